#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Measures how well times are predicted on this machine: with the built-in costs, and with its own calibration.

    judge.py MEASURE [--budget SECONDS] [--threads N] [--table TABLE.csv] [--calibrations FILE FILE] [MESH …]

MEASURE is the program build/bin/measure. Each mesh is timed in some orders and predicted for each of MACHINES (see
measure.cpp). Prints the tables of docs/prediction.md. The two halves of each measurement are compared, too: a prediction
cannot be more accurate than a repetition. The regret of a choice is how much slower its order is than the fastest one that
was timed, in both halves; "one half by the other" chooses the order that was fastest in the other half. --table keeps the
lines of MEASURE in a file; meshes in the file are not measured again. --calibrations compares the predictions of two files
of `meshorder calibrate`, in place of the stored calibration.
"""
import argparse
import itertools
import math
import pathlib
import statistics
import subprocess

KERNELS = {"spmv": "SpMV", "element": "element force", "assembly": "assembly", "springs": "springs"}
MACHINES = {"prior": "zen3, with the caches of this machine"}
CALIBRATED = ("calibrated here", "calibrated here again")
MESHES = ["grid-17", "ball-24", "torus-12", "bunny", "grid-32", "armadillo", "dragon", "torus-20", "ball-45", "grid-64"]
OWN = "original/original"
ORDERS = ["scrambled/scrambled", OWN, "hilbert/lexmax", "hilbert-fronts/lexmax", "bfs/lexmax", "rcm/lexmax", "spectral/lexmax"]
DIFFERENT = 0.1
#: factor below which the verdict of a calibrated machine sees no difference (docs/prediction.md)
SAME = 1.05


def measured(arguments):
    """Returns {kernel: {mesh: (vertices, {order: (one half, the other, predicted…)})}} and {kernel: {mesh: auto's order}}."""
    lines = arguments.table.read_text().splitlines() if arguments.table and arguments.table.exists() else []
    for mesh in arguments.meshes:
        if any(line.startswith(f"{mesh},") for line in lines):
            continue
        command = [arguments.measure, mesh, str(arguments.budget), str(arguments.threads),
                   ",".join([*MACHINES, *arguments.calibrations]), *arguments.orders]
        lines += subprocess.check_output(command, text=True).split()
        if arguments.table:
            arguments.table.write_text("\n".join(lines) + "\n")
    result = {kernel: {} for kernel in KERNELS}
    chosen = {kernel: {} for kernel in KERNELS}
    for line in lines:
        mesh, vertices, order, kernel, *times = line.split(",")
        if order == "auto":
            chosen[kernel][mesh] = times[0]
        else:
            result[kernel].setdefault(mesh, (int(vertices), {}))[1][order] = [float(time) for time in times]
    return result, chosen


def pairs(meshes, column):
    """Yields the logarithms of the measured ratio and of the ratio in `column`, for each pair of orders of each mesh."""
    for _, orders in meshes.values():
        for a, b in itertools.combinations(orders.values(), 2):
            yield math.log(min(a[:2]) / min(b[:2])), math.log(a[column] / b[column])


def errors(meshes, column):
    off = sorted(math.exp(abs(measured - predicted)) - 1 for measured, predicted in pairs(meshes, column))
    far = [(m, p) for m, p in pairs(meshes, column) if abs(m) > math.log(1 + DIFFERENT)]
    right = sum(m * p > 0 for m, p in far)
    return f"{100 * statistics.median(off):.0f} % | {100 * off[int(0.9 * len(off))]:.0f} % | {right} of {len(far)}"


def regrets(orders, pick_in):
    """Yields, for each half, how much slower the order named by `pick_in(half)` is than the fastest one there."""
    for half in (0, 1):
        best = min(times[half] for times in orders.values())
        yield orders[pick_in(half)][half] / best - 1


def regret(meshes, pick):
    """Returns the mean and the largest regret of the order that `pick(mesh, orders, half)` names for each mesh."""
    of_all = [one for mesh, (_, orders) in meshes.items()
              for one in regrets(orders, lambda half, mesh=mesh, orders=orders: pick(mesh, orders, half))]
    return f"{100 * statistics.mean(of_all):.1f} % | {100 * max(of_all):.0f} %"


def fastest(orders, column):
    return min(orders, key=lambda order: orders[order][column])


def verdict(orders, column, same):
    """Returns the order with the least predicted time, or the file's own if that is no worse."""
    best = fastest(orders, column)
    return OWN if orders[OWN][column] < same * orders[best][column] else best


def nothing_to_gain(meshes, column, same):
    """Returns how many verdicts "nothing to gain" are wrong (an order is faster by `same` or more), and of how many."""
    said = [orders for _, orders in meshes.values() if verdict(orders, column, same) == OWN]
    wrong = sum(min(orders[OWN][:2]) >= same * min(min(times[:2]) for times in orders.values()) for orders in said)
    return f"{wrong} of {len(said)}"


def print_regrets(results, chosen, column):
    """Prints the table of regrets."""
    print("\n| kernel | choice | regret: mean | largest | \"nothing to gain\" wrong |")
    print("| --- | --- | ---: | ---: | ---: |")
    for kernel, title in KERNELS.items():
        meshes = results[kernel]
        print(f"| {title} | one half by the other | {regret(meshes, lambda _, orders, half: fastest(orders, 1 - half))} | |")
        print(f"| {title} | `auto` | {regret(meshes, lambda mesh, orders, _, kernel=kernel: chosen[kernel][mesh])} | |")
        print(f"| {title} | the verdict | {regret(meshes, lambda _, orders, __: verdict(orders, column, SAME))} | "
              f"{nothing_to_gain(meshes, column, SAME)} |")


def repeated(meshes, one, other):
    off = sorted(math.exp(abs(math.log(a[one] / b[one]) - math.log(a[other] / b[other]))) - 1
                 for _, orders in meshes.values() for a, b in itertools.combinations(orders.values(), 2))
    return f"{100 * statistics.median(off):.0f} % | {100 * off[int(0.9 * len(off))]:.0f} % |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("measure")
    parser.add_argument("meshes", nargs="*", default=MESHES)
    parser.add_argument("--budget", type=float, default=20, help="seconds a mesh, preparation not counted")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--orders", type=lambda text: text.split(","), default=ORDERS)
    parser.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--calibrations", nargs=2, default=["this"])
    arguments = parser.parse_args()
    results, chosen = measured(arguments)
    machines = [*MACHINES.values(), *CALIBRATED[:len(arguments.calibrations)]]
    print("| kernel | predicted by | ratio of two times off by: median | 90 % | pairs > 10 % apart told right |")
    print("| --- | --- | ---: | ---: | ---: |")
    for kernel, title in KERNELS.items():
        for place, machine in enumerate(machines):
            print(f"| {title} | {machine} | {errors(results[kernel], 2 + place)} |")
        print(f"| {title} | the measurement itself, once more | {repeated(results[kernel], 0, 1)} |")
        if len(arguments.calibrations) == 2:
            print(f"| {title} | one calibration by the other | {repeated(results[kernel], -2, -1)} |")
    print_regrets(results, chosen, 2 + len(MACHINES))
    print("\nScrambled over hilbert/lexmax, predicted as calibrated here / measured:\n")
    print("| mesh | vertices | " + " | ".join(KERNELS.values()) + " |")
    print("| --- | ---: |" + " ---: |" * len(KERNELS))
    for mesh, (vertices, _) in results["spmv"].items():
        cells = []
        for kernel in KERNELS:
            slow, fast = (results[kernel][mesh][1][order] for order in ("scrambled/scrambled", "hilbert/lexmax"))
            calibrated = 2 + len(MACHINES)
            cells.append(f"{slow[calibrated] / fast[calibrated]:.2f} / {min(slow[:2]) / min(fast[:2]):.2f}")
        print(f"| {mesh} | {vertices:,} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
