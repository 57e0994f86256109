#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Measures the cost of syncing an output to the disk before it replaces the old file, by the size of the file.

Usage: output_sync.py FOLDER [--rounds N] [--largest BYTES]

Each round replaces a file in FOLDER as meshorder does (write a new one, rename it), once without waiting for the disk
and once with fsync of the file before and of the folder after. Prints medians in milliseconds, also of processor time,
which excludes waiting for the disk.
"""
import argparse
import os
import pathlib
import statistics
import time

SIZES = [10_000, 100_000, 1_000_000, 10_000_000, 100_000_000, 1_000_000_000]
PIECE = 1 << 20


def replace(folder, content, synced):
    """Replaces the file; returns the seconds by the clock and those of the processor."""
    wall, processor = time.perf_counter(), time.process_time()
    file = os.open(folder / "new", os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    for begin in range(0, len(content), PIECE):
        os.write(file, content[begin:begin + PIECE])
    if synced:
        os.fsync(file)
    os.close(file)
    os.rename(folder / "new", folder / "target")
    if synced:
        opened = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        os.fsync(opened)
        os.close(opened)
    return time.perf_counter() - wall, time.process_time() - processor


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--largest", type=int, default=SIZES[-1])
    arguments = parser.parse_args()
    folder = arguments.folder / ".output-sync"
    folder.mkdir()
    try:
        print(f"{'bytes':>13} {'without, ms':>12} {'with fsync, ms':>15} {'more, ms':>10} {'processor, ms':>14}")
        for size in (size for size in SIZES if size <= arguments.largest):
            content = memoryview(os.urandom(size))
            times = {synced: [] for synced in (False, True)}
            processor = []
            for _ in range(arguments.rounds):
                for synced, list_of in times.items():
                    os.sync()  # finishes the writes of the previous round
                    wall, busy = replace(folder, content, synced)
                    list_of.append(wall)
                    if synced:
                        processor.append(busy)
            without, with_sync = (1000 * statistics.median(times[synced]) for synced in (False, True))
            print(f"{size:>13,} {without:>12.2f} {with_sync:>15.2f} {with_sync - without:>10.2f} "
                  f"{1000 * statistics.median(processor):>14.2f}", flush=True)
    finally:
        for path in folder.iterdir():
            path.unlink()
        folder.rmdir()


if __name__ == "__main__":
    main()
