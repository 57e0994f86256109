# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Draws results with matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core, _thumbnails
from ._extras import load

if TYPE_CHECKING:
    from ._graphs import Order, Quality
    from ._payoff import Candidate

_COLOURS = ("#224c8a", "#16928a", "#8cbf4a", "#e0a93b")  # can be told apart without colour vision


def _axes(given: Any, **figure: Any) -> Any:
    """Returns the Axes given, or those of a new figure."""
    return given if given is not None else load("matplotlib.pyplot", "plot").subplots(layout="constrained", **figure)[1]


def candidates(of: Sequence[Candidate], kernels: Sequence[str], axes: Any = None) -> Any:
    """Draws a bar for each kernel and order; see `meshorder.Comparison.plot`."""
    axes = _axes(axes, figsize=(1.6 + 1.5 * len(of), 3.6))
    width = 0.8 / len(kernels)
    for k, (kernel, colour) in enumerate(zip(kernels, _COLOURS)):
        before = of[0].milliseconds[kernel] or 1.0
        heights = [one.milliseconds[kernel] / before for one in of]
        axes.bar(np.arange(len(of)) + (k - (len(kernels) - 1) / 2) * width, heights, width, color=colour, label=kernel)
    axes.axhline(1, color="0.5", linewidth=0.8, linestyle="--")
    axes.set_xticks(range(len(of)), [f"{one.vertices}\n{one.elements}" for one in of])
    axes.set_ylabel(f"time / time as it is, {'measured' if of[0].measured else 'predicted'}")
    axes.legend(ncols=len(kernels), loc="lower center", bbox_to_anchor=(0.5, 1), frameon=False)
    return axes


def patterns(of: Order, offsets: Any, neighbours: Any, side: int, axes: Any = None) -> Any:
    """Draws the sparsity pattern before and after an order; see `meshorder.Order.plot`."""
    axes = _axes(axes, ncols=2, figsize=(8, 4.2))
    identity = _core.Permutation.from_old_to_new(np.arange(len(of.permutation), dtype=np.int32))
    n = len(of.permutation)
    counts = [_thumbnails.pattern(offsets, neighbours, one, side) for one in (identity, of.permutation._handle)]
    most = max(int(one.max(initial=0)) for one in counts)
    for one, pattern, title in zip(axes, counts, ("as it is", of.method)):
        shares = _thumbnails.ink(pattern, most)
        one.imshow(shares, cmap="Blues", vmin=0, vmax=1, extent=(0, n, n, 0), interpolation="nearest")
        one.set_title(title)
    return axes


def quality(of: Quality, axes: Any = None) -> Any:
    """Draws the histogram of spans; see `meshorder.Quality.plot`."""
    axes = _axes(axes, figsize=(6, 3.4))
    spans = range(len(of.histogram_log2))
    axes.bar(spans, of.histogram_log2, width=0.92, color=_COLOURS[0])
    axes.set_xticks(spans, [f"{2**k:,}" for k in spans], rotation=90)
    axes.set_xlabel("span: from this number to below the next")
    axes.set_ylabel("edges")
    return axes
