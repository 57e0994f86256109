// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Tables that a click on a heading sorts: ascending, descending, and as they were. Long ones can be filtered.

const sortStates = ["none", "ascending", "descending"];
const longTable = 16;  // rows from which on a table can be filtered

/** Returns the key by which a cell is sorted: its number, or its words. */
function cellKey(cell) {
  if (cell.dataset.value !== undefined && cell.dataset.value !== "") return Number(cell.dataset.value);
  return cell.textContent.trim();
}

/** Compares two keys: numbers before words, empty cells last in both directions. */
function compareKeys(a, b, direction) {
  if (a === "" || b === "") return (a === "") - (b === "");
  if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
  return direction * (typeof a === "number" ? a - b : a.localeCompare(b, undefined, { numeric: true }));
}

function sortTable(table, column, state) {
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const came = (row) => Number(row.dataset.came);
  const direction = state === "descending" ? -1 : 1;
  const cell = (row) => (row.cells[column] ? cellKey(row.cells[column]) : "");
  rows.sort((a, b) => {
    const order = state === "none" ? 0 : compareKeys(cell(a), cell(b), direction);
    return order || came(a) - came(b);
  });
  body.append(...rows);
  markGroups(table, state === "none" || column === 0);
}

/** Marks as a group the rows whose heads differ only in the part after the last comma: "falling, Original". */
function markGroups(table, wanted) {
  let last = null;
  for (const row of table.tBodies[0].rows) {
    const words = row.cells[0].textContent.split(", ");
    const group = words.length > 1 ? words.slice(0, -1).join(", ") : null;
    row.classList.toggle("grouped", wanted && group !== null);
    row.classList.toggle("begins", wanted && group !== last && last !== null);
    last = group;
  }
}

function makeSortable(table) {
  const heads = table.tHead ? [...table.tHead.rows[table.tHead.rows.length - 1].cells] : [];
  const rows = table.tBodies[0] ? [...table.tBodies[0].rows] : [];
  if (rows.length < 2) return;
  rows.forEach((row, i) => { row.dataset.came = i; });
  markGroups(table, true);
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "sort";
    button.append(...head.childNodes);
    head.append(button);
    head.setAttribute("aria-sort", "none");
    button.addEventListener("click", () => {
      const state = sortStates[(sortStates.indexOf(head.getAttribute("aria-sort")) + 1) % 3];
      for (const other of heads) other.setAttribute("aria-sort", "none");
      head.setAttribute("aria-sort", state);
      sortTable(table, column, state);
    });
  });
}

/** Keeps a caption in sight while its table is scrolled. */
function holdCaption(table) {
  if (!table.caption) return;
  const words = make("div", { className: "caption" });
  words.append(...table.caption.childNodes);
  table.caption.append(words);
}

/** Adds a field above a long table; only the rows that contain all words in it are shown. */
function makeFilter(table) {
  const rows = table.tBodies[0] ? [...table.tBodies[0].rows] : [];
  if (rows.length < longTable || !table.querySelector(".number")) return;
  const words = rows.map((row) => row.textContent.toLowerCase());
  const input = make("input", { type: "search", placeholder: rows[1].cells[0].textContent.replaceAll(",", ""), autocomplete: "off" });
  const count = make("output", {});
  input.addEventListener("input", () => {
    const wanted = input.value.toLowerCase().split(/\s+/);
    rows.forEach((row, i) => { row.hidden = !wanted.every((word) => words[i].includes(word)); });
    count.textContent = input.value.trim() ? `${rows.filter((row) => !row.hidden).length} of ${rows.length}` : "";
  });
  table.caption.append(make("label", { className: "control filter" }, make("span", {}, "Rows with"), input, count));
}

function startTables() {
  for (const table of document.querySelectorAll("main table")) {
    holdCaption(table);
    makeSortable(table);
    makeFilter(table);
  }
  for (const box of document.querySelectorAll(".scroll")) {
    if (box.firstElementChild) box.tabIndex = 0;  // so that keys can scroll it
    else box.remove();
  }
}
