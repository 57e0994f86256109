# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders that are kept fresh: Delaunay meshes by SciPy whose points move, come and go."""
import threading

import meshorder
import numpy as np
import pytest
import scipy.sparse
from scipy.spatial import Delaunay


def mean_log2_span(triangles):
    a, b = triangles[:, [0, 1, 2]].ravel(), triangles[:, [1, 2, 0]].ravel()
    return np.log2(np.abs(a.astype(np.int64) - b)).mean()


def edges_by_place(points, triangles):
    """The edges by the coordinates of their ends, which no order changes."""
    pairs = np.concatenate([triangles[:, pair] for pair in ((0, 1), (1, 2), (2, 0))])
    ends = np.sort(points[pairs] @ [1.0, np.pi], axis=1)
    return np.unique(ends.round(12), axis=0)


@pytest.mark.parametrize("method", ["auto", "hilbert", "fiedler"])
def test_a_mesh_that_is_triangulated_anew_in_each_step_stays_in_order(method):
    random = np.random.default_rng(4)
    points = random.random((3000, 2))
    reorderer = meshorder.Reorderer(method)
    repairs = []
    for step in range(14):
        triangles = Delaunay(points).simplices
        before = edges_by_place(points, triangles)
        update = reorderer.update({"triangle": triangles}, points=points)
        points = update.permutation.move(points)
        triangles = update.permutation.renumber(triangles)
        assert np.array_equal(edges_by_place(points, triangles), before)
        order = meshorder.order_mesh(points, triangles, vertices=method).vertices.permutation
        assert mean_log2_span(triangles) < 1.1 * mean_log2_span(order.renumber(triangles))
        repairs.append(update.repair)
        points += random.normal(0, 0.0005, points.shape)
    assert repairs[0] == "fresh" and "none" in repairs


@pytest.mark.parametrize(("method", "repair"), [("rcm", "carried"), ("hilbert", "fresh")])
def test_points_that_come_and_go_are_put_next_to_their_neighbours(method, repair):
    random = np.random.default_rng(5)
    points = random.random((2000, 2))
    reorderer = meshorder.Reorderer(method, slack=1)
    update = reorderer.update({"triangle": Delaunay(points).simplices}, points=points)
    points = points[update.new_to_old]
    first = update.span_log2
    for _ in range(9):
        stay = np.flatnonzero(random.random(len(points)) > 0.02)
        points = np.concatenate([points[stay], random.random((40, 2))])
        previous = np.concatenate([stay, np.full(40, -1)])
        update = reorderer.update({"triangle": Delaunay(points).simplices}, points=points, previous=previous)
        assert update.repair == repair and update.added == 40
        points = points[update.new_to_old]
    assert update.span_log2 < 1.1 * first


def test_a_matrix_is_its_graph_and_particles_need_none():
    points = np.random.default_rng(6).random((1500, 3))
    pairs = np.stack([np.arange(1499), np.arange(1, 1500)])
    matrix = scipy.sparse.coo_array((np.ones(1499), pairs), shape=(1500, 1500)).tocsr()
    assert meshorder.Reorderer("rcm").update(matrix).old_to_new.shape == (1500,)
    update = meshorder.Reorderer().update(points=points)
    assert update.repair == "fresh" and update.span_log2 == 0
    empty = scipy.sparse.csr_array((1500, 1500))
    assert sorted(update.new_to_old) == list(range(1500)) and empty.nnz == 0


def test_a_state_goes_on():
    points = np.random.default_rng(7).random((800, 2))
    cells = {"triangle": Delaunay(points).simplices}
    one, two = meshorder.Reorderer("fiedler"), meshorder.Reorderer("fiedler")
    update = one.update(cells, points=points)
    points, cells["triangle"] = points[update.new_to_old], update.permutation.renumber(cells["triangle"])
    two.restore(one.state)
    for _ in range(12):
        assert np.array_equal(one.update(cells, points=points).old_to_new, two.update(cells, points=points).old_to_new)
    with pytest.raises(meshorder.InvalidArgument, match="cut off"):
        two.restore(one.state[:-3])
    with pytest.raises(meshorder.InvalidArgument, match="of the method 'fiedler', not 'rcm'"):
        meshorder.Reorderer("rcm").restore(one.state)


@pytest.mark.parametrize("call, error, words", [
    (lambda: meshorder.Reorderer("hilbrt"), meshorder.InvalidArgument, "did you mean 'hilbert'"),
    (lambda: meshorder.Reorderer(slack=-1), meshorder.InvalidArgument, "slack"),
    (lambda: meshorder.Reorderer(budget=-1), meshorder.InvalidArgument, "budget"),
    (lambda: meshorder.Reorderer(groups=[1]), TypeError, "groups"),
    (lambda: meshorder.Reorderer(colour=1), TypeError, "colour"),
    (lambda: meshorder.Reorderer().update(), meshorder.InvalidArgument, "expected a graph, cells or points"),
    (lambda: meshorder.Reorderer().update({"triangle": [[0, 1, 2]]}), meshorder.InvalidArgument, "vertex_count"),
    (lambda: meshorder.Reorderer().update(points=[[0.0, 1], [1, np.nan]]), meshorder.InvalidArgument, "not finite"),
    (lambda: meshorder.Reorderer().update(points=[[0.0, 1]], previous=[0]), meshorder.InvalidArgument,
     "no vertices before"),
    (lambda: meshorder.Reorderer().observe(-1), meshorder.InvalidArgument, "observe"),
])  # fmt: skip
def test_what_does_not_fit_is_refused(call, error, words):
    with pytest.raises(error, match=words):
        call()


def test_threads_take_turns():
    points = np.random.default_rng(8).random((5000, 2))
    reorderer = meshorder.Reorderer()
    failures = []

    def work():
        try:
            for _ in range(50):
                reorderer.update(points=points)
        except Exception as failure:  # noqa: BLE001
            failures.append(failure)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures
