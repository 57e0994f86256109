# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The paper's three objects: orders compared with an eigenvector that SciPy computes."""
import numpy
import pytest

import meshes

# the paper's counts (vertices, tetrahedra), sections 5.1 to 5.3
PAPER = {"dragon": (46736, 160553), "armadillo": (45908, 151869), "bunny": (34833, 120001)}


@pytest.mark.parametrize("name", PAPER)
def test_order_is_that_of_the_exact_eigenvector(command, model, name):
    path = model(name)
    points, cells = meshes.read_tetgen(path)
    for ours, paper in zip((len(points), len(cells)), PAPER[name]):
        assert abs(ours - paper) < 0.05 * paper
    matrix = meshes.adjacency(len(points), cells)
    lambda2, vector = meshes.exact_fiedler(matrix)
    exact = numpy.empty(len(points), dtype=int)
    exact[numpy.argsort(vector, kind="stable")] = numpy.arange(len(points))

    ordered = command.json("order", path, "-o", "ordered.vtu", "--vertices", "fiedler")
    component, = ordered["fiedler"]["components"]
    assert component["converged"] and component["size"] == len(points)
    assert component["lambda2"] == pytest.approx(lambda2, rel=0.02)
    assert component["residual"] <= 0.1 * component["lambda2"]
    assert ordered["edge_span"]["after"]["mean"] == pytest.approx(meshes.mean_span(matrix, exact), rel=0.02)
    assert command.json("info", "ordered.vtu")["edge_span"] == ordered["edge_span"]["after"]


def test_scrambled_span_is_a_third_of_the_vertices(command, model):
    path = model("dragon")
    command.ok("order", path, "-o", "scrambled.node", "--vertices", "scrambled", "--elements", "scrambled")
    info = command.json("info", "scrambled.node")
    assert info["edge_span"]["mean"] == pytest.approx(info["vertices"] / 3, rel=0.02)
    again = command.json("order", "scrambled.node", "-o", "ordered.node", "--vertices", "fiedler")
    assert again["edge_span"]["before"] == info["edge_span"]
    assert again["edge_span"]["after"]["mean"] < 0.02 * info["edge_span"]["mean"]
