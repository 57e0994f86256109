#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Measures what the cost model is fitted to: every kernel in every order on many meshes, with what the reuse model
says of each, as one CSV table.

    collect.py MEASURE TABLE.csv [--predict-with COMMAND] [--time-with COMMAND] [MESH …]

MEASURE is the program build/bin/measure (benchmarks/fit_cost_model/measure.cpp). Meshes that the table holds already
are left alone, so that it can be collected in pieces. The two COMMANDs stand before each run: one that waits until
nothing else runs on the machine, say, before those that take times.
"""
import argparse
import csv
import pathlib
import shlex
import subprocess
import tempfile

# more sizes than a machine has caches: what part of a shared one a thread has is seen by fitting
CACHES = ["32K", "48K", "256K", "512K", "1M", "2M", "4M", "8M", "10M", "16M", "20M", "32M"]
COLUMNS = ["mesh", "vertices", "simplices", "dimension", "order", "kernel", "accesses", "gathers", *(f"miss_{c}" for c in CACHES),
           *(f"jump_{c}" for c in CACHES), "repeats", "best_ms", "median_ms", "samples"]

# anybody can make them, on any machine
MESHES = ["grid-17", "torus-12", "ball-24", "grid-64-skin", "grid-32", "bunny", "ball-80-skin", "armadillo", "dragon",
          "dragon-skin", "torus-20", "ball-45", "armadillo-300k-skin", "torus-30", "grid-64", "armadillo-300k", "ball-80"]

FEW = ["scrambled/scrambled", "original/original", "fiedler/lexmax", "bfs/lexmax", "hilbert/lexmax", "hilbert/hilbert"]
MANY = FEW + ["spectral/lexmax", "rcm/lexmax", "morton/lexmax", "metis-nd/lexmax", "metis-rb/lexmax",
              "scrambled/lexmax"]
ALL = MANY + ["minla/lexmax", "fiedler/fiedler", "hilbert/mean", "original/scrambled"]


def orders_of(mesh):
    """Fewer for the larger ones, whose runs take longer."""
    if mesh in ("ball-80", "grid-100"):
        return FEW
    return MANY if mesh in ("torus-30", "grid-64", "armadillo-300k") else ALL


def rows_of(mesh, arguments):
    with tempfile.TemporaryDirectory() as folder:
        def run(before, *words):
            command = [*shlex.split(before), arguments.measure, *map(str, words), folder, *orders_of(mesh)]
            return [line.split(",") for line in subprocess.check_output(command, text=True).split()]

        predicted = run(arguments.predict_with, "predict", mesh, ",".join(CACHES))
        times = {tuple(row[:2]): row[2:] for row in run(arguments.time_with, "time", mesh, arguments.budget)}
    return [row + times[tuple(row[4:6])] for row in predicted]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("measure")
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("meshes", nargs="*", default=MESHES)
    parser.add_argument("--budget", type=float, default=8, help="seconds a mesh, preparation not counted")
    parser.add_argument("--predict-with", default="")
    parser.add_argument("--time-with", default="")
    arguments = parser.parse_args()
    known = set()
    if arguments.table.exists():
        with arguments.table.open() as file:
            known = {row["mesh"] for row in csv.DictReader(file)}
    with arguments.table.open("a") as file:
        writer = csv.writer(file, lineterminator="\n")
        if not known:
            writer.writerow(COLUMNS)
        for mesh in arguments.meshes:
            if mesh in known:
                continue
            writer.writerows(rows_of(mesh, arguments))
            file.flush()


if __name__ == "__main__":
    main()
