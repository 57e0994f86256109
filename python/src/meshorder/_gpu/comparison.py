# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Compares orders of a mesh with kernels that run on a graphics processor, and says which order is best there."""

from __future__ import annotations

import os
import pathlib
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import _html
from .._errors import InternalError, InvalidArgument
from .._files import mesh_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .device import Device
    from .kernels import Arrays, Kernel, Run
    from .problem import Ordered

_LARGEST_ERROR = 1e-4
_LEAST_GAIN = 1.02
_RANK = 3  # index from both ends of 15 sorted values: the two values bound the median with a probability of 96 %


class Speedup(NamedTuple):
    """How many times faster kernels run than in the file's order: the median of 15 rounds, and a 96 % interval of it."""

    ratio: float
    low: float
    high: float

    @classmethod
    def of(cls, ratios: NDArray[np.float64]) -> Speedup:
        """Returns the speedup from the ratio of times in each of 15 rounds."""
        ranked = np.sort(ratios).tolist()
        return cls(float(np.median(ratios)), ranked[_RANK], ranked[-1 - _RANK])

    def __str__(self) -> str:
        return f"{self.ratio:.2f}× ({self.low:.2f}–{self.high:.2f})"


class GpuTime(NamedTuple):
    """Time of a kernel in an order.

    Attributes:
        milliseconds: the median of 15 rounds.
        speedup: over the file's order: ``ratio``, ``low`` and ``high``.
        error: largest difference of a result from double precision, relative to the sum of its terms: at most 1e-4.
    """

    milliseconds: float
    speedup: Speedup
    error: float


@dataclass(frozen=True)
class GpuOrder:
    """An order in which the kernels ran.

    Attributes:
        name: "original", or the order's name: "rcm" for "rcm/lexmax", "hilbert/original", "rcm+corners".
        vertices: method of the vertices; never "auto".
        elements: method of the elements; never "auto".
        by_auto: whether ``auto`` chose both methods for a GPU.
        sorts_corners: whether the corners of tetrahedra were sorted by `sort_corners`.
        seconds: time to make the order, on the host.
        times: the time of each kernel.
        speedup: geometric means over all kernels of the ratio, and of both ends of its interval.
    """

    name: str
    vertices: str
    elements: str
    by_auto: bool
    sorts_corners: bool
    seconds: float
    times: dict[str, GpuTime]
    speedup: Speedup

    def options(self) -> str:
        """Returns the options of ``meshorder order`` that make this order, without sorted corners."""
        return "--for gpu" if self.by_auto else f"--vertices {self.vertices} --elements {self.elements}"


@dataclass(frozen=True)
class GpuComparison:
    """Result of `compare_on_gpu`. Its text is a verdict and a table.

    Attributes:
        gpu: name of the graphics processor.
        kernels: for each kernel its group and its title in the group.
        orders: the file's order first.
        best: the order to take: the fastest one without sorted corners if its interval begins above 1.02, else the
            file's; the order of ``auto`` instead of the fastest one if it is less than 2 % slower.
        file: name of the mesh's file; None if it was not read from one.
        notes: on what was left out when the mesh was read.
    """

    gpu: str
    kernels: dict[str, tuple[str, str]]
    orders: list[GpuOrder]
    best: GpuOrder
    file: str | None
    notes: list[str]

    def verdict(self) -> str:
        """Returns the order to take and what it gains, in two lines."""
        best = self.best
        if best is self.orders[0]:
            first = f"Keep the file's order: no other is faster by more than {100 * (_LEAST_GAIN - 1):.0f} % on average."
        else:
            mesh = os.fspath(self.file or "MESH")
            ordered = "ordered-" + pathlib.Path(mesh).name.removesuffix(".gz")
            command = f"meshorder order {shlex.quote(mesh)} -o {shlex.quote(ordered)} {best.options()}"
            gains = ", ".join(
                f"{group} {least:.2f}×" if f"{least:.2f}" == f"{most:.2f}" else f"{group} {least:.2f}–{most:.2f}×"
                for group, (least, most) in self._gains(best).items()
            )
            first = f"Sort by `{command}`: {gains}."
        layouts = "; ".join(f"{group} {', '.join(found)}" for group, found in self._layouts(best).items())
        return first + (f"\nLayouts in that order, against packed: {layouts}." if layouts else "")

    def _gains(self, order: GpuOrder) -> dict[str, tuple[float, float]]:
        """Returns the least and the largest speedup in each group of kernels."""
        gains: dict[str, tuple[float, float]] = {}
        for kernel, (group, _) in self.kernels.items():
            ratio = order.times[kernel].speedup.ratio
            least, most = gains.get(group, (ratio, ratio))
            gains[group] = min(least, ratio), max(most, ratio)
        return gains

    def _layouts(self, order: GpuOrder) -> dict[str, list[str]]:
        """Returns for each group how many times faster other layouts are than additions to three numbers side by side."""
        found: dict[str, list[str]] = {}
        for kernel, (group, title) in self.kernels.items():
            packed = order.times.get(f"{kernel.partition('_')[0]}_packed")
            if packed is not None and title != "packed":
                ratio = packed.milliseconds / order.times[kernel].milliseconds
                found.setdefault(group, []).append(f"{title} {ratio:.1f}×")
        return found

    def as_dict(self) -> dict[str, Any]:
        """Returns everything, ready for JSON."""
        orders = []
        for order in self.orders:
            times = {
                kernel: {"milliseconds": time.milliseconds, **time.speedup._asdict(), "error": time.error}
                for kernel, time in order.times.items()
            }
            orders.append({**vars(order), "times": times, "speedup": order.speedup._asdict()})
        kernels = {name: {"group": group, "title": title} for name, (group, title) in self.kernels.items()}
        return {
            "file": self.file, "gpu": self.gpu, "verdict": self.verdict(), "best": self.best.name, "kernels": kernels,
            "orders": orders, "notes": self.notes,
        }  # fmt: skip

    def rows(self) -> list[list[str]]:
        """Returns the cells of the table: two rows of titles, times in the file's order, and a row for each order."""
        groups, shown = [""], ""
        for group, _ in self.kernels.values():
            groups.append("" if group == shown else group)
            shown = group
        titles = ["order", *(title for _, title in self.kernels.values())]
        given = self.orders[0].times
        best = {kernel: max(order.times[kernel].speedup.ratio for order in self.orders) for kernel in self.kernels}
        marks = {kernel: "*" if most == 1 else " " for kernel, most in best.items()}
        in_ms = [f"{given[kernel].milliseconds:.3g}{mark}" for kernel, mark in marks.items()]
        rows = [groups, titles, ["original, ms", *in_ms]]
        for order in self.orders[1:]:
            ratios = [(order.times[kernel].speedup.ratio, best[kernel]) for kernel in self.kernels]
            cells = [f"{ratio:.2f}{'*' if ratio == most else ' '}" for ratio, most in ratios]
            rows.append([f"{order.name} (auto)" if order.by_auto else order.name, *cells])
        return rows

    def __str__(self) -> str:
        rows = self.rows()
        widths = [max(len(row[column]) for row in rows[1:]) for column in range(len(rows[0]))]
        text = [self.verdict(), "", f"{self.gpu}: how many times faster than in the file's order, the best marked by *"]
        head, place = "", widths[0]
        for group, width in zip(rows[0][1:], widths[1:]):
            if group:
                head = head.ljust(place + 1) + group
            place += width + 1
        text.append(head)
        text += [" ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in rows[1:]]
        return "\n".join(line.rstrip() for line in text)

    def _repr_html_(self) -> str:
        return _html.gpu_comparison(self.verdict(), self.gpu, self.rows())


def _times_of(kernel: Kernel, arrays: Sequence[Arrays], device: Device) -> list[GpuTime]:
    """Checks and times a kernel in all orders."""
    runs = [kernel.prepare(of_order) for of_order in arrays]
    errors = [_error(kernel, run, of_order, device) for run, of_order in zip(runs, arrays)]
    times = device.milliseconds([run.launches for run in runs])
    medians = np.median(times, axis=0).tolist()
    speedups = [Speedup.of(times[:, 0] / of_order) for of_order in times.T]
    return list(map(GpuTime, medians, speedups, errors))


def _error(kernel: Kernel, run: Run, arrays: Arrays, device: Device) -> float:
    """Runs a kernel once and returns its error.

    Raises:
        InternalError: the error is too large.
    """
    device.launch(run.launches)
    found = run.read(device.download(run.result))
    error = run.expected().error(arrays.order.vertices.inverse().move(found))
    if not error <= _LARGEST_ERROR:
        raise InternalError(
            f"compare on a GPU: {kernel.name} is wrong in the order {arrays.order.name}: its relative error is {error:.2g}, "
            f"more than {_LARGEST_ERROR:g}"
        )
    return error


def _best_of(orders: list[GpuOrder]) -> GpuOrder:
    """Returns the order to take; see `GpuComparison`."""
    plain = [order for order in orders[1:] if not order.sorts_corners]
    fastest = max(plain, key=lambda order: order.speedup.ratio, default=orders[0])
    if fastest.speedup.low <= _LEAST_GAIN:
        return orders[0]
    enough = fastest.speedup.ratio / _LEAST_GAIN
    return next((order for order in plain if order.by_auto and order.speedup.ratio > enough), fastest)


def compare_on_gpu(mesh: Any, methods: Sequence[str] | None = None, **options: Any) -> GpuComparison:
    """Runs kernels of simulations on this machine's GPU in the order of a mesh and in others, and compares their times.

    The kernels are products with a sparse matrix, sums of the elastic forces of linear tetrahedra, and springs along the
    edges, each in several layouts. Meshes without linear tetrahedra have no element forces. The results are compared with
    double precision. Only the kernels are timed; the orders run alternately.

    Args:
        mesh: the path of a file, or a mesh that `reorder` takes. It is not changed.
        methods: the orders to compare with the mesh's own: "rcm", "rcm/lexmax" with a method for the elements, "rcm+corners"
            with the corners of tetrahedra sorted by `sort_corners`. None: "auto" with and without sorted corners, hilbert,
            rcm, spectral, fiedler, "hilbert/original" and scrambled.
        **options: see `Options`; ``workload`` is "gpu".

    Returns:
        The order to take, and the times of all kernels in all orders.

    Raises:
        InvalidArgument: an object that is not a mesh, a mesh without vertices, an unknown method.
        InputError: the file cannot be read.
        Unavailable: CuPy, a GPU or its driver is missing, the GPU's memory is too small, or NVRTC fails.
        InternalError: a kernel's results are wrong.
        Stopped: ``progress`` returned False.

    Example:
        On a machine with an NVIDIA GPU and CuPy::

            print(meshorder.compare_on_gpu("dragon.msh"))
    """
    from .device import Device
    from .expected import Results
    from .kernels import Arrays, kernels_for
    from .problem import Problem, ordered

    device = Device()
    given = mesh_of(mesh)
    if not len(given.points):
        raise InvalidArgument("mesh: it has no vertices")
    problem = Problem(given)
    results = Results(problem)
    orders = ordered(problem, methods, options)
    groups = kernels_for(problem)
    times: dict[str, list[GpuTime]] = {}
    for group in groups:
        arrays = [Arrays(device, order, results) for order in orders]
        times.update({kernel.name: _times_of(kernel, arrays, device) for kernel in group})
        del arrays
        device.free()
    compared = [_result(order, {kernel: of[place] for kernel, of in times.items()}) for place, order in enumerate(orders)]
    kernels = {kernel.name: (kernel.group, kernel.title) for group in groups for kernel in group}
    file = os.fspath(mesh) if isinstance(mesh, (str, os.PathLike)) else None
    return GpuComparison(device.name, kernels, compared, _best_of(compared), file, given.notes)


def _result(order: Ordered, times: dict[str, GpuTime]) -> GpuOrder:
    logarithms = np.log([list(time.speedup) for time in times.values()]).mean(axis=0)
    mean = Speedup(*np.exp(logarithms).tolist())
    return GpuOrder(order.name, *order.methods, order.by_auto, order.sorts_corners, order.seconds, times, mean)
