# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""What other orders of a mesh are worth."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _core, _html, _plots
from ._extras import load
from ._files import mesh_of
from ._graphs import Quality
from ._options import prepared

KERNELS: tuple[str, ...] = _core.kernels


@dataclass(frozen=True)
class Candidate:
    """An order of the mesh, and what the kernels take in it.

    Attributes:
        vertices, elements: the methods.
        reason: why "auto" took the method for the vertices.
        workload: what "auto" chose for.
        spans: of the vertex graph in this order.
        pattern: of the matrix over the vertices in this order: the number of entries, diagonal included, in each of
            64 × 64 tiles, rows from the top; n × n where there are fewer vertices. 16 KB, counted in O(entries).
        predicted: milliseconds of each kernel by the cost model, to be compared with each other only; or None.
        measured: milliseconds of each kernel here, the best of interleaved rounds; or None.
        order_seconds: cost of the order.
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
        """The measured times, else the predicted ones."""
        return self.measured or self.predicted or {}


class KernelAdvice(NamedTuple):
    """The best candidate for a kernel: its place, how many times faster it is, runs until it has paid."""

    candidate: int
    factor: float
    runs_to_pay: float


@dataclass(frozen=True, repr=False)
class Advice:
    """What reordering a mesh would be worth; ``str(advice)`` is the verdict in one sentence.

    Attributes:
        verdict: the sentence.
        as_is: the order that the mesh has.
        candidates: other orders; the first is what `order_mesh` does without arguments.
        kernels: the best candidate for each kernel.
        doubt: why measured times are not to be trusted (the machine was busy or throttled); empty where they are, and
            where nothing was measured.
        machine: what the predicted times are those of: "this machine, calibrated 2026-11-22", "zen5", or "this machine's
            caches at the costs of zen5"; empty where nothing was predicted.
    """

    verdict: str
    as_is: Candidate
    candidates: list[Candidate]
    kernels: dict[str, KernelAdvice]
    doubt: str = ""
    machine: str = ""

    def __str__(self) -> str:
        return self.verdict

    def __repr__(self) -> str:
        return f"<Advice: {self.verdict}>"

    def _repr_html_(self) -> str:
        return _html.advice(self, KERNELS)


class Comparison(Sequence[Candidate]):
    """Orders of a mesh: the one that it has, then those asked for."""

    def __init__(self, candidates: list[Candidate]) -> None:
        self._candidates = candidates

    def __len__(self) -> int:
        return len(self._candidates)

    def __getitem__(self, place: Any) -> Any:
        return self._candidates[place]

    def rows(self) -> list[dict[str, Any]]:
        """A flat dict for each order."""
        return [
            {
                "vertices": candidate.vertices,
                "elements": candidate.elements,
                "mean span": candidate.spans.mean_span,
                "order seconds": candidate.order_seconds,
                **{f"{kernel} ms": candidate.milliseconds[kernel] for kernel in KERNELS},
            }
            for candidate in self
        ]

    def to_pandas(self) -> Any:
        """A pandas.DataFrame with a row for each order.

        Raises:
            ImportError: pandas is missing, which the extra of its name brings.
        """
        return load("pandas", "pandas").DataFrame(self.rows())

    def __repr__(self) -> str:
        rows = [["vertices", "elements", "mean span", *(f"{kernel} ms" for kernel in KERNELS)]]
        for row in self.rows():
            numbers = [f"{row['mean span']:,.1f}", *(f"{row[f'{kernel} ms']:.3g}" for kernel in KERNELS)]
            rows.append([row["vertices"], row["elements"], *numbers])
        widths = [max(map(len, column)) for column in zip(*rows)]
        return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in rows)

    def _repr_html_(self) -> str:
        return _html.candidates(self._candidates, KERNELS)

    def plot(self, axes: Any = None) -> Any:
        """Draws bars of each kernel for each order, by matplotlib: its time relative to that as the mesh is.

        Args:
            axes: matplotlib's; None: a new figure's.

        Raises:
            ImportError: matplotlib is missing, which the extra ``plot`` brings.
        """
        return _plots.candidates(self._candidates, KERNELS, axes)


def _pairs(methods: Any) -> list[tuple[str, str]]:
    listed = [methods] if isinstance(methods, str) else methods or []
    return [(method, "auto") if isinstance(method, str) else tuple(method) for method in listed]


@dataclass(frozen=True)
class Calibration:
    """What `calibrate` found of this machine.

    Attributes:
        machine: what ``Advice.machine`` calls it.
        figures: all that was measured: what a thread gets of the caches, latencies, bandwidths, costs of the kernels.
        file: where it is stored; None if it is not kept.
        doubt: why it is not to be trusted (the machine was busy or throttled); empty where it is.
    """

    machine: str
    figures: dict[str, Any] = field(repr=False)
    file: Path | None
    doubt: str


def calibrate(seconds: float = 16, *, keep: bool = True, **options: Any) -> Calibration:
    """Measures this machine, so that `advise` and `compare` predict for it from now on.

    Other work on the machine spoils it.

    Args:
        seconds: no measurement begins that would end later, but each is made once: some 20 s in all for 16.
        keep: stores it for this processor and this build of the library.
        **options: see `Options`; only ``threads`` and ``progress`` matter.
    """
    with prepared(options) as given:
        machine, figures, file, doubt = _core.calibrate(seconds, keep, given)
    return Calibration(machine, json.loads(figures), Path(file) if file else None, doubt)


def advise(
    mesh: Any, *, measure: bool = False, budget: float = 10, machine: str = "", **options: Any
) -> Advice:
    """Tells what reordering a mesh would be worth, before it is done.

    Args:
        mesh: a path, or a mesh as of `reorder`.
        measure: runs the kernels here; otherwise they are predicted.
        budget: seconds for that.
        machine: what to predict for: "this", as `calibrate` measured it, or one that ships, as "zen5"; empty: what the
            environment variable MESHORDER_MACHINE says, else "this".
        **options: see `Options`.
    """
    with prepared(options) as given:
        made = mesh_of(mesh)._handle.advise([], not measure, measure, budget, machine, given)
    verdict, as_is, candidates, kernels, doubt, predicted_for = made
    return Advice(
        verdict,
        Candidate._of(as_is),
        [Candidate._of(candidate) for candidate in candidates],
        {kernel: KernelAdvice(*best) for kernel, best in kernels.items()},
        doubt,
        predicted_for,
    )


def compare(
    mesh: Any,
    methods: Any = None,
    *,
    measure: bool = False,
    budget: float = 10,
    predict: bool = True,
    machine: str = "",
    **options: Any,
) -> Comparison:
    """Compares orders of a mesh: their spans and the time of four kernels of simulators.

    Args:
        mesh: as of `advise`.
        methods: names of methods for the vertices, or pairs of those for vertices and elements; or one name; None: what
            "auto" takes.
        measure: runs the kernels here, on one thread.
        budget: seconds for that.
        predict: by reuse distances and a cost model.
        machine: as of `advise`.
        **options: see `Options`.
    """
    with prepared(options) as given:
        made = mesh_of(mesh)._handle.compare(_pairs(methods), predict, measure, budget, machine, given)
    return Comparison([Candidate._of(candidate) for candidate in made])
