#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""A report page with made-up results, for looking at viewer/ without a study.

    tests/command/sample_page.py OUT.html [MODEL.node ...]

Meshes are a torus, or the surfaces of TetGen's meshes; the numbers in its tables mean nothing.
"""
import base64
import html
import json
import pathlib
import re
import sys
import zlib

import numpy

VIEWER = pathlib.Path(__file__).resolve().parents[2] / "viewer"
THREE = pathlib.Path("/usr/share/javascript/three/three.min.js")
ORDERINGS = {"original": "Original", "fiedler": "Fiedler", "vf-fiedler": "VF Fiedler", "scrambled": "Scrambled",
             "vf-scrambled": "VF scrambled"}
PAPER = {"falling": (14.8, 26.7, 27.8), "stretch": (4.66, 12.1, 25.5), "bounce": (8.23, 13.3, 14.1)}
SPAN_BIN = 50


class Blobs:
    """Arrays of the page's data, and the script elements that hold them."""

    def __init__(self):
        self.scripts = {}

    def add(self, array, **more):
        packed = base64.b64encode(zlib.compress(numpy.ascontiguousarray(array).tobytes(), 6)).decode()
        name = self.scripts.setdefault(packed, f"blob-{len(self.scripts)}")
        return {"blob": name, "type": str(array.dtype), "shape": list(array.shape), **more}

    def places(self, places, delta=False):
        """Places as 16-bit numbers: vertices × 3, or frames × vertices × 3."""
        low, high = (places.reshape(-1, 3).min(axis=0), places.reshape(-1, 3).max(axis=0))
        scale = numpy.maximum(high - low, 1e-12) / 65535
        numbers = numpy.round((places - low) / scale).astype(numpy.uint16)
        if delta:
            numbers[1:] = numbers[1:] - numbers[:-1]
        return self.add(numbers, scale=scale.tolist(), offset=low.tolist(), delta=delta)

    def html(self):
        return "\n".join(f'<script type="text/plain" id="{name}">{packed}</script>' for packed, name in self.scripts.items())


def torus(around=96, across=40):
    """A bumpy torus: places and triangles."""
    u, v = numpy.meshgrid(numpy.arange(around) * 2 * numpy.pi / around, numpy.arange(across) * 2 * numpy.pi / across,
                          indexing="ij")
    radius = 0.3 + 0.04 * numpy.cos(5 * u)
    places = numpy.stack([(1 + radius * numpy.cos(v)) * numpy.cos(u), radius * numpy.sin(v),
                          (1 + radius * numpy.cos(v)) * numpy.sin(u)], axis=-1).reshape(-1, 3)
    number = numpy.arange(around * across).reshape(around, across)
    east, north = numpy.roll(number, -1, axis=0), numpy.roll(number, -1, axis=1)
    both = numpy.roll(east, -1, axis=1)
    triangles = numpy.concatenate([numpy.stack([number, north, both], axis=-1).reshape(-1, 3),
                                   numpy.stack([number, both, east], axis=-1).reshape(-1, 3)])
    return places, triangles


def tetgen_surface(path):
    """Places and outer triangles of a .node/.ele pair."""
    def rows(file, columns):
        return numpy.loadtxt(file, skiprows=1, usecols=range(columns), comments="#")

    nodes = rows(path, 4)
    cells = rows(str(path).replace(".node", ".ele"), 5).astype(int)[:, 1:] - int(nodes[0, 0])
    faces = numpy.concatenate([cells[:, [1, 2, 3]], cells[:, [0, 3, 2]], cells[:, [0, 1, 3]], cells[:, [0, 2, 1]]])
    _, first, count = numpy.unique(numpy.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return nodes[:, 1:], faces[first[count == 1]]


def thinned(places, triangles, cells):
    """Vertices of a coarse grid's cells merged into the first one of each."""
    low, high = places.min(axis=0), places.max(axis=0)
    key = ((places - low) / (high - low).max() * cells).astype(int) @ [1, 4096, 4096 * 4096]
    _, first, inverse = numpy.unique(key, return_index=True, return_inverse=True)
    triangles = first[inverse][triangles]
    return triangles[(triangles != numpy.roll(triangles, 1, axis=1)).all(axis=1)]


def edges_of(triangles):
    edges = numpy.sort(numpy.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    return numpy.unique(edges, axis=0)


def rank_along(key):
    rank = numpy.empty(len(key), dtype=numpy.int64)
    rank[numpy.argsort(key, kind="stable")] = numpy.arange(len(key))
    return rank


def ranks_of(places, rng):
    """Plausible orders: half in order, along the shape, and none."""
    along = numpy.hypot(places[:, 0] - places[:, 0].min(), places[:, 2]) + 0.3 * places[:, 1]
    good = rank_along(along)
    scrambled = rng.permutation(len(places))
    block = len(places) // 40 + 1
    original = rank_along(rng.permutation(41)[numpy.arange(len(places)) // block] * 1e6 + rng.random(len(places)))
    return {"original": original, "fiedler": good, "vf-fiedler": good, "scrambled": scrambled, "vf-scrambled": scrambled}


def pattern(edges, rank, side):
    tile = rank * side // len(rank)
    counts = numpy.zeros((side, side), dtype=numpy.uint32)
    for a, b in ((0, 1), (1, 0)):
        numpy.add.at(counts, (tile[edges[:, a]], tile[edges[:, b]]), 1)
    numpy.add.at(counts, (tile, tile), 1)
    return counts


def motion_of(name, places, triangles, frames=41):
    """A body that falls on a floor and is squeezed by it."""
    low, high = places.min(axis=0), places.max(axis=0)
    unit = (places - [(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2]) / (high - low).max()
    time = numpy.linspace(0, 1, frames)[:, None, None]
    height = 0.8 * numpy.abs(numpy.cos(2.5 * numpy.pi * time)) * numpy.exp(-1.2 * time)
    squeeze = 1 - 0.35 * numpy.exp(-(height / 0.12) ** 2)
    moved = unit[None] * numpy.concatenate([1 / numpy.sqrt(squeeze), squeeze, 1 / numpy.sqrt(squeeze)], axis=2)
    moved[:, :, 1:2] += height
    floor = numpy.array([[-1.2, 0, -1.2], [-1.2, 0, 1.2], [1.2, 0, 1.2], [1.2, 0, -1.2]])
    return {"scenario": name, "title": "A body falls on the floor and bounces", "steps": [6 * i for i in range(frames)],
            "moved": moved, "triangles": triangles, "floor": (floor, numpy.array([[0, 1, 2], [0, 2, 3]]))}


def compact(triangles):
    """The vertices that triangles have, and the triangles over those."""
    used, inverse = numpy.unique(triangles, return_inverse=True)
    return used, inverse.reshape(-1, 3)


def table(name, title, caption, columns, rows):
    """As the program writes them: cells are words, or numbers with their words."""
    def cell(value, tag):
        if isinstance(value, str):
            return f"<{tag}>{html.escape(value)}</{tag[:2]}>"
        number, words, *weak = value
        return f'<{tag} class="number{" weak" if weak else ""}" data-value="{number}">{html.escape(words)}</{tag[:2]}>'

    numbers = [any(not isinstance(row[i], str) for row in rows) for i in range(len(columns))]
    head = "".join(f'<th scope="col"{" class=number" if number else ""}>{html.escape(column)}</th>'
                   for column, number in zip(columns, numbers))
    body = "".join("<tr>" + cell(row[0], 'th scope="row"') + "".join(cell(value, "td") for value in row[1:]) + "</tr>"
                   for row in rows)
    return (f'<table id="{name}"><caption><strong>{html.escape(title)}</strong> {html.escape(caption)}</caption>'
            f"<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>")


def bars(title, values):
    """A figure of some bars, as a stand-in for the program's."""
    rows = "".join(f'<text x="0" y="{30 + 28 * i}" font-size="13">{name}</text><rect x="110" y="{18 + 28 * i}" height="16" '
                   f'width="{8 * value:.0f}" fill="#1b5e7b"/><text x="{116 + 8 * value:.0f}" y="{30 + 28 * i}" '
                   f'font-size="12">{value:.1f}</text>' for i, (name, value) in enumerate(values))
    svg = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 {20 + 28 * len(values)}" width="400" '
           f'height="{20 + 28 * len(values)}" font-family="sans-serif">{rows}</svg>')
    source = "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode()
    return (f'<figure id="figure-{title.split()[0].lower()}"><img src="{source}" alt="{title}">'
            f"<figcaption><strong>{title}.</strong> Made up.</figcaption></figure>")


def sample_parts(models=()):
    """What stands in for the frame's placeholders."""
    rng = numpy.random.default_rng(7)
    blobs = Blobs()
    manifest = {"orderings": [{"name": name, "title": title} for name, title in ORDERINGS.items()], "meshes": [],
                "motions": []}
    records, span_rows, motions = [], [], []
    surfaces = [(pathlib.Path(model).stem, *tetgen_surface(model)) for model in models] or [("torus", *torus())]
    for name, places, triangles in surfaces:
        ranks, edges = ranks_of(places, rng), edges_of(triangles)
        shown, small = compact(thinned(places, triangles, 160))
        side = 160
        manifest["meshes"].append({
            "name": name, "vertices": len(places), "positions": blobs.places(places[shown]),
            "triangles": blobs.add(small.astype(numpy.uint32)),
            "ranks": {order: blobs.add(rank[shown].astype(numpy.uint32)) for order, rank in ranks.items()},
            "sparsity": {order: blobs.add(pattern(edges, rank, side)) for order, rank in ranks.items()}})
        spans = {order: float(numpy.abs(rank[edges[:, 0]] - rank[edges[:, 1]]).mean()) for order, rank in ranks.items()}
        records.append({"name": name, "orders": [{"ordering": o, "span": {"mean": s}} for o, s in spans.items()]})
        span_rows.append([name] + [(span, f"{span:,.1f}") for span in spans.values()])
        shown, small = compact(thinned(places, triangles, 90))
        motions.append((name, places[shown], small))
    for i, scenario in enumerate(PAPER):
        mesh, places, triangles = motions[i % len(motions)]
        made = motion_of(scenario, places, triangles)
        manifest["motions"].append({
            "scenario": scenario, "title": made["title"], "mesh": mesh, "steps": made["steps"],
            "triangles": blobs.add(made["triangles"].astype(numpy.uint32)), "frames": blobs.places(made["moved"], delta=True),
            "obstacle": {"positions": blobs.places(made["floor"][0]), "triangles": blobs.add(made["floor"][1].astype(numpy.uint8))}})
    results = {"began": "2026-11-20T17:30:00Z", "threads": 1, "runs": 3, "machine": {"processor": "Sample processor"},
               "meshes": records,
               "scenarios": [{"name": name, "title": name, "mesh": manifest["motions"][i]["mesh"], "method": "backward-euler",
                              "material": "corotational", "steps": 240, "turn": 4, "interleaved": True,
                              "fixed_addresses": True, "processors": [0]} for i, name in enumerate(PAPER)]}
    titles = list(ORDERINGS.values())
    seconds = {name: [rng.uniform(50, 100) for _ in titles] for name in PAPER}
    speedups = [[name, (paper[1], f"{paper[1]} %"), *[(value := rng.normal(8, 6), f"{value:.1f} %", *(["weak"] * (value < 4)))
                                                      for _ in titles[:3]], (20, "20")] for name, paper in PAPER.items()]
    tables = {
        "table-1": table("table-1", "Table 1: mean edge span", "How far apart in memory the ends of an edge are.", ["Mesh", *titles], span_rows),
        "table-2": table("table-2", "Table 2: seconds", "Sums over 240 steps, mean of three runs.", ["Scenario", *titles],
                         [[n, *[(s, f"{s:.2f} ± 0.1") for s in row]] for n, row in seconds.items()]),
        "table-3": table("table-3", "Table 3: seconds saved", "Against the scrambled order.", ["Scenario", *titles],
                         [[n, *[(row[3] - s, f"{row[3] - s:.2f}") for s in row]] for n, row in seconds.items()]),
        "table-4": table("table-4", "Table 4: speedup in per cent", "Over the scrambled order, with the paper's figures beside; "
                         "in italics what the noise swallows.", ["Scenario", "Paper, Fiedler", *titles[:3], "Break-even step"], speedups),
        "machine": table("machine", "This machine", "What was measured on.", ["What", "Value"],
                         [["Processor", "Sample processor"], ["Cores", (2, "2")]])}
    for name in ("break-even", "misses-1", "misses-2", "phases", "kernels", "motions"):
        rows = [[f"{scenario}, {title}", (value := int(rng.integers(1000)), str(value)), (-value, str(-value))]
                for scenario in PAPER for title in titles + titles[:2 * (name == "kernels")]]
        tables[name] = table(name, f"Sample: {name}", "Made up.", ["Scenario and order", "A", "B"], rows)
    tables["protocol"] = table("protocol", "How it was measured", "Made up.", ["What", "Is"], [["Runs", (3, "3")], ["Turns", "of 4 steps"]])
    parts = {
        "title": "Sample of a report", "has": "meshes scenarios motions",
        "findings": "<p>These numbers are made up: this page shows what a report looks like.</p><p>The second finding.</p>",
        "style": (VIEWER / "style.css").read_text(), "three": THREE.read_text(),
        "scripts": "\n".join(path.read_text() for path in sorted(VIEWER.glob("*.js"))),
        "data": "\n".join([f'<script type="application/json" id="{name}">{json.dumps(value)}</script>'
                           for name, value in (("results", results), ("manifest", manifest))] + [blobs.html()])}
    parts.update({f"table {name}": text for name, text in tables.items()})
    for section in ("speedup", "spans", "caches", "phases", "prediction"):
        parts[f"figures {section}"] = bars(f"{section.capitalize()} of the sample", [(n, p[1]) for n, p in PAPER.items()])
    return parts


def fill(frame, parts):
    return re.sub(r"\{\{([a-z0-9 -]+)\}\}", lambda match: parts.get(match.group(1), ""), frame)


def write_sample(path, models=()):
    pathlib.Path(path).write_text(fill((VIEWER / "page.html").read_text(), sample_parts(models)))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    write_sample(sys.argv[1], sys.argv[2:])
