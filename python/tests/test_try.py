# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`try_orders`, which times orders by a function of the caller: synthetic times, results, and bad arguments."""

import itertools
import json
import time
import typing
import unittest.mock

import meshorder
import numpy as np
import pytest
import scipy.sparse as sp
from conftest import lattice, tetrahedra
from meshorder import InvalidArgument, _try


def mean_span(matrix):
    entries = sp.coo_array(matrix)
    return np.abs(entries.row - entries.col).mean()


class Solver:
    """Returns invented seconds: fewer in a good order, with a relative spread."""

    def __init__(self, gain, spread=0.01, limit=500):
        self.gain = gain
        self.spread = spread
        self.limit = limit
        self.random = np.random.default_rng(1)

    def __call__(self, matrix):
        in_order = mean_span(matrix) < self.limit
        return float((1 / self.gain if in_order else 1) * np.exp(self.spread * self.random.standard_normal()))


def tried(solver, methods=("rcm", "scrambled"), budget=0.5):
    return meshorder.try_orders(lattice(30, 20, 9), solver, methods, budget=budget, time=lambda seconds: seconds)


def test_a_gain_is_found_and_the_matrix_in_that_order_returned():
    trial = tried(Solver(1.2))
    assert trial.verdict == "faster" and trial.best == "rcm"
    assert trial.interval is not None and trial.ratio is not None
    low, high = trial.interval
    assert 1.1 < low < trial.ratio < high < 1.3
    assert mean_span(trial.ordered) < 500
    original, rcm, scrambled = trial.orders
    assert (original.name, original.ratio, original.order_seconds) == ("original", 1, 0)
    assert rcm.runs >= 4 and rcm.order_seconds > 0
    assert scrambled.runs in (2, 3) and trial.control
    assert str(trial).startswith("1.2")
    assert "faster (" in str(trial) and "scrambled" in str(trial)
    assert json.loads(json.dumps(trial.as_dict()))["orders"][1]["name"] == "rcm"


@pytest.mark.parametrize(
    "gain, verdict, words",
    [
        (1, "tie", "tie: no order tried is faster by more than 1.5 %; in rcm "),
        (0.8, "slower", "slower: fastest in the original order; in rcm 0.8"),
    ],
)
def test_no_gain_is_called_none(gain, verdict, words):
    given = lattice(30, 20, 9)
    trial = meshorder.try_orders(given, Solver(gain, 0.002), ["rcm"], time=lambda seconds: seconds)
    assert trial.verdict == verdict
    assert trial.ordered is given
    assert str(trial).startswith(words) and "× as fast (" in str(trial)
    assert trial.needed_budget is None


def test_the_budget_ends_what_is_not_decided():
    trial = tried(Solver(1, 0.2), ["rcm"], 0.05)
    assert trial.verdict == "not told apart" and trial.ratio is None and trial.orders[1].ratio is None
    assert trial.interval and trial.needed_budget == pytest.approx(0.2)
    assert str(trial).startswith("not told apart: the times vary too much; rcm is ")
    assert "budget=0.2 halves this range" in str(trial) and str(trial).count("not told apart") == 2


def test_few_long_calls_give_a_range():
    """As many as a budget of 12 s allows of calls of 0.4 s."""
    solver = Solver(1.3)

    def long(matrix):
        clock[0] += 0.4
        return solver(matrix)

    clock = [0.0]
    with unittest.mock.patch("meshorder._try.clocks.perf_counter", lambda: clock[0]):
        trial = meshorder.try_orders(lattice(30, 20, 9), long, budget=12, time=lambda seconds: seconds)
    assert trial.verdict == "faster" and trial.ratio and trial.interval and trial.interval[0] > 1.1
    assert sum(order.runs for order in trial.orders) < 30


class Sleeper:
    """Takes 30 ms and returns the next number for each run; repeats the last number at the end."""

    def __init__(self, *numbers):
        self.numbers = list(numbers)

    def __call__(self, matrix):
        time.sleep(0.03)
        return self.numbers.pop(0) if len(self.numbers) > 1 else self.numbers[0]


@pytest.mark.parametrize("budget", [0.05, 0.15])
def test_too_few_runs_are_no_finding(graph, budget):
    trial = meshorder.try_orders(graph, Sleeper(1), budget=budget)
    assert trial.verdict == "undecided" and trial.interval is None
    assert trial.left_out and trial.needed_budget and trial.needed_budget > 0.5
    assert str(trial).startswith(f"undecided: too few runs to say; raise budget to {trial.needed_budget:g}\n")
    assert f"no time for {', '.join(trial.left_out)}: give a larger budget" in str(trial)
    assert json.loads(json.dumps(trial.as_dict()))["needed_budget"] == trial.needed_budget


def test_an_order_whose_results_differ_gives_its_place_to_others(graph):
    trial = meshorder.try_orders(graph, Sleeper(1, 2, 1), budget=0.4, tolerance=1e-6)
    _, first, second = trial.orders
    assert first.fault == "the results differ: 2 instead of 1"
    assert second.fault is None and second.runs > 0 and trial.left_out
    assert "a larger tolerance allows larger differences" in str(trial)


def test_orders_that_the_caller_names_share_the_budget(graph):
    trial = meshorder.try_orders(graph, Sleeper(1), ["auto", "bfs", "scrambled", "rcm"], budget=0.65)
    assert trial.left_out == [] and {"bfs", "scrambled"} <= {order.name for order in trial.orders}


def test_times_agree_with_ratios():
    """Each run is shorter than the one before."""
    times = iter(1 / n for n in range(10, 1000))
    trial = meshorder.try_orders(
        lattice(30, 20, 9), lambda a: next(times), ["rcm", "scrambled", "bfs"], budget=1, time=lambda seconds: seconds
    )
    original, *others = trial.orders
    assert {order.runs for order in others} != {original.runs}
    assert any(order.time for order in others)
    for order in others:
        if order.time and order.ratio:
            assert order.time * order.ratio == pytest.approx(original.time)


def test_sums_that_are_zero_but_for_rounding_agree(graph):
    def results(zero):
        return itertools.chain([[2e-14, -102.0]], itertools.repeat([zero, -102.0]))

    near, far = results(-8e-14), results(-2e-10)
    assert meshorder.try_orders(graph, lambda a: next(near), ["rcm"], budget=0.05, tolerance=1e-9).best == "rcm"
    with pytest.raises(InvalidArgument, match="only in the original order; in rcm the results differ"):
        meshorder.try_orders(graph, lambda a: next(far), ["rcm"], budget=0.05, tolerance=1e-9)


def test_an_interval_that_is_shown_as_one_decides_nothing():
    noise = [-0.02, 0.02, -0.01, 0.01, 0, 0]
    width = np.log(_try._speedup_of(noise).high)
    for log, verdict in ((0.0004, "undecided"), (0.002, "faster"), (-0.0004, "undecided"), (-0.002, "slower")):
        trials = _try._PairedTrials(1)
        for disturbance in noise:
            trials.add_round({0: np.exp(log + np.copysign(width, log) + disturbance), 1: 1.0})
        assert trials.verdict == verdict


def test_meshes_come_as_reorder_returns_them():
    points, cells = tetrahedra(4)
    seen = []

    def solver(mesh):
        seen.append(mesh)
        return 1.0

    trial = meshorder.try_orders((points, cells), solver, budget=1, time=lambda seconds: seconds)
    assert trial.verdict == "tie"
    assert {order.name for order in trial.orders} >= {"original", "rcm", "hilbert"}
    assert all(isinstance(mesh, tuple) and mesh[0].shape == points.shape for mesh in seen)
    assert seen[0][0] is points
    trial = meshorder.try_orders((points, cells), solver, ["rcm/original"], budget=1, time=lambda seconds: seconds)
    assert [order.name for order in trial.orders] == ["original", "rcm/original"]


def test_processor_time_and_the_clock_count(graph):
    for clock in ("cpu", "wall"):
        trial = meshorder.try_orders(graph, lambda a: (a @ a).sum(), ["rcm"], budget=0.2, time=clock)
        assert (trial.orders[0].time or 0) > 0


def test_geometric_orders_are_left_out_where_there_are_no_coordinates(graph):
    trial = meshorder.try_orders(graph, lambda a: 1.0, budget=0.5, time=lambda seconds: seconds)
    assert not any("hilbert" in order.name for order in trial.orders)
    with pytest.raises(InvalidArgument, match="coordinates"):
        meshorder.try_orders(graph, lambda a: 1.0, ["hilbert"], budget=0.5)


def test_results_must_agree(graph):
    assert meshorder.try_orders(graph, lambda a: a.sum(), ["rcm"], budget=0.05, tolerance=1e-9).best == "rcm"
    with pytest.raises(InvalidArgument, match="only in the original order; in rcm the results differ"):
        meshorder.try_orders(graph, mean_span, ["rcm"], budget=0.05, tolerance=1e-9)
    numbers = iter([1.0, 1.0, 2.0])
    with pytest.raises(InvalidArgument, match="in two runs in the original order"):
        meshorder.try_orders(graph, lambda a: next(numbers), ["rcm"], budget=1, tolerance=1e-9)


@pytest.mark.parametrize("result", [None, float("nan"), [np.nan, np.inf], [], "text", {}, [[1], [1, 2]]])
def test_results_that_are_no_numbers_do_not_agree(graph, result):
    with pytest.raises(InvalidArgument, match="nothing to compare: the function returned "):
        meshorder.try_orders(graph, lambda a: result, ["rcm"], budget=0.05, tolerance=1e-9)


def test_exceptions_of_the_function_pass_through(graph):
    with pytest.raises(ZeroDivisionError):
        meshorder.try_orders(graph, lambda a: 1 / 0)


@pytest.mark.parametrize(
    "arguments, match",
    [
        ({"budget": 0}, "budget"),
        ({"time": "clock"}, "time: expected 'cpu', 'wall' or a function"),
        ({"methods": ["best"]}, "best"),
        ({"methods": ["rcm/lexmax"]}, "a matrix has no elements"),
        ({"time": lambda result: 0}, "cannot be compared"),
        ({"time": lambda result: float("nan")}, "a time of nan cannot be compared"),
        ({"time": lambda result: float("inf")}, "a time of inf cannot be compared"),
        ({"tolerance": 1e-6}, "nothing to compare: the function returned None"),
    ],
)
def test_bad_arguments(graph, arguments, match):
    with pytest.raises(InvalidArgument, match=match):
        meshorder.try_orders(graph, lambda a: None, **{"budget": 0.1, **arguments})
    with pytest.raises(InvalidArgument, match="a SciPy matrix"):
        meshorder.try_orders("mesh.msh", lambda a: None, ["rcm"])
    with pytest.raises(InvalidArgument, match="function"):
        meshorder.try_orders(graph, typing.cast(typing.Any, "solver"))


def test_orders_that_are_all_the_same_are_rarely_called_different():
    wrong = 0
    random = np.random.default_rng(1)
    for _ in range(200):
        trials = _try._PairedTrials(5)
        runs = 6
        while (each := trials.next_round()) and runs + len(each) <= 120:
            disturbed = {k: random.random() < 0.05 for k in each}
            trials.add_round({
                k: np.exp(0.02 * random.standard_normal()) * (1 + disturbed[k] * random.random() / 2) for k in each
            })  # fmt: skip
            runs += len(each)
        wrong += trials.verdict in ("faster", "slower")
    assert wrong <= 10


def test_intervals_are_those_of_the_command():
    """The numbers that tests/payoff/paired_trials_test.cpp expects of the C++ code."""
    for tail, degrees, expected in ((0.025, 1, 12.7062), (0.025, 2, 4.30265), (0.005, 3, 5.84091), (0.001, 7, 4.78529)):
        assert _try._student_quantile(tail, degrees) == pytest.approx(expected, rel=1e-5)
    found = _try._speedup_of([0.10, 0.11, 0.09, 0.10, 0.12, 0.08, 0.10, 0.11, 0.09, -3])
    assert found == pytest.approx((1.1033305, 1.0794101, 1.1277810), abs=1e-6)
    found = _try._speedup_of([0.10, 0.11, 0.09, 0.12], [0.01, -0.02])
    assert found == pytest.approx((1.1107106, 1.0753893, 1.1471920), abs=1e-6)
