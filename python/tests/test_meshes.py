# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Meshes as arrays, as files and as meshio's objects, checked by meshio."""

import gzip
import pathlib

import meshio
import meshorder
import networkx
import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from meshorder import InputError, InvalidArgument
from meshorder._meshes import _WIDTHS

#: meshes of Gmsh and TetGen
DATA = pathlib.Path(__file__).parents[2] / "tests" / "data"


def volumes(points, cells):
    a, b, c, d = (points[cells[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def test_all_forms_of_cells_give_the_same_order(mesh):
    points, cells = mesh
    expected = meshorder.order_mesh(points, cells)
    offsets = np.arange(0, cells.size + 1, 4)
    forms = [
        {"tetra": cells}, [("tetrahedron", cells)], [meshio.CellBlock("tetra", cells)], cells.astype(np.uint32).tolist(),
        (offsets, cells.ravel(), np.full(len(cells), 10)),
    ]  # fmt: skip
    for form in forms:
        found = meshorder.order_mesh(points, form)
        assert found.vertices.permutation == expected.vertices.permutation
        assert found.cells.permutation == expected.cells.permutation
    records = np.zeros(len(points), dtype=[("tag", "i1"), ("place", "f8", 3)])
    records["place"] = points
    for layout in (points.astype(np.float32), np.asfortranarray(points), np.pad(points, ((0, 0), (0, 1)))[:, :3],
                   records["place"]):  # fmt: skip
        found = meshorder.order_mesh(layout, cells, vertices="hilbert")
        assert len(found.vertices.permutation) == len(points)
    strided = meshorder.order_mesh(np.asfortranarray(points), cells, vertices="hilbert")
    assert strided.vertices.permutation == meshorder.order_mesh(points, cells, vertices="hilbert").vertices.permutation


def test_order_of_the_mesh_is_that_of_its_graph(mesh):
    points, cells = mesh
    n = len(points)
    pairs = np.unique(np.concatenate([cells[:, [i, j]] for i in range(4) for j in range(4) if i != j]), axis=0)
    offsets = np.searchsorted(pairs[:, 0], np.arange(n + 1))
    by_graph = meshorder.order((offsets, pairs[:, 1]), "fiedler").permutation
    assert meshorder.order_mesh(points, cells, vertices="fiedler").vertices.permutation == by_graph
    assert meshorder.order_mesh(None, cells, vertices="fiedler", vertex_count=n).vertices.permutation == by_graph


def labelled(mesh):
    points, cells = mesh
    random = np.random.default_rng(6)
    edges = cells[:50, :2]
    return meshio.Mesh(
        points.copy(),
        [("line", edges.copy()), ("tetra", cells[:1000].copy()), ("tetra", cells[1000:].copy())],
        point_data={"p": points.sum(axis=1), "u": random.random((len(points), 3))},
        cell_data={"centre": [points[c].mean(axis=1) for c in (edges, cells[:1000], cells[1000:])]},
        point_sets={"left": np.flatnonzero(points[:, 0] == 0)},
        cell_sets={"first": [np.arange(5), np.arange(7), None]},
    )


@pytest.mark.parametrize("inplace", [False, True])
def test_everything_of_a_meshio_mesh_moves_along(mesh, inplace):
    given, before = labelled(mesh), labelled(mesh)
    moved, order = meshorder.reorder(given, vertices="rcm", inplace=inplace)
    assert (moved is given) == inplace and isinstance(moved, meshio.Mesh)
    if not inplace:
        np.testing.assert_array_equal(given.points, before.points)
        np.testing.assert_array_equal(given.cells[1].data, before.cells[1].data)
    np.testing.assert_array_equal(moved.points, before.points[order.vertices.new_to_old])
    np.testing.assert_allclose(moved.point_data["p"], moved.points.sum(axis=1))
    assert (moved.points[moved.point_sets["left"]][:, 0] == 0).all() and len(moved.point_sets["left"]) == 81
    for block, old, centres in zip(moved.cells, before.cells, moved.cell_data["centre"]):
        assert block.type == old.type and len(block.data) == len(old.data)
        np.testing.assert_allclose(moved.points[block.data].mean(axis=1), centres)
    firsts = before.points[before.cells[1].data[:7]].mean(axis=1)
    found = moved.points[moved.cells[1].data[moved.cell_sets["first"][1]]].mean(axis=1)
    np.testing.assert_allclose(np.sort(found, axis=0), np.sort(firsts, axis=0))
    assert moved.cell_sets["first"][2] is None
    assert meshorder.order_mesh(moved.points, moved.cells, vertices="rcm") is not None
    graph = meshorder.make_mesh(moved.points, moved.cells).cells
    assert sum(len(rows) for _, rows in graph) == 50 + len(mesh[1])


@pytest.mark.parametrize("suffix, reads", [(".vtu", "vtu"), (".msh", "gmsh"), (".mesh", "medit")])
def test_files_are_what_meshio_reads(mesh, tmp_path, suffix, reads):
    points, cells = mesh
    ours = meshorder.make_mesh(points, cells)
    moved, order = meshorder.reorder(ours, vertices="rcm", format=reads)
    path = tmp_path / f"moved{suffix}"
    assert meshorder.write(moved, path) == []
    read = meshio.read(path)
    np.testing.assert_allclose(read.points, points[order.vertices.new_to_old])
    expected = order.vertices.old_to_new[cells][order.cells.new_to_old]
    np.testing.assert_array_equal(np.concatenate([block.data for block in read.cells]), expected)
    np.testing.assert_allclose(volumes(read.points, expected), volumes(points, cells)[order.cells.new_to_old])
    again = meshorder.read(meshorder.to_bytes(moved, reads))
    np.testing.assert_array_equal(again.connectivity, moved.connectivity)
    np.testing.assert_array_equal(ours.points, points)


@pytest.mark.skipif(not DATA.exists(), reason="needs tests/data")
@pytest.mark.parametrize("name", ["arch.msh", "ball.msh", "blocks.msh", "ring.node"])
def test_files_of_others(name):
    mesh = meshorder.read(DATA / name)
    moved, order = meshorder.reorder(mesh)
    assert len(mesh.points) == len(moved.points) and "vertices" in repr(mesh)
    np.testing.assert_array_equal(moved.points, mesh.points[order.vertices.new_to_old])
    for data in (moved.point_data, moved.cell_data):
        assert all(len(values) in (len(moved.points), len(moved.shapes)) for values in data.values())
    assert str(meshorder.advise(DATA / name))


def test_arrays_of_a_mesh_outlive_it(mesh):
    points = meshorder.make_mesh(*mesh).points
    np.testing.assert_array_equal(points, mesh[0])
    assert not points.flags.writeable


def test_arrays_of_a_mesh_stay_when_it_is_reordered_in_place(mesh):
    points, cells = mesh
    ours = meshorder.make_mesh((points, cells, {"x": points[:, 0]}))
    taken = ours.points, ours.connectivity, ours.offsets, ours.shapes, ours.point_data["x"]
    before = [array.copy() for array in taken]
    moved, order = meshorder.reorder(ours, vertices="rcm", elements="lexmax", inplace=True)
    assert moved is ours
    np.testing.assert_array_equal(ours.points, points[order.vertices.new_to_old])
    np.testing.assert_array_equal(ours.point_data["x"], ours.points[:, 0])
    for array, old in zip(taken, before):
        np.testing.assert_array_equal(array, old)


def test_comparison_and_advice(mesh):
    comparison = meshorder.compare(mesh, ["rcm", ("fiedler", "lexmax")])
    assert [candidate.vertices for candidate in comparison] == ["original", "rcm", "fiedler"]
    assert [candidate.vertices for candidate in meshorder.compare(mesh, "rcm")] == ["original", "rcm"]
    assert comparison[1].spans.mean_span < comparison[0].spans.mean_span and comparison[0].measured is None
    assert comparison._repr_html_().count("<tr>") == 4 and "rcm" in repr(comparison)
    measured = meshorder.compare(mesh, ["rcm"], measure=True, predict=False, budget=0)
    assert all(time > 0 for candidate in measured for time in candidate.milliseconds.values())
    assert all(candidate.measured and not candidate.predicted for candidate in measured)
    advice = meshorder.advise(mesh, machine="zen3")
    assert advice.machine == "zen3"
    tuned = meshorder.compare(mesh, ["rcm"], measure=True, kernels="tuned", budget=0)
    assert all(candidate.measured and not candidate.predicted for candidate in tuned)
    assert meshorder.advise(mesh, measure=True, kernels="tuned", budget=0).as_is.measured
    with pytest.raises(InvalidArgument, match="tuned kernels are not predicted"):
        meshorder.advise(mesh, measure=False, kernels="tuned")
    with pytest.raises(InvalidArgument, match="gpu_cost and gpu_product_cost count"):
        meshorder.advise(mesh, workload="gpu")
    with pytest.raises(InvalidArgument, match="known: plain, tuned"):
        meshorder.compare(mesh, kernels="fast")
    with pytest.raises(InvalidArgument, match="zen"):
        meshorder.compare(mesh, machine="zen9")
    assert str(advice) == advice.verdict and set(advice.kernels) == {"spmv", "element", "assembly", "springs"}


def test_advice_measures_what_runs_within_seconds(mesh, monkeypatch):
    def is_measured(given, **options):
        advice = meshorder.advise(given, **options)
        assert advice.as_is.predicted  # also beside measured times: it decides if they are not reliable
        return bool(advice.as_is.measured)

    monkeypatch.delenv("MESHORDER_MACHINE", raising=False)
    path = sp.eye(1_000_002, k=1, format="csr")  # two corners for each of its entries
    assert is_measured(mesh) and is_measured(path[:1000, :1000]) and not is_measured(path)
    assert not is_measured(mesh, measure=False) and not is_measured(mesh, machine="this")
    monkeypatch.setenv("MESHORDER_MACHINE", "zen3")
    assert not is_measured(mesh)


def test_a_matrix_is_judged_by_its_own_product(tmp_path):
    side = 60
    steps = [sp.eye(side), sp.eye(side, k=1)]
    matrix = (sp.kron(*steps) + sp.kron(*reversed(steps)) + sp.eye(side**2)).tocsr()
    scrambled = np.random.default_rng(1).permutation(side**2)
    matrix = matrix[scrambled][:, scrambled]
    scipy.io.mmwrite(tmp_path / "a.mtx", matrix, symmetry="general")
    given = [matrix, matrix.tocoo(), networkx.from_scipy_sparse_array(matrix + matrix.T), tmp_path / "a.mtx",
             meshorder.read(tmp_path / "a.mtx")]
    as_is, *_ = verdicts = [meshorder.advise(one, machine="zen3").as_is.milliseconds for one in given]
    assert list(as_is) == ["spmv"] and as_is["spmv"] > 0
    assert [one == as_is for one in verdicts] == [True, True, False, True, True]
    advice = meshorder.advise(matrix, measure=True, budget=0)
    assert list(advice.kernels) == ["spmv"] and ("product" in advice.verdict or advice.doubt) and advice._repr_html_()
    compared = meshorder.compare(matrix, ["rcm"], measure=True, predict=False, budget=0)
    assert list(compared.rows()[1])[-1] == "spmv ms" and "assembly" not in repr(compared)
    assert compared[1].spans.mean_span < compared[0].spans.mean_span and compared._repr_html_()
    for refused, words in (
        (sp.eye(5).tocsr(), "off the diagonal"),
        (sp.csr_array((3, 4)), "square"),
        ((matrix.indptr, matrix.indices), "cells"),
    ):
        with pytest.raises(InvalidArgument, match=words):
            meshorder.advise(refused)
    with pytest.raises(InvalidArgument, match="needs coordinates"):
        meshorder.compare(matrix, ["hilbert"])


def test_calibration(mesh, tmp_path, monkeypatch):
    monkeypatch.setenv("MESHORDER_CACHE", str(tmp_path))
    stages = []
    found = meshorder.calibrate(0.5, keep=False, progress=lambda stage, part: stages.append(stage))
    assert found.file is None and not list(tmp_path.iterdir()) and "caches" in stages
    assert found.machine.startswith("this machine, calibrated") and found.figures["caches"]
    kept = meshorder.calibrate(0.5)
    assert kept.file is not None and kept.file.is_file()
    assert meshorder.advise(mesh, machine="this").machine == kept.machine
    threads = found.figures["threads"]
    on_all = meshorder.advise(mesh, machine="this", all_threads=True, threads=threads)
    assert on_all.threads == threads and on_all.machine.startswith("this machine")
    assert len(meshorder.compare(mesh, "rcm", measure=True, predict=False, budget=0, all_threads=True)) == 2
    with pytest.raises(meshorder.InvalidArgument, match="those of one thread"):
        meshorder.advise(mesh, machine="zen3", all_threads=True, threads=2)
    with pytest.raises(InvalidArgument):
        meshorder.calibrate(0)


def test_bad_files(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        meshorder.read(tmp_path / "missing.msh")
    (tmp_path / "bad.obj").write_text("v 0 0 0\nf 1 2 3\n")
    with pytest.raises(InputError) as caught:
        meshorder.read(tmp_path / "bad.obj")
    assert caught.value.line == 2 and str(caught.value.file).endswith("bad.obj")
    assert isinstance(caught.value, ValueError)
    with pytest.raises(meshorder.Error):
        meshorder.read(b"nothing")


@pytest.mark.parametrize(
    "cells",
    [[[0, 1, 2, 9]], [[0, 1, 2, -1]], [[0, 1, 2, 3, 4]], {"tetra": [[0, 1, 2]]}, {"blob": [[0, 1]]}, [0, 1, 2, 3],
     ([0, 4], [0, 1, 2]), ([0, 4], [0, 1, 2, 3], [10, 10]), ([0, 4], [0, 1, 2, 3], [256 + 10]),
     ([0, 4], [0, 1, 2, 3], [10 - 256]), ([0, 4], [0, 1, 2, 3], [10.5]), [[0.5, 1, 2, 3]], [[0, 1], [0, 1, 2]]],
)  # fmt: skip
def test_refuses_faulty_cells(cells):
    with pytest.raises(InvalidArgument):
        meshorder.order_mesh(np.eye(4, 3), cells)


@pytest.mark.parametrize("width", [6, 8, 10])
def test_cells_of_second_order_in_the_plane_need_a_type(width):
    points = np.random.default_rng(7).random((width, 2))
    with pytest.raises(InvalidArgument, match="name it"):
        meshorder.make_mesh(points, [range(width)])
    kind = {6: "triangle", 8: "quad", 10: "triangle"}[width]
    assert meshorder.make_mesh(points, {f"{kind}{width}": [range(width)]}).cells[0][0] == kind


@pytest.mark.parametrize("shape", _WIDTHS)
def test_the_library_takes_each_number_of_vertices_that_a_name_means(shape):
    for width in _WIDTHS[shape]:
        points = np.random.default_rng(width).random((width, 3))
        assert len(meshorder.order_mesh(points, {shape: [range(width)]}).cells.permutation) == 1
    if shape != "line":  # only lines may have 23 vertices
        with pytest.raises(InvalidArgument, match="23 vertices"):
            meshorder.order_mesh(np.random.default_rng(7).random((23, 3)), {f"{shape}23": [range(23)]})


@pytest.mark.parametrize("cells", [[], (), {}, np.zeros((0, 4), int), ([0], [])])
def test_points_without_cells(cells):
    order = meshorder.order_mesh(np.random.default_rng(8).random((10, 3)), cells, vertices="hilbert")
    assert len(order.vertices.permutation) == 10 and len(order.cells.permutation) == 0


def test_refuses_faulty_points(mesh):
    with pytest.raises(InvalidArgument):
        meshorder.order_mesh(np.full((4, 3), np.nan), [[0, 1, 2, 3]], vertices="hilbert")
    with pytest.raises(InvalidArgument):
        meshorder.order_mesh(None, [[0, 1, 2, 3]])
    with pytest.raises(InvalidArgument):
        meshorder.reorder("mesh.msh")


@pytest.mark.parametrize("count", [-1, 4.5, "4", 2**80])
def test_refuses_faulty_counts(count):
    with pytest.raises(InvalidArgument, match="^vertex_count: "):
        meshorder.order_mesh(None, [[0, 1, 2, 3]], vertex_count=count)
    with pytest.raises(InvalidArgument, match="^memory_limit: "):
        meshorder.read(b"OFF 3 1 0  0 0 0  1 0 0  0 1 0  3 0 1 2", memory_limit=count)


def test_files_take_no_more_than_the_limit(tmp_path):
    text = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n" + b" " * (4 << 20)
    packed = gzip.compress(text)
    assert len(meshorder.read(packed, "off").shapes) == 1
    with pytest.raises(InputError, match="would take .* more than the limit of 1 MiB"):
        meshorder.read(packed, "off", memory_limit=1 << 20)
    (tmp_path / "mesh").mkdir()
    (tmp_path / "other.txt").write_text("# nothing\n")
    mesh = tmp_path / "mesh" / "a.veg"
    mesh.write_text("*VERTICES\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n*INCLUDE ../other.txt\n"
                    "*ELEMENTS\nTET\n1 4 0\n1 1 2 3 4\n")  # fmt: skip
    with pytest.raises(InputError, match="is not in the mesh's folder"):
        meshorder.read(mesh)
    for allowed in ([tmp_path], tmp_path, str(tmp_path)):
        assert len(meshorder.read(mesh, include_folders=allowed).shapes) == 1
    with pytest.raises(InputError, match="is not in the mesh's folder"):
        meshorder.read(mesh, include_folders="/usr")


def test_bytes_that_are_no_text_become_escapes():
    with pytest.raises(InputError, match=r"\\x8f"):
        meshorder.read(b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$\x8f\n", format="gmsh")
    mesh = meshorder.read(b"v 0 0 0\nv 1 0 0\nv 0 1 0\ng a\xff\nf 1 2 3\n", format="obj")
    assert list(mesh.sets) == [r"a\xff"]


def test_sets_of_vertices_and_of_cells_may_share_a_name():
    deck = (b"*NODE, NSET=a\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,0,0,2\n"
            b"*ELEMENT, TYPE=C3D4, ELSET=a\n1,1,2,3,4\n*ELSET, ELSET=b\n1\n")  # fmt: skip
    sets = meshorder.read(deck, "abaqus").sets
    assert {name: members.tolist() for name, members in sets.items()} == {
        "vertices:a": [0, 1, 2, 3, 4], "cells:a": [0], "b": [0],
    }  # fmt: skip
