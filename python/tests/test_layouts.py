# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Layouts for graphics processors against NumPy and SciPy."""

from typing import Any

import meshorder
import numpy as np
import pytest
from meshorder import InvalidArgument
from scipy.spatial import Delaunay


@pytest.fixture(scope="module")
def cells():
    points = np.random.default_rng(1).random((900, 3))
    points = points[meshorder.order_mesh(points, Delaunay(points).simplices, vertices="hilbert").vertices.new_to_old]
    return Delaunay(points).simplices


def scattered(cells, values, count):
    sums = np.zeros(count)
    np.add.at(sums, cells, values)
    return sums


@pytest.mark.parametrize("size", [2, 100, 256])
def test_patches_add_up_as_the_cells_do(cells, size):
    cut = meshorder.patches(cells, size)
    assert cut.local.dtype == np.uint16 and cut.local.shape == cells.shape and cut.size == size
    np.testing.assert_array_equal(np.sort(cut.cells), np.arange(len(cells)))
    values = np.random.default_rng(2).random(cells.shape)
    sums = np.zeros(900)
    for p in range(len(cut.offsets) - 1):
        rows, own = slice(p * size, (p + 1) * size), cut.vertices[cut.offsets[p] : cut.offsets[p + 1]]
        np.testing.assert_array_equal(own[cut.local[rows]], cells[cut.cells[rows]])
        assert (np.diff(own) > 0).all()
        sums[own] += scattered(cut.local[rows], values[cut.cells[rows]], len(own))
    np.testing.assert_allclose(sums, scattered(cells, values, 900), rtol=1e-12)


def test_gather_lists_add_up_without_conflicts(cells):
    lists = meshorder.gather_lists(cells, vertices=905)
    values = np.random.default_rng(2).random(cells.shape)
    taken = np.append(values[lists.cells, lists.corners], 0)
    used = lists.offsets[:-1] < lists.offsets[1:]
    sums = np.where(used, np.add.reduceat(taken, lists.offsets[:-1]), 0)
    np.testing.assert_allclose(sums, scattered(cells, values, 905), rtol=1e-12)


@pytest.mark.parametrize("width", [2, 4])
def test_colours_share_no_vertex(cells, width):
    rows = np.ascontiguousarray(cells[:, :width])
    found = meshorder.colours(rows)
    np.testing.assert_array_equal(np.sort(found.cells), np.arange(len(rows)))
    for begin, end in zip(found.starts, found.starts[1:]):
        own = found.cells[begin:end]
        assert (np.diff(own) > 0).all() and len(np.unique(rows[own])) == rows[own].size > 0


def test_sorted_corners_keep_the_orientation(cells):
    tetrahedra = meshorder.sort_corners(cells)
    triangles = meshorder.sort_corners(np.ascontiguousarray(cells[:, :3]))
    np.testing.assert_array_equal(triangles[:, 0], cells[:, :3].min(axis=1))
    for made, given in ((tetrahedra, cells), (triangles, cells[:, :3])):
        np.testing.assert_array_equal(np.sort(made, axis=1), np.sort(given, axis=1))
        # places of the corners: an even permutation has the determinant 1
        moves = (given[:, :, np.newaxis] == made[:, np.newaxis, :]).astype(float)
        np.testing.assert_allclose(np.linalg.det(moves), 1)


@pytest.mark.parametrize("layout, record, additions, arrays", [("packed", 12, 3, 1), ("apart", 4, 1, 3), ("padded", 16, 1, 1)])
def test_cost_is_that_of_its_definition(cells, layout, record, additions, arrays):
    sectors = requests = 0
    for begin in range(0, len(cells), 32):
        for corner in cells[begin : begin + 32].T:
            for k in range(additions):
                addresses, threads = np.unique(record * corner.astype(int) + 4 * k, return_counts=True)
                most = np.zeros(addresses.max() // 32 + 1, dtype=int)
                np.maximum.at(most, addresses // 32, threads)
                sectors += arrays * int(most.sum())
                requests += arrays
    cost = meshorder.gpu_cost(cells, layout)
    assert (cost.sectors, cost.requests) == (sectors, requests) and cost.floor < cost.sectors
    with pytest.raises(InvalidArgument, match="'packed', 'apart', 'padded', 'patches' or 'gathered'"):
        meshorder.gpu_cost(cells, "float3")


def test_costs_have_floors(cells):
    for layout in ("packed", "apart", "padded", "patches", "gathered"):
        cost = meshorder.gpu_cost(cells, layout)
        small = meshorder.gpu_cost(cells, layout, cache_bytes=2000)
        assert cost.floor <= cost.sectors == small.sectors
        assert cost.dram_floor <= cost.dram_bytes < small.dram_bytes
        with pytest.raises(InvalidArgument, match="a cache of 0 bytes"):
            meshorder.gpu_cost(cells, layout, cache_bytes=0)


def test_products_load_offsets_columns_values_and_vector():
    path = [0, 1, 3, 5, 6], [1, 0, 2, 1, 3, 2]  # with a diagonal: 10 entries in rows of 2, 3, 3 and 2
    cost = meshorder.gpu_product_cost(path)
    assert (cost.requests, cost.dram_bytes) == (2 + 3 * 3, 10 * 8 + 5 * 4 + 32)
    assert cost.dram_floor == cost.dram_bytes
    assert meshorder.gpu_product_cost(path, 8).requests == 2 + 3
    with pytest.raises(InvalidArgument, match="give 1, 2, 4, 8, 16 or 32"):
        meshorder.gpu_product_cost(path, 3)


def test_faults_are_named(cells):
    sizes: list[tuple[Any, str]] = [
        (0, "give 2 to"), (1, "give 2 to"), (65535, "give 2 to 16383"), (2.5, "whole number"), (-1, "size"),
    ]  # fmt: skip
    for size, words in sizes:
        with pytest.raises(InvalidArgument, match=words):
            meshorder.patches(cells, size)
    with pytest.raises(InvalidArgument, match="another type"):
        meshorder.patches({"tetra": cells, "triangle": cells[:, :3]})
    for layout in (meshorder.patches, meshorder.gather_lists, meshorder.colours, meshorder.sort_corners, meshorder.gpu_cost):
        with pytest.raises(InvalidArgument, match="outside 0"):
            layout(cells, vertices=800)
        with pytest.raises(InvalidArgument):
            layout(cells - 1)
        with pytest.raises(InvalidArgument, match="integers"):
            layout(cells.astype(float))
    with pytest.raises(meshorder.TooLarge):
        meshorder.colours(np.array([[0, 2**64 - 1]], dtype=np.uint64))
    with pytest.raises(InvalidArgument, match="not None"):
        meshorder.gpu_cost(cells, layout=None)  # type: ignore[arg-type]
    assert meshorder.patches(cells[:0]).local.shape == meshorder.sort_corners(cells[:0]).shape == (0, 4)
    for of_none in (meshorder.patches(cells[:0]).local, meshorder.gather_lists(cells[:0]).cells,
                    meshorder.colours(cells[:0]).cells, meshorder.sort_corners(cells[:0])):
        assert len(of_none) == 0
    with pytest.raises(InvalidArgument, match="neither triangles nor tetrahedra"):
        meshorder.sort_corners(np.ascontiguousarray(cells[:, :2]))
