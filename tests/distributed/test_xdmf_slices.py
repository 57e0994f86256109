# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""XDMF files that all ranks read and write at once. h5py makes them in the layout of DOLFINx."""
import json
import os
import re
import subprocess

import h5py
import meshio
import numpy
import pytest
from test_mpi import launch, order, own_lines, serial

NODES = {"Triangle": 3, "Tetrahedron": 4, "Tetrahedron_10": 10}
GRID = """<?xml version="1.0"?>
<!DOCTYPE Xdmf SYSTEM "Xdmf.dtd" []>
<Xdmf Version="3.0" xmlns:xi="https://www.w3.org/2001/XInclude">
  <Domain>
    <Grid Name="mesh" GridType="Uniform">
      <Topology TopologyType="{kind}" NumberOfElements="{cells}" NodesPerElement="{nodes}">
        <DataItem Dimensions="{cells} {nodes}" NumberType="Int" Format="HDF">{h5}:/Mesh/mesh/topology</DataItem>
      </Topology>
      <Geometry GeometryType="{geometry}">
        <DataItem Dimensions="{points} {width}" Format="HDF">{h5}:/Mesh/mesh/geometry</DataItem>
      </Geometry>
{attributes}    </Grid>
{more}  </Domain>
</Xdmf>
"""
ATTRIBUTE = """      <Attribute Name="{name}" AttributeType="Scalar" Center="{center}">
        <DataItem Dimensions="{shape}" Format="HDF">{h5}:{path}</DataItem>
      </Attribute>
"""
#: a function of DOLFINx at two times, on the mesh above
SERIES = """    <Grid Name="f" GridType="Collection" CollectionType="Temporal">
{}    </Grid>
"""
STEP = """      <Grid Name="f" GridType="Uniform">
        <xi:include xpointer="xpointer(/Xdmf/Domain/Grid[@GridType='Uniform'][1]/*[self::Topology or self::Geometry])" />
        <Time Value="{step}" />
{attribute}      </Grid>
"""


def write(path, points=400, cells=900, seed=1, index="i8", number="f8", kind="Tetrahedron", width=3, **options):
    """Writes cells in random order, unused points, and arrays of several types. `options` are h5py's."""
    chance = numpy.random.default_rng(seed)
    arrays = {("id", "Node"): numpy.arange(points, dtype="i4"), ("vector", "Node"): chance.random((points, 3)),
              ("id", "Cell"): numpy.arange(cells), ("pair", "Cell"): chance.random((cells, 2)).astype("f4")}
    steps = [chance.random((points, 1)), chance.random((points, 1))]
    h5 = path.with_suffix(".h5").name
    with h5py.File(path.with_suffix(".h5"), "w") as file:
        def put(name, values):
            file.create_dataset(name, data=values, **options)

        put("/Mesh/mesh/topology",
            numpy.array([chance.choice(points - 20, NODES[kind], replace=False) for _ in range(cells)]).astype(index))
        put("/Mesh/mesh/geometry", chance.random((points, width)).astype(number))
        for k, step in enumerate(steps):
            put(f"/Function/f/{k}", step)
        attributes = ""
        for (name, center), values in arrays.items():
            put(f"/{center}/{name}", values)
            attributes += ATTRIBUTE.format(name=name, center=center, shape=" ".join(map(str, values.shape)), h5=h5,
                                           path=f"/{center}/{name}")
        file.attrs["made by"] = "a test"
        file["note"] = [1.5, 2.5]
    texts = [ATTRIBUTE.format(name="f", center="Node", shape=f"{points} 1", h5=h5, path=f"/Function/f/{k}") for k in (0, 1)]
    path.write_text(GRID.format(
        kind=kind, nodes=NODES[kind], cells=cells, points=points, h5=h5, width=width, geometry="XYZ"[:width],
        attributes=attributes,
        more=SERIES.format("".join(STEP.format(step=k, attribute=text) for k, text in enumerate(texts)))))
    return path


def read(path):
    """All datasets of the document's HDF5 file; asserts that both have the same mark."""
    found = {}
    with h5py.File(path.with_suffix(".h5")) as file:
        file.visititems(lambda name, item: found.update({name: item[()]} if isinstance(item, h5py.Dataset) else {}))
        mark = file.attrs.get("meshorder", b"")
    text = path.read_text()
    names = set(re.findall(r">([^<:>]+):/", text))
    assert names == {path.with_suffix(".h5").name}
    if mark:
        assert f"<?meshorder {mark if isinstance(mark, str) else mark.decode()}?>" in text
    return found


def assert_same_but_for_order(old, new):
    """Asserts that each point and cell equals the old one with its id, also in all arrays."""
    u, c = new["Node/id"], new["Cell/id"]
    assert sorted(u) == list(range(len(old["Node/id"]))) and sorted(c) == list(range(len(old["Cell/id"])))
    assert u.tolist() != sorted(u)
    for name, rows in (("Mesh/mesh/geometry", u), ("Node/vector", u), ("Function/f/0", u), ("Function/f/1", u),
                       ("Cell/pair", c)):
        assert numpy.array_equal(new[name], old[name][rows]), name
    assert numpy.array_equal(u[new["Mesh/mesh/topology"]], old["Mesh/mesh/topology"][c])
    assert old.keys() == new.keys() and all(old[name].dtype == new[name].dtype for name in old)
    assert new["note"].tolist() == [1.5, 2.5]


def by(done):
    return json.loads(done.stdout)["files_by"]


@pytest.mark.parametrize("kind, index, number, width", [
    ("Tetrahedron", "i8", "f8", 3), ("Triangle", "i4", "f4", 2), ("Tetrahedron_10", "u4", "f8", 3)])
@pytest.mark.parametrize("ranks", [1, 2, 4])
def test_slices_give_what_the_serial_command_gives(tmp_path, ranks, kind, index, number, width):
    before = read(write(tmp_path / "a.xdmf", kind=kind, index=index, number=number, width=width))
    done = order(ranks, tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf", "--parts", "3", "--maps", tmp_path / "m", "--json")
    assert by(done) == "all ranks"
    assert_same_but_for_order(before, read(tmp_path / "b.xdmf"))

    (tmp_path / "serial").mkdir()
    serial("apply", tmp_path / "m", tmp_path / "a.xdmf", "-o", tmp_path / "serial" / "b.xdmf")
    for name in ("b.xdmf", "b.h5"):
        assert (tmp_path / name).read_bytes() == (tmp_path / "serial" / name).read_bytes(), name
    serial("apply", tmp_path / "m", tmp_path / "b.xdmf", "-o", tmp_path / "back.xdmf", "--inverse")
    back = read(tmp_path / "back.xdmf")
    assert all(numpy.array_equal(before[name], back[name]) for name in before)


def test_the_maps_are_those_that_rank_0_writes(tmp_path):
    for name, options in (("raw", {}), ("zip", {"chunks": True, "compression": "gzip"})):
        write(tmp_path / f"{name}.xdmf", **options)
        done = order(3, tmp_path / f"{name}.xdmf", "-o", tmp_path / f"{name}-out.xdmf", "--maps", tmp_path / name, "--json")
        assert by(done) == {"raw": "all ranks", "zip": "rank 0"}[name]
    raw, zipped = read(tmp_path / "raw-out.xdmf"), read(tmp_path / "zip-out.xdmf")
    assert raw.keys() == zipped.keys() and all(numpy.array_equal(raw[name], zipped[name]) for name in raw)
    maps = [{path.name[4:]: path.read_bytes() for path in tmp_path.glob(f"{name}.*.*")} for name in ("raw", "zip")]
    assert maps[0] == maps[1] and len(maps[0]) > 3


def test_numbers_in_attributes_may_have_blanks(tmp_path):
    before = read(write(tmp_path / "a.xdmf"))
    text, count = re.subn(r' (NumberOfElements|NodesPerElement|Dimensions)="([\d ]+)"', r' \1=" \n\2\t"',
                          (tmp_path / "a.xdmf").read_text())
    assert count > 5
    (tmp_path / "a.xdmf").write_text(text)
    done = order(2, tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf", "--json")
    assert by(done) == "all ranks"
    assert_same_but_for_order(before, read(tmp_path / "b.xdmf"))


def test_a_file_may_take_its_own_place(tmp_path):
    before = read(write(tmp_path / "a.xdmf", seed=4))
    order(3, tmp_path / "a.xdmf", "-o", tmp_path / "a.xdmf")
    assert_same_but_for_order(before, read(tmp_path / "a.xdmf"))
    assert sorted(os.listdir(tmp_path)) == ["a.h5", "a.xdmf"]


def test_fewer_cells_than_ranks(tmp_path):
    before = read(write(tmp_path / "a.xdmf", points=28, cells=3, seed=3))
    done = order(5, tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf", "--json")
    assert by(done) == "all ranks"
    assert_same_but_for_order(before, read(tmp_path / "b.xdmf"))


def test_a_file_of_meshorder_is_read_by_all_ranks_and_by_meshio(tmp_path):
    chance = numpy.random.default_rng(2)
    points, cells = chance.random((300, 3)), chance.integers(0, 300, (500, 4))
    meshio.Mesh(points, [("tetra", cells)], point_data={"id": numpy.arange(300)},
                cell_data={"id": [numpy.arange(500)]}).write(tmp_path / "a.vtu", binary=True)
    serial("order", tmp_path / "a.vtu", "-o", tmp_path / "b.xdmf", "--vertices", "original", "--elements", "original")
    done = order(4, tmp_path / "b.xdmf", "-o", tmp_path / "c.xdmf", "--json")
    assert by(done) == "all ranks"
    found = meshio.read(tmp_path / "c.xdmf")
    u, c = found.point_data["id"], found.cell_data["id"][0]
    assert numpy.array_equal(found.points, points[u]) and numpy.array_equal(u[found.cells[0].data], cells[c])


def change_xml(old, new):
    def work(path):
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new))
    return work


def change_data(name, values, **options):
    def work(path):
        with h5py.File(path.with_suffix(".h5"), "a") as file:
            values_of = values(file[name][()])
            del file[name]
            file.create_dataset(name, data=values_of, **options)
    return work


def one_for_two(path):
    """Makes two names of one dataset."""
    with h5py.File(path.with_suffix(".h5"), "a") as file:
        del file["Function/f/1"]
        file["Function/f/1"] = file["Function/f/0"]


SET = '<Set Name="some" SetType="Node"><DataItem Dimensions="2" NumberType="Int" Format="XML">3 5</DataItem></Set></Grid>\n'
QUADRILATERALS = """<Grid Name="again" GridType="Uniform"><Topology TopologyType="Quadrilateral">
<DataItem Dimensions="900 4" NumberType="Int" Format="HDF">a.h5:/Mesh/mesh/topology</DataItem></Topology>
<xi:include xpointer="xpointer(/Xdmf/Domain/Grid[1]/Geometry)"/></Grid>
"""
BY_RANK_0 = {
    "another order of bytes": change_data("Cell/pair", lambda values: values.astype(">f4")),
    "chunks": change_data("Cell/pair", lambda values: values, chunks=True),
    "narrow indices": change_data("Mesh/mesh/topology", lambda values: values.astype("u2")),
    "a set": change_xml('</Grid>\n    <Grid Name="f" GridType="Collection"', SET + '<Grid Name="f" GridType="Collection"'),
    "one dataset by two names": one_for_two,
    "cells of two types in one dataset": change_xml('<Grid Name="f" GridType="Collection"',
                                                    QUADRILATERALS + '<Grid Name="f" GridType="Collection"'),
    "a dataset that the XML does not name": change_data("note", lambda values: numpy.zeros(400)),
}


@pytest.mark.parametrize("kind", BY_RANK_0)
def test_what_only_the_library_reads_is_read_by_rank_0(tmp_path, kind):
    BY_RANK_0[kind](write(tmp_path / "a.xdmf"))
    done = order(2, tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf", "--json")
    assert by(done) == "rank 0"
    old, new = read(tmp_path / "a.xdmf"), read(tmp_path / "b.xdmf")
    assert numpy.array_equal(new["Node/vector"], old["Node/vector"][new["Node/id"]])


def test_pieces_are_made_by_rank_0(tmp_path):
    write(tmp_path / "a.xdmf")
    done = order(2, tmp_path / "a.xdmf", "--pieces", tmp_path / "p", "--json")
    assert by(done) == "rank 0" and (tmp_path / "p" / "a.pvtu").exists()


def at(place, value):
    def work(values):
        values[place] = value
        return values
    return work


def without_ids(path):
    with h5py.File(path.with_suffix(".h5"), "a") as file:
        del file["Cell/id"]


POINTER = "version https://git-lfs.github.com/spec/v1\noid sha256:01ab\nsize 12345\n"
FAULTS = {
    "point 390 (counted from 0) has a coordinate that is not finite":
        change_data("Mesh/mesh/geometry", at((390, 1), numpy.nan)),
    "a cell names the point 400": change_data("Mesh/mesh/topology", at((800, 2), 400)),
    "a cell names the point -1": change_data("Mesh/mesh/topology", at((10, 0), -1)),
    "the data file 'a.h5' is missing": lambda path: path.with_suffix(".h5").unlink(),
    "HDF5 cannot open it": lambda path: os.truncate(path.with_suffix(".h5"), os.path.getsize(path.with_suffix(".h5")) // 2),
    "a.h5: is a pointer of Git LFS": lambda path: path.with_suffix(".h5").write_text(POINTER),
    "a.xdmf: is a pointer of Git LFS": lambda path: path.write_text(POINTER),
    "the XML is malformed": lambda path: os.truncate(path, os.path.getsize(path) // 2),
    "has 900 values": change_xml('Dimensions="900" Format', 'Dimensions="901" Format'),
    "'/Cell/id' is missing or damaged": without_ids,
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_on_any_rank_ends_all_with_one_line(tmp_path, fault):
    FAULTS[fault](write(tmp_path / "a.xdmf"))
    before = sorted(os.listdir(tmp_path))
    done = launch(3, "order", tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and fault in own_lines(done)[0], done.stderr
    assert sorted(os.listdir(tmp_path)) == before


@pytest.mark.parametrize("size, fault", [("4k", "b.h5: cannot be written; "), ("40k", "geometry' cannot be written"),
                                         ("550k", "b.h5: cannot be written to byte ")])
def test_a_full_disk_ends_all_ranks(tmp_path, size, fault):
    """The disk is too small for the HDF5 file without values, for libhdf5's data in it, or for the values of the ranks."""
    folder = tmp_path / "small"
    folder.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", folder], capture_output=True,
                      check=False).returncode:
        pytest.skip("needs the right to mount a file system")
    try:
        write(tmp_path / "a.xdmf", points=4000, cells=8000)
        done = launch(3, "order", tmp_path / "a.xdmf", "-o", folder / "b.xdmf")
        assert done.returncode == 2 and len(own_lines(done)) == 1 and fault in own_lines(done)[0], done.stderr
        assert os.listdir(folder) == []
    finally:
        subprocess.run(["umount", folder], check=True)
