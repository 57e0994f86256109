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
  if (results) startProtocol(results);
  startSaving();
  const parts = [
    ["meshes", (manifest.meshes || []).length, () => new MeshView(document.getElementById("mesh-view"), manifest, results)],
    ["spans", (manifest.meshes || []).length,
     () => new PatternView(document.getElementById("pattern-view"), manifest, results)],
    ["motion", (manifest.motions || []).length, () => new Player(document.getElementById("motion-view"), manifest)],
  ].filter(([id, count]) => count && document.getElementById(id));
  for (const [id, , makeView] of parts) whenShown(id, () => showView(id, makeView));

  // what was never looked at is to be on paper, too
  const prepare = () => parts.forEach(([id, , makeView]) => showView(id, makeView));
  (window.requestIdleCallback || setTimeout)(prepare, { timeout: 4000 });
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
