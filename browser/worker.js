// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Orders one mesh, off the page's thread. A worker serves one request, since its memory never shrinks.

/** Promises the module with memory of its own. */
function startModule(wasm) {
  return new Promise((resolve, reject) => {
    meshorderModule({
      instantiateWasm(imports, receive) {
        WebAssembly.instantiate(wasm, imports).then(receive).catch(reject);
        return {};
      },
      tell: (stage, share) => postMessage({ stage, share }),
    }).then(resolve, reject);
  });
}

onmessage = async ({ data: { wasm, request } }) => {
  try {
    const result = orderFiles(await startModule(wasm), request);
    const numbers = Object.values(result).filter((value) => ArrayBuffer.isView(value));
    const bytes = (result.files || []).map((file) => file.bytes);
    postMessage({ result }, [...numbers, ...bytes].map((array) => array.buffer));
  } catch (failure) {
    postMessage({ result: { error: `the ordering ended: ${failure.message}` } });
  }
};
