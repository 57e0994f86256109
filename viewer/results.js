// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// The parts of the page that are made of results.json, besides its tables.

/** Returns the line below the title: processor, threads, date and version. */
function bylineWords(results) {
  const machine = results.machine || {};
  const threads = results.threads && `${results.threads} thread${results.threads === 1 ? "" : "s"}`;
  const parts = [machine.processor, threads, results.began && results.began.slice(0, 10),
                 machine.program && `meshorder ${machine.program}`];
  return parts.filter((part) => part).join(" · ");
}

/** Returns the mean edge span of a mesh in an order, in words; empty where the results have none. */
function spanWords(results, mesh, ordering) {
  const record = ((results && results.meshes) || []).find((one) => one.name === mesh);
  const order = record && (record.orders || []).find((one) => one.ordering === ordering);
  const mean = order && order.span && order.span.mean;
  return mean > 0 ? `mean span ${grouped(mean)}` : "";
}

/** Makes the button that saves the results.json that the page contains; hides it where there is none. */
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
