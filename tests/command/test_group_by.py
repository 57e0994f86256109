# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""order --group-by: materials, regions and physical groups stay together in every format."""
import meshio
import numpy
import pytest

import meshes
from conftest import DATA


def runs(values):
    """The value of each run of equal values, in order."""
    values = numpy.asarray(values)
    return values[numpy.insert(values[1:] != values[:-1], 0, True)].tolist()


def smallest_at_vertices(vertices, cells, tags):
    """The smallest tag among the cells at each vertex."""
    smallest = numpy.full(vertices, numpy.iinfo(int).max)
    for corner in cells.T:
        numpy.minimum.at(smallest, corner, tags)
    return smallest


def layered_grid(command, folder, size=6):
    """A grid of three layers of tags 30, -4 and 7 in z, as a .vtu; its points, cells and tags."""
    made = command.json("models", "make", "grid", "--size", str(size))["models"][0]["path"]
    points, cells = meshes.read_tetgen(made)
    height = points[cells].mean(axis=1)[:, 2]
    layer = numpy.digitize(height, numpy.quantile(height, [1 / 3, 2 / 3]))
    tags = numpy.array([30, -4, 7])[layer]
    mesh = meshio.Mesh(points, [("tetra", cells)], cell_data={"tag": [tags], "height": [height]},
                       point_data={"zone": (points[:, 0] > points[:, 0].mean()).astype(int)})
    mesh.write(folder / "layers.vtu")
    return points, cells, tags


@pytest.mark.parametrize("vertices", ["auto", "fiedler", "rcm", "metis-rb", "original"])
def test_groups_are_contiguous_and_rise(command, tmp_path, vertices):
    points, cells, tags = layered_grid(command, tmp_path)
    result = command.json("order", "layers.vtu", "-o", "ordered.vtu", "--group-by", "tag", "--vertices", vertices)
    mesh = meshio.read(tmp_path / "ordered.vtu")
    new_cells, new_tags = mesh.cells[0].data, mesh.cell_data["tag"][0]
    assert runs(new_tags) == [-4, 7, 30]
    at_vertices = smallest_at_vertices(len(points), new_cells, new_tags)
    assert runs(at_vertices) == [-4, 7, 30]
    expected = smallest_at_vertices(len(points), cells, tags)
    groups = result["group_by"]["groups"]
    assert (result["group_by"]["name"], result["group_by"]["on"]) == ("tag", "cells")
    first = 0
    for group, value in zip(groups, [-4, 7, 30], strict=True):
        count = int((expected == value).sum())
        assert group == {"value": value, "first_vertex": first, "vertices": count, "cells": int((tags == value).sum())}
        assert (at_vertices[first:first + count] == value).all()
        first += count


def test_each_group_is_ordered_as_it_is_alone(command, tmp_path):
    points, cells, tags = layered_grid(command, tmp_path)
    command.ok("order", "layers.vtu", "-o", "ordered.vtu", "--group-by", "tag", "--vertices", "hilbert")
    ordered = meshio.read(tmp_path / "ordered.vtu")
    at_vertices = smallest_at_vertices(len(points), ordered.cells[0].data, ordered.cell_data["tag"][0])
    # tag -4 is the smallest and owns all of its vertices: the group is ordered like a mesh of its own
    chosen = cells[tags == -4]
    names, local = numpy.unique(chosen, return_inverse=True)
    meshio.Mesh(points[names], [("tetra", local.reshape(chosen.shape))]).write(tmp_path / "part.vtu")
    command.ok("order", "part.vtu", "-o", "part.vtu", "--vertices", "hilbert")
    assert (meshio.read(tmp_path / "part.vtu").points == ordered.points[at_vertices == -4]).all()


def test_a_vertex_array_groups_vertices(command, tmp_path):
    layered_grid(command, tmp_path)
    result = command.json("order", "layers.vtu", "-o", "ordered.vtu", "--group-by", "zone")
    assert runs(meshio.read(tmp_path / "ordered.vtu").point_data["zone"]) == [0, 1]
    assert result["group_by"]["on"] == "vertices"
    assert all(group["cells"] is None for group in result["group_by"]["groups"])


@pytest.mark.parametrize("extension", ["msh", "mesh", "node", "vtk"])
def test_labels_group_in_every_format(command, tmp_path, extension):
    meshes.write_tetgen(tmp_path)
    points, cells, tags = layered_grid(command, tmp_path)
    meshio.Mesh(points, [("tetra", cells)], cell_data={"label": [tags + 5]}).write(tmp_path / "labels.vtu")
    command.ok("order", "labels.vtu", "-o", f"labels.{extension}", "--vertices", "scrambled", "--elements", "scrambled")
    info = command.json("info", f"labels.{extension}")
    name = next((array["name"] for array in info["data"] if array["on"] == "cells"), "label")
    command.ok("order", f"labels.{extension}", "-o", f"grouped.{extension}", "--group-by", name)
    command.ok("order", f"grouped.{extension}", "-o", "back.vtu", "--vertices", "original", "--elements", "original")
    back = meshio.read(tmp_path / "back.vtu")
    new_tags = back.cell_data[name][0].ravel()
    assert len(runs(new_tags)) == 3
    assert len(runs(smallest_at_vertices(len(points), back.cells[0].data, new_tags))) == 3


def test_regions_of_vega_are_sets(command, tmp_path):
    points, cells, tags = layered_grid(command, tmp_path)
    meshio.Mesh(points, [("tetra", cells)], cell_data={"label": [tags + 5]}).write(tmp_path / "labels.vtu")
    command.ok("order", "labels.vtu", "-o", "labels.veg", "--elements", "scrambled")
    result = command.json("order", "labels.veg", "-o", "grouped.veg", "--group-by", "sets", "--maps", "m")
    names = {int(group["value"].split("_")[1]): group["cells"] for group in result["group_by"]["groups"]}
    assert names == {tag + 5: (tags == tag).sum() for tag in (-4, 7, 30)}
    command.ok("order", "grouped.veg", "-o", "back.vtu", "--vertices", "original", "--elements", "original")
    back = meshio.read(tmp_path / "back.vtu")
    places = [numpy.flatnonzero(marks[0].ravel()) for name, marks in back.cell_data.items() if "label_" in name]
    assert len(places) == 3
    for members in places:
        assert members[-1] - members[0] + 1 == len(members)


def test_regions_that_tetgen_writes_as_reals(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    text = (tmp_path / "mesh.ele").read_text().replace(" 10\n", " 2.0\n").replace(" 20\n", " 1.0\n")
    (tmp_path / "mesh.ele").write_text(text)
    name = command.json("info", "mesh.node")["data"]
    name = next(array["name"] for array in name if array["on"] == "cells")
    groups = command.json("order", "mesh.node", "-o", "new.node", "--group-by", name)["group_by"]["groups"]
    assert [(g["value"], g["vertices"]) for g in groups] == [(1, 4), (2, 1)]


def test_materials_of_a_real_mesh(command, tmp_path):
    source = DATA / "blocks.msh"
    result = command.json("order", source, "-o", "ordered.msh", "--group-by", "label", "--maps", "m")
    mesh = meshio.read(tmp_path / "ordered.msh")
    tags = numpy.concatenate(mesh.cell_data["gmsh:physical"])
    assert runs(tags) == [1, 2, 3] == [group["value"] for group in result["group_by"]["groups"]]
    assert "3 groups by label on cells: 1, 2, 3" in command.ok("order", source, "-o", "a.msh", "--group-by", "label").stdout
    command.ok("apply", "m", "ordered.msh", "-o", "back.msh", "--inverse")
    command.ok("order", source, "-o", "same.msh", "--vertices", "original", "--elements", "original")
    assert (tmp_path / "back.msh").read_bytes() == (tmp_path / "same.msh").read_bytes()


@pytest.mark.parametrize("name, words", [
    ("tags", ["'tags'", "tag on cells", "zone on vertices"]),
    ("height", ["'height' on cells", "whole number", "tag on cells"]),
    ("vertices:tag", ["'vertices:tag'", "tag on cells"]),
])
def test_what_cannot_group_is_refused_with_what_can(command, tmp_path, name, words):
    layered_grid(command, tmp_path)
    line = command.fails("order", "layers.vtu", "-o", "ordered.vtu", "--group-by", name)
    assert all(word in line for word in words), line
    assert not (tmp_path / "ordered.vtu").exists()
