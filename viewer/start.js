// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Starts everything: tabs and tables at once, what needs data when the data are there and somebody looks.

const views = {};

/** Makes a part's view the first time that it is called for, and draws it each time. */
function showView(name, makeView) {
  if (!views[name]) views[name] = makeView();
  else if (views[name].redraw) views[name].redraw();
}

function startViews() {
  const results = embeddedJson("results");
  const manifest = embeddedJson("manifest") || {};
  if (results) document.getElementById("byline").textContent = bylineWords(results);
  startSaving();
  const at = (id) => document.getElementById(id);
  const parts = [
    ["findings", "hero", () => new Hero(at("hero"), manifest, results)],
    ["meshes", "mesh-view", () => new MeshView(at("mesh-view"), manifest, results)],
    ["spans", "pattern-view", () => new PatternView(at("pattern-view"), manifest, results)],
    ["motion", "motion-view", () => new Player(at("motion-view"), manifest)],
  ].filter(([id, root]) => (manifest[id === "motion" ? "motions" : "meshes"] || []).length && at(root));
  for (const [id, , makeView] of parts) whenShown(id, () => showView(id, makeView));

  // what was never looked at is to be on paper, too
  const prepare = async () => {
    for (const [id, , makeView] of parts) {
      await new Promise((idle) => (window.requestIdleCallback || setTimeout)(idle));
      if (!views[id]) showView(id, makeView);
      await views[id].ready;
    }
  };
  prepare();
  window.addEventListener("beforeprint", () => {
    for (const view of Object.values(views)) if (view.draw) view.draw();
  });
}

/** Called at the end of the body, before the data. */
function startPage() {
  startTables();
  startTabs();
  document.addEventListener("DOMContentLoaded", startViews);
}
