// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Small pieces of which the views' controls are made.

/** An element with attributes and children. */
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

/** One of several, as a row of radio buttons. `options` are [value, title]; the first is chosen. */
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

/** A slider with its words; `onInput` gets its number and returns the words for it. */
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

/** 46736 as "46,736". */
function grouped(number) {
  return Math.round(number).toLocaleString("en-US");
}

/** Runs `draw` once before the next picture, however often the function that it returns is called. */
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
