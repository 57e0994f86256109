#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Draws tetrahedral meshes side by side, each coloured by its vertices' order: the README's picture.

    docs/pictures/draw_orders.py OUT.png MESH.vtu MESH.vtu ...

Blue comes first in memory, yellow last, and a dark line stands at every twentieth of the order. Where the order
follows the shape, the lines are smooth rings; where it does not, they are noise. Needs NumPy and meshio.
"""
import sys

import numpy

from raster import boundary_faces, cropped, drawn, in_view, ramp, read_tetrahedra, write_png

BANDS = 20


def panel(path):
    """One mesh as an image."""
    points, cells, _ = read_tetrahedra(path)
    rank = numpy.arange(len(points)) / len(points)

    def colour(share):
        line = numpy.abs(share * BANDS - numpy.round(share * BANDS)) < 0.07
        return ramp(share) * numpy.where(line, 0.25, 1)[:, None]

    return drawn(in_view([points])[0], boundary_faces(cells), rank, colour)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    write_png(sys.argv[1], numpy.concatenate(cropped([panel(path) for path in sys.argv[2:]]), axis=1))


if __name__ == "__main__":
    main()
