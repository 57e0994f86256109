#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""How well times are predicted on this machine: by the costs that ship, and by its own calibration.

    judge.py MEASURE [--budget SECONDS] [--table TABLE.csv] [--calibrations FILE FILE] [MESH …]

MEASURE is the program build/bin/measure. Each mesh is timed in some orders and predicted for each of MACHINES (see
measure.cpp); the tables that docs/prediction.md holds are printed. Both halves of each measurement are compared, too:
nothing can be predicted better than it repeats. With --table, lines of MEASURE are kept there, and meshes that it holds
are not measured again. With --calibrations, two files of `meshorder calibrate` take the place of the one that is stored,
and what they predict is compared.
"""
import argparse
import itertools
import math
import pathlib
import statistics
import subprocess

KERNELS = {"spmv": "SpMV", "element": "element force", "assembly": "assembly", "springs": "springs"}
MACHINES = {"zen5": "zen5", "prior": "zen5, caches of this machine"}
CALIBRATED = ("calibrated here", "calibrated here again")
MESHES = ["grid-17", "ball-24", "torus-12", "grid-32", "torus-20", "ball-45", "grid-64"]
ORDERS = ["scrambled/scrambled", "original/original", "hilbert/lexmax", "fiedler/lexmax", "bfs/lexmax", "spectral/lexmax"]
DIFFERENT = 0.1


def measured(arguments):
    """By kernel and mesh: (vertices, by order (one half, the other, predicted…))."""
    lines = arguments.table.read_text().splitlines() if arguments.table and arguments.table.exists() else []
    for mesh in arguments.meshes:
        if any(line.startswith(f"{mesh},") for line in lines):
            continue
        command = [arguments.measure, "judge", mesh, str(arguments.budget), ",".join([*MACHINES, *arguments.calibrations]), *ORDERS]
        lines += subprocess.check_output(command, text=True).split()
        if arguments.table:
            arguments.table.write_text("\n".join(lines) + "\n")
    result = {kernel: {} for kernel in KERNELS}
    for line in lines:
        mesh, vertices, order, kernel, *times = line.split(",")
        result[kernel].setdefault(mesh, (int(vertices), {}))[1][order] = [float(time) for time in times]
    return result


def pairs(meshes, column):
    """(log of the measured ratio, of the ratio in `column`) of each two orders of each mesh."""
    for _, orders in meshes.values():
        for a, b in itertools.combinations(orders.values(), 2):
            yield math.log(min(a[:2]) / min(b[:2])), math.log(a[column] / b[column])


def errors(meshes, column):
    off = sorted(math.exp(abs(measured - predicted)) - 1 for measured, predicted in pairs(meshes, column))
    far = [(m, p) for m, p in pairs(meshes, column) if abs(m) > math.log(1 + DIFFERENT)]
    right = sum(m * p > 0 for m, p in far)
    return f"{100 * statistics.median(off):.0f} % | {100 * off[int(0.9 * len(off))]:.0f} % | {right} of {len(far)}"


def repeated(meshes, one, other):
    off = sorted(math.exp(abs(math.log(a[one] / b[one]) - math.log(a[other] / b[other]))) - 1
                 for _, orders in meshes.values() for a, b in itertools.combinations(orders.values(), 2))
    return f"{100 * statistics.median(off):.0f} % | {100 * off[int(0.9 * len(off))]:.0f} % |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("measure")
    parser.add_argument("meshes", nargs="*", default=MESHES)
    parser.add_argument("--budget", type=float, default=20, help="seconds a mesh, preparation not counted")
    parser.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--calibrations", nargs=2, default=["this"])
    arguments = parser.parse_args()
    results = measured(arguments)
    machines = [*MACHINES.values(), *CALIBRATED[:len(arguments.calibrations)]]
    print("| kernel | predicted by | ratio of two times off by: median | 90 % | pairs > 10 % apart told right |")
    print("| --- | --- | ---: | ---: | ---: |")
    for kernel, title in KERNELS.items():
        for place, machine in enumerate(machines):
            print(f"| {title} | {machine} | {errors(results[kernel], 2 + place)} |")
        print(f"| {title} | the measurement itself, once more | {repeated(results[kernel], 0, 1)} |")
        if len(arguments.calibrations) == 2:
            print(f"| {title} | one calibration by the other | {repeated(results[kernel], -2, -1)} |")
    print("\nScrambled over hilbert/lexmax, predicted by zen5 / calibrated here / measured:\n")
    print("| mesh | vertices | " + " | ".join(KERNELS.values()) + " |")
    print("| --- | ---: |" + " ---: |" * len(KERNELS))
    for mesh, (vertices, _) in results["spmv"].items():
        cells = []
        for kernel in KERNELS:
            slow, fast = (results[kernel][mesh][1][order] for order in ("scrambled/scrambled", "hilbert/lexmax"))
            cells.append(f"{slow[2] / fast[2]:.2f} / {slow[4] / fast[4]:.2f} / {min(slow[:2]) / min(fast[:2]):.2f}")
        print(f"| {mesh} | {vertices:,} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
