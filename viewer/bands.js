// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// A surface coloured by the order of its vertices: bands from dark to light, which need no colour vision.

const bandCount = 24;
// first to last in memory, of steadily growing brightness
const rampStops = [[38, 24, 92], [34, 76, 138], [22, 122, 138], [62, 165, 112], [158, 203, 72], [250, 226, 92]];

/** Returns the ramp's colour at a share of the order, 0 to 1, as "rgb(…)"; every second band is lighter. */
function bandColour(share) {
  const place = Math.min(Math.max(share, 0), 1) * (rampStops.length - 1);
  const low = Math.min(Math.floor(place), rampStops.length - 2);
  const lighter = Math.floor(share * bandCount) % 2 === 1 ? 0.3 : 0;
  const channels = rampStops[low].map((value, i) => {
    const ramp = value + (place - low) * (rampStops[low + 1][i] - value);
    return Math.round(ramp + lighter * (255 - ramp));
  });
  return `rgb(${channels.join(", ")})`;
}

const bandVertexShader = `
attribute float share;
varying float place;
varying vec3 facing;
void main() {
  place = share;
  facing = normalMatrix * normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const bandFragmentShader = `
uniform vec3 ramp[${rampStops.length}];
uniform float limit;
uniform bool contours;
varying float place;
varying vec3 facing;
vec3 colour_at(float share) {
  float along = share * ${rampStops.length - 1}.0;
  vec3 colour = ramp[0];
  for (int i = 1; i < ${rampStops.length}; ++i) colour = mix(colour, ramp[i], clamp(along - float(i - 1), 0.0, 1.0));
  return colour;
}
void main() {
  float band = place * ${bandCount}.0;
  float width = max(fwidth(band), 1e-6);           // bands under a pixel
  float blurred = smoothstep(0.4, 1.2, width);     // too many to tell them apart
  float wave = abs(fract(band * 0.5) * 2.0 - 1.0); // over 1/2 in even bands
  float odd = mix(clamp((0.5 - wave) / width + 0.5, 0.0, 1.0), 0.5, blurred);
  float edge = abs(fract(band + 0.5) - 0.5) / width;  // pixels to the nearest band's end
  float line = mix(1.0 - smoothstep(0.5, 1.5, edge), 0.35, blurred);

  vec3 colour = contours ? mix(vec3(0.96), vec3(0.08), line) : mix(colour_at(place), vec3(1.0), 0.3 * odd);
  if (place > limit) colour = vec3(0.86);
  vec3 normal = normalize(facing) * (gl_FrontFacing ? 1.0 : -1.0);
  float light = 0.62 + 0.42 * max(dot(normal, normalize(vec3(-0.35, 0.6, 0.75))), 0.0);
  float rim = 0.8 + 0.2 * smoothstep(0.0, 0.5, abs(normal.z));
  gl_FragColor = vec4(colour * light * rim, 1.0);
}`;

function bandMaterial() {
  return new THREE.ShaderMaterial({
    uniforms: {
      ramp: { value: rampStops.map((stop) => new THREE.Vector3(...stop).divideScalar(255)) },
      limit: { value: 1 },
      contours: { value: false },
    },
    vertexShader: bandVertexShader,
    fragmentShader: bandFragmentShader,
    extensions: { derivatives: true },
    side: THREE.DoubleSide,
  });
}

/** Makes a legend: the ramp as a strip, from first to last. */
function makeLegend() {
  const strip = make("span", { className: "strip", ariaHidden: "true" });
  for (let band = 0; band < bandCount; ++band) {
    const cell = make("span");
    cell.style.background = bandColour((band + 0.5) / bandCount);
    strip.append(cell);
  }
  return make("p", { className: "legend" }, "first in memory", strip, "last");
}
