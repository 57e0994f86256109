// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// The page's data: arrays that the manifest describes, unpacked when they are first asked for.

const numberTypes = { uint8: Uint8Array, uint16: Uint16Array, uint32: Uint32Array };
const unpackedBlobs = new Map();

/** Returns the JSON in a script element; null where there is none. */
function embeddedJson(id) {
  const element = document.getElementById(id);
  return element && element.textContent.trim() ? JSON.parse(element.textContent) : null;
}

async function unpackBlob(id) {
  const element = document.getElementById(id);
  const packed = Uint8Array.from(atob(element.textContent.trim()), (letter) => letter.charCodeAt(0));
  element.textContent = "";
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

/** Turns the differences between frames into frames, in place; sums wrap around at the range of the type. */
function addUpFrames(numbers, frames) {
  const length = numbers.length / frames;
  for (let i = length; i < numbers.length; ++i) numbers[i] += numbers[i - length];
}

/** Promises the numbers of an array of the manifest. */
function loadNumbers(array) {
  if (!unpackedBlobs.has(array.blob)) {
    unpackedBlobs.set(array.blob, unpackBlob(array.blob).then((buffer) => {
      const numbers = new numberTypes[array.type](buffer);
      if (array.delta) addUpFrames(numbers, array.shape[0]);
      return numbers;
    }));
  }
  return unpackedBlobs.get(array.blob);
}

/** Returns the coordinates x, y, z of `count` vertices from vertex `first` on, computed from an array's numbers. */
function placesOf(array, numbers, first, count, places = new Float32Array(3 * count)) {
  for (let i = 0; i < 3 * count; ++i) places[i] = array.offset[i % 3] + array.scale[i % 3] * numbers[3 * first + i];
  return places;
}

/** Promises the places of an array of vertices × 3. */
async function loadPlaces(array) {
  return placesOf(array, await loadNumbers(array), 0, array.shape[0]);
}
