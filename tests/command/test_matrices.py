# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Matrix Market's matrices and METIS's graphs, judged by SciPy."""
import numpy
import pytest
import scipy.io
import scipy.sparse


def grid(n, seed=1):
    """The Laplacian of a square grid whose points are in random order."""
    line = scipy.sparse.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n))
    matrix = (scipy.sparse.kron(line, scipy.sparse.eye(n)) + scipy.sparse.kron(scipy.sparse.eye(n), line)).tocsr()
    places = numpy.random.default_rng(seed).permutation(n * n)
    return matrix[places][:, places]


def bandwidth(matrix):
    coordinates = matrix.tocoo()
    return int(numpy.abs(coordinates.row - coordinates.col).max())


def moved(matrix, places):
    """P A P', where row i of A becomes row places[i]."""
    new_to_old = numpy.argsort(places)
    return matrix.tocsr()[new_to_old][:, new_to_old]


@pytest.mark.parametrize("field", ["real", "integer", "pattern", "complex"])
@pytest.mark.parametrize("symmetry", ["general", "symmetric"])
def test_the_permutation_is_applied_to_rows_and_columns(command, tmp_path, field, symmetry):
    matrix = grid(20)
    if field == "complex":
        matrix = matrix * (1 + 2j)
    if symmetry == "general":
        matrix = (matrix + scipy.sparse.coo_matrix(([3.0, 5.0], ([0, 7], [399, 70])), shape=matrix.shape)).tocsr()
    if field == "pattern":
        matrix.data[:] = 1
    scipy.io.mmwrite(tmp_path / "a.mtx", matrix.astype(int) if field == "integer" else matrix, comment="a grid",
                     field=field, symmetry=symmetry)
    done = command.ok("order", "a.mtx", "-o", "b.mtx", "--vertices", "rcm", "--maps", "m")
    assert ("A + A'" in done.stderr) == (symmetry == "general")
    places = numpy.load(tmp_path / "m.vertices.old_to_new.npy")
    before, after = scipy.io.mmread(tmp_path / "a.mtx"), scipy.io.mmread(tmp_path / "b.mtx")
    expected = moved(before, places)
    assert (abs(after.tocsr() - expected)).nnz == 0 and after.nnz == before.nnz
    assert scipy.io.mminfo(tmp_path / "b.mtx") == scipy.io.mminfo(tmp_path / "a.mtx")
    assert bandwidth(after) == bandwidth(expected)
    if symmetry == "symmetric":
        assert bandwidth(after) <= 30 < 200 < bandwidth(before)
    assert "a grid" in (tmp_path / "b.mtx").read_text()


def test_maps_hold_for_the_sequence_of_a_matrix_s_entries(command, tmp_path):
    scipy.io.mmwrite(tmp_path / "a.mtx", grid(20))
    lines = (tmp_path / "a.mtx").read_text().splitlines(keepends=True)
    (tmp_path / "b.mtx").write_text("".join([*lines[:3], *reversed(lines[3:])]))
    command.ok("order", "a.mtx", "-o", "c.mtx", "--maps", "m")
    assert "the same entries in another sequence count as another matrix" in command.fails("apply", "m", "b.mtx", "-o", "d.mtx")
    assert not (tmp_path / "d.mtx").exists()


def test_a_matrix_without_coordinates_is_not_ordered_by_them(command, tmp_path):
    scipy.io.mmwrite(tmp_path / "a.mtx", grid(20))
    result = command.json("order", "a.mtx", "-o", "b.mtx")
    assert result["vertices"]["method"] == "bfs" and result["vertices"]["count"] == 400


def test_a_matrix_can_be_looked_at(command, tmp_path):
    scipy.io.mmwrite(tmp_path / "a.mtx", grid(20))
    assert "400" in command.ok("info", "a.mtx").stdout


def test_a_rectangular_matrix_is_refused(command, tmp_path):
    scipy.io.mmwrite(tmp_path / "a.mtx", scipy.sparse.eye(4, 5))
    assert "the matrix has 4 rows and 5 columns; only a square" in command.fails("order", "a.mtx", "-o", "b.mtx")
    assert not (tmp_path / "b.mtx").exists()


def adjacency(path):
    """A graph file without weights, as a SciPy matrix."""
    header, *lists = path.read_text().splitlines()
    count, edges = map(int, header.split()[:2])
    assert len(lists) == count and sum(len(line.split()) for line in lists) == 2 * edges
    rows = [(v, int(u) - 1) for v, line in enumerate(lists) for u in line.split()]
    return scipy.sparse.csr_matrix((numpy.ones(2 * edges), zip(*rows)), shape=(count, count))


def test_a_graph_is_ordered(command, tmp_path):
    matrix = grid(20)
    matrix.setdiag(0)
    matrix.eliminate_zeros()
    matrix.sort_indices()
    rows = numpy.split(matrix.indices + 1, matrix.indptr[1:-1])
    (tmp_path / "a.graph").write_text(
        f"{matrix.shape[0]} {matrix.nnz // 2}\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows))
    command.ok("order", "a.graph", "-o", "b.graph", "--vertices", "rcm", "--maps", "m")
    places = numpy.load(tmp_path / "m.vertices.old_to_new.npy")
    before, after = adjacency(tmp_path / "a.graph"), adjacency(tmp_path / "b.graph")
    assert (after != moved(before, places)).nnz == 0 and bandwidth(after) <= 30
    command.ok("order", "a.graph", "-o", "c.mtx", "--vertices", "original")
    pattern = scipy.io.mmread(tmp_path / "c.mtx")
    assert (pattern.tocsr() != before).nnz == 0


def halves(symmetry):
    """Entries on and below the diagonal, in random order, of a matrix of that symmetry."""
    random = numpy.random.default_rng(5)
    rows, columns = numpy.tril_indices(12, -1 if symmetry == "skew-symmetric" else 0)
    chosen = random.permutation(len(rows))[:40]
    values = random.integers(1, 100, (40, 2))
    field = "complex" if symmetry == "hermitian" else "integer"
    lines = [
        f"{rows[k] + 1} {columns[k] + 1} {a}" + (f" {0 if rows[k] == columns[k] else b}" if field == "complex" else "")
        for k, (a, b) in zip(chosen, values)
    ]
    return f"%%MatrixMarket matrix coordinate {field} {symmetry}\n12 12 40\n" + "\n".join(lines) + "\n"


@pytest.mark.parametrize("method", ["scrambled", "rcm"])
@pytest.mark.parametrize("name, text", [
    *((f"{symmetry}.mtx", halves(symmetry)) for symmetry in ("symmetric", "skew-symmetric", "hermitian")),
    ("weighted.graph", "4 4 001\n2 5 4 1\n1 5 3 6\n2 6 4 7\n1 1 3 7\n"),
    ("both.graph", "4 4 011\n9 2 5 4 1\n8 1 5 3 6\n7 2 6 4 7\n6 1 1 3 7\n"),
])
def test_the_old_order_is_restored(command, tmp_path, name, text, method):
    (tmp_path / name).write_text(text)
    again, ordered = "again" + name, "ordered" + name
    command.ok("order", name, "-o", ordered, "--vertices", method, "--elements", "lexmax", "--maps", "m")
    command.ok("apply", "m", name, "-o", "applied" + name)
    assert (tmp_path / ("applied" + name)).read_bytes() == (tmp_path / ordered).read_bytes()
    command.ok("apply", "m", ordered, "-o", again, "--inverse")
    assert (tmp_path / again).read_bytes() == (tmp_path / name).read_bytes()
    assert "already in its old order" in command.fails("apply", "m", name, "-o", again, "--inverse")
    if name.endswith(".mtx"):
        places = numpy.load(tmp_path / "m.vertices.old_to_new.npy")
        before, after = (scipy.io.mmread(tmp_path / file).tocsr() for file in (name, ordered))
        assert abs(after - moved(before, places)).nnz == 0
        # the map of cells is that of the entries, in file order
        rows = [[line.split() for line in (tmp_path / file).read_text().splitlines()[2:]] for file in (name, ordered)]
        cells = numpy.load(tmp_path / "m.cells.new_to_old.npy")
        assert [row[2].lstrip("-") for row in rows[1]] == [rows[0][old][2].lstrip("-") for old in cells]
