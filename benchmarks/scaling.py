#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Time and memory of every vertex order, and of lexmax for elements, over meshes of 10^3 to 10^7 vertices.

    benchmarks/scaling.py build/bin/scaling --json scaling.json --plot docs/pictures/scaling.svg

The meshes are scrambled grids of tetrahedra. Each run is a process of its own; memory is its peak while it orders,
mesh and graph included. A method that takes longer than --limit gets no larger mesh. The exponent p of time ~ n^p is
fitted by least squares of the logarithms over the largest decades (--decades). --from draws and prints a file that
--json wrote. Needs NumPy.
"""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy

VERTEX_METHODS = ["hilbert", "morton", "bfs", "rcm", "fiedler", "minla", "spectral", "metis-nd", "metis-rb"]
METHODS = [("vertices", method) for method in VERTEX_METHODS] + [("elements", "lexmax")]
COLOURS = ["#332288", "#88ccee", "#117733", "#999933", "#cc6677", "#882255", "#ddaa33", "#aa4499", "#44aa99", "#000000"]


def measure(program, what, method, mesh, limit):
    """One run as a dictionary; None when it reached the limit."""
    try:
        done = subprocess.run([program, what, method, mesh], capture_output=True, text=True, check=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    vertices, cells, seconds, before, peak = done.stdout.split()
    return {"of": what, "method": method, "vertices": int(vertices), "elements": int(cells),
            "seconds": float(seconds), "mb_before": float(before), "mb_peak": float(peak)}


def measure_all(options):
    runs = []
    slow = set()
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        for cubes in options.cubes:
            mesh = options.mesh or Path(folder, f"grid-{cubes}.vtu")
            if not options.mesh:
                subprocess.run([options.program, "make", str(cubes), mesh], check=True)
            for what, method in METHODS:
                if method in slow or (options.methods and method not in options.methods):
                    continue
                run = measure(options.program, what, method, mesh, options.limit)
                if run is None:
                    slow.add(method)
                    continue
                runs.append(run)
                print(f"{method:<10} {run['vertices']:>10,} vertices {run['seconds']:>10.4f} s "
                      f"{run['mb_peak']:>8,.0f} MB", flush=True)
                if run["seconds"] > options.limit:
                    slow.add(method)
            if not options.mesh:
                mesh.unlink()
    return runs


def exponent(runs, key, decades):
    """p of value ~ vertices^p over the largest decades; None with fewer than two sizes there."""
    largest = max(run["vertices"] for run in runs)
    used = [run for run in runs if run["vertices"] >= largest / 10**decades / 1.2 and run[key] > 0]
    if len({run["vertices"] for run in used}) < 2:
        return None
    return float(numpy.polyfit(numpy.log([run["vertices"] for run in used]), numpy.log([run[key] for run in used]), 1)[0])


def of_method(runs, what, method):
    return sorted((run for run in runs if (run["of"], run["method"]) == (what, method)), key=lambda r: r["vertices"])


def print_table(runs, decades):
    sizes = sorted({run["vertices"] for run in runs})
    head = " | ".join(f"{size:,}" for size in sizes)
    print(f"\n| order | {head} | time ~ n^p | peak MB at the largest |\n|---{'| ---: ' * (len(sizes) + 2)}|")
    for what, method in METHODS:
        own = of_method(runs, what, method)
        if not own:
            continue
        seconds = {run["vertices"]: run["seconds"] for run in own}
        cells = [f"{seconds[size]:.3g} s" if size in seconds else "–" for size in sizes]
        power = exponent(own, "seconds", decades)
        print(f"| {method} | {' | '.join(cells)} | {'–' if power is None else f'{power:.2f}'} | "
              f"{own[-1]['mb_peak']:,.0f} |")


def panel(runs, key, title, left):
    """One log-log plot, 380 wide, as lines of SVG."""
    top, width, height = 40, 330, 330
    x_range = (3, 7.1)
    values = [run[key] for run in runs if run[key] > 0]
    y_range = (numpy.floor(numpy.log10(min(values))), numpy.ceil(numpy.log10(max(values))))
    x = lambda n: left + width * (numpy.log10(n) - x_range[0]) / (x_range[1] - x_range[0])
    y = lambda v: top + height * (y_range[1] - numpy.log10(v)) / (y_range[1] - y_range[0])
    lines = [f'<text x="{left}" y="24" font-weight="bold">{title}</text>']
    for power in range(3, 8):
        at = x(10.0**power)
        lines += [f'<path d="M{at:.1f} {top}v{height}" stroke="#ddd"/>',
                  f'<text x="{at:.1f}" y="{top + height + 18}" text-anchor="middle">10<tspan dy="-5" font-size="9">'
                  f'{power}</tspan></text>']
    for power in range(int(y_range[0]), int(y_range[1]) + 1):
        at = y(10.0**power)
        lines += [f'<path d="M{left} {at:.1f}h{width}" stroke="#ddd"/>',
                  f'<text x="{left - 8}" y="{at + 4:.1f}" text-anchor="end">10<tspan dy="-5" font-size="9">{power}'
                  '</tspan></text>']
    for (what, method), colour in zip(METHODS, COLOURS):
        own = of_method(runs, what, method)
        if not own:
            continue
        places = [(x(run["vertices"]), y(run[key])) for run in own]
        path = "L".join(f"{a:.1f} {b:.1f}" for a, b in places)
        lines.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="1.8"/>')
        lines += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.6" fill="{colour}"/>' for a, b in places]
    return lines


def draw(runs, decades, path):
    lines = ['<svg xmlns="http://www.w3.org/2000/svg" width="960" height="410" font-family="sans-serif" font-size="12">',
             '<rect width="960" height="410" fill="white"/>']
    lines += panel(runs, "seconds", "seconds, over vertices", 50)
    lines += panel(runs, "mb_peak", "peak memory in MB, over vertices", 440)
    row = 0
    for (what, method), colour in zip(METHODS, COLOURS):
        own = of_method(runs, what, method)
        if not own:
            continue
        at = 56 + 22 * row
        row += 1
        power = exponent(own, "seconds", decades)
        fitted = "" if power is None else f'  n<tspan dy="-5" font-size="9">{power:.2f}</tspan>'
        lines.append(f'<path d="M800 {at - 4}h18" stroke="{colour}" stroke-width="3"/><text x="824" y="{at}">{method}'
                     f'{fitted}</text>')
    Path(path).write_text("\n".join(lines + ["</svg>\n"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", help="build/bin/scaling")
    parser.add_argument("--cubes", type=int, nargs="+", default=[9, 21, 45, 99, 215], help="across the grids")
    parser.add_argument("--mesh", help="measure this file instead of grids")
    parser.add_argument("--methods", nargs="+", help="these alone")
    parser.add_argument("--limit", type=float, default=120, help="seconds a process may take")
    parser.add_argument("--decades", type=float, default=2, help="for the fit")
    parser.add_argument("--folder", help="for the meshes; the largest has 1.5 GB")
    parser.add_argument("--json", help="write the runs here")
    parser.add_argument("--from", dest="known", nargs="+", help="runs that --json wrote, instead of measuring")
    parser.add_argument("--plot", help="draw them as SVG")
    options = parser.parse_args()
    if options.mesh:
        options.cubes = [0]
    if not options.known and not options.program:
        parser.error("give the program, or --from")
    runs = [run for path in options.known or [] for run in json.loads(Path(path).read_text())]
    if not options.known:
        runs = measure_all(options)
    if options.json:
        Path(options.json).write_text(json.dumps(runs, indent=1) + "\n")
    print_table(runs, options.decades)
    if options.plot:
        draw(runs, options.decades, options.plot)


if __name__ == "__main__":
    main()
