#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Compares the cache model's misses with those that valgrind's cachegrind counts in the running kernels.

Every kernel runs once and then three times under cachegrind. Half the difference of the counts is that of one run, which
finds the caches as the previous run left them. Cachegrind's caches map lines to sets, those of the model do not. A load or
store across two lines that misses both counts once in cachegrind and twice in the model. A mesh of 46,000 vertices takes
about twenty seconds for each kernel and order. Needs valgrind and SciPy.
"""

import argparse
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from scipy.stats import spearmanr

KERNELS = ["spmv", "element", "assembly", "springs"]


def bytes_of(size):
    return int(size.rstrip("KMG")) << {"K": 10, "M": 20, "G": 30}.get(size[-1], 0)


def output_of(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]}: {done.stderr.strip()}")
    return done.stdout


def ordered_mesh(arguments, order, folder):
    """Writes the mesh in that order, VERTICES or VERTICES/ELEMENTS, and returns its path."""
    vertices, _, elements = order.partition("/")
    elements = elements or (vertices if vertices in ("original", "scrambled") else "lexmax")
    path = Path(folder) / f"{vertices}-{elements}.node"
    output_of(arguments.build / "bin/meshorder", "order", arguments.mesh, "-o", path, "--vertices", vertices,
              "--elements", elements, "--quiet")
    return path


def predicted(arguments, path):
    """Returns {kernel: misses of both levels}."""
    caches = f"{arguments.d1.split(',')[0]},{arguments.ll.split(',')[0]}"
    lines = output_of(arguments.build / "bin/cache_misses", path, "predict", caches).splitlines()
    return {line.split()[0]: [int(word) for word in line.split("misses")[1].split()] for line in lines[1:]}


def cache_option(text):
    size, ways = text.split(",")
    return f"{bytes_of(size)},{ways},64"


def counted(arguments, path, kernel, runs, folder):
    """Returns the data misses of the whole program in the first and in the last level."""
    out = Path(folder) / "cachegrind.out"
    output_of("valgrind", "--tool=cachegrind", "--cache-sim=yes", f"--D1={cache_option(arguments.d1)}",
              f"--LL={cache_option(arguments.ll)}", f"--cachegrind-out-file={out}",
              arguments.build / "bin/cache_misses", path, kernel, runs)
    text = out.read_text()
    for level, size in ("D1", arguments.d1), ("LL", arguments.ll):
        if f"desc: {level} cache:         {bytes_of(size.split(',')[0])} B, 64 B, {size.split(',')[1]}-way" not in text:
            sys.exit(f"cachegrind: simulated another {level} cache than {size}")
    events = re.search(r"^events: (.*)$", text, re.M)[1].split()
    total = dict(zip(events, map(int, re.search(r"^summary: (.*)$", text, re.M)[1].split())))
    return total["D1mr"] + total["D1mw"], total["DLmr"] + total["DLmw"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--orders", default="scrambled,original,fiedler,hilbert,rcm,metis-rb")
    parser.add_argument("--kernels", default=",".join(KERNELS))
    parser.add_argument("--d1", default="48K,12", help="size and ways of the first level")
    parser.add_argument("--ll", default="1M,16", help="size and ways of the last level")
    parser.add_argument("--build", type=Path, default=Path("build"), help="build folder with MESHORDER_BENCHMARKS=ON")
    arguments = parser.parse_args()

    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for order in arguments.orders.split(","):
            path = ordered_mesh(arguments, order, folder)
            prediction = predicted(arguments, path)
            for kernel in arguments.kernels.split(","):
                once = counted(arguments, path, kernel, 1, folder)
                thrice = counted(arguments, path, kernel, 3, folder)
                counts = [(b - a) / 2 for a, b in zip(once, thrice)]
                rows.append((kernel, order, prediction[kernel], counts))
                print(".", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)

    for level, cache in enumerate((arguments.d1, arguments.ll)):
        print(f"\n{cache}-way: misses of a run\n{'kernel':<10}{'order':<12}{'predicted':>12}{'cachegrind':>12}{'ratio':>8}")
        for kernel in arguments.kernels.split(","):
            pairs = [(order, model[level], counts[level]) for name, order, model, counts in rows if name == kernel]
            for order, model, count in pairs:
                print(f"{kernel:<10}{order:<12}{model:>12}{count:>12.0f}{model / count if count else math.nan:>8.2f}")
            rank = spearmanr([model for _, model, _ in pairs], [count for _, _, count in pairs]).correlation
            print(f"{kernel:<10}{'rank correlation (Spearman)':<32}{rank:>12.2f}")


if __name__ == "__main__":
    main()
