# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Options that several functions share: their names, their checks and their form for the library."""

from __future__ import annotations

import contextlib
import difflib
import operator
from collections.abc import Callable, Iterator
from typing import Any, TypedDict, Union

from ._arrays import integers, reals
from ._errors import InvalidArgument, Unavailable

#: Type of the option ``progress``; see `Options`.
ProgressFunction = Union[Callable[[str, float], Any], bool, None]


class Options(TypedDict, total=False):
    """Keyword arguments that the functions on graphs and meshes share. None means the default.

    Another name is a TypeError; a value that is out of range is an InvalidArgument.

    Attributes:
        workload: what the method "auto" optimises: "element", "spmv", "assembly" or "springs", the four kernels;
            "all" of them, weighted equally (default); "bandwidth", for banded solvers; "fill", for sparse direct solvers;
            or "gpu", for graphics processors. Other methods ignore it.
        seed: integer ≥ 0, default 0, for the method "scrambled", METIS's methods and random start vectors.
        tolerance: > 0: the eigensolver iterates until ‖L x − λ x‖ ≤ tolerance · λ₂ ‖x‖. The default, 0.1, suffices for
            orders; that of `fiedler` is 1e-8.
        max_iterations: ≥ 1, default 500: limit on the iterations of the eigensolver on the whole graph.
        start: n real numbers, for n vertices: an approximation of the Fiedler vector from which the eigensolver
            starts, such as ``Order.vector`` of an earlier call.
        groups: n integers, the group of each vertex: the vertices of a group stay together, groups ascend, and the method
            orders each group.
        cell_groups: m integers, the group of each cell, likewise. Cells still stay in their block, and cells of each
            dimension keep their places there.
        symmetric: for graphs and matrices. True: an asymmetric pattern is an InvalidArgument. False and None
            (default): it is replaced by the pattern of A + Aᵀ, with the weights of (A + Aᵀ) / 2.
        check: "full" (default) checks sizes, ranges, symmetry and that weights and coordinates are finite; "fast"
            does the same but accepts an asymmetric pattern; "none" trusts the arrays (those of a graph only
            with ``symmetric=True``): faulty ones can crash the process.
        threads: limit on threads, ≥ 0; None and 0: all. Orders do not depend on it.
        time_limit: seconds ≥ 0 after which iterative methods return the best order so far, with ``complete`` False;
            other methods ignore it. None (default): no limit.
        progress: a function that is called now and then as ``progress(stage, fraction)``, with the name of the stage
            and the share of the call that is done (0 … 1, or −1 if unknown). It ends the call with `Stopped` if it
            returns False; an exception ends it and passes through. True shows a bar with tqdm, which must be installed.
    """

    workload: str
    seed: int
    tolerance: float
    max_iterations: int
    start: Any
    groups: Any
    cell_groups: Any
    symmetric: bool | None
    check: str
    threads: int | None
    time_limit: float | None
    progress: ProgressFunction


@contextlib.contextmanager
def prepared(options: Options | dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Checks the options and yields them as the dict that the functions of `_core` need.

    Raises:
        TypeError: an unknown option.
        InvalidArgument: a value of the wrong type, a negative seed.
    """
    unknown = options.keys() - Options.__annotations__.keys()
    if unknown:
        name = sorted(unknown)[0]
        near = difflib.get_close_matches(name, Options.__annotations__, 1)
        raise TypeError(f"unexpected keyword argument {name!r}{f'; did you mean {near[0]!r}?' if near else ''}")
    given: dict[str, Any] = {name: value for name, value in options.items() if value is not None}
    given["mirror"] = not given.pop("symmetric", False)
    if "start" in given:
        given["start"] = reals(given["start"], "start")
    for name in ("groups", "cell_groups"):
        if name in given:
            given[name] = integers(given[name], name)
    for name, most in (("seed", 2**64 - 1), ("max_iterations", 2**31 - 1), ("threads", 2**31 - 1)):
        if name in given:
            given[name] = whole(given[name], most, name)
    for name in ("tolerance", "time_limit"):
        if name in given:
            given[name] = _real(given[name], name)
    for name in ("workload", "check"):
        if name in given and not isinstance(given[name], str):
            raise InvalidArgument(f"{name}: expected a text, not {given[name]!r}")
    progress = given.pop("progress", None)
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        raise InvalidArgument(f"progress: expected a function or True, not {progress!r}")
    if progress is True:
        with _bar() as given["progress"]:
            yield given
        return
    if progress is not None and progress is not False:
        given["progress"] = progress
    yield given


def in_a_line(value: Any) -> str:
    """Returns a value for a message: the shape of an array, the ``repr`` of other values."""
    shape = getattr(value, "shape", ())
    return f"an array of the shape {tuple(shape)}" if shape else repr(value)


def whole(value: Any, most: int, name: str) -> int:
    """Returns an integer in 0 … ``most``; raises InvalidArgument for other values."""
    try:
        number = operator.index(value)
    except TypeError:
        raise InvalidArgument(f"{name}: expected a whole number, not {in_a_line(value)}") from None
    if not 0 <= number <= most:
        raise InvalidArgument(f"{name}: {number} is outside 0 … {most}")
    return number


def _real(value: Any, name: str) -> float:
    if not isinstance(value, (str, bytes)):
        with contextlib.suppress(TypeError, ValueError, OverflowError):
            return float(value)
    raise InvalidArgument(f"{name}: expected a number, not {in_a_line(value)}")


@contextlib.contextmanager
def _bar() -> Iterator[Callable[[str, float], None]]:
    """Shows a bar with tqdm and yields a progress function that updates it."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise Unavailable("progress: the bar needs the package tqdm; install it, or give a function") from None

    with tqdm(total=100, bar_format="{desc:12} {bar} {n:3.0f} % {elapsed}") as bar:

        def show(stage: str, fraction: float) -> None:
            bar.set_description(stage, refresh=False)
            bar.n = max(bar.n, round(100 * fraction))
            bar.refresh()

        yield show
