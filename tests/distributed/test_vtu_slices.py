# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files that all ranks read and write at once: made by VTK, which also reads what becomes of them."""
import json
import os
import re
import struct
import subprocess

import numpy
import pytest
import vtkmodules.util.numpy_support as convert
from test_mpi import launch, order, own_lines
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

LINE, TRIANGLE, TETRAHEDRON, PYRAMID = 3, 5, 10, 14


def array(name, values):
    made = convert.numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    made.SetName(name)
    return made


def grid(points=400, cells=900, seed=1):
    """Cells of three dimensions in an order by chance, points that nothing uses, arrays of several types and a text."""
    chance = numpy.random.default_rng(seed)
    kinds = chance.choice([TETRAHEDRON, PYRAMID, TRIANGLE, LINE], cells, p=[0.5, 0.2, 0.2, 0.1])
    sizes = {TETRAHEDRON: 4, PYRAMID: 5, TRIANGLE: 3, LINE: 2}
    rows = [chance.choice(points - 20, sizes[kind], replace=False) for kind in kinds]
    made = vtkUnstructuredGrid()
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(convert.numpy_to_vtk(chance.random((points, 3)), deep=True))
    made.SetPoints(places)
    connectivity = vtkCellArray()
    connectivity.SetData(convert.numpy_to_vtkIdTypeArray(numpy.concatenate([[0], numpy.cumsum([len(r) for r in rows])]), deep=True),
                         convert.numpy_to_vtkIdTypeArray(numpy.concatenate(rows), deep=True))
    made.SetCells(convert.numpy_to_vtk(kinds.astype(numpy.uint8), deep=True), connectivity)
    made.GetPointData().AddArray(array("u", chance.random((points, 3)).astype(numpy.float32)))
    made.GetPointData().AddArray(array("id", numpy.arange(points, dtype=numpy.int64)))
    made.GetCellData().AddArray(array("id", numpy.arange(cells, dtype=numpy.int32)))
    made.GetCellData().AddArray(array("label", (kinds % 7).astype(numpy.int16)))
    made.GetFieldData().AddArray(array("time", numpy.array([2.5])))
    text = vtkStringArray()
    text.SetName("note")
    text.InsertNextValue("kept as it is")
    made.GetFieldData().AddArray(text)
    return made


def write(path, made, wide=True, compressed=False, mode="appended"):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(made)
    writer.SetDataModeToAppended() if mode == "appended" else writer.SetDataModeToBinary()
    writer.EncodeAppendedDataOff()
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    if not compressed:
        writer.SetCompressorTypeToNone()
    assert writer.Write() == 1


def read(path):
    """All that a file has, by the ids of its points and cells."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    found = reader.GetOutput()
    points = convert.vtk_to_numpy(found.GetPoints().GetData())
    types = convert.vtk_to_numpy(found.GetCellTypesArray())
    offsets = convert.vtk_to_numpy(found.GetCells().GetOffsetsArray())
    connectivity = convert.vtk_to_numpy(found.GetCells().GetConnectivityArray())
    arrays = [{data.GetArrayName(k): convert.vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}
              for data in (found.GetPointData(), found.GetCellData())]
    cells = [(int(kind), connectivity[a:b].tolist()) for kind, a, b in zip(types, offsets, offsets[1:])]
    fields = found.GetFieldData()
    return points, cells, arrays, (fields.GetArray("time").GetTuple1(0), fields.GetAbstractArray("note").GetValue(0))


def assert_same_but_for_order(old, new):
    """Whether each point and cell is the one of its id, with its arrays, and whether dimensions kept their places."""
    old_points, old_cells, (old_u, old_c), old_fields = old
    points, cells, (u, c), fields = new
    assert sorted(u["id"]) == list(range(len(old_points))) and sorted(c["id"]) == list(range(len(old_cells)))
    assert (points == old_points[u["id"]]).all() and (u["u"] == old_u["u"][u["id"]]).all()
    assert u["u"].dtype == old_u["u"].dtype and c["id"].dtype == old_c["id"].dtype
    assert (c["label"] == old_c["label"][c["id"]]).all()
    for (kind, row), number in zip(cells, c["id"]):
        assert (kind, u["id"][row].tolist()) == old_cells[number]
    dimension = {LINE: 1, TRIANGLE: 2, TETRAHEDRON: 3, PYRAMID: 3}
    assert [dimension[kind] for kind, _ in cells] == [dimension[kind] for kind, _ in old_cells]
    assert fields == old_fields


@pytest.mark.parametrize("wide", [True, False])
@pytest.mark.parametrize("ranks", [1, 2, 3, 5])
def test_slices_give_what_one_rank_gives(tmp_path, ranks, wide):
    made = grid()
    write(tmp_path / "raw.vtu", made, wide)
    write(tmp_path / "zlib.vtu", made, wide, compressed=True)
    by = {}
    for name in ("raw", "zlib"):
        done = order(ranks, tmp_path / f"{name}.vtu", "-o", tmp_path / f"{name}-out.vtu", "--parts", "3", "--json")
        by[name] = json.loads(done.stdout)["files_by"]
    assert by == {"raw": "all ranks", "zlib": "rank 0"}
    sliced, whole = read(tmp_path / "raw-out.vtu"), read(tmp_path / "zlib-out.vtu")
    assert_same_but_for_order(read(tmp_path / "raw.vtu"), sliced)
    assert sliced[1] == whole[1] and (sliced[0] == whole[0]).all()
    for ours, theirs in zip(sliced[2], whole[2]):
        assert all((ours[name] == theirs[name]).all() for name in ours)
    assert sliced[2][0]["id"].tolist() != list(range(len(sliced[0])))
    assert os.path.getsize(tmp_path / "raw.vtu") == os.path.getsize(tmp_path / "raw-out.vtu")


def test_a_file_may_take_its_own_place(tmp_path):
    write(tmp_path / "a.vtu", grid(seed=4))
    before = read(tmp_path / "a.vtu")
    order(3, tmp_path / "a.vtu", "-o", tmp_path / "a.vtu")
    assert_same_but_for_order(before, read(tmp_path / "a.vtu"))
    assert os.listdir(tmp_path) == ["a.vtu"]


def test_fewer_cells_than_ranks(tmp_path):
    write(tmp_path / "a.vtu", grid(points=25, cells=2, seed=3))
    order(5, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu")
    assert_same_but_for_order(read(tmp_path / "a.vtu"), read(tmp_path / "b.vtu"))


@pytest.mark.parametrize("arguments", [["--maps", "m"], ["--ids", "attach"], ["--only", "volume"], ["--strict"]])
def test_what_needs_the_whole_mesh_is_done_by_rank_0(tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    write("a.vtu", grid())
    assert json.loads(order(2, "a.vtu", "-o", "b.vtu", "--json", *arguments).stdout)["files_by"] == "rank 0"


def block(data, name):
    """The first byte of the block of an array, which begins with its size."""
    appended = data.index(b"_", data.index(b"<AppendedData")) + 1
    offset = re.search(rb'Name="%s"[^>]*?offset="(\d+)"' % name.encode(), data)
    return appended + int(offset[1])


def replaced(data, at, values):
    return data[:at] + values + data[at + len(values):]


FAULTS = {
    "cut short": (lambda d: d[:len(d) * 2 // 3], "may be cut short"),
    "a size that lies": (lambda d: replaced(d, block(d, "u"), struct.pack("<Q", 17)), "has 17 bytes for 400 rows of 12"),
    "an enormous size": (lambda d: replaced(d, block(d, "u"), struct.pack("<Q", 2**63)), "but the file ends"),
    "not a number": (lambda d: replaced(d, block(d, "Points") + 8 + 24 * 390, struct.pack("<d", float("nan"))),
                     "point 390 (counted from 0) has a coordinate that is not finite"),
    "a point that is not there": (lambda d: replaced(d, block(d, "connectivity") + 8 + 8 * 2000, struct.pack("<q", 400)),
                                  "a cell names the point 400"),
    "offsets that descend": (lambda d: replaced(d, block(d, "offsets") + 8 + 8 * 800, struct.pack("<q", 3)),
                             "cell 800 (counted from 0) has the entries"),
    "an unknown type": (lambda d: replaced(d, block(d, "types") + 8 + 899, b"\xc8"), "cell 899 (counted from 0) is of VTK's type 200"),
    "a type of more points": (lambda d: replaced(d, block(d, "types") + 8 + 600, b"\x0c"), "is of VTK's type 12"),
    "too many points": (lambda d: d.replace(b'NumberOfPoints="400"', b'NumberOfPoints="401"'), "for 401 rows of"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_ends_all_ranks_with_one_line(tmp_path, fault):
    change, words = FAULTS[fault]
    write(tmp_path / "a.vtu", grid())
    (tmp_path / "a.vtu").write_bytes(change((tmp_path / "a.vtu").read_bytes()))
    done = launch(3, "order", tmp_path / "a.vtu", "-o", tmp_path / "b.vtu")
    assert done.returncode == 2, done.stderr
    assert len(own_lines(done)) == 1 and words in own_lines(done)[0] and "a.vtu" in own_lines(done)[0], done.stderr
    assert os.listdir(tmp_path) == ["a.vtu"]


def test_a_full_disk_ends_all_ranks(tmp_path):
    folder = tmp_path / "small"
    folder.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=40k", "none", folder], capture_output=True, check=False).returncode:
        pytest.skip("needs the right to mount a file system")
    try:
        write(tmp_path / "a.vtu", grid())
        done = launch(3, "order", tmp_path / "a.vtu", "-o", folder / "b.vtu")
        assert done.returncode == 2, done.stderr
        assert len(own_lines(done)) == 1 and "b.vtu" in own_lines(done)[0], done.stderr
        assert os.listdir(folder) == []
    finally:
        subprocess.run(["umount", folder], check=True)
