# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Shows results as HTML in notebooks. All text is escaped; colours suit light and dark pages."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from . import _core, _thumbnails

if TYPE_CHECKING:
    from ._graphs import Fiedler, Order, Quality
    from ._meshes import Mesh, MeshOrder
    from ._payoff import Advice, Candidate
    from ._permutation import Permutation

_BAR = "rgba(76,139,205,.42)"
_MOST_LINES = 8  # a longer list is cut to this number


def _cell(html: str, style: str = "") -> str:
    return f'<td style="text-align:right;{style}">{html}</td>'


def _words(text: object) -> str:
    return f'<td style="text-align:left">{escape(str(text))}</td>'


def _table(heads: Sequence[str], rows: Iterable[str], caption: str = "") -> str:
    head = "".join(f'<th style="text-align:left">{escape(name)}</th>' for name in heads)
    words = f'<caption style="caption-side:top;text-align:left">{escape(caption)}</caption>' if caption else ""
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    table = f"<table>{words}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    return f'<div style="overflow-x:auto">{table}</div>'


def _beside(picture: str, words: str) -> str:
    return f'<div style="display:flex;gap:.8em;align-items:center">{picture}<div>{words}</div></div>'


def _lines(lines: Iterable[str]) -> str:
    return "".join(f"<div>{line}</div>" for line in lines if line)


def _some(lines: Sequence[str]) -> list[str]:
    """Returns the lines. Of a long list it returns the first lines and the number of the others."""
    if len(lines) <= _MOST_LINES:
        return list(lines)
    return [*lines[: _MOST_LINES - 1], f"and {len(lines) - _MOST_LINES + 1:,} more"]


def permutation(of: Permutation) -> str:
    """Shows a picture of the moves, and their mean distance."""
    picture = _thumbnails.image(_thumbnails.moves(of.old_to_new), "old places from the left, new ones from the top")
    return _beside(picture, escape(repr(of)[1:-1]))


def order(of: Order) -> str:
    """Shows a picture of the moves, and the order's method, reason and notes."""
    picture = _thumbnails.image(_thumbnails.moves(of.old_to_new), "old places from the left, new ones from the top")
    head = f"Order of {len(of.permutation):,} by <b>{escape(of.method)}</b> in {of.seconds:.3g} s"
    unfinished = "" if of.complete else "incomplete: the time limit ended it"
    return _beside(picture, _lines([head, escape(of.reason), unfinished, *map(escape, _some(of.notes))]))


def mesh_order(of: MeshOrder) -> str:
    """Shows the orders of vertices and cells."""
    return _lines([f"<b>vertices</b>{order(of.vertices)}", f"<b>cells</b>{order(of.cells)}"])


def quality(of: Quality) -> str:
    """Shows the numbers as a table, and the histogram as bars."""
    most = max(of.histogram_log2, default=0) or 1
    bars = "".join(
        f'<span title="spans of {2**k:,} to {2 ** (k + 1) - 1:,}: {edges:,} edges" style="display:inline-block;'
        f"width:10px;height:{max(round(48 * edges / most), 1)}px;margin-right:1px;vertical-align:bottom;"
        f'background:{_BAR}"></span>'
        for k, edges in enumerate(of.histogram_log2)
    )
    numbers = {
        "edges": f"{of.edges:,}",
        "mean span": f"{of.mean_span:,.1f}",
        "mean log₂ span": f"{of.mean_log2_span:.2f}",
        "lines first read out of order": f"{100 * of.jump_share:.0f} %",
        "bandwidth": f"{of.bandwidth:,}",
        "profile": f"{of.profile:,}",
    }
    table = _table(list(numbers), ["".join(map(_cell, numbers.values()))])
    return _lines([table, f"{bars} edges by span: 1, 2–3, 4–7, …" if bars else ""])


def fiedler(of: Fiedler) -> str:
    """Shows the eigensolver's report on the largest components."""
    shown = of.components[:_MOST_LINES]
    rows = [
        "".join(
            map(
                _cell,
                (
                    f"{one.size:,}", f"{one.lambda2:.6g}", f"{one.residual:.2g}", f"{one.iterations:,}",
                    "yes" if one.converged else "<b>no</b>",
                ),
            )
        )
        for one in shown
    ]  # fmt: skip
    left = len(of.components) - len(shown)
    table = _table(("vertices", "λ₂", "residual", "iterations", "converged"), rows)
    more = f"and {left:,} smaller components" if left else ""
    return _lines([escape(repr(of)[1:-1]), table, more, *map(escape, _some(of.notes))])


def mesh(of: Mesh) -> str:
    """Shows what the mesh holds, as a table."""
    types, counts = np.unique(np.stack([of.shapes, np.diff(of.offsets)]), axis=1, return_counts=True)
    names = [
        f"{count:,} × {_core.shapes[shape]} of {width:,}" for (shape, width), count in zip(types.T.tolist(), counts.tolist())
    ]
    parts = {
        "vertices": [f"{len(of.points):,}"],
        "cells": _some(names),
        "arrays of vertices": _some(sorted(of.point_data)),
        "arrays of cells": _some(sorted(of.cell_data)),
        "sets": _some([f"{name} ({len(members):,})" for name, members in sorted(of.sets.items())]),
        "format": [of.format] if of.format else [],
        "notes": _some(of.notes),
    }
    rows = [_words(name) + _words(", ".join(values)) for name, values in parts.items() if values]
    return _table(("Mesh", ""), rows)


def candidates(of: Sequence[Candidate], kernels: Sequence[str]) -> str:
    """Shows a row for each order: its sparsity pattern, its mean span, and bars for the kernels' times."""
    slowest = {kernel: max((one.milliseconds[kernel] for one in of), default=0.0) or 1.0 for kernel in kernels}
    most = max((int(one.pattern.max()) for one in of if one.pattern.size), default=1)
    rows = []
    for one in of:
        name = f"{one.vertices}, {one.elements}"
        cells = f"<td>{_thumbnails.image(one.pattern, f'sparsity pattern: {name}', most)}</td>"
        cells += _words(one.vertices) + _words(one.elements) + _cell(f"{one.spans.mean_span:,.1f}")
        for kernel in kernels:
            part = 100 * one.milliseconds[kernel] / slowest[kernel]
            bar = (
                f"min-width:6em;padding:.3em .5em;background:linear-gradient({_BAR},{_BAR}) left/{part:.0f}% 1.6em "
                "no-repeat content-box"
            )
            cells += _cell(f"{one.milliseconds[kernel]:.3g} ms", bar)
        rows.append(cells + _cell(f"{1e3 * one.order_seconds:.3g} ms" if one.order_seconds else "–"))
    how = "measured here" if of and of[0].measured else "predicted, to be compared with each other only"
    return _table(("", "vertices", "elements", "mean span", *kernels, "ordering"), rows, f"Times of the kernels: {how}")


def advice(of: Advice, kernels: Sequence[str]) -> str:
    """Shows the verdict, and below it the candidates."""
    verdict = re.sub("`([^`]*)`", r"<code>\1</code>", escape(of.verdict))
    return _lines([f"<b>{verdict}</b>", candidates([of.as_is, *of.candidates], kernels)])


def gpu_comparison(verdict: str, gpu: str, rows: Sequence[Sequence[str]]) -> str:
    """Shows the verdict of a comparison on a GPU, and below it its table, whose first two rows are titles."""
    words = re.sub("`([^`]*)`", r"<code>\1</code>", escape(verdict)).replace("\n", "<br>")
    groups, titles, *rest = rows
    heads = [f"{group} {title}".strip() for group, title in zip(groups, titles)]
    body = [_words(row[0]) + "".join(_cell(escape(cell)) for cell in row[1:]) for row in rest]
    return _lines([f"<b>{words}</b>", _table(heads, body, f"{gpu}: how many times faster than in the file's order")])
