# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Matrices and meshes that several tests use."""

import os

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import settings

# the same examples in every run; HYPOTHESIS_PROFILE=default tries others
settings.register_profile("reproducible", derandomize=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "reproducible"))

# the same predictions on every machine
os.environ["MESHORDER_MACHINE"] = "zen3"


def lattice(*sizes):
    """The graph of a lattice, its vertices shuffled."""
    graph = sp.csr_array((1, 1))
    for size in sizes:
        path = sp.diags([np.ones(size - 1), np.ones(size - 1)], offsets=[-1, 1])
        graph = sp.kronsum(graph, path, format="csr")
    shuffled = np.random.default_rng(1).permutation(graph.shape[0])
    graph = sp.csr_array(graph)[shuffled][:, shuffled]
    graph.eliminate_zeros()
    graph.sort_indices()
    return graph


@pytest.fixture(scope="session")
def graph():
    return lattice(30, 20, 9)


def tetrahedra(n):
    """Points and cells of n³ cubes, each cut into six tetrahedra; both shuffled."""
    corner = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    cells = []
    for steps in ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)):
        at = np.zeros(3, dtype=int)
        vertices = [at.copy()]
        for axis in steps:
            at[axis] += 1
            vertices.append(at.copy())
        cells.append(
            np.stack([corner[i : i + n, j : j + n, k : k + n].ravel() for i, j, k in vertices], axis=1)
        )
    points = np.stack(np.meshgrid(*[np.linspace(0, 1, n + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    random = np.random.default_rng(2)
    places = random.permutation(len(points))
    cells = np.argsort(places)[np.concatenate(cells)]
    return points[places], random.permutation(cells)


@pytest.fixture(scope="session")
def mesh():
    return tetrahedra(8)


@pytest.fixture
def model():
    """Gmsh's model, empty."""
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield gmsh.model
    gmsh.finalize()
