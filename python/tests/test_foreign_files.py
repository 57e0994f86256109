# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files of formats that only meshio reads and writes."""

import subprocess
import sys

import meshio
import meshorder
import numpy as np
import pytest
from conftest import tetrahedra
from meshorder import InputError

FORMATS = {
    ".mdpa": "mdpa", ".f3grid": "flac3d", ".dat": "tecplot", ".post": "permas",
}  # fmt: skip


def made_by_meshio():
    points, cells = tetrahedra(3)
    half = len(cells) // 2
    return meshio.Mesh(
        points, [("tetra", cells[:half]), ("tetra", cells[half:])],
        point_data={"t": points[:, 0] + 2, "u": points * 3},
        cell_data={"m": [np.arange(half), np.arange(half, len(cells))]},
        point_sets={"left": np.flatnonzero(points[:, 0] == 0)},
        cell_sets={"some": [np.arange(5), np.arange(3)]},
    )  # fmt: skip


def bare():
    points, cells = tetrahedra(3)
    return meshio.Mesh(points, [("tetra", cells)])


def volumes(points, cells):
    a, b, c, d = (points[cells[:, k]] for k in range(4))
    return np.sort(np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)))


@pytest.mark.parametrize("suffix", FORMATS)
def test_bare_meshes_of_every_format(tmp_path, suffix):
    given = bare()
    given.write(tmp_path / f"mesh{suffix}", file_format=FORMATS[suffix])
    mesh = meshorder.read(tmp_path / f"mesh{suffix}")
    assert mesh.notes[0].startswith(f"read by meshio {meshio.__version__} as {FORMATS[suffix]}: ")
    np.testing.assert_allclose(mesh.points, given.points, atol=1e-6)
    found, expected = mesh.connectivity.reshape(-1, 4), given.cells[0].data
    if suffix == ".f3grid":  # meshio may reverse the cells, whose orientation FLAC3D prescribes
        found, expected = np.sort(found), np.sort(expected)
    np.testing.assert_array_equal(found, expected)
    moved, order = meshorder.reorder(mesh, vertices="rcm")
    notes = meshorder.write(moved, tmp_path / f"moved{suffix}")
    assert notes[0] == f"written by meshio {meshio.__version__} as {FORMATS[suffix]}"
    read = meshio.read(tmp_path / f"moved{suffix}")
    np.testing.assert_allclose(read.points, given.points[order.vertices.new_to_old], atol=1e-6)
    found = read.get_cells_type("tetra")
    np.testing.assert_allclose(volumes(read.points, found), volumes(given.points, given.cells[0].data), atol=1e-6)


@pytest.mark.parametrize(
    "suffix, kept",
    [(".hmf", {"point t", "point u", "cell m"}), (".post", set())],
)  # fmt: skip
def test_what_a_format_keeps_is_read_and_the_rest_is_reported(tmp_path, suffix, kept):
    given = made_by_meshio()
    mesh = meshorder.make_mesh(given)
    assert mesh.notes == [] and set(mesh.sets) == {"left", "some"}
    np.testing.assert_array_equal(mesh.sets["some"], [0, 1, 2, 3, 4, 81, 82, 83])
    notes = meshorder.write(mesh, tmp_path / f"mesh{suffix}")
    read = meshorder.read(tmp_path / f"mesh{suffix}")
    kinds = {"point": read.point_data, "cell": read.cell_data, "set": read.sets}
    found = {f"{kind} {name}" for kind, names in kinds.items() for name in names}
    everything = {"point t", "point u", "cell m", "set left", "set some"}
    assert found & everything == kept
    for name in everything - kept:
        assert any(f"'{name.split()[1]}'" in note for note in notes[1:])
    for name in kept:
        assert not any(f"'{name.split()[1]}'" in note for note in notes)
    if "point t" in kept:
        np.testing.assert_allclose(read.point_data["t"], read.points[:, 0] + 2)
    if "set left" in kept:
        assert (read.points[read.sets["left"], 0] == 0).all() and len(read.sets["left"]) == 16


def test_second_order_cells_there_and_back(tmp_path):
    edges = np.array([(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)])
    corners = np.vstack([np.zeros(3), np.eye(3)])
    points = np.concatenate([corners, corners[edges].mean(axis=1)])
    given = meshio.Mesh(points, [("tetra10", [np.arange(10)])])
    given.write(tmp_path / "mesh.mdpa")
    mesh = meshorder.read(tmp_path / "mesh.mdpa")
    assert [(shape, rows.shape[1]) for shape, rows in mesh.cells] == [("tetrahedron", 10)]
    meshorder.write(mesh, tmp_path / "again.mdpa")
    read = meshio.read(tmp_path / "again.mdpa")
    assert [block.type for block in read.cells] == ["tetra10"]
    np.testing.assert_array_equal(read.cells[0].data, given.cells[0].data)


def test_mixed_cells_are_grouped_and_reported(tmp_path):
    points = np.random.default_rng(1).random((8, 3))
    cells = (np.array([0, 4, 7, 11]), np.array([0, 1, 2, 3, 0, 1, 2, 4, 5, 6, 7]), np.array([10, 5, 10]))
    notes = meshorder.write(meshorder.make_mesh(points, cells), tmp_path / "mixed.mdpa")
    assert "cells were grouped by type" in notes
    assert [block.type for block in meshio.read(tmp_path / "mixed.mdpa").cells] == ["tetra", "triangle"]


def test_what_a_mesh_cannot_hold_is_reported():
    given = bare()
    given.point_data["wave"] = given.points[:, 0] * 1j
    given.point_data["stress"] = np.zeros((len(given.points), 3, 3))
    given.field_data["time"] = np.array([1.0])
    given.cell_sets = {"repeated": [np.array([3, 1, 3])]}
    mesh = meshorder.make_mesh(given)
    assert sum("'wave'" in note for note in mesh.notes) == 1 and sum("'time'" in note for note in mesh.notes) == 1
    assert mesh.point_data["stress"].shape == (64, 9)
    np.testing.assert_array_equal(mesh.sets["repeated"], [3, 1])


def test_meshes_of_other_libraries_are_written(tmp_path):
    given = made_by_meshio()
    given.point_data["wave"] = given.points[:, 0] * 1j
    notes = meshorder.write(given, tmp_path / "mesh.vtu")
    assert "'wave'" in notes[0]
    assert set(meshio.read(tmp_path / "mesh.vtu").point_data) >= {"t", "u"}
    assert meshorder.write((given.points, {"tetra": given.get_cells_type("tetra")}), tmp_path / "bare.mesh") == []
    assert b"Tetrahedra" in meshorder.to_bytes(given, "medit")
    with pytest.raises(meshorder.InvalidArgument):
        meshorder.write(5, tmp_path / "mesh.vtu")


@pytest.mark.parametrize("suffix", [".mdpa", ".h5m"])
def test_broken_files_are_input_errors(tmp_path, suffix, capsys):
    with pytest.raises(InputError, match="No such file"):
        meshorder.read(tmp_path / f"missing{suffix}")
    (tmp_path / f"bad{suffix}").write_text("*ELEMENT, TYPE=C3D4\n1, nothing\nGRID,a,b\n<Xdmf>NDIME= x")
    with pytest.raises(meshorder.Error) as caught:
        meshorder.read(tmp_path / f"bad{suffix}")
    assert f"bad{suffix}" in str(caught.value) and "meshio" in str(caught.value)
    assert capsys.readouterr() == ("", "")


def test_cells_that_meshio_lacks(tmp_path):
    polyline = meshorder.make_mesh(np.eye(3), (np.array([0, 3]), np.arange(3), np.array([4])))
    with pytest.raises(InputError, match="polyline"):
        meshorder.write(polyline, tmp_path / "line.mdpa")
    with pytest.raises(InputError):
        meshorder.write(meshorder.make_mesh(*tetrahedra(2)), tmp_path / "mesh.stp")


def test_formats_may_be_named(tmp_path):
    bare().write(tmp_path / "mesh.data", file_format="avsucd")
    assert "avsucd" in meshorder.read(tmp_path / "mesh.data", "avsucd").notes[0]
    with pytest.raises(meshorder.Error):
        meshorder.read(tmp_path / "mesh.data", "no format")
    with pytest.raises(InputError):
        meshorder.read(tmp_path / "mesh.data")


def test_without_meshio_the_error_names_it(tmp_path):
    program = """
import sys
sys.modules["meshio"] = None  # as if it were not there
import meshorder
try:
    meshorder.read("part.mdpa")
except meshorder.InputError as error:
    print(error)
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "pip install meshio" in ended.stdout and "part.mdpa" in ended.stdout
