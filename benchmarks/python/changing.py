#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""What it costs to keep an order fresh, and how near to a fresh one it stays.

Usage: changing.py [TRACE…] [--points N] [--steps N] [--json FILE]

Traces, all of tetrahedra by SciPy's Delaunay triangulation, scrambled at first:
  stir    points turn in four rolls
  churn   the same, and 2 % of them are taken out and put elsewhere in each step
  refine  points gather around a place that travels
  cut     points above and below a plane that grows drift apart
A strategy orders all vertices in each step (fresh), or is a Reorderer (kept). Prints the mean of log2 spans above the fresh order's, in
the mean of the steps and in the worst, and the time beside that of the fresh orders. To be run by a Python that has meshorder.
"""
import argparse
import json
import pathlib
import time

import numpy
from scipy.spatial import Delaunay

import meshorder

METHODS = ("hilbert", "hilbert-fronts", "rcm", "fiedler")


def rolls(points, step):
    """The velocity of Taylor's and Green's cells, slipping along the walls."""
    x, y = numpy.pi * points[:, 0], 2 * numpy.pi * points[:, 1]
    return numpy.stack([2 * numpy.sin(x) * numpy.cos(y), -numpy.cos(x) * numpy.sin(y),
                        0.3 * numpy.sin(2 * numpy.pi * points[:, 2]) * numpy.cos(step / 5)], axis=1)


class Trace:
    """Points of each step, with the place of each in the step before."""

    def __init__(self, name, count):
        self.name = name
        self.random = numpy.random.default_rng(1)
        self.points = self.random.random((count, 3))
        self.spacing = count ** (-1 / 3)

    def step(self, number):
        count = len(self.points)
        previous = numpy.arange(count)
        if self.name in ("stir", "churn"):
            self.points += 0.15 * self.spacing * rolls(self.points, number)
        if self.name == "churn":
            gone = self.random.choice(count, count // 50, replace=False)
            self.points[gone] = self.random.random((len(gone), 3))
            previous[gone] = -1
        if self.name == "refine":
            middle = 0.5 + 0.3 * numpy.array([numpy.cos(number / 20), numpy.sin(number / 20), 0])
            far = numpy.linalg.norm(self.points - middle, axis=1)
            gone = self.random.choice(numpy.flatnonzero(far > 0.3), count // 100, replace=False)
            self.points[gone] = middle + 0.15 * self.random.normal(size=(len(gone), 3))
            previous[gone] = -1
        if self.name == "cut":
            reach = numpy.clip(number / 60 - self.points[:, 0], 0, 1)
            self.points[:, 1] += 0.01 * reach * numpy.sign(self.points[:, 1] - 0.5)
        return previous


class Strategy:
    """An order of the points: the point at each place."""

    def __init__(self, method, kept):
        self.method = method
        self.reorderer = meshorder.Reorderer(method, threads=1, check="fast") if kept else None
        self.seconds = 0
        self.spans = []
        self.repairs = {}
        self.at = None

    def step(self, graph, points, previous):
        """Takes the graph and points in their own numbers."""
        count = len(points)
        if self.at is None:
            self.at = numpy.random.default_rng(2).permutation(count)
            previous = numpy.full(count, -1)
        place = numpy.empty(count, numpy.int64)
        place[self.at] = numpy.arange(count)
        matrix = meshorder.Permutation(new_to_old=self.at).move(graph)
        moved = points[self.at]
        if self.reorderer is None:
            begin = time.thread_time()
            update = meshorder.order(matrix, self.method, points=moved, threads=1, check="fast")
            self.seconds += time.thread_time() - begin
        else:
            before = previous[self.at]
            before = numpy.where(before >= 0, place[before], -1)
            begin = time.thread_time()
            update = self.reorderer.update(matrix, points=moved, previous=before)
            self.seconds += time.thread_time() - begin
            self.repairs[update.repair] = self.repairs.get(update.repair, 0) + 1
        self.at = self.at[update.new_to_old]
        self.spans.append(meshorder.quality(matrix, update.permutation).mean_log2_span)


def graph_of(points):
    indptr, indices = Delaunay(points).vertex_neighbor_vertices
    import scipy.sparse
    return scipy.sparse.csr_array((numpy.ones(len(indices), numpy.float32), indices, indptr), shape=(len(points),) * 2)


def run(name, count, steps):
    trace = Trace(name, count)
    strategies = {(method, kept): Strategy(method, kept) for method in METHODS for kept in (False, True)}
    previous = None
    for number in range(steps):
        graph = graph_of(trace.points)
        for strategy in strategies.values():
            strategy.step(graph, trace.points, previous)
        previous = trace.step(number)
    rows = []
    for method in METHODS:
        fresh, kept = strategies[method, False], strategies[method, True]
        above = numpy.array(kept.spans) / numpy.array(fresh.spans) - 1
        rows.append({"trace": name, "method": method, "points": count, "steps": steps, "span": fresh.spans[-1],
                     "above_mean": above.mean(), "above_worst": above.max(), "fresh_seconds": fresh.seconds,
                     "kept_seconds": kept.seconds, "repairs": kept.repairs})
        print(f"| {name} | {method} | {fresh.spans[-1]:.2f} | {100 * above.mean():+.1f} %, {100 * above.max():+.1f} % | "
              f"{1e3 * fresh.seconds / steps:.1f} ms | {100 * kept.seconds / fresh.seconds:.0f} % | "
              + ", ".join(f"{number} {repair}" for repair, number in kept.repairs.items()) + " |", flush=True)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("traces", nargs="*", default=["stir", "churn", "refine", "cut"])
    parser.add_argument("--points", type=int, default=50_000)
    parser.add_argument("--steps", type=int, default=120)
    parser.add_argument("--json", type=pathlib.Path)
    arguments = parser.parse_args()
    print("| trace | method | mean log2 span | kept: above fresh, mean and worst | fresh | kept / fresh | repairs |")
    print("| --- | --- | ---: | ---: | ---: | ---: | --- |")
    rows = [row for name in arguments.traces for row in run(name, arguments.points, arguments.steps)]
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
