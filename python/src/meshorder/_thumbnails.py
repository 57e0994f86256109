# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Draws small pictures of matrices and permutations, as PNG."""

from __future__ import annotations

import base64
import html
import struct
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core

#: number of tiles, and of pixels, along each side of a thumbnail
SIDE = 64
_PAPER = np.array([255.0, 255.0, 255.0])
_INK = np.array([17.0, 33.0, 69.0])
_FAINTEST = 0.16  # share of ink of a tile with one entry


def pattern(
    offsets: NDArray[Any], neighbours: NDArray[Any], order: _core.Permutation, side: int
) -> NDArray[np.uint32]:
    """Counts the entries of a graph's matrix, diagonal included, in side × side tiles; n × n if n is less."""
    return np.asarray(_core.sparsity_pattern(offsets, neighbours, order, side))


def ink(counts: NDArray[Any], most: int) -> NDArray[np.float64]:
    """Returns a share of ink, 0 … 1, for each count: logarithmic, 1 at ``most``, visible for one entry."""
    shares = _FAINTEST + (1 - _FAINTEST) * np.log1p(counts) / np.log1p(max(most, 1))
    return np.where(counts > 0, np.minimum(shares, 1.0), 0.0)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(shares: NDArray[Any]) -> bytes:
    """Returns a PNG with a pixel for each share of ink, dark blue on white.

    Args:
        shares: an array of rank 2 of numbers in 0 … 1.
    """
    height, width = shares.shape
    rows = np.zeros((height, 1 + width), dtype=np.uint8)  # each row begins with the number of its filter, 0 for none
    rows[:, 1:] = np.rint(255 * shares)
    ramp = np.linspace(0, 1, 256)[:, np.newaxis]
    palette = np.rint(_PAPER + ramp * (_INK - _PAPER)).astype(np.uint8)
    header = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)  # 8 bits per pixel: a place in the palette
    pixels = zlib.compress(rows.tobytes(), 9)
    parts = [(b"IHDR", header), (b"PLTE", palette.tobytes()), (b"IDAT", pixels), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*part) for part in parts)


def image(counts: NDArray[Any], words: str, most: int | None = None) -> str:
    """Returns an HTML image of counts, one pixel for each, that needs no other file; an empty text if there are none.

    Args:
        counts: an array of rank 2.
        words: the alternative text: a description of the image.
        most: the count that is drawn darkest; None: the largest one.
    """
    if counts.size == 0:
        return ""
    data = base64.b64encode(png(ink(counts, int(counts.max()) if most is None else most))).decode("ascii")
    return (
        f'<img src="data:image/png;base64,{data}" alt="{html.escape(words)}" width="{SIDE}" height="{SIDE}" '
        f'style="min-width:{SIDE}px;image-rendering:pixelated;border:1px solid #8888;margin:2px">'
    )


def moves(old_to_new: NDArray[np.int32]) -> NDArray[Any]:
    """Counts a permutation's moves in at most 64 × 64 tiles. O(n).

    Old places go from left to right, new ones from top to bottom.
    """
    n = len(old_to_new)
    side = min(SIDE, n)
    if n == 0:
        return np.zeros((0, 0), dtype=np.int64)
    tiles = old_to_new.astype(np.int64) * side // n * side + np.arange(n) * side // n
    return np.bincount(tiles, minlength=side * side).reshape(side, side)
