// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// What the results say about how they were measured, in words.

function yesNo(value) {
  return value ? "yes" : "no";
}

function plural(count, word) {
  return `${grouped(count)} ${word}${count === 1 ? "" : "s"}`;
}

/** One line below the title: what was measured where and when. */
function bylineWords(results) {
  const machine = results.machine || {};
  const parts = [machine.processor, results.threads && plural(results.threads, "thread"),
                 results.began && results.began.slice(0, 10), machine.program && `meshorder ${machine.program}`];
  return parts.filter((part) => part).join(" · ");
}

/** The protocol of each scenario as a table; null where nothing was simulated. */
function protocolTable(results) {
  const scenarios = results.scenarios || [];
  if (scenarios.length === 0) return null;
  const columns = ["Scenario", "Mesh", "Method", "Material", "Steps", "Steps a turn", "Interleaved", "Same addresses",
                   "Bound to processors"];
  const rows = scenarios.map((one) => [
    one.name, one.mesh, one.method, one.material, one.steps, one.turn, yesNo(one.interleaved),
    yesNo(one.fixed_addresses), (one.processors || []).join(", ") || "no"]);
  const table = make("table", { id: "protocol-table" },
    make("caption", {}, make("strong", {}, "Protocol"), " Orders take turns of so many steps, so that what disturbs the " +
      `machine disturbs all of them; ${plural(results.runs || 1, "run")} of each.`),
    make("thead", {}, make("tr", {}, ...columns.map((title) => make("th", { scope: "col" }, title)))),
    make("tbody", {}, ...rows.map((row) => make("tr", {}, ...row.map((cell, i) => {
      const element = make(i ? "td" : "th", {}, String(cell ?? ""));
      if (i === 0) element.scope = "row";
      if (typeof cell === "number") element.dataset.value = cell;
      return element;
    })))));
  return make("div", { className: "scroll", tabIndex: 0 }, table);
}

function startProtocol(results) {
  document.getElementById("byline").textContent = bylineWords(results);
  const place = document.getElementById("protocol");
  const box = place && protocolTable(results);
  if (!box) return;
  place.append(box);
  arrangeTable(box.firstElementChild);
  makeSortable(box.firstElementChild);
}

/** Lets the reader keep the results that the page was made from. */
function startSaving() {
  const button = document.getElementById("save-results");
  const source = document.getElementById("results");
  if (!source) {
    button.hidden = true;
    return;
  }
  button.addEventListener("click", () => {
    const address = URL.createObjectURL(new Blob([source.textContent], { type: "application/json" }));
    make("a", { href: address, download: "results.json" }).click();
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  });
}
