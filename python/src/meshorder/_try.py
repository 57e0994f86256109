# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Runs a caller's function on a mesh or matrix in several orders, and reports in which it runs faster."""

from __future__ import annotations

import math
import statistics
import time as clocks
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Union

import numpy as np

from ._errors import InvalidArgument
from ._orders import order, reorder
from ._permutation import Permutation
from .hosts import find_host

#: orders that `try_orders` tries by default, as `meshorder try` does
_DEFAULT = ("auto", "hilbert", "rcm", "spectral-fronts", "hilbert-fronts")
_CLOCKS = {"cpu": clocks.process_time, "wall": clocks.perf_counter}

# the rule of src/payoff/paired_trials.cpp, which explains it
_TIE = 0.015
_FEWEST_ROUNDS = 3
_FEWEST_PAIRS = 6
_FIRST_CHECK = 4
_PLAINLY_SLOWER = 1.2
_TAIL = 0.003
_TRIMMED = 0.2
_BETWEEN_CHECKS = 1.2
_LEAST_SPREAD = 0.003
_LEAST_DISTANCE = 0.001
_LEAST_TIME = 1e-6

_NOT_TOLD_APART = "not told apart"

# differences below this share of the largest number count as rounding
_ROUNDING = 1e-12

# runs of the best order: a first run, rounds to choose among the orders, and pairs; then runs of each order
_RUNS_OF_BEST = 15
_RUNS_OF_EACH = 3


def _student_tail(t: float, degrees: int) -> float:
    """Returns the probability that Student's t exceeds t > 0 (Abramowitz and Stegun, 1964, 26.7.3 and 26.7.4)."""
    angle = math.atan(t / math.sqrt(degrees))
    odd = degrees % 2 == 1
    term = math.cos(angle) if odd else 1.0
    total = 0.0 if degrees == 1 else term
    for k in range(3 if odd else 2, degrees - 1, 2):
        term *= math.cos(angle) ** 2 * (k - 1) / k
        total += term
    within = 2 / math.pi * (angle + math.sin(angle) * total) if odd else math.sin(angle) * total
    return (1 - within) / 2


def _student_quantile(tail: float, degrees: int) -> float:
    low, high = 0.0, 1.0
    while _student_tail(high, degrees) > tail:
        high *= 2
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if _student_tail(middle, degrees) > tail else (low, middle)
    return (low + high) / 2


class _Speedup(NamedTuple):
    ratio: float = 1.0
    low: float = 0.0
    high: float = math.inf


def _told_apart(speedup: _Speedup) -> bool:
    """Returns whether a ratio may be reported: its interval does not contain 1, or is that of a tie."""
    return speedup.low > 1 or speedup.high < 1 or (speedup.low > 1 / (1 + _TIE) and speedup.high < 1 + _TIE)


def _speedup_of_few(logs: Sequence[float], control: Sequence[float]) -> _Speedup:
    n = len(logs)
    mean = sum(logs) / n
    if n < 2:
        return _Speedup(math.exp(mean))
    squares = sum((log - mean) ** 2 for log in logs) + sum(log * log for log in control)
    degrees = n - 1 + len(control)
    deviation = max(math.sqrt(squares / degrees), _LEAST_SPREAD)
    width = _student_quantile(_TAIL, degrees) * deviation / math.sqrt(n)
    return _Speedup(math.exp(mean), math.exp(mean - width), math.exp(mean + width))


def _speedup_of(logs: Sequence[float], control: Sequence[float] = ()) -> _Speedup:
    """Returns the speedup from logarithms of paired ratios, by their trimmed mean (Yuen, 1974).

    For two to five pairs it is their mean, with the spread of the control: ratios of runs in one order.
    """
    if not logs:
        return _Speedup()
    if len(logs) < _FEWEST_PAIRS:
        return _speedup_of_few(logs, control)
    values = np.sort(logs)
    cut = int(_TRIMMED * len(values))
    kept = len(values) - 2 * cut
    mean = float(values[cut : len(values) - cut].mean())
    values = np.clip(values, values[cut], values[len(values) - cut - 1])
    squares = float(((values - values.mean()) ** 2).sum())
    width = _student_quantile(_TAIL, kept - 1) * math.sqrt(squares / (kept * (kept - 1)))
    return _Speedup(math.exp(mean), math.exp(mean - width), math.exp(mean + width))


def _spread(values: Sequence[float]) -> float:
    middle = statistics.median(values)
    return 1.4826 * statistics.median([abs(value - middle) for value in values])


class _PairedTrials:
    """Decides by paired runs which of the candidates 1, 2, … is faster than candidate 0."""

    def __init__(self, candidates: int) -> None:
        self.logs: list[list[float]] = [[] for _ in range(candidates + 1)]
        self.left = list(range(1, candidates + 1))
        self.verdict = "undecided"
        self.control: list[float] = []  # logarithms of ratios of the own order in successive rounds
        self._own: list[float] = []
        self._next_check = _FIRST_CHECK

    def next_round(self) -> list[int]:
        """Returns the candidates to run next, in this order; empty when the trial has ended."""
        if not self.left or self.verdict != "undecided":
            return []
        each = [0, *self.left]
        start = len(self._own) % len(each)
        return each[start:] + each[:start]

    def add_round(self, times: dict[int, float]) -> None:
        for candidate in self.left:
            self.logs[candidate].append(math.log(times[0] / times[candidate]))
        self._own.append(times[0])
        rounds = len(self._own)
        if rounds % 2 == 0:
            self.control.append(math.log(self._own[-2] / self._own[-1]))
        if rounds == 2:
            best = max((min(self.logs[candidate]) for candidate in self.left), default=0.0)
            least = best - math.log(_PLAINLY_SLOWER)
            self.left = [candidate for candidate in self.left if max(self.logs[candidate]) >= least]
        if len(self.left) > 1 and rounds >= _FEWEST_ROUNDS:
            self._drop_losers()
        if len(self.left) == 1:
            self._check()

    def exclude(self, candidate: int) -> None:
        if candidate in self.left:
            self.left.remove(candidate)

    def best(self) -> int | None:
        return max(self.left, key=self._median, default=None)

    def speedup(self, candidate: int) -> _Speedup:
        return _speedup_of(self.logs[candidate], self.control) if candidate else _Speedup(1.0, 1.0, 1.0)

    def _median(self, candidate: int) -> float:
        return statistics.median(self.logs[candidate] or [0.0])

    def _drop_losers(self) -> None:
        self.left.sort(key=self._median, reverse=True)
        best = self.logs[self.left[0]]
        n = len(best)
        spreads = [_spread([b - x for b, x in zip(best, self.logs[c])]) for c in self.left[1:]]
        error = max(statistics.median(spreads) * math.sqrt(n / (n - 1)), _LEAST_SPREAD) / math.sqrt(n)
        least = statistics.median(best) - 2 * error
        self.left = [candidate for candidate in self.left if self._median(candidate) >= least]
        self.left = self.left[: max(1, (len(self.logs) - 1) >> (len(self._own) // 2))]

    def _check(self) -> None:
        pairs = len(self.logs[self.left[0]])
        if pairs < self._next_check:
            return
        while self._next_check <= pairs:
            self._next_check = max(self._next_check + 1, int(_BETWEEN_CHECKS * self._next_check))
        found = self.speedup(self.left[0])
        if found.low > 1 / (1 + _TIE) and found.high < 1 + _TIE:
            self.verdict = "tie"
        elif found.low >= 1 + _LEAST_DISTANCE and found.ratio > 1 + _TIE:
            self.verdict = "faster"
        elif found.high <= 1 - _LEAST_DISTANCE and found.ratio < 1 / (1 + _TIE):
            self.verdict = "slower"


@dataclass(frozen=True)
class TriedOrder:
    """An order in which a function was run.

    Attributes:
        name: "original", or the name of the order: "rcm", "hilbert/hilbert"; for "auto" the name of its choice.
        time: in seconds or as returned by ``time``: for the original order the median of its runs, for another order
            this median divided by ``ratio``; None where ``ratio`` is.
        ratio: speedup over the original order, from runs of the same rounds; None if no run counts, and if the order is
            not told apart from the original one: the interval holds 1 and more than a tie.
        interval: lowest and highest ratio of a 95 % interval; None for fewer than two runs.
        runs: number of runs that count.
        order_seconds: seconds to make the order.
        fault: why the order was excluded from the trial, a sentence; None if it was not.
    """

    name: str
    time: float | None
    ratio: float | None
    interval: tuple[float, float] | None
    runs: int
    order_seconds: float
    fault: str | None


@dataclass(frozen=True)
class Trial:
    """Result of `try_orders`.

    Attributes:
        verdict: "faster": the function runs faster in ``best``; "slower": it runs slower in the best other order
            than in the original one; "tie": in ``best`` its time differs by at most 1.5 %; "not told apart": its times vary
            too much to say; "undecided": there were too few runs to say, or they decide nothing yet.
        best: name of the best order besides the original one; None if there is no other.
        ratio: speedup in that order; None if it is not told apart from the original one, or if there is none.
        interval: a 95 % interval of the ratio, None for fewer than two runs.
        orders: the orders that were tried, the original one first.
        ordered: the mesh or matrix in the best order if the verdict is "faster", else the one that was given.
        left_out: names of orders for which the budget left no time.
        control: the smallest and the largest ratio of the original order to itself in other rounds, which show the noise;
            None for fewer than two runs.
        needed_budget: the budget in seconds that an undecided trial needs for an interval, or, if there is one, to halve
            its width; None for other trials, and if no other order is left to try.
    """

    verdict: str
    best: str | None
    ratio: float | None
    interval: tuple[float, float] | None
    orders: list[TriedOrder]
    ordered: Any = field(repr=False, compare=False)
    left_out: list[str]
    needed_budget: float | None = None
    control: tuple[float, float] | None = None

    def as_dict(self) -> dict[str, Any]:
        """Returns everything but ``ordered``, ready for JSON."""
        names = ("verdict", "best", "ratio", "interval", "left_out", "needed_budget", "control")
        result = {name: getattr(self, name) for name in names}
        return {**result, "orders": [dict(vars(tried)) for tried in self.orders]}

    def __str__(self) -> str:
        rows = [f"{'order':<20} {'time':>10} {'ratio':>7} {'95 %':>13} {'runs':>5}"]
        for tried in self.orders:
            if tried.fault or tried.runs == 0:
                rows.append(f"{tried.name:<20} {tried.fault or 'not timed'}")
                continue
            if tried.time is None or tried.ratio is None:
                rows.append(f"{tried.name:<20} {_NOT_TOLD_APART:>18} {_range(tried.interval):>13} {tried.runs:>5}")
                continue
            rows.append(
                f"{tried.name:<20} {tried.time:>10.4g} {tried.ratio:>7.3f} {_range(tried.interval):>13} {tried.runs:>5}"
            )
        if self.control:
            rows.insert(2, f"{'original again':<20} {'':>18} {_range(self.control):>13}")
        if self.left_out:
            rows.append(f"no time for {', '.join(self.left_out)}: give a larger budget")
        if any(tried.fault for tried in self.orders):
            rows.append("orders whose results differ are left out: a larger tolerance allows larger differences")
        return "\n".join([self._sentence(), "", *rows])

    def _sentence(self) -> str:
        if self.best is None:
            return "no order was tried but the original one"
        interval = _range(self.interval)
        if self.verdict == "faster":
            return f"{self.ratio:.2f}× faster ({interval}) in {self.best}"
        if not interval:
            return f"undecided: too few runs to say; raise budget to {self.needed_budget:.6g}"
        if self.ratio is None:
            return (
                f"{_NOT_TOLD_APART}: the times vary too much; {self.best} is {interval}× as fast, and "
                f"budget={self.needed_budget:.6g} halves this range"
            )
        found = f"in {self.best} {self.ratio:.3f}× as fast ({interval})"
        if self.verdict == "slower":
            return f"slower: fastest in the original order; {found}"
        if self.verdict == "tie":
            return f"tie: no order tried is faster by more than {100 * _TIE:g} %; {found}"
        return f"undecided: {found} so far, and budget={self.needed_budget:.6g} halves the range"


def _range(interval: tuple[float, float] | None) -> str:
    return f"{interval[0]:.3f}–{interval[1]:.3f}" if interval else ""


#: how a run is timed; see `try_orders`
TimeOf = Union[str, Callable[[Any], float]]


class _Candidate:
    """An order, the mesh or matrix in it, and the times of its runs."""

    def __init__(self, name: str, ordered: Any, seconds: float) -> None:
        self.name = name
        self.ordered = ordered
        self.order_seconds = seconds
        self.times: list[float] = []
        self.last = 0.0  # seconds of the last run, by the clock
        self.fault: str | None = None


class _Runner:
    """Runs the function and compares its result with that of the first run."""

    def __init__(self, function: Callable[[Any], Any], time: TimeOf, tolerance: float | None) -> None:
        if isinstance(time, str) and time not in _CLOCKS:
            raise InvalidArgument(f"time: expected 'cpu', 'wall' or a function, not {time!r}")
        self._function = function
        self._time = time
        self._tolerance = tolerance
        self._first: Any = None
        self.spent = 0.0

    def run(self, candidate: _Candidate) -> float:
        clock = _CLOCKS[self._time] if isinstance(self._time, str) else clocks.process_time
        began, at = clocks.perf_counter(), clock()
        result = self._function(candidate.ordered)
        taken = clock() - at
        candidate.last = clocks.perf_counter() - began
        self.spent += candidate.last
        if not isinstance(self._time, str):
            taken = float(self._time(result))
            if not 0 < taken < math.inf:
                raise InvalidArgument(f"time: a time of {taken} cannot be compared")
        candidate.fault = self._difference(result)
        candidate.times.append(max(taken, _LEAST_TIME))
        return candidate.times[-1]

    def _difference(self, result: Any) -> str | None:
        if self._tolerance is None:
            return None
        try:
            found = np.array(result, dtype=float)
        except (TypeError, ValueError):
            raise InvalidArgument(f"tolerance: nothing to compare: the function returned {_shown(result)}") from None
        if self._first is None:
            if not np.isfinite(found).any():
                raise InvalidArgument(f"tolerance: nothing to compare: the function returned {_shown(result)}")
            self._first = found
        if found.shape != self._first.shape:
            return f"the results differ: shape {found.shape} instead of {self._first.shape}"
        finite = self._first[np.isfinite(self._first)]
        floor = _ROUNDING * np.abs(finite).max(initial=0)
        wrong = ~np.isclose(found, self._first, rtol=self._tolerance, atol=floor, equal_nan=True)
        if not wrong.any():
            return None
        return f"the results differ: {found[wrong].flat[0]:.6g} instead of {self._first[wrong].flat[0]:.6g}"


def _shown(result: Any) -> str:
    """Returns the beginning of an object's text, on one line."""
    return " ".join(repr(result).split())[:60]


def _stays(moved: Permutation) -> bool:
    return bool(np.array_equal(moved.new_to_old, np.arange(len(moved))))


def _ordered(given: Any, name: str, options: dict[str, Any]) -> tuple[str, Any, bool]:
    """Returns the name of an order, the object in it, and whether nothing has moved."""
    vertices, _, elements = name.partition("/")
    if find_host(given) is None:
        if not hasattr(given, "tocsr"):
            raise InvalidArgument(f"try_orders: expected a mesh or a SciPy matrix, not {type(given).__name__}")
        if elements:
            raise InvalidArgument(f"methods: {name}: a matrix has no elements")
        found = order(given, vertices, **options)
        return found.method, found.permutation.move(given), _stays(found.permutation)
    elements = elements or ("original" if vertices == "original" else "auto" if vertices == "auto" else "lexmax")
    moved, both = reorder(given, vertices=vertices, elements=elements, **options)
    kept = _stays(both.vertices.permutation) and _stays(both.cells.permutation)
    shown = both.vertices.method if both.cells.method == "lexmax" else f"{both.vertices.method}/{both.cells.method}"
    return shown if name == "auto" else name, moved, kept


def _orders_that_fit(runs: float, named: Sequence[str] | None) -> int:
    """Returns the number of orders for which a budget of ``runs`` runs suffices; orders that the caller named share it."""
    if named is not None and runs >= 2 * (len(named) + 1):
        return len(named)
    return max(1, int((min(runs, 1e6) - _RUNS_OF_BEST) / _RUNS_OF_EACH))


def _candidate(
    given: Any, name: str, others: Sequence[_Candidate], named: bool, options: dict[str, Any]
) -> _Candidate | None:
    """Returns an order to try; None if it moves nothing or the others contain it."""
    began = clocks.perf_counter()
    try:
        shown, ordered, kept = _ordered(given, name, options)
    except InvalidArgument:
        if named or name == "auto":
            raise
        return None  # a geometric order, for an object without coordinates
    if kept or any(candidate.name == shown for candidate in others):
        return None
    return _Candidate(shown, ordered, clocks.perf_counter() - began)


def _first_runs(
    mesh: Any, methods: Sequence[str] | None, runner: _Runner, budget: float, options: dict[str, Any]
) -> tuple[list[_Candidate], list[str]]:
    """Runs the function once in each order; returns these orders, and the names of those for which there is no time.

    An order with different results does not count, so that another one can run in its place.
    """
    original = _Candidate("original", mesh, 0.0)
    runner.run(original)
    most = _orders_that_fit(budget / max(original.last, _LEAST_TIME), methods)
    candidates = [original]
    left_out: list[str] = []
    for name in _DEFAULT if methods is None else methods:
        if any(candidate.name == name for candidate in candidates[1:]):
            continue
        sound = sum(candidate.fault is None for candidate in candidates[1:])
        if sound >= most or (len(candidates) > 1 and runner.spent + original.last > budget):
            left_out.append(name)
        elif candidate := _candidate(mesh, name, candidates[1:], methods is not None, options):
            candidates.append(candidate)
            runner.run(candidate)
    return candidates, left_out


def try_orders(
    mesh: Any, function: Callable[[Any], Any], methods: Sequence[str] | None = None, *, budget: float = 120.0,
    time: TimeOf = "cpu", tolerance: float | None = None, **options: Any,
) -> Trial:  # fmt: skip
    """Runs a function on a mesh or matrix in its present order and in others, and reports in which it runs faster.

    The function runs once in each order, then in rounds, in the original order and in the remaining ones, until it is
    clear which one is best and whether it is faster, or until the budget ends. Equally fast orders are reported as
    different in fewer than one of twenty trials, as by the command ``meshorder try``.

    Args:
        mesh: a mesh that `reorder` takes, except for Gmsh's model, or a SciPy matrix.
        function: called with the mesh or matrix in one of the orders, of the type that `reorder` returns; must not change
            it.
        methods: the orders to try: "rcm", or "rcm/lexmax" with a method for the elements; they share the budget. None:
            "auto", and hilbert, rcm, spectral-fronts and hilbert-fronts where possible.
        budget: seconds for all runs of the function.
        time: what is compared: "cpu", the processor time of this process; "wall", the time by the clock; or a function that
            returns a number > 0 for the result of ``function``.
        tolerance: None: results are not compared. Else the relative difference that is allowed between the numbers that
            ``function`` returns and those of its first run; differences below 1e-12 of the largest number are allowed,
            too. An order in which they differ more is excluded.
        **options: of the orders; see `Options`.

    Returns:
        The result, which prints as a sentence and a table.

    Raises:
        InvalidArgument: an object that is not a mesh or matrix, an unknown method or time, results that differ in all
            orders; as `reorder`. Exceptions of the function pass through.

    Example:
        >>> import scipy.sparse
        >>> matrix = scipy.sparse.csr_array([[2, 0, 1], [0, 2, 1], [1, 1, 2]])
        >>> trial = meshorder.try_orders(matrix, lambda a: a @ a, ["rcm"], budget=0.1)
        >>> trial.verdict in ("faster", "slower", "tie", "not told apart", "undecided")
        True
    """
    if not budget > 0:
        raise InvalidArgument(f"budget: expected seconds > 0, not {budget!r}")
    if not callable(function):
        raise InvalidArgument("function: expected a function that takes the mesh")
    runner = _Runner(function, time, tolerance)
    candidates, left_out = _first_runs(mesh, methods, runner, budget, options)
    trials = _PairedTrials(len(candidates) - 1)
    for number, candidate in enumerate(candidates):
        candidate.times.clear()  # the first runs do not count
        if candidate.fault:
            trials.exclude(number)
    if len(candidates) > 1 and not trials.left:
        faults = "; ".join(f"in {candidate.name} {candidate.fault}" for candidate in candidates[1:])
        raise InvalidArgument(f"the results are the same only in the original order; {faults}; give a larger tolerance")

    def run(number: int) -> float:
        taken = runner.run(candidates[number])
        fault = candidates[number].fault
        if fault and number == 0:
            raise InvalidArgument(f"{fault}, in two runs in the original order; give a larger tolerance")
        if fault:
            trials.exclude(number)
        return taken

    while each := trials.next_round():
        if runner.spent + sum(candidates[number].last for number in each) > budget:
            break
        trials.add_round({number: run(number) for number in each})
    return _result(candidates, trials, left_out, budget, runner.spent)


def _rounded_up(seconds: float) -> float:
    """Returns a number of seconds rounded up to two digits."""
    scale = 10.0 ** (1 - math.floor(math.log10(seconds)))
    return math.ceil(seconds * scale) / scale


def _needed_budget(candidates: list[_Candidate], left_out: list[str], budget: float, spent: float) -> float:
    """Returns the budget that suffices for an interval: 1.25 times the seconds of the runs that all orders need."""
    runs = sum(1 + len(candidate.times) for candidate in candidates)
    others = sum(candidate.fault is None for candidate in candidates[1:]) + len(left_out)
    return _rounded_up(1.25 * max(budget, (_RUNS_OF_BEST + _RUNS_OF_EACH * others) * spent / runs))


def _result(
    candidates: list[_Candidate], trials: _PairedTrials, left_out: list[str], budget: float, spent: float
) -> Trial:
    tried = []
    own = statistics.median(candidates[0].times or [0.0])
    for number, candidate in enumerate(candidates):
        speedup = trials.speedup(number)
        timed = bool(candidate.times)
        known = timed and _told_apart(speedup)
        tried.append(
            TriedOrder(
                candidate.name,
                own / speedup.ratio if known else None,
                speedup.ratio if known else None,
                (speedup.low, speedup.high) if timed and speedup.high < math.inf else None,
                len(candidate.times),
                candidate.order_seconds,
                candidate.fault,
            )
        )
    best = trials.best()
    if best is None:
        return Trial("undecided", None, None, None, tried, candidates[0].ordered, left_out)
    interval = tried[best].interval
    needed = None
    if trials.verdict == "undecided":  # the width of an interval falls with the root of the number of runs
        needed = _rounded_up(4 * budget) if interval else _needed_budget(candidates, left_out, budget, spent)
    ordered = candidates[best if trials.verdict == "faster" else 0].ordered
    ratio = tried[best].ratio
    verdict = _NOT_TOLD_APART if interval and ratio is None else trials.verdict
    noise = (math.exp(min(trials.control)), math.exp(max(trials.control))) if trials.control else None
    return Trial(verdict, tried[best].name, ratio, interval, tried, ordered, left_out, needed, noise)
