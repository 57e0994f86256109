// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Sparsity patterns of the matrix over the vertices, a picture for each order.

/** Draws side × side counts, the larger the darker, on a logarithmic scale that ends at `most`. */
function drawPattern(canvas, counts, side, most) {
  Object.assign(canvas, { width: side, height: side });
  const picture = canvas.getContext("2d");
  const image = picture.createImageData(side, side);
  for (let i = 0; i < counts.length; ++i) {
    const ink = counts[i] ? 0.16 + 0.84 * Math.log(1 + counts[i]) / Math.log(1 + most) : 0;
    image.data.set([255 - 238 * ink, 255 - 222 * ink, 255 - 186 * ink, 255], 4 * i);
  }
  picture.putImageData(image, 0, 0);
}

class PatternView {
  constructor(root, manifest, results) {
    this.manifest = manifest;
    this.results = results;
    this.grid = make("div", { className: "orders patterns" });
    const meshes = manifest.meshes.map(({ name }) => [name, name]);
    root.replaceChildren(
      make("div", { className: "controls" }, makeChoices("Mesh", meshes, (name) => this.choose(name))), this.grid);
    this.ready = this.choose(meshes[0][0]);
  }

  async choose(name) {
    const mesh = this.manifest.meshes.find((one) => one.name === name);
    const groups = await loadByOrder(this.manifest.orderings, mesh.sparsity);
    const most = groups.reduce((high, { numbers }) => numbers.reduce((a, b) => Math.max(a, b), high), 1);
    this.grid.replaceChildren(...groups.map((group) => {
      const canvas = make("canvas", { role: "img" });
      canvas.setAttribute("aria-label", `Sparsity pattern of ${name}: ${group.titles.join(", ")}`);
      drawPattern(canvas, group.numbers, group.array.shape[0], most);
      return orderFigure(canvas, group, spanWords(this.results, name, group.names[0]));
    }));
  }
}
