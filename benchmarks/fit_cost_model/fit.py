#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Fits the cost model to a table of collect.py and says how well it predicts meshes that it was not fitted to.

    fit.py TABLE.csv [--page docs/prediction.md]

Prints the coefficients as C++, for src/payoff/cost_model.cpp: non-negative least squares of relative errors, for
tetrahedra over the meshes of these, for triangles over all meshes. What it says of their worth is of two other fits: each half of the meshes, every second one by size,
is predicted by a fit to the other half.
"""
import argparse
import collections
import csv
import itertools
import pathlib
import textwrap

import numpy
from scipy.optimize import nnls
from scipy.stats import spearmanr

KERNELS = {"spmv": "SpMV", "element": "element force", "assembly": "assembly", "springs": "springs"}
# the machine's, and half of its last one, as cost_model.hpp has it
LEVELS = ["48K", "1M", "16M", "32M"]
FEATURES = ["accesses", *(f"miss_{c}" for c in LEVELS), *(f"jump_{c}" for c in LEVELS), "repeats"]
# gathered accesses that wait for the memory together, as cost_model.cpp has it
TOGETHER = 32
DIFFERENT = 0.1


def waits(row):
    """See counts_of in src/payoff/cost_model.cpp."""
    gathers = float(row["gathers"])
    hits = max(0.0, 1 - float(row[f"jump_{LEVELS[-1]}"]) / gathers) if gathers else 1.0
    return gathers / TOGETHER * (1 - hits**TOGETHER)


def read(table):
    """By kernel: rows of (mesh, order, features, best ms); the meshes by size, their sizes and dimensions."""
    rows = collections.defaultdict(list)
    sizes, dimensions = {}, {}
    with open(table) as file:
        for row in csv.DictReader(file):
            sizes[row["mesh"]] = int(row["vertices"])
            dimensions[row["mesh"]] = int(row["dimension"])
            features = [*(float(row[f]) for f in FEATURES), waits(row)]
            rows[row["kernel"]].append((row["mesh"], row["order"], features, float(row["best_ms"])))
    return rows, sorted(sizes, key=sizes.get), sizes, dimensions


def fit(features, times):
    """Milliseconds a count, none negative."""
    scale = features.max(axis=0) + 1
    scaled, _ = nnls(features / scale / times[:, None], numpy.ones(len(times)))
    return scaled / scale


def mean_within(meshes, statistic):
    """The mean over meshes of a statistic of (predicted, measured), and its least."""
    values = [statistic(p, t) for p, t in meshes.values() if len(t) > 2]
    return numpy.mean(values), min(values)


def agreeing_pairs(meshes, judge):
    """Of the pairs of orders of one mesh whose times differ by more than DIFFERENT, as judged by entry `judge` of
    (predicted, measured): how many, and the share whose faster one prediction and measurement agree on."""
    right = total = 0
    for times in meshes.values():
        predicted, measured = times
        for i, j in itertools.combinations(range(len(measured)), 2):
            if max(times[judge][i], times[judge][j]) < (1 + DIFFERENT) * min(times[judge][i], times[judge][j]):
                continue
            total += 1
            right += (predicted[i] - predicted[j]) * (measured[i] - measured[j]) > 0
    return total, right / max(total, 1)


def pooled_rank(results):
    """Spearman's correlation of the speedups over the scrambled order, the first one, of all orders of all meshes."""
    speedups = []
    for predicted, measured in results.values():
        speedups += zip(predicted[0] / predicted[1:], measured[0] / measured[1:])
    return spearmanr(*zip(*speedups))[0]


def noise(rows, meshes):
    """How far apart two timings of the same problem are: kernels that see vertices alone, hilbert/lexmax and
    hilbert/hilbert. The median and the greatest, as ratios."""
    times = {(m, o): t for m, o, _, t in rows}
    off = [numpy.exp(abs(numpy.log(times[m, "hilbert/lexmax"] / times[m, "hilbert/hilbert"]))) for m in meshes]
    return numpy.median(off), max(off)


def ratio_errors(meshes):
    """Over all pairs of orders of one mesh: by which factor the predicted ratio of times is off."""
    factors = []
    for predicted, measured in meshes.values():
        for i, j in itertools.combinations(range(len(measured)), 2):
            off = abs(numpy.log(predicted[i] / predicted[j] / (measured[i] / measured[j])))
            factors.append(numpy.exp(off))
    return numpy.median(factors), numpy.percentile(factors, 90)


def evaluate(rows, meshes, coefficients):
    result = {}
    for mesh in meshes:
        of_mesh = [(numpy.dot(f, coefficients), t) for m, _, f, t in rows if m == mesh]
        result[mesh] = tuple(numpy.array(column) for column in zip(*of_mesh))
    return result


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--page", type=pathlib.Path, help="the page whose tables are written anew")
    return parser.parse_args()


def initialiser(kernel, coefficients):
    numbers = [f"{1e6 * c:.4g}" for c in coefficients]
    return (f"    {{.access = {numbers[0]}, .miss = {{{', '.join(numbers[1:5])}}}, .jump = {{{', '.join(numbers[5:9])}}}, "
            f".repeat = {numbers[9]}, .wait = {{0, 0, {numbers[10]}}}}},  // {kernel}")


def tables(rows, meshes, sizes, results):
    def percent(share):
        return f"{100 * share:.0f} %"

    lines = ["| kernel | rank correlation within a mesh: mean | least | of speedups over scrambled, all meshes | "
             "measured > 10 % apart: pairs | told right | predicted > 10 % apart: pairs | told right | "
             "ratio of two times off by: median | 90 % |", "| --- |" + " ---: |" * 9]
    for kernel, title in KERNELS.items():
        rank, least = mean_within(results[kernel], lambda p, t: spearmanr(p, t)[0])
        pairs, right = agreeing_pairs(results[kernel], 1)
        claimed, kept = agreeing_pairs(results[kernel], 0)
        median, most = ratio_errors(results[kernel])
        lines.append(f"| {title} | {rank:.2f} | {least:.2f} | {pooled_rank(results[kernel]):.2f} | {pairs} | "
                     f"{percent(right)} | {claimed} | {percent(kept)} | {percent(median - 1)} | {percent(most - 1)} |")
    for kernel in ("spmv", "springs"):
        median, most = noise(rows[kernel], meshes)
        text = (f"{KERNELS[kernel]} timed twice on the same problem in one run (under `hilbert/lexmax` and "
                f"`hilbert/hilbert`, which differ in elements alone) differs by {percent(median - 1)} in the median of the "
                f"{len(meshes)} meshes, by {percent(most - 1)} at most.")
        lines += ["", textwrap.fill(text, 112, break_on_hyphens=False)]
    lines += ["", "The scrambled order against `hilbert/lexmax`, predicted / measured:", "",
              "| mesh | vertices | " + " | ".join(KERNELS.values()) + " |", "| --- | ---: |" + " ---: |" * len(KERNELS)]
    for mesh in meshes:
        orders = [order for m, order, _, _ in rows["spmv"] if m == mesh]
        slow, fast = orders.index("scrambled/scrambled"), orders.index("hilbert/lexmax")
        cells = []
        for kernel in KERNELS:
            predicted, measured = results[kernel][mesh]
            cells.append(f"{predicted[slow] / predicted[fast]:.2f} / {measured[slow] / measured[fast]:.2f}")
        lines.append(f"| {mesh} | {sizes[mesh]:,} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def fit_to(rows, meshes):
    of_meshes = [row for row in rows if row[0] in meshes]
    return fit(numpy.array([row[2] for row in of_meshes]), numpy.array([row[3] for row in of_meshes]))


def main():
    given = arguments()
    rows, meshes, sizes, dimensions = read(given.table)
    solid = [mesh for mesh in meshes if dimensions[mesh] == 3]
    flat = [mesh for mesh in meshes if dimensions[mesh] < 3]
    for name, fitted in ((".solid", solid), (".flat", meshes)):
        print(name)
        for kernel in KERNELS:
            print(initialiser(kernel, fit_to(rows[kernel], fitted)))
    results = {}
    for kernel in KERNELS:
        results[kernel] = {}
        for fitting, left_out in ((meshes[0::2], meshes[1::2]), (meshes[1::2], meshes[0::2])):
            for of_dimension, fitted in ((solid, [mesh for mesh in fitting if mesh in solid]), (flat, fitting)):
                predicted = [mesh for mesh in left_out if mesh in of_dimension]
                results[kernel].update(evaluate(rows[kernel], predicted, fit_to(rows[kernel], fitted)))
    text = tables(rows, meshes, sizes, results)
    print(text)
    if given.page:
        page = given.page.read_text()
        begin, end = page.index("<!-- fit.py"), page.index("<!-- /fit.py -->")
        begin = page.index("\n", begin) + 1
        given.page.write_text(page[:begin] + "\n" + text + "\n\n" + page[end:])


if __name__ == "__main__":
    main()
