# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""XDMF with HDF5: meshio's files, and the layouts of FEniCSx and FEniCS. h5py makes the files and checks the results."""
import re
import shutil
import xml.etree.ElementTree as ElementTree

import h5py
import meshio
import numpy
import pytest

KUHN = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
INCLUDE = '<xi:include xpointer="xpointer({})"/>'


def box(n, seed=1):
    """A cube of tetrahedra and the triangles of its lower face, with points in random order."""
    axis = numpy.arange(n + 1)
    z, y, x = numpy.meshgrid(axis, axis, axis, indexing="ij")
    points = numpy.stack([x, y, z], -1).reshape(-1, 3).astype(float)
    place = (x + (n + 1) * (y + (n + 1) * z))
    low = place[:-1, :-1, :-1].ravel()
    steps = numpy.array([0, 1, n + 2, n + 1])
    corners = low[:, None] + numpy.concatenate([steps, steps + (n + 1) ** 2])
    tetrahedra = numpy.concatenate([corners[:, kuhn] for kuhn in KUHN])
    lower = corners[low < n * (n + 1)]
    triangles = numpy.concatenate([lower[:, [0, 1, 2]], lower[:, [0, 2, 3]]])
    chance = numpy.random.default_rng(seed)
    shuffle = chance.permutation(len(points))
    moved = numpy.empty_like(points)
    moved[shuffle] = points
    return moved, chance.permutation(shuffle[tetrahedra]), chance.permutation(shuffle[triangles])


def order(command, source, target, *options):
    """Orders a file and returns the old-to-new maps of vertices and cells."""
    done = command.ok("order", source, "-o", target, "--vertices", "rcm", "--elements", "min",
                      "--maps", f"{target}-maps", *options)
    assert all(" is no better" in line or "$Entities" in line for line in done.stderr.splitlines()), done.stderr
    return [numpy.load(f"{target}-maps.{of}.old_to_new.npy") for of in ("vertices", "cells")]


def item(name, path, shape, kind="Float", precision=8):
    dimensions = " ".join(map(str, shape))
    return (f'<DataItem Dimensions="{dimensions}" NumberType="{kind}" Precision="{precision}" Format="HDF">'
            f"{name}:{path}</DataItem>")


def xdmf(grids):
    return ('<?xml version="1.0"?>\n<!DOCTYPE Xdmf SYSTEM "Xdmf.dtd" []>\n'
            f'<Xdmf Version="3.0" xmlns:xi="https://www.w3.org/2001/XInclude">\n  <Domain>\n{grids}\n  </Domain>\n</Xdmf>\n')


def topology(name, path, kind, shape):
    return (f'<Topology TopologyType="{kind}" NumberOfElements="{shape[0]}" NodesPerElement="{shape[1]}">'
            f'{item(name, path, shape, "Int")}</Topology>')


def attribute(name, center, data, kind="Scalar"):
    return f'<Attribute Name="{name}" AttributeType="{kind}" Center="{center}">{data}</Attribute>'


def write_fenicsx(folder, points, tetrahedra, triangles, tagged, values):
    """A mesh with tags of facets and of some cells and a function in three time steps, as dolfinx 0.9 writes them."""
    steps = [points @ [1, 2, 3] * k for k in range(3)]
    with h5py.File(folder / "a.h5", "w") as file:
        file["/Mesh/mesh/geometry"] = points
        file["/Mesh/mesh/topology"] = tetrahedra.astype("int64")
        file["/MeshTags/facet_tags/topology"] = triangles.astype("int64")
        file["/MeshTags/facet_tags/Values"] = (10 + numpy.arange(len(triangles), dtype="int32"))[:, None]
        file["/MeshTags/cell_tags/topology"] = tetrahedra[tagged].astype("int64")
        file["/MeshTags/cell_tags/Values"] = values.astype("int32")[:, None]
        for k, step in enumerate(steps):
            file.create_dataset(f"/Function/u/{k}", data=step[:, None], chunks=(16, 1), compression="gzip",
                                compression_opts=7, shuffle=True)
        file["/Mesh/mesh/topology"].attrs["celltype"] = "tetrahedron"
        file["/notes/text"] = "made by hand"
        file["/notes"].attrs["unit"] = "mm"
        file["/alias"] = h5py.SoftLink("/notes/text")
    n, mesh = len(points), "/Xdmf/Domain/Grid[@GridType='Uniform'][1]/*[self::Topology or self::Geometry]"
    grids = ['<Grid Name="mesh" GridType="Uniform">' +
             topology("a.h5", "/Mesh/mesh/topology", "Tetrahedron", tetrahedra.shape) +
             f'<Geometry GeometryType="XYZ">{item("a.h5", "/Mesh/mesh/geometry", points.shape)}</Geometry></Grid>']
    for name, kind, count, width in [("facet_tags", "Triangle", len(triangles), 3), ("cell_tags", "Tetrahedron", len(tagged), 4)]:
        grids.append(f'<Grid Name="{name}" GridType="Uniform">' + INCLUDE.format("/Xdmf/Domain/Grid/Geometry") +
                     topology("a.h5", f"/MeshTags/{name}/topology", kind, (count, width)) +
                     attribute(name, "Cell", item("a.h5", f"/MeshTags/{name}/Values", (count, 1), "Int", 4)) + "</Grid>")
    grids.append('<Grid Name="u" GridType="Collection" CollectionType="Temporal">' + "".join(
        f'<Grid Name="u" GridType="Uniform">{INCLUDE.format(mesh)}<Time Value="{0.1 * k}"/>' +
        attribute("u", "Node", item("a.h5", f"/Function/u/{k}", (n, 1))) + "</Grid>" for k in range(3)) + "</Grid>")
    (folder / "a.xdmf").write_text(xdmf("\n".join(grids)))
    return steps


def cell_rows(cells):
    return [tuple(sorted(cell)) for cell in cells.tolist()]


def unmarked(path):
    """The XML without the mark that it shares with its HDF5 file."""
    with h5py.File(path.with_suffix(".h5")) as file:
        mark = file.attrs["meshorder"].decode()
    assert re.fullmatch("[0-9a-f]{16}", mark)
    text = path.read_text()
    assert text.count(f"<?meshorder {mark}?>") == 1
    return text.replace(f"<?meshorder {mark}?>", "")


def test_files_of_two_runs_are_refused(command, tmp_path):
    write_fenicsx(tmp_path, *box(3), numpy.arange(5), numpy.arange(5))
    for method in ("rcm", "hilbert"):
        command.ok("order", "a.xdmf", "-o", "b.xdmf", "--vertices", method)
        shutil.copy(tmp_path / "b.h5", tmp_path / f"{method}.h5")
    command.ok("info", "b.xdmf")
    shutil.copy(tmp_path / "rcm.h5", tmp_path / "b.h5")
    line = command.fails("info", "b.xdmf")
    assert "'b.h5' was not written together with this file" in line and "b.xdmf:" in line
    # a user who removes the mark may combine the two files
    xml = (tmp_path / "b.xdmf").read_text()
    (tmp_path / "b.xdmf").write_text(re.sub(r"<\?meshorder .*?\?>", "", xml))
    command.ok("info", "b.xdmf")
    (tmp_path / "b.xdmf").write_text(xml)
    with h5py.File(tmp_path / "b.h5", "r+") as file:
        del file.attrs["meshorder"]
    assert "'b.h5' was not written together with this file" in command.fails("info", "b.xdmf")


def test_plain_binary_files_of_two_runs_are_refused(command, tmp_path):
    points, cells, _ = box(2)
    points.astype("<f8").tofile(tmp_path / "points.bin")
    text = "\n".join(" ".join(map(str, cell)) for cell in cells)
    (tmp_path / "a.xdmf").write_text(f"""<Xdmf Version="3.0"><Domain><Grid>
<Topology TopologyType="Tetrahedron" NumberOfElements="{len(cells)}"><DataItem Dimensions="{len(cells)} 4" NumberType="Int">{text}</DataItem>
</Topology><Geometry><DataItem Format="Binary" Endian="Little" Precision="8" Dimensions="{len(points)} 3">points.bin</DataItem>
</Geometry></Grid></Domain></Xdmf>""")
    for method in ("rcm", "hilbert"):
        command.ok("order", "a.xdmf", "-o", "b.xdmf", "--vertices", method)
        shutil.copy(tmp_path / "b0.bin", tmp_path / f"{method}.bin")
    command.ok("info", "b.xdmf")
    shutil.copy(tmp_path / "rcm.bin", tmp_path / "b0.bin")
    line = command.fails("info", "b.xdmf")
    assert "'b0.bin' was not written together with this file" in line and "b.xdmf:" in line
    # a file in another order has the checksum of its own data
    shutil.copy(tmp_path / "hilbert.bin", tmp_path / "b0.bin")
    command.ok("order", "b.xdmf", "-o", "c.xdmf", "--vertices", "scrambled")
    command.ok("info", "c.xdmf")


def test_fenicsx_mesh_tags_and_functions_move_together(command, tmp_path):
    points, tetrahedra, triangles = box(4)
    tagged = numpy.random.default_rng(2).permutation(len(tetrahedra))[:60]
    tags = 100 + tagged
    steps = write_fenicsx(tmp_path, points, tetrahedra, triangles, tagged, tags)
    vertices, cells = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    assert (numpy.diff(vertices) != 1).any()
    with h5py.File(tmp_path / "a.h5") as old, h5py.File(tmp_path / "b.h5") as new:
        names = []
        old.visit(names.append)
        found = []
        new.visit(found.append)
        assert sorted(found) == sorted(names)
        assert (new["/Mesh/mesh/geometry"][()][vertices] == points).all()
        assert (new["/Mesh/mesh/topology"][()][cells[:len(tetrahedra)]] == vertices[tetrahedra]).all()
        # facets are cells of the mesh after the tetrahedra
        facets = cells[len(tetrahedra):] - len(tetrahedra)
        assert (new["/MeshTags/facet_tags/topology"][()][facets] == vertices[triangles]).all()
        assert (new["/MeshTags/facet_tags/Values"][()][facets, 0] == 10 + numpy.arange(len(triangles))).all()
        by_cell = dict(zip(cell_rows(new["/MeshTags/cell_tags/topology"][()]), new["/MeshTags/cell_tags/Values"][:, 0]))
        assert by_cell == dict(zip(cell_rows(vertices[tetrahedra[tagged]]), tags))
        for k, step in enumerate(steps):
            dataset = new[f"/Function/u/{k}"]
            assert (dataset[()][vertices, 0] == step).all()
            assert (dataset.chunks, dataset.compression, dataset.compression_opts, dataset.shuffle) == ((16, 1), "gzip", 7, True)
        for path in names:
            if isinstance(old[path], h5py.Dataset):
                assert new[path].dtype == old[path].dtype and new[path].shape == old[path].shape
        assert new["/Mesh/mesh/topology"].attrs["celltype"] == "tetrahedron"
        assert new["/notes/text"][()] == b"made by hand" and new["/notes"].attrs["unit"] == "mm"
        assert new.get("/alias", getlink=True).path == "/notes/text"
    assert unmarked(tmp_path / "b.xdmf") == (tmp_path / "a.xdmf").read_text().replace("a.h5:", "b.h5:")


def test_identity_keeps_fenicsx_files_as_they_are(command, tmp_path):
    points, tetrahedra, triangles = box(3)
    tagged = numpy.array([7, 3, 50])
    write_fenicsx(tmp_path, points, tetrahedra, triangles, tagged, tagged + 1)
    command.ok("order", tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf", "--vertices", "original", "--elements", "original")
    with h5py.File(tmp_path / "a.h5") as old, h5py.File(tmp_path / "b.h5") as new:
        def same(path, item):
            if isinstance(item, h5py.Dataset):
                assert new[path].dtype == item.dtype and numpy.array_equal(new[path][()], item[()]), path
        old.visititems(same)


def test_groups_that_record_the_order_of_links_keep_it(command, tmp_path):
    points, tetrahedra, _ = box(2)
    names = ["zeta", "an array with a long name", "mu", "alpha", "another array with a long name"]
    with h5py.File(tmp_path / "a.h5", "w", track_order=True) as file:
        group = file.create_group("values", track_order=True)
        for name in names:
            group[name] = points[:, 0]
        file["points"], file["cells"] = points, tetrahedra
    data = "".join(attribute(name, "Node", item("a.h5", f"/values/{name}", [len(points)])) for name in sorted(names))
    (tmp_path / "a.xdmf").write_text(xdmf(
        f'<Grid>{topology("a.h5", "/cells", "Tetrahedron", tetrahedra.shape)}'
        f'<Geometry GeometryType="XYZ">{item("a.h5", "/points", points.shape)}</Geometry>{data}</Grid>'))
    order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    with h5py.File(tmp_path / "b.h5") as file:
        assert list(file["/"]) == ["values", "points", "cells"] and list(file["values"]) == names


def test_labels_of_fenicsx_reach_other_formats(command, tmp_path):
    points, tetrahedra, triangles = box(2)
    tagged = numpy.arange(len(tetrahedra))
    write_fenicsx(tmp_path, points, tetrahedra, triangles, tagged, 1 + tagged % 3)
    done = command.ok("order", tmp_path / "a.xdmf", "-o", tmp_path / "b.mesh", "--vertices", "original", "--elements", "original")
    medit = meshio.read(tmp_path / "b.mesh")
    refs = {block.type: ref for block, ref in zip(medit.cells, medit.cell_data["medit:ref"])}
    assert (refs["tetra"] == 1 + tagged % 3).all() and (refs["triangle"] == 10 + numpy.arange(len(triangles))).all()
    assert "the times of 3 steps" in done.stderr


def test_legacy_fenics_writes_the_mesh_in_each_step(command, tmp_path):
    points, tetrahedra, triangles = box(3)
    values = [points @ [1, 1, 1] + k for k in range(2)]
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for k in range(2):
            file[f"/Mesh/{k}/mesh/topology"] = tetrahedra.astype("uint32")
            file[f"/Mesh/{k}/mesh/geometry"] = points
            file[f"/VisualisationVector/{k}"] = values[k][:, None]
        file["/MeshValueCollection/0/topology"] = triangles.astype("uint32")
        file["/MeshValueCollection/0/values"] = numpy.arange(len(triangles), dtype="uint64")[:, None]

    def mesh(k):
        return (topology("a.h5", f"/Mesh/{k}/mesh/topology", "Tetrahedron", tetrahedra.shape) +
                f'<Geometry GeometryType="XYZ">{item("a.h5", f"/Mesh/{k}/mesh/geometry", points.shape)}</Geometry>')
    grids = '<Grid Name="TimeSeries_f" GridType="Collection" CollectionType="Temporal">' + "".join(
        f'<Grid Name="mesh" GridType="Uniform">{mesh(k)}<Time Value="{k}"/>' +
        attribute("f", "Node", item("a.h5", f"/VisualisationVector/{k}", (len(points), 1))) + "</Grid>" for k in range(2))
    grids += ('</Grid><Grid Name="mesh" GridType="Uniform">' +
              topology("a.h5", "/MeshValueCollection/0/topology", "Triangle", triangles.shape) +
              f'<Geometry GeometryType="XYZ">{item("a.h5", "/Mesh/0/mesh/geometry", points.shape)}</Geometry>' +
              attribute("f", "Cell", item("a.h5", "/MeshValueCollection/0/values", (len(triangles), 1), "UInt")) + "</Grid>")
    (tmp_path / "a.xdmf").write_text(xdmf(grids))
    vertices, cells = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    with h5py.File(tmp_path / "b.h5") as new:
        for k in range(2):
            assert (new[f"/Mesh/{k}/mesh/topology"][()][cells[:len(tetrahedra)]] == vertices[tetrahedra]).all()
            assert (new[f"/Mesh/{k}/mesh/geometry"][()][vertices] == points).all()
            assert (new[f"/VisualisationVector/{k}"][()][vertices, 0] == values[k]).all()
        facets = cells[len(tetrahedra):] - len(tetrahedra)
        assert (new["/MeshValueCollection/0/topology"][()][facets] == vertices[triangles]).all()
        assert (new["/MeshValueCollection/0/values"][()][facets, 0] == numpy.arange(len(triangles))).all()


@pytest.mark.parametrize("data_format", ["HDF", "XML", "Binary"])
def test_meshio_reads_what_becomes_of_its_files(command, tmp_path, monkeypatch, data_format):
    monkeypatch.chdir(tmp_path)  # where meshio looks for binary files
    points, tetrahedra, _ = box(4)
    numbers = numpy.arange(len(tetrahedra), dtype="int32")
    mesh = meshio.Mesh(points, [("tetra", tetrahedra)], {"x": points[:, 0].copy(), "at": points.astype("float32")},
                       {"number": [numbers]})
    meshio.xdmf.write(tmp_path / "a.xdmf", mesh, data_format=data_format)
    vertices, cells = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    (tmp_path / "a.h5").unlink(missing_ok=True)
    after = meshio.read(tmp_path / "b.xdmf")
    assert (after.points[vertices] == points).all() and (after.points == after.point_data["at"]).all()
    assert (after.point_data["x"] == after.points[:, 0]).all() and after.point_data["at"].dtype == "float32"
    assert (after.cells[0].data[cells] == vertices[tetrahedra]).all()
    assert (after.cell_data["number"][0][cells] == numbers).all() and after.cell_data["number"][0].dtype == "int32"


@pytest.mark.parametrize("data_format", ["HDF", "XML"])
def test_time_series_of_meshio(command, tmp_path, monkeypatch, data_format):
    monkeypatch.chdir(tmp_path)  # where meshio leaves the HDF5 file
    points, tetrahedra, _ = box(3)
    with meshio.xdmf.TimeSeriesWriter("a.xdmf", data_format=data_format) as writer:
        writer.write_points_cells(points, [("tetra", tetrahedra)])
        for k in range(4):
            writer.write_data(0.25 * k, point_data={"u": points * k}, cell_data={"c": [numpy.arange(len(tetrahedra)) + k]})
    vertices, cells = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    with meshio.xdmf.TimeSeriesReader("b.xdmf") as reader:
        after, blocks = reader.read_points_cells()
        assert (after[vertices] == points).all() and (blocks[0].data[cells] == vertices[tetrahedra]).all()
        assert reader.num_steps == 4
        for k in range(4):
            time, point_data, cell_data = reader.read_data(k)
            assert time == 0.25 * k and (point_data["u"] == after * k).all()
            assert (cell_data["c"][0][cells] == numpy.arange(len(tetrahedra)) + k).all()


def test_a_mesh_of_another_format_becomes_one_grid_for_each_dimension(command, tmp_path):
    points, tetrahedra, triangles = box(3)
    labels = [numpy.arange(len(tetrahedra)) % 4 + 1, numpy.arange(len(triangles)) % 3 + 7]
    meshio.write(tmp_path / "a.mesh", meshio.Mesh(points, [("tetra", tetrahedra), ("triangle", triangles)],
                                                  cell_data={"medit:ref": labels}))
    vertices, cells = order(command, tmp_path / "a.mesh", tmp_path / "b.xdmf")
    grids = ElementTree.parse(tmp_path / "b.xdmf").getroot().find("Domain").findall("Grid")
    assert [grid.get("Name") for grid in grids] == ["mesh", "facet_tags"]
    assert [grid.find("Topology").get("TopologyType") for grid in grids] == ["Tetrahedron", "Triangle"]
    texts = [data.text for data in grids[0].iter("DataItem")]
    assert texts[:2] == ["b.h5:/Mesh/mesh/topology", "b.h5:/Mesh/mesh/geometry"]
    with h5py.File(tmp_path / "b.h5") as file:
        assert (file["/Mesh/mesh/geometry"][()][vertices] == points).all()
        assert (file["/Mesh/mesh/topology"][()][cells[:len(tetrahedra)]] == vertices[tetrahedra]).all()
        facets = cells[len(tetrahedra):] - len(tetrahedra)
        assert (file["/MeshTags/facet_tags/topology"][()][facets] == vertices[triangles]).all()
        assert (file["/MeshTags/facet_tags/Values"][()][facets] == labels[1]).all()
    command.ok("order", tmp_path / "b.xdmf", "-o", tmp_path / "c.mesh", "--vertices", "original", "--elements", "original")
    medit = meshio.read(tmp_path / "c.mesh")
    back = {block.type: (block.data, ref) for block, ref in zip(medit.cells, medit.cell_data["medit:ref"])}
    assert (back["tetra"][0][cells[:len(tetrahedra)]] == vertices[tetrahedra]).all()
    assert (back["tetra"][1][cells[:len(tetrahedra)]] == labels[0]).all() and (back["triangle"][1][facets] == labels[1]).all()


# for each further node of second-order cells, in VTK's order, the corners whose mean it is
HEXAHEDRON = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
MIDDLES = {
    "line3": [(0, 1)], "triangle6": [(0, 1), (1, 2), (2, 0)], "quad8": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "quad9": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 1, 2, 3)],
    "tetra10": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "pyramid13": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
    "wedge15": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "hexahedron20": HEXAHEDRON,
    "hexahedron27": HEXAHEDRON + [(0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (3, 2, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7),
                                  tuple(range(8))],
}
CORNERS = {
    "line": [(0, 0, 0), (2, 0, 0)], "triangle": [(0, 0, 0), (2, 0, 0), (0, 2, 0)],
    "quad": [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], "tetra": [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)],
    "pyramid": [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (1, 1, 2)],
    "wedge": [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (0, 2, 2)],
    "hexahedron": [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)],
}


XDMF_NAMES = {"line3": "Edge_3", "triangle6": "Triangle_6", "quad8": "Quadrilateral_8", "quad9": "Quadrilateral_9",
              "tetra10": "Tetrahedron_10", "pyramid13": "Pyramid_13", "wedge15": "Wedge_15",
              "hexahedron20": "Hexahedron_20", "hexahedron27": "Hexahedron_27"}


@pytest.mark.parametrize("kind", MIDDLES)
def test_nodes_of_second_order_cells_are_where_vtk_has_them(command, tmp_path, kind):
    corners = numpy.array(CORNERS[kind.rstrip("0123456789")], float)
    cell = numpy.concatenate([corners, [corners[list(of)].mean(0) for of in MIDDLES[kind]]])
    cells = numpy.stack([numpy.arange(len(cell)), len(cell) + numpy.arange(len(cell))])
    points = numpy.concatenate([cell, cell + 5])
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["/cells"], file["/points"] = cells, points
    (tmp_path / "a.xdmf").write_text(xdmf(
        "<Grid>" + topology("a.h5", "/cells", XDMF_NAMES[kind], cells.shape) +
        f'<Geometry GeometryType="XYZ">{item("a.h5", "/points", points.shape)}</Geometry></Grid>'))
    order(command, tmp_path / "a.xdmf", tmp_path / "b.msh")  # Gmsh has its own order of nodes
    order(command, tmp_path / "b.msh", tmp_path / "c.xdmf")
    found = ElementTree.parse(tmp_path / "c.xdmf").getroot().find("Domain/Grid/Topology")
    assert found.get("TopologyType") == XDMF_NAMES[kind]
    with h5py.File(tmp_path / "c.h5") as file:
        nodes = file["/Mesh/mesh/geometry"][()][file["/Mesh/mesh/topology"][()]]
    assert sorted(nodes.tolist()) == sorted(points[cells].tolist())
    if kind not in ("wedge15", "pyramid13"):  # meshio 5.0 does not read these two
        gmsh = meshio.read(tmp_path / "b.msh")
        assert sorted(gmsh.points[gmsh.cells[0].data].tolist()) == sorted(points[cells].tolist())


def test_arrays_that_share_a_dataset_keep_their_values(command, tmp_path):
    """A dataset of an array of points and an array of cells is split if the two are reordered differently. A dataset of two
    arrays of points stays one."""
    points, _, _ = box(2)
    edges = numpy.stack([numpy.arange(27), numpy.random.default_rng(3).permutation(27)], -1)
    edges = edges[edges[:, 0] != edges[:, 1]]
    edges = numpy.concatenate([edges, [[0, 1]] * (27 - len(edges))])
    values = numpy.arange(27, dtype="int32") ** 2
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["points"], file["edges"], file["values"] = points, edges.astype("int32"), values
        file["Attributes/0"] = 7  # no element names this dataset
    shared = item("a.h5", "/values", (27,), "Int", 4)
    (tmp_path / "a.xdmf").write_text(xdmf(
        '<Grid Name="g" GridType="Uniform">' + topology("a.h5", "/edges", "Polyline", (27, 2)) + '<Geometry GeometryType="XYZ">'
        + item("a.h5", "/points", (27, 3)) + "</Geometry>" + attribute("of points", "Node", shared)
        + attribute("again", "Node", shared) + attribute("of cells", "Cell", shared) + "</Grid>"))
    vertices, cells = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    named = {element.get("Name"): element.find("DataItem").text.strip().split(":")
             for element in ElementTree.parse(tmp_path / "b.xdmf").iter("Attribute")}
    assert named["of points"] == named["again"] == ["b.h5", "/values"]
    with h5py.File(tmp_path / "b.h5") as file:
        numpy.testing.assert_array_equal(file[named["of points"][1]][()][vertices], values)
        numpy.testing.assert_array_equal(file[named["of cells"][1]][()][cells], values)
    command.ok("apply", "--inverse", tmp_path / "b.xdmf-maps", tmp_path / "b.xdmf", "-o", tmp_path / "c.xdmf")
    with h5py.File(tmp_path / "c.h5") as file:
        for name in named.values():
            numpy.testing.assert_array_equal(file[name[1]], values)
        assert file["Attributes/0"][()] == 7


def test_arrays_whose_paths_lead_to_one_dataset_keep_their_values(command, tmp_path):
    """The paths contain a hard link, a soft link and a soft link to the root."""
    points, tetrahedra, _ = box(2)
    count = len(tetrahedra)
    points = numpy.concatenate([points, numpy.random.default_rng(1).uniform(5, 6, (count - 27, 3))])
    values = numpy.arange(count, dtype="int32") ** 2
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["points"], file["cells"], file["values"] = points, tetrahedra.astype("int64"), values
        file["hard"] = file["values"]
        file["soft"], file["round"] = h5py.SoftLink("/values"), h5py.SoftLink("/")
    paths = {"of points": "/values", "of cells": "/soft", "again": "/hard", "around": "/round/round/values"}
    arrays = "".join(attribute(name, "Node" if name == "of points" else "Cell", item("a.h5", path, (count,), "Int", 4))
                     for name, path in paths.items())
    (tmp_path / "a.xdmf").write_text(xdmf(
        '<Grid Name="g" GridType="Uniform">' + topology("a.h5", "/cells", "Tetrahedron", tetrahedra.shape)
        + '<Geometry GeometryType="XYZ">' + item("a.h5", "/points", points.shape) + "</Geometry>" + arrays + "</Grid>"))
    vertices, cells = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    with h5py.File(tmp_path / "b.h5") as file:
        for name, path in paths.items():
            numpy.testing.assert_array_equal(file[path][()][vertices if name == "of points" else cells], values)
    command.ok("apply", "--inverse", tmp_path / "b.xdmf-maps", tmp_path / "b.xdmf", "-o", tmp_path / "c.xdmf")
    with h5py.File(tmp_path / "c.h5") as file:
        for path in paths.values():
            numpy.testing.assert_array_equal(file[path], values)


def test_labels_of_two_types_that_do_not_make_one_array_keep_them(command, tmp_path):
    points, tetrahedra, _ = box(2)
    count = len(tetrahedra)
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["points"], file["cells"] = points, tetrahedra.astype("int64")
        file["wide"], file["narrow"] = numpy.arange(count, dtype="int32"), numpy.arange(count, dtype="uint8")
    labels = attribute("label", "Cell", item("a.h5", "/wide", (count,), "Int", 4)) + attribute(
        "label", "Cell", item("a.h5", "/narrow", (count,), "UChar", 1))
    (tmp_path / "a.xdmf").write_text(xdmf(
        '<Grid Name="g" GridType="Uniform">' + topology("a.h5", "/cells", "Tetrahedron", tetrahedra.shape)
        + '<Geometry GeometryType="XYZ">' + item("a.h5", "/points", points.shape) + "</Geometry>" + labels + "</Grid>"))
    _, cells = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    with h5py.File(tmp_path / "b.h5") as file:
        assert [file[name].dtype for name in ("wide", "narrow")] == ["int32", "uint8"]
        for name in ("wide", "narrow"):
            assert file[name][()][cells].tolist() == list(range(count))


def test_a_topology_shares_its_dataset(command, tmp_path):
    """An array in the dataset of a topology gets its own dataset, because it is not renumbered with the vertices. The
    topologies of two steps keep one dataset."""
    points, tetrahedra, _ = box(2)
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["points"], file["cells"], file["values"] = points, tetrahedra.astype("int64"), points[:, 0]
    shape = tetrahedra.shape
    step = ('<Grid Name="g" GridType="Uniform">' + topology("a.h5", "/cells", "Tetrahedron", shape)
            + '<Geometry GeometryType="XYZ">' + item("a.h5", "/points", points.shape) + "</Geometry>"
            + '<Time Value="{}"/>' + attribute("u", "Node", item("a.h5", "/values", (27,))) + "{}</Grid>")
    corners = attribute("corners", "Cell", item("a.h5", "/cells", shape, "Int"), "Matrix")
    (tmp_path / "a.xdmf").write_text(xdmf('<Grid Name="t" GridType="Collection" CollectionType="Temporal">'
                                          + step.format(0, corners) + step.format(1, "") + "</Grid>"))
    vertices, cells = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    tree = ElementTree.parse(tmp_path / "b.xdmf")
    topologies = {element.find("DataItem").text.strip().split(":")[1] for element in tree.iter("Topology")}
    [kept] = [element.find("DataItem").text.strip().split(":")[1] for element in tree.iter("Attribute")
              if element.get("Name") == "corners"]
    assert len(topologies) == 1 and kept not in topologies
    with h5py.File(tmp_path / "b.h5") as file:
        numpy.testing.assert_array_equal(file[kept][()][cells], tetrahedra)
        numpy.testing.assert_array_equal(file[topologies.pop()][()][cells], vertices[tetrahedra])
    command.ok("apply", "--inverse", tmp_path / "b.xdmf-maps", tmp_path / "b.xdmf", "-o", tmp_path / "c.xdmf")
    with h5py.File(tmp_path / "c.h5") as file:
        for name in ("/cells", kept):
            numpy.testing.assert_array_equal(file[name], tetrahedra)


def test_topologies_of_two_types_share_a_dataset_until_they_differ(command, tmp_path):
    """Eight numbers are one hexahedron or two tetrahedra: the topology that is written last gets its own dataset."""
    points, _, _ = box(2)
    corners = numpy.random.default_rng(6).permutation(27)[:24]
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["points"], file["cells"] = points, corners.astype("int64")
    geometry = f'<Geometry GeometryType="XYZ">{item("a.h5", "/points", points.shape)}</Geometry>'
    (tmp_path / "a.xdmf").write_text(xdmf("".join(
        f'<Grid Name="{kind}" GridType="Uniform">' + topology("a.h5", "/cells", kind, shape) + geometry + "</Grid>"
        for kind, shape in [("Hexahedron", (3, 8)), ("Tetrahedron", (6, 4))])))
    vertices, _ = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    named = [element.find("DataItem").text.strip().split(":")[1]
             for element in ElementTree.parse(tmp_path / "b.xdmf").iter("Topology")]
    assert len(set(named)) == 2
    with h5py.File(tmp_path / "b.h5") as file:
        for name, width in zip(named, (8, 4)):
            assert sorted(file[name][()].reshape(-1, width).tolist()) == sorted(vertices[corners].reshape(-1, width).tolist())


def test_what_gets_a_dataset_of_its_own_gets_it_in_every_step(command, tmp_path):
    """27 numbers belong to points and to nine triangles: one of the two gets its own dataset, in every step."""
    points, _, _ = box(2)
    corners = numpy.random.default_rng(7).permutation(27)
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["points"], file["cells"] = points, corners.astype("int32")
    geometry = f'<Geometry GeometryType="XYZ">{item("a.h5", "/points", points.shape)}</Geometry>'
    step = (topology("a.h5", "/cells", "Triangle", (9, 3)).replace('Precision="8"', 'Precision="4"') + geometry +
            attribute("number", "Node", item("a.h5", "/cells", (9, 3), "Int", 4)) +
            attribute("again", "Node", '<DataItem Reference="/Xdmf/Domain/Grid/Grid[1]/Attribute[1]/DataItem"/>'))
    (tmp_path / "a.xdmf").write_text(xdmf('<Grid GridType="Collection" CollectionType="Temporal">' + "".join(
        f'<Grid Name="step">{step}<Time Value="{time}"/></Grid>' for time in range(3)) + "</Grid>"))
    vertices, _ = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    written = ElementTree.parse(tmp_path / "b.xdmf")
    items = [element.find("DataItem") for element in written.iter("Attribute")]
    numbers, cells = items[::2], [element.find("DataItem") for element in written.iter("Topology")]
    assert len(numbers) == len(cells) == 3
    names = [{data.text.strip() for data in data_of} for data_of in (numbers, items[1::2], cells)]
    assert [len(named) for named in names] == [1, 1, 1] and names[2].isdisjoint(names[0] | names[1])
    assert {data.get("Dimensions") for data in items} == {"27"}
    with h5py.File(tmp_path / "b.h5") as file:
        of_points = numpy.empty(27, "int32")
        of_points[vertices] = corners
        for named in names[:2]:
            assert (file[named.pop().split(":")[1]][()] == of_points).all()
        assert sorted(map(sorted, file["cells"][()].reshape(9, 3).tolist())) == sorted(map(sorted, vertices[corners].reshape(9, 3).tolist()))


@pytest.mark.parametrize("other", ["an array of cells", "cells of another type"])
def test_values_that_move_in_two_ways_get_two_items(command, tmp_path, other):
    """A DataItem becomes its own if it refers to an item whose values are reordered in another way."""
    points, _, _ = box(2)
    corners = numpy.random.default_rng(6).permutation(27)[:24]
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["points"], file["cells"] = points, corners.astype("int64")
    geometry = f'<Geometry GeometryType="XYZ">{item("a.h5", "/points", points.shape)}</Geometry>'
    same = '<DataItem Reference="XML">/Xdmf/Domain/Grid/Topology/DataItem</DataItem>'
    hexahedra = topology("a.h5", "/cells", "Hexahedron", (3, 8)) + geometry
    of_cells = other.startswith("an array")
    (tmp_path / "a.xdmf").write_text(xdmf(
        f'<Grid Name="a">{hexahedra}{attribute("u", "Cell", same, "Matrix")}</Grid>' if of_cells else
        f'<Grid Name="a">{hexahedra}</Grid><Grid Name="b"><Topology TopologyType="Tetrahedron">{same}</Topology>{geometry}</Grid>'))
    vertices, cells = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    written = ElementTree.parse(tmp_path / "b.xdmf")
    first, second = ([*written.iter("Topology")] + [*written.iter("Attribute")])[:2]
    assert second.find("DataItem").get("Reference") is None
    with h5py.File(tmp_path / "b.h5") as file:
        hexahedra, others = (file[element.find("DataItem").text.strip().split(":")[1]][()] for element in (first, second))
    assert sorted(hexahedra.reshape(3, 8).tolist()) == sorted(vertices[corners].reshape(3, 8).tolist())
    if of_cells:
        moved = numpy.empty((3, 8), int)
        moved[cells] = corners.reshape(3, 8)
        assert (others.reshape(3, 8) == moved).all()
    else:
        assert sorted(others.reshape(6, 4).tolist()) == sorted(vertices[corners].reshape(6, 4).tolist())


def test_a_set_and_an_array_of_one_item(command, tmp_path):
    """If a mesh changes the order of a set, the set's marks become numbers; an array that refers to them keeps its values."""
    points, tetrahedra, _ = box(2)
    marks = numpy.zeros(27, "uint8")
    marks[[3, 9, 20, 26]] = 1
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["points"], file["cells"], file["marks"] = points, tetrahedra, marks
    of_set = '<DataItem Reference="/Xdmf/Domain/Grid/Attribute[2]/DataItem"/>'
    (tmp_path / "a.xdmf").write_text(xdmf(
        f'<Grid Name="a">{topology("a.h5", "/cells", "Tetrahedron", tetrahedra.shape)}'
        f'<Geometry GeometryType="XYZ">{item("a.h5", "/points", points.shape)}</Geometry>'
        f'{attribute("number", "Node", of_set)}{attribute("set:some", "Node", item("a.h5", "/marks", (27,), "UChar", 1))}</Grid>'))
    vertices, _ = order(command, tmp_path / "a.xdmf", tmp_path / "b.xdmf")
    items = {element.get("Name"): element.find("DataItem") for element in ElementTree.parse(tmp_path / "b.xdmf").iter("Attribute")}
    with h5py.File(tmp_path / "b.h5") as file:
        values = {name: file[data.text.strip().split(":")[1]][()] for name, data in items.items()}
    assert (values["number"][vertices] == marks).all()
    assert ((values["set:some"][vertices] != 0) == marks).all()


def test_an_attribute_of_two_grids_with_other_cells_is_refused(command, tmp_path):
    points, _, _ = box(2)
    corners = numpy.arange(24)
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["points"], file["cells"], file["u"] = points, corners, numpy.arange(3.0)
    geometry = f'<Geometry GeometryType="XYZ">{item("a.h5", "/points", points.shape)}</Geometry>'
    triangles = '<Topology TopologyType="Triangle"><DataItem Dimensions="3 3" NumberType="Int">0 1 2 1 2 3 2 3 4</DataItem></Topology>'
    (tmp_path / "a.xdmf").write_text(xdmf(
        f'<Grid Name="a">{topology("a.h5", "/cells", "Hexahedron", (3, 8))}{geometry}'
        f'{attribute("u", "Cell", item("a.h5", "/u", (3,)))}</Grid>'
        f'<Grid Name="b">{triangles}{geometry}<Attribute Reference="/Xdmf/Domain/Grid[1]/Attribute"/></Grid>'))
    fault = command.fails("order", tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf")
    assert "the <Attribute> is referred to by a Grid with other cells" in fault


BROKEN = {
    "a <Xdmf> follows the <Xdmf> element": ("</Xdmf>", "</Xdmf>\n<Xdmf/>"),
    "data file 'c.h5' is missing; copy it to /": ("a.h5:/Mesh/mesh/topology", "c.h5:/Mesh/mesh/topology"),
    "the dataset '/Mesh/mesh/cells' is missing": ("a.h5:/Mesh/mesh/topology", "a.h5:/Mesh/mesh/cells"),
    "Dimensions is '48 5'": ('Dimensions="48 4"', 'Dimensions="48 5"'),
    "selects a part of a dataset": ("/Mesh/mesh/geometry<", "/Mesh/mesh/geometry|0 0|1 1|5 3<"),
    "is a HyperSlab": ("<DataItem Dimensions", '<DataItem ItemType="HyperSlab" Dimensions'),
    "is a Function": ("<DataItem Dimensions", '<DataItem ItemType="Function" Function="JOIN($0;$1)" Dimensions'),
    "3DCoRectMesh', which is structured": ('"Tetrahedron"', '"3DCoRectMesh"'),
    "names no element of the file": ("/Xdmf/Domain/Grid/Geometry", "/Xdmf/Domain/Grid/Nothing"),
    "is not an XPath": ("/Xdmf/Domain/Grid/Geometry", "/Xdmf/Domain/Grid["),
    "is on each Face": ('Name="facet_tags" AttributeType="Scalar" Center="Cell"',
                        'Name="facet_tags" AttributeType="Scalar" Center="Face"'),
    "a spatial collection holds several meshes": ('"Temporal"', '"Spatial"'),
    "the XML is malformed": ("</Domain>", ""),
    "reached through '/elsewhere', a link to another file": ("a.h5:/Mesh/mesh/geometry", "a.h5:/elsewhere/mesh/geometry"),
    "claims 1000000000000 values": ('Dimensions="27 3" NumberType="Float" Precision="8" Format="HDF">a.h5:/Mesh/mesh/geometry',
                                    'Dimensions="1000000000000" Format="HDF">a.h5:/huge'),
    "does not hold plain numbers": ("a.h5:/Mesh/mesh/topology", "a.h5:/notes/text"),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_a_fault_of_the_xml_is_one_line(command, tmp_path, fault):
    points, tetrahedra, triangles = box(2)
    write_fenicsx(tmp_path, points, tetrahedra, triangles, numpy.arange(5), numpy.arange(5))
    with h5py.File(tmp_path / "a.h5", "a") as file:
        file["/elsewhere"] = h5py.ExternalLink("other.h5", "/")
        file.create_dataset("/huge", (10 ** 12,), "f8")
    (tmp_path / "other.h5").write_bytes((tmp_path / "a.h5").read_bytes())
    old, new = BROKEN[fault]
    text = (tmp_path / "a.xdmf").read_text()
    assert old in text
    (tmp_path / "a.xdmf").write_text(text.replace(old, new))
    assert fault in command.fails("order", tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf")
    assert not (tmp_path / "b.xdmf").exists() and not (tmp_path / "b.h5").exists()


def test_damaged_hdf5_files_end_in_one_line(command, tmp_path):
    points, tetrahedra, triangles = box(2)
    write_fenicsx(tmp_path, points, tetrahedra, triangles, numpy.arange(5), numpy.arange(5))
    whole = (tmp_path / "a.h5").read_bytes()
    for size in [1, 100, 1000, len(whole) // 2, len(whole) - 1]:
        (tmp_path / "a.h5").write_bytes(whole[:size])
        assert "a.h5: HDF5 cannot open it" in command.fails("order", tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf")
    # a point that does not exist
    (tmp_path / "a.h5").write_bytes(whole)
    with h5py.File(tmp_path / "a.h5", "a") as file:
        file["/Mesh/mesh/topology"][7, 2] = len(points)
    fault = command.fails("order", tmp_path / "a.xdmf", "-o", tmp_path / "b.xdmf")
    assert "cell 7 (counted from 0) names a point that does not exist" in fault
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.h5", "a.xdmf"]


def test_entities_mean_what_an_xml_reader_says(command, tmp_path):
    # PETSc writes the name of the HDF5 file as an entity; Python's XML reader says what the file means
    points, tetrahedra, _ = box(3)
    files = {kind: tmp_path / kind for kind in ("entity", "plain")}
    for folder in files.values():
        folder.mkdir()
        with h5py.File(folder / "a.h5", "w") as file:
            file["/viz/topology/cells"] = tetrahedra
            file["/geometry/vertices"] = points
    text = xdmf('<Grid Name="&name;">' + topology("&HeavyData;", "/viz/topology/cells", "Tetrahedron", tetrahedra.shape)
                + f'<Geometry GeometryType="XYZ">{item("&HeavyData;", "/geometry/vertices", points.shape)}</Geometry></Grid>')
    text = text.replace("[]", '[\n<!ENTITY HeavyData "a.h5">\n<!ENTITY name \'"&#38;HeavyData;" &#169;\'>\n]')
    (files["entity"] / "a.xmf").write_text(text)
    meaning = ElementTree.fromstring(text)
    assert meaning.find("Domain/Grid").get("Name") == '"a.h5" \xa9'
    (files["plain"] / "a.xmf").write_bytes(ElementTree.tostring(meaning, encoding="utf-8"))
    for folder in files.values():
        command.ok("order", folder / "a.xmf", "-o", folder / "b.xmf", "--vertices", "rcm", "--elements", "min")
    mark = re.compile("<.meshorder .*?>")
    first, second = [ElementTree.canonicalize(mark.sub("", (folder / "b.xmf").read_text()), strip_text=True)
                     for folder in files.values()]
    assert first == second
    with h5py.File(files["entity"] / "b.h5") as one, h5py.File(files["plain"] / "b.h5") as other:
        for name in ("/viz/topology/cells", "/geometry/vertices"):
            assert numpy.array_equal(one[name][:], other[name][:])


def test_data_in_another_folder_are_read(command, tmp_path):
    points, tetrahedra, triangles = box(2)
    (tmp_path / "in").mkdir()
    write_fenicsx(tmp_path, points, tetrahedra, triangles, numpy.arange(5), numpy.arange(5))
    text = (tmp_path / "a.xdmf").read_text().replace("a.h5:", "../a.h5:")
    (tmp_path / "in" / "a.xdmf").write_text(text)
    line = command.fails("info", tmp_path / "in" / "a.xdmf")
    assert "the data file '../a.h5' is not in the mesh's folder" in line
    order(command, tmp_path / "in" / "a.xdmf", tmp_path / "in" / "b.xdmf", "--allow-includes-from", tmp_path)
    assert unmarked(tmp_path / "in" / "b.xdmf") == text.replace("../a.h5:", "b.h5:")
