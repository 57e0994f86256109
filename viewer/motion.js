// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// A motion of the manifest as a scene that can be set to any step.

const bodyColour = 0xd08a4e;
const obstacleColour = 0x5b7fa6;

async function loadMotion(motion) {
  const [numbers, triangles] = await Promise.all([loadNumbers(motion.frames), loadNumbers(motion.triangles)]);
  const obstacle = motion.obstacle && {
    places: await loadPlaces(motion.obstacle.positions),
    triangles: await loadNumbers(motion.obstacle.triangles),
  };
  return new MotionScene(motion, numbers, triangles, obstacle);
}

class MotionScene {
  constructor(motion, numbers, triangles, obstacle) {
    this.motion = motion;
    this.numbers = numbers;
    this.vertices = motion.frames.shape[1];
    this.lastStep = motion.steps[motion.steps.length - 1];
    this.before = new Float32Array(3 * this.vertices);
    this.after = new Float32Array(3 * this.vertices);
    this.geometry = surfaceGeometry(this.placesAt(0, this.before).slice(), triangles);
    this.scene = new THREE.Scene();
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8c7f74, 0.75));
    this.sun = new THREE.DirectionalLight(0xffffff, 0.55);
    this.sun.position.set(-0.5, 1, 0.8);
    this.scene.add(this.sun);
    this.scene.add(new THREE.Mesh(this.geometry,
      new THREE.MeshLambertMaterial({ color: bodyColour, side: THREE.DoubleSide })));
    if (obstacle) this.addObstacle(obstacle);
    this.view = this.wholeView(obstacle);
  }

  addObstacle({ places, triangles }) {
    const material = new THREE.MeshLambertMaterial(
      { color: obstacleColour, side: THREE.DoubleSide, transparent: true, opacity: 0.28, depthWrite: false });
    this.scene.add(new THREE.Mesh(surfaceGeometry(places, triangles), material));
  }

  placesAt(frame, places) {
    return placesOf(this.motion.frames, this.numbers, frame * this.vertices, this.vertices, places);
  }

  /** Returns a ball around the body in some of the frames, and around an obstacle that is not much larger. */
  wholeView(obstacle) {
    const frames = this.motion.frames.shape[0];
    const some = [];
    for (let i = 0; i < frames; i += Math.max(1, Math.floor(frames / 12))) some.push(i);
    if (some[some.length - 1] !== frames - 1) some.push(frames - 1);
    const passed = some.flatMap((frame) => [...this.placesAt(frame, this.before)]);
    const view = ballAround(passed);
    const withAll = obstacle ? ballAround(passed.concat([...obstacle.places])) : view;
    return withAll.radius < 1.5 * view.radius ? withAll : view;
  }

  /** Moves the body to where it was after `step` steps, which may be a fraction. */
  set(step) {
    const steps = this.motion.steps;
    let next = steps.findIndex((one) => one >= step);
    if (next < 0) next = steps.length - 1;
    const last = Math.max(next - 1, 0);
    const share = next === last ? 0 : (step - steps[last]) / (steps[next] - steps[last]);
    this.placesAt(last, this.before);
    this.placesAt(next, this.after);
    const position = this.geometry.getAttribute("position");
    for (let i = 0; i < this.before.length; ++i) {
      position.array[i] = this.before[i] + share * (this.after[i] - this.before[i]);
    }
    position.needsUpdate = true;
    this.geometry.computeVertexNormals();
    this.geometry.getAttribute("normal").needsUpdate = true;
  }

  dispose() {
    this.scene.traverse((one) => {
      if (one.geometry) one.geometry.dispose();
      if (one.material) one.material.dispose();
    });
  }
}
