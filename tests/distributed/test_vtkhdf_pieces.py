# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Pieces as the partitions of one VTKHDF file, compared with pieces in .vtu files. Other tests compare these with the mesh."""
import json
import os
import subprocess
import sys

import h5py
import numpy
import pytest
import test_vtkhdf_slices as vtkhdf
from test_mpi import DATA, launch, order, own_lines, serial
from test_pieces import Grid, with_texts_and_roles
from test_vtu_slices import array, grid, write

# by libhdf5 alone, without h5py
COUNTS = """
import sys
from vtk import vtkHDFReader
reader = vtkHDFReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
print(grid.GetNumberOfPoints(), grid.GetNumberOfCells(), grid.GetPointData().GetNumberOfArrays(),
      grid.GetCellData().GetNumberOfArrays(), grid.GetFieldData().GetNumberOfArrays())
"""


def partitions(path):
    """Points, cells as (type, points), arrays of both and the fields of each partition."""
    with h5py.File(path) as file:
        group = file["VTKHDF"]
        assert list(group.attrs["Version"]) == [1, 0] and group.attrs["Type"] == b"UnstructuredGrid"
        counts = [group[f"NumberOf{what}"][()] for what in ("Points", "Cells", "ConnectivityIds")]
        point, cell, entry = ([0, *numpy.cumsum(count)] for count in counts)
        assert len(group["Points"]) == point[-1] and len(group["Types"]) == cell[-1]
        assert len(group["Connectivity"]) == entry[-1] and len(group["Offsets"]) == cell[-1] + len(counts[0])
        found = []
        for p in range(len(counts[0])):
            offsets = group["Offsets"][cell[p] + p:cell[p + 1] + p + 1]
            assert offsets[0] == 0 and offsets[-1] == counts[2][p]
            entries = group["Connectivity"][entry[p]:entry[p + 1]]
            types = group["Types"][cell[p]:cell[p + 1]]
            found.append((group["Points"][point[p]:point[p + 1]],
                          [(int(kind), tuple(entries[a:b].tolist())) for kind, a, b in zip(types, offsets, offsets[1:])],
                          {name: values[point[p]:point[p + 1]] for name, values in group["PointData"].items()},
                          {name: values[cell[p]:cell[p + 1]] for name, values in group["CellData"].items()}))
        fields = {name: values[()].tolist() for name, values in group["FieldData"].items()}
        roles = {kind: dict(group[kind].attrs) for kind in ("PointData", "CellData")}
    return found, fields, roles


def assert_those_of(folder, name, path, without=()):
    """Asserts that the partitions are the pieces in a folder."""
    found, fields, roles = partitions(path)
    files = sorted(file for file in os.listdir(folder) if file.endswith(".vtu"))
    assert len(files) == len(found) and files[0].startswith(name)
    totals = numpy.zeros(2, int)
    for file, (points, cells, of_points, of_cells) in zip(files, found):
        piece = Grid(folder / file)
        totals += [len(points), len(cells)]
        assert numpy.array_equal(piece.points, points) and piece.cells == cells
        if len(points):
            assert piece.points.dtype == points.dtype
        for ours, theirs in ((of_points, piece.of_points), (of_cells, piece.of_cells)):
            if not theirs:
                continue  # VTK reads no arrays of empty pieces
            assert set(ours) == set(theirs) - set(without)
            for key, values in ours.items():
                assert numpy.array_equal(values, theirs[key]) and values.dtype == theirs[key].dtype, key
    assert roles["PointData"]["GlobalIds"] == b"GlobalPointIds" and roles["CellData"]["GlobalIds"] == b"GlobalCellIds"
    done = subprocess.run([sys.executable, "-c", COUNTS, path], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert done.stdout.split() == [str(n) for n in (*totals, len(found[0][2]), len(found[0][3]), len(fields))]
    return fields, roles


@pytest.mark.parametrize("source", ["a.vtu", "narrow.vtu", "b.vtu", "a.vtkhdf"])
@pytest.mark.parametrize("ranks, parts, ghosts", [(1, 3, 1), (2, 2, 1), (3, 7, 1), (3, 2, 1), (2, 5, 0)])
def test_partitions_are_the_pieces(tmp_path, ranks, parts, ghosts, source):
    """For files that all ranks read, and for one that rank 0 reads."""
    if source == "a.vtkhdf":
        vtkhdf.write(tmp_path / source, number="f4")
    else:
        write(tmp_path / source, grid(), source != "narrow.vtu", mode="binary" if source == "b.vtu" else "appended")
    options = ("--parts", parts, "--ghosts", ghosts, "--json")
    order(ranks, tmp_path / source, "--pieces", tmp_path / "out", *options)
    result = json.loads(order(ranks, tmp_path / source, "--pieces", tmp_path / "out.vtkhdf", *options).stdout)
    assert result["files_by"] == ("rank 0" if source == "b.vtu" else "all ranks")
    assert result["pieces"]["file"] == str(tmp_path / "out.vtkhdf") and result["output"] is None
    fields, _ = assert_those_of(tmp_path / "out", source[0], tmp_path / "out.vtkhdf")
    assert fields == {"time": [2.5], "note": [b"kept as it is"]}
    assert (result["pieces"]["ghost_cells"] > 0) == (ghosts == 1)
    assert sorted(os.listdir(tmp_path)) == sorted([source, "out", "out.vtkhdf"])


@pytest.mark.parametrize("ghosts", [0, 1])
def test_partitions_are_read_as_the_mesh_that_they_are_of(tmp_path, ghosts):
    write(tmp_path / "a.vtu", grid())
    order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--pieces", tmp_path / "out.vtkhdf", "--parts", 5, "--ghosts", ghosts)
    serial("order", tmp_path / "out.vtkhdf", "-o", tmp_path / "again.vtu", "--vertices", "original", "--elements", "original")
    whole, again = Grid(tmp_path / "b.vtu"), Grid(tmp_path / "again.vtu")
    assert numpy.array_equal(again.points, whole.points) and again.cells == whole.cells
    for read, written in ((again.of_points, whole.of_points), (again.of_cells, whole.of_cells)):
        assert set(read) - {"part"} == set(written)
        for name in written:
            assert numpy.array_equal(read[name], written[name]), name


def test_pieces_beside_a_whole_file_that_they_replace(tmp_path):
    write(tmp_path / "a.vtu", grid())
    (tmp_path / "out.vtkhdf").write_bytes(b"of an earlier run")
    order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--pieces", tmp_path / "out.vtkhdf", "--parts", "3")
    order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--pieces", tmp_path / "out", "--parts", "3")
    assert_those_of(tmp_path / "out", "b", tmp_path / "out.vtkhdf")


def test_texts_are_left_out_and_roles_are_kept(tmp_path):
    with_texts_and_roles(tmp_path / "a.vtu")
    order(2, tmp_path / "a.vtu", "--pieces", tmp_path / "out", "--parts", "4")
    done = order(2, tmp_path / "a.vtu", "--pieces", tmp_path / "out.vtkhdf", "--parts", "4")
    _, roles = assert_those_of(tmp_path / "out", "a", tmp_path / "out.vtkhdf", without=["text"])
    assert roles["PointData"]["Vectors"] == b"u" and roles["PointData"]["Scalars"] == b"id"
    told = "\n".join(own_lines(done))
    for part in ("the pieces have other arrays of the names", "the array 'text' on vertices is not in the pieces",
                 "the array 'text' on cells is not in the pieces", "information of the array 'u' on vertices"):
        assert part in told
    assert launch(2, "order", tmp_path / "a.vtu", "--pieces", tmp_path / "no.vtkhdf", "--strict").returncode == 2
    assert not (tmp_path / "no.vtkhdf").exists()


def test_names_that_hdf5_cannot_hold_are_changed(tmp_path):
    made = grid()
    made.GetPointData().AddArray(array("a/b", numpy.arange(400)))
    made.GetPointData().AddArray(array("a_b", numpy.arange(400)))
    made.GetPointData().SetActiveScalars("a/b")
    write(tmp_path / "a.vtu", made)
    done = order(2, tmp_path / "a.vtu", "--pieces", tmp_path / "out.vtkhdf")
    assert "the array 'a/b' on vertices is written as 'a_b'" in done.stderr
    found, _, roles = partitions(tmp_path / "out.vtkhdf")
    assert {"a_b", "a_b_2"} < set(found[0][2]) and roles["PointData"]["Scalars"] == b"a_b"


def test_more_parts_than_vertices_leave_empty_partitions(tmp_path):
    write(tmp_path / "a.vtu", grid(points=25, cells=2, seed=3))
    for pieces in ("out", "out.vtkhdf"):
        order(2, tmp_path / "a.vtu", "--pieces", tmp_path / pieces, "--parts", "12")
    assert_those_of(tmp_path / "out", "a", tmp_path / "out.vtkhdf")


def test_a_mesh_of_another_format(tmp_path):
    source = DATA / "arch.msh"
    for pieces in ("out", "out.vtkhdf"):
        order(3, source, "--pieces", tmp_path / pieces, "--parts", "5")
    assert_those_of(tmp_path / "out", "arch", tmp_path / "out.vtkhdf")


@pytest.mark.parametrize("output, pieces, words", [
    ("b.vtkhdf", "b.vtkhdf", "the output and the pieces cannot be one file"),
    ("b.vtu", "nowhere/b.vtkhdf", "nowhere"), ("b.vtu", "folder.vtkhdf", "folder.vtkhdf")])
def test_pieces_that_cannot_be_written_leave_nothing(tmp_path, output, pieces, words):
    write(tmp_path / "a.vtu", grid())
    (tmp_path / "folder.vtkhdf").mkdir()
    done = launch(2, "order", tmp_path / "a.vtu", "-o", tmp_path / output, "--pieces", tmp_path / pieces)
    assert done.returncode == 2 and len(own_lines(done)) == 1 and words in own_lines(done)[0], done.stderr
    assert sorted(os.listdir(tmp_path)) == ["a.vtu", "folder.vtkhdf"]
