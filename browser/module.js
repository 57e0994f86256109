// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// The calls of order.cpp, for the worker and for tests by Node.

const partTypes = {
  places: Float32Array, triangles: Uint32Array, before: Uint32Array, after: Uint32Array, spans: Float64Array,
  counts: Float64Array,
};

/** Returns a part of the last result: numbers, the bytes of a file, or a text. */
function takePart(module, part, name) {
  const from = module._part_data(part) >>> 0;
  const bytes = module.HEAPU8.slice(from, from + (module._part_size(part) >>> 0));
  if (name.startsWith("file:")) return bytes;
  return partTypes[name] ? new partTypes[name](bytes.buffer) : new TextDecoder().decode(bytes);
}

/**
 * Orders one of the files of a request: {files: [{name, bytes}], input, output, vertices, elements}. Returns {error},
 * or {lines, notes, cells, spans, counts, files} and, of a mesh with a surface, {places, triangles, before, after}.
 */
function orderFiles(module, request) {
  for (const { name, bytes } of request.files) {
    const place = module.ccall("give_file", "number", ["string", "number"], [name, bytes.length]) >>> 0;
    if (place === 0) return { error: `${name}: is larger than the memory that a page may have; the command orders it` };
    module.HEAPU8.set(bytes, place);
  }
  module.ccall("order_file", null, ["string", "string", "string", "string"],
    [request.input, request.output, request.vertices, request.elements]);
  const result = { files: [] };
  for (let part = 0; part < module._part_count(); ++part) {
    const name = module.UTF8ToString(module._part_name(part));
    const value = takePart(module, part, name);
    if (name.startsWith("file:")) result.files.push({ name: name.slice("file:".length), bytes: value });
    else result[name] = value;
  }
  return result;
}
