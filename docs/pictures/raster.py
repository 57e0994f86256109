# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Draws surfaces of tetrahedral meshes by NumPy alone: what the scripts beside it share."""
import struct
import zlib

import meshio
import numpy

SIZE = 640  # pixels of a panel's side
OVERSAMPLING = 2  # samples along each side of a pixel
# colours that also differ in brightness, so that they read without colour vision and in print
RAMP = numpy.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]]) / 255.0


def boundary_faces(cells):
    """Corners of the faces that belong to one tetrahedron only, turned outwards."""
    faces = numpy.concatenate([cells[:, [1, 2, 3]], cells[:, [0, 3, 2]], cells[:, [0, 1, 3]], cells[:, [0, 2, 1]]])
    key = numpy.sort(faces, axis=1)
    order = numpy.lexsort(key.T)
    same = (key[order][1:] == key[order][:-1]).all(axis=1)
    single = numpy.ones(len(faces), dtype=bool)
    single[order[1:][same]] = False
    single[order[:-1][same]] = False
    return faces[single]


def ramp(share):
    place = numpy.clip(share, 0, 1) * (len(RAMP) - 1)
    low = numpy.minimum(place.astype(int), len(RAMP) - 2)
    return RAMP[low] + (place - low)[:, None] * (RAMP[low + 1] - RAMP[low])


def rotated(points, about_y, about_x):
    c, s = numpy.cos(about_y), numpy.sin(about_y)
    points = points @ numpy.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])
    c, s = numpy.cos(about_x), numpy.sin(about_x)
    return points @ numpy.array([[1, 0, 0], [0, c, s], [0, -s, c]])


def read_tetrahedra(path):
    """Points, tetrahedra and the data of the points."""
    mesh = meshio.read(path)
    return mesh.points, next(block.data for block in mesh.cells if block.type == "tetra"), mesh.point_data


def in_view(frames, size=SIZE, about_y=0.5, about_x=0.25):
    """Point sets turned towards the viewer and brought to pixels, all in one scale and place."""
    turned = [rotated(points, about_y, about_x) for points in frames]
    low = numpy.min([points.min(axis=0) for points in turned], axis=0)
    high = numpy.max([points.max(axis=0) for points in turned], axis=0)
    side = size * OVERSAMPLING
    scale = 0.92 * side / (high - low)[:2].max()
    return [(points - (low + high) / 2) * [scale, -scale, scale] + [side / 2, side / 2, 0] for points in turned]


def drawn(pixels, faces, values, colour, size=SIZE):
    """A shaded surface as an image, size × size × 3 in [0, 1]; `colour` maps values of the points to colours."""
    side = size * OVERSAMPLING
    corners = pixels[faces]
    normal = numpy.cross(corners[:, 2] - corners[:, 0], corners[:, 1] - corners[:, 0])
    length = numpy.linalg.norm(normal, axis=1)
    light = numpy.array([-0.35, -0.55, 0.75]) / numpy.linalg.norm([-0.35, -0.55, 0.75])
    shade = 0.35 + 0.65 * numpy.abs(normal @ light) / numpy.maximum(length, 1e-30)

    # every face is sampled finely enough to leave no hole, and nearer samples cover farther ones
    image = numpy.ones((side * side, 3))
    depth = numpy.full(side * side, -numpy.inf)
    extent = (corners[:, :, :2].max(axis=1) - corners[:, :, :2].min(axis=1)).max(axis=1)
    steps = numpy.ceil(1.5 * extent).astype(int) + 1
    for count in numpy.unique(steps):
        chosen = numpy.flatnonzero(steps == count)
        i, j = numpy.meshgrid(numpy.arange(count + 1), numpy.arange(count + 1))
        weights = numpy.stack([i, j, count - i - j], axis=-1)[i + j <= count] / count
        for part in numpy.array_split(chosen, max(1, len(chosen) * len(weights) // 2_000_000)):
            where = numpy.einsum("sk,fkd->fsd", weights, corners[part])
            pixel = where[..., 1].astype(int).ravel() * side + where[..., 0].astype(int).ravel()
            z = where[..., 2].ravel()
            paint = colour(numpy.einsum("sk,fk->fs", weights, values[faces[part]]).ravel())
            paint = paint * numpy.repeat(shade[part], len(weights))[:, None]
            order = numpy.argsort(z, kind="stable")  # the last one written to a pixel is the nearest
            pixel, z, paint = pixel[order], z[order], paint[order]
            last = numpy.full(side * side, -1)
            last[pixel] = numpy.arange(len(pixel))
            hit = numpy.flatnonzero(last >= 0)
            nearer = hit[z[last[hit]] > depth[hit]]
            image[nearer] = paint[last[nearer]]
            depth[nearer] = z[last[nearer]]
    return image.reshape(size, OVERSAMPLING, size, OVERSAMPLING, 3).mean(axis=(1, 3))


def write_png(path, image):
    data = (numpy.clip(image, 0, 1) * 255 + 0.5).astype(numpy.uint8)
    height, width, _ = data.shape
    raw = numpy.concatenate([numpy.zeros((height, 1), numpy.uint8), data.reshape(height, -1)], axis=1).tobytes()

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def cropped(panels, margin=20):
    """All panels cut to the rows that any of them uses, each to the columns that it uses."""
    used = [(image < 0.999).any(axis=2) for image in panels]
    rows = numpy.flatnonzero(numpy.any([u.any(axis=1) for u in used], axis=0))
    top, bottom = max(rows[0] - margin, 0), rows[-1] + margin
    result = []
    for image, u in zip(panels, used):
        columns = numpy.flatnonzero(u.any(axis=0))
        result.append(image[top:bottom, max(columns[0] - margin, 0):columns[-1] + margin])
    return result
