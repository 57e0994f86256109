# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""VTKHDF files that all ranks read and write at once. h5py makes them and reads the results."""
import json
import os

import h5py
import numpy
import pytest
from test_mpi import launch, order, own_lines, serial

TRIANGLE, TETRAHEDRON, PYRAMID = 5, 10, 14
SIZES = {TRIANGLE: 3, TETRAHEDRON: 4, PYRAMID: 5}


def write(path, points=400, cells=900, seed=1, index="i8", number="f8", **options):
    """Writes cells in random order, unused points, and arrays of several types. `options` are h5py's."""
    chance = numpy.random.default_rng(seed)
    kinds = chance.choice(list(SIZES), cells, p=[0.2, 0.6, 0.2])
    rows = [chance.choice(points - 20, SIZES[kind], replace=False) for kind in kinds]
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group.attrs["Version"] = numpy.array([1, 0])
        group.attrs["Type"] = numpy.bytes_("UnstructuredGrid")

        def put(name, values, dtype):
            group.create_dataset(name, data=numpy.asarray(values).astype(dtype), **options)

        put("NumberOfPoints", [points], "i8")
        put("NumberOfCells", [cells], "i8")
        put("NumberOfConnectivityIds", [sum(map(len, rows))], "i8")
        put("CellData/id", numpy.arange(cells), index)
        put("CellData/pair", chance.random((cells, 2)), "f4")
        put("Points", chance.random((points, 3)), number)
        put("Offsets", numpy.cumsum([0, *map(len, rows)]), index)
        put("Connectivity", numpy.concatenate(rows), index)
        put("PointData/id", numpy.arange(points), "i4")
        put("Types", kinds, "u1")
        put("FieldData/time", [2.5], "f8")
        group["PointData"].attrs["Scalars"] = numpy.bytes_("id")
        group["FieldData"].create_dataset("note", data=[b"kept as it is"], dtype=h5py.string_dtype("ascii"))
    return path


def read(path):
    with h5py.File(path) as file:
        group = file["VTKHDF"]
        found = {}
        group.visititems(lambda name, item: found.update({name: item[()]} if isinstance(item, h5py.Dataset) else {}))
        found["roles"] = dict(group["PointData"].attrs)
    return found


def cells_of(found):
    return [tuple(found["Connectivity"][a:b]) for a, b in zip(found["Offsets"], found["Offsets"][1:])]


def assert_same_but_for_order(old, new, with_types=True):
    """Asserts that each point and cell equals the old one with its id, also in all arrays."""
    u, c = new["PointData/id"], new["CellData/id"]
    assert sorted(u) == list(range(len(old["Points"]))) and sorted(c) == list(range(len(old["Types"])))
    assert u.tolist() != sorted(u)
    for name, rows in (("Points", u), ("Types", c), ("CellData/pair", c)):
        assert numpy.array_equal(new[name], old[name][rows]), name
    before, after = cells_of(old), cells_of(new)
    assert [tuple(u[list(cell)]) for cell in after] == [before[cell] for cell in c]
    assert new["FieldData/time"] == 2.5 and new["FieldData/note"][0] == b"kept as it is" and new["roles"] == old["roles"]
    assert old.keys() == new.keys()
    if with_types:
        assert all(old[name].dtype == new[name].dtype for name in old.keys() - {"roles"})


def assert_same(one, other):
    assert one.keys() == other.keys()
    assert all(numpy.array_equal(one[name], other[name]) for name in one)


@pytest.mark.parametrize("index, number", [("i8", "f8"), ("i4", "f4"), ("u2", "f8")])
@pytest.mark.parametrize("ranks", [1, 2, 3, 5])
def test_slices_give_what_one_rank_gives(tmp_path, ranks, index, number):
    write(tmp_path / "raw.vtkhdf", index=index, number=number)
    write(tmp_path / "zip.vtkhdf", index=index, number=number, chunks=True, compression="gzip")
    by = {}
    for name in ("raw", "zip"):
        done = order(ranks, tmp_path / f"{name}.vtkhdf", "-o", tmp_path / f"{name}-out.vtkhdf", "--parts", "3", "--maps",
                     tmp_path / name, "--json")
        by[name] = json.loads(done.stdout)["files_by"]
        assert all("parts are ranges" in line for line in own_lines(done))
    assert by == {"raw": "all ranks", "zip": "rank 0"}
    sliced, whole = read(tmp_path / "raw-out.vtkhdf"), read(tmp_path / "zip-out.vtkhdf")
    assert_same_but_for_order(read(tmp_path / "raw.vtkhdf"), sliced)
    assert_same(sliced, whole)
    assert os.path.getsize(tmp_path / "raw.vtkhdf") == os.path.getsize(tmp_path / "raw-out.vtkhdf")
    maps = [{path.name[4:]: path.read_bytes() for path in tmp_path.glob(f"{name}.*.*")} for name in ("raw", "zip")]
    assert maps[0] == maps[1] and len(maps[0]) > 3


def test_a_file_may_take_its_own_place(tmp_path):
    before = read(write(tmp_path / "a.vtkhdf", seed=4))
    order(3, tmp_path / "a.vtkhdf", "-o", tmp_path / "a.vtkhdf")
    assert_same_but_for_order(before, read(tmp_path / "a.vtkhdf"))
    assert os.listdir(tmp_path) == ["a.vtkhdf"]


def test_fewer_cells_than_ranks(tmp_path):
    before = read(write(tmp_path / "a.vtkhdf", points=28, cells=2, seed=3))
    order(5, tmp_path / "a.vtkhdf", "-o", tmp_path / "b.vtkhdf")
    assert_same_but_for_order(before, read(tmp_path / "b.vtkhdf"))


def test_a_file_of_meshorder_is_read_by_all_ranks(tmp_path):
    write(tmp_path / "a.vtkhdf", index="u2", chunks=True)
    serial("order", tmp_path / "a.vtkhdf", "-o", tmp_path / "b.vtkhdf", "--vertices", "original", "--elements", "original")
    done = order(3, tmp_path / "b.vtkhdf", "-o", tmp_path / "c.vtkhdf", "--json")
    assert json.loads(done.stdout)["files_by"] == "all ranks"
    assert_same_but_for_order(read(tmp_path / "b.vtkhdf"), read(tmp_path / "c.vtkhdf"))


def replace(name, values, **options):
    def work(group):
        del group[name]
        group.create_dataset(name, data=values, **options)
    return work


BY_RANK_0 = {
    "another order of bytes": lambda group: replace("CellData/id", group["CellData/id"][()].astype(">i8"))(group),
    "texts": lambda group: replace("CellData/text", numpy.array([b"a"] * 900, "S2"))(group),
    "more than a grid": lambda group: group.create_dataset("assembly", data=[1]),
    "an only step": lambda group: group.create_group("Steps").attrs.create("NSteps", 1),
    "compact": lambda group: compact(group),
}


def compact(group):
    del group["PointData/id"]
    kept = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    kept.set_layout(h5py.h5d.COMPACT)
    space = h5py.h5s.create_simple((400,))
    made = h5py.h5d.create(group["PointData"].id, b"id", h5py.h5t.NATIVE_INT32, space, kept)
    made.write(h5py.h5s.ALL, h5py.h5s.ALL, numpy.arange(400, dtype="i4"))


@pytest.mark.parametrize("kind", BY_RANK_0)
def test_what_only_the_library_reads_is_read_by_rank_0(tmp_path, kind):
    write(tmp_path / "a.vtkhdf")
    with h5py.File(tmp_path / "a.vtkhdf", "a") as file:
        if kind == "texts":
            file["VTKHDF/CellData/text"] = [1]
        BY_RANK_0[kind](file["VTKHDF"])
    before = read(tmp_path / "a.vtkhdf")
    done = order(2, tmp_path / "a.vtkhdf", "-o", tmp_path / "b.vtkhdf", "--json")
    assert json.loads(done.stdout)["files_by"] == "rank 0"
    for name in ("CellData/text", "assembly"):
        before.pop(name, None)
    assert_same_but_for_order(before, read(tmp_path / "b.vtkhdf"), with_types=False)


def put(name, place, value):
    def work(group):
        group[name][place] = value
    return work


def longer(group):
    """Adds an entry to the connectivity that belongs to no cell."""
    group["NumberOfConnectivityIds"][0] += 1
    replace("Connectivity", numpy.append(group["Connectivity"][()], 0))(group)


FAULTS = {
    "point 390 (counted from 0) has a coordinate that is not finite": put("Points", (390, 1), numpy.nan),
    "a cell names the point 400": put("Connectivity", 2000, 400),
    "cell 800 (counted from 0) has the entries": put("Offsets", 801, 3),
    "'/VTKHDF/Offsets' begins a partition with 1": put("Offsets", 0, 1),
    "entries of": lambda group: longer(group),
    "cell 899 (counted from 0) is of VTK's type 200": put("Types", 899, 200),
    "cell 600 (counted from 0) is a hexahedron of": put("Types", 600, 12),
    "401 rows of 3 are needed": put("NumberOfPoints", 0, 401),
    "'/VTKHDF/CellData/id' has 3 rows": replace("CellData/id", [1, 2, 3]),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_on_any_rank_ends_all_with_one_line(tmp_path, fault):
    write(tmp_path / "a.vtkhdf")
    with h5py.File(tmp_path / "a.vtkhdf", "a") as file:
        FAULTS[fault](file["VTKHDF"])
    done = launch(3, "order", tmp_path / "a.vtkhdf", "-o", tmp_path / "b.vtkhdf")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and fault in own_lines(done)[0], done.stderr
    assert os.listdir(tmp_path) == ["a.vtkhdf"]


def test_a_file_that_is_cut_short_is_reported(tmp_path):
    whole = write(tmp_path / "a.vtkhdf").read_bytes()
    (tmp_path / "a.vtkhdf").write_bytes(whole[:len(whole) * 2 // 3])
    done = launch(2, "order", tmp_path / "a.vtkhdf", "-o", tmp_path / "b.vtkhdf")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and "HDF5 cannot open it" in done.stderr, done.stderr
    assert os.listdir(tmp_path) == ["a.vtkhdf"]
