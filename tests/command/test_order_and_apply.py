# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""An ordered mesh is the same mesh, with all its data and sets, and the order can be undone."""
import itertools
import json
import os
import re
import shutil
import subprocess
import time

import meshio
import numpy
import pytest

import conftest
import meshes


def load(folder, prefix, what):
    return (numpy.load(folder / f"{prefix}.{what}.old_to_new.npy"), numpy.load(folder / f"{prefix}.{what}.new_to_old.npy"))


@pytest.mark.parametrize("name, extension", [("ball.msh", ".msh"), ("blocks.msh", ".msh"), ("arch.msh", ".veg"),
                                             ("ring.node", ".node")])
def test_inverse_gives_the_file_back(command, tmp_path, name, extension):
    source = conftest.DATA / name
    if source.suffix != extension:
        source = tmp_path / f"source{extension}"
        command.ok("order", conftest.DATA / name, "-o", source, "--vertices", "scrambled")
    command.ok("order", source, "-o", f"ordered{extension}", "--maps", "m")
    command.ok("apply", "m", f"ordered{extension}", "-o", f"back{extension}", "--inverse")
    # meshorder's file of the unchanged mesh, to compare byte by byte
    command.ok("order", source, "-o", f"same{extension}", "--vertices", "original", "--elements", "original")
    for suffix in {extension, ".ele", ".face"} if extension == ".node" else {extension}:
        assert (tmp_path / f"back{suffix}").read_bytes() == (tmp_path / f"same{suffix}").read_bytes()
    command.ok("apply", "m", source, "-o", f"again{extension}")
    assert (tmp_path / f"again{extension}").read_bytes() == (tmp_path / f"ordered{extension}").read_bytes()


def numbered_points(path):
    """The points of a Gmsh 4.1 file by their numbers."""
    lines = iter(path.read_text().split("$Nodes\n")[1].split("$EndNodes")[0].splitlines())
    points = {}
    for _ in range(int(next(lines).split()[0])):
        count = int(next(lines).split()[3])
        numbers = [int(next(lines)) for _ in range(count)]
        points.update((number, tuple(map(float, next(lines).split()[:3]))) for number in numbers)
    return points


def numbered_cells(path):
    """The vertices of a Gmsh 4.1 file's cells by the cells' numbers."""
    lines = iter(path.read_text().split("$Elements\n")[1].split("$EndElements")[0].splitlines())
    cells = {}
    for _ in range(int(next(lines).split()[0])):
        for _ in range(int(next(lines).split()[3])):
            number, *vertices = map(int, next(lines).split())
            cells[number] = vertices
    return cells


def test_ids_stay_with_their_vertices_and_cells(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    command.ok("order", "mesh.node", "-o", "a.msh", "--vertices", "original", "--elements", "original")
    command.ok("order", "a.msh", "-o", "kept.msh", "--vertices", "scrambled", "--elements", "scrambled", "--ids", "keep")
    points = numbered_points(tmp_path / "a.msh")
    kept = numbered_points(tmp_path / "kept.msh")
    assert kept == points and list(kept) != list(points)
    assert numbered_cells(tmp_path / "kept.msh") == numbered_cells(tmp_path / "a.msh")
    command.ok("order", "a.msh", "-o", "sorted.msh", "--vertices", "scrambled", "--elements", "scrambled")
    assert list(numbered_points(tmp_path / "sorted.msh")) == list(points)


def test_old_ids_are_attached_as_arrays(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    command.ok("order", "mesh.node", "-o", "a.vtu", "--vertices", "scrambled", "--elements", "scrambled", "--seed", "3",
               "--ids", "attach", "--maps", "m")
    mesh = meshio.read(tmp_path / "a.vtu")
    assert (mesh.point_data["original"] == load(tmp_path, "m", "vertices")[1]).all()
    command.fails("order", "a.vtu", "-o", "b.vtu", "--ids", "attach")
    command.fails("order", "mesh.node", "-o", "b.node", "--ids", "keep")
    assert not (tmp_path / "b.node").exists()


def write_interleaved(path):
    """Tetrahedra in a row, each followed by one of its triangles: formats that group cells have to move them."""
    points = numpy.array([[i // 2, i % 2, (i // 3) % 2 + 0.1 * i] for i in range(12)], dtype=float)
    cells = []
    for i in range(9):
        cells += [("tetra", numpy.array([[i, i + 1, i + 2, i + 3]])), ("triangle", numpy.array([[i, i + 1, i + 2]]))]
    meshio.write(path, meshio.Mesh(points, cells))


def cells_in_order(path):
    return [tuple(cell) for block in meshio.read(path).cells for cell in block.data]


def test_maps_serve_between_formats_that_group_cells_and_others(command, tmp_path):
    write_interleaved(tmp_path / "a.vtu")
    command.ok("order", "a.vtu", "-o", "b.msh", "--vertices", "scrambled", "--elements", "scrambled", "--maps", "m")
    command.ok("apply", "m", "a.vtu", "-o", "c.msh")
    assert (tmp_path / "c.msh").read_bytes() == (tmp_path / "b.msh").read_bytes()
    command.ok("apply", "m", "b.msh", "-o", "d.vtu", "--inverse")
    assert cells_in_order(tmp_path / "d.vtu") == cells_in_order(tmp_path / "a.vtu")
    assert (meshio.read(tmp_path / "d.vtu").points == meshio.read(tmp_path / "a.vtu").points).all()


def test_apply_treats_ids_as_order_did(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    command.ok("order", "mesh.node", "-o", "a.msh", "--vertices", "original", "--elements", "original")
    for ids in ("keep", "attach", "renumber"):
        command.ok("order", "a.msh", "-o", "b.msh", "--vertices", "scrambled", "--ids", ids, "--maps", "m")
        command.ok("apply", "m", "a.msh", "-o", "c.msh", "--ids", ids)
        assert (tmp_path / "c.msh").read_bytes() == (tmp_path / "b.msh").read_bytes()
    command.fails("apply", "m", "b.msh", "-o", "c.msh", "--inverse", "--ids", "keep")
    command.fails("apply", "m", "a.msh", "-o", "c.node", "--ids", "keep")


def write_boxes(folder):
    """Writes a mesh of tetrahedra that other formats can hold, in scrambled order, and the same mesh with moved points."""
    axis = numpy.arange(4.0)
    points = numpy.array([[x, y, z] for x in axis for y in axis for z in axis])
    corner = [16 * x + 4 * y + z for x in range(3) for y in range(3) for z in range(3)]
    cells = numpy.array([[c, c + 16, c + 20, c + 21] for c in corner])
    meshio.write(folder / "a.vtu", meshio.Mesh(points, [("tetra", cells)]))
    meshio.write(folder / "moved.vtu", meshio.Mesh(points + 0.1 * points[:, ::-1] ** 2, [("tetra", cells)]))
    other = numpy.array([[c, c + 16, c + 20, c + 21] for c in corner[::-1]])
    meshio.write(folder / "other.vtu", meshio.Mesh(points, [("tetra", other)]))


def write_groups(path, side=14):
    """A square of triangles in OBJ, in four groups, one after the other."""
    rows, half = range(side), side // 2
    lines = [f"v {x} {y} 0" for x in range(side + 1) for y in range(side + 1)]
    for group in range(4):
        lines.append(f"g part{group}")
        for x, y in itertools.product(rows, rows):
            if 2 * (x >= half) + (y >= half) == group:
                a = x * (side + 1) + y + 1
                lines += [f"f {a} {a + side + 1} {a + side + 2}", f"f {a} {a + side + 2} {a + 1}"]
    path.write_text("\n".join(lines) + "\n")


def test_groups_of_obj_stay_together_also_in_meshes_from_other_files(command, tmp_path):
    write_groups(tmp_path / "a.obj")

    def groups(name):
        return sum(line.startswith("g ") for line in (tmp_path / name).read_text().splitlines())

    for elements in ("lexmax", "scrambled", "original"):
        command.ok("order", "a.obj", "-o", "b.obj", "--vertices", "rcm", "--elements", elements)
        assert groups("b.obj") == 4
    command.ok("order", "a.obj", "-o", "a.msh", "--vertices", "rcm", "--elements", "lexmax")
    for elements in ("lexmax", "original"):
        command.ok("order", "a.msh", "-o", "c.obj", "--vertices", "original", "--elements", elements)
        assert groups("c.obj") == 4


def test_arrays_that_obj_does_not_hold_move_no_faces(command, tmp_path):
    write_groups(tmp_path / "a.obj")
    given = meshio.read(tmp_path / "a.obj")
    for name in ("other", "smoothing", "object"):
        values = numpy.arange(len(given.cells[0].data)) % 7
        meshio.write(tmp_path / f"{name}.vtu", meshio.Mesh(given.points, [given.cells[0]], cell_data={name: [values]}))
        command.ok("order", f"{name}.vtu", "-o", f"{name}.obj", "--vertices", "rcm", "--elements", "lexmax")
        assert (tmp_path / f"{name}.obj").read_bytes() == (tmp_path / "other.obj").read_bytes()


def test_files_do_not_hold_when_they_were_written(command, tmp_path):
    """Only CGNS files do: the library writes the time into every node."""
    write_boxes(tmp_path)
    extensions = ["vtu", "vtk", "msh", "node", "mesh", "veg", "su2", "xdmf", "med", "vtkhdf", "e", "bdf", "inp"]
    written = []
    for wait in (0, 1.1):  # HDF5 counts whole seconds
        time.sleep(wait)
        for extension in extensions:
            command.ok("order", "a.vtu", "-o", f"c.{extension}")
        written.append({path.name: path.read_bytes() for path in tmp_path.glob("c.*")})
    assert len(written[0]) == len(extensions) + 2  # the .ele of TetGen and the .h5 of XDMF
    assert [name for name in written[0] if written[1][name] != written[0][name]] == []


@pytest.mark.parametrize("output, others", [("b.vtu", []), ("b.node", ["b.ele"]), ("b.ele", ["b.node"]), ("b.xdmf", ["b.h5"])])
def test_all_written_files_are_named(command, tmp_path, output, others):
    write_boxes(tmp_path)
    files = [output, *others]
    before = set(tmp_path.iterdir())
    *_, line, first_map = command.ok("order", "a.vtu", "-o", output, "--maps", "m").stdout.splitlines()[:-4]
    ordered = command.json("order", "a.vtu", "-o", output, "--maps", "m")
    assert ordered["output"] == output and ordered["files"] == files
    assert {path.name for path in set(tmp_path.iterdir()) - before} == {*files, *ordered["maps"]}
    assert line.split() == ["wrote", *", ".join(files).split()] and first_map.split() == ordered["maps"][:1]
    applied = command.ok("apply", "m", output, "-o", f"c{output[1:]}", "--inverse").stdout
    assert applied.startswith(f"wrote {', '.join(files).replace('b.', 'c.')}: ")
    assert command.json("apply", "m", output, "-o", f"c{output[1:]}", "--inverse")["files"] == \
        [f"c{name[1:]}" for name in files]


@pytest.mark.parametrize("extension", ["vtu", "vtk", "msh", "node", "mesh", "veg", "su2", "xdmf", "cgns", "med", "vtkhdf"])
def test_maps_know_whether_they_were_applied(command, tmp_path, extension):
    write_boxes(tmp_path)
    made = command.json("order", "a.vtu", "-o", f"b.{extension}", "--vertices", "rcm", "--maps", "m")["maps"]
    assert made[-1] == "m.maps.json"
    line = command.fails("apply", "m", f"b.{extension}", "-o", "c.vtu")
    assert "is already in the new order" in line and "--inverse" in line
    line = command.fails("apply", "m", "a.vtu", "-o", "c.vtu", "--inverse")
    assert "is already in its old order" in line and "leave out --inverse" in line
    for inverse in ([], ["--inverse"]):
        assert "is not the mesh that the maps were written for" in \
            command.fails("apply", "m", "other.vtu", "-o", "c.vtu", *inverse)
    assert not (tmp_path / "c.vtu").exists()
    command.ok("apply", "m", f"b.{extension}", "-o", "back.vtu", "--inverse")
    assert cells_in_order(tmp_path / "back.vtu") == cells_in_order(tmp_path / "a.vtu")
    command.ok("apply", "m", "a.vtu", "-o", "c.vtu")
    command.ok("apply", "m", "moved.vtu", "-o", "d.vtu")  # the same mesh, deformed
    assert cells_in_order(tmp_path / "c.vtu") == cells_in_order(tmp_path / "d.vtu")
    command.fails("apply", "m", "d.vtu", "-o", "e.vtu")
    command.ok("apply", "m", "d.vtu", "-o", "e.vtu", "--inverse")


def test_maps_hold_checksums_of_the_mesh_before_and_after(command, tmp_path):
    write_boxes(tmp_path)
    command.ok("order", "a.vtu", "-o", "b.vtu", "--vertices", "rcm", "--maps", "m")
    command.ok("order", "a.vtu", "-o", "same.vtu", "--vertices", "original", "--elements", "original", "--maps", "same")
    command.ok("order", "moved.vtu", "-o", "moved-b.vtu", "--vertices", "rcm", "--maps", "moved")
    identity, same, moved = (json.loads((tmp_path / f"{name}.maps.json").read_text()) for name in ("m", "same", "moved"))
    assert identity["version"] == command.ok("--version").stdout.strip()
    for side in ("before", "after"):
        assert all(re.fullmatch("[0-9a-f]{16}", identity[side][of]) for of in ("points", "cells"))
        assert moved[side]["cells"] == identity[side]["cells"] and moved[side]["points"] != identity[side]["points"]
    assert identity["before"] == same["before"] == same["after"]
    assert all(identity["before"][of] != identity["after"][of] for of in ("points", "cells"))
    for inverse in ([], ["--inverse"]):  # maps that move nothing may be applied any number of times
        command.ok("apply", "same", "same.vtu", "-o", "c.vtu", *inverse)


@pytest.mark.parametrize("content", ["", "{", "[]", "{}", '{"before": {"points": "x", "cells": "0"}, "after": null}',
                                     '{"before": {"points": 1, "cells": 2}, "after": null}', "\xff" * 9, "[" * 100000])
def test_a_broken_identity_of_maps_is_refused(command, tmp_path, content):
    write_boxes(tmp_path)
    command.ok("order", "a.vtu", "-o", "b.vtu", "--maps", "m")
    (tmp_path / "m.maps.json").write_text(content, encoding="latin-1")
    assert command.fails("apply", "m", "a.vtu", "-o", "c.vtu").startswith("meshorder: m.maps.json: ")
    (tmp_path / "m.maps.json").unlink()  # as maps of earlier versions
    command.ok("apply", "m", "a.vtu", "-o", "c.vtu")
    command.ok("apply", "m", "b.vtu", "-o", "c.vtu")


def test_an_unknown_side_of_maps_is_not_checked(command, tmp_path):
    write_boxes(tmp_path)
    command.ok("order", "a.vtu", "-o", "b.vtu", "--vertices", "rcm", "--maps", "m")
    identity = json.loads((tmp_path / "m.maps.json").read_text())
    (tmp_path / "m.maps.json").write_text(json.dumps({**identity, "after": None}))
    command.ok("apply", "m", "a.vtu", "-o", "c.vtu")
    command.ok("apply", "m", "other.vtu", "-o", "c.vtu", "--inverse")
    assert "already" in command.fails("apply", "m", "a.vtu", "-o", "c.vtu", "--inverse")
    assert "already" in command.fails("apply", "m", "moved.vtu", "-o", "c.vtu", "--inverse")
    assert "not in the order that the maps start from" in command.fails("apply", "m", "b.vtu", "-o", "c.vtu")


def test_maps_that_move_nothing_lead_back_without_checksums_of_the_mesh_after(command, tmp_path):
    write_boxes(tmp_path)
    command.ok("order", "a.vtu", "-o", "b.vtu", "--vertices", "original", "--elements", "original", "--maps", "m")
    identity = json.loads((tmp_path / "m.maps.json").read_text())
    (tmp_path / "m.maps.json").write_text(json.dumps({**identity, "after": None}))
    for direction in ([], ["--inverse"]):
        command.ok("apply", "m", "b.vtu", "-o", "c.vtu", *direction)
        assert (tmp_path / "c.vtu").read_bytes() == (tmp_path / "b.vtu").read_bytes()
    assert "not in the order" in command.fails("apply", "m", "other.vtu", "-o", "c.vtu")


@pytest.mark.parametrize("name", ["m.vertices.old_to_new.npy", "m.cells.new_to_old.npy", "m.maps.json"])
def test_a_file_of_the_maps_is_not_their_prefix(command, tmp_path, name):
    write_boxes(tmp_path)
    command.ok("order", "a.vtu", "-o", "b.vtu", "--maps", "m")
    assert command.fails("apply", name, "a.vtu", "-o", "c.vtu") == \
        f"meshorder: {name}: is one file of the maps; give their prefix, m"


def test_maps_say_which_was_which(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    command.ok("order", "mesh.node", "-o", "new.node", "--vertices", "scrambled", "--elements", "scrambled", "--seed",
               "3", "--maps", "m")
    points, cells = meshes.read_tetgen(tmp_path / "mesh.node")
    new_points, new_cells = meshes.read_tetgen(tmp_path / "new.node")
    vertex_new, vertex_old = load(tmp_path, "m", "vertices")
    cell_new, cell_old = load(tmp_path, "m", "cells")
    assert (new_points[vertex_new] == points).all() and (new_points == points[vertex_old]).all()
    assert (new_cells[cell_new] == vertex_new[cells]).all() and (new_cells == vertex_new[cells[cell_old]]).all()
    assert not (vertex_new == numpy.arange(5)).all()


def test_attached_data_moves_along_into_another_format(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    command.ok("order", "mesh.node", "-o", "new.vtu", "--vertices", "scrambled", "--elements", "scrambled", "--maps", "m")
    mesh = meshio.read(tmp_path / "new.vtu")
    vertex_new, _ = load(tmp_path, "m", "vertices")
    cell_new, _ = load(tmp_path, "m", "cells")
    assert mesh.point_data["label"].ravel()[vertex_new].tolist() == [7, 8, 7, 8, 9]
    assert mesh.cell_data["label"][0].ravel()[cell_new].tolist() == [10, 20]


TARGETS = ["node", "mesh", "msh", "vtu", "vtk", "veg"]


@pytest.mark.parametrize("extension", TARGETS)
def test_order_of_a_converted_file_is_the_one_computed(command, tmp_path, extension):
    made = command.json("models", "make", "grid", "--size", "4")["models"][0]["path"]
    ordered = command.json("order", made, "-o", f"grid.{extension}", "--maps", "m")
    info = command.json("info", f"grid.{extension}")
    assert info["edge_span"] == ordered["edge_span"]["after"]
    assert info["cells"] == {"tetrahedron": 384}
    command.ok("apply", "m", f"grid.{extension}", "-o", "back.vtu", "--inverse")
    original, back = meshio.read(made), meshio.read(tmp_path / "back.vtu")
    assert (original.points == back.points).all()
    assert (original.cells[0].data == back.cells[0].data).all()


def test_all_orders_give_the_same_mesh(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    listed = command.json("methods")
    points, cells = meshes.read_tetgen(tmp_path / "mesh.node")
    expected = sorted(sorted(map(tuple, points[c])) for c in cells)
    vertex_names = [m["name"] for m in listed["vertices"]]
    element_names = [m["name"] for m in listed["elements"]]
    assert len(vertex_names) >= 9 and len(element_names) >= 9
    for vertices, elements in itertools.zip_longest(vertex_names, element_names):
        command.ok("order", "mesh.node", "-o", "new.node", "--vertices", vertices or "fiedler", "--elements",
                   elements or "lexmax")
        new_points, new_cells = meshes.read_tetgen(tmp_path / "new.node")
        assert sorted(sorted(map(tuple, new_points[c])) for c in new_cells) == expected


@pytest.mark.parametrize("vertices", ["auto", "fiedler", "rcm", "metis-nd", "scrambled"])
@pytest.mark.parametrize("group_by", [None, "half"])
def test_threads_do_not_change_a_byte(command, tmp_path, vertices, group_by):
    made = command.json("models", "make", "ball", "--size", "12")["models"][0]["path"]
    points, cells = meshes.read_tetgen(made)
    half = (points[cells].mean(axis=1)[:, 0] > 0).astype(int)
    meshio.Mesh(points, [("tetra", cells)], cell_data={"half": [half]}).write(tmp_path / "ball.vtu")
    options = ["--vertices", vertices, "--elements", "fiedler"] + (["--group-by", group_by] if group_by else [])
    written = []
    for threads in (1, 2, 3):
        command.ok("order", "ball.vtu", "-o", f"{threads}.vtu", "--maps", str(threads), "--threads", threads, *options)
        written.append([path.read_bytes() for path in sorted(tmp_path.glob(f"{threads}.*"))])
    assert len(written[0]) == 6
    assert written[0] == written[1] == written[2]


@pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="needs Linux's list of threads")
@pytest.mark.parametrize("arguments", [
    ["order", "big.node", "-o", "out.node", "--elements", "fiedler"],
    ["order", "big.node", "-o", "out.node", "--vertices", "fiedler", "--maps", "m"],
    ["info", "big.node"],
    ["compare", "big.node", "--methods", "fiedler", "--budget", "0.2"],
])
def test_there_are_no_more_threads_than_asked_for(command, tmp_path, arguments):
    made = command.json("models", "make", "ball", "--size", "24")["models"][0]["path"]
    for suffix in (".node", ".ele"):
        shutil.copy(made.replace(".node", suffix), tmp_path / f"big{suffix}")
    for threads in (1, 2):
        process = subprocess.Popen([conftest.MESHORDER, *arguments, "--threads", str(threads)], cwd=tmp_path,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        most = 0
        while process.poll() is None:
            try:
                most = max(most, len(os.listdir(f"/proc/{process.pid}/task")))
            except OSError:
                pass
        assert process.returncode == 0
        assert 1 <= most <= threads


def test_a_set_of_elements_in_included_files_follows(command, tmp_path):
    command.ok("order", conftest.DATA / "blocks.msh", "-o", "blocks.veg", "--vertices", "scrambled")
    text = (tmp_path / "blocks.veg").read_text()
    text = text[:text.index("*SET")] + "*SET shell\n*INCLUDE shell.txt\n\n*SET rest\n*INCLUDE rest.txt\n"
    (tmp_path / "blocks.veg").write_text(text)
    line = command.fails("info", "blocks.veg")
    assert f"blocks.veg:{text.count(chr(10)) - 3}: " in line and "shell.txt" in line
    (tmp_path / "shell.txt").write_text(", ".join(str(i) for i in range(1, 101)) + "\n")
    (tmp_path / "rest.txt").write_text(", ".join(str(i) for i in range(101, 700)) + "\n")
    command.ok("order", "blocks.veg", "-o", "ordered.veg", "--maps", "m")
    cell_new, _ = load(tmp_path, "m", "cells")
    text = "\n".join(line.split("#")[0] for line in (tmp_path / "ordered.veg").read_text().splitlines())
    block = text[text.index("*SET shell") + len("*SET shell"):]
    members = {int(word) for word in block[:block.index("*")].replace(",", " ").split()}
    assert members == {int(i) + 1 for i in cell_new[:100]}
