#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Copies memory on one processor until it is ended, and prints the rate.

A program on another processor then has less of the memory's bandwidth, and of the last cache if both share one:

    benchmarks/memory_hog.py --processor 0 & hog=$!
    meshorder reproduce -o beside-a-hog ...
    kill $hog
"""

import argparse
import os
import time

import numpy as np


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--processor", type=int, default=0, help="number of the processor (default: 0)")
    parser.add_argument("--mib", type=int, default=512, help="size of each of the two arrays in MiB (default: 512)")
    parser.add_argument("--every", type=float, default=60, help="seconds between two lines (default: 60)")
    options = parser.parse_args()

    os.sched_setaffinity(0, {options.processor})
    source = np.ones(options.mib << 17)
    target = np.zeros_like(source)
    copies, since = 0, time.perf_counter()
    while True:
        np.copyto(target, source)
        copies += 1
        seconds = time.perf_counter() - since
        if seconds >= options.every:
            # counts each byte once as read and once as written, not the lines that are fetched before a write
            print(f"{2 * copies * source.nbytes / seconds / 1e9:.1f} GB/s", flush=True)
            copies, since = 0, time.perf_counter()


if __name__ == "__main__":
    main()
