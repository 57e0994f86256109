// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// A mesh to begin with: the surface of a ball, with its vertices and triangles in a random order.

/** Returns a function that shuffles arrays, the same way each time that the page is opened. */
function makeShuffle(seed) {
  let state = seed;
  const random = (end) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * end);
  };
  return (array) => {
    for (let i = array.length - 1; i > 0; --i) {
      const j = random(i + 1);
      [array[i], array[j]] = [array[j], array[i]];
    }
    return array;
  };
}

/** Returns {points, triangles} of an octahedron with each edge cut into `cuts`, blown up to a ball. */
function octahedralBall(cuts) {
  const points = [];
  const triangles = [];
  const known = new Map();
  const vertex = (...place) => {
    const key = place.join();
    if (!known.has(key)) {
      known.set(key, points.length);
      const length = Math.hypot(...place);
      points.push(place.map((x) => x / length));
    }
    return known.get(key);
  };
  for (const [x, y, z] of [1, -1].flatMap((x) => [1, -1].flatMap((y) => [1, -1].map((z) => [x, y, z])))) {
    const at = (i, j) => vertex(x * i, y * j, z * (cuts - i - j));
    const add = (a, b, c) => triangles.push(x * y * z > 0 ? [a, b, c] : [a, c, b]);
    for (let i = 0; i < cuts; ++i) {
      for (let j = 0; i + j < cuts; ++j) {
        add(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < cuts) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  return { points, triangles };
}

/** Returns a ball as a file: {name, bytes}. */
function makeBall(cuts = 60) {
  const shuffle = makeShuffle(7);
  const { points, triangles } = octahedralBall(cuts);
  const newToOld = shuffle(points.map((_, v) => v));
  const oldToNew = [];
  newToOld.forEach((old, v) => { oldToNew[old] = v; });
  const lines = ["OFF", `${points.length} ${triangles.length} 0`,
    ...newToOld.map((old) => points[old].map((x) => x.toFixed(6)).join(" ")),
    ...shuffle(triangles.map((corners) => `3 ${corners.map((v) => oldToNew[v]).join(" ")}`)), ""];
  return { name: "ball.off", bytes: new TextEncoder().encode(lines.join("\n")) };
}
