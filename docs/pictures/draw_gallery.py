#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Makes the meshes of docs/gallery.md, draws them before and after, and prints the page's table.

    docs/pictures/draw_gallery.py FOLDER [SECONDS]

The meshes are written to FOLDER, where those of an earlier run are taken again; pictures go beside this script. The kernels
run for SECONDS on each mesh (default 30). MESHORDER names the command, else build/bin/meshorder is taken. Needs NumPy,
meshio and gmsh.
"""
import json
import os
import pathlib
import subprocess
import sys

import numpy

import draw_orders
from raster import cropped, write_png

HERE = pathlib.Path(__file__).resolve().parent
MESHORDER = os.environ.get("MESHORDER", str(HERE.parents[1] / "build" / "bin" / "meshorder"))
KERNELS = ("spmv", "element", "assembly", "springs")


def meshorder(*words):
    return subprocess.run([MESHORDER, *map(str, words)], check=True, capture_output=True, text=True).stdout


def model(name, *options):
    """Copies a model that meshorder makes, in the order in which TetGen or the lattice's rule left it."""
    def make(path):
        made = json.loads(meshorder("models", "make", name, *options, "--json"))["models"][0]["path"]
        meshorder("order", made, "-o", path, "--vertices", "original", "--elements", "original")
    return make


def block(refined):
    """Fills a block with a hole by Gmsh; refined: splits each tetrahedron into eight."""
    def make(path):
        import gmsh
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        for bound in ("Min", "Max"):
            gmsh.option.setNumber(f"Mesh.MeshSize{bound}", 0.07 if refined else 0.035)
        occ = gmsh.model.occ
        occ.cut([(3, occ.addBox(0, 0, 0, 2, 1, 1))], [(3, occ.addCylinder(1, 0.5, -1, 0, 0, 3, 0.25))])
        occ.synchronize()
        gmsh.model.mesh.generate(3)
        if refined:
            gmsh.model.mesh.refine()
        gmsh.write(str(path.with_suffix(".msh")))
        gmsh.finalize()
        meshorder("order", path.with_suffix(".msh"), "-o", path, "--vertices", "original", "--elements", "original")
        path.with_suffix(".msh").unlink()
    return make


MESHES = {
    "dragon": ("TetGen", model("dragon")),
    "armadillo": ("TetGen", model("armadillo")),
    "bunny": ("TetGen", model("bunny")),
    "block": ("Gmsh", block(refined=False)),
    "refined": ("Gmsh, refined once", block(refined=True)),
    "ball": ("a lattice, bent", model("ball", "--size", "40")),
}


def halved(image):
    """An image in half of its width and height."""
    height, width = (size // 2 for size in image.shape[:2])
    return image[:2 * height, :2 * width].reshape(height, 2, width, 2, 3).mean(axis=(1, 3))


def row(name, maker, path, ordered, seconds):
    """A row of the table: how many times as fast the kernels run in `auto`'s order as in the file's, and what it costs."""
    made = json.loads(meshorder("order", path, "-o", ordered, "--json"))
    cells = [f"{name}, {maker}", f"{made['vertices']['count']:,}"]
    if made["vertices"]["kept"] and made["cells"]["kept"]:
        return f"| {' | '.join([*cells, *['–' for _ in KERNELS], 'stays as it is'])} |"
    found = json.loads(meshorder("compare", path, "--methods", "auto", "--budget", seconds, "--json"))
    _, taken = found["methods"]
    factors = [f"{taken['kernels'][kernel]['speedup']:.2f}" for kernel in KERNELS]
    methods = f"`{made['vertices']['method']}/{made['cells']['method']}`, {1000 * taken['seconds']:.0f} ms"
    return f"| {' | '.join([*cells, *factors, methods])} |"


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(exist_ok=True)
    for name, (maker, make) in MESHES.items():
        path, ordered = folder / f"{name}.vtu", folder / f"{name}-ordered.vtu"
        if not path.exists():
            make(path)
        line = row(name, maker, path, ordered, sys.argv[2] if len(sys.argv) > 2 else 30)
        panels = cropped([draw_orders.panel(path), draw_orders.panel(ordered)])
        write_png(HERE / f"gallery-{name}.png", halved(numpy.concatenate(panels, axis=1)))
        print(line)


if __name__ == "__main__":
    main()
