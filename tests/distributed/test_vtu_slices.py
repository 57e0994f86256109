# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files that all ranks read and write at once. VTK makes them and reads the results."""
import json
import os
import re
import struct
import subprocess

import meshio
import numpy
import pytest
import vtkmodules.util.numpy_support as convert
from test_mpi import launch, order, own_lines, serial
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOCore import vtkLZ4DataCompressor, vtkLZMADataCompressor, vtkZLibDataCompressor
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

LINE, TRIANGLE, TETRAHEDRON, VOXEL, PYRAMID = 3, 5, 10, 11, 14


def array(name, values):
    made = convert.numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    made.SetName(name)
    return made


def grid(points=400, cells=900, seed=1):
    """Cells of three dimensions in random order, unused points, arrays of several types and a text."""
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


def write(path, made, wide=True, compressor=None, block=None, mode="appended", big=False):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(made)
    writer.SetDataModeToAppended() if mode == "appended" else writer.SetDataModeToBinary()
    writer.EncodeAppendedDataOff()
    writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    writer.SetCompressor(compressor() if compressor else None)
    if block:
        writer.SetBlockSize(block)
    assert writer.Write() == 1


def read(path):
    """The content of a file: points, cells, arrays with ids, and fields."""
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
    """Asserts that each point and cell equals the old one with its id, also in all arrays, and that dimensions kept
    their places."""
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


def appended(data):
    """The offset of the first byte after the underscore."""
    return data.index(b"_", data.index(b"<AppendedData")) + 1


def block(data, name):
    """The offset of an array, which begins with its size."""
    return appended(data) + int(re.search(rb'Name="%s"[^>]*?offset="(\d+)"' % name.encode(), data)[1])


def assert_same(one, other):
    assert one[1] == other[1] and (one[0] == other[0]).all() and one[3] == other[3]
    for ours, theirs in zip(one[2], other[2]):
        assert ours.keys() == theirs.keys() and all((ours[name] == theirs[name]).all() for name in ours)


def sorted_cells(path):
    """The cells by the coordinates of their vertices."""
    mesh = meshio.read(path)
    return sorted(map(bytes, mesh.points[mesh.cells[0].data].reshape(len(mesh.cells[0].data), -1)))


def xml(path):
    """The XML of a file without the values of offsets."""
    head, begin, rest = path.read_bytes().partition(b"<AppendedData")
    tag = rest[:rest.index(b">")]
    return re.sub(rb'offset="\d+"', b"", head), begin + tag, rest[rest.rindex(b"</AppendedData>"):]


@pytest.mark.parametrize("wide", [True, False])
@pytest.mark.parametrize("ranks", [1, 2, 3, 5])
def test_slices_give_what_one_rank_gives(tmp_path, ranks, wide):
    made = grid()
    write(tmp_path / "raw.vtu", made, wide)
    write(tmp_path / "zlib.vtu", made, wide, vtkZLibDataCompressor, block=1000)
    write(tmp_path / "text.vtu", made, wide, mode="binary")
    by = {}
    for name in ("raw", "zlib", "text"):
        done = order(ranks, tmp_path / f"{name}.vtu", "-o", tmp_path / f"{name}-out.vtu", "--parts", "3", "--json")
        by[name] = json.loads(done.stdout)["files_by"]
    assert by == {"raw": "all ranks", "zlib": "all ranks", "text": "rank 0"}
    sliced, whole = read(tmp_path / "raw-out.vtu"), read(tmp_path / "text-out.vtu")
    assert_same_but_for_order(read(tmp_path / "raw.vtu"), sliced)
    assert_same(sliced, whole)
    assert_same(sliced, read(tmp_path / "zlib-out.vtu"))
    assert sliced[2][0]["id"].tolist() != list(range(len(sliced[0])))
    assert os.path.getsize(tmp_path / "raw.vtu") == os.path.getsize(tmp_path / "raw-out.vtu")
    for name in ("raw", "zlib"):
        assert xml(tmp_path / f"{name}.vtu") == xml(tmp_path / f"{name}-out.vtu")


@pytest.mark.parametrize("compressor, block", [(vtkZLibDataCompressor, 8), (vtkZLibDataCompressor, 3000),
                                               (vtkLZ4DataCompressor, 1 << 20), (vtkLZMADataCompressor, 800)])
def test_blocks_of_any_size_are_read(tmp_path, compressor, block):
    """Blocks of less than a row, and of more than all rows."""
    write(tmp_path / "raw.vtu", grid())
    write(tmp_path / "a.vtu", grid(), True, compressor, block)
    order(3, tmp_path / "raw.vtu", "-o", tmp_path / "raw-out.vtu")
    done = order(3, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--json")
    if json.loads(done.stdout)["files_by"] == "rank 0":
        pytest.skip("needs a build with this compression")
    assert_same(read(tmp_path / "b.vtu"), read(tmp_path / "raw-out.vtu"))
    assert xml(tmp_path / "a.vtu") == xml(tmp_path / "b.vtu")
    serial("order", tmp_path / "b.vtu", "-o", tmp_path / "c.vtu", "--vertices", "original", "--elements", "original")
    assert_same(read(tmp_path / "b.vtu"), read(tmp_path / "c.vtu"))


def test_numbers_in_attributes_may_have_blanks(tmp_path):
    write(tmp_path / "a.vtu", grid())
    head, begin, rest = (tmp_path / "a.vtu").read_bytes().partition(b"<AppendedData")
    head, count = re.subn(rb' (version|NumberOf\w+|offset)="([\d.]+)"', rb' \1=" \n\t\2\t"', head)
    assert count > 10
    (tmp_path / "b.vtu").write_bytes(head + begin + rest)
    for name in ("a", "b"):
        done = order(2, tmp_path / f"{name}.vtu", "-o", tmp_path / f"{name}-out.vtu", "--json")
        assert json.loads(done.stdout)["files_by"] == "all ranks"
    assert_same(read(tmp_path / "a-out.vtu"), read(tmp_path / "b-out.vtu"))


def test_compressed_files_are_the_same_on_every_number_of_ranks(tmp_path):
    """Many blocks for each rank, and for each of its neighbours."""
    ball = json.loads(serial("models", "make", "ball", "--size", "30", "--json").stdout)["models"][0]["path"]
    reader = vtkXMLUnstructuredGridReader()
    serial("order", ball, "-o", tmp_path / "ball.vtu", "--vertices", "scrambled")
    reader.SetFileName(str(tmp_path / "ball.vtu"))
    reader.Update()
    write(tmp_path / "a.vtu", reader.GetOutput(), compressor=vtkZLibDataCompressor)
    files = []
    for ranks in (1, 2, 3, 5):
        order(ranks, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--partition", "hilbert", "--parts", "7")
        files.append((tmp_path / "b.vtu").read_bytes())
    assert files[0] == files[1] == files[2] == files[3]
    blocks, size = struct.unpack("<QQ", files[0][block(files[0], "connectivity"):][:16])
    assert blocks >= 3 and size == 1 << 20
    assert sorted_cells(tmp_path / "b.vtu") == sorted_cells(tmp_path / "a.vtu")
    # the room for offsets does not grow
    order(2, tmp_path / "b.vtu", "-o", tmp_path / "c.vtu")
    assert appended(files[0]) == appended((tmp_path / "c.vtu").read_bytes())


def test_what_is_no_array_of_the_mesh_stays_as_it_is(tmp_path):
    """An empty field, a text, a comment, and a field after all arrays."""
    made = grid(cells=2500)
    made.GetFieldData().AddArray(array("empty", numpy.zeros(0)))
    write(tmp_path / "a.vtu", made, compressor=vtkZLibDataCompressor)
    data = (tmp_path / "a.vtu").read_bytes()
    at, end = block(data, "time"), data.rindex(b"\n  </AppendedData>")
    _, _, _, size = struct.unpack("<4Q", data[at:at + 32])
    data = data[:end] + data[at:at + 32 + size] + data[end:]
    data = re.sub(rb'(Name="time"[^>]*?offset=")\d+', rb"\g<1>%d" % (end - appended(data)), data)
    (tmp_path / "a.vtu").write_bytes(data.replace(b"<UnstructuredGrid>", b"<!-- of a user --><UnstructuredGrid>", 1))
    order(3, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu")
    assert xml(tmp_path / "a.vtu") == xml(tmp_path / "b.vtu") and b"of a user" in xml(tmp_path / "b.vtu")[0]
    assert_same_but_for_order(read(tmp_path / "a.vtu"), read(tmp_path / "b.vtu"))
    for name in ("empty", "time", "note"):
        old, new = ((tmp_path / file).read_bytes() for file in ("a.vtu", "b.vtu"))
        assert old[block(old, name):][:24] == new[block(new, name):][:24]


@pytest.mark.parametrize("compressor", [None, vtkZLibDataCompressor])
def test_a_file_may_take_its_own_place(tmp_path, compressor):
    write(tmp_path / "a.vtu", grid(seed=4), True, compressor)
    before = read(tmp_path / "a.vtu")
    order(3, tmp_path / "a.vtu", "-o", tmp_path / "a.vtu")
    assert_same_but_for_order(before, read(tmp_path / "a.vtu"))
    assert os.listdir(tmp_path) == ["a.vtu"]


@pytest.mark.parametrize("compressor", [None, vtkZLibDataCompressor])
def test_fewer_cells_than_ranks(tmp_path, compressor):
    write(tmp_path / "a.vtu", grid(points=25, cells=2, seed=3), True, compressor)
    order(5, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu")
    assert_same_but_for_order(read(tmp_path / "a.vtu"), read(tmp_path / "b.vtu"))


@pytest.mark.parametrize("compressor", [None, vtkZLibDataCompressor])
def test_another_order_of_bytes_is_read_by_rank_0(tmp_path, compressor):
    write(tmp_path / "a.vtu", grid(), True, compressor, big=True)
    before = read(tmp_path / "a.vtu")
    done = order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--json")
    assert json.loads(done.stdout)["files_by"] == "rank 0"
    assert_same_but_for_order(before, read(tmp_path / "b.vtu"))
    order(2, tmp_path / "a.vtu", "--pieces", tmp_path / "out")
    serial("order", tmp_path / "out" / "a.pvtu", "-o", tmp_path / "c.vtu", "--vertices", "original", "--elements", "original")
    cells = {name: sorted((kind, tuple(u["id"][row].tolist())) for kind, row in made)
             for name, (_, made, (u, _), _) in (("a", before), ("c", read(tmp_path / "c.vtu")))}
    assert cells["a"] == cells["c"]


@pytest.mark.parametrize("arguments", [["--ids", "attach"], ["--only", "volume"], ["--strict"]])
def test_what_needs_the_whole_mesh_is_done_by_rank_0(tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    write("a.vtu", grid())
    assert json.loads(order(2, "a.vtu", "-o", "b.vtu", "--json", *arguments).stdout)["files_by"] == "rank 0"


def files_of_maps(folder, prefix):
    return {path.name.removeprefix(prefix): path.read_bytes() for path in folder.glob(f"{prefix}.*") if path.suffix != ".vtu"}


@pytest.mark.parametrize("ranks", [1, 2, 3, 5])
def test_maps_are_those_that_one_rank_writes(tmp_path, ranks):
    made = grid()
    write(tmp_path / "raw.vtu", made)
    write(tmp_path / "zlib.vtu", made, True, vtkZLibDataCompressor, 1000)
    write(tmp_path / "text.vtu", made, mode="binary")
    for name, by in (("raw", "all ranks"), ("zlib", "all ranks"), ("text", "rank 0")):
        (tmp_path / f"{name}.vertices.ids.npy").write_bytes(b"of an earlier run")
        result = json.loads(order(ranks, tmp_path / f"{name}.vtu", "-o", tmp_path / f"{name}-out.vtu", "--parts", "4", "--maps",
                                  tmp_path / name, "--json").stdout)
        assert result["files_by"] == by
        assert sorted(result["maps"]) == sorted(map(str, set(tmp_path.glob(f"{name}.*")) - {tmp_path / f"{name}.vtu"}))
    assert len(files_of_maps(tmp_path, "text")) == 7
    assert files_of_maps(tmp_path, "raw") == files_of_maps(tmp_path, "zlib") == files_of_maps(tmp_path, "text")
    serial("apply", tmp_path / "zlib", tmp_path / "zlib-out.vtu", "-o", tmp_path / "back.vtu", "--inverse")
    assert_same(read(tmp_path / "back.vtu"), read(tmp_path / "raw.vtu"))


def test_a_file_of_meshorder_comes_back_byte_by_byte(tmp_path):
    write(tmp_path / "made.vtu", grid())
    serial("order", tmp_path / "made.vtu", "-o", tmp_path / "a.vtu", "--vertices", "scrambled", "--elements", "scrambled")
    order(3, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--maps", tmp_path / "m")
    serial("apply", tmp_path / "m", tmp_path / "b.vtu", "-o", tmp_path / "back.vtu", "--inverse")
    assert (tmp_path / "back.vtu").read_bytes() == (tmp_path / "a.vtu").read_bytes() != (tmp_path / "b.vtu").read_bytes()


def test_maps_of_cells_that_a_mesh_has_in_another_order_are_written_by_rank_0(tmp_path):
    """A voxel becomes a hexahedron; the maps' checksums depend on the order of its vertices."""
    points = numpy.stack(numpy.meshgrid(range(2), range(2), range(2), indexing="ij"), axis=-1).reshape(-1, 3)[:, ::-1]
    made = vtkUnstructuredGrid()
    places = vtkPoints()
    places.SetData(convert.numpy_to_vtk(points.astype(float), deep=True))
    made.SetPoints(places)
    made.InsertNextCell(VOXEL, 8, range(8))
    write(tmp_path / "a.vtu", made)
    by = [json.loads(order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--json", *maps).stdout)["files_by"]
          for maps in ([], ["--maps", tmp_path / "m"])]
    assert by == ["all ranks", "rank 0"]
    serial("apply", tmp_path / "m", tmp_path / "a.vtu", "-o", tmp_path / "again.vtu")
    assert (tmp_path / "again.vtu").read_bytes() == (tmp_path / "b.vtu").read_bytes()


@pytest.mark.parametrize("extension", ["vtu", "vtkhdf"])
def test_pipes_are_read_by_rank_0(tmp_path, extension):
    write(tmp_path / "a.vtu", grid())
    serial("order", tmp_path / "a.vtu", "-o", tmp_path / f"b.{extension}", "-q")
    os.mkfifo(tmp_path / f"pipe.{extension}")
    with subprocess.Popen(["cp", tmp_path / f"b.{extension}", tmp_path / f"pipe.{extension}"]):
        done = order(2, tmp_path / f"pipe.{extension}", "-o", tmp_path / f"c.{extension}", "--json")
    assert json.loads(done.stdout)["files_by"] == "rank 0"
    order(2, tmp_path / f"b.{extension}", "-o", tmp_path / f"d.{extension}", "--strict")  # by rank 0 as well
    assert (tmp_path / f"c.{extension}").read_bytes() == (tmp_path / f"d.{extension}").read_bytes()


def test_maps_that_cannot_be_written_leave_nothing(tmp_path):
    write(tmp_path / "a.vtu", grid())
    done = launch(3, "order", tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--maps", tmp_path / "nowhere" / "m")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and "nowhere" in own_lines(done)[0], done.stderr
    assert os.listdir(tmp_path) == ["a.vtu"]


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
    "a type of more points": (lambda d: replaced(d, block(d, "types") + 8 + 600, b"\x0c"), "cell 600 (counted from 0) is a hexahedron of"),
    "too many points": (lambda d: d.replace(b'NumberOfPoints="400"', b'NumberOfPoints="401"'), "for 401 rows of"),
}


def word(data, name, number, change):
    """The file with a changed word in the header of an array: word 0 is the number of blocks, 1 the size of a block, 2 the
    size of the last one, the others the compressed sizes."""
    at = block(data, name) + 8 * number
    return replaced(data, at, struct.pack("<Q", change(struct.unpack("<Q", data[at:at + 8])[0])))


def first_byte_of_blocks(data, name):
    at = block(data, name)
    return at + 8 * (3 + struct.unpack("<Q", data[at:at + 8])[0])


FAULTS_OF_BLOCKS = {
    "cut short": (lambda d: d[:len(d) * 2 // 3], "ends early"),
    "more blocks than bytes": (lambda d: word(d, "u", 0, lambda n: 2**61), "the array 'u' ends early"),
    "empty blocks": (lambda d: word(d, "u", 1, lambda n: 0), "the array 'u' has empty blocks"),
    "a last block that lies": (lambda d: word(d, "u", 2, lambda n: n + 24), "the array 'u' has 4824 bytes for 400 rows of 12"),
    "blocks that cannot hold so much": (lambda d: word(d, "u", 1, lambda n: 2**62), "cannot hold 4611686018427387904"),
    "an enormous block": (lambda d: word(d, "u", 3, lambda n: 2**63), "the array 'u' ends early"),
    "sizes of two blocks that lie": (lambda d: word(word(d, "u", 4, lambda n: n - 1), "u", 5, lambda n: n + 1),
                                     "block 1 of the array 'u' cannot be uncompressed"),
    "bytes that are no zlib": (lambda d: replaced(d, first_byte_of_blocks(d, "connectivity"), b"\0\0\0\0"),
                               "block 0 of the array 'connectivity' cannot be uncompressed"),
    "points that are too few": (lambda d: d.replace(b'NumberOfPoints="400"', b'NumberOfPoints="401"'), "for 401 rows of"),
}


@pytest.mark.parametrize("fault, compressor", [*((fault, None) for fault in FAULTS),
                                               *((fault, vtkZLibDataCompressor) for fault in FAULTS_OF_BLOCKS)])
def test_a_fault_ends_all_ranks_with_one_line(tmp_path, fault, compressor):
    change, words = (FAULTS_OF_BLOCKS if compressor else FAULTS)[fault]
    write(tmp_path / "a.vtu", grid(), True, compressor, block=1000)
    (tmp_path / "a.vtu").write_bytes(change((tmp_path / "a.vtu").read_bytes()))
    done = launch(3, "order", tmp_path / "a.vtu", "-o", tmp_path / "b.vtu")
    assert done.returncode == 2, done.stderr
    assert len(own_lines(done)) == 1 and words in own_lines(done)[0] and "a.vtu" in own_lines(done)[0], done.stderr
    assert os.listdir(tmp_path) == ["a.vtu"]


def test_what_blocks_claim_is_limited(tmp_path):
    made = grid()
    made.GetCellData().AddArray(array("nothing", numpy.zeros((900, 2000))))
    write(tmp_path / "a.vtu", made, True, vtkZLibDataCompressor)
    done = launch(2, "order", tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--limit-memory", "16M")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and "the array 'nothing' would take" in own_lines(done)[0]
    order(4, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--limit-memory", "20M")


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
