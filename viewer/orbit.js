// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// A camera that turns around a body: by dragging, pinching, the wheel and keys, on any number of canvases at once.

const startYaw = 0.5;
const startPitch = 0.22;

/** Returns the turn about the vertical axis that makes a mesh face the reader: half a turn for the armadillo. */
function frontOf(mesh) {
  return mesh && mesh.startsWith("armadillo") ? Math.PI : 0;
}

class Orbit {
  /** Starts from the front of a mesh; `onChange` is called after each turn. */
  constructor(onChange, mesh = "") {
    this.onChange = onChange;
    this.pointers = new Map();
    this.face(mesh);
  }

  /** Turns to the front of a mesh, without a call. */
  face(mesh) {
    this.front = frontOf(mesh);
    this.set(startYaw + this.front, startPitch, 1);
  }

  set(yaw, pitch, zoom) {
    this.yaw = yaw;
    this.pitch = Math.max(-1.5, Math.min(1.5, pitch));
    this.zoom = Math.max(0.4, Math.min(12, zoom));
  }

  change(yaw, pitch, zoom) {
    this.set(this.yaw + yaw, this.pitch + pitch, this.zoom * zoom);
    this.onChange();
  }

  reset() {
    this.set(startYaw + this.front, startPitch, 1);
    this.onChange();
  }

  attach(canvas) {
    canvas.tabIndex = 0;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      canvas.focus({ preventScroll: true });
    });
    canvas.addEventListener("pointermove", (event) => this.drag(event, canvas.clientWidth));
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
    canvas.addEventListener("wheel", (event) => {
      // a canvas without the focus leaves the wheel to the page
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.change(0, 0, Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => this.press(event));
    canvas.addEventListener("dblclick", () => this.reset());
  }

  drag(event, width) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    const now = { x: event.clientX, y: event.clientY };
    this.pointers.set(event.pointerId, now);
    if (others.length > 0) {
      const distance = (place) => Math.hypot(place.x - others[0].x, place.y - others[0].y);
      this.change(0, 0, Math.max(distance(now), 1) / Math.max(distance(last), 1));
    } else {
      const radians = Math.PI / Math.max(width, 1);  // a canvas's width is half a turn
      this.change((last.x - now.x) * radians, (now.y - last.y) * radians, 1);
    }
  }

  press(event) {
    const changes = {
      ArrowLeft: [0.12, 0, 1], ArrowRight: [-0.12, 0, 1], ArrowUp: [0, 0.1, 1], ArrowDown: [0, -0.1, 1],
      "+": [0, 0, 1.15], "=": [0, 0, 1.15], "-": [0, 0, 1 / 1.15],
    };
    if (event.key === "Home" || event.key === "0") this.reset();
    else if (changes[event.key]) this.change(...changes[event.key]);
    else return;
    event.preventDefault();
  }
}
