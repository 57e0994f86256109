// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// One WebGL context draws for every canvas, since browsers allow few of them; each canvas keeps its own picture.

const fieldOfView = 28;  // degrees

let sharedStage;

/** Returns the page's stage; null where the browser has no WebGL. */
function theStage() {
  if (sharedStage === undefined) {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl", { antialias: true, alpha: true, preserveDrawingBuffer: true });
    sharedStage = context ? new Stage(canvas, context) : null;
  }
  return sharedStage;
}

class Stage {
  constructor(canvas, context) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, context });
    this.renderer.setPixelRatio(1);
    this.renderer.setClearColor(0x000000, 0);
    this.camera = new THREE.PerspectiveCamera(fieldOfView, 1, 0.1, 10);
  }

  /** Draws a scene on a canvas, seen so that a ball of `view` (center, radius) fills it. A canvas out of sight has
   *  no size: it becomes a square of `side`. */
  draw(canvas, scene, orbit, view, side = 400) {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.round((canvas.clientWidth || side) * ratio);
    const height = Math.round((canvas.clientHeight || side) * ratio);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    if (this.canvas.width !== width || this.canvas.height !== height) this.renderer.setSize(width, height, false);

    this.aim(orbit, view, width / height);
    this.renderer.render(scene, this.camera);
    const picture = canvas.getContext("2d");
    picture.clearRect(0, 0, width, height);
    picture.drawImage(this.canvas, 0, 0);
  }

  aim(orbit, view, aspect) {
    const half = Math.tan((fieldOfView * Math.PI) / 360) * Math.min(1, aspect);
    const distance = view.radius / Math.sin(Math.atan(half)) / orbit.zoom;
    const level = Math.cos(orbit.pitch) * distance;
    this.camera.position.set(
      view.center[0] + level * Math.sin(orbit.yaw),
      view.center[1] + distance * Math.sin(orbit.pitch),
      view.center[2] + level * Math.cos(orbit.yaw));
    this.camera.lookAt(new THREE.Vector3(...view.center));
    this.camera.aspect = aspect;
    this.camera.near = Math.max(distance - 4 * view.radius, distance / 200);
    this.camera.far = distance + 12 * view.radius;
    this.camera.updateProjectionMatrix();
  }
}

/** Returns the middle of the box around places, and the radius of the ball around that middle that holds them. */
function ballAround(places) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < places.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], places[i]);
    high[i % 3] = Math.max(high[i % 3], places[i]);
  }
  const center = low.map((x, axis) => (x + high[axis]) / 2);
  let square = 0;
  for (let i = 0; i < places.length; i += 3) {
    square = Math.max(square, (places[i] - center[0]) ** 2 + (places[i + 1] - center[1]) ** 2 +
                              (places[i + 2] - center[2]) ** 2);
  }
  return { center, radius: Math.sqrt(square) || 1 };
}

/** Returns a geometry of three.js with places, triangles and normals. */
function surfaceGeometry(places, triangles) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(triangles), 1));
  geometry.computeVertexNormals();
  return geometry;
}
