// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Starts the page: tabs and tables at once, each view of the data when its part is first shown.

const views = {};

/** Makes the view of that name when it is first shown, and draws it again each later time. */
function showView(name, makeView) {
  if (!views[name]) views[name] = makeView();
  else if (views[name].redraw) views[name].redraw();
}

function startViews() {
  const results = embeddedJson("results");
  const manifest = embeddedJson("manifest") || {};
  // a matrix has a pattern and no surface
  const inSpace = { ...manifest, meshes: (manifest.meshes || []).filter(({ triangles }) => triangles) };
  if (results) document.getElementById("byline").textContent = bylineWords(results);
  startSaving();
  const at = (id) => document.getElementById(id);
  const parts = [
    ["findings", "hero", () => new Hero(at("hero"), inSpace, results), inSpace.meshes],
    ["meshes", "mesh-view", () => new MeshView(at("mesh-view"), inSpace, results), inSpace.meshes],
    ["spans", "pattern-view", () => new PatternView(at("pattern-view"), manifest, results), manifest.meshes],
    ["motion", "motion-view", () => new Player(at("motion-view"), manifest), manifest.motions],
  ].filter(([, root, , shown]) => (shown || []).length && at(root));
  for (const [id, , makeView] of parts) whenShown(id, () => showView(id, makeView));

  // makes the views that were never shown, too, so that they can be printed
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
