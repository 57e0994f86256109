#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Checks whether verdicts of `meshorder info` contradict each other on a quiet and on a busy machine.

    verdicts.py MESH… [--runs 40] [--loads 0,2,8] [--truth-runs 5]

Runs `info --json` that often on each mesh beside 0, 2 and 8 processes that compute without end. Two verdicts
contradict each other if their grades differ, or if the intervals of a kernel's gain have no number in common; a
verdict contradicts itself if its gain does not follow from its own times. On the quiet machine the interval is also
compared with a long measurement (`--truth-runs` calls of `info --measure`; their median). MESHORDER names the program.
"""
import argparse
import contextlib
import itertools
import json
import os
import statistics
import subprocess
import sys

KERNELS = ("spmv", "element", "assembly", "springs")


@contextlib.contextmanager
def load(processes):
    others = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(processes)]
    try:
        yield
    finally:
        for other in others:
            other.kill()
            other.wait()


def info(mesh, *options):
    program = os.environ.get("MESHORDER", "meshorder")
    done = subprocess.run([program, "info", mesh, "--json", *options], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def measured_gains(result):
    """The intervals of the gains that the verdict states from measured times, by kernel."""
    verdict = result["verdict"]
    if verdict is None or verdict["by"] != "measurement":
        return {}
    return {kernel: of["interval"] for kernel, of in verdict["kernels"].items() if of["interval"]}


def apart(a, b):
    return a[0] > b[1] or b[0] > a[1]


def contradictions(results):
    """Returns the pairs of verdicts that contradict each other, and the verdicts that contradict themselves."""
    count = sum(a["order"] and b["order"] and a["order"]["grade"] != b["order"]["grade"] or
                any(apart(measured_gains(a)[k], measured_gains(b)[k])
                    for k in measured_gains(a).keys() & measured_gains(b).keys())
                for a, b in itertools.combinations(results, 2))
    for result in results:
        verdict = result["verdict"]
        stated = verdict and any(of["factor"] for of in verdict["kernels"].values())
        count += bool(verdict) and bool(stated) != verdict["sentence"].startswith("as it is, ")
    return count


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", metavar="MESH")
    parser.add_argument("--runs", type=int, default=40)
    parser.add_argument("--loads", default="0,2,8")
    parser.add_argument("--truth-runs", type=int, default=5)
    given = parser.parse_args()
    print("| mesh | load | verdicts | reliable | contradictions | gains that hold the true one |\n|---|--:|--:|--:|--:|--:|")
    for mesh in given.meshes:
        truth = {}
        if given.truth_runs and "0" in given.loads.split(","):
            long = [measured_gains(info(mesh, "--measure")) for _ in range(given.truth_runs)]
            truth = {kernel: statistics.median(sum(gains[kernel]) / 2 for gains in long if kernel in gains)
                     for kernel in KERNELS if any(kernel in gains for gains in long)}
        for processes in map(int, given.loads.split(",")):
            with load(processes):
                results = [info(mesh) for _ in range(given.runs)]
            held = [low <= truth[kernel] <= high for result in results
                    for kernel, (low, high) in measured_gains(result).items() if kernel in truth]
            share = f"{sum(held)} of {len(held)}" if processes == 0 and held else "–"
            reliable = sum(bool(result["verdict"] and result["verdict"]["reliable"]) for result in results)
            print(f"| {os.path.basename(mesh)} | {processes} | {len(results)} | {reliable} | {contradictions(results)} | {share} |",
                  flush=True)


if __name__ == "__main__":
    main()
