#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""What the order of a deck's nodes and elements is worth in CalculiX: the processor time of ccx in each.

Usage: calculix.py FOLDER PREFIX [--solver SPOOLES|ITERATIVESCALING|ITERATIVECHOLESKY] [--rounds N] [--orders NAME…]

PREFIX.node and PREFIX.ele are a mesh by TetGen, numbered from 0, of a box from 0 to 1. It becomes a deck of C3D4, held at
z = 0 and pulled at z = 1. `original` is that deck, other names are methods of `meshorder order --vertices`, applied to it.
Each round runs ccx on all decks in a random sequence, on one thread. Gains are medians of the ratios within the rounds.
MESHORDER names the command, else build/bin/meshorder is taken.
"""
import argparse
import os
import pathlib
import random
import re
import resource
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[1]
MESHORDER = os.environ.get("MESHORDER", str(ROOT / "build" / "bin" / "meshorder"))
SOLVERS = {"SPOOLES": "SPOOLES", "ITERATIVESCALING": "ITERATIVE SCALING", "ITERATIVECHOLESKY": "ITERATIVE CHOLESKY"}


def rows(path):
    lines = [line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]
    return lines[1:int(lines[0][0]) + 1]


def write_deck(path, prefix, solver):
    nodes = [(int(n) + 1, *map(float, xyz[:3])) for n, *xyz in rows(prefix.with_name(prefix.name + ".node"))]
    cells = [[int(word) for word in row[:5]] for row in rows(prefix.with_name(prefix.name + ".ele"))]
    with path.open("w") as deck:
        deck.write("*NODE, NSET=ALL\n" + "".join(f"{n}, {x!r}, {y!r}, {z!r}\n" for n, x, y, z in nodes))
        deck.write("*ELEMENT, TYPE=C3D4, ELSET=BODY\n")
        deck.write("".join(f"{e + 1}, {a + 1}, {b + 1}, {c + 1}, {d + 1}\n" for e, a, b, c, d in cells))
        for name, height in (("BOTTOM", 0), ("TOP", 1)):
            deck.write(f"*NSET, NSET={name}\n" + "".join(f"{n},\n" for n, _, _, z in nodes if z == height))
        deck.write("*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n"
                   f"*BOUNDARY\nBOTTOM, 1, 3\n*STEP\n*STATIC, SOLVER={SOLVERS[solver]}\n*CLOAD\nTOP, 3, 1.0\n"
                   "*NODE PRINT, NSET=TOP\nU\n*END STEP\n")
    return len(nodes), len(cells)


def run(folder, name):
    """Returns the processor time of ccx in seconds and the sum of all displacements along z of the upper side."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(["ccx", name], cwd=folder, check=True, capture_output=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    lines = re.findall(r"^ +\d+ +\S+ +\S+ +(\S+)$", (folder / f"{name}.dat").read_text(), re.MULTILINE)
    return seconds, sum(map(float, lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("prefix", type=pathlib.Path)
    parser.add_argument("--solver", choices=SOLVERS, default="SPOOLES")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--orders", nargs="+", default=["original", "scrambled", "rcm", "hilbert", "metis-nd"])
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    nodes, cells = write_deck(arguments.folder / "original.inp", arguments.prefix, arguments.solver)
    for name in arguments.orders:
        if name != "original":
            subprocess.run([MESHORDER, "order", "-q", "original.inp", "-o", f"{name}.inp", "--vertices", name],
                           cwd=arguments.folder, check=True)
    times = {name: [] for name in arguments.orders}
    sums = {}
    for turn in range(arguments.rounds):
        for name in random.Random(turn).sample(arguments.orders, len(arguments.orders)):
            seconds, sums[name] = run(arguments.folder, name)
            times[name].append(seconds)
    first = times[arguments.orders[0]]
    print(f"{nodes:,} nodes, {cells:,} tetrahedra, {SOLVERS[arguments.solver]}\n")
    print("| order | sum of displacements | ccx | gain |\n| --- | ---: | ---: | ---: |")
    for name, seconds in times.items():
        gain = statistics.median(a / b for a, b in zip(first, seconds))
        print(f"| {name} | {sums[name]:.5g} | {statistics.median(seconds):.2f} s | {gain:.2f} |")


if __name__ == "__main__":
    main()
