# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The pieces that a .pvtu file lists are read as one mesh."""
import meshio
import numpy
import pytest

#: two tetrahedra with a common triangle. Each is in a piece of its own, and a ghost cell in the other piece. Ids are
#: the numbers in the whole mesh
POINTS = numpy.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)], float)
CELLS = [(0, 1, 2, 3), (1, 2, 3, 4)]
OWNERS = [0, 0, 1, 1, 1]


def data_array(name, kind, values, components=1):
    words = " ".join(str(value) for value in numpy.asarray(values).ravel().tolist())
    return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">{words}</DataArray>'


def write_piece(path, points, cells, point_arrays=(), cell_arrays=(), version="1.0"):
    rows = "\n".join([
        f'<VTKFile type="UnstructuredGrid" version="{version}" byte_order="LittleEndian" header_type="UInt64">',
        f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">',
        "<PointData>", *point_arrays, "</PointData><CellData>", *cell_arrays, "</CellData>",
        "<Points>", data_array("Points", "Float64", points, 3), "</Points><Cells>",
        data_array("connectivity", "Int64", cells), data_array("offsets", "Int64", 4 * numpy.arange(1, len(cells) + 1)),
        data_array("types", "UInt8", [10] * len(cells)), "</Cells></Piece></UnstructuredGrid></VTKFile>"])
    path.write_text(rows)


def write_list(path, pieces):
    listed = "".join(f'<Piece Source="{piece}"/>' for piece in pieces)
    path.write_text('<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian">'
                    f'<PUnstructuredGrid GhostLevel="1">{listed}</PUnstructuredGrid></VTKFile>')


def write_pieces(folder, ids=(True, True), ghosts=True, moved=0.0, first_id=0):
    """Writes both pieces and their list. `ids`: whether points and whether cells have ids."""
    folder.mkdir(exist_ok=True)
    for part in (0, 1):
        cells = [part, 1 - part] if ghosts else [part]
        numbers = sorted({v for c in cells for v in CELLS[c]}, key=lambda v: (OWNERS[v] != part, v))
        point_arrays = [data_array("height", "Float64", [10 + v if OWNERS[v] == part else -1 for v in numbers])]
        cell_arrays = [data_array("cell", "Int32", cells)]
        if ids[0]:
            point_arrays.append(data_array("GlobalPointIds", "Int64", [first_id + v for v in numbers]))
        if ids[1]:
            cell_arrays.append(data_array("GlobalCellIds", "Int64", cells))
        if ghosts:
            point_arrays.append(data_array("vtkGhostType", "UInt8", [int(OWNERS[v] != part) for v in numbers]))
            cell_arrays.append(data_array("vtkGhostType", "UInt8", [int(c != part) for c in cells]))
        points = POINTS[numbers] + part * moved
        write_piece(folder / f"p{part}.vtu", points, [[numbers.index(v) for v in CELLS[c]] for c in cells], point_arrays, cell_arrays)
    write_list(folder / "all.pvtu", ["p0.vtu", "p1.vtu"])


def read_whole(command, name="pieces/all.pvtu"):
    command.ok("order", name, "-o", "whole.vtu", "--vertices", "original", "--elements", "original")
    return meshio.read(command.folder / "whole.vtu")


@pytest.mark.parametrize("ghosts", [True, False])
def test_points_of_one_id_are_one_and_ghosts_are_left_out(command, tmp_path, ghosts):
    write_pieces(tmp_path / "pieces", ghosts=ghosts)
    mesh = read_whole(command)
    assert numpy.array_equal(mesh.points, POINTS)
    assert mesh.cells[0].data.tolist() == [list(cell) for cell in CELLS]
    assert mesh.cell_data["cell"][0].tolist() == [0, 1]
    assert set(mesh.point_data) == {"height"} and set(mesh.cell_data) == {"cell"}
    if ghosts:  # the values of the owners
        assert mesh.point_data["height"].tolist() == [10, 11, 12, 13, 14]
    info = command.json("info", "pieces/all.pvtu")
    assert info["format"] == "VTU" and info["vertices"] == 5 and sum(info["cells"].values()) == 2


def test_other_marks_than_those_of_copies_stay(command, tmp_path):
    write_pieces(tmp_path / "pieces")
    piece = tmp_path / "pieces" / "p0.vtu"
    hidden = data_array("vtkGhostType", "UInt8", [0, 1])
    assert hidden in piece.read_text()
    piece.write_text(piece.read_text().replace(hidden, data_array("vtkGhostType", "UInt8", [32, 1])))
    assert read_whole(command).cell_data["vtkGhostType"][0].tolist() == [32, 0]


def test_ids_that_are_no_places_stay(command, tmp_path):
    write_pieces(tmp_path / "pieces", first_id=7)
    mesh = read_whole(command)
    assert mesh.point_data["GlobalPointIds"].tolist() == [7, 8, 9, 10, 11]


def test_without_ids_points_on_borders_stay_several(command, tmp_path):
    write_pieces(tmp_path / "pieces", ids=(False, False))
    done = command.ok("order", "pieces/all.pvtu", "-o", "whole.vtu", "--vertices", "original", "--elements", "original")
    assert "no global ids" in done.stderr
    mesh = meshio.read(tmp_path / "whole.vtu")
    assert len(mesh.points) == 8 and mesh.cell_data["cell"][0].tolist() == [0, 1]
    assert numpy.array_equal(mesh.points[mesh.cells[0].data], POINTS[CELLS])


def test_some_of_the_pieces_are_a_mesh(command, tmp_path):
    write_pieces(tmp_path / "pieces")
    write_list(tmp_path / "pieces" / "all.pvtu", ["p1.vtu"])
    mesh = read_whole(command)
    assert numpy.array_equal(mesh.points[mesh.cells[0].data], POINTS[[CELLS[1]]])
    assert mesh.point_data["GlobalPointIds"].tolist() == [1, 2, 3, 4]


def listing(pieces):
    return lambda folder: write_list(folder / "all.pvtu", pieces)


def second_piece(**changes):
    def write(folder):
        cell_arrays = [data_array("cell", "Int32", [1]), data_array("GlobalCellIds", "Int64", [changes.get("cell_id", 1)])]
        ids = [data_array("GlobalPointIds", "Int64", changes.get("ids", [1, 2, 3, 4]))]
        heights = [] if changes.get("no_heights") else [data_array("height", "Float64", [0] * 4)]
        write_piece(folder / "p1.vtu", POINTS[[1, 2, 3, 4]], [[0, 1, 2, 3]], heights + ids, cell_arrays,
                    changes.get("version", "1.0"))
    return write


@pytest.mark.parametrize("spoil, words", [
    (listing([]), ["all.pvtu", "lists no pieces"]),
    (listing(["p0.vtu", "p7.vtu"]), ["all.pvtu", "p7.vtu", "does not exist"]),
    (listing(["../secret.vtu"]), ["secret.vtu", "not in the folder"]),
    (listing(["all.pvtu"]), ["all.pvtu", "UnstructuredGrid"]),
    (lambda folder: (folder / "p1.vtu").write_text("<VTKFile"), ["p1.vtu"]),
    (lambda folder: write_pieces(folder, moved=0.5), ["all.pvtu", "the global id 1 has two positions"]),
    (second_piece(cell_id=0), ["all.pvtu", "two cells have the global id 0"]),
    (second_piece(ids=[-1, 2, 3, 4]), ["all.pvtu", "a point has the global id -1"]),
    (second_piece(no_heights=True), ["all.pvtu", "'height' is missing in a piece"]),
    (second_piece(version="2.2"), ["p1.vtu", "only one has a version below 2.1"]),
])
def test_faults_of_pieces_are_reported(command, tmp_path, spoil, words):
    write_pieces(tmp_path / "pieces", ghosts=False)
    (tmp_path / "secret.vtu").write_text("secret")
    spoil(tmp_path / "pieces")
    message = command.fails("order", "pieces/all.pvtu", "-o", "whole.vtu")
    assert all(word in message for word in words), message
    assert not (tmp_path / "whole.vtu").exists()


def test_pieces_elsewhere_are_read_where_that_is_allowed(command, tmp_path):
    write_pieces(tmp_path / "pieces")
    (tmp_path / "lists").mkdir()
    write_list(tmp_path / "lists" / "all.pvtu", ["../pieces/p0.vtu", "../pieces/p1.vtu"])
    assert "--allow-includes-from" in command.fails("info", "lists/all.pvtu")
    assert command.json("info", "lists/all.pvtu", "--allow-includes-from", "pieces")["vertices"] == 5


def test_one_mesh_is_not_written_as_a_list(command, tmp_path):
    write_pieces(tmp_path / "pieces")
    for words in ("order", "pieces/all.pvtu"), ("apply", "m", "pieces/all.pvtu"):
        assert "--pieces FOLDER" in command.fails(*words, "-o", "out.pvtu")
    assert not (tmp_path / "out.pvtu").exists()
