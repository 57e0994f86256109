# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Options that several functions share."""

from __future__ import annotations

import contextlib
import operator
from collections.abc import Callable, Iterator
from typing import Any, TypedDict, Union

from ._arrays import integers, reals
from ._errors import InvalidArgument

#: see `Options`
ProgressFunction = Union[Callable[[str, float], Any], bool, None]


class Options(TypedDict, total=False):
    """Keyword arguments that orders have in common.

    Attributes:
        workload: what ``auto`` chooses its method for: "all", "element", "spmv", "assembly", "springs", "bandwidth"
            or "fill".
        seed: of "scrambled", of METIS and of start vectors.
        tolerance: of Fiedler vectors: ‖L x − λ x‖ ≤ tolerance · λ₂ ‖x‖; 0.1 suffices for orders.
        max_iterations: of the eigensolver.
        start: n numbers near the Fiedler vector, as the ``vector`` of an earlier result.
        groups: a whole number for each vertex; groups stay together, ascending.
        cell_groups: likewise for each cell.
        symmetric: of graphs: True refuses an asymmetric pattern, None and False order A + Aᵀ.
        check: "full", "fast" (does not refuse an asymmetric pattern) or "none" (nothing: faulty arrays crash).
        threads: at most; None: all.
        time_limit: seconds after which the best order so far is returned, with ``complete`` False.
        progress: a function of the stage's name and the part that is done (0 … 1, or −1 where that is unknown), which may
            return False to stop; or True for a bar by tqdm.
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
    """The options in the library's form."""
    unknown = options.keys() - Options.__annotations__.keys()
    if unknown:
        raise TypeError(f"unexpected keyword argument {sorted(unknown)[0]!r}")
    given: dict[str, Any] = {name: value for name, value in options.items() if value is not None}
    given["mirror"] = not given.pop("symmetric", False)
    if "start" in given:
        given["start"] = reals(given["start"], "start")
    for name in ("groups", "cell_groups"):
        if name in given:
            given[name] = integers(given[name], name)
    for name, most in (("seed", 2**64 - 1), ("max_iterations", 2**31 - 1), ("threads", 2**31 - 1)):
        if name in given:
            given[name] = _whole(given[name], most, name)
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


def _whole(value: Any, most: int, name: str) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        raise InvalidArgument(f"{name}: expected a whole number, not {value!r}") from None
    if not 0 <= number <= most:
        raise InvalidArgument(f"{name}: {number} is outside 0 … {most}")
    return number


def _real(value: Any, name: str) -> float:
    if not isinstance(value, (str, bytes)):
        with contextlib.suppress(TypeError, ValueError, OverflowError):
            return float(value)
    raise InvalidArgument(f"{name}: expected a number, not {value!r}")


@contextlib.contextmanager
def _bar() -> Iterator[Callable[[str, float], None]]:
    from tqdm.auto import tqdm

    with tqdm(total=100, bar_format="{desc:12} {bar} {n:3.0f} % {elapsed}") as bar:

        def show(stage: str, fraction: float) -> None:
            bar.set_description(stage, refresh=False)
            bar.n = max(bar.n, round(100 * fraction))
            bar.refresh()

        yield show
