# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The sets and other content that meshio's readers add to points, cells and data keep their meaning in a new order."""

import io

import gmsh
import meshio
import numpy as np
import pytest

import meshorder

ABAQUS = """*NODE
1,0,0,0
2,1,0,0
3,0,1,0
4,0,0,1
5,1,1,1
6,2,1,1
7,2,2,1
*ELEMENT,TYPE=C3D4,ELSET=BODY
1,1,2,3,4
2,2,3,4,5
3,5,6,7,4
*ELEMENT,TYPE=CPS3,ELSET=SKIN
11,1,2,3
12,5,6,7
13,2,3,5
*NSET,NSET=FIX
1,7
*ELSET,ELSET=A
2,11
*ELSET,ELSET=B
3,12,13
*ELSET,ELSET=BOTH
A,B
"""
FLAC3D = """* FLAC3D grid
G 1 0 0 0
G 2 1 0 0
G 3 0 1 0
G 4 0 0 1
G 5 1 1 1
G 6 2 1 1
G 7 2 2 1
G 8 3 1 0
F T3 1 1 2 3
F T3 2 5 6 7
F Q4 3 1 2 3 5
F Q4 4 2 3 4 6
Z T4 1 1 2 3 4
Z T4 2 2 3 4 5
Z P5 3 1 2 3 4 5
Z P5 4 5 6 7 8 1
FGROUP "Skin" SLOT 1
2 4
ZGROUP "Rock" SLOT 1
2 4
ZGROUP "Sand" SLOT 2
1 3
"""


def read(path, text, format):
    path.write_text(text)
    return meshio.read(path, file_format=format)


def box(folder):
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Verbosity", 0)
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(3, [1], name="body")
        gmsh.model.addPhysicalGroup(2, [1, 2, 3, 4, 5, 6], name="skin")
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(folder / "box.msh"))
    finally:
        gmsh.finalize()
    return meshio.read(folder / "box.msh")


def nastran(folder):
    given = meshio.Mesh(np.eye(5, 3), [("tetra", [[0, 1, 2, 3], [1, 2, 3, 4]]), ("triangle", [[0, 1, 2], [2, 3, 4]])])
    given.write(folder / "a.bdf")
    text = (folder / "a.bdf").read_text()
    return read(folder / "b.bdf", text.replace("GRID,5,", "GRID,50,"), "nastran")


MESHES = {
    "abaqus": lambda folder: read(folder / "a.inp", ABAQUS, "abaqus"),
    "flac3d": lambda folder: read(folder / "a.f3grid", FLAC3D, "flac3d"),
    "gmsh": box,
    "nastran": nastran,
}


def places(mesh, name, blocks, starts):
    """Returns the corners of a set's cells, sorted, and those of each set that it names."""
    if any(isinstance(part, list) for part in blocks):
        return [places(mesh, name, part, starts) for part in blocks]
    found = [
        mesh.points[block.data[np.asarray(members, dtype=int) - start]].reshape(len(members), block.data.shape[1] * mesh.points.shape[1])
        for block, members, start in zip(mesh.cells, blocks, starts)
        if members is not None
    ]
    return [rows[np.lexsort(rows.T)].tolist() for rows in found]


@pytest.mark.parametrize("name", MESHES)
def test_sets_hold_the_same_cells_after_reordering(tmp_path, name):
    given, before = MESHES[name](tmp_path), MESHES[name](tmp_path)
    moved, order = meshorder.reorder(given, vertices="scrambled", elements="scrambled")
    assert (order.vertices.new_to_old != np.arange(len(given.points))).any()

    sizes = [len(block.data) for block in given.cells]
    starts = np.cumsum([0, *sizes[:-1]]) if name == "flac3d" else [0] * len(sizes)
    assert list(moved.cell_sets) == list(before.cell_sets)
    for key, blocks in before.cell_sets.items():
        if key == "gmsh:bounding_entities":
            for old, new in zip(blocks, moved.cell_sets[key]):
                np.testing.assert_array_equal(old, new)
        else:
            assert places(moved, key, moved.cell_sets[key], starts) == places(before, key, blocks, starts), key
    for key, members in before.point_sets.items():
        corners = (mesh.points[np.sort(mesh.point_sets[key])] for mesh in (before, moved))
        old, new = (rows[np.lexsort(rows.T)] for rows in corners)
        np.testing.assert_array_equal(old, new)
    # make_mesh and advise read the sets, too
    assert meshorder.make_mesh(given).cells
    meshorder.advise(given, machine="zen3")


def test_gmsh_reads_what_meshio_writes_after_reordering(tmp_path):
    moved, _ = meshorder.reorder(box(tmp_path), vertices="scrambled")
    moved.write(tmp_path / "moved.msh", file_format="gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Verbosity", 0)
        gmsh.open(str(tmp_path / "moved.msh"))
        assert {gmsh.model.getPhysicalName(*group) for group in gmsh.model.getPhysicalGroups()} == {"body", "skin"}
        boundary = gmsh.model.getBoundary([(3, 1)], oriented=False)
        assert sorted(boundary) == [(2, tag) for tag in range(1, 7)]
    finally:
        gmsh.finalize()


def test_ids_of_nastran_go_with_their_points_and_cells(tmp_path):
    given = nastran(tmp_path)
    moved, order = meshorder.reorder(given, vertices="scrambled", elements="scrambled")
    np.testing.assert_array_equal(moved.points_id, given.points_id[order.vertices.new_to_old])
    old, new = (
        {int(i): corners.tolist() for block, ids in zip(mesh.cells, mesh.cells_id)
         for i, corners in zip(ids, mesh.points_id[block.data])}
        for mesh in (given, moved)
    )  # fmt: skip
    assert old == new


def test_more_arrays_than_blocks_are_refused():
    given = meshio.Mesh(np.eye(4, 3), [("tetra", [[0, 1, 2, 3]])], cell_sets={"s": [[0], [0]]})
    with pytest.raises(meshorder.InvalidArgument, match="set 's' has 2 arrays for 1 block"):
        meshorder.reorder(given)
