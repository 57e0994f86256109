# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Pieces for programs whose ranks read one each, checked by VTK."""
import json
import os
import re
import subprocess

import numpy
import pytest
import vtkmodules.util.numpy_support as convert
from test_mpi import DATA, ball, launch, order, own_lines, serial
from test_vtu_slices import array, grid, write
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkHigherOrderHexahedron, vtkUnstructuredGrid
from vtkmodules.vtkIOCore import vtkZLibDataCompressor
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

#: how a file holds its arrays; if they are in the XML, only rank 0 reads them
STORED = {"raw": {}, "compressed": {"compressor": vtkZLibDataCompressor, "block": 1000}, "in the XML": {"mode": "binary"}}
OF_PIECES = {"GlobalPointIds", "GlobalCellIds", "vtkGhostType", "part"}


class Grid:
    """What VTK reads from a file: points, cells as (type, points), and arrays of both by name."""

    def __init__(self, path):
        reader = vtkXMLPUnstructuredGridReader() if path.suffix == ".pvtu" else vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        assert reader.GetErrorCode() == 0
        found = self.vtk = reader.GetOutput()
        self.points, self.cells = numpy.zeros((0, 3)), []
        if found.GetNumberOfPoints():
            self.points = convert.vtk_to_numpy(found.GetPoints().GetData())
        if found.GetNumberOfCells():
            types = convert.vtk_to_numpy(found.GetCellTypesArray())
            offsets = convert.vtk_to_numpy(found.GetCells().GetOffsetsArray())
            entries = convert.vtk_to_numpy(found.GetCells().GetConnectivityArray())
            self.cells = [(int(kind), tuple(entries[a:b].tolist())) for kind, a, b in zip(types, offsets, offsets[1:])]
        self.of_points, self.of_cells = (self.arrays(data) for data in (found.GetPointData(), found.GetCellData()))

    @staticmethod
    def arrays(data):
        found = {}
        for k in range(data.GetNumberOfArrays()):
            values = data.GetAbstractArray(k)
            texts = isinstance(values, vtkStringArray)
            found[values.GetName()] = (numpy.array([values.GetValue(i) for i in range(values.GetNumberOfValues())])
                                       if texts else convert.vtk_to_numpy(values))
        return found


def parts_of(whole, starts):
    """The part of each vertex and cell of an ordered mesh, as --maps defines them."""
    vertices = numpy.searchsorted(starts, numpy.arange(len(whole.points)), side="right") - 1
    cells = numpy.array([vertices[max(row)] for _, row in whole.cells])
    return vertices, cells


def assert_pieces_of(whole, folder, name, result, ghosts=1, with_arrays=True):
    """Asserts that the pieces are the parts of the ordered mesh with their ghosts, and nothing else."""
    starts = result["partition"]["first_vertices"]
    assert sorted(os.listdir(folder)) == sorted([f"{name}.pvtu", *(f"{name}_{p:04}.vtu" for p in range(len(starts)))])
    vertex_parts, cell_parts = parts_of(whole, starts)
    totals = [0, 0]
    for part in range(len(starts)):
        piece = Grid(folder / f"{name}_{part:04}.vtu")
        own_vertices = numpy.flatnonzero(vertex_parts == part)
        own_cells = numpy.flatnonzero(cell_parts == part)
        own = set(own_vertices.tolist())
        ghost_cells = [c for c, (_, row) in enumerate(whole.cells) if cell_parts[c] != part and own & set(row)]
        ghost_cells = sorted(ghost_cells, key=lambda c: (cell_parts[c], c)) if ghosts else []
        cells = [*own_cells.tolist(), *ghost_cells]
        used = {vertex for c in cells for vertex in whole.cells[c][1]}
        ghost_vertices = sorted(used - own)  # also sorted by part, since parts are ranges
        vertices = [*own_vertices.tolist(), *ghost_vertices]
        totals[0] += len(ghost_vertices)
        totals[1] += len(ghost_cells)

        if not vertices:
            assert len(piece.points) == 0 and not piece.cells
            continue
        points, of_cells = piece.of_points, piece.of_cells
        assert points["GlobalPointIds"].tolist() == vertices
        assert points["vtkGhostType"].tolist() == [0] * len(own_vertices) + [1] * len(ghost_vertices)
        assert points["part"].tolist() == vertex_parts[vertices].tolist()
        assert (piece.points == whole.points[vertices]).all() and piece.points.dtype == whole.points.dtype
        assert piece.vtk.GetPointData().GetGlobalIds().GetName() == "GlobalPointIds"
        if cells:
            assert of_cells["GlobalCellIds"].tolist() == cells
            assert of_cells["vtkGhostType"].tolist() == [0] * len(own_cells) + [1] * len(ghost_cells)
            assert of_cells["part"].tolist() == cell_parts[cells].tolist()
            assert piece.vtk.GetCellData().GetGlobalIds().GetName() == "GlobalCellIds"
        assert [(kind, tuple(vertices[v] for v in row)) for kind, row in piece.cells] == [whole.cells[c] for c in cells]
        for ours, theirs, rows in ((points, whole.of_points, vertices), (of_cells, whole.of_cells, cells)) * with_arrays:
            assert set(ours) - OF_PIECES == set(theirs) - OF_PIECES
            for key in (set(theirs) - OF_PIECES if len(rows) else ()):
                assert numpy.array_equal(ours[key], theirs[key][rows]) and ours[key].dtype.kind == theirs[key].dtype.kind
    assert [result["pieces"]["ghost_vertices"], result["pieces"]["ghost_cells"]] == totals

    everything = Grid(folder / f"{name}.pvtu")
    owned = numpy.flatnonzero(everything.of_cells["vtkGhostType"] == 0)
    assert sorted(everything.of_cells["GlobalCellIds"][owned].tolist()) == list(range(len(whole.cells)))
    ids = everything.of_points["GlobalPointIds"]
    assert sorted(ids[everything.of_points["vtkGhostType"] == 0].tolist()) == list(range(len(whole.points)))
    for cell in owned:
        kind, row = everything.cells[cell]
        assert (kind, tuple(ids[list(row)])) == whole.cells[everything.of_cells["GlobalCellIds"][cell]]
    if with_arrays:
        assert set(everything.of_points) == set(whole.of_points) | OF_PIECES - {"GlobalCellIds"}
        assert set(everything.of_cells) == set(whole.of_cells) | OF_PIECES - {"GlobalPointIds"}
    assert f'GhostLevel="{ghosts}"' in (folder / f"{name}.pvtu").read_text()


@pytest.mark.parametrize("stored", STORED)
@pytest.mark.parametrize("ranks, parts, ghosts", [(1, 3, 1), (2, 2, 1), (3, 7, 1), (3, 2, 1), (2, 5, 0)])
def test_pieces_are_the_parts_of_the_ordered_mesh(tmp_path, ranks, parts, ghosts, stored):
    write(tmp_path / "a.vtu", grid(), **STORED[stored])
    done = order(ranks, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--pieces", tmp_path / "out", "--parts", parts,
                 "--ghosts", ghosts, "--json")
    result = json.loads(done.stdout)
    assert result["files_by"] == ("rank 0" if stored == "in the XML" else "all ranks") and result["parts"] == parts
    assert result["pieces"]["file"] == str(tmp_path / "out" / "b.pvtu")
    assert_pieces_of(Grid(tmp_path / "b.vtu"), tmp_path / "out", "b", result, ghosts)


@pytest.mark.parametrize("make, ghosts", [(lambda path: write(path, grid(seed=4)), 1), (lambda path: write(path, grid(seed=4)), 0),
                                          (lambda path: with_texts_and_roles(path), 1)])
def test_pieces_are_read_as_the_mesh_that_they_are_of(tmp_path, make, ghosts):
    make(tmp_path / "a.vtu")
    order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--pieces", tmp_path / "out", "--parts", 5, "--ghosts", ghosts)
    serial("order", tmp_path / "out" / "b.pvtu", "-o", tmp_path / "again.vtu", "--vertices", "original", "--elements", "original")
    whole, again = Grid(tmp_path / "b.vtu"), Grid(tmp_path / "again.vtu")
    assert numpy.array_equal(again.points, whole.points) and again.cells == whole.cells
    for read, written in ((again.of_points, whole.of_points), (again.of_cells, whole.of_cells)):
        assert set(read) - {"part"} == set(written) - {"part"}
        for name in set(written) - {"part"}:
            assert numpy.array_equal(read[name], written[name]), name


def test_pieces_without_a_whole_file(tmp_path):
    write(tmp_path / "a.vtu", grid(seed=2))
    order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--parts", "3")
    done = order(2, tmp_path / "a.vtu", "--pieces", tmp_path / "out", "--parts", "3", "--json")
    assert json.loads(done.stdout)["output"] is None
    assert_pieces_of(Grid(tmp_path / "b.vtu"), tmp_path / "out", "a", json.loads(done.stdout))
    assert sorted(os.listdir(tmp_path)) == ["a.vtu", "b.vtu", "out"]


def with_texts_and_roles(path, wide=True):
    """A grid with texts on points and cells, roles, names that pieces use themselves, and information."""
    made = grid(points=120, cells=200, seed=5)
    for data, count in ((made.GetPointData(), 120), (made.GetCellData(), 200)):
        texts = vtkStringArray()
        texts.SetName("text")
        for k in range(count):
            texts.InsertNextValue(f"<{k % 7}>" * (k % 3))
        data.AddArray(texts)
        data.AddArray(array("part", numpy.arange(count)))
        data.SetActiveScalars("id")
    made.GetPointData().SetActiveVectors("u")
    made.GetPointData().GetArray("u").SetComponentName(1, "up & down")
    made.GetPointData().SetGlobalIds(array("old", numpy.arange(120)))
    write(path, made, wide)


def test_texts_roles_and_names_that_pieces_use(tmp_path):
    with_texts_and_roles(tmp_path / "a.vtu")
    done = order(3, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--pieces", tmp_path / "out", "--parts", "4", "--json")
    result = json.loads(done.stdout)
    assert result["files_by"] == "rank 0"  # which reads texts
    assert_pieces_of(Grid(tmp_path / "b.vtu"), tmp_path / "out", "b", result)
    assert sum("the pieces have other arrays of the names" in line for line in own_lines(done)) == 1
    piece = Grid(tmp_path / "out" / "b_0002.vtu").vtk
    assert piece.GetPointData().GetVectors().GetName() == "u" and piece.GetPointData().GetScalars().GetName() == "id"
    assert piece.GetPointData().GetArray("u").GetComponentName(1) == "up & down"
    assert set(Grid(tmp_path / "out" / "b_0002.vtu").of_points["text"]) == {f"<{k}>" * n for k in range(7) for n in range(3)}


def test_no_loss_where_none_is_allowed(tmp_path):
    with_texts_and_roles(tmp_path / "a.vtu")
    write(tmp_path / "b.vtu", grid())
    done = launch(2, "order", tmp_path / "a.vtu", "--pieces", tmp_path / "out", "--strict")
    assert done.returncode == 2 and len(own_lines(done)) == 1, done.stderr
    assert "'part'" in own_lines(done)[0] and "--strict forbids data loss" in own_lines(done)[0]
    assert sorted(os.listdir(tmp_path)) == ["a.vtu", "b.vtu"]
    order(2, tmp_path / "b.vtu", "--pieces", tmp_path / "out", "--strict")


@pytest.mark.parametrize("wide", [True, False])
@pytest.mark.parametrize("stored", STORED)
def test_every_piece_has_the_fields(tmp_path, wide, stored):
    write(tmp_path / "a.vtu", grid(), wide, **STORED[stored])
    order(2, tmp_path / "a.vtu", "--pieces", tmp_path / "out", "--parts", "3")
    for part in range(3):
        fields = Grid(tmp_path / "out" / f"a_{part:04}.vtu").vtk.GetFieldData()
        assert fields.GetArray("time").GetTuple1(0) == 2.5
        assert fields.GetAbstractArray("note").GetValue(0) == "kept as it is"


def test_fields_that_stand_compressed_in_the_xml_are_those_of_every_piece(tmp_path):
    """Rank 0 reads a file with such fields, and the pieces are not compressed."""
    write(tmp_path / "a.vtu", grid(), **STORED["compressed"])
    write(tmp_path / "inline.vtu", grid(), compressor=vtkZLibDataCompressor, mode="binary")
    fields = re.search(rb"<FieldData>.*?</FieldData>", (tmp_path / "inline.vtu").read_bytes(), re.DOTALL)[0]
    mixed = re.sub(rb"<FieldData>.*?</FieldData>", lambda _: fields, (tmp_path / "a.vtu").read_bytes(), count=1, flags=re.DOTALL)
    (tmp_path / "mixed.vtu").write_bytes(mixed)
    done = order(2, tmp_path / "mixed.vtu", "--pieces", tmp_path / "out", "--json")
    assert json.loads(done.stdout)["files_by"] == "rank 0"
    for part in range(2):
        assert Grid(tmp_path / "out" / f"mixed_{part:04}.vtu").vtk.GetFieldData().GetArray("time").GetTuple1(0) == 2.5


def test_what_fields_claim_is_limited(tmp_path):
    made = grid()
    made.GetFieldData().AddArray(array("zeros", numpy.zeros(1_000_000)))
    write(tmp_path / "a.vtu", made, compressor=vtkZLibDataCompressor)
    done = launch(2, "order", tmp_path / "a.vtu", "--pieces", tmp_path / "out", "--limit-memory", "28M")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and "zeros" in done.stderr, done.stderr
    assert os.listdir(tmp_path) == ["a.vtu"]
    order(2, tmp_path / "a.vtu", "--pieces", tmp_path / "out", "--limit-memory", "36M")


@pytest.mark.parametrize("offset", [10**6, 2**63 - 1])
def test_fields_beyond_the_end_are_reported(tmp_path, offset):
    write(tmp_path / "a.vtu", grid())
    moved = re.sub(rb'(<DataArray [^>]*Name="time"[^>]*offset=")\d+', lambda found: found[1] + str(offset).encode(),
                   (tmp_path / "a.vtu").read_bytes(), count=1)
    # offsets count from the underscore: those of the other arrays stay valid
    (tmp_path / "a.vtu").write_bytes(moved)
    done = launch(2, "order", tmp_path / "a.vtu", "--pieces", tmp_path / "out")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and "beyond the end" in done.stderr, done.stderr
    assert os.listdir(tmp_path) == ["a.vtu"]


@pytest.mark.parametrize("name, extension", [("blocks.msh", ".mesh"), ("arch.msh", ".vtu")])
def test_pieces_of_other_formats_have_the_numbers_of_the_output(tmp_path, name, extension):
    out = tmp_path / f"b{extension}"
    done = order(2, DATA / name, "-o", out, "--pieces", tmp_path / "out", "--parts", "5", "--json")
    subprocess.run([os.environ["MESHORDER"], "order", out, "-o", tmp_path / "same.vtu", "--vertices", "original", "--elements",
                    "original"], check=True, capture_output=True)
    # the pieces also have what Medit's files cannot hold
    whole = Grid(out if extension == ".vtu" else tmp_path / "same.vtu")
    assert_pieces_of(whole, tmp_path / "out", "b", json.loads(done.stdout), with_arrays=extension == ".vtu")


@pytest.mark.parametrize("stored", STORED)
def test_hexahedra_of_higher_order_keep_their_nodes(tmp_path, stored):
    """Lagrange hexahedra of 27 nodes, whose order depends on the version of the file."""
    numbers, rows = {}, []
    for x, y, z in numpy.ndindex(6, 2, 2):
        row = [0] * 27
        for i, j, k in numpy.ndindex(3, 3, 3):
            place = vtkHigherOrderHexahedron.PointIndexFromIJK(i, j, k, [2, 2, 2])
            row[place] = numbers.setdefault((2 * x + i, 2 * y + j, 2 * z + k), len(numbers))
        rows.append(row)
    made, points, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(convert.numpy_to_vtk(numpy.array(list(numbers), dtype=float), deep=True))
    made.SetPoints(points)
    cells.SetData(27, convert.numpy_to_vtkIdTypeArray(numpy.array(rows).ravel(), deep=True))
    made.SetCells(72, cells)
    write(tmp_path / "a.vtu", made, **STORED[stored])
    done = order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--pieces", tmp_path / "out", "--parts", "3", "--json")
    assert_pieces_of(Grid(tmp_path / "b.vtu"), tmp_path / "out", "b", json.loads(done.stdout))


def test_more_parts_than_vertices_leave_empty_pieces(tmp_path):
    write(tmp_path / "a.vtu", grid(points=25, cells=2, seed=3))
    done = order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--pieces", tmp_path / "out", "--parts", "12", "--json")
    starts = json.loads(done.stdout)["partition"]["first_vertices"]
    assert len(set(starts)) < 12
    whole, everything = Grid(tmp_path / "b.vtu"), Grid(tmp_path / "out" / "b.pvtu")
    assert len(os.listdir(tmp_path / "out")) == 13
    owned = everything.of_points["vtkGhostType"] == 0
    assert sorted(everything.of_points["GlobalPointIds"][owned].tolist()) == list(range(25))
    assert sorted(everything.of_cells["GlobalCellIds"][everything.of_cells["vtkGhostType"] == 0].tolist()) == [0, 1]
    assert (everything.points == whole.points[everything.of_points["GlobalPointIds"]]).all()


def test_fewer_pieces_than_before_leave_none_of_these(tmp_path):
    write(tmp_path / "a.vtu", grid())
    out = tmp_path / "out"
    order(2, tmp_path / "a.vtu", "--pieces", out, "--parts", "6")
    (out / "a_notes.vtu").write_text("another file")
    (out / "ab_0001.vtu").write_text("another file")
    order(2, tmp_path / "a.vtu", "--pieces", out, "--parts", "3")
    assert sorted(os.listdir(out)) == ["a.pvtu", "a_0000.vtu", "a_0001.vtu", "a_0002.vtu", "a_notes.vtu", "ab_0001.vtu"]
    assert re.findall('Source="(.*)"', (out / "a.pvtu").read_text()) == ["a_0000.vtu", "a_0001.vtu", "a_0002.vtu"]
    assert len(Grid(out / "a.pvtu").cells) > 900


@pytest.mark.parametrize("arguments, words", [
    ([], "there is nothing to write"),
    (["--pieces", "taken"], "taken/a_0001.vtu: has the name of a piece"),
    (["--pieces", "a.vtu"], "a.vtu: is not a folder"),
    (["--pieces", "out.pvtu"], "out.pvtu: --pieces expects a folder and not a file; give a name such as out; a.pvtu in it"),
    (["--pieces", "out.xdmf"], "out.xdmf: --pieces expects a folder"),
    (["--pieces", "out", "--parts", "1000"], "too few for 1,000 parts"),
    (["--pieces", "nowhere/out"], "nowhere"),
    (["--pieces", ""], "a folder is needed"),
    (["-o", "b.vtu", "--ghosts", "1"], "--pieces"),
    (["--pieces", "out", "--ghosts", "2"], "--ghosts"),
    (["--pieces", "out", "--vertices", "original"], "'original' within parts"),
    (["--pieces", "out", "-o", "out/a.vtu"], "out/a.vtu: its folder does not exist"),
    (["-o", "full.vtu", "--pieces", "out"], "full"),
])
def test_faults_leave_nothing(tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    write("a.vtu", grid())
    (tmp_path / "taken").mkdir()
    (tmp_path / "taken" / "a_0001.vtu").write_text("somebody's time step")
    os.symlink("/dev/full", "full.vtu")
    before = sorted(os.listdir())
    done = launch(3, "order", "a.vtu", *arguments)
    assert done.returncode == 2, done.stderr
    assert len(own_lines(done)) == 1 and words in own_lines(done)[0], done.stderr
    assert sorted(os.listdir()) == before and os.listdir("taken") == ["a_0001.vtu"]


def test_a_full_disk_leaves_the_old_pieces(tmp_path):
    folder = tmp_path / "small"
    folder.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=200k", "none", folder], capture_output=True, check=False).returncode:
        pytest.skip("needs the right to mount a file system")
    try:
        write(tmp_path / "a.vtu", grid(points=100, cells=100))
        order(2, tmp_path / "a.vtu", "--pieces", folder / "out", "--parts", "3")
        before = {name: (folder / "out" / name).read_bytes() for name in os.listdir(folder / "out")}
        write(tmp_path / "a.vtu", grid(points=2000, cells=4000))
        done = launch(3, "order", tmp_path / "a.vtu", "--pieces", folder / "out")
        assert done.returncode == 2, done.stderr
        assert len(own_lines(done)) == 1 and "a_000" in own_lines(done)[0], done.stderr
        assert before == {name: (folder / "out" / name).read_bytes() for name in os.listdir(folder / "out")}
        done = launch(3, "order", tmp_path / "a.vtu", "--pieces", folder / "new")
        assert done.returncode == 2 and os.listdir(folder) == ["out"], done.stderr
    finally:
        subprocess.run(["umount", folder], check=True)


@pytest.mark.parametrize("place", ["mixed", "last"])
def test_interfaces_follow_the_other_vertices_of_a_piece(tmp_path, ball, place):
    done = order(3, ball, "--pieces", tmp_path, "--parts", "4", "--interface", place, "--json")
    partition = json.loads(done.stdout)["partition"]
    assert partition["interface"] == place and len(partition["interface_vertices"]) == 4
    last = []
    for part, count in enumerate(partition["interface_vertices"]):
        piece = Grid(next(tmp_path.glob(f"*_{part:04}.vtu")))
        own = int((piece.of_points["vtkGhostType"] == 0).sum())
        interface = {v for _, row in piece.cells if max(row) >= own for v in row if v < own}
        assert 0 < len(interface) == count < own
        last.append(interface == set(range(own - count, own)))
    assert last == [place == "last"] * 4


def test_the_same_bits_on_every_number_of_ranks(tmp_path):
    write(tmp_path / "a.vtu", grid())
    for ranks in (1, 2, 5):
        order(ranks, tmp_path / "a.vtu", "--pieces", tmp_path / str(ranks), "--partition", "hilbert", "--parts", "4")
    for name in os.listdir(tmp_path / "1"):
        assert len({(tmp_path / str(ranks) / name).read_bytes() for ranks in (1, 2, 5)}) == 1
