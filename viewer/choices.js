// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Elements of the views' controls: choices, sliders.

/** Makes an element with attributes and children. */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name in element && name !== "role" && name !== "list") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

let choicesMade = 0;

/** Makes a row of radio buttons. `options` are [value, title]; the first is chosen. Hidden for fewer than two. */
function makeChoices(legend, options, onChoice) {
  const name = `choice-${++choicesMade}`;
  const row = make("div", { className: "choices" });
  options.forEach(([value, title], i) => {
    const radio = make("input", { type: "radio", name, value, checked: i === 0 });
    radio.addEventListener("change", () => onChoice(value));
    row.append(make("label", {}, radio, make("span", {}, title)));
  });
  return make("fieldset", { className: "control", hidden: options.length < 2 }, make("legend", {}, legend), row);
}

/** Makes a slider with a text beside it; `onInput` gets the slider's number and returns the text. */
function makeSlider(title, range, onInput) {
  const words = make("output", {});
  const input = make("input", { type: "range", min: range.min, max: range.max, step: range.step });
  input.value = range.value;
  const tell = () => {
    words.textContent = onInput(Number(input.value));
    input.setAttribute("aria-valuetext", words.textContent);
  };
  input.addEventListener("input", tell);
  return { element: make("label", { className: "control slider" }, make("span", {}, title), input, words), input, tell };
}

/** Returns a number as text, 46736 as "46,736". */
function grouped(number) {
  return Math.round(number).toLocaleString("en-US");
}

/** Returns a function that runs `draw` before the next frame, once however often it is called until then. */
function coalesced(draw) {
  let waiting = false;
  return () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      draw();
    });
  };
}
