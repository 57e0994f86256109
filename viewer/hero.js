// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Beside the findings: the first mesh as it is and as `meshorder order` makes it; of a study in its worst and best order.

/** Returns a measure, to compare orders by, of the distance in memory of the corners of a surface's triangles. */
function roughness(ranks, surface) {
  const corners = surface.index.array;
  let sum = 0;
  for (let i = 0; i < corners.length; i += 3) {
    sum += Math.abs(ranks[corners[i]] - ranks[corners[i + 1]]) + Math.abs(ranks[corners[i + 1]] - ranks[corners[i + 2]]);
  }
  return sum / corners.length;
}

class Hero {
  constructor(root, manifest, results) {
    this.redraw = coalesced(() => this.draw());
    this.orbit = new Orbit(this.redraw);
    this.pictures = [];
    this.stage = theStage();
    this.ready = this.stage ? this.build(root, manifest, results) : Promise.resolve(root.remove());
  }

  async build(root, manifest, results) {
    const ordered = await loadOrderedMesh(manifest, manifest.meshes[0].name);
    const name = ordered.mesh.name;
    const groups = ordered.groups.map((group) => ({ group, roughness: roughness(group.numbers, ordered.surface) }));
    groups.sort((a, b) => b.roughness - a.roughness);
    const made = ["original", "meshorder"].map((order) => groups.find(({ group }) => group.names.includes(order)));
    const ends = groups.length > 1 ? [groups[0], groups[groups.length - 1]] : groups;
    const shown = results && results.scenarios.length === 0 && made.every((one) => one) ? [...new Set(made)] : ends;
    const material = bandMaterial();
    this.view = ordered.view;
    this.orbit.face(name);
    this.pictures = shown.map(({ group }) =>
      orderPicture(ordered, group, material, spanWords(results, name, group.names[0])));
    for (const { canvas } of this.pictures) this.orbit.attach(canvas);
    const grid = make("div", { className: "pair" }, ...this.pictures.map(({ figure }) => figure));
    root.replaceChildren(grid,
      make("p", { className: "hint" }, `${name}, its vertices coloured from first to last in memory. `,
        make("a", { href: "#meshes" }, "All meshes and orders")));
    new ResizeObserver(this.redraw).observe(grid);
  }

  draw() {
    for (const { canvas, scene } of this.pictures) this.stage.draw(canvas, scene, this.orbit, this.view);
  }
}
