// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// Tables that are sorted by a click on a heading: up, down, and back to how they came.

const sortStates = ["none", "ascending", "descending"];

/** What a cell is sorted by: its number, or its words. */
function cellKey(cell) {
  if (cell.dataset.value !== undefined && cell.dataset.value !== "") return Number(cell.dataset.value);
  return cell.textContent.trim();
}

/** Numbers before words; cells without anything last, whichever way round. */
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
}

function makeSortable(table) {
  const heads = table.tHead ? [...table.tHead.rows[table.tHead.rows.length - 1].cells] : [];
  const rows = table.tBodies[0] ? [...table.tBodies[0].rows] : [];
  if (rows.length < 2) return;
  rows.forEach((row, i) => { row.dataset.came = i; });
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

/** Numbers stand right, below their heading; a caption stays within sight while its table is scrolled. */
function arrangeTable(table) {
  const rows = table.tBodies[0] ? [...table.tBodies[0].rows] : [];
  const heads = table.tHead ? table.tHead.rows[table.tHead.rows.length - 1].cells : [];
  for (let column = 1; column < heads.length; ++column) {
    const cells = rows.map((row) => row.cells[column]).filter((cell) => cell);
    if (!cells.some((cell) => cell.dataset.value !== undefined)) continue;
    for (const cell of [heads[column], ...cells]) cell.classList.add("number");
  }
  if (table.caption) {
    const words = document.createElement("div");
    words.className = "caption";
    words.append(...table.caption.childNodes);
    table.caption.append(words);
  }
}

function startTables() {
  for (const table of document.querySelectorAll("main table")) {
    arrangeTable(table);
    makeSortable(table);
  }
  for (const box of document.querySelectorAll(".scroll")) {
    if (box.firstElementChild) box.tabIndex = 0;  // so that keys can scroll it
    else box.remove();
  }
}
