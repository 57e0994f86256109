// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// The page: takes files, lets a worker order them, and shows and saves the result. Texts from files and from the worker
// are inserted as text only, never as HTML.

const largestFile = 600 * 2 ** 20;  // bytes; reading and ordering take several times as much
const methods = ["auto", "hilbert-fronts", "hilbert", "rcm", "bfs", "spectral", "spectral-fronts", "original"];
const stages = { reading: "reading", check: "checking", graph: "joining neighbours", coarsen: "ordering",
  eigenvector: "ordering", improve: "ordering", sort: "sorting", move: "moving", writing: "writing" };

const page = { wasm: null, worker: null, files: [], view: null, made: 0, result: null };

function element(id) {
  return document.getElementById(id);
}

/** Promises the module, compiled once. */
function compiledModule() {
  page.wasm = page.wasm || unpackBlob("wasm").then((bytes) => WebAssembly.compile(bytes));
  return page.wasm;
}

/** Returns "ordered-part.msh". */
function orderedName(name) {
  return `ordered-${name}`;
}

/** Promises a dropped file as {name, bytes}, unpacked if it is a gzip file. */
async function readFile(file) {
  if (file.size > largestFile) {
    throw new Error(`${file.name}: has ${grouped(file.size / 2 ** 20)} MiB, more than the ${largestFile / 2 ** 20} MiB ` +
      "that this page takes; the command meshorder orders larger meshes");
  }
  if (!/\.gz$/i.test(file.name)) return { name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) };
  const unpacked = file.stream().pipeThrough(new DecompressionStream("gzip"));
  const bytes = await new Response(unpacked).arrayBuffer().catch(() => {
    throw new Error(`${file.name}: is not a whole gzip file; the file may be damaged`);
  });
  return { name: file.name.slice(0, -3), bytes: new Uint8Array(bytes) };
}

/** Promises a worker's result for a request; calls `onStage` with its progress. A later call ends this one. */
function orderInWorker(wasm, request, onStage) {
  if (page.worker) page.worker.terminate();
  const source = URL.createObjectURL(new Blob([element("worker").textContent], { type: "text/javascript" }));
  const worker = page.worker = new Worker(source);
  URL.revokeObjectURL(source);
  return new Promise((resolve) => {
    worker.onmessage = ({ data }) => {
      if (!data.result) onStage(data);
      else {
        worker.terminate();
        resolve(data.result);
      }
    };
    worker.postMessage({ wasm, request });
  });
}

function showError(message) {
  if (page.worker) page.worker.terminate();
  element("result").hidden = true;
  element("state").textContent = "";
  element("progress").hidden = true;
  element("error").textContent = message;
  element("error").hidden = false;
  document.body.dataset.state = "failed";
}

/** Returns the sentence on the spans. */
function gainWords([before, after]) {
  const spans = `the mean distance between neighbours is ${grouped(before)} before and ${grouped(after)} after`;
  if (before > 1.02 * after) return `Neighbours are ${(before / after).toPrecision(2)} times nearer in memory: ${spans}.`;
  return `The order brings nothing here: ${spans}.`;
}

/** Shows the surface in both orders. */
function showSurface(name, result) {
  const root = element("mesh-view");
  if (page.view) for (const picture of page.view.pictures) picture.geometry.dispose();
  page.view = null;
  if (!result.places) {
    root.replaceChildren(make("p", { className: "notice" }, "This mesh has no surface to show."));
    return;
  }
  const array = (part, values = {}) => {
    const blob = `${part}-${++page.made}`;
    unpackedBlobs.set(blob, Promise.resolve(result[part]));
    return { blob, ...values };
  };
  unpackedBlobs.clear();
  const positions = array("places", { shape: [result.places.length / 3, 3], offset: [0, 0, 0], scale: [1, 1, 1] });
  const mesh = { name, vertices: result.counts[0], positions, triangles: array("triangles"),
    ranks: { before: array("before"), after: array("after") } };
  const orders = ["before", "after"].map((order, i) => ({ ordering: order, span: { mean: result.spans[i] } }));
  const orderings = [{ name: "before", title: "as it is" }, { name: "after", title: "ordered" }];
  page.view = new MeshView(root, { meshes: [mesh], orderings }, { meshes: [{ name, orders }] });
  return page.view.ready;
}

async function showResult(name, result) {
  element("result").hidden = false;
  element("name").textContent = name;
  element("summary").textContent = `${grouped(result.counts[0])} vertices · ${result.cells}`;
  element("gains").textContent = gainWords(result.spans);
  element("save").textContent = `Save ${result.files.map((file) => file.name).join(", ")}`;
  element("lines").textContent = result.lines;
  element("notes").replaceChildren(...result.notes.split("\n").filter((note) => note).map((note) => make("li", {}, note)));
  await showSurface(name, result);
}

/** Orders the page's files by the chosen method. */
async function orderNow() {
  document.body.dataset.state = "busy";
  element("error").hidden = true;
  element("result").hidden = true;
  element("progress").hidden = false;
  element("progress").value = 0;
  const [{ name }] = page.files;
  const request = { files: page.files, input: name, output: orderedName(name), vertices: page.method, elements: "auto" };
  const onStage = ({ stage, share }) => {
    element("state").textContent = `${name}: ${stages[stage] || stage} …`;
    element("progress").value = share;
  };
  onStage({ stage: "reading", share: 0 });
  const began = performance.now();
  const result = await orderInWorker(await compiledModule(), request, onStage);
  if (result.error) throw new Error(result.error);
  page.result = result;
  element("progress").hidden = true;
  element("state").textContent = `read, ordered and written in ${((performance.now() - began) / 1000).toPrecision(2)} s`;
  await showResult(name, result);
  document.body.dataset.state = "done";
}

async function takeFiles(list) {
  if (list.length === 0) return;
  try {
    page.files = await Promise.all([...list].map(readFile));
    await orderNow();
  } catch (failure) {
    showError(failure.message);
  }
}

function save() {
  for (const { name, bytes } of page.result.files) {
    const address = URL.createObjectURL(new Blob([bytes], { type: "application/octet-stream" }));
    make("a", { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
  }
}

function startPage() {
  const drop = element("drop");
  for (const name of ["dragover", "drop"]) document.addEventListener(name, (event) => event.preventDefault());
  document.addEventListener("dragover", () => drop.classList.add("over"));
  for (const name of ["dragleave", "drop"]) document.addEventListener(name, () => drop.classList.remove("over"));
  document.addEventListener("drop", (event) => takeFiles(event.dataTransfer.files));
  element("file").addEventListener("change", () => takeFiles(element("file").files));
  element("save").addEventListener("click", save);
  page.method = methods[0];
  element("controls").append(makeChoices("Order of the vertices", methods.map((name) => [name, name]), (name) => {
    page.method = name;
    orderNow().catch((failure) => showError(failure.message));
  }));
  page.files = [makeBall()];
  orderNow().catch((failure) => showError(failure.message));
}
