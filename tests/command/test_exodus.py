# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Exodus II files, made and read by netCDF's own module for Python and by SciPy."""
import meshio
import numpy
import pytest
import scipy.io

netCDF4 = pytest.importorskip("netCDF4")

KINDS = ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA", "NETCDF4", "NETCDF4_CLASSIC"]
SIDES_OF_HEX = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7)]


def lattice(n):
    """Points and cubes of an n × n × n lattice, moved a little so that all coordinates differ."""
    axis = numpy.arange(n + 1)
    z, y, x = numpy.meshgrid(axis, axis, axis, indexing="ij")
    points = numpy.stack([x, y, z], -1).reshape(-1, 3) + numpy.random.default_rng(3).uniform(0, 0.1, ((n + 1) ** 3, 3))
    at = lambda i, j, k: i + (n + 1) * (j + (n + 1) * k)  # noqa: E731
    cubes = [[at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1), at(i + 1, j, k + 1),
              at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)] for k in range(n) for j in range(n) for i in range(n)]
    return points, numpy.array(cubes)


def put_names(file, variable, dimension, names, length="len_name"):
    table = file.createVariable(variable, "S1", (dimension, length))
    width = len(file.dimensions[length])
    rows = numpy.zeros((len(names), width), "S1")
    for row, name in zip(rows, names):
        row[:len(name)] = list(name)
    table[:] = rows


def blocks_of_lattice(n, cubes):
    layers = numpy.split(cubes, n)
    wedges = numpy.concatenate([layers[1][:, [0, 1, 2, 4, 5, 6]], layers[1][:, [0, 2, 3, 4, 6, 7]]])
    tets = numpy.concatenate([layers[2][:, pick] for pick in (
        [0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6])])
    return [(10, "steel", "HEX", layers[0]), (20, "", "wedge6", wedges), (7, "nothing", "NULL", None),
            (5, "soil", "TETRA4", tets), (30, "skin", "SHELL", layers[0][:, [0, 3, 2, 1]])]


def write_all(path, kind="NETCDF3_64BIT_OFFSET", n=3, steps=3, real="f8"):
    """Writes a file with everything that the format can hold."""
    rng = numpy.random.default_rng(5)
    points, cubes = lattice(n)
    blocks = blocks_of_lattice(n, cubes)
    compressed = {"zlib": True, "complevel": 5} if kind == "NETCDF4" else {}
    with netCDF4.Dataset(path, "w", format=kind) as f:
        f.api_version, f.version = numpy.float32(5.22), numpy.float32(5.22)
        f.floating_point_word_size = numpy.int32(8 if real == "f8" else 4)
        f.file_size = numpy.int32(1)
        f.maximum_name_length = numpy.int32(12)
        f.title = "all that there is"
        f.my_own_attribute = numpy.array([1.5, 2.5])
        for name, length in [("len_string", 33), ("len_line", 81), ("four", 4), ("len_name", 60), ("time_step", None),
                             ("num_dim", 3), ("num_nodes", len(points)), ("num_el_blk", len(blocks)),
                             ("num_elem", sum(0 if c is None else len(c) for *_, c in blocks)), ("num_qa_rec", 1),
                             ("num_info", 2), ("nodes_of_nothing", 7)]:
            f.createDimension(name, length)

        def add(name, values, dimensions, type=None, /, **attributes):
            values = numpy.asarray(values)
            variable = f.createVariable(name, type or values.dtype, dimensions, **compressed)
            variable.setncatts(attributes)
            variable[:] = values

        add("time_whole", [0.5, 1.0, 2.5][:steps], ("time_step",), real)
        for k in range(3):
            add("coord" + "xyz"[k], points[:, k], ("num_nodes",), real, units="m")
        put_names(f, "coor_names", "num_dim", ["x", "y", "z"])
        qa = f.createVariable("qa_records", "S1", ("num_qa_rec", "four", "len_string"))
        qa[0] = numpy.array([list(text.ljust(33, "\0")) for text in ("maker", "1.0", "today", "now")], "S1")
        put_names(f, "info_records", "num_info", ["first line", "second"], "len_line")
        add("of_my_own", numpy.arange(7, dtype="i4"), ("nodes_of_nothing",), purpose="unknown")
        add("node_num_map", 100 + 2 * numpy.arange(len(points)), ("num_nodes",), "i4")
        n_elem = len(f.dimensions["num_elem"])
        add("elem_num_map", 1000 + 3 * numpy.arange(n_elem), ("num_elem",), "i4")
        f.createDimension("num_node_maps", 1)
        f.createDimension("num_elem_maps", 1)
        add("node_map1", rng.integers(0, 1000, len(points)), ("num_nodes",), "i4")
        add("elem_map1", rng.integers(0, 1000, n_elem), ("num_elem",), "i4")
        add("nm_prop1", [4], ("num_node_maps",), "i4", name="ID")
        add("em_prop1", [8], ("num_elem_maps",), "i4", name="ID")
        put_names(f, "nmap_names", "num_node_maps", ["owners"])
        put_names(f, "emap_names", "num_elem_maps", ["parents"])

        # blocks
        add("eb_status", [int(c is not None) for *_, c in blocks], ("num_el_blk",), "i4")
        add("eb_prop1", [b[0] for b in blocks], ("num_el_blk",), "i4", name="ID")
        add("eb_prop2", [11, 22, 33, 44, 55], ("num_el_blk",), "i4", name="colour")
        put_names(f, "eb_names", "num_el_blk", [b[1] for b in blocks])
        for b, (_, _, type_name, cells) in enumerate(blocks, 1):
            if cells is None:
                continue
            f.createDimension(f"num_el_in_blk{b}", len(cells))
            f.createDimension(f"num_nod_per_el{b}", cells.shape[1])
            add(f"connect{b}", cells + 1, (f"num_el_in_blk{b}", f"num_nod_per_el{b}"), "i4", elem_type=type_name)
        f.createDimension("num_att_in_blk5", 2)
        add("attrib5", rng.uniform(size=(len(blocks[4][3]), 2)), ("num_el_in_blk5", "num_att_in_blk5"), real)
        put_names(f, "attrib_name5", "num_att_in_blk5", ["thickness", "offset"])
        f.createDimension("num_att_in_blk1", 1)
        add("attrib1", rng.uniform(size=(len(blocks[0][3]), 1)), ("num_el_in_blk1", "num_att_in_blk1"), real)

        # sets
        node_sets = [(3, "left", numpy.flatnonzero(points[:, 0] < 0.5)[::-1]), (9, "", numpy.array([5, 2, 40]))]
        f.createDimension("num_node_sets", 2)
        add("ns_status", [1, 1], ("num_node_sets",), "i4")
        add("ns_prop1", [s[0] for s in node_sets], ("num_node_sets",), "i4", name="ID")
        add("ns_prop2", [70, 80], ("num_node_sets",), "i4", name="rank")
        put_names(f, "ns_names", "num_node_sets", [s[1] for s in node_sets])
        for s, (_, _, nodes) in enumerate(node_sets, 1):
            f.createDimension(f"num_nod_ns{s}", len(nodes))
            add(f"node_ns{s}", nodes + 1, (f"num_nod_ns{s}",), "i4")
        f.createDimension("num_df_ns1", len(node_sets[0][2]))
        add("dist_fact_ns1", rng.uniform(size=len(node_sets[0][2])), ("num_df_ns1",), real)

        # sides 1, 2, 5 and 6 of hexahedra, two sides of wedges and one of a tetrahedron, not sorted
        first_wedge, first_tet = n * n, 3 * n * n
        sides = [(4, 5), (1, 2), (4, 1), (0, 6), (first_wedge + 2, 1), (first_wedge + 3, 4), (first_tet + 1, 3), (1, 5)]
        counts = [4, 4, 4, 4, 4, 3, 3, 4]
        f.createDimension("num_side_sets", 2)
        add("ss_status", [1, 1], ("num_side_sets",), "i4")
        add("ss_prop1", [2, 12], ("num_side_sets",), "i4", name="ID")
        put_names(f, "ss_names", "num_side_sets", ["pressed", ""])
        for s, of_set in enumerate([sides, [(2, 5)]], 1):
            f.createDimension(f"num_side_ss{s}", len(of_set))
            add(f"elem_ss{s}", [e + 1 for e, _ in of_set], (f"num_side_ss{s}",), "i4")
            add(f"side_ss{s}", [side for _, side in of_set], (f"num_side_ss{s}",), "i4")
        f.createDimension("num_df_ss1", sum(counts))
        add("dist_fact_ss1", rng.uniform(size=sum(counts)), ("num_df_ss1",), real)
        f.createDimension("num_elem_sets", 1)
        add("els_prop1", [6], ("num_elem_sets",), "i4", name="ID")
        put_names(f, "els_names", "num_elem_sets", ["some"])
        f.createDimension("num_ele_els1", 4)
        add("elem_els1", [30, 2, 17, 9], ("num_ele_els1",), "i4")

        # variables
        def names(dimension, variable, texts):
            f.createDimension(dimension, len(texts))
            put_names(f, variable, dimension, texts)

        def series(name, *dimension):
            shape = [len(f.dimensions[d]) for d in dimension]
            add(name, rng.uniform(size=(steps, *shape)), ("time_step", *dimension), real)

        names("num_glo_var", "name_glo_var", ["energy", "work"])
        series("vals_glo_var", "num_glo_var")
        names("num_nod_var", "name_nod_var", ["ux", "a_name_of_more_than_thirty_two_characters_in_all"])
        series("vals_nod_var1", "num_nodes")
        series("vals_nod_var2", "num_nodes")
        names("num_elem_var", "name_elem_var", ["stress", "damage"])
        table = numpy.array([[1, 0], [1, 1], [0, 0], [1, 1], [1, 0]])
        add("elem_var_tab", table, ("num_el_blk", "num_elem_var"), "i4")
        for b, row in enumerate(table, 1):
            for v in numpy.flatnonzero(row) + 1:
                series(f"vals_elem_var{v}eb{b}", f"num_el_in_blk{b}")
        names("num_nset_var", "name_nset_var", ["reaction"])
        add("nset_var_tab", [[1], [0]], ("num_node_sets", "num_nset_var"), "i4")
        series("vals_nset_var1ns1", "num_nod_ns1")
        names("num_sset_var", "name_sset_var", ["traction"])
        add("sset_var_tab", [[1], [1]], ("num_side_sets", "num_sset_var"), "i4")
        series("vals_sset_var1ss1", "num_side_ss1")
        series("vals_sset_var1ss2", "num_side_ss2")


def text_rows(variable):
    variable.set_auto_mask(False)
    return [b"".join(row).split(b"\0")[0].decode() for row in variable[:]]


def content(path):
    """The content of a file, independent of the order of nodes and elements: their coordinates identify them."""
    with netCDF4.Dataset(path) as f:
        f.set_auto_mask(False)
        v = f.variables
        size = {name: len(dimension) for name, dimension in f.dimensions.items()}
        points = numpy.stack([v["coord" + c][:] for c in "xyz"], 1)
        node = [tuple(point) for point in points.tolist()]
        n_blocks, elements, blocks, start = size["num_el_blk"], [], [], 0
        attributes = sorted((name, str(f.getncattr(name))) for name in f.ncattrs() if name != "maximum_name_length")

        def all_steps(name):
            return v[name][:].T.tolist() if name in v else None

        ids, properties, eb_names = v["eb_prop1"][:], v["eb_prop2"][:], text_rows(v["eb_names"])
        table = v["elem_var_tab"][:]
        for b in range(1, n_blocks + 1):
            head = [int(ids[b - 1]), int(properties[b - 1]), eb_names[b - 1], table[b - 1].tolist()]
            if f"connect{b}" not in v:
                blocks.append((head, None))
                continue
            cells = [tuple(node[k - 1] for k in row) for row in v[f"connect{b}"][:].tolist()]
            elements += cells
            columns = [v[f"attrib{b}"][:].tolist() if f"attrib{b}" in v else None,
                       v["elem_map1"][start:start + len(cells)].tolist(),
                       *(all_steps(f"vals_elem_var{k}eb{b}") for k in (1, 2))]
            start += len(cells)
            rows = sorted((cell, *(column and column[e] for column in columns)) for e, cell in enumerate(cells))
            named = text_rows(v[f"attrib_name{b}"]) if f"attrib_name{b}" in v else None
            blocks.append(([*head, v[f"connect{b}"].elem_type, named], rows))
        nodal = sorted(zip(node, v["node_map1"][:].tolist(), *(all_steps(f"vals_nod_var{k}") for k in (1, 2))))
        node_sets = []
        for s in range(1, size["num_node_sets"] + 1):
            members = [node[k - 1] for k in v[f"node_ns{s}"][:]]
            columns = [column for name in (f"dist_fact_ns{s}", f"vals_nset_var1ns{s}") if (column := all_steps(name))]
            node_sets.append([*zip(members, *columns)])
        side_sets = []
        for s in range(1, size["num_side_sets"] + 1):
            factors = v[f"dist_fact_ss{s}"][:].tolist() if f"dist_fact_ss{s}" in v else []
            traction, rows = all_steps(f"vals_sset_var1ss{s}"), []
            for i, (e, side) in enumerate(zip(v[f"elem_ss{s}"][:], v[f"side_ss{s}"][:].tolist())):
                corners = len(elements[e - 1])
                width = 4 if corners == 8 or (corners == 6 and side < 4) else 3
                rows.append((elements[e - 1], side, tuple(factors[:width]), traction[i]))
                factors = factors[width:]
            assert not factors
            side_sets.append(sorted(rows))
        element_sets = [[elements[e - 1] for e in v["elem_els1"][:]], text_rows(v["els_names"])]
        plain = {name: v[name][:].tolist() for name in ("time_whole", "vals_glo_var", "qa_records", "of_my_own", "ns_prop1",
                                                        "ns_prop2", "ss_prop1", "els_prop1", "nm_prop1", "em_prop1",
                                                        "ss_status", "eb_status", "nset_var_tab", "sset_var_tab")}
        plain |= {name: text_rows(v[name]) for name in v if name.endswith("_names") or name.startswith("name_")}
        plain |= {"info": text_rows(v["info_records"]), "units": v["coordx"].units, "purpose": v["of_my_own"].purpose,
                  "properties": [v["eb_prop2"].name, v["ns_prop2"].name], "model": f.data_model,
                  "real": [v[k].dtype.str for k in ("coordx", "vals_nod_var1", "dist_fact_ss1")],
                  "numbers": [sorted(v[k][:].tolist()) for k in ("node_num_map", "elem_num_map")],
                  "level": (v["coordx"].filters() or {}).get("complevel", 0)}
        return {"attributes": attributes, "blocks": blocks, "nodal": nodal, "node sets": node_sets,
                "side sets": side_sets, "element sets": element_sets, "plain": plain}


def write_blocks_of_one(path, ids):
    """Writes two tetrahedra, each a block with an id of 64 bits."""
    with netCDF4.Dataset(path, "w", format="NETCDF4") as f:
        f.api_version, f.version, f.floating_point_word_size = numpy.float32(5.22), numpy.float32(5.22), numpy.int32(8)
        sizes = {"num_dim": 3, "num_nodes": 5, "num_elem": 2, "num_el_blk": 2, "num_el_in_blk1": 1, "num_nod_per_el1": 4,
                 "num_el_in_blk2": 1, "num_nod_per_el2": 4}
        for name, size in sizes.items():
            f.createDimension(name, size)
        for name, values in (("x", [0, 1, 0, 0, 1]), ("y", [0, 0, 1, 0, 1]), ("z", [0, 0, 0, 1, 1])):
            f.createVariable("coord" + name, "f8", ("num_nodes",))[:] = values
        f.createVariable("eb_prop1", "i8", ("num_el_blk",)).setncattr("name", "ID")
        f["eb_prop1"][:] = ids
        for block in (1, 2):
            connect = f.createVariable(f"connect{block}", "i4", (f"num_el_in_blk{block}", f"num_nod_per_el{block}"))
            connect.elem_type = "TETRA"
            connect[:] = [[1, 2, 3, 4], [2, 3, 4, 5]][block - 1]


@pytest.mark.parametrize("kind", KINDS)
def test_everything_follows_the_order(command, tmp_path, kind):
    write_all(tmp_path / "a.exo", kind)
    done = command.ok("order", "a.exo", "-o", "b.e", "--vertices", "rcm", "--elements", "scrambled", "--maps", "m")
    assert "left out" not in done.stderr and "not written" not in done.stderr, done.stderr
    before, after = content(tmp_path / "a.exo"), content(tmp_path / "b.e")
    for part in before:
        assert after[part] == before[part], part
    with netCDF4.Dataset(tmp_path / "a.exo") as a, netCDF4.Dataset(tmp_path / "b.e") as b:
        places = numpy.load(tmp_path / "m.vertices.old_to_new.npy")
        assert (places != numpy.arange(len(places))).any()
        assert (b["coordx"][:][places] == a["coordx"][:]).all()
        assert not (b["connect4"][:] == a["connect4"][:]).all()
    # the inverse restores the old content
    command.ok("apply", "m", "b.e", "-o", "c.exo", "--inverse")
    assert content(tmp_path / "c.exo") == before
    with netCDF4.Dataset(tmp_path / "a.exo") as a, netCDF4.Dataset(tmp_path / "c.exo") as c:
        for name in a.variables:
            if name not in ("elem_ss1", "side_ss1", "dist_fact_ss1", "vals_sset_var1ss1"):  # element by element now
                assert (numpy.ma.getdata(a[name][:]).tobytes() == numpy.ma.getdata(c[name][:]).tobytes()
                        or text_rows(a[name]) == text_rows(c[name])), name


def test_attributes_of_a_block_without_elements_are_nobodys(command, tmp_path):
    with netCDF4.Dataset(tmp_path / "a.e", "w") as f:
        for name, length in [("num_dim", 3), ("num_nodes", 4), ("num_elem", 1), ("num_el_blk", 2), ("num_el_in_blk1", 1),
                             ("num_el_in_blk2", None), ("num_nod_per_el1", 4), ("num_att_in_blk2", 1)]:
            f.createDimension(name, length)
        f.createVariable("coord", "f8", ("num_dim", "num_nodes"))[:] = numpy.eye(3, 4)
        for b in (1, 2):
            f.createVariable(f"connect{b}", "i4", (f"num_el_in_blk{b}", "num_nod_per_el1")).elem_type = "TETRA"
        f["connect1"][:] = [[1, 2, 3, 4]]
        f.createVariable("attrib2", "f8", ("num_el_in_blk2", "num_att_in_blk2"))
    command.ok("order", "a.e", "-o", "b.e")
    with netCDF4.Dataset(tmp_path / "b.e") as f:
        assert sorted(f["connect1"][0].tolist()) == [1, 2, 3, 4]


def test_single_precision_and_one_step(command, tmp_path):
    write_all(tmp_path / "a.exo", steps=1, real="f4")
    command.ok("order", "a.exo", "-o", "b.exo", "--vertices", "hilbert")
    assert content(tmp_path / "b.exo") == content(tmp_path / "a.exo")


def test_scipy_reads_the_file(command, tmp_path):
    write_all(tmp_path / "a.exo", "NETCDF3_CLASSIC")
    command.ok("order", "a.exo", "-o", "b.exo", "--vertices", "rcm", "--ids", "keep")
    with scipy.io.netcdf_file(tmp_path / "a.exo", mmap=False) as a, scipy.io.netcdf_file(tmp_path / "b.exo", mmap=False) as b:
        def by_number(f):
            columns = [f.variables[name][:].tolist() for name in ("node_num_map", "coordx", "coordy", "coordz")]
            return sorted(zip(*columns, *f.variables["vals_nod_var1"][:].tolist()))
        assert by_number(a) == by_number(b)
        assert a.variables["node_num_map"][:].tolist() != b.variables["node_num_map"][:].tolist()


def test_meshio_reads_what_meshio_wrote(command, tmp_path):
    points, cubes = lattice(3)
    shuffle = numpy.random.default_rng(1).permutation(len(points))
    moved = numpy.empty_like(points)
    moved[shuffle] = points
    cells = [("hexahedron", shuffle[cubes[:9]]), ("wedge", shuffle[cubes[9:18][:, [0, 1, 2, 4, 5, 6]]])]
    mesh = meshio.Mesh(moved, cells, point_data={"u": moved.copy(), "t": moved[:, 0].copy()}, point_sets={"held": shuffle[:5]})
    # netCDF-4, with numbers of eight bytes, coordinates in one variable and a variable of three components
    meshio.write(tmp_path / "a.e", mesh)
    command.ok("order", "a.e", "-o", "b.e", "--vertices", "rcm")
    after = meshio.read(tmp_path / "b.e")
    found = {tuple(point): i for i, point in enumerate(after.points.tolist())}
    place = numpy.array([found[tuple(point)] for point in moved.tolist()])
    assert (place != numpy.arange(len(place))).any()
    corners = lambda points, cells: sorted(points[cell].tolist() for cell in cells)  # noqa: E731
    for (kind, before), block in zip(cells, after.cells):
        assert block.type == kind and corners(after.points, block.data) == corners(moved, before)
    assert (after.point_data["t"][place] == moved[:, 0]).all()
    assert (after.point_data["u_"][place] == moved).all()
    assert sorted(after.point_sets["held"]) == sorted(place[shuffle[:5]])


MSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
2 1 "inlet"
3 2 "fluid"
3 3 "solid"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
6 2 2 0
$EndNodes
$Elements
4
1 4 2 2 1 1 2 3 4
2 2 2 1 1 1 2 3
3 4 2 3 1 2 3 4 5
4 4 2 2 1 2 3 6 5
$EndElements
"""


def test_named_groups_become_blocks_and_come_back(command, tmp_path):
    (tmp_path / "a.msh").write_text(MSH)
    command.ok("order", "a.msh", "-o", "b.exo")
    with netCDF4.Dataset(tmp_path / "b.exo") as f:
        assert f.data_model == "NETCDF3_64BIT_OFFSET"
        assert dict(zip(f["eb_prop1"][:].tolist(), text_rows(f["eb_names"]))) == {1: "inlet", 2: "fluid", 3: "solid"}
        assert sorted(f[f"connect{b}"].elem_type for b in (1, 2, 3)) == ["TETRA", "TETRA", "TRI3"]
    command.ok("order", "b.exo", "-o", "c.msh")
    groups = {kind: sorted(tags) for kind, tags in zip(("tetra", "triangle"), ([2, 2, 3], [1]))}
    back = meshio.read(tmp_path / "c.msh")
    assert {block.type: sorted(tags) for block, tags in zip(back.cells, back.cell_data["gmsh:physical"])
            if block.type == "triangle"} == {"triangle": [1]}
    tets = [tag for block, tags in zip(back.cells, back.cell_data["gmsh:physical"]) if block.type == "tetra" for tag in tags]
    assert sorted(tets) == groups["tetra"] and {"inlet", "fluid", "solid"} <= set(back.field_data)


def test_side_sets_go_through_vtu(command, tmp_path):
    write_all(tmp_path / "a.exo", steps=1)
    command.ok("order", "a.exo", "-o", "b.vtu", "--vertices", "rcm")
    command.ok("order", "b.vtu", "-o", "c.exo", "--vertices", "hilbert")

    def sides(path):
        with netCDF4.Dataset(path) as f:
            node = numpy.stack([f["coord" + c][:] for c in "xyz"], 1)
            connect = [row for b in range(1, len(f.dimensions["num_el_blk"]) + 1) if f"connect{b}" in f.variables
                       for row in f[f"connect{b}"][:].tolist()]
            named = dict(zip(text_rows(f["ss_names"]), range(1, 9)))
            s, rows = named["pressed"], []
            factors = f[f"dist_fact_ss{s}"][:].tolist()
            for e, side in zip(f[f"elem_ss{s}"][:], f[f"side_ss{s}"][:].tolist()):
                corners = connect[e - 1]
                width = 4 if len(corners) == 8 or (len(corners) == 6 and side < 4) else 3
                rows.append((node[numpy.array(corners) - 1].tolist(), side, factors[:width]))
                factors = factors[width:]
            return sorted(rows)

    assert sides(tmp_path / "c.exo") == sides(tmp_path / "a.exo")


def nodes_of_sides(dimension):
    """Returns for each type the numbers of nodes of an element and of each side, as ex_get_side_set_node_count does."""
    found = {"QUAD4": (4, [2] * 4), "SHELL4": (4, [4, 4, 2, 2, 2, 2]), "QUAD8": (8, [3] * 4), "SHELL9": (9, [9, 9, 3, 3, 3, 3]),
             "TRI3": (3, [2] * 3)}
    if dimension == 3:
        found |= {"TRI3": (3, [3, 3, 2, 2, 2]), "HEX8": (8, [4] * 6), "WEDGE": (6, [4, 4, 4, 3, 3])}
    return found


@pytest.mark.parametrize("dimension", [2, 3])
def test_factors_stay_at_the_nodes_of_sides(command, tmp_path, dimension):
    types, each = nodes_of_sides(dimension), 3
    elements = [(name, nodes, sides) for name, (nodes, sides) in types.items() for _ in range(each)]
    nodes = sum(count for _, count, _ in elements)
    entries = [(e, side, width) for e, (_, _, sides) in enumerate(elements) for side, width in enumerate(sides)]
    entries = [entries[k] for k in numpy.random.default_rng(3).permutation(len(entries))]
    factors = sum(width for _, _, width in entries)
    with netCDF4.Dataset(tmp_path / "a.exo", "w", format="NETCDF3_CLASSIC") as f:
        sizes = {"num_dim": dimension, "num_nodes": nodes, "num_elem": len(elements), "num_el_blk": len(types),
                 "num_side_sets": 1, "num_side_ss1": len(entries), "num_df_ss1": factors}
        for name, size in sizes.items():
            f.createDimension(name, size)
        for axis, values in zip("xyz", numpy.random.default_rng(4).uniform(size=(dimension, nodes))):
            f.createVariable("coord" + axis, "f8", ("num_nodes",))[:] = values
        first = 1
        for b, (name, (width, _)) in enumerate(types.items(), 1):
            f.createDimension(f"num_el_in_blk{b}", each)
            f.createDimension(f"num_nod_per_el{b}", width)
            connect = f.createVariable(f"connect{b}", "i4", (f"num_el_in_blk{b}", f"num_nod_per_el{b}"))
            connect.elem_type = name
            connect[:] = numpy.arange(first, first + each * width).reshape(each, width)
            first += each * width
        f.createVariable("elem_ss1", "i4", ("num_side_ss1",))[:] = [e + 1 for e, _, _ in entries]
        f.createVariable("side_ss1", "i4", ("num_side_ss1",))[:] = [side + 1 for _, side, _ in entries]
        f.createVariable("dist_fact_ss1", "f8", ("num_df_ss1",))[:] = numpy.arange(factors)
    command.ok("order", "a.exo", "-o", "b.exo", "--vertices", "scrambled", "--elements", "scrambled")

    def factors_of_sides(path):
        with netCDF4.Dataset(path) as f:
            x = f["coordx"][:].tolist()
            rows = [(x[row[0] - 1], f[f"connect{b}"].elem_type) for b in range(1, len(types) + 1)
                    for row in f[f"connect{b}"][:].tolist()]
            values, result = f["dist_fact_ss1"][:].tolist(), {}
            for e, side in zip(f["elem_ss1"][:].tolist(), f["side_ss1"][:].tolist()):
                width = types[rows[e - 1][1]][1][side - 1]
                result[(*rows[e - 1], side)] = values[:width]
                values = values[width:]
            assert not values
            return result

    assert factors_of_sides(tmp_path / "b.exo") == factors_of_sides(tmp_path / "a.exo")


def test_faults_are_named_with_their_place(command, tmp_path):
    def broken(change, kind="NETCDF3_CLASSIC"):
        write_all(tmp_path / "a.exo", kind)
        with netCDF4.Dataset(tmp_path / "a.exo", "a") as f:
            f.set_auto_mask(False)
            change(f)
        return command.fails("info", "a.exo")

    def put(name, at, value):
        return lambda f: f[name].__setitem__(at, value)

    assert "connect2, element 17: node 99 does not exist; the nodes are 1 to 64" in broken(put("connect2", (16, 3), 99))
    assert "connect1, element 1: node 0 does not exist" in broken(put("connect1", (0, 0), 0))
    assert "node_ns2, entry 2: node 65 does not exist" in broken(put("node_ns2", 1, 65))
    assert "elem_ss1, entry 3: element -1 does not exist" in broken(put("elem_ss1", 2, -1))
    assert "side_ss1, entry 4: a hexahedron has no side 7" in broken(put("side_ss1", 3, 7))
    assert "not finite" in broken(put("coordx", 3, numpy.nan))
    assert "elements of type 'NFACED'" in broken(lambda f: f["connect4"].setncattr("elem_type", "NFACED"))
    assert "has 1 blocks of faces" in broken(lambda f: f.createDimension("num_fa_blk", 1))


def test_a_piece_of_a_decomposed_mesh_is_read_and_not_written_again(command, tmp_path):
    write_all(tmp_path / "a.exo.4.1")
    with netCDF4.Dataset(tmp_path / "a.exo.4.1", "a") as f:
        f.createVariable("node_mapi", "i4", ("nodes_of_nothing",))
    assert "is a piece of a decomposed mesh: its communication maps are left out" in command.ok("info", "a.exo.4.1").stderr
    for out in ("b.exo", "b.e.4.1"):
        assert ("Exodus cannot hold a.exo.4.1 in another order, as it is a piece of a decomposed mesh: order the whole mesh "
                "before it is decomposed") in command.fails("order", "a.exo.4.1", "-o", out)
        assert not (tmp_path / out).exists()
    done = command.ok("order", "a.exo.4.1", "-o", "b.vtu")
    assert "node_mapi" not in done.stderr
    assert meshio.read(tmp_path / "b.vtu").points.shape == (64, 3)


@pytest.mark.parametrize("kind", KINDS)
def test_a_truncated_file_is_refused(command, tmp_path, kind):
    write_all(tmp_path / "whole.exo", kind)
    content_of_file = (tmp_path / "whole.exo").read_bytes()
    for length in [*range(0, 40, 7), *numpy.linspace(40, len(content_of_file) - 5, 12).astype(int)]:
        (tmp_path / "a.exo").write_bytes(content_of_file[:length])
        command.fails("order", "a.exo", "-o", "b.exo")
        assert not (tmp_path / "b.exo").exists()


def test_what_is_not_understood_is_left_out_with_a_note(command, tmp_path):
    write_all(tmp_path / "a.exo", steps=0)
    with netCDF4.Dataset(tmp_path / "a.exo", "a") as f:
        f.createVariable("neighbours", "i4", ("num_nodes",))
        f.createVariable("elem_map", "i4", ("num_elem",))
    done = command.ok("order", "a.exo", "-o", "b.exo")
    assert "neighbours is left out" in done.stderr and "elem_map, is left out" in done.stderr
    with netCDF4.Dataset(tmp_path / "b.exo") as f:
        assert "neighbours" not in f.variables and "elem_map" not in f.variables
        assert f["elem_var_tab"][:].tolist() == [[1, 0], [1, 1], [0, 0], [1, 1], [1, 0]]
        assert text_rows(f["name_nod_var"])[0] == "ux"


def write_pair(path, kind="NETCDF3_64BIT_OFFSET", steps=2):
    """Writes a file of six nodes and two blocks of two triangles, with a node set and a side set. Returns it open."""
    f = netCDF4.Dataset(path, "w", format=kind)
    f.set_auto_mask(False)
    points = numpy.array([(x, y, 0) for y in (0, 1) for x in (0, 1, 2)], float)
    for name, length in [("len_name", 33), ("time_step", None), ("num_dim", 3), ("num_nodes", 6), ("num_elem", 4),
                         ("num_el_blk", 2), ("num_node_sets", 1), ("num_nod_ns1", 3), ("num_side_sets", 1), ("num_side_ss1", 2)]:
        f.createDimension(name, length)
    for k in range(3):
        f.createVariable("coord" + "xyz"[k], "f8", ("num_nodes",))[:] = points[:, k]
    f.createVariable("time_whole", "f8", ("time_step",))[:] = numpy.arange(steps)
    for b, cells in enumerate([[[1, 2, 5], [1, 5, 4]], [[2, 3, 6], [2, 6, 5]]], 1):
        f.createDimension(f"num_el_in_blk{b}", 2)
        f.createDimension(f"num_nod_per_el{b}", 3)
        connect = f.createVariable(f"connect{b}", "i4", (f"num_el_in_blk{b}", f"num_nod_per_el{b}"))
        connect.elem_type = "TRI3"
        connect[:] = cells
    for name, values in [("node_ns1", [6, 1, 3]), ("elem_ss1", [1, 4]), ("side_ss1", [3, 4])]:
        f.createVariable(name, "i4", ("num_nod_ns1" if name == "node_ns1" else "num_side_ss1",))[:] = values
    return f


def put_series(f, name, dimension, type="f8", values=None):
    """Writes a variable of two steps."""
    if values is None:
        values = numpy.random.default_rng(len(f.variables)).uniform(size=(2, len(f.dimensions[dimension])))
    f.createVariable(name, type, ("time_step", dimension))[:] = numpy.asarray(values, type)


def put_variable_names(f, of, names, table=None):
    f.createDimension(f"num_{of}_var", len(names))
    put_names(f, f"name_{of}_var", f"num_{of}_var", names)
    if table is not None:
        objects = {"elem": "num_el_blk", "nset": "num_node_sets", "sset": "num_side_sets"}[of]
        f.createVariable(f"{of}_var_tab", "i4", (objects, f"num_{of}_var"))[:] = table


@pytest.mark.parametrize("kind", KINDS)
def test_names_without_values_stay_names(command, tmp_path, kind):
    tables = {"elem_var_tab": [[1, 1, 0], [0, 1, 0]], "nset_var_tab": [[1, 1]], "sset_var_tab": [[0]]}
    with write_pair(tmp_path / "a.exo", kind) as f:
        put_variable_names(f, "nod", ["first", "heat", "last"])
        put_series(f, "vals_nod_var2", "num_nodes")
        put_variable_names(f, "elem", ["stress", "damage", "flux"], tables["elem_var_tab"])
        put_series(f, "vals_elem_var2eb2", "num_el_in_blk2")
        put_variable_names(f, "nset", ["reaction", "slip"], tables["nset_var_tab"])
        put_series(f, "vals_nset_var2ns1", "num_nod_ns1")
        put_variable_names(f, "sset", ["traction"], tables["sset_var_tab"])
    done = command.ok("order", "a.exo", "-o", "b.exo", "--vertices", "scrambled", "--elements", "scrambled", "--maps", "m")
    assert "left out" not in done.stderr and "not written" not in done.stderr, done.stderr
    command.ok("apply", "m", "b.exo", "-o", "c.exo", "--inverse")
    with netCDF4.Dataset(tmp_path / "a.exo") as a:
        for name in ("b.exo", "c.exo"):
            with netCDF4.Dataset(tmp_path / name) as after:
                after.set_auto_mask(False)
                assert {v for v in after.variables if v.startswith("vals_")} == {v for v in a.variables if v.startswith("vals_")}
                for of in ("nod", "elem", "nset", "sset"):
                    assert text_rows(after[f"name_{of}_var"]) == text_rows(a[f"name_{of}_var"])
                assert {table: after[table][:].tolist() for table in tables} == tables
        with netCDF4.Dataset(tmp_path / "b.exo") as b, netCDF4.Dataset(tmp_path / "c.exo") as c:
            places = numpy.load(tmp_path / "m.vertices.old_to_new.npy")
            assert (places != numpy.arange(6)).any()
            assert (b["vals_nod_var2"][:][:, places] == a["vals_nod_var2"][:]).all()
            for name in ("vals_nod_var2", "vals_elem_var2eb2", "vals_nset_var2ns1"):
                assert c[name][:].tolist() == a[name][:].tolist()


def test_variables_of_no_step_stay_declared(command, tmp_path):
    with write_pair(tmp_path / "a.exo", steps=0) as f:
        put_variable_names(f, "nod", ["first", "heat"])
        put_variable_names(f, "elem", ["stress", "damage"])
        put_variable_names(f, "nset", ["reaction"], [[1]])
        for name, dimension in [("nod_var2", "num_nodes"), ("elem_var1eb2", "num_el_in_blk2"), ("nset_var1ns1", "num_nod_ns1")]:
            f.createVariable(f"vals_{name}", "f4", ("time_step", dimension))
    command.ok("order", "a.exo", "-o", "b.exo", "--vertices", "scrambled")
    with netCDF4.Dataset(tmp_path / "b.exo") as b:
        assert {name: (v.dtype, v.shape) for name, v in b.variables.items() if name.startswith("vals_")} == {
            "vals_nod_var2": ("f4", (0, 6)), "vals_elem_var1eb2": ("f4", (0, 2)), "vals_nset_var1ns1": ("f4", (0, 3))}
        assert b["elem_var_tab"][:].tolist() == [[0, 0], [1, 0]] and b["nset_var_tab"][:].tolist() == [[1]]


@pytest.mark.parametrize("types", [("f8", "f4"), ("f4", "f8"), ("i4", "f4"), ("i2", "f4"), ("i4", "i2")])
def test_mixed_precision_loses_no_value(command, tmp_path, types):
    values = {"f8": [[1e165, 0.1], [-1e-200, 3]], "f4": [[0.1, 1e30], [2, 3]], "i4": [[16777217, 2**31 - 1], [-5, 6]],
              "i2": [[1, -2], [30000, 4]]}
    with write_pair(tmp_path / "a.exo") as f:
        put_variable_names(f, "elem", ["stress"], [[1], [1]])
        for b, type in enumerate(types, 1):
            put_series(f, f"vals_elem_var1eb{b}", f"num_el_in_blk{b}", type, values[type])
    command.ok("order", "a.exo", "-o", "b.exo", "--vertices", "rcm", "--elements", "scrambled", "--maps", "m")
    command.ok("apply", "m", "b.exo", "-o", "c.exo", "--inverse")
    with netCDF4.Dataset(tmp_path / "a.exo") as a, netCDF4.Dataset(tmp_path / "c.exo") as c:
        for name in ("vals_elem_var1eb1", "vals_elem_var1eb2"):
            assert c[name].dtype == "f8" and c[name][:].tolist() == a[name][:].tolist(), name


def test_types_of_variables_stay(command, tmp_path):
    big = [[2**53 + 1, -2**62, 3], [4, 5, 2**63 - 1]]
    with write_pair(tmp_path / "a.exo", "NETCDF4") as f:
        put_variable_names(f, "nod", ["heat", "cold"])
        packed = f.createVariable("vals_nod_var", "f4", ("time_step", "num_nod_var", "num_nodes"))
        packed[:] = numpy.arange(24).reshape(2, 2, 6) / 7
        put_variable_names(f, "nset", ["owner"], [[1]])
        put_series(f, "vals_nset_var1ns1", "num_nod_ns1", "i8", big)
        put_variable_names(f, "sset", ["mark"], [[1]])
        put_series(f, "vals_sset_var1ss1", "num_side_ss1", "u8", [[2**64 - 1, 2**63], [2**53 + 1, 0]])
        put_variable_names(f, "elem", ["key"], [[1], [0]])
        put_series(f, "vals_elem_var1eb1", "num_el_in_blk1", "u8", [[2**64 - 1, 2**63], [2**53 + 1, 0]])
    command.ok("order", "a.exo", "-o", "b.exo", "--vertices", "scrambled", "--elements", "scrambled", "--maps", "m")
    command.ok("apply", "m", "b.exo", "-o", "c.exo", "--inverse")
    with netCDF4.Dataset(tmp_path / "a.exo") as a, netCDF4.Dataset(tmp_path / "c.exo") as c:
        for name in ("vals_nod_var", "vals_nset_var1ns1", "vals_sset_var1ss1", "vals_elem_var1eb1"):
            assert c[name].dtype == a[name].dtype and c[name][:].tolist() == a[name][:].tolist(), name


@pytest.mark.parametrize("ids", [[2**40, 2**31], [7, 2**62], [-1, 2**31 - 1]])
def test_ids_of_64_bits_stay(command, tmp_path, ids):
    write_blocks_of_one(tmp_path / "a.exo", ids)
    command.ok("order", "a.exo", "-o", "b.exo", "--vertices", "scrambled", "--elements", "scrambled", "--maps", "m")
    command.ok("apply", "m", "b.exo", "-o", "c.exo", "--inverse")
    with netCDF4.Dataset(tmp_path / "a.exo") as a, netCDF4.Dataset(tmp_path / "c.exo") as c:
        for name in ("eb_prop1", "connect1", "connect2", "coordx", "coordy", "coordz"):
            assert c[name][:].tolist() == a[name][:].tolist(), name
        assert "vals_elem_var1eb1" not in c.variables and len(c.dimensions["num_el_blk"]) == 2


def test_digits_that_no_type_of_all_blocks_has_are_reported(command, tmp_path):
    with write_pair(tmp_path / "a.exo", "NETCDF4") as f:
        put_variable_names(f, "elem", ["key"], [[1], [1]])
        put_series(f, "vals_elem_var1eb1", "num_el_in_blk1", "i8", [[2**53 + 1, 1], [2, 3]])
        put_series(f, "vals_elem_var1eb2", "num_el_in_blk2", "f4")
    done = command.ok("order", "a.exo", "-o", "b.exo")
    assert "the variable 'key' loses digits" in done.stderr


# the nodes between corners, in the order of the format's manual
QUAD_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]
HEX_EDGES = QUAD_EDGES + [(0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]
HEX_FACES = [tuple(range(8)), (0, 1, 2, 3), (4, 5, 6, 7), (0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (3, 2, 6, 7)]
WEDGE_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 4), (2, 5), (3, 4), (4, 5), (5, 3)]
TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
MIDDLES = {
    "line3": (2, [(0, 1)]), "triangle6": (3, TET_EDGES[:3]), "quad8": (4, QUAD_EDGES), "quad9": (4, [*QUAD_EDGES, (0, 1, 2, 3)]),
    "tetra10": (4, TET_EDGES), "pyramid13": (5, [*QUAD_EDGES, (0, 4), (1, 4), (2, 4), (3, 4)]),
    "wedge15": (6, WEDGE_EDGES), "wedge18": (6, [*WEDGE_EDGES, (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]),
    "hexahedron20": (8, HEX_EDGES), "hexahedron27": (8, HEX_EDGES + HEX_FACES),
}
CORNERS = {2: [(0, 0, 0), (1, 0, 0)], 3: [(0, 0, 0), (1, 0, 0), (0, 1, 0)], 4: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
           5: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1)],
           6: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)],
           8: [(x ^ y, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]}
TETRA = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]


def only_cell_of_vtk(content):
    """The nodes' coordinates in a binary legacy file with one cell."""
    def numbers(keyword, type, skip=0):
        line, _, rest = content.split(b"\n" + keyword + b" ", 1)[1].partition(b"\n")
        return numpy.frombuffer(rest, type, int(line.split()[skip]) * (3 if keyword == b"POINTS" else 1))

    return numbers(b"POINTS", ">f8").reshape(-1, 3)[numbers(b"CELLS", ">i4", 1)[1:]]


@pytest.mark.parametrize("kind", MIDDLES)
def test_nodes_are_in_the_order_of_the_manual(command, tmp_path, kind):
    count, middles = MIDDLES[kind]
    corners = numpy.array(TETRA if kind == "tetra10" else CORNERS[count], float) * [3, 2, 1]
    points = numpy.array([*corners, *(corners[list(group)].mean(axis=0) for group in middles)])
    with netCDF4.Dataset(tmp_path / "a.exo", "w", format="NETCDF3_64BIT_OFFSET") as f:
        for name, length in [("num_dim", 3), ("num_nodes", len(points)), ("num_elem", 1), ("num_el_blk", 1),
                             ("num_el_in_blk1", 1), ("num_nod_per_el1", len(points))]:
            f.createDimension(name, length)
        for k in range(3):
            f.createVariable("coord" + "xyz"[k], "f8", ("num_nodes",))[:] = points[:, k]
        connect = f.createVariable("connect1", "i4", ("num_el_in_blk1", "num_nod_per_el1"))
        connect.elem_type = {"line": "bar", "tria": "tri", "quad": "quad", "tetr": "Tetra", "pyra": "PYRAMID",
                             "wedg": "wedge", "hexa": "HEX"}[kind[:4]]
        connect[:] = [range(1, len(points) + 1)]
    # in VTK's file the nodes between corners are in the order of VTK's manual
    command.ok("order", "a.exo", "-o", "b.vtk")
    cell = only_cell_of_vtk((tmp_path / "b.vtk").read_bytes())
    assert (cell[:count] == corners).all()
    vtk_edges = {"wedge": [*WEDGE_EDGES[:3], *WEDGE_EDGES[6:], *WEDGE_EDGES[3:6]],
                 "hexah": [*HEX_EDGES[:4], *HEX_EDGES[8:], *HEX_EDGES[4:8]]}.get(kind[:5])
    if vtk_edges:
        assert (cell[count:count + len(vtk_edges)] == [corners[list(edge)].mean(axis=0) for edge in vtk_edges]).all()
    if kind == "hexahedron27":
        assert (cell[20:] == [corners[list(HEX_FACES[k])].mean(axis=0) for k in (3, 4, 5, 6, 1, 2, 0)]).all()
    # and back
    command.ok("order", "b.vtk", "-o", "c.exo")
    with netCDF4.Dataset(tmp_path / "c.exo") as f:
        places = numpy.stack([f["coord" + c][:] for c in "xyz"], 1)
        assert (places[f["connect1"][0] - 1] == points).all()
