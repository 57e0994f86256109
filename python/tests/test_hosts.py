# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Meshes as tuples of arrays, of trimesh and of scikit-fem, checked by computations of these libraries; and bad input."""

import copy
import subprocess
import sys

import meshio
import meshorder
import numpy as np
import pytest
from conftest import tetrahedra
from meshorder import InvalidArgument


def flat(cells):
    """The cells as a list of tuples."""
    if isinstance(cells, dict):
        return [tuple(row) for rows in cells.values() for row in rows]
    if isinstance(cells, tuple):
        return [tuple(row) for row in np.split(cells[1], cells[0][1:-1])]
    if isinstance(cells, list):
        return [tuple(row) for _, rows in cells for row in rows]
    return [tuple(row) for row in cells]


def forms():
    points, cells = tetrahedra(4)
    n, half = len(cells), len(cells) // 2
    lines = cells[:30, :2].copy()
    return points, {
        "table": (cells, np.arange(n)),
        "dict": ({"line": lines, "tetra": cells}, {"line": np.arange(30), "tetra": np.arange(30, n + 30)}),
        "blocks": (
            [("tetra", cells[:half].copy()), ("line", lines), ("tetra", cells[half:].copy())],
            [np.arange(half), np.arange(half, half + 30), np.arange(half + 30, n + 30)],
        ),
        "offsets": (
            (
                np.concatenate([np.arange(0, 4 * n + 1, 4), 4 * n + np.arange(2, 61, 2)]),
                np.concatenate([cells.ravel(), lines.ravel()]),
                np.repeat([10, 3], [n, 30]).astype(np.uint8),
            ),
            np.arange(n + 30),
        ),
    }


@pytest.mark.parametrize("inplace", [False, True])
@pytest.mark.parametrize("form", ["table", "dict", "blocks", "offsets"])
def test_arrays_move_in_every_form(form, inplace):
    points, all_forms = forms()
    cells, numbers = all_forms[form]
    before, old_cells = points.copy(), flat(cells)
    given = (points, cells, {"x": points[:, 0].copy()}, {"number": numbers})
    moved, order = meshorder.reorder(given, vertices="rcm", inplace=inplace)
    assert (moved is given) == inplace
    new_points, new_cells, point_data, cell_data = moved
    assert type(new_cells) is type(cells)
    np.testing.assert_array_equal(new_points, before[order.vertices.new_to_old])
    np.testing.assert_array_equal(point_data["x"], new_points[:, 0])
    expected = [tuple(order.vertices.old_to_new[list(old_cells[old])]) for old in order.cells.new_to_old]
    assert flat(new_cells) == expected
    found = cell_data["number"]
    if form in ("dict", "blocks"):
        found = np.concatenate(list(found.values()) if form == "dict" else found)
    np.testing.assert_array_equal(found, order.cells.new_to_old)
    if not inplace:
        np.testing.assert_array_equal(points, before)
        assert flat(cells) == old_cells


def test_arrays_alone_give_as_many_back(mesh):
    points, cells = mesh
    moved, order = meshorder.reorder((points, cells))
    assert len(moved) == 2
    expected = meshorder.order_mesh(points, cells)
    assert order.vertices.permutation == expected.vertices.permutation
    assert meshorder.order_mesh((points, cells)).cells.permutation == expected.cells.permutation
    assert meshorder.order((points, cells)).permutation == expected.vertices.permutation
    both = meshorder.make_mesh(points, cells), (points, cells)
    ours, theirs = (meshorder.compare(m, ["rcm"]) for m in both)
    assert [candidate.spans for candidate in ours] == [candidate.spans for candidate in theirs]
    grouped, _ = meshorder.reorder((points, cells, {}, {"part": np.arange(len(cells)) % 2}), group_by="part")
    assert (np.diff(grouped[3]["part"]) >= 0).all()


def test_polygons_of_any_size_move():
    random = np.random.default_rng(1)
    rows = [random.permutation(50)[: random.integers(3, 8)] for _ in range(40)]
    offsets = np.cumsum([0, *map(len, rows)])
    points = random.random((50, 2)).astype(np.float32)
    (moved_points, cells), order = meshorder.reorder((points, (offsets, np.concatenate(rows), np.full(40, 7))))
    assert flat(cells[:2]) == [tuple(order.vertices.old_to_new[rows[old]]) for old in order.cells.new_to_old]
    assert moved_points.dtype == np.float32


def test_inplace_refuses_what_it_cannot_write_to():
    points, cells = tetrahedra(2)
    read_only = points.copy()
    read_only.flags.writeable = False
    before = cells.copy()
    for wrong in ((read_only, cells), (points, cells.tolist()), (points, cells, {"x": list(points[:, 0])})):
        with pytest.raises(InvalidArgument, match="inplace"):
            meshorder.reorder(wrong, inplace=True)
    np.testing.assert_array_equal(cells, before)


def test_hosts_are_not_imported():
    program = (
        "import sys, numpy as np, meshorder; meshorder.reorder((np.eye(4, 3), [[0, 1, 2, 3]]));"
        "print({'meshio', 'pyvista', 'vtkmodules', 'skfem', 'trimesh', 'gmsh'} & sys.modules.keys())"
    )
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert ended.stdout.strip() == "set()"


# meshio


def test_periodic_points_and_sets_of_meshio_move():
    points, cells = tetrahedra(3)
    left, right = (np.flatnonzero(points[:, 0] == x) for x in (0, 1))
    left, right = (side[np.lexsort(points[side, 1:].T)] for side in (left, right))
    given = meshio.Mesh(points, [("tetra", cells)], gmsh_periodic=[[2, (1, 2), None, np.stack([left, right], axis=1)]])
    moved, _ = meshorder.reorder(given)
    pairs = moved.gmsh_periodic[0][3]
    np.testing.assert_allclose(moved.points[pairs[:, 0]] + [1, 0, 0], moved.points[pairs[:, 1]])


@pytest.mark.parametrize("name", ["material", "sets"])
def test_groups_of_meshio_stay_together(name):
    points, cells = tetrahedra(3)
    materials = np.arange(len(cells)) % 3
    given = meshio.Mesh(
        points, [("tetra", cells)], cell_data={"material": [materials]},
        cell_sets={f"{k}": [np.flatnonzero(materials == k)] for k in range(3)},
    )  # fmt: skip
    moved, _ = meshorder.reorder(given, group_by=name)
    assert (np.diff(moved.cell_data["material"][0]) >= 0).all()
    np.testing.assert_array_equal(np.sort(moved.cell_sets["1"][0]), np.flatnonzero(moved.cell_data["material"][0] == 1))


# trimesh


def solid(**options):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.icosphere(subdivisions=2)
    random = np.random.default_rng(2)
    made = trimesh.Trimesh(
        mesh.vertices, mesh.faces, process=False, vertex_attributes={"x": mesh.vertices[:, 0]},
        face_attributes={"material": random.integers(3, size=len(mesh.faces))}, metadata={"name": "ball"}, **options,
    )  # fmt: skip
    return made


@pytest.mark.parametrize("inplace", [False, True])
@pytest.mark.parametrize("colours", ["face", "vertex", "texture", None])
def test_trimesh_keeps_its_geometry_and_data(colours, inplace):
    random = np.random.default_rng(3)
    options = {}
    if colours == "face":
        options["face_colors"] = random.integers(255, size=(320, 4), dtype=np.uint8)
    elif colours == "vertex":
        options["vertex_colors"] = random.integers(255, size=(162, 4), dtype=np.uint8)
    elif colours == "texture":
        trimesh = pytest.importorskip("trimesh")
        options["visual"] = trimesh.visual.TextureVisuals(uv=random.random((162, 2)), face_materials=np.arange(320) % 2)
    normals = random.random((162, 3))
    given, before = (solid(**copy.deepcopy(options)) for _ in range(2))
    given.vertex_normals = before.vertex_normals = normals / np.linalg.norm(normals, axis=1)[:, None]
    moved, order = meshorder.reorder(given, vertices="rcm", inplace=inplace)
    assert (moved is given) == inplace
    vertices, faces = order.vertices.new_to_old, order.cells.new_to_old
    np.testing.assert_array_equal(moved.vertices, before.vertices[vertices])
    np.testing.assert_array_equal(vertices[moved.faces], before.faces[faces])
    np.testing.assert_allclose(moved.face_normals, before.face_normals[faces])
    np.testing.assert_allclose(moved.vertex_normals, before.vertex_normals[vertices])
    np.testing.assert_allclose((moved.volume, moved.area), (before.volume, before.area))
    assert moved.is_watertight and moved.metadata["name"] == "ball"
    np.testing.assert_array_equal(moved.vertex_attributes["x"], moved.vertices[:, 0])
    np.testing.assert_array_equal(moved.face_attributes["material"], before.face_attributes["material"][faces])
    if colours == "face":
        np.testing.assert_array_equal(moved.visual.face_colors, before.visual.face_colors[faces])
    elif colours == "vertex":
        np.testing.assert_array_equal(moved.visual.vertex_colors, before.visual.vertex_colors[vertices])
    elif colours == "texture":
        np.testing.assert_array_equal(moved.visual.uv, before.visual.uv[vertices])
        np.testing.assert_array_equal(moved.visual.face_materials, before.visual.face_materials[faces])
    if not inplace:
        np.testing.assert_array_equal(given.faces, before.faces)
        np.testing.assert_array_equal(given.face_attributes["material"], before.face_attributes["material"])
        if colours == "texture":
            np.testing.assert_array_equal(given.visual.face_materials, before.visual.face_materials)


def test_groups_of_trimesh_stay_together():
    moved, _ = meshorder.reorder(solid(), group_by="material")
    assert (np.diff(moved.face_attributes["material"]) >= 0).all()
    assert len(meshorder.compare(moved, ["rcm"])) == 2


def test_empty_surface_of_trimesh():
    trimesh = pytest.importorskip("trimesh")
    moved, order = meshorder.reorder(trimesh.Trimesh())
    assert isinstance(moved, trimesh.Trimesh) and len(order.cells.permutation) == 0
    with pytest.raises(InvalidArgument):
        meshorder.reorder(trimesh.PointCloud(np.eye(3)))
    with pytest.raises(InvalidArgument):
        meshorder.reorder(trimesh.Scene(solid()))
    listed = solid()
    listed.face_attributes.update({"name": ["a"] * 320, "other": [[1], [2, 3]], "one": 3})
    with pytest.raises(InvalidArgument, match="'name' must be an array"):
        meshorder.reorder(listed)
    del listed.face_attributes["name"]
    assert meshorder.reorder(listed)[0].face_attributes["other"] == [[1], [2, 3]]


# scikit-fem


def skfem_meshes():
    skfem = pytest.importorskip("skfem")
    made = {
        "MeshLine": skfem.MeshLine().refined(4), "MeshTri": skfem.MeshTri().refined(3),
        "MeshQuad": skfem.MeshQuad().refined(3), "MeshTet": skfem.MeshTet().refined(2),
        "MeshHex": skfem.MeshHex().refined(2), "MeshWedge1": skfem.MeshWedge1(),
        "MeshTri2": skfem.MeshTri2.init_circle(2), "MeshQuad2": skfem.MeshQuad2().refined(2),
        "MeshTet2": skfem.MeshTet2.init_ball(1), "MeshHex2": skfem.MeshHex2().refined(1),
    }  # fmt: skip
    return skfem, made


@pytest.mark.parametrize(
    "name",
    ["MeshLine", "MeshTri", "MeshQuad", "MeshTet", "MeshHex", "MeshWedge1", "MeshTri2", "MeshQuad2", "MeshTet2",
     "MeshHex2"],
)  # fmt: skip
def test_scikit_fem_assembles_the_same(name):
    skfem, made = skfem_meshes()
    from skfem.models.poisson import laplace, unit_load

    mesh = made[name]
    middle = int(mesh.nelements // 2)
    mesh = mesh.with_subdomains({"half": np.arange(middle, dtype=np.int32)})
    if name != "MeshWedge1":
        mesh = mesh.with_boundaries({"low": lambda x: x[0] < 0.3})
        if name != "MeshLine":
            mesh = mesh.with_boundaries({"around": mesh.facets_around(np.arange(middle))})
    moved, order = meshorder.reorder(mesh, vertices="rcm", elements="lexmax")
    assert type(moved) is type(mesh) and moved.is_valid() == mesh.is_valid()
    vertices, cells = order.vertices.new_to_old, order.cells.new_to_old
    corners = len(vertices)
    np.testing.assert_array_equal(moved.p[:, :corners], mesh.p[:, vertices])
    expected = order.vertices.old_to_new[mesh.t[:, cells]]
    np.testing.assert_array_equal(np.sort(moved.t, axis=0), np.sort(expected, axis=0))

    both = [skfem.Basis(m, m.elem()) for m in (mesh, moved)]
    matrices, loads = ([form.assemble(basis) for basis in both] for form in (laplace, unit_load))
    places = [np.lexsort(np.round(basis.doflocs, 9)) for basis in both]
    ordered = [m[p][:, p].toarray() for m, p in zip(matrices, places)]
    np.testing.assert_allclose(ordered[1], ordered[0], atol=1e-10)
    np.testing.assert_allclose(loads[1][places[1]], loads[0][places[0]], atol=1e-12)

    np.testing.assert_array_equal(np.sort(cells[moved.subdomains["half"]]), np.arange(middle))
    for boundary in mesh.boundaries or {}:
        old, new = mesh.boundaries[boundary], moved.boundaries[boundary]
        centres = [m.p[:, m.facets[:, f]].mean(axis=1) for m, f in ((mesh, np.asarray(old)), (moved, np.asarray(new)))]
        np.testing.assert_allclose(centres[1], centres[0])
        if hasattr(old, "ori"):
            sides = [m.f2t[f.ori, np.asarray(f)] for m, f in ((mesh, old), (moved, new))]
            np.testing.assert_array_equal(cells[sides[1]], sides[0])


@pytest.mark.parametrize("name", ["MeshTri", "MeshQuad", "MeshTet", "MeshHex", "MeshWedge1"])
def test_cells_of_scikit_fem_are_those_that_it_exports(name):
    _, made = skfem_meshes()
    from skfem.io.meshio import to_meshio

    exported = meshorder.make_mesh(to_meshio(made[name]))
    np.testing.assert_array_equal(meshorder.make_mesh(made[name]).connectivity, exported.connectivity)


def test_refusals_of_scikit_fem():
    skfem, made = skfem_meshes()
    with pytest.raises(InvalidArgument, match="inplace"):
        meshorder.reorder(made["MeshTri"], inplace=True)
    with pytest.raises(InvalidArgument, match="discontinuous"):
        meshorder.reorder(skfem.MeshTri1DG.from_mesh(made["MeshTri"]))
    with pytest.raises(InvalidArgument):
        meshorder.reorder(skfem.ElementTriP1())
    grouped, order = meshorder.reorder(made["MeshTri"].with_subdomains({"a": np.arange(0, 128, 2)}), group_by="sets")
    assert len(np.unique(np.diff(np.sort(grouped.subdomains["a"])))) == 1
    assert len(meshorder.compare(made["MeshHex"], ["rcm"])) == 2


# bad input


@pytest.mark.parametrize(
    "wrong",
    [
        None, 3, "mesh.msh", b"mesh", [], (), {}, object(), (np.eye(3),), [np.eye(4, 3), [[0, 1, 2, 3]]],
        (np.eye(4, 3), [[0, 1, 2, 9]]), (np.eye(4, 3), [[0, 1, 2, 3], [0, 1]]), (np.eye(4, 3), {"tetra": [[0, 1, 2]]}),
        (np.eye(4, 3), {"blob": [[0, 1]]}), (np.eye(4, 3), {"tetra": [[0, 1, 2, 3], [0, 1]]}), (np.eye(4, 3), 5),
        (np.eye(4, 3), "tetra"), (np.eye(4, 3), None), (np.eye(4, 3), [[0.5, 1, 2, 3]]),
        (np.eye(4, 3), ([0, 4], [0, 1, 2])),
        (np.full((4, 3), np.nan), [[0, 1, 2, 3]]), (np.eye(4), [[0, 1, 2, 3]]), (np.eye(4, 3) * 1j, [[0, 1, 2, 3]]),
        (np.eye(4, 3), [[0, 1, 2, 3]], [1]), (np.eye(4, 3), [[0, 1, 2, 3]], {"x": [1, 2]}),
        (np.eye(4, 3), [[0, 1, 2, 3]], {}, {"x": [1, 2]}), (np.eye(4, 3), [[0, 1, 2, 3]], {}, {"x": 3}),
        (np.eye(4, 3), {"tetra": [[0, 1, 2, 3]]}, {}, {"x": {"line": [1]}}), ([[0, 0], [0]], [[0, 1]]),
        (np.eye(4, 3), [("tetra", [[0, 1, 2, 3]])], {}, {"x": [[1], [2]]}), meshio.Mesh,
        meshio.CellBlock("line", [[0, 1]]),
        meshio.Mesh(np.eye(4, 3), [("polyhedron4", [[[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]])]),
        meshio.Mesh(np.full((4, 3), np.nan), [("tetra", [[0, 1, 2, 3]])]),
        meshio.Mesh(np.eye(4, 3), [("tetra", [[0, 1, 2, 4]])]),
        meshio.Mesh(np.eye(4, 3), [("tetra", [[0, 1, 2, 3]])], point_sets={"s": [7]}),
        meshio.Mesh(np.eye(4, 3), [("tetra", [[0, 1, 2, 3]])], point_sets={"s": [-(2**32)]}),
        meshio.Mesh(np.eye(4, 3), [("tetra", [[0, 1, 2, 3]])], cell_sets={"s": [[-1]]}),
        meshorder.Permutation.identity(3),
    ],
)  # fmt: skip
def test_refuses(wrong):
    with pytest.raises(ValueError) as caught:
        meshorder.reorder(wrong)
    assert type(caught.value) is InvalidArgument and str(caught.value)


@pytest.mark.parametrize("function", [meshorder.compare, meshorder.advise, meshorder.order_mesh, meshorder.make_mesh])
def test_other_functions_refuse_likewise(function):
    for wrong in (3, object(), (np.eye(4, 3), [[0, 1, 2, 9]]), meshio.CellBlock("line", [[0, 1]])):
        with pytest.raises(InvalidArgument):
            function(wrong)


def test_empty_meshes():
    for given in ((np.zeros((0, 3)), np.zeros((0, 4), dtype=int)), meshio.Mesh(np.zeros((0, 3)), [])):
        _, order = meshorder.reorder(given)
        assert len(order.vertices.permutation) == 0 and len(order.cells.permutation) == 0
