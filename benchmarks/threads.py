#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Measures the time of each stage of `meshorder order` on 1, 2, 4 … all threads, and its serial share.

    benchmarks/threads.py build/bin/meshorder mesh.node --json threads.json --plot threads.svg

Every run is a process of its own; runs with different numbers of threads take turns, and medians are printed. The mesh
is written to each format and read back, and scrambled before it is ordered. The serial share s follows from the times
on one thread and on all n by Amdahl's law, T(n) = T(1) (s + (1 - s) / n). The speed-up on --compute threads is computed
by this law, not measured. Bytes per second count the files, on the most threads. --from draws and prints a file that
--json wrote.
"""
import argparse
import json
import os
import statistics
import subprocess
import tempfile
from pathlib import Path

METHODS = ["hilbert", "hilbert-fronts", "bfs", "rcm", "spectral", "fiedler"]
FORMATS = [".node", ".msh", ".mesh", ".inp", ".vtk", ".vtu"]


def order(program, mesh, output, threads, vertices, elements):
    """The result of `order` as JSON."""
    done = subprocess.run([program, "order", mesh, "-o", output, "--threads", str(threads), "--vertices", vertices,
                           "--elements", elements, "--json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def measure(options, folder, counts):
    """{stage: {"bytes": …, "seconds": {threads: [seconds of each round]}}}"""
    stages = {}

    def add(stage, threads, seconds, size=None):
        found = stages.setdefault(stage, {"bytes": size, "seconds": {}})
        found["seconds"].setdefault(threads, []).append(seconds)

    files = {extension: folder / f"mesh{extension}" for extension in options.formats}
    for file in files.values():
        order(options.program, options.mesh, file, max(counts), "scrambled", "scrambled")
    scrambled = folder / "scrambled.vtu"
    order(options.program, options.mesh, scrambled, max(counts), "scrambled", "scrambled")
    for _ in range(options.rounds):
        for threads in counts:
            for extension, file in files.items():
                result = order(options.program, file, folder / f"out{extension}", threads, "original", "original")
                for timing in result["timings"]:
                    if timing["stage"] in ("read", "write"):
                        add(f"{timing['stage']} {extension}", threads, timing["seconds"], timing["bytes"])
            for method in options.methods:
                result = order(options.program, scrambled, folder / "out.vtu", threads, method, "lexmax")
                add(method, threads, result["vertices"]["seconds"])
                add("lexmax", threads, result["cells"]["seconds"])
                for timing in result["timings"]:
                    if timing["stage"] in ("graph", "move", "spans"):
                        add(timing["stage"], threads, timing["seconds"])
    return stages


def serial_share(seconds):
    """Returns the serial share from the times on one thread and on the most threads; None if all times are on one thread."""
    most = max(seconds)
    if most == 1:
        return None
    return min(max((seconds[most] / seconds[1] - 1 / most) / (1 - 1 / most), 0.0), 1.0)


def medians(stage):
    return {int(threads): statistics.median(times) for threads, times in stage["seconds"].items()}


def print_table(stages, computed):
    counts = sorted(medians(next(iter(stages.values()))))
    print(f"| stage | {' | '.join(f'{n} threads' if n > 1 else '1 thread' for n in counts)} | faster | serial share "
          f"| {computed} threads, computed | |\n|---{'| ---: ' * (len(counts) + 4)}|")
    for name, stage in stages.items():
        seconds = medians(stage)
        share = serial_share(seconds)
        rate = f"{1e-6 * stage['bytes'] / seconds[counts[-1]]:,.0f} MB/s" if stage["bytes"] else ""
        law = "–" if share is None else f"{1 / (share + (1 - share) / computed):.1f}×"
        print(f"| {name} | {' | '.join(f'{seconds[n]:.3g} s' for n in counts)} | {seconds[1] / seconds[counts[-1]]:.2f}× | "
              f"{'–' if share is None else f'{100 * share:.0f} %'} | {law} | {rate} |")


def draw(stages, path):
    """A bar for each stage: how many times faster it is on the most threads than on one."""
    most = max(medians(next(iter(stages.values()))))
    width, left, row = 420, 130, 22
    height = 44 + row * len(stages)
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + width + 60}" height="{height}" '
             'font-family="sans-serif" font-size="12">', f'<rect width="100%" height="{height}" fill="white"/>',
             f'<text x="{left}" y="20" font-weight="bold">times as fast on {most} threads as on one</text>']
    for k, (name, stage) in enumerate(stages.items()):
        seconds = medians(stage)
        gain = seconds[1] / seconds[most]
        y = 34 + row * k
        lines += [f'<text x="{left - 8}" y="{y + 13}" text-anchor="end">{name}</text>',
                  f'<rect x="{left}" y="{y}" width="{width * min(gain / most, 1):.1f}" height="16" fill="#4477aa"/>',
                  f'<text x="{left + width * min(gain / most, 1) + 6:.1f}" y="{y + 13}">{gain:.2f}</text>']
    lines.append(f'<path d="M{left + width} 30V{height - 6}" stroke="#999" stroke-dasharray="3"/>')
    Path(path).write_text("\n".join(lines + ["</svg>\n"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", help="build/bin/meshorder")
    parser.add_argument("mesh", nargs="?", help="of tetrahedra, so that all formats hold it")
    parser.add_argument("--threads", type=int, nargs="+", help="these numbers, with 1, instead of powers of two")
    parser.add_argument("--methods", nargs="*", default=METHODS)
    parser.add_argument("--formats", nargs="*", default=FORMATS)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--compute", type=int, default=16, help="threads to compute the speed-up for")
    parser.add_argument("--folder", help="for the files; some ten times the mesh")
    parser.add_argument("--json", help="write the times here")
    parser.add_argument("--from", dest="known", help="a file that --json wrote, instead of measuring")
    parser.add_argument("--plot", help="draw the speed-ups as SVG")
    options = parser.parse_args()
    if options.known:
        stages = json.loads(Path(options.known).read_text())
    elif options.mesh:
        cores = len(os.sched_getaffinity(0))
        powers = [2**k for k in range(cores.bit_length()) if 2**k <= cores]
        counts = sorted({1, *(options.threads or [*powers, cores])})
        with tempfile.TemporaryDirectory(dir=options.folder) as folder:
            stages = measure(options, Path(folder), counts)
    else:
        parser.error("give the program and a mesh, or --from")
    if options.json:
        Path(options.json).write_text(json.dumps(stages, indent=1) + "\n")
    print_table(stages, options.compute)
    if options.plot:
        draw(stages, options.plot)


if __name__ == "__main__":
    main()
