// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// What a mesh looks like in each order, with orders that come to the same shown once.

function sameNumbers(a, b) {
  return a === b || (a.length === b.length && a.every((number, i) => number === b[i]));
}

/** Promises the orders' arrays as [{titles, names, numbers, array}]; equal ones are one entry. */
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

/** The mean edge span of an order, in words; empty where the results do not say. */
function spanWords(results, mesh, ordering) {
  const record = ((results && results.meshes) || []).find((one) => one.name === mesh);
  const order = record && (record.orders || []).find((one) => one.ordering === ordering);
  const mean = order && order.span && order.span.mean;
  return typeof mean === "number" ? `mean span ${grouped(mean)}` : "";
}

/** A picture with the names of its orders below. */
function orderFigure(canvas, group, words) {
  const caption = make("figcaption", {}, make("strong", {}, group.titles.join(", ")));
  if (words) caption.append(make("span", {}, words));
  return make("figure", { className: "order" }, canvas, caption);
}
