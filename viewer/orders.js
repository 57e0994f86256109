// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Pictures of a mesh in each order. Orders with the same numbers share a picture.

function sameNumbers(a, b) {
  return a === b || (a.length === b.length && a.every((number, i) => number === b[i]));
}

/** Promises the orders' arrays as [{titles, names, numbers, array}]; orders with equal numbers share an entry. */
async function loadByOrder(orderings, arrays) {
  const groups = [];
  for (const { name, title } of orderings) {
    if (!arrays[name]) continue;
    const numbers = await loadNumbers(arrays[name]);
    const known = groups.find((group) => sameNumbers(group.numbers, numbers));
    if (known) {
      known.titles.push(title);
      known.names.push(name);
    } else {
      groups.push({ titles: [title], names: [name], numbers, array: arrays[name] });
    }
  }
  return groups;
}

/** Returns a picture with the names of its orders below. */
function orderFigure(canvas, group, words) {
  const caption = make("figcaption", {}, make("strong", {}, group.titles.join(", ")));
  if (words) caption.append(make("span", {}, words));
  return make("figure", { className: "order" }, canvas, caption);
}

/** Promises a mesh's surface and its orders: {mesh, surface, groups, view}. */
async function loadOrderedMesh(manifest, name) {
  const mesh = manifest.meshes.find((one) => one.name === name);
  const places = await loadPlaces(mesh.positions);
  return {
    mesh,
    surface: surfaceGeometry(places, await loadNumbers(mesh.triangles)),
    groups: await loadByOrder(manifest.orderings, mesh.ranks),
    view: ballAround(places),
  };
}

/** Returns a surface coloured by one of its orders, ready to be drawn: {geometry, scene, canvas, figure}. */
function orderPicture({ mesh, surface }, group, material, words) {
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(surface.index);
  for (const name of ["position", "normal"]) geometry.setAttribute(name, surface.getAttribute(name));
  const shares = Float32Array.from(group.numbers, (rank) => (rank + 0.5) / mesh.vertices);
  geometry.setAttribute("share", new THREE.BufferAttribute(shares, 1));
  const scene = new THREE.Scene();
  scene.add(new THREE.Mesh(geometry, material));
  const canvas = make("canvas", { role: "img" });
  canvas.setAttribute("aria-label", `${mesh.name}, coloured by its vertices' order: ${group.titles.join(", ")}`);
  return { geometry, scene, canvas, figure: orderFigure(canvas, group, words) };
}
