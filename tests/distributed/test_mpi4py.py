# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`meshorder.mpi`, which calls libmeshorder_mpi, in programs that mpirun starts."""
import os
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MESHORDER = pathlib.Path(os.environ.get("MESHORDER", ROOT / "build" / "bin" / "meshorder"))
LIBRARY = MESHORDER.parents[1] / "src" / "libmeshorder_mpi.so"
SECONDS = 60  # after which ranks are taken to wait for each other

# imports only this module: the wheel with the other modules is for another interpreter
BEGINNING = f"""
import sys, types
package = types.ModuleType("meshorder")
package.__path__ = [{str(ROOT / "python" / "src" / "meshorder")!r}]
sys.modules["meshorder"] = package
import numpy
from mpi4py import MPI
import meshorder.mpi
comm = MPI.COMM_WORLD
# a strip of triangles, of which each rank owns `own` vertices in a poor order
own = 500
def number(k):
    return k // own * own + 77 * (k % own) % own
first = comm.rank * own
last = min(comm.size * own, first + own + 2)
triangles = numpy.array([[number(k), number(k + 1), number(k + 2)] for k in range(first, last - 2)])
places = numpy.empty((own, 2))
for k in range(first, first + own):
    places[number(k) - first] = k // 2, k % 2
"""

pytest.importorskip("mpi4py")
if not LIBRARY.exists():
    pytest.skip("needs a build with MESHORDER_MPI=ON", allow_module_level=True)


def ranks(count, program, **variables):
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMPI_MCA_mpi_yield_when_idle": "1", "MESHORDER_MPI_LIBRARY": str(LIBRARY), **variables}
    return subprocess.run(["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(count), sys.executable, "-c",
                           BEGINNING + program], env=environment, capture_output=True, text=True, timeout=SECONDS, check=False)


def ended_well(done):
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("count", [1, 3])
def test_vertices_stay_with_their_ranks_and_neighbours_meet(count):
    ended_well(ranks(count, """
order = meshorder.mpi.order_ranks(comm, own, triangles)
assert sorted(order.new_numbers) == list(range(first, first + own))
assert sorted(order.cell_order) == list(range(len(triangles)))
inside = triangles[(triangles // own == comm.rank).all(axis=1)] - first
span = numpy.abs(numpy.diff(order.new_numbers[inside], axis=1))
assert span.mean() < 2.1, span.mean()
ordered = triangles[order.cell_order]
same = meshorder.mpi.order_ranks(comm, own, (3 * numpy.arange(len(triangles) + 1), triangles.ravel()), places)
assert (same.new_numbers == order.new_numbers).all()
"""))


def test_parts_are_ranges_of_the_new_numbers():
    ended_well(ranks(2, """
order = meshorder.mpi.order_parts(comm, own, triangles, places, parts=5)
every = numpy.sort(numpy.concatenate(comm.allgather(order.new_numbers)))
assert (every == numpy.arange(own * comm.size)).all()
assert order.part_starts[0] == 0 and order.part_starts[-1] == own * comm.size and len(order.part_starts) == 6
sizes = numpy.diff(order.part_starts)
assert sizes.max() <= 1.05 * sizes.mean()
assert set(order.cell_parts) <= set(range(5))
"""))


def test_errors_reach_all_ranks():
    said = ended_well(ranks(2, """
wrong = triangles.copy()
if comm.rank == 1:
    wrong[0, 0] = 10 ** 12
for call in (lambda: meshorder.mpi.order_ranks(comm, own, wrong),
             lambda: meshorder.mpi.order_ranks(comm, own if comm.rank == 0 else -1, triangles),
             lambda: meshorder.mpi.order_ranks(comm, own, triangles + 0.5),
             lambda: meshorder.mpi.order_ranks(comm, own, triangles if comm.rank == 0 else triangles + 0.5),
             lambda: meshorder.mpi.order_ranks(comm, own, triangles, places[comm.rank:]),
             lambda: meshorder.mpi.order_ranks(comm, "many" if comm.rank == 0 else own, triangles),
             lambda: meshorder.mpi.order_ranks(comm, own, triangles, method=None if comm.rank == 0 else "rcm"),
             lambda: meshorder.mpi.order_parts(comm, own, triangles, places, seed=comm.rank - 1),
             lambda: meshorder.mpi.order_parts(comm, own, triangles, places, parts=-5),
             lambda: meshorder.mpi.order_ranks(comm, own, triangles, method="nonsense"),
             lambda: meshorder.mpi.order_parts(comm, own, triangles, places, partition="nonsense")):
    try:
        call()
    except ValueError as error:
        print(type(error).__name__, error)
"""))
    assert said.count("InvalidArgument") == 22
    assert said.count("has the vertex 1000000000000") == 2
    assert said.count("expected integers") == 4 and said.count("rank 1: cells: expected integers") == 1
    for words in ("vertex_count: -1", "vertex_count: expected a whole number, not 'many'", "parts: -5", "seed: -1",
                  "points: expected 500 of them, not 499", "method: expected a text, not None"):
        assert said.count(words) == 2, words


def refused(call, count=2):
    """The error of a call that all ranks refuse."""
    said = ended_well(ranks(count, f"""
try:
    {call}
except ValueError as error:
    print(f"{{type(error).__name__}} {{error}}\\n", end="")
""")).splitlines()
    assert len(said) == count and all(line.startswith("InvalidArgument ") for line in said), said
    return said[0]


@pytest.mark.parametrize("option, words", [
    ("partition=['hilbert', 'rsb'][comm.rank]", "partition is 'rsb', and on rank 0 'hilbert'"),
    ("method=['rcm', 'bfs'][comm.rank]", "method is 'bfs', and on rank 0 'rcm'"),
    ("balance=['vertices', 'cells'][comm.rank]", "balance is 'cells'"),
    ("interface_last=comm.rank == 1", "interface_last is 'true'"),
    ("seed=comm.rank", "seed is '1'"),
    ("parts=2 + comm.rank", "parts is '3'"),
])
def test_options_that_differ_are_an_error_on_all_ranks(option, words):
    said = refused(f"meshorder.mpi.order_parts(comm, own, triangles, places, {option})")
    assert said.startswith("InvalidArgument rank 1: options: ") and words in said


@pytest.mark.parametrize("call, words", [
    ("order_ranks(comm, own, triangles.T)", "vertices each: is the array transposed? A row for each cell is expected"),
    ("order_parts(comm, own, triangles.T, places)", "is the array transposed?"),
    ("order_ranks(comm, triangles, own)", "vertex_count: expected a whole number, not an array of the shape ("),
    ("order_ranks(comm.py2f(), own, triangles)", "communicator: expected one of mpi4py (comm.py2f() is for C), not int"),
    ("order_ranks(None, own, triangles)", "communicator: expected one of mpi4py (comm.py2f() is for C), not NoneType"),
    ("order_ranks(type('Comm', (), {'tompi4py': None})(), own, triangles)", "with .tompi4py()), not Comm"),
    ("order_parts(comm, own, triangles, places, partition='order')", "the partitions ptscotch, hilbert and rsb order each part"),
])
def test_mistakes_are_reported_in_a_line(call, words):
    assert words in refused(f"meshorder.mpi.{call}")


def test_more_parts_than_vertices_are_refused_before_their_table_is_allocated():
    said = refused("""
    import resource
    resource.setrlimit(resource.RLIMIT_AS, (12 << 30, 12 << 30))  # the table would take 16 GiB
    meshorder.mpi.order_parts(comm, own, triangles, places, parts=2**31 - 1)""")
    assert "too few for 2147483647 parts" in said


def test_the_example_of_the_manual_moves_vertices_and_elements():
    """The new elements join the same places as the old ones."""
    page = (ROOT / "docs" / "scale.md").read_text()
    example, = (block for block in page.split("```\n") if "meshorder.mpi.order_ranks(" in block)
    ended_well(ranks(2, f"""
own_vertices, tetrahedra, coordinates = own, triangles.copy(), places.copy()
def joined(elements, points):
    everywhere = numpy.concatenate(comm.allgather(points))
    return sorted(sorted(map(tuple, everywhere[element].tolist())) for element in elements)
before = joined(tetrahedra, coordinates)
{example}
assert (tetrahedra != triangles).any() and joined(tetrahedra, coordinates) == before
"""))


def test_a_missing_library_is_reported():
    done = ranks(1, """
try:
    meshorder.mpi.order_ranks(comm, own, triangles)
except RuntimeError as error:
    print(type(error).__name__, error)
""", MESHORDER_MPI_LIBRARY="libnowhere.so")
    assert ended_well(done).startswith("Unavailable libnowhere.so was not found")
