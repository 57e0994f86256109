# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""VTKHDF files, made by h5py in the layouts of its specification. VTK's own reader and h5py judge what is written."""
import json
import subprocess
import sys

import h5py
import numpy
import pytest

# in a separate process: h5py would register conversions of texts with libhdf5 that VTK itself does not have
READ = """
import json, sys
from vtk import vtkHDFReader
from vtk.util.numpy_support import vtk_to_numpy
reader = vtkHDFReader()
reader.SetFileName(sys.argv[1])
assert reader.CanReadFile(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
def arrays(data):
    numbers = [data.GetArray(k) for k in range(data.GetNumberOfArrays())]
    return {a.GetName(): vtk_to_numpy(a).tolist() for a in numbers if a is not None}
fields = grid.GetFieldData()
texts = [fields.GetAbstractArray(k) for k in range(fields.GetNumberOfArrays())]
texts = {a.GetName(): [a.GetValue(k) for k in range(a.GetNumberOfValues())] for a in texts if a.IsA("vtkStringArray")}
print(json.dumps({"points": vtk_to_numpy(grid.GetPoints().GetData()).tolist(),
                  "cells": [[grid.GetCell(c).GetPointId(k) for k in range(grid.GetCell(c).GetNumberOfPoints())]
                            for c in range(grid.GetNumberOfCells())],
                  "types": [grid.GetCellType(c) for c in range(grid.GetNumberOfCells())],
                  "points data": arrays(grid.GetPointData()), "cells data": arrays(grid.GetCellData()),
                  "fields": arrays(fields) | texts}))
"""


def by_vtk(path):
    done = subprocess.run([sys.executable, "-c", READ, path], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    return json.loads(done.stdout)


def box(n):
    """Points and tetrahedra of n³ cubes, six each, and triangles of the side z = 0."""
    points = numpy.array([(x, y, z) for z in range(n + 1) for y in range(n + 1) for x in range(n + 1)], float) / 3
    cubes = [(x, y, z) for z in range(n) for y in range(n) for x in range(n)]
    corner = lambda x, y, z: x + (n + 1) * (y + (n + 1) * z)  # noqa: E731
    tetrahedra = []
    for cube in cubes:
        for axes in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)):
            at, cell = list(cube), [corner(*cube)]
            for axis in axes:
                at[axis] += 1
                cell.append(corner(*at))
            tetrahedra.append(cell)
    triangles = [[corner(x, y, 0), corner(x + 1, y, 0), corner(x, y + 1, 0)] for y in range(n) for x in range(n)]
    return points, tetrahedra, triangles


def write(path, n=2, number=numpy.float64, index=numpy.int64, version=(1, 0), partitions=1, **options):
    """One box, or several beside each other, each a partition. `options` are those of h5py's datasets."""
    one, tetrahedra, triangles = box(n)
    cells = tetrahedra + triangles
    entries = sum(map(len, cells))
    points = numpy.concatenate([one + [5 * p, 0, 0] for p in range(partitions)])
    count, cell_count = len(points), len(cells) * partitions
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group.attrs["Version"] = numpy.array(version, index)
        group.attrs["Type"] = numpy.bytes_("UnstructuredGrid")

        def put(name, values, dtype):
            group.create_dataset(name, data=numpy.asarray(values).astype(dtype), **options)

        put("NumberOfPoints", [len(one)] * partitions, index)
        put("NumberOfCells", [len(cells)] * partitions, index)
        put("NumberOfConnectivityIds", [entries] * partitions, index)
        put("Points", points, number)
        put("Types", ([10] * len(tetrahedra) + [5] * len(triangles)) * partitions, "u1")
        put("Connectivity", numpy.concatenate([*cells] * partitions), index)
        put("Offsets", numpy.concatenate([numpy.cumsum([0, *map(len, cells)])] * partitions), index)
        put("PointData/heat", points[:, 0] + 10 * points[:, 1], number)
        put("PointData/shift", 2 * points, number)
        put("PointData/GlobalPointIds", numpy.arange(count) + 7, index)
        put("CellData/material", numpy.arange(cell_count) % 3, "i2")
        put("CellData/vtkGhostType", numpy.zeros(cell_count), "u1")
        put("FieldData/times", [0.5, 1.5, 2.5], number)
        group["PointData"].attrs["Scalars"] = numpy.bytes_("heat")
        group["FieldData"].create_dataset("title", data=[b"a box", b"of cells"], dtype=h5py.string_dtype("ascii"))
    return path


def by_place(grid):
    """The content of a grid, with points and cells identified by their coordinates."""
    points = [tuple(point) for point in grid["points"]]
    cells = [tuple(points[v] for v in cell) for cell in grid["cells"]]
    result = {"points": sorted(points), "cells": sorted(zip(cells, grid["types"])), "fields": grid["fields"]}
    for kind, keys in (("points data", points), ("cells data", cells)):
        for name, values in grid[kind].items():
            result[kind, name] = sorted(zip(keys, values))
    return result


@pytest.mark.parametrize("number, index, options", [
    ("f8", "i8", {}), ("f4", "i4", {}), (">f8", ">i8", {}), ("f4", "u2", {"chunks": True}),
    ("f8", "i8", {"chunks": True, "compression": "gzip", "shuffle": True})])
def test_all_that_a_file_has_moves_with_its_mesh(command, tmp_path, number, index, options):
    write(tmp_path / "a.vtkhdf", number=number)  # VTK does not read 16-bit connectivity
    before = by_place(by_vtk(tmp_path / "a.vtkhdf"))
    write(tmp_path / "a.vtkhdf", number=number, index=index, **options)
    done = command.ok("order", "a.vtkhdf", "-o", "b.vtkhdf", "--vertices", "scrambled", "--elements", "scrambled")
    assert done.stderr == ""
    after = by_vtk(tmp_path / "b.vtkhdf")
    assert by_place(after) == before
    with h5py.File(tmp_path / "a.vtkhdf") as a, h5py.File(tmp_path / "b.vtkhdf") as b:
        a, b = a["VTKHDF"], b["VTKHDF"]
        assert list(b.attrs["Version"]) == [1, 0] and b.attrs["Type"] == b"UnstructuredGrid"
        assert b["PointData"].attrs["Scalars"] == b"heat"
        assert not numpy.array_equal(a["Points"][()], b["Points"][()])
        assert not numpy.array_equal(a["Connectivity"][()], b["Connectivity"][()])
        for name in ("Points", "PointData/heat", "CellData/material", "FieldData/times"):
            assert b[name].dtype == a[name].dtype.newbyteorder("<"), name
        for name in ("Connectivity", "Offsets", "NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"):
            assert b[name].dtype == "i8" and b[name].chunks is None


def test_partitions_become_one(command, tmp_path):
    write(tmp_path / "a.vtkhdf", partitions=3, version=(2, 2))
    done = command.ok("order", "a.vtkhdf", "-o", "b.vtkhdf", "--vertices", "original", "--elements", "original")
    assert "the 3 partitions of the file became one" in done.stderr
    with h5py.File(tmp_path / "b.vtkhdf") as file:
        assert list(file["VTKHDF/NumberOfPoints"]) == [81]
    write(tmp_path / "a.vtkhdf", partitions=3)
    whole, first = by_vtk(tmp_path / "b.vtkhdf"), by_vtk(tmp_path / "a.vtkhdf")
    assert set(first["cells data"].pop("vtkGhostType")) == {0}  # trivial for one mesh
    # VTK reads all partitions as one grid, too
    assert len(whole["points"]) == 81 and by_place(whole) == by_place(first)


def test_empty_partitions_are_passed_over(command, tmp_path):
    write(tmp_path / "a.vtkhdf")
    with h5py.File(tmp_path / "a.vtkhdf", "a") as file:
        group = file["VTKHDF"]
        for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"):
            values = [0, *group[name][()], 0]
            del group[name]
            group[name] = values
        offsets = [0, *group["Offsets"][()], 0]
        del group["Offsets"]
        group["Offsets"] = offsets
    done = command.ok("order", "a.vtkhdf", "-o", "b.vtkhdf", "--vertices", "original", "--elements", "original")
    assert done.stderr == ""
    write(tmp_path / "a.vtkhdf")
    assert by_vtk(tmp_path / "b.vtkhdf") == by_vtk(tmp_path / "a.vtkhdf")


def test_meshes_of_other_formats_become_files_that_vtk_reads(command, tmp_path):
    write(tmp_path / "a.vtkhdf")
    before = by_place(by_vtk(tmp_path / "a.vtkhdf"))
    for extension in ("vtu", "vtk", "xdmf"):
        command.ok("order", "a.vtkhdf", "-o", f"b.{extension}", "--vertices", "scrambled", "--elements", "scrambled")
        command.ok("order", f"b.{extension}", "-o", "c.vtkhdf", "--vertices", "hilbert", "--elements", "lexmax")
        after = by_place(by_vtk(tmp_path / "c.vtkhdf"))
        if extension == "xdmf":  # XDMF has no fields
            after["fields"] = before["fields"]
        assert after == before, extension


def test_arrays_keep_the_sequence_in_which_vtk_lists_them(command, tmp_path):
    names = ["zeta", "an array with a long name", "mu", "alpha", "b", "another array with a long name"]

    def list_anew(group):
        kept = {name: group["CellData"][name][()] for name in group["CellData"]}
        del group["CellData"]
        cells = group.create_group("CellData", track_order=True)
        for name in [*names, *kept]:
            cells[name] = kept.get(name, numpy.arange(len(group["Types"])) + 0.5)

    write(tmp_path / "a.vtkhdf")
    change(tmp_path / "a.vtkhdf", list_anew)
    before = list(by_vtk(tmp_path / "a.vtkhdf")["cells data"])
    command.ok("order", "a.vtkhdf", "-o", "b.vtkhdf", "--vertices", "scrambled", "--elements", "scrambled")
    assert list(by_vtk(tmp_path / "b.vtkhdf")["cells data"]) == before != sorted(before)
    command.ok("order", "b.vtkhdf", "-o", "c.vtu", "--vertices", "original", "--elements", "original")
    command.ok("order", "c.vtu", "-o", "d.vtkhdf", "--vertices", "original", "--elements", "original")
    assert list(by_vtk(tmp_path / "d.vtkhdf")["cells data"]) == before


def change(path, work):
    with h5py.File(path, "a") as file:
        work(file["VTKHDF"])


def replace(name, values, dtype=None):
    def work(group):
        attributes = dict(group[name].attrs)
        del group[name]
        group.create_dataset(name, data=numpy.asarray(values), dtype=dtype)
        group[name].attrs.update(attributes)
    return work


def put(name, place, value):
    def work(group):
        group[name][place] = value
    return work


def attribute(name, value):
    def work(group):
        group.attrs[name] = value
    return work


def remove(name):
    def work(group):
        del group[name]
    return work


def claim(name, shape, dtype):
    def work(group):
        del group[name]
        group.create_dataset(name, shape, dtype)
    return work


def steps(group):
    group.create_group("Steps").attrs["NSteps"] = 3


def link(group):
    del group["Points"]
    group["Points"] = h5py.ExternalLink("other.h5", "/points")


# 27 points, 52 cells and 204 entries
BROKEN = {
    "has no group 'VTKHDF'": lambda group: group.file.move("VTKHDF", "other"),
    "is of version 3 of VTKHDF": attribute("Version", numpy.array([3, 0])),
    "has no version of VTKHDF": lambda group: group.attrs.pop("Version"),
    "no attribute Type of fixed length": attribute("Type", "UnstructuredGrid"),
    "holds VTK's PolyData": attribute("Type", numpy.bytes_("PolyData")),
    "holds 3 time steps": steps,
    "the dataset '/VTKHDF/NumberOfCells' is missing": remove("NumberOfCells"),
    "'/VTKHDF/NumberOfPoints' does not hold whole numbers": replace("NumberOfPoints", [27.0]),
    "'/VTKHDF/NumberOfPoints' has the count -1": replace("NumberOfPoints", [28, -1]),
    "'/VTKHDF/NumberOfPoints' has no count": replace("NumberOfPoints", [], "i8"),
    "'/VTKHDF/NumberOfCells' has 2 counts": replace("NumberOfCells", [51, 1]),
    "too many points or cells": replace("NumberOfPoints", [2 ** 31]),
    "'/VTKHDF/Points' is missing": remove("Points"),
    "'/VTKHDF/Points' has the shape (27, 3); 28 rows of 3 are needed": replace("NumberOfPoints", [28]),
    "'/VTKHDF/Points' has the shape (27, 2)": replace("Points", numpy.zeros((27, 2))),
    "'/VTKHDF/Points' has the shape (81)": replace("Points", numpy.zeros(81)),
    "has a coordinate of point 5 (counted from 0) that is not finite": put("Points", (5, 1), numpy.nan),
    "'/VTKHDF/Points' is reached through '/VTKHDF/Points', a link to another file": link,
    "'/VTKHDF/Points' claims 81 values, but only 0 bytes are stored": claim("Points", (27, 3), "f8"),
    "'/VTKHDF/Offsets' is missing": remove("Offsets"),
    "'/VTKHDF/Offsets' has the shape (52); 53 rows of 1 are needed":
        lambda group: replace("Offsets", group["Offsets"][1:])(group),
    "'/VTKHDF/Offsets' ends a cell at 3, before it begins at 4": put("Offsets", 2, 3),
    "'/VTKHDF/Offsets' begins a partition with 1": put("Offsets", 0, 1),
    "'/VTKHDF/Offsets' ends the cells of a partition at 1000": put("Offsets", 9, 1000),
    "'/VTKHDF/Offsets' ends the cells of a partition at 203": put("Offsets", 52, 203),
    "'/VTKHDF/Offsets' does not hold whole numbers": replace("Offsets", numpy.zeros(53)),
    "'/VTKHDF/Connectivity' is missing": remove("Connectivity"),
    "'/VTKHDF/Connectivity' has the shape (203); 204 rows of 1":
        lambda group: replace("Connectivity", group["Connectivity"][1:])(group),
    "'/VTKHDF/Connectivity' names the point 27": put("Connectivity", 3, 27),
    "'/VTKHDF/Connectivity' names the point -1": put("Connectivity", 203, -1),
    "'/VTKHDF/Types' is missing": remove("Types"),
    "'/VTKHDF/Types' has the type 256": replace("Types", [256] * 52, "i4"),
    "cell 0 (counted from 0) is a polyhedron": put("Types", 0, 42),
    "cell 1 (counted from 0) has the type 99": put("Types", 1, 99),
    "cell 2 (counted from 0) is a VTK_WEDGE of 4 vertices": put("Types", 2, 13),
    "'/VTKHDF/PointData/heat' has 26 rows": replace("PointData/heat", numpy.zeros(26)),
    "'/VTKHDF/CellData/material' has the shape (52, 0)": replace("CellData/material", numpy.zeros((52, 0))),
    "'/VTKHDF/CellData/material' claims 52 values": claim("CellData/material", (52,), "f8"),
    "'/VTKHDF/FieldData/times' has 3 values in rows of 2":
        lambda group: group["FieldData/times"].attrs.create("NumberOfComponents", 2),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_a_fault_is_one_line(command, tmp_path, fault):
    path = write(tmp_path / "a.vtkhdf")
    command.ok("info", path)
    change(path, BROKEN[fault])
    line = command.fails("order", path, "-o", "b.vtkhdf")
    assert line.startswith(f"meshorder: {path}: ") and fault in line
    assert [file.name for file in tmp_path.iterdir()] == ["a.vtkhdf"]


def test_a_file_that_is_cut_short_is_one_line(command, tmp_path):
    whole = write(tmp_path / "a.vtkhdf").read_bytes()
    for size in (1, 100, 2000, len(whole) // 2, len(whole) - 1):
        (tmp_path / "a.vtkhdf").write_bytes(whole[:size])
        assert "a.vtkhdf: HDF5 cannot open it" in command.fails("order", "a.vtkhdf", "-o", "b.vtkhdf")
    assert [file.name for file in tmp_path.iterdir()] == ["a.vtkhdf"]


def test_claims_count_against_the_memory_limit(command, tmp_path):
    path = write(tmp_path / "a.vtkhdf")
    with h5py.File(path, "a") as file:
        # zeros compress well
        file["VTKHDF"].create_dataset("CellData/zeros", data=numpy.zeros((52, 10 ** 6)), chunks=(52, 10 ** 5), compression="gzip")
    assert "'/VTKHDF/CellData/zeros' would take" in command.fails("info", path, "--limit-memory", "100M")


def test_what_is_not_kept_is_reported(command, tmp_path):
    path = write(tmp_path / "a.vtkhdf")
    with h5py.File(path, "a") as file:
        file["other"] = [1]
        file["VTKHDF/assembly"] = [1]
        file["VTKHDF/CellData/pairs"] = numpy.zeros(52, [("a", "i4"), ("b", "f8")])
        file["VTKHDF/CellData/group/inside"] = [1]
        file["VTKHDF/PointData"].create_dataset("words", data=[b"word"] * 27, dtype="S6")
    told = command.ok("order", "a.vtkhdf", "-o", "b.vtkhdf").stderr
    assert told.count("warning") == 5
    for part in ("'/other' is ignored", "'/VTKHDF/assembly' is ignored", "'/VTKHDF/CellData/pairs' is not read",
                 "'/VTKHDF/CellData/group' is not read", "the array 'words' on vertices is not written"):
        assert part in told
    by_vtk(tmp_path / "b.vtkhdf")
    assert command.run("order", "a.vtkhdf", "-o", "c.vtkhdf", "--strict").returncode == 2
    # .vtu holds texts
    command.ok("order", "a.vtkhdf", "-o", "b.vtu")
    assert "words" in (tmp_path / "b.vtu").read_text(encoding="latin-1")
