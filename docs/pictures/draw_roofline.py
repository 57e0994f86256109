#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Draws the roofline of implicit time steps from what `build/bin/implicit --json` measured.

    docs/pictures/draw_roofline.py implicit.json OUT.svg

A kernel stands at its operations for each byte that it must move and at the operations a second that it reached. Under
the slope memory limits it, under the flat roof arithmetic (Williams, Waterman, Patterson 2009). Above the slope it finds
part of its data in caches. One panel for each mesh.
"""
import json
import math
import sys
from pathlib import Path

COLOURS = {"scrambled": "#c44e52", "original": "#dd8452", "fiedler": "#4c72b0", "spectral": "#8172b3", "rcm": "#937860",
           "hilbert": "#55a868"}
X, Y = (-1, 1.5), (0, 2.5)  # decades of operations a byte and of 10⁹ operations a second
WIDTH, HEIGHT, TOP = 400, 340, 44


def panel(mesh, bandwidths, peak, left):
    def x(value):
        return left + WIDTH * (math.log10(value) - X[0]) / (X[1] - X[0])

    def y(value):
        return TOP + HEIGHT * (Y[1] - math.log10(value)) / (Y[1] - Y[0])

    lines = [f'<text x="{left}" y="28" font-weight="bold">{Path(mesh["mesh"]).stem}, {mesh["vertices"]:,} vertices</text>']
    for power in range(math.ceil(X[0]), math.floor(X[1]) + 1):
        lines += [f'<path d="M{x(10**power):.1f} {TOP}v{HEIGHT}" stroke="#ddd"/>',
                  f'<text x="{x(10**power):.1f}" y="{TOP + HEIGHT + 18}" text-anchor="middle">{10**power:g}</text>']
    for power in range(math.ceil(Y[0]), math.floor(Y[1]) + 1):
        lines += [f'<path d="M{left} {y(10**power):.1f}h{WIDTH}" stroke="#ddd"/>',
                  f'<text x="{left - 8}" y="{y(10**power) + 4:.1f}" text-anchor="end">{10**power:g}</text>']
    for threads, bandwidth in enumerate(bandwidths, start=1):
        roof, start = threads * peak, 10**X[0]
        lines += [f'<path d="M{x(start):.1f} {y(start * bandwidth):.1f}L{x(roof / bandwidth):.1f} {y(roof):.1f}'
                  f'H{left + WIDTH}" fill="none" stroke="#444" stroke-width="{0.8 + 0.6 * threads}"/>',
                  f'<text x="{left + WIDTH - 4}" y="{y(roof) + 14:.1f}" text-anchor="end" font-size="10" '
                  f'fill="#444">{roof:.0f} Gflop/s, {bandwidth:.0f} GB/s</text>']
    for run in mesh["orders"]:
        for kernel, shape in (("iteration", "circle"), ("assembly", "square")):
            measured = run[kernel]
            px = x(measured["operations"] / measured["bytes"])
            py = y(1e-6 * measured["operations"] / measured["ms"])
            fill = COLOURS.get(run["name"], "#777") if run["threads"] == 1 else "white"
            style = f'fill="{fill}" stroke="{COLOURS.get(run["name"], "#777")}" stroke-width="1.6"'
            lines.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="4" {style}/>' if shape == "circle" else
                         f'<rect x="{px - 4:.1f}" y="{py - 4:.1f}" width="8" height="8" {style}/>')
    lines.append(f'<text x="{left + WIDTH / 2}" y="{TOP + HEIGHT + 38}" text-anchor="middle">operations for each byte</text>')
    return lines


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    results = json.loads(Path(sys.argv[1]).read_text())
    step = WIDTH + 60
    width = 60 + step * len(results["meshes"]) + 90
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{TOP + HEIGHT + 50}" '
             'font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{TOP + HEIGHT + 50}" fill="white"/>',
             f'<text x="14" y="{TOP + HEIGHT / 2}" transform="rotate(-90 14 {TOP + HEIGHT / 2})" text-anchor="middle">'
             'Gflop/s</text>']
    for number, mesh in enumerate(results["meshes"]):
        lines += panel(mesh, results["bandwidth"], results["peak_gflops"], 60 + step * number)
    names = list(dict.fromkeys(run["name"] for run in results["meshes"][0]["orders"]))
    at = width - 110
    for row, name in enumerate(names):
        lines.append(f'<circle cx="{at}" cy="{TOP + 8 + 20 * row}" r="4" fill="{COLOURS.get(name, "#777")}"/>'
                     f'<text x="{at + 10}" y="{TOP + 12 + 20 * row}">{name}</text>')
    for row, (mark, text) in enumerate((("●", "CG iteration"), ("■", "assembly"), ("○", "two threads")), len(names) + 1):
        lines.append(f'<text x="{at - 4}" y="{TOP + 12 + 20 * row}">{mark} {text}</text>')
    Path(sys.argv[2]).write_text("\n".join(lines + ["</svg>\n"]))


if __name__ == "__main__":
    main()
