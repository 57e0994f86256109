# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Layouts of cells for graphics processors, where many threads work at once. Order the mesh first."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._errors import InvalidArgument
from ._graphs import graph_arrays
from ._meshes import cell_arrays
from ._options import whole


_LAYOUTS = ("packed", "apart", "padded", "patches", "gathered")
_CACHE_BYTES = 50 * 2**20  # last cache of an H100


class Patches(NamedTuple):
    """Cells in patches, one for each block of threads, which keeps the patch's vertices in shared memory.

    Attributes:
        cells: the old number of each of the m cells: those of patch p are ``cells[p * size : (p + 1) * size]``.
        offsets: the vertices of patch p are ``vertices[offsets[p] : offsets[p + 1]]``.
        vertices: the vertices of each patch, ascending.
        local: m × k numbers of 16 bits: corner a of ``cells[i]`` is vertex ``local[i, a]`` of its patch.
        size: number of cells of each patch; the last may have fewer.
    """

    cells: NDArray[np.int32]
    offsets: NDArray[np.int64]
    vertices: NDArray[np.int32]
    local: NDArray[np.uint16]
    size: int


class GatherLists(NamedTuple):
    """The cells at each vertex: those of vertex v are at ``offsets[v]`` to below ``offsets[v + 1]``.

    Attributes:
        offsets: n + 1 numbers.
        cells: the cells of each vertex, ascending.
        corners: the position of the vertex in that cell.
    """

    offsets: NDArray[np.int64]
    cells: NDArray[np.int32]
    corners: NDArray[np.uint8]


class Colours(NamedTuple):
    """Cells by colour: no two cells of a colour share a vertex.

    Attributes:
        starts: the cells of colour c are ``cells[starts[c] : starts[c + 1]]``.
        cells: all cells, colour after colour, in their old order within a colour.
    """

    starts: NDArray[np.int32]
    cells: NDArray[np.int32]


class GpuCost(NamedTuple):
    """Cost of a kernel on a GPU.

    Attributes:
        requests: additions, or loads and stores, each of a warp of 32 threads at once.
        sectors: sectors of 32 bytes that these requests touch. A sector of additions counts t times, where t is the largest
            number of threads of the warp that add to the same number in it.
        floor: ``sectors`` if the numbers that each warp touches at once were all different and side by side; for patches, also
            if no vertex were in two patches.
        dram_bytes: bytes read from memory, if the cache is filled again and again.
        dram_floor: ``dram_bytes`` if each number were read once.
    """

    requests: int
    sectors: int
    floor: int
    dram_bytes: int
    dram_floor: int


def _given(cells: Any, vertices: int | None) -> tuple[Any, int]:
    """Returns cells as the library takes them, and the number of vertices."""
    arrays = cell_arrays(cells, 3)
    if vertices is not None:
        return arrays, whole(vertices, 2**31 - 1, "vertices")
    named = [block for _, block in arrays] if isinstance(arrays, list) else [arrays[1]]
    most = max((int(block.max()) + 1 for block in named if block.size), default=0)
    return arrays, min(most, 2**63)  # the library refuses 2⁶³ vertices


def _rows(values: NDArray[Any], cells: Any) -> NDArray[Any]:
    """Returns values with a row for each of the cells, which `_given` returned."""
    if isinstance(cells, list):
        return values.reshape(-1, cells[0][1].shape[1]) if cells else values.reshape(0, 0)
    return values.reshape(len(cells[0]) - 1, -1) if values.size else values.reshape(0, 0)


def patches(cells: Any, size: int = 256, *, vertices: int | None = None) -> Patches:
    """Cuts cells into patches, in their order.

    A block of threads loads the vertices of its patch into shared memory, uses their local numbers, and adds up its results
    there. Within a patch, neighbouring cells are spread over the warps of 32 threads, so that few threads of a warp add to
    the same vertex.

    Args:
        cells: cells of one type, in one of the forms that `order_mesh` takes; rows of two are edges.
        size: cells of a patch, 2 … 65,535 / k for cells of k vertices; multiples of 32 fill all warps.
        vertices: number of vertices n; None: as many as the cells name.

    Raises:
        InvalidArgument: faulty cells, cells of several types, a size out of range.
        TooLarge: 2³¹ or more cells.

    Example:
        The vertices that block p of threads has in shared memory, and the corners of its cells there::

            cut = meshorder.patches(tetrahedra)
            shared = positions[cut.vertices[cut.offsets[p] : cut.offsets[p + 1]]]
            corners = shared[cut.local[p * cut.size : (p + 1) * cut.size]]
    """
    arrays, count = _given(cells, vertices)
    size = whole(size, 2**16, "size")
    order, offsets, own, local = _core.patches(arrays, count, size)
    return Patches(order, offsets, own, _rows(local, arrays), size)


def gather_lists(cells: Any, *, vertices: int | None = None) -> GatherLists:
    """Lists the cells at each vertex, so that each vertex can sum their contributions without atomics.

    Args:
        cells: cells in one of the forms that `order_mesh` takes, with at most 256 vertices each; rows of two are edges.
        vertices: number of vertices n; None: as many as the cells name.

    Raises:
        InvalidArgument: faulty cells.
        TooLarge: 2³¹ or more cells.
    """
    return GatherLists(*_core.gather_lists(*_given(cells, vertices)))


def colours(cells: Any, *, vertices: int | None = None) -> Colours:
    """Colours cells, or edges, so that no two of a colour share a vertex and threads may work on a colour at once.

    Args:
        cells: cells in one of the forms that `order_mesh` takes; rows of two are edges.
        vertices: number of vertices n; None: as many as the cells name.

    Raises:
        InvalidArgument: faulty cells.
        TooLarge: 2³¹ or more cells.
    """
    return Colours(*_core.colours(*_given(cells, vertices)))


def sort_corners(cells: Any, *, vertices: int | None = None) -> NDArray[np.int32]:
    """Sorts the vertices of each triangle or tetrahedron as far as its orientation allows.

    A triangle then begins with its smallest vertex. The vertices of a tetrahedron ascend; the last two are swapped if
    ascending order would reverse the orientation.

    Args:
        cells: linear triangles or tetrahedra, in one of the forms that `order_mesh` takes; rows of four are tetrahedra.
        vertices: number of vertices n; None: as many as the cells name.

    Returns:
        A row of vertices for each cell.

    Raises:
        InvalidArgument: faulty cells, cells of other types.
        TooLarge: 2³¹ or more cells.
    """
    arrays, count = _given(cells, vertices)
    return _rows(_core.sort_corners(arrays, count), arrays)


def gpu_cost(
    cells: Any, layout: str = "padded", *, vertices: int | None = None, cache_bytes: int = _CACHE_BYTES
) -> GpuCost:
    """Counts what adding to the vertices of cells costs on a GPU, with one thread for each cell. The count needs no GPU.

    Of two orders of the same cells, the one with fewer sectors is faster there. ``sectors`` are those of atomic additions;
    for "gathered", those that the first pass stores and the second one loads. ``dram_bytes`` counts vertex numbers (4 bytes
    each, 2 bytes within patches) and two arrays with the layout's numbers for each vertex: one is read, the other is added to.
    Other data of the cells is not counted.

    Args:
        cells: cells of one type, in one of the forms that `order_mesh` takes; rows of two are edges.
        layout: where the kernel keeps the numbers of 4 bytes that it adds to vertices: "packed" has three side by side,
            each added separately; "apart" has three arrays; "padded" has four side by side, added at once; "patches" is
            "packed" by `patches` of 256 cells; "gathered" is two passes by `gather_lists`.
        vertices: number of vertices n; None: as many as the cells name.
        cache_bytes: size of the last cache, ≥ 1; by default that of an H100.

    Raises:
        InvalidArgument: faulty cells, cells of several types, another layout, no cache.
        TooLarge: 2³¹ or more cells.

    Example:
        >>> import numpy as np
        >>> edges = np.arange(64).reshape(2, 32).T            # 32 edges, no two with a common vertex
        >>> meshorder.gpu_cost(edges).sectors, meshorder.gpu_cost(edges * [1, 0]).sectors
        (32, 48)
    """
    if layout not in _LAYOUTS:
        known = ", ".join(map(repr, _LAYOUTS[:-1]))
        raise InvalidArgument(f"layout: expected {known} or {_LAYOUTS[-1]!r}, not {layout!r}")
    cache = whole(cache_bytes, 2**62, "cache_bytes")
    return GpuCost(*_core.gpu_cost(*_given(cells, vertices), _LAYOUTS.index(layout), cache))


def gpu_product_cost(graph: Any, lanes: int = 1, *, cache_bytes: int = _CACHE_BYTES) -> GpuCost:
    """Counts what the product of a sparse matrix with a vector costs on a GPU. The count needs no GPU.

    The matrix has an entry for each neighbour in the graph, and a diagonal, in compressed sparse rows with numbers of 4 bytes.
    ``sectors`` and ``dram_bytes`` are those of loads: of offsets, columns, values and the vector.

    Args:
        graph: the pattern of the matrix, in one of the forms that `order` takes; that of A + Aᵀ where it is not symmetric.
        lanes: threads of a row: 1, 2, 4, 8, 16 or 32.
        cache_bytes: size of the last cache, ≥ 1; by default that of an H100.

    Raises:
        InvalidArgument: another number of threads, no cache, a faulty graph.
        TooLarge: 2³¹ or more rows.
    """
    offsets, neighbours, _ = graph_arrays(graph, mirror=True)
    cache = whole(cache_bytes, 2**62, "cache_bytes")
    return GpuCost(*_core.gpu_product_cost(offsets, neighbours, whole(lanes, 32, "lanes"), cache))
