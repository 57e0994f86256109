#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Draws the pictures of the pages docs/how/: how-fiedler.png, how-solver.png and how-cost.svg, beside this script.

    docs/pictures/draw_how.py MESH

MESH holds tetrahedra for how-cost.svg: the dragon that `meshorder models make dragon` makes.

Needs the packages meshorder, NumPy, SciPy and matplotlib. Everything drawn is computed here: the orders and vectors by
meshorder, reuse distances by counting.
"""

import pathlib
import sys

import matplotlib
import matplotlib.pyplot as pyplot
import meshorder
import numpy
import scipy.sparse
import scipy.sparse.linalg
import scipy.spatial

HERE = pathlib.Path(__file__).parent
LINE_BYTES = 64
BLUE, ORANGE, GREEN, GREY = "#3465a4", "#d9822b", "#3a923a", "#888888"

matplotlib.rcParams.update({
    "font.size": 9, "axes.titlesize": 9, "axes.spines.top": False, "axes.spines.right": False,
    "svg.hashsalt": "meshorder",
    "svg.fonttype": "path", "contour.negative_linestyle": "solid", "figure.dpi": 150, "savefig.facecolor": "white",
})  # fmt: skip


def horseshoe(spacing):
    """A bent strip of triangles, its vertices numbered at random."""
    random = numpy.random.default_rng(4)
    x, y = numpy.meshgrid(numpy.arange(-1.2, 1.2, spacing), numpy.arange(-1.2, 1.3, spacing * 0.866))
    x = x + (numpy.arange(len(y)) % 2)[:, None] * spacing / 2
    points = numpy.column_stack([x.ravel(), y.ravel()]) + random.normal(0, 0.12 * spacing, (x.size, 2))
    radius, angle = numpy.hypot(*points.T), numpy.arctan2(points[:, 0], points[:, 1])
    points = points[(radius < 1.05) & (radius > 0.55) & (numpy.abs(angle) > 0.45)]
    points = points[random.permutation(len(points))]
    triangles = scipy.spatial.Delaunay(points).simplices
    sides = numpy.linalg.norm(points[triangles] - points[numpy.roll(triangles, 1, axis=1)], axis=2)
    return points, triangles[sides.max(axis=1) < 2.5 * spacing]


def adjacency(cells, n):
    pairs = [(a, b) for a in range(cells.shape[1]) for b in range(cells.shape[1]) if a != b]
    rows = numpy.concatenate([cells[:, a] for a, _ in pairs])
    columns = numpy.concatenate([cells[:, b] for _, b in pairs])
    matrix = scipy.sparse.csr_matrix((numpy.ones(len(rows)), (rows, columns)), shape=(n, n))
    matrix.data[:] = 1
    return matrix


def bare(axes, title):
    axes.set_title(title)
    axes.set_aspect("equal")
    axes.set_axis_off()


def panels(mosaic, size):
    """A figure and its axes in their order, in rows so that a phone shows them large enough."""
    figure, axes = pyplot.subplot_mosaic(mosaic, figsize=size, layout="constrained")
    return figure, [axes[name] for name in sorted(axes)]


def spy(axes, matrix, title):
    axes.plot(matrix.indices, numpy.repeat(numpy.arange(matrix.shape[0]), numpy.diff(matrix.indptr)), ",", color=BLUE)
    axes.set(xlim=(0, matrix.shape[0]), ylim=(matrix.shape[0], 0), xticks=[], yticks=[], aspect="equal")
    axes.set_title(title)
    for side in axes.spines.values():
        side.set_visible(True)


def draw_fiedler():
    points, triangles = horseshoe(0.045)
    n = len(points)
    graph = adjacency(triangles, n)
    vector = meshorder.fiedler(graph).values
    order = meshorder.order(graph, "fiedler")
    moved = order.permutation.move(graph)
    figure, axes = panels([["0", "0", "1", "1", "2", "2"], [".", "3", "3", "4", "4", "."]], (7.5, 5.4))
    shown = dict(triangles=triangles, cmap="viridis", shading="gouraud")
    axes[0].tripcolor(*points.T, numpy.arange(n), **shown)
    bare(axes[0], "1. the numbers of a generator")
    axes[1].tripcolor(*points.T, vector, **shown)
    axes[1].tricontour(*points.T, triangles, vector, levels=15, colors="black", linewidths=0.5)
    bare(axes[1], "2. the Fiedler vector")
    axes[2].tripcolor(*points.T, order.old_to_new, **shown)
    axes[2].tricontour(*points.T, triangles, order.old_to_new, levels=15, colors="black", linewidths=0.5)
    bare(axes[2], "3. its ranks: the new numbers")
    spans = [meshorder.quality(graph), meshorder.quality(moved)]
    spy(axes[3], graph, f"before: mean span {spans[0].mean_span:.0f}")
    spy(axes[4], moved, f"after: mean span {spans[1].mean_span:.0f}")
    figure.savefig(HERE / "how-fiedler.png")


def aggregates(matrix):
    """Greedy aggregation: a vertex whose neighbours are all free founds an aggregate, the rest join a neighbour's."""
    group = numpy.full(matrix.shape[0], -1)
    count = 0
    rows = numpy.split(matrix.indices, matrix.indptr[1:-1])
    for v, row in enumerate(rows):
        if group[v] < 0 and (group[row] < 0).all():
            group[row] = group[v] = count
            count += 1
    founded = group.copy()
    for v in numpy.flatnonzero(founded < 0):
        group[v] = founded[rows[v]].max()
    return group, count


def second_eigenvector(weights, masses):
    laplacian = scipy.sparse.csgraph.laplacian(weights).toarray()
    return scipy.linalg.eigh(laplacian, numpy.diag(masses))[1][:, 1]


def draw_solver():
    points, triangles = horseshoe(0.045)
    weights = adjacency(triangles, len(points))
    figure, axes = panels([["0", "1", "2", "3"], [".", "4", "4", "."]], (7.5, 4.4))
    member = numpy.arange(len(points))  # which vertex of the level a vertex of the mesh belongs to
    masses = numpy.ones(len(points))
    reference = meshorder.fiedler(weights).values
    for level in range(4):
        values = second_eigenvector(weights, masses)[member]
        values *= numpy.sign(values @ reference)
        axes[level].tripcolor(*points.T, triangles, facecolors=values[triangles].mean(axis=1), cmap="viridis")
        bare(axes[level], f"{weights.shape[0]} vertices")
        group, count = aggregates(weights.tocsr())
        step = scipy.sparse.csr_matrix(
            (numpy.ones(len(group)), (numpy.arange(len(group)), group)), shape=(len(group), count)
        )
        weights = scipy.sparse.csr_matrix(step.T @ weights @ step)
        weights.setdiag(0)
        weights.eliminate_zeros()
        masses = step.T @ masses
        member = group[member]

    sides = (8, 12, 20, 32)
    ours, plain = [], []
    for side in sides:
        graph = lattice(side)
        ours.append(meshorder.fiedler(graph, tolerance=1e-3).components[0].iterations)
        plain.append(plain_iterations(graph, 1e-3))
        print(f"{graph.shape[0]} vertices: {ours[-1]} iterations, without the hierarchy {plain[-1]}")
    sizes = [side**3 for side in sides]
    axes[4].loglog(sizes, plain, "o-", color=GREY, label="without the hierarchy")
    axes[4].loglog(sizes, ours, "o-", color=BLUE, label="meshorder")
    axes[4].set(xlabel="vertices of a cubic lattice", title="iterations of LOBPCG to 0.001", ylim=(1, 500))
    axes[4].legend(frameon=False)
    figure.savefig(HERE / "how-solver.png")


def lattice(side):
    """The graph of a cubic lattice of side³ points."""
    path, points = (
        scipy.sparse.diags_array([1.0, 1.0], offsets=[-1, 1], shape=(side, side)),
        scipy.sparse.eye_array(side),
    )
    along = ((path, points, points), (points, path, points), (points, points, path))
    return scipy.sparse.csr_matrix(sum(scipy.sparse.kron(scipy.sparse.kron(a, b), c) for a, b, c in along))


def plain_iterations(graph, tolerance):
    """Iterations of SciPy's LOBPCG for λ₂ without a preconditioner, from a random start."""
    laplacian = scipy.sparse.csr_matrix(scipy.sparse.csgraph.laplacian(graph))
    n = laplacian.shape[0]
    start = numpy.random.default_rng(0).normal(size=(n, 2))
    ones = numpy.ones((n, 1))
    smallest = 2 - 2 * numpy.cos(numpy.pi / round(n ** (1 / 3)))
    options = dict(largest=False, maxiter=2000, tol=tolerance * smallest, retResidualNormsHistory=True)
    _, _, history = scipy.sparse.linalg.lobpcg(laplacian, start, Y=ones, **options)
    first = [norms[0] for norms in history]
    return next(k for k, norm in enumerate(first) if norm < tolerance * smallest)


def stack_distances(stream):
    """For each access, the number of other lines accessed since the last access to the same line; -1 for the first."""
    size = len(stream)
    tree = [0] * (size + 1)
    last = {}
    distances = numpy.empty(size, dtype=int)

    def add(place, by):
        while place <= size:
            tree[place] += by
            place += place & -place

    def count(place):
        total = 0
        while place:
            total += tree[place]
            place -= place & -place
        return total

    for time, line in enumerate(stream.tolist(), start=1):
        before = last.get(line)
        if before is None:
            distances[time - 1] = -1
        else:
            distances[time - 1] = count(time - 1) - count(before)
            add(before, -1)
        add(time, 1)
        last[line] = time
    return distances


def draw_cost(path):
    mesh = meshorder.read(path)
    figure, axes = pyplot.subplots(2, 1, figsize=(6, 5.6), layout="constrained")
    methods = (("scrambled", "scrambled", GREY), ("original", "original", ORANGE), ("fiedler", "lexmax", BLUE),
               ("hilbert", "lexmax", GREEN))  # fmt: skip
    for vertices, elements, colour in methods:
        moved, _ = meshorder.reorder(mesh, vertices=vertices, elements=elements)
        tetrahedra = numpy.concatenate([rows for shape, rows in moved.cells if shape == "tetrahedron"])
        # element forces gather the position of each corner, three numbers of eight bytes
        distances = stack_distances((tetrahedra.ravel().astype(numpy.int64) * 24) // LINE_BYTES)
        distances = distances[distances >= 0]
        bins = numpy.concatenate([[0], 2 ** numpy.arange(0, 16)])
        share, _ = numpy.histogram(distances, bins=[*bins, 1 << 30])
        axes[0].step(numpy.maximum(bins, 0.5), 100 * share / len(distances), where="post", color=colour, label=vertices)
        sizes = 2.0 ** numpy.arange(9, 22, 0.25)
        misses = [(distances >= size / LINE_BYTES).sum() / len(tetrahedra) for size in sizes]
        axes[1].plot(sizes, misses, color=colour, label=vertices)
        print(vertices, f"{misses[numpy.searchsorted(sizes, 48 * 1024)]:.2f} misses a tetrahedron with 48 KB")
    axes[0].set(
        xscale="log",
        xlabel="reuse distance, cache lines",
        ylabel="accesses, %",
        title="how far back the line was last used",
    )
    axes[1].set(xscale="log", xlabel="size of the cache", ylabel="misses for each tetrahedron",
                title="misses that follow",
                xticks=[2**10, 2**15, 2**20], xticklabels=["1 KB", "32 KB", "1 MB"])  # fmt: skip
    axes[1].minorticks_off()
    for name, size in (("L1", 48 << 10), ("L2", 1 << 20)):
        axes[1].axvline(size, color="black", linewidth=0.5, linestyle=":")
        axes[1].text(size * 1.05, 3.7, name)
    axes[0].legend(frameon=False)
    figure.savefig(HERE / "how-cost.svg", metadata={"Date": None})


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    draw_fiedler()
    draw_solver()
    draw_cost(sys.argv[1])


if __name__ == "__main__":
    main()
