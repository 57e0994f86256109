#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Draws frames of a simulation side by side, in one scale, coloured by strain.

    docs/pictures/draw_frames.py OUT.png LARGEST REST.vtu FRAME.vtu FRAME.vtu ...

The strain of a vertex is the mean of |length / rest length - 1| over its edges of the surface: violet where there is
none, yellow from LARGEST on. Needs NumPy and meshio.
"""
import sys

import numpy

from raster import boundary_faces, cropped, drawn, in_view, ramp, read_tetrahedra, write_png

SIZE = 360  # pixels of a frame's side


def strain(points, rest, faces):
    """Of each vertex; 0 inside."""
    ends = numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    length = numpy.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    change = numpy.abs(length / numpy.linalg.norm(rest[ends[:, 0]] - rest[ends[:, 1]], axis=1) - 1)
    count = numpy.bincount(ends.ravel(), minlength=len(points))
    total = numpy.bincount(ends.ravel(), numpy.repeat(change, 2), minlength=len(points))
    return total / numpy.maximum(count, 1)


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    largest = float(sys.argv[2])
    rest, cells, _ = read_tetrahedra(sys.argv[3])
    faces = boundary_faces(cells)
    frames = [read_tetrahedra(path)[0] for path in sys.argv[4:]]
    images = [
        drawn(pixels, faces, strain(points, rest, faces), lambda value: 0.25 + 0.75 * ramp(value / largest), SIZE)
        for pixels, points in zip(in_view(frames, SIZE), frames)
    ]
    write_png(sys.argv[1], numpy.concatenate(cropped(images), axis=1))


if __name__ == "__main__":
    main()
