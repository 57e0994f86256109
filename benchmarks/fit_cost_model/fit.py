#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Fits the cost model to a table of collect.py, on half of the meshes, and says how it does on the other half.

    fit.py TABLE.csv [--page docs/prediction.md] [--plot docs/pictures/prediction.svg]

Prints the coefficients as C++, for src/meshorder/study/cost_model.cpp. Times are fitted by non-negative least squares
of relative errors; every second mesh by size is left out. The coefficients printed come from the fitting half alone,
so that what is said of the other half holds of them.
"""
import argparse
import collections
import csv
import itertools
import pathlib

import numpy
from scipy.optimize import nnls
from scipy.stats import pearsonr, spearmanr

KERNELS = {"spmv": "SpMV", "element": "element force", "assembly": "assembly", "springs": "springs"}
FEATURES = ["accesses", "miss1", "miss2", "miss3", "jump1", "jump2", "jump3"]
DIFFERENT = 0.1


def read(table):
    """By kernel: rows of (mesh, order, features, best ms)."""
    rows = collections.defaultdict(list)
    sizes = {}
    with open(table) as file:
        for row in csv.DictReader(file):
            sizes[row["mesh"]] = int(row["vertices"])
            rows[row["kernel"]].append((row["mesh"], row["order"], [float(row[f]) for f in FEATURES],
                                        float(row["best_ms"])))
    return rows, sorted(sizes, key=sizes.get), sizes


def fit(features, times):
    """Milliseconds a count, none negative."""
    scale = features.max(axis=0) + 1
    scaled, _ = nnls(features / scale / times[:, None], numpy.ones(len(times)))
    return scaled / scale


def mean_within(meshes, statistic):
    """The mean over meshes of a statistic of (predicted, measured), and its least."""
    values = [statistic(p, t) for p, t in meshes.values() if len(t) > 2]
    return numpy.mean(values), min(values)


def agreeing_pairs(meshes):
    """Of the pairs of orders of one mesh whose times differ by more than DIFFERENT: how many, and the share whose
    faster one is told."""
    right = total = 0
    for predicted, measured in meshes.values():
        for i, j in itertools.combinations(range(len(measured)), 2):
            if max(measured[i], measured[j]) < (1 + DIFFERENT) * min(measured[i], measured[j]):
                continue
            total += 1
            right += (predicted[i] - predicted[j]) * (measured[i] - measured[j]) > 0
    return total, right / max(total, 1)


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
    parser.add_argument("--plot", type=pathlib.Path, help="predicted against measured, as SVG")
    return parser.parse_args()


def initialiser(kernel, coefficients):
    numbers = [f"{1e6 * c:.4g}" for c in coefficients]
    return (f"    {{.access = {numbers[0]}, .miss = {{{', '.join(numbers[1:4])}}}, "
            f".jump = {{{', '.join(numbers[4:])}}}}},  // {kernel}")


def tables(rows, meshes, left_out, sizes, results):
    lines = ["| kernel | Spearman | least of a mesh | Pearson | pairs > 10 % apart | of these told right | "
             "ratios off by (median) | (90 %) |", "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"]
    for kernel, title in KERNELS.items():
        outside = {m: results[kernel][m] for m in left_out}
        rank, least = mean_within(outside, lambda p, t: spearmanr(p, t)[0])
        linear, _ = mean_within(outside, lambda p, t: pearsonr(p, t)[0])
        total, right = agreeing_pairs(outside)
        median, most = ratio_errors(outside)
        lines.append(f"| {title} | {rank:.2f} | {least:.2f} | {linear:.2f} | {total} | {100 * right:.0f} % | "
                     f"{100 * (median - 1):.0f} % | {100 * (most - 1):.0f} % |")
    lines += ["", "The meshes left out, slowest order against fastest, predicted / measured:", "",
              "| mesh | vertices | " + " | ".join(KERNELS.values()) + " |", "| --- | ---: |" + " ---: |" * len(KERNELS)]
    for mesh in left_out:
        cells = []
        for kernel in KERNELS:
            predicted, measured = results[kernel][mesh]
            slow, fast = measured.argmax(), measured.argmin()
            cells.append(f"{predicted[slow] / predicted[fast]:.2f} / {measured[slow] / measured[fast]:.2f}")
        lines.append(f"| {mesh} | {sizes[mesh]:,} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def plot(path, left_out, results):
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "meshorder"
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(1, 4, figsize=(13, 3.6), constrained_layout=True)
    for axis, (kernel, title) in zip(axes, KERNELS.items()):
        for mesh in left_out:
            predicted, measured = results[kernel][mesh]
            axis.plot(measured / measured.min(), predicted / predicted[measured.argmin()], ".", label=mesh)
        top = max(axis.get_xlim()[1], axis.get_ylim()[1])
        axis.plot([0.8, top], [0.8, top], color="grey", linewidth=0.7)
        axis.set(title=title, xscale="log", yscale="log", xlabel="measured: times the fastest order")
    axes[0].set_ylabel("predicted: times that order")
    axes[-1].legend(fontsize=6)
    figure.savefig(path, metadata={"Date": None})


def main():
    given = arguments()
    rows, meshes, sizes = read(given.table)
    fitting, left_out = meshes[0::2], meshes[1::2]
    results, table = {}, []
    for kernel in KERNELS:
        of_fitting = [row for row in rows[kernel] if row[0] in fitting]
        coefficients = fit(numpy.array([row[2] for row in of_fitting]), numpy.array([row[3] for row in of_fitting]))
        results[kernel] = evaluate(rows[kernel], meshes, coefficients)
        table.append(initialiser(kernel, coefficients))
    print("\n".join(table))
    text = tables(rows, meshes, left_out, sizes, results)
    print(text)
    if given.page:
        page = given.page.read_text()
        begin, end = page.index("<!-- fit.py"), page.index("<!-- /fit.py -->")
        begin = page.index("\n", begin) + 1
        given.page.write_text(page[:begin] + "\n" + text + "\n\n" + page[end:])
    if given.plot:
        plot(given.plot, left_out, results)


if __name__ == "__main__":
    main()
