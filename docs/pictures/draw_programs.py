#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Draws how much faster orders make programs, from the results of `benchmarks/programs.py --json`.

    docs/pictures/draw_programs.py programs.json OUT.svg [PROGRAM…]

For each program two bars: its time as the mesh was, which all have the same length, and its time in the best order with
the 95 % interval. Grey where `try` found no order that is faster.
"""
import json
import sys
from pathlib import Path

LEFT, WIDTH, ROW, TOP = 270, 420, 44, 34


def bars(number, title, found):
    orders = {order["name"]: order for order in found["orders"]}
    best = orders[found["best"]]
    y = TOP + ROW * number
    share = 1 / best["ratio"]
    low, high = (1 / x for x in reversed(best["interval"])) if best["interval"] else (share, share)
    high = min(high, 1.2)
    faster = found["verdict"] == "faster"
    text = f"{best['ratio']:.2f}× in {best['name']}" if faster else "no gain found"
    seconds = found["orders"][0]["time"]
    return [f'<text x="{LEFT - 10}" y="{y + 15}" text-anchor="end">{title}</text>',
            f'<rect x="{LEFT}" y="{y}" width="{WIDTH}" height="12" fill="#d8a48f"/>',
            f'<text x="{LEFT + WIDTH + 8}" y="{y + 10}" font-size="11" fill="#555">{seconds:.3g} s</text>',
            f'<rect x="{LEFT}" y="{y + 14}" width="{WIDTH * share:.1f}" height="12" fill="{"#4c72b0" if faster else "#aaa"}"/>',
            f'<path d="M{LEFT + WIDTH * low:.1f} {y + 20}H{LEFT + WIDTH * high:.1f}" stroke="#222" stroke-width="1.5"/>',
            f'<text x="{LEFT + WIDTH * max(share, high) + 8:.1f}" y="{y + 25}" font-size="11">{text}</text>']


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    results = json.loads(Path(sys.argv[1]).read_text())
    names = sys.argv[3:] or list(results)
    height = TOP + ROW * len(names)
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {LEFT + WIDTH + 190} {height}" '
             'font-family="sans-serif" font-size="13">',
             f'<rect width="{LEFT + WIDTH + 190}" height="{height}" fill="white"/>',
             f'<text x="{LEFT}" y="20" font-weight="bold">time as the generator left the mesh, and in the best order</text>']
    for number, name in enumerate(names):
        lines += bars(number, results[name]["title"], results[name])
    Path(sys.argv[2]).write_text("\n".join(lines + ["</svg>\n"]))


if __name__ == "__main__":
    main()
