// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// A motion of the manifest as a scene that can be set to any step.

const bodyColour = 0xd08a4e;
const fluidColour = 0x3f86c6;
const obstacleColour = 0x5b7fa6;

async function loadMotion(motion) {
  const obstacle = motion.obstacle && {
    places: await loadPlaces(motion.obstacle.positions),
    triangles: await loadNumbers(motion.obstacle.triangles),
  };
  const geometries = motion.surfaces && await Promise.all(motion.surfaces.map(async (one) =>
    surfaceGeometry(await loadPlaces(one.positions), await loadNumbers(one.triangles))));
  if (geometries) return new FluidScene(motion, geometries, obstacle);
  const [numbers, triangles] = await Promise.all([loadNumbers(motion.frames), loadNumbers(motion.triangles)]);
  return new BodyScene(motion, numbers, triangles, obstacle);
}

/** The lights, what moves, and what it meets. Who extends it sets `view`, a ball around all of it. */
class MotionScene {
  constructor(motion, geometry, colour, obstacle) {
    this.motion = motion;
    this.lastStep = motion.steps[motion.steps.length - 1];
    this.scene = new THREE.Scene();
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8c7f74, 0.75));
    this.sun = new THREE.DirectionalLight(0xffffff, 0.55);
    this.sun.position.set(-0.5, 1, 0.8);
    this.scene.add(this.sun);
    this.mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: colour, side: THREE.DoubleSide }));
    this.scene.add(this.mesh);
    if (obstacle) this.addObstacle(obstacle);
  }

  addObstacle({ places, triangles }) {
    const material = new THREE.MeshLambertMaterial(
      { color: obstacleColour, side: THREE.DoubleSide, transparent: true, opacity: 0.28, depthWrite: false });
    this.scene.add(new THREE.Mesh(surfaceGeometry(places, triangles), material));
  }

  /** Returns the frames before and after `step`, and the share of the way between them. */
  framesAround(step) {
    const steps = this.motion.steps;
    let next = steps.findIndex((one) => one >= step);
    if (next < 0) next = steps.length - 1;
    const last = Math.max(next - 1, 0);
    return { last, next, share: next === last ? 0 : (step - steps[last]) / (steps[next] - steps[last]) };
  }

  dispose() {
    this.scene.traverse((one) => {
      if (one.geometry) one.geometry.dispose();
      if (one.material) one.material.dispose();
    });
  }
}

/** A body, whose surface keeps its triangles. */
class BodyScene extends MotionScene {
  constructor(motion, numbers, triangles, obstacle) {
    const vertices = motion.frames.shape[1];
    const placesAt = (frame, places) => placesOf(motion.frames, numbers, frame * vertices, vertices, places);
    super(motion, surfaceGeometry(placesAt(0), triangles), bodyColour, obstacle);
    this.placesAt = placesAt;
    this.before = new Float32Array(3 * vertices);
    this.after = new Float32Array(3 * vertices);
    this.view = this.wholeView(obstacle);
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
    const { last, next, share } = this.framesAround(step);
    this.placesAt(last, this.before);
    this.placesAt(next, this.after);
    const position = this.mesh.geometry.getAttribute("position");
    for (let i = 0; i < this.before.length; ++i) {
      position.array[i] = this.before[i] + share * (this.after[i] - this.before[i]);
    }
    position.needsUpdate = true;
    this.mesh.geometry.computeVertexNormals();
    this.mesh.geometry.getAttribute("normal").needsUpdate = true;
  }
}

/** A fluid, which has another surface in each frame. */
class FluidScene extends MotionScene {
  constructor(motion, geometries, obstacle) {
    super(motion, geometries[0], fluidColour, obstacle);
    this.geometries = geometries;
    const places = geometries.flatMap((one) => [...one.getAttribute("position").array]);
    this.view = ballAround(obstacle ? places.concat([...obstacle.places]) : places);
  }

  /** Shows the frame nearest to `step`. */
  set(step) {
    const { last, next, share } = this.framesAround(step);
    this.mesh.geometry = this.geometries[share < 0.5 ? last : next];
  }

  dispose() {
    super.dispose();
    for (const geometry of this.geometries) geometry.dispose();
  }
}
