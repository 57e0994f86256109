// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Plays the motions of the scenarios.

const posterShare = 0.4;  // share of a motion at which it is shown before it is played
const stills = 6;

class Player {
  constructor(root, manifest) {
    this.root = root;
    this.manifest = manifest;
    this.redraw = coalesced(() => this.draw());
    this.orbit = new Orbit(this.redraw);
    this.stepsPerSecond = 40;
    this.step = 0;
    this.build();
  }

  build() {
    this.stage = theStage();
    if (!this.stage) {
      this.root.replaceChildren(make("p", { className: "notice" },
        "This browser has no WebGL, which the player needs. The tables and figures work without it."));
      return;
    }
    const motions = this.manifest.motions.map(({ scenario }) => [scenario, scenario]);
    this.canvas = make("canvas", { className: "film", role: "img" });
    this.orbit.attach(this.canvas);
    this.title = make("strong", {});
    this.details = make("span", {});
    this.button = make("button", { type: "button", className: "play" }, "Play");
    this.button.addEventListener("click", () => (this.playing ? this.pause() : this.play()));
    this.slider = makeSlider("Step", { min: 0, max: 1, step: 1, value: 0 }, (step) => {
      this.step = step;
      this.redraw();
      return this.words();
    });
    this.slider.input.addEventListener("pointerdown", () => this.pause());
    const speed = make("select", {}, ...[10, 20, 40, 80, 160].map((value) =>
      make("option", { value, selected: value === this.stepsPerSecond }, String(value))));
    this.strip = make("div", { className: "strip-of-frames" });
    speed.addEventListener("change", () => { this.stepsPerSecond = Number(speed.value); });
    this.root.replaceChildren(
      make("div", { className: "controls" }, makeChoices("Scenario", motions, (name) => this.choose(name))),
      make("figure", { className: "order" }, this.canvas, make("figcaption", {}, this.title, this.details)),
      make("div", { className: "controls" }, this.button, this.slider.element,
        make("label", { className: "control" }, make("span", {}, "Steps a second"), speed)),
      this.strip,
      make("p", { className: "hint" }, "Drag to turn, pinch or click and scroll to zoom, double-click to reset. " +
        "With keys: arrows, + and −, Home; the space bar plays and pauses."));
    this.canvas.addEventListener("keydown", (event) => {
      if (event.key !== " ") return;
      event.preventDefault();
      this.button.click();
    });
    new ResizeObserver(this.redraw).observe(this.canvas);
    this.ready = this.choose(motions[0][0]);
  }

  words() {
    return this.motion ? `${Math.round(this.step)} of ${this.motion.lastStep}` : "";
  }

  /** Shows the motion of that scenario. */
  async choose(scenario) {
    this.pause();
    const chosen = this.manifest.motions.find((one) => one.scenario === scenario);
    this.wanted = chosen;
    const motion = await loadMotion(chosen);
    if (this.wanted !== chosen) return;  // another was chosen meanwhile
    if (this.motion) this.motion.dispose();
    this.motion = motion;
    this.orbit.face(chosen.mesh);
    this.title.textContent = chosen.title;
    this.details.textContent = `${chosen.mesh}: ${chosen.steps.length} frames of ${motion.lastStep} steps`;
    this.canvas.setAttribute("aria-label", `${chosen.title} (${chosen.mesh})`);
    this.slider.input.max = motion.lastStep;
    this.slider.input.value = Math.round(posterShare * motion.lastStep);
    this.slider.tell();
    this.drawStills();
  }

  /** Draws some frames side by side, as buttons that go to their step. */
  drawStills() {
    this.strip.replaceChildren();
    for (let i = 0; i < stills; ++i) {
      const step = Math.round((i * this.motion.lastStep) / (stills - 1));
      const canvas = make("canvas", {});
      const button = make("button", { type: "button" }, canvas, `step ${step}`);
      button.addEventListener("click", () => this.go(step));
      this.strip.append(button);
      this.motion.set(step);
      this.stage.draw(canvas, this.motion.scene, new Orbit(() => {}, this.motion.motion.mesh), this.motion.view, 160);
    }
  }

  go(step) {
    this.pause();
    this.slider.input.value = step;
    this.slider.tell();
  }

  play() {
    if (!this.motion) return;
    this.playing = true;
    this.button.textContent = "Pause";
    let last = performance.now();
    const tick = (now) => {
      if (!this.playing) return;
      this.advance((Math.max(now - last, 0) / 1000) * this.stepsPerSecond);
      last = now;
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  pause() {
    this.playing = false;
    this.button.textContent = "Play";
  }

  /** Advances by some steps; after the last one starts again. */
  advance(steps) {
    const next = this.step + steps;
    this.slider.input.value = Math.round(next > this.motion.lastStep ? 0 : next);
    this.slider.tell();
    this.step = next > this.motion.lastStep ? 0 : next;
  }

  draw() {
    if (!this.motion) return;
    this.motion.set(this.step);
    this.stage.draw(this.canvas, this.motion.scene, this.orbit, this.motion.view);
  }
}
