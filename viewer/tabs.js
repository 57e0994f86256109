// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"use strict";
// The page's parts as tabs. Without scripts, and on paper, they stand one after another.

const shownListeners = new Map();

/** Calls `listener` now if the part of that id is shown, and each time that it is shown later. */
function whenShown(id, listener) {
  shownListeners.set(id, listener);
  const panel = document.getElementById(id);
  if (panel && panel.classList.contains("current")) listener();
}

function holdsSomething(panel) {
  const visible = (element) => getComputedStyle(element).display !== "none";
  return [...panel.querySelectorAll("table, figure, .view, .findings > *")].some(visible);
}

function showTab(tabs, shown) {
  for (const tab of tabs) {
    const current = tab === shown;
    const panel = document.getElementById(tab.hash.slice(1));
    tab.setAttribute("aria-selected", String(current));
    tab.tabIndex = current ? 0 : -1;
    panel.classList.toggle("current", current);
  }
  const list = shown.parentElement;
  list.scrollTo({ left: shown.offsetLeft - (list.clientWidth - shown.offsetWidth) / 2 });
  const listener = shownListeners.get(shown.hash.slice(1));
  if (listener) listener();
}

function startTabs() {
  const list = document.querySelector("nav.tabs");
  const tabs = [];
  for (const tab of list.querySelectorAll("a")) {
    const panel = document.getElementById(tab.hash.slice(1));
    panel.classList.add("current");  // a hidden part seems to be empty
    const kept = getComputedStyle(tab).display !== "none" && holdsSomething(panel);
    panel.classList.remove("current");
    if (!kept) {
      tab.remove();
      panel.remove();
      continue;
    }
    tab.id = `tab-${panel.id}`;
    tab.setAttribute("role", "tab");
    tab.setAttribute("aria-controls", panel.id);
    panel.setAttribute("role", "tabpanel");
    panel.setAttribute("aria-labelledby", tab.id);
    tabs.push(tab);
  }
  list.setAttribute("role", "tablist");

  const named = () => tabs.find((tab) => tab.hash === location.hash) || tabs[0];
  const go = (tab) => {
    history.replaceState(null, "", tab.hash);
    showTab(tabs, tab);
    if (list.getBoundingClientRect().top <= 0) list.nextElementSibling.scrollIntoView();
  };
  list.addEventListener("click", (event) => {
    const tab = event.target.closest("a");
    if (!tab || event.ctrlKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    go(tab);
  });
  list.addEventListener("keydown", (event) => {
    const at = tabs.indexOf(document.activeElement);
    const next = {
      ArrowRight: (at + 1) % tabs.length,
      ArrowLeft: (at + tabs.length - 1) % tabs.length,
      Home: 0,
      End: tabs.length - 1,
    }[event.key];
    if (at < 0 || next === undefined) return;
    event.preventDefault();
    go(tabs[next]);
    tabs[next].focus({ preventScroll: true });
  });
  window.addEventListener("hashchange", () => showTab(tabs, named()));
  showTab(tabs, named());
}
