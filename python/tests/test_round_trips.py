# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Random meshes through files: they come back unchanged, or a note of the writer names what it left out.

HYPOTHESIS_PROFILE=default tries other examples; the marker `long` tries more of them.
"""

import tempfile
from pathlib import Path
from typing import Any

import meshio
import meshorder
import numpy as np
import pytest
import round_trip
from hypothesis import HealthCheck, given, note, settings
from hypothesis import strategies as st
from random_meshes import TYPES, meshes, odd_names, plain_names

gmsh = pytest.importorskip("gmsh")
pytest.importorskip("vtk")
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader  # noqa: E402
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader  # noqa: E402

SUFFIXES = {name: extensions[0] for name, extensions, _ in meshorder._core.formats()}
#: STL keeps no vertices, the formats of matrices and graphs keep no coordinates
ALMOST_EMPTY = {"stl", "matrixmarket", "metis"}
FORMATS = [name for name in SUFFIXES if name not in ALMOST_EMPTY]
unwatched = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.function_scoped_fixture]
quickly = settings(deadline=None, max_examples=20, suppress_health_check=unwatched)
thoroughly = settings(quickly, max_examples=1000)


def through(mesh, *formats):
    """Passes the mesh through a file of each format. Returns None if a format refuses it; fails if a loss has no note."""
    with tempfile.TemporaryDirectory() as folder:
        for k, name in enumerate(formats):
            made = round_trip.hop(mesh, Path(folder) / f"{k}{SUFFIXES[name]}")
            if made is None:
                return None
            after, silent = made
            assert not silent, f"{' → '.join(formats[: k + 1])}: {silent}"
            mesh = after
    return mesh


@pytest.mark.parametrize("name", FORMATS)
@quickly
@given(mesh=meshes())
def test_losses_are_announced(name, mesh):
    through(mesh, name)


@pytest.mark.long
@pytest.mark.parametrize("name", FORMATS)
@settings(quickly, max_examples=200)
@given(mesh=meshes(names=odd_names, types=[kind for kind in TYPES if kind[0] in ("triangle", "tetrahedron")]))
def test_names_come_back_or_are_announced(name, mesh):
    through(mesh, name)


@pytest.mark.parametrize("source", FORMATS)
@settings(quickly, max_examples=3)
@given(mesh=meshes())
def test_pairs_of_formats(source, mesh):
    first = through(mesh, source)
    if first is not None:
        for target in FORMATS:
            note(target)
            through(first, target)


def two_tetrahedra():
    points = np.arange(24).reshape(8, 3) + np.eye(8, 3)
    return meshorder.make_mesh(points, {"tetrahedron": np.arange(8).reshape(2, 4)})


def test_med_names_the_sets_without_members(tmp_path):
    mesh = two_tetrahedra()
    mesh._handle.add_set("nothing", False, np.array([], dtype="i4"))
    notes = meshorder.write(mesh, tmp_path / "mesh.med")
    assert notes == ["the set 'nothing' of cells is not written: it has no members"]


def test_gmsh_says_when_an_entity_is_parted(tmp_path):
    mesh = two_tetrahedra()
    mesh._handle.add_data("gmsh:geometrical", False, np.array([5, 5], dtype="i4"))
    assert meshorder.write(mesh, tmp_path / "whole.msh") == []
    mesh._handle.add_set("one", False, np.array([1], dtype="i4"))
    notes = meshorder.write(mesh, tmp_path / "parted.msh")
    assert len(notes) == 1 and "'gmsh:geometrical' is written with new numbers" in notes[0]


def written(mesh, path):
    """The notes of the writer, or None where it refuses the mesh."""
    try:
        return meshorder.write(mesh, path)
    except meshorder.InputError:
        return None


def grid_by_vtk(path):
    reader: Any = vtkXMLUnstructuredGridReader() if path.suffix == ".vtu" else vtkUnstructuredGridReader()
    if path.suffix == ".vtk":
        reader.ReadAllScalarsOn()
        reader.ReadAllVectorsOn()
        reader.ReadAllTensorsOn()
        reader.ReadAllFieldsOn()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


@pytest.mark.parametrize("suffix", [".vtu", ".vtk"])
@settings(quickly, max_examples=25)
@given(mesh=meshes())
def test_vtk_reads_the_same(suffix, mesh):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"mesh{suffix}"
        notes = written(mesh, path)
        if notes is None:
            return
        grid = grid_by_vtk(path)
    assert grid.GetNumberOfCells() == len(mesh.shapes)
    assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), mesh.points)
    changes = round_trip.Changes(notes)
    for (name, of_vertices), (values, rows) in round_trip.arrays_of(mesh).items():
        array = (grid.GetPointData() if of_vertices else grid.GetCellData()).GetAbstractArray(name)
        if len(rows) == 0 and not (array and round_trip.same_numbers(values, vtk_to_numpy(array))):
            changes.of_name(f"VTK finds another array {name!r}", name)
    assert not changes.silent


@settings(quickly, max_examples=40)
@given(mesh=meshes(names=plain_names, finite=True))
def test_gmsh_reads_the_same(model, mesh):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.msh"
        notes = written(mesh, path)
        if notes is None:
            return
        gmsh.clear()
        gmsh.open(str(path))
    tags, places, _ = model.mesh.getNodes()
    points = dict(zip(tags.tolist(), places.reshape(-1, 3).tolist()))
    numbers = mesh.vertex_ids.tolist() or range(1, len(mesh.points) + 1)
    used = set(mesh.connectivity.tolist())
    assert all(points[numbers[v]] == mesh.points[v].tolist() for v in used)
    _, elements, _ = model.mesh.getElements()
    lost = any("left out" in note for note in notes)
    kinds = set(zip(mesh.shapes.tolist(), np.diff(mesh.offsets).tolist()))
    if len(dict(kinds)) < len(kinds):
        return  # Gmsh lists the cells of one shape and one order
    assert lost or sum(map(len, elements)) == len(mesh.shapes)


@pytest.mark.parametrize("suffix", [".mesh", ".su2", ".inp", ".obj"])
@settings(quickly, max_examples=10)
@given(mesh=meshes(types=[("triangle", 3), ("tetrahedron", 4), ("hexahedron", 8), ("quad", 4)], finite=True))
def test_meshio_finds_the_same_cells(suffix, mesh):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"mesh{suffix}"
        notes = written(mesh, path)
        if notes is None or (suffix == ".su2" and "MARKER_ELEMS= 0" in path.read_text()):
            return  # meshio cannot read markers without elements
        found = meshio.read(path)
    lost = sum("left out" in one for one in notes)
    assert lost or sum(len(block.data) for block in found.cells) == len(mesh.shapes)
    assert len(found.points) == len(mesh.points)


@pytest.mark.long
@pytest.mark.parametrize("source", FORMATS)
@thoroughly
@given(mesh=meshes(names=st.one_of(plain_names, odd_names)), targets=st.lists(st.sampled_from(FORMATS), max_size=3))
def test_chains_of_formats(source, mesh, targets):
    through(mesh, source, *targets)
