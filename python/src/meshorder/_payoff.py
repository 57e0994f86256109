# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Predicts and measures how much faster four kernels of simulators run in other orders of a mesh, or products of a matrix."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _core, _html, _plots
from ._extras import load
from ._files import mesh_of
from ._graphs import Quality, graph_arrays, is_graph
from ._options import prepared
from .hosts import find_host


@dataclass(frozen=True)
class Candidate:
    """An order of a mesh, and the times of the kernels in it.

    The keys of ``predicted`` and ``measured`` are the kernels: "spmv" (a product of the stiffness matrix with a
    vector), "element" (elastic forces of the elements), "assembly" (of the stiffness matrix) and "springs" (forces
    along the edges). A matrix has "spmv" alone: the product with its own entries.

    Attributes:
        vertices: name of the method for the vertices; "original" for the present order of the mesh.
        elements: name of the method for the elements.
        reason: why "auto" chose the method for the vertices; empty if it was requested by name.
        workload: what "auto" optimised.
        spans: spans, bandwidth and profile of the vertex graph in this order.
        pattern: the sparsity pattern of the matrix over the vertices in this order: the number of entries, diagonal
            included, in each of 64 × 64 tiles, n × n if there are fewer vertices; rows from the top. 16 KB.
        predicted: milliseconds of one run of each kernel by a cost model; compare them only with each other. None if
            nothing was predicted.
        measured: milliseconds of one run of each kernel on this machine, the best of interleaved rounds;
            None if nothing was measured.
        order_seconds: cost of the order: the graph, both methods and moving the mesh; 0 for "original".
    """

    vertices: str
    elements: str
    reason: str
    workload: str
    spans: Quality
    predicted: dict[str, float] | None
    measured: dict[str, float] | None
    order_seconds: float
    pattern: NDArray[np.uint32] = field(repr=False, compare=False)

    @classmethod
    def _of(cls, made: dict[str, Any]) -> Candidate:
        return cls(**{**made, "spans": Quality(**made["spans"])})

    @property
    def milliseconds(self) -> dict[str, float]:
        """The measured times of the kernels, else the predicted ones."""
        return self.measured or self.predicted or {}


class KernelAdvice(NamedTuple):
    """The best candidate for a kernel.

    Attributes:
        candidate: position in ``Advice.candidates`` of the order in which the kernel runs fastest.
        factor: the present time divided by the time in that order; 1 if no order is told apart as faster.
        low: the lower end of the interval of ``factor``, which holds the true one in 95 of 100 measurements.
        high: its upper end.
        runs_to_pay: runs of the kernel after which the order has saved more time than it cost; 0 if nothing is
            gained.
    """

    candidate: int
    factor: float
    low: float
    high: float
    runs_to_pay: float


@dataclass(frozen=True, repr=False)
class Advice:
    """How much faster the kernels would run if a mesh were reordered; ``str(advice)`` is the verdict.

    Attributes:
        verdict: one sentence: which kernel loses most in the present order, which order is better and after how many runs of
            it the order has saved its own cost; or that nothing is gained, or that the gain is not known.
        as_is: the present order of the mesh.
        candidates: other orders; the first is the one that `reorder` chooses without arguments.
        kernels: the best candidate for each kernel, by the kernel's name: its position ``candidate`` in ``candidates``;
            ``factor``, the present time divided by the time in that order; and ``runs_to_pay``, the runs of the
            kernel after which the order has saved more time than it cost. If times are not told apart, ``factor``
            is 1 and ``runs_to_pay`` 0.
        doubt: reason not to trust the measured times (the machine was busy or throttled): then the advice rests on
            predictions. Empty if they are reliable, or if nothing was measured.
        machine: the machine that the predicted times are for: "this machine, calibrated 2026-11-22", "zen3", or "this
            machine's caches at the costs of zen3"; empty if nothing was predicted.
        threads: number of threads that shared each run of a kernel.
    """

    verdict: str
    as_is: Candidate
    candidates: list[Candidate]
    kernels: dict[str, KernelAdvice]
    doubt: str = ""
    machine: str = ""
    threads: int = 1

    def __str__(self) -> str:
        return self.verdict

    def __repr__(self) -> str:
        return f"<Advice: {self.verdict}>"

    def _repr_html_(self) -> str:
        return _html.advice(self, tuple(self.as_is.milliseconds))


class Comparison(Sequence[Candidate]):
    """A sequence of `Candidate`: the present order of a mesh, then the requested ones.

    Its text is a table; a notebook shows it with sparsity patterns and bars.
    """

    def __init__(self, candidates: list[Candidate]) -> None:
        self._candidates = candidates

    def __len__(self) -> int:
        return len(self._candidates)

    def __getitem__(self, place: Any) -> Any:
        return self._candidates[place]

    @property
    def _kernels(self) -> tuple[str, ...]:
        return tuple(self._candidates[0].milliseconds)

    def rows(self) -> list[dict[str, Any]]:
        """Returns a flat dict for each order: methods, mean span, seconds of the order, milliseconds of each kernel."""
        return [
            {
                "vertices": candidate.vertices,
                "elements": candidate.elements,
                "mean span": candidate.spans.mean_span,
                "order seconds": candidate.order_seconds,
                **{f"{kernel} ms": time for kernel, time in candidate.milliseconds.items()},
            }
            for candidate in self
        ]

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame of `rows`, with a row for each order.

        Raises:
            ImportError: pandas is not installed; the extra ``pandas`` installs it.
        """
        return load("pandas", "pandas").DataFrame(self.rows())

    def __repr__(self) -> str:
        times = [f"{kernel} ms" for kernel in self._kernels]
        rows = [["vertices", "elements", "mean span", *times]]
        for row in self.rows():
            numbers = [f"{row['mean span']:,.1f}", *(f"{row[time]:.3g}" for time in times)]
            rows.append([row["vertices"], row["elements"], *numbers])
        widths = [max(map(len, column)) for column in zip(*rows)]
        return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in rows)

    def _repr_html_(self) -> str:
        return _html.candidates(self._candidates, self._kernels)

    def plot(self, axes: Any = None) -> Any:
        """Draws a bar for each kernel and order with matplotlib: the time relative to the time as the mesh is.

        Args:
            axes: the matplotlib Axes to draw on; None: those of a new figure.

        Returns:
            The Axes.

        Raises:
            ImportError: matplotlib is not installed; the extra ``plot`` installs it.
        """
        return _plots.candidates(self._candidates, self._kernels, axes)


def _runs_quickly(handle: Any, machine: str) -> bool:
    """Returns whether the kernels of a mesh or matrix run within seconds on the machine that the times are for."""
    most_corners = 2_000_000  # of half a million tetrahedra, or of a million entries
    named = machine or os.environ.get("MESHORDER_MACHINE", "")
    return handle.connectivity.size <= most_corners and (not named or not machine and named == "this")


def _handle_of(given: Any) -> Any:
    """Returns the library's form of the mesh or matrix that `advise` and `compare` were given."""
    is_path = isinstance(given, (str, os.PathLike))
    host = None if is_path else find_host(given)
    if is_graph(given) or host is not None and host.takes_weights:
        offsets, columns, _ = graph_arrays(given)
        return _core.matrix_mesh(offsets, columns)
    return (mesh_of(given) if host is None else host.mesh())._handle


def _pairs(methods: Any) -> list[tuple[str, str]]:
    """Returns the methods as pairs: the method for the vertices, and the method for the elements."""
    listed = [methods] if isinstance(methods, str) else methods or []
    return [(method, "auto") if isinstance(method, str) else tuple(method) for method in listed]


@dataclass(frozen=True)
class Calibration:
    """The measurements of this machine that `calibrate` made.

    Attributes:
        machine: the name of this machine in ``Advice.machine`` from now on.
        figures: all measured numbers: a thread's share of the caches, latencies, bandwidths, and the costs of cache
            misses for each kernel.
        file: the file that stores them; None if they are not stored.
        doubt: reason not to trust them (the machine was busy or throttled); empty if they are reliable.
    """

    machine: str
    figures: dict[str, Any] = field(repr=False)
    file: Path | None
    doubt: str


def calibrate(seconds: float = 16, *, keep: bool = True, **options: Any) -> Calibration:
    """Measures this machine, so that `advise` and `compare` predict for it from now on.

    Takes about 1 GB of memory. Other work on the machine during the call spoils the measurements.

    Args:
        seconds: > 0: a measurement begins only if it would end in time, but each is made once; 16 take 40 to 60 s.
        keep: True stores the measurements for this processor and this build of the library, in the user's cache folder
            ($MESHORDER_CACHE, else $XDG_CACHE_HOME/meshorder, else ~/.cache/meshorder).
        **options: see `Options`; only ``threads`` and ``progress`` have an effect.

    Returns:
        The measurements.

    Raises:
        InvalidArgument: ``seconds`` is not above 0.
        Error: the measurements cannot be stored.
        Stopped: ``progress`` returned False.
    """
    with prepared(options) as given:
        machine, figures, file, doubt = _core.calibrate(seconds, keep, given)
    return Calibration(machine, json.loads(figures), Path(file) if file else None, doubt)


def advise(
    mesh: Any,
    *,
    measure: bool | None = None,
    kernels: str = "plain",
    budget: float | None = None,
    machine: str = "",
    all_threads: bool = False,
    **options: Any,
) -> Advice:
    """Says how much faster simulators' kernels would run if a mesh or matrix were reordered, without changing it.

    Args:
        mesh: the path of a file; a mesh that `reorder` takes, with lines, surfaces or volumes; or a matrix or graph of
            SciPy, networkx or PyTorch: its product with a vector is the only kernel then, "spmv".
        measure: True runs the kernels on this machine; False predicts their times from reuse distances and a cost model.
            None: they are run if that takes a few seconds, up to half a million tetrahedra or a matrix of a million
            entries, and predicted, too, for the case that the machine is busy; for larger ones, and for a named
            machine, they are only predicted.
        kernels: "plain": as in most programs, one simple loop; "tuned": as in the simulators of
            ``meshorder simulate``, which prefetch, work on blocks, and run alike in all good orders; these
            can only be measured.
        budget: seconds ≥ 0 from the start of the call: a round of measurements begins only if it would end in time, but
            two are run. None: 10 with ``measure=True``, else 2.
        machine: the machine to predict for: "this" machine, as `calibrate` measured it, else its caches with the costs of
            "zen3", which are part of the library; or "zen3". Empty: the environment variable MESHORDER_MACHINE names it,
            else "this".
        all_threads: True: times of kernel runs that all threads (see the option ``threads``) share; False: times on
            one thread. Predictions for all threads need a calibration of this machine on as many threads.
        **options: see `Options`; ``symmetric`` has no effect.

    Returns:
        The verdict, the times in the present and other orders, and the best order for each kernel.

    Raises:
        InvalidArgument: a mesh without lines, surfaces and volumes, a matrix without entries off the diagonal, an unknown
            machine or set of kernels, tuned kernels without measuring or for a matrix, ``workload="gpu"``, a negative
            budget; a prediction for all threads of a machine whose costs for these are not known.
        InputError: the file cannot be read.
        Stopped: ``progress`` returned False.

    Example:
        The verdict of a mesh in a file::

            print(meshorder.advise("dragon.msh"))
    """
    with prepared(options) as given:
        handle = _handle_of(mesh)
        measured = _runs_quickly(handle, machine) if measure is None else measure
        seconds = (10 if measure else 2) if budget is None else budget
        # a busy machine gives no reliable times; then predictions decide
        predicts = not measured or measure is None and kernels == "plain" and not all_threads
        made = handle.advise([], predicts, measured, kernels, seconds, machine, all_threads, given)
    verdict, as_is, candidates, best_of, doubt, predicted_for, threads = made
    return Advice(
        verdict,
        Candidate._of(as_is),
        [Candidate._of(candidate) for candidate in candidates],
        {kernel: KernelAdvice(*best) for kernel, best in best_of.items()},
        doubt,
        predicted_for,
        threads,
    )


def compare(
    mesh: Any,
    methods: Any = None,
    *,
    measure: bool = False,
    kernels: str = "plain",
    budget: float = 10,
    predict: bool = True,
    machine: str = "",
    all_threads: bool = False,
    **options: Any,
) -> Comparison:
    """Compares orders of a mesh or matrix by their spans and the times of four kernels of simulators. The mesh is not changed.

    Args:
        mesh: the path of a file; a mesh that `reorder` takes, with lines, surfaces or volumes; or a matrix or graph of
            SciPy, networkx or PyTorch: its product with a vector is the only kernel then, "spmv".
        methods: the name of a vertex method, or a list of names, to which the element method "auto" is added, or of pairs
            ``(vertex method, element method)``; None: the choices of "auto" for all kernels, and for springs if these
            differ.
        measure: True runs the kernels on this machine.
        kernels: "plain" or "tuned", as for `advise`; nothing is predicted for the latter.
        budget: with ``measure``, seconds from the start of the call, as for `advise`.
        predict: True predicts the times from reuse distances and a cost model.
        machine: the machine to predict for, as for `advise`.
        all_threads: whether all threads share each run, as for `advise`.
        **options: see `Options`; ``symmetric`` has no effect.

    Returns:
        The present order of the mesh, then one for each method.

    Raises:
        InvalidArgument: as `advise`; an unknown method; neither ``measure`` nor ``predict``.
        InputError: the file cannot be read.
        Stopped: ``progress`` returned False.

    Example:
        A table in a notebook, or printed::

            meshorder.compare("dragon.msh", ["rcm", ("hilbert", "original")])
    """
    with prepared(options) as given:
        made = _handle_of(mesh).compare(
            _pairs(methods), predict and kernels == "plain", measure, kernels, budget, machine, all_threads, given
        )
    return Comparison([Candidate._of(candidate) for candidate in made])
