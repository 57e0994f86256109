# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Valid arrays are read in place: neither NumPy nor the C++ library copies them."""

import os
import subprocess
import sys
import tracemalloc
from typing import Any

import meshorder
import numpy as np
import pytest

# rings in which every vertex has many neighbours: the arrays are much larger than the memory that an order needs
GRAPH = """
import numpy as np
n, reach = 12_000, 400
offsets = np.arange(n + 1, dtype=np.int64) * (2 * reach)
steps = np.delete(np.arange(-reach, reach + 1, dtype=np.int32), reach)
neighbours = np.empty((n, 2 * reach), dtype=np.int32)
for vertex in range(n):
    neighbours[vertex] = np.sort((steps + vertex) % n)
neighbours = neighbours.reshape(-1)
size = offsets.nbytes + neighbours.nbytes
apart = np.repeat(neighbours, 2)[::2]
"""
MESH = """
import numpy as np
n = 400_000
points = np.empty((n, 3))
for axis in range(3):
    points[:, axis] = np.arange(n)
cells = np.empty((4 * n, 4), dtype=np.int32)
cells[:, 0] = np.arange(4 * n) % n
for corner in range(1, 4):
    np.remainder(cells[:, corner - 1] + 1, n, out=cells[:, corner])
size = points.nbytes + cells.nbytes
apart = np.repeat(cells, 2, axis=0)[::2]
"""
# the peak of the process's memory during the call, less its memory before
GROWTH = """
import ctypes, meshorder
meshorder.order((np.zeros(1, np.int64), np.zeros(0, np.int32)), "original")
ctypes.CDLL(None).malloc_trim(0)
def memory(key):
    with open("/proc/self/status") as file:
        return next(1024 * int(line.split()[1]) for line in file if line.startswith(key))
with open("/proc/self/clear_refs", "w") as file:
    file.write("5")
before = memory("VmRSS")
made = CALL
print((memory("VmHWM") - before) / size)
"""


def growth(arrays, call):
    """The growth of a process's memory during a call, as a fraction of the arrays' size."""
    program = arrays + GROWTH.replace("CALL", call)
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, env=environment)
    return float(done.stdout)


@pytest.mark.skipif(not os.access("/proc/self/clear_refs", os.W_OK), reason="only Linux tells how much memory was used")
@pytest.mark.parametrize(
    "arrays, call",
    [
        (GRAPH, "meshorder.order((offsets, neighbours), 'original', symmetric=True)"),
        (GRAPH, "meshorder.fiedler((offsets, neighbours), max_iterations=3)"),
        (MESH, "meshorder.order_mesh(points, cells, vertices='original', elements='original')"),
    ],
)
def test_the_process_does_not_grow_by_a_copy(arrays, call):
    found = growth(arrays, call)
    # the same numbers in a strided array are copied
    copied = growth(arrays, call.replace("neighbours", "apart").replace("cells", "apart"))
    assert found < copied - 0.7
    assert found < 0.05 or "'original', symmetric" not in call


@pytest.mark.parametrize(
    "arrays, call",
    [
        (GRAPH, lambda a: meshorder.order((a["offsets"], a["neighbours"]), "rcm", symmetric=True)),
        (GRAPH, lambda a: meshorder.fiedler((a["offsets"], a["neighbours"]), max_iterations=3)),
        (GRAPH, lambda a: meshorder.quality((a["offsets"], a["neighbours"]))),
        (MESH, lambda a: meshorder.order_mesh(a["points"], a["cells"], vertices="hilbert")),
        (MESH, lambda a: meshorder.order_mesh(a["points"], {"tetra": a["cells"]}, vertices="hilbert")),
    ],
)
def test_numpy_allocates_nothing_for_clean_arrays(arrays, call):
    given: dict[str, Any] = {}
    exec(arrays, given)
    tracemalloc.start()
    call(given)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < given["size"] / 100


def test_results_are_views():
    offsets, neighbours = np.array([0, 1, 2]), np.array([1, 0], dtype=np.int32)
    order = meshorder.order((offsets, neighbours), "original")
    assert np.shares_memory(order.new_to_old, order.permutation.new_to_old)
    assert not order.new_to_old.flags.owndata and not order.new_to_old.flags.writeable
