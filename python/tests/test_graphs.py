# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders, Fiedler vectors and quality against SciPy, networkx and NumPy."""

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
import typing

import meshorder
import networkx as nx
import numpy as np
import pytest
import scipy.sparse as sp
from conftest import lattice
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from meshorder import InvalidArgument, Stopped
from scipy.sparse.csgraph import reverse_cuthill_mckee as scipys_rcm


def bandwidth(a, p):
    moved = sp.coo_array(a[p][:, p])
    return int(np.abs(moved.row - moved.col).max(initial=0))


@pytest.mark.parametrize("method", [m.name for m in meshorder.methods() if not m.needs_points])
def test_every_method_gives_the_same_order_for_every_type(graph, method):
    expected = meshorder.order(graph, method).permutation
    for offsets in (np.int32, np.int64, np.uint32, np.uint64):
        for neighbours in (np.int32, np.int64):
            arrays = graph.indptr.astype(offsets), graph.indices.astype(neighbours)
            assert meshorder.order(arrays, method).permutation == expected
    assert meshorder.order(graph.tocoo(), method).permutation == expected
    assert meshorder.order(sp.csr_matrix(graph), method, threads=1).permutation == expected


@pytest.mark.parametrize("kind", ["bsr", "coo", "csc", "csr", "dia", "dok", "lil"])
@pytest.mark.parametrize("of", ["array", "matrix"])
def test_every_kind_of_sparse_matrix_gives_the_same_order(kind, of):
    graph = lattice(7, 6)
    given = getattr(sp, f"{kind}_{of}")(graph)
    order = meshorder.order(given, "rcm")
    assert order.permutation == meshorder.order(graph, "rcm").permutation
    np.testing.assert_array_equal(
        order.permutation.move(given).toarray(), graph.toarray()[order.new_to_old][:, order.new_to_old]
    )


def test_edges_go_by_the_larger_of_their_places(graph):
    edges = np.argwhere(sp.triu(graph, 1).toarray())
    vertices = meshorder.order(graph, "scrambled").permutation
    order = meshorder.order_edges(edges, vertices)
    moved = np.sort(vertices.renumber(order.move(edges)), axis=1)
    assert np.array_equal(moved, moved[np.lexsort(moved.T)])
    stay = meshorder.Permutation(old_to_new=np.arange(len(vertices)))
    assert meshorder.order_edges(vertices.renumber(edges), stay) == order, "of edges that are renumbered already"
    for wrong in (edges.ravel(), edges[:, :1], edges + 10**6, edges - 1.5):
        with pytest.raises(meshorder.InvalidArgument):
            meshorder.order_edges(wrong, vertices)


def test_arrays_at_odd_addresses_are_read(graph):
    matrix = sp.csr_array(graph)

    def odd(a):
        room = np.empty(a.nbytes + 1, dtype=np.uint8)[1:]
        room[:] = np.frombuffer(a.tobytes(), dtype=np.uint8)
        return room.view(a.dtype)

    assert not odd(matrix.indptr).flags.aligned
    order = meshorder.order((odd(matrix.indptr), odd(matrix.indices)), "rcm")
    assert order.permutation == meshorder.order(matrix, "rcm").permutation


def test_quality_is_that_of_the_moved_matrix(graph):
    order = meshorder.order(graph, "rcm")
    moved = sp.coo_array(order.permutation.move(graph))
    spans = np.abs(moved.row - moved.col)
    found = meshorder.quality(graph, order)
    assert found == meshorder.quality(moved.tocsr())
    assert found.bandwidth == spans.max() and found.edges == len(spans) // 2
    assert found.mean_span == pytest.approx(spans.mean())


def test_fiedler_vector_is_the_eigenvector():
    graph = lattice(12, 10, 7)
    found = meshorder.fiedler(graph)
    values, vectors = np.linalg.eigh(sp.csgraph.laplacian(graph.toarray()))
    assert found.lambda2 == pytest.approx(values[1]) and found.converged
    assert abs(vectors[:, 1] @ found.values) == pytest.approx(1, abs=1e-6)
    again = meshorder.fiedler(graph, start=found.values)
    assert again.components[0].iterations <= 1


def test_order_keeps_what_it_found(graph):
    order = meshorder.order(graph, "fiedler")
    assert order.method == "fiedler" and order.complete and order.fiedler[0].converged
    assert order.vector is not None
    np.testing.assert_array_equal(np.argsort(order.vector, kind="stable")[[0, -1]], order.new_to_old[[0, -1]])
    copy = pickle.loads(pickle.dumps(order))
    assert copy.permutation == order.permutation and "fiedler" in repr(copy)


def test_clean_input_is_not_copied():
    graph = lattice(40, 40, 40)
    arrays = graph.indptr.astype(np.int64), graph.indices.astype(np.int32)
    tracemalloc.start()
    order = meshorder.order(arrays, "rcm", symmetric=True)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert order.notes == []
    assert peak < arrays[1].nbytes / 10


def test_asymmetric_patterns():
    a = sp.csr_array(np.triu(np.ones((4, 4))))
    with pytest.raises(InvalidArgument, match="row 0 has the neighbour 1"):
        meshorder.order(a, "rcm", symmetric=True)
    assert meshorder.order(a, "rcm").permutation == meshorder.order(sp.csr_array(np.ones((4, 4))), "rcm").permutation


@pytest.mark.parametrize("sizes", [(9, 9, 9), (100, 3), (40, 30)])
def test_csgraph_is_about_as_good_as_scipys(sizes):
    graph = lattice(*sizes)
    found = meshorder.csgraph.reverse_cuthill_mckee(graph)
    assert found.dtype == np.int32 and sorted(found) == list(range(graph.shape[0]))
    # meshorder and SciPy break ties differently
    assert bandwidth(graph, found) <= 1.05 * bandwidth(graph, scipys_rcm(sp.csr_matrix(graph)))


def test_csgraph_on_scipys_own_example():
    # the example in the documentation of scipy.sparse.csgraph.reverse_cuthill_mckee
    graph = sp.csr_matrix([[0, 1, 2, 0], [0, 0, 0, 1], [2, 0, 0, 3], [0, 0, 0, 0]])
    found = meshorder.csgraph.reverse_cuthill_mckee(graph)
    both = graph + graph.T
    assert bandwidth(both, found) <= bandwidth(both, scipys_rcm(graph))


@given(st.integers(2, 25), st.integers(0, 40), st.integers(0, 1000))
@settings(deadline=None)
def test_networkx_functions_agree_with_networkx(n, extra, seed):
    graph = nx.path_graph(n)
    random = np.random.default_rng(seed)
    for a, b, weight in zip(random.integers(n, size=extra), random.integers(n, size=extra), random.random(extra)):
        if a != b:
            graph.add_edge(int(a), int(b), weight=0.5 + weight)
    laplacian = nx.laplacian_matrix(graph).toarray()
    eigenvalue = np.linalg.eigvalsh(laplacian)[1]
    assert meshorder.networkx.algebraic_connectivity(graph) == pytest.approx(eigenvalue, abs=1e-7)
    vector = meshorder.networkx.fiedler_vector(graph)
    assert np.linalg.norm(laplacian @ vector - eigenvalue * vector) < 1e-5
    assert sorted(meshorder.networkx.spectral_ordering(graph)) == list(graph)


def test_networkx_backend():
    graph = nx.barbell_graph(5, 6)
    with nx.config(cache_converted_graphs=False):
        theirs = nx.fiedler_vector(graph, seed=1, tol=1e-10)
        ours = nx.fiedler_vector(graph, tol=1e-10, backend="meshorder")
        assert nx.algebraic_connectivity(graph, backend="meshorder") == pytest.approx(nx.algebraic_connectivity(graph))
        order = nx.spectral_ordering(graph, backend="meshorder")
        normalized = nx.fiedler_vector(graph, normalized=True, seed=1)
    np.testing.assert_allclose(abs(ours @ theirs) / np.linalg.norm(theirs), 1, atol=1e-6)
    assert order == [node for _, node in sorted(zip(ours, graph))]
    assert len(normalized) == 16


def test_networkx_refusals():
    with pytest.raises(nx.NetworkXError):
        meshorder.networkx.fiedler_vector(nx.empty_graph(3))
    with pytest.raises(nx.NetworkXError):
        meshorder.networkx.fiedler_vector(nx.empty_graph(1))
    with pytest.raises(nx.NetworkXNotImplemented):
        meshorder.networkx.fiedler_vector(nx.DiGraph([(0, 1)]))
    assert meshorder.networkx.algebraic_connectivity(nx.empty_graph(3)) == 0
    out_of_reach = nx.grid_2d_graph(40, 40)  # its residual does not reach 1e-30
    for function in ("fiedler_vector", "algebraic_connectivity", "spectral_ordering"):
        with pytest.raises(nx.ExceededMaxIterations, match="did not reach the tolerance 1e-30 in 2000 iterations"):
            getattr(meshorder.networkx, function)(out_of_reach, tol=1e-30)


@pytest.mark.parametrize(
    "graph",
    [
        nx.Graph([(1, 2), (2, 3), (3, 4), (5, 3), (6, 2)]),  # networkx's issue 2381
        nx.random_regular_graph(5, 100, seed=1),  # networkx's issue 3418
        nx.complete_graph(9),  # λ₂ eight times over
        nx.star_graph(12),
    ],
)
def test_networkx_graphs_on_which_networkx_once_hung(graph):
    laplacian = nx.laplacian_matrix(graph).toarray()
    expected = np.linalg.eigvalsh(laplacian)[1]
    assert meshorder.networkx.algebraic_connectivity(graph) == pytest.approx(expected, rel=1e-7)
    vector = meshorder.networkx.fiedler_vector(graph)
    assert np.linalg.norm(laplacian @ vector - expected * vector) < 1e-6
    assert abs(vector.sum()) < 1e-7


def test_networkx_edges_are_taken_as_networkx_takes_them():
    parallel = nx.MultiGraph([(0, 1), (0, 1), (1, 2), (2, 3)])  # their weights are summed
    zero = nx.Graph([(0, 1), (1, 2), (2, 3), (3, 0)])
    zero[3][0]["weight"] = 0.0  # a weight of 0 means no edge
    signed = nx.Graph()
    signed.add_weighted_edges_from([("a", "b", -2.0), ("b", "c", 1.0), ("c", "a", 0.5), ("c", "c", 9.0)])
    opposite = nx.MultiGraph([(0, 1, {"weight": 1}), (0, 1, {"weight": -1}), (1, 2)])  # signs of weights are ignored
    for graph in (parallel, zero, signed, opposite):
        theirs = nx.algebraic_connectivity(graph)
        assert meshorder.networkx.algebraic_connectivity(graph) == pytest.approx(theirs, abs=1e-7)
    assert meshorder.networkx.algebraic_connectivity(zero, weight=None) == pytest.approx(2)


def test_a_bar_says_what_it_needs(graph, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(meshorder.Unavailable, match="needs the package tqdm"):
        meshorder.order(graph, "rcm", progress=True)


def test_progress_and_stop(graph):
    heard = []
    large = lattice(60, 60, 40)
    meshorder.order(large, "spectral", progress=lambda stage, fraction: heard.append((stage, fraction)))
    assert heard and all(isinstance(stage, str) for stage, _ in heard)
    assert [f for _, f in heard] == sorted(f for _, f in heard)
    for stop in (False, np.float64(1) < 0):
        with pytest.raises(Stopped):
            meshorder.order(large, "spectral", progress=lambda stage, fraction, answer=stop: answer)
    for go_on in (True, None, np.float64(1) > 0, 0):
        meshorder.order(large, "hilbert", points=np.zeros((144000, 3)), progress=lambda stage, fraction, answer=go_on: answer)
    with pytest.raises(ZeroDivisionError):
        meshorder.order(large, "spectral", progress=lambda stage, fraction: 1 / 0)


#: the start of programs that need a call without an end: no residual reaches its tolerance
ENDLESS = """
import threading, numpy as np, meshorder
n = 200_000
path = np.cumsum([0, 1, *[2] * (n - 2), 1]), np.delete(np.stack([np.arange(n) - 1, np.arange(n) + 1], 1).ravel(), [0, -1])
def solve(progress):
    meshorder.fiedler(path, tolerance=1e-300, max_iterations=2**31 - 1, progress=progress)
"""


def test_interrupt_ends_a_call_that_would_not_end():
    program = """
import os, signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # which processes in the background are without
began = threading.Event()
def interrupt():
    began.wait()
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
try:
    solve(lambda stage, part: began.set())
except KeyboardInterrupt:
    print("interrupted")
"""
    ended = subprocess.run([sys.executable, "-c", ENDLESS + program], capture_output=True, text=True, timeout=60)
    assert ended.stdout == "interrupted\n", ended.stderr


def test_processes_forked_during_a_call_may_call_and_end():
    program = """
import os
began, end = threading.Event(), threading.Event()
def report(stage, part):
    began.set()
    return not end.is_set()
def work():
    try:
        solve(report)
    except meshorder.Stopped:
        pass
thread = threading.Thread(target=work)
thread.start()
began.wait()
child = os.fork()
if child == 0:
    import sys
    meshorder.order(path, "rcm", threads=1)
    sys.exit(7)  # waits for this process's calls, of which there are none
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
end.set()
thread.join()
"""
    ended = subprocess.run([sys.executable, "-c", ENDLESS + program], capture_output=True, text=True, timeout=60)
    assert ended.stdout == "7\n", ended.stderr


def test_other_threads_go_on():
    large = lattice(60, 60, 60)
    turns, done = [], threading.Event()

    def count():
        while not done.is_set():
            turns.append(1)
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = len(turns)
    meshorder.order(large, "spectral")
    after = len(turns)
    done.set()
    thread.join()
    assert after - before > 20


def _order_in_child(arrays):
    return meshorder.order(arrays, "rcm", threads=1).permutation


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_processes_forked_after_use(graph):
    arrays = graph.indptr, graph.indices
    expected = meshorder.order(arrays, "rcm").permutation
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(_order_in_child, [arrays] * 4).get(timeout=60) == [expected] * 4


def test_interpreter_may_end_while_a_thread_works():
    program = """
import os, threading, numpy as np, meshorder
threading.excepthook = lambda raised: os.write(2, f"raised: {raised.exc_value}".encode())
n = 300_000
arrays = np.arange(0, 2 * n + 1, 2), np.stack([np.roll(np.arange(n), 1), np.roll(np.arange(n), -1)], 1).ravel()
@meshorder.register("own")
def own(graph, points): return np.arange(len(graph[0]) - 1)
threading.Thread(target=lambda: [meshorder.order(arrays, "fiedler", tolerance=1e-9) for _ in range(50)], daemon=True).start()
meshorder.order(arrays, "own")
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_another_interpreter_of_the_process_is_refused():
    program = """
import meshorder
try:
    import _interpreters as interpreters
except ImportError:
    import _xxsubinterpreters as interpreters
other = interpreters.create()
try:
    failed = interpreters.run_string(other, "import meshorder")  # returned, or raised before Python 3.13
except interpreters.RunFailedError as error:
    failed = error
interpreters.destroy(other)
assert "interpreter" in str(failed), failed
print(meshorder.order(([0, 1, 2], [1, 0]), "rcm").permutation.new_to_old)
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert ended.returncode == 0 and ended.stdout.startswith("["), ended.stderr


def test_methods_are_of_vertices_or_elements():
    assert "lexmax" in [method.name for method in meshorder.methods("elements")]
    with pytest.raises(InvalidArgument, match="'vertices' or 'elements', not 'faces'"):
        meshorder.methods("faces")


def test_methods_of_ones_own(graph):
    @meshorder.register("few-first", "vertices with few neighbours first")
    def few_first(given, points):
        assert points.shape == (0, 3)
        return np.argsort(np.diff(given[0]), kind="stable")

    try:
        assert "few-first" in [method.name for method in meshorder.methods()]
        order = meshorder.order(graph, "few-first")
        np.testing.assert_array_equal(order.new_to_old, np.argsort(np.diff(graph.indptr), kind="stable"))
        with pytest.raises(InvalidArgument):
            meshorder.register("few-first")(few_first)
        with pytest.raises(InvalidArgument, match="expected a function, not None"):
            meshorder.register("none")(typing.cast(typing.Any, None))
    finally:
        meshorder.unregister("few-first")
    with pytest.raises(InvalidArgument, match="unknown"):
        meshorder.order(graph, "few-first")

    @meshorder.register("wrong")
    def wrong(given, points):
        return [0, 0]

    try:
        with pytest.raises(InvalidArgument):
            meshorder.order(graph, "wrong")
    finally:
        meshorder.unregister("wrong")


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: meshorder.order("graph"),
        lambda: meshorder.order(sp.csr_array(np.ones((2, 3)))),
        lambda: meshorder.order(([0, 1], [5])),
        lambda: meshorder.order(([0, 2, 1], [1, 0])),
        lambda: meshorder.order(([0, 1.5], [0])),
        lambda: meshorder.order((np.ma.masked_array([0, 1], [False, True]), [0])),
        lambda: meshorder.order(([], [1])),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), "hilbert"),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), "hilbert", points=[[0, 0], [np.nan, 1]]),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), points=np.zeros((2, 4))),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), "no method"),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), "fiedler", weights=[-1, -1]),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), check="some"),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), workload="play"),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), threads=-1),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), seed=-1),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), time_limit=-1.0),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), time_limit="1"),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), tolerance=1j),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), threads=2**31),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), seed=2**64),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), seed=1.5),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), max_iterations=2**40),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), workload=3),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), check=True),
        lambda: meshorder.order(([0, 1, 2], [1, 0]), progress="bar"),
    ],
)
def test_refuses(wrong):
    with pytest.raises(ValueError) as caught:
        wrong()
    assert type(caught.value) is InvalidArgument


def test_unknown_options_are_type_errors():
    with pytest.raises(TypeError, match="colour"):
        meshorder.order(([0, 1, 2], [1, 0]), colour="red")


any_array = st.sampled_from(["i1", "u2", "i4", ">i4", "u4", "i8", "u8", "f8", "O", "U3", "?", "c8"]).flatmap(
    lambda dtype: hnp.arrays(dtype, hnp.array_shapes(min_dims=0, max_dims=2, min_side=0, max_side=6))
    if dtype != "O"
    else hnp.arrays(object, 3, elements=st.none() | st.integers(-2, 3))
)


@given(any_array, any_array, st.booleans())
@settings(deadline=None, max_examples=300)
def test_any_arrays_give_an_order_or_an_error(offsets, neighbours, strided):
    if strided and neighbours.ndim == 1:
        neighbours = np.repeat(neighbours, 2)[::2]
    for array in (offsets, neighbours):
        array.flags.writeable = False
    try:
        order = meshorder.order((offsets, neighbours), "rcm")
    except (ValueError, OverflowError) as error:
        assert isinstance(error, meshorder.Error)
        return
    # a pair of arrays of rank 2 is taken for points and cells
    assert len(order.permutation) == (len(offsets) if offsets.ndim == 2 else max(offsets.size - 1, 0))
