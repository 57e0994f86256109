// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// How Sphinx's search ranks what it finds: the glossary before guides, the changelog and large tables last.
var Scorer = {
  score: ([docname, title, anchor, descr, score, filename, kind]) => {
    if (docname === "glossary" || docname === "which") return score + 4;
    if (/^(changelog|contributing|benchmarks|reproduction\/tables)$/.test(docname)) return score - 3;
    return score;
  },
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
