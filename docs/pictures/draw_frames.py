#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Draws frames of a simulation side by side, in one scale, coloured by strain.

    docs/pictures/draw_frames.py OUT.png LARGEST FIRST.vtu FRAME.vtu FRAME.vtu ...

The strain of a vertex is the mean of |length / rest length - 1| over its edges of the surface: violet where there is
none, yellow from LARGEST on. NAME-obstacles.vtu beside FIRST.vtu is drawn in grey, and what is hollow cut open.
Needs NumPy and meshio.
"""
import pathlib
import sys

import meshio
import numpy

from raster import boundary_faces, cropped, drawn, in_view, ramp, read_tetrahedra, rotated, write_png

SIZE = 360  # pixels of a frame's side


def strain(points, rest, faces):
    """Of each vertex; 0 inside."""
    ends = numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    length = numpy.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    change = numpy.abs(length / numpy.linalg.norm(rest[ends[:, 0]] - rest[ends[:, 1]], axis=1) - 1)
    count = numpy.bincount(ends.ravel(), minlength=len(points))
    total = numpy.bincount(ends.ravel(), numpy.repeat(change, 2), minlength=len(points))
    return total / numpy.maximum(count, 1)


def colour(value, largest):
    """Of strains, and grey for the obstacles' -1."""
    return numpy.where(value[:, None] < 0, 0.8, 0.25 + 0.75 * ramp(value / largest))


def read_obstacles(rest_path):
    """Points and triangles of the obstacles, of those that are not flat the half that is farther away."""
    path = pathlib.Path(rest_path)
    path = path.with_name(path.name.rsplit("-", 1)[0] + "-obstacles.vtu")
    if not path.exists():
        return numpy.empty((0, 3)), numpy.empty((0, 3), int)
    mesh = meshio.read(path)
    faces, number = mesh.cells_dict["triangle"], mesh.cell_data["obstacle"][0].ravel()
    depth = rotated(mesh.points, 0.5, 0)[:, 2][faces].mean(axis=1)
    kept = []
    for one in range(number.max() + 1):
        own = faces[number == one]
        corners = mesh.points[numpy.unique(own)]
        flat = numpy.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)[2] < 1e-6
        kept.append(own if flat else own[depth[number == one] < depth[number == one].mean()])
    return mesh.points, numpy.concatenate(kept)


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    largest = float(sys.argv[2])
    start, cells, data = read_tetrahedra(sys.argv[3])
    rest = start - data["displacement"]
    obstacles, triangles = read_obstacles(sys.argv[3])
    faces = numpy.concatenate([triangles, boundary_faces(cells) + len(obstacles)])
    frames = [read_tetrahedra(path)[0] for path in sys.argv[4:]]
    images = []
    for pixels, points in zip(in_view([numpy.concatenate([obstacles, points]) for points in frames], SIZE), frames):
        values = numpy.concatenate([numpy.full(len(obstacles), -1), strain(points, rest, boundary_faces(cells))])
        images.append(drawn(pixels, faces, values, lambda value: colour(value, largest), SIZE))
    write_png(sys.argv[1], numpy.concatenate(cropped(images), axis=1))


if __name__ == "__main__":
    main()
