// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// The meshes in 3-D, one picture for each vertex order, all turned together.

class MeshView {
  constructor(root, manifest, results) {
    this.root = root;
    this.manifest = manifest;
    this.results = results;
    this.redraw = coalesced(() => this.draw());
    this.orbit = new Orbit(this.redraw);
    this.pictures = [];
    this.share = 1;
    this.build();
  }

  build() {
    this.stage = theStage();
    if (!this.stage) {
      this.root.replaceChildren(make("p", { className: "notice" },
        "This browser has no WebGL, which the meshes in 3-D need. The tables and figures work without it."));
      return;
    }
    this.material = bandMaterial();
    this.grid = make("div", { className: "orders" });
    const meshes = this.manifest.meshes.map(({ name }) => [name, name]);
    const styles = [["bands", "Bands"], ["contours", "Contour lines"]];
    this.slider = makeSlider("Vertices up to rank", { min: 0, max: 1000, step: 1, value: 1000 }, (thousandths) => {
      this.share = thousandths / 1000;
      this.redraw();
      return this.mesh ? `${grouped(this.share * this.mesh.vertices)} of ${grouped(this.mesh.vertices)}` : "";
    });
    this.sweepButton = make("button", { type: "button" }, "Sweep");
    this.sweepButton.addEventListener("click", () => this.sweep());
    this.root.replaceChildren(
      make("div", { className: "controls" },
        makeChoices("Mesh", meshes, (name) => this.choose(name)),
        makeChoices("Drawn as", styles, (style) => {
          this.material.uniforms.contours.value = style === "contours";
          this.legend.hidden = style === "contours";
          this.redraw();
        })),
      make("div", { className: "controls" }, this.slider.element, this.sweepButton),
      this.legend = makeLegend(),
      this.grid,
      make("p", { className: "hint" }, "Drag to turn, pinch or click and scroll to zoom, double-click to reset. " +
        "With keys: arrows, + and −, Home."));
    new ResizeObserver(this.redraw).observe(this.grid);
    this.ready = this.choose(meshes[0][0]);
  }

  /** Shows the mesh of that name. */
  async choose(name) {
    this.wanted = name;
    const ordered = await loadOrderedMesh(this.manifest, name);
    if (this.wanted !== name) return;  // another was chosen meanwhile
    for (const picture of this.pictures) picture.geometry.dispose();
    this.mesh = ordered.mesh;
    this.view = ordered.view;
    this.orbit.face(name);
    this.pictures = ordered.groups.map((group) =>
      orderPicture(ordered, group, this.material, spanWords(this.results, name, group.names[0])));
    for (const { canvas } of this.pictures) this.orbit.attach(canvas);
    this.grid.replaceChildren(...this.pictures.map(({ figure }) => figure));
    this.slider.tell();
  }

  draw() {
    if (!this.stage) return;
    this.material.uniforms.limit.value = this.share;
    for (const { canvas, scene } of this.pictures) this.stage.draw(canvas, scene, this.orbit, this.view);
  }

  /** Moves the slider to the end, so that colour runs through the order; stops it if it moves already. */
  sweep() {
    if (this.sweeping) {
      this.sweeping = false;
      return;
    }
    this.sweeping = true;
    this.sweepButton.textContent = "Stop";
    const input = this.slider.input;
    const from = Number(input.value) >= 1000 ? 0 : Number(input.value);
    const began = performance.now();
    const tick = (now) => {
      const value = Math.min(from + (now - began) / 6, 1000);
      input.value = value;
      this.slider.tell();
      if (this.sweeping && value < 1000) requestAnimationFrame(tick);
      else this.sweeping = false;
      if (!this.sweeping) this.sweepButton.textContent = "Sweep";
    };
    requestAnimationFrame(tick);
  }
}
