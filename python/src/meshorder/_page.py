# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Makes the page of `meshorder.show` from the viewer of the report page."""

from __future__ import annotations

import base64
import html
import json
import os
import pathlib
import re
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import Unavailable
from ._graphs import quality
from ._meshes import Mesh
from ._permutation import Permutation
from ._thumbnails import pattern

_VIEWER = pathlib.Path(__file__).with_name("viewer")
_PATTERN_SIDE = 192
_STEPS = 65535  # number of steps to which coordinates are rounded, along each side of the mesh's box


class Page:
    """A page in HTML that needs no other files and no network.

    A notebook shows it if it is the result of a cell, in a frame that may run scripts and nothing else.

    Attributes:
        html: the text of the page.
        triangles: number of triangles of the surface in it.
        path: the file that it was last saved to; None if it was never saved.
    """

    def __init__(self, page: str, triangles: int) -> None:
        self.html = page
        self.triangles = triangles
        self.path: pathlib.Path | None = None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page to a file and sets ``path``.

        Raises:
            OSError: the file cannot be written.
        """
        self.path = pathlib.Path(path)
        self.path.write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.html)}" sandbox="allow-scripts" title="mesh in its orders" '
            'style="width:100%;height:780px;border:1px solid #8888;border-radius:6px"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<Page: {self.triangles:,} triangles{f', {self.path}' if self.path else ''}>"


class _Arrays:
    """The page's arrays, in the form that its scripts decode (viewer/README.md)."""

    def __init__(self) -> None:
        self.elements: dict[str, str] = {}

    def add(self, numbers: NDArray[Any], dtype: Any = None) -> dict[str, Any]:
        """Adds non-negative integers, in the smallest type that holds them, and returns their description."""
        most = int(numbers.max(initial=0))
        kind = np.dtype(dtype or (np.uint8 if most < 1 << 8 else np.uint16 if most < 1 << 16 else np.uint32))
        packed = zlib.compress(numbers.astype(kind.newbyteorder("<")).tobytes(), 9)
        name = f"blob-{len(self.elements) + 1}"
        self.elements[name] = base64.b64encode(packed).decode("ascii")
        return {"blob": name, "type": kind.name, "shape": list(numbers.shape)}

    def add_places(self, points: NDArray[np.float64]) -> dict[str, Any]:
        """Adds points, rounded to 65,536 steps along each side of the box around them."""
        low = points.min(axis=0)
        sides = points.max(axis=0) - low
        scale = np.where(sides > 0, sides, 1.0) / _STEPS
        described = self.add(np.rint((points - low) / scale), np.uint16)
        return {**described, "scale": scale.tolist(), "offset": low.tolist()}


def _sources() -> dict[str, str]:
    """Returns the sources of the viewer's files in the package.

    Raises:
        Unavailable: three.js is not among them.
    """
    three = _VIEWER / "three.min.js"
    if not three.is_file():
        raise Unavailable(
            "show: this build of meshorder has no three.js, which draws the mesh; install Debian's libjs-three (or set "
            "MESHORDER_THREE_JS of CMake to the path of three.min.js, release 111) and build it again with pip install"
        )
    read = {path.name: path.read_text(encoding="utf-8") for path in _VIEWER.iterdir() if path.is_file()}
    scripts = "\n".join(text for name, text in sorted(read.items()) if name.endswith(".js") and name != three.name)
    return {
        "frame": read["show.html"],
        "style": read["style.css"],
        "scripts": scripts,
        "three": read["three_licence.txt"] + read[three.name],
    }


def _json_element(name: str, value: Any) -> str:
    text = json.dumps(value).replace("<", "\\u003c")
    return f'<script type="application/json" id="{name}">{text}</script>\n'


def make_page(mesh: Mesh, orders: Mapping[str, Permutation], mesh_name: str) -> Page:
    """Makes a page that shows a mesh as it is and in the given orders, by name.

    Raises:
        InputError: the mesh has neither surfaces nor volumes.
        Unavailable: this build lacks three.js.
    """
    name = mesh_name or "mesh"
    corners = mesh._handle.surface()
    vertices, places = np.unique(corners, return_inverse=True)
    offsets, neighbours = mesh._handle.graph()
    shown = {"as it is": Permutation.identity(len(mesh.points)), **orders}

    arrays = _Arrays()
    described: dict[str, Any] = {
        "name": name,
        "vertices": len(mesh.points),
        "positions": arrays.add_places(mesh.points[vertices]),
        "triangles": arrays.add(places.reshape(-1, 3)),
        "ranks": {name: arrays.add(order.old_to_new[vertices]) for name, order in shown.items()},
        "sparsity": {
            name: arrays.add(pattern(offsets, neighbours, order._handle, _PATTERN_SIDE))
            for name, order in shown.items()
        },
    }
    manifest = {"orderings": [{"name": name, "title": name} for name in shown], "meshes": [described]}
    spans = [
        {"ordering": name, "span": {"mean": quality((offsets, neighbours), order).mean_span}}
        for name, order in shown.items()
    ]
    results = {"meshes": [{"name": name, "orders": spans}]}
    blobs = "".join(
        f'<script type="text/plain" id="{blob}">{text}</script>\n' for blob, text in arrays.elements.items()
    )

    triangles = len(corners) // 3
    parts = _sources()
    parts["title"] = f"Vertex orders of {html.escape(mesh_name)}" if mesh_name else "Vertex orders"
    parts["summary"] = f"{len(mesh.points):,} vertices · {len(mesh.shapes):,} cells · {triangles:,} surface triangles"
    parts["data"] = _json_element("results", results) + _json_element("manifest", manifest) + blobs
    return Page(re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], parts["frame"]), triangles)
