// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Orders one mesh, off the page's thread. A worker serves one request, since its memory never shrinks.

onmessage = async ({ data: { wasm, request } }) => {
  const module = await meshorderModule({
    instantiateWasm(imports, receive) {
      WebAssembly.instantiate(wasm, imports).then(receive);
      return {};
    },
    tell: (stage, share) => postMessage({ stage, share }),
  });
  const result = orderFiles(module, request);
  const numbers = Object.values(result).filter((value) => ArrayBuffer.isView(value));
  const bytes = result.files.map((file) => file.bytes);
  postMessage({ result }, [...numbers, ...bytes].map((array) => array.buffer));
};
