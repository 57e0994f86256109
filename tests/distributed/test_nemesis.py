# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Pieces in Nemesis: together, as netCDF's module reads them, they have the content of the whole mesh's file."""
import collections
import json
import os
import pathlib
import subprocess
import sys

import meshio
import numpy
import pytest
import vtkmodules.util.numpy_support as convert
from test_mpi import ROOT, ball, launch, order, own_lines, serial
from vtkmodules.vtkIOExodus import vtkExodusIIReader

sys.path.insert(0, str(ROOT / "tests" / "command"))
from test_exodus import SIDES_OF_HEX, lattice, text_rows, write_all, write_blocks_of_one

netCDF4 = pytest.importorskip("netCDF4")

# corners of the sides, by the figures of the manual of Exodus II
SIDES = {
    "HEX": [(1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (1, 5, 8, 4), (1, 4, 3, 2), (5, 6, 7, 8)],
    "WED": [(1, 2, 5, 4), (2, 3, 6, 5), (1, 4, 6, 3), (1, 3, 2), (4, 5, 6)],
    "PYR": [(1, 2, 5), (2, 3, 5), (3, 4, 5), (1, 5, 4), (1, 4, 3, 2)],
    "TET": [(1, 2, 4), (2, 3, 4), (1, 4, 3), (1, 3, 2)],
    "SHE": [(1, 2, 3, 4), (1, 4, 3, 2), (1, 2), (2, 3), (3, 4), (4, 1)],
    "TRI": [(1, 2, 3), (1, 3, 2), (1, 2), (2, 3), (3, 1)],
    "QUA": [(1, 2), (2, 3), (3, 4), (4, 1)],
}
# variables that describe only a piece, or its place among the others
OF_PIECES = {"nem_ftype", "node_num_map", "elem_num_map", "nmap_names", "emap_names", "nm_prop1", "em_prop1", "elem_var_tab",
             "nset_var_tab", "sset_var_tab"}
OF_MEMBERS = ("ns", "ss", "els")


def paths_of(name, parts):
    return [pathlib.Path(f"{name}.{parts}.{part:0{len(str(parts))}}") for part in range(parts)]


class Exodus:
    """The content of a file: what belongs to each node and element, by its number in the whole mesh, and all else."""

    def __init__(self, path, is_piece=True):
        self.path = path
        with netCDF4.Dataset(path) as f:
            f.set_auto_mask(False)
            self.sizes = {name: len(dimension) for name, dimension in f.dimensions.items()}
            self.attributes = {name: str(f.getncattr(name)) for name in f.ncattrs()}
            v = self.v = {name: variable[...] for name, variable in f.variables.items()}
            self.texts = {name: text_rows(f[name]) for name in v if v[name].dtype.char == "S" and v[name].ndim == 2}
            self.types = {name: f[name].elem_type[:3].upper() for name in v if name.startswith("connect")}
        count = [self.sizes.get(name, 0) for name in ("num_nodes", "num_elem")]
        self.nodes, self.elements = ([*range(n)] for n in count)
        if is_piece:
            self.nodes = (v["node_num_map"] - 1).tolist() if count[0] else []
            self.elements = (v["elem_num_map"] - 1).tolist() if count[1] else []
        assert len(self.nodes) == count[0] and len(self.elements) == count[1]
        self.cells, self.blocks, self.of_nodes, self.of_elements, self.of_sets = {}, {}, {}, {}, collections.Counter()
        self.read_nodes()
        self.read_elements()
        for kind in OF_MEMBERS:
            self.read_sets(kind)

    def columns(self, names):
        return [(name, self.v[name]) for name in names if name in self.v]

    def read_nodes(self):
        rows = [*self.columns(["coordx", "coordy", "coordz", "node_map1"]),
                *((name, values.T) for name, values in self.columns(f"vals_nod_var{k}" for k in (1, 2)))]
        for k, node in enumerate(self.nodes):
            self.of_nodes[node] = {name: values[k].tolist() for name, values in rows}

    def read_elements(self):
        first = 0
        for b in range(1, self.sizes["num_el_blk"] + 1):
            if f"connect{b}" not in self.v:
                continue
            connect = self.v[f"connect{b}"]
            rows = [*self.columns([f"attrib{b}"]),
                    *((name, values.T) for name, values in self.columns(f"vals_elem_var{k}eb{b}" for k in (1, 2)))]
            for k, row in enumerate(connect):
                element = self.elements[first + k]
                self.blocks[element] = b
                self.cells[element] = tuple(self.nodes[node - 1] for node in row)
                self.of_elements[element] = {name: values[k].tolist() for name, values in rows}
                if "elem_map1" in self.v:
                    self.of_elements[element]["map"] = int(self.v["elem_map1"][first + k])
            first += len(connect)
        assert first == len(self.elements)

    def read_sets(self, kind):
        """Members by their numbers in the whole mesh, with sides, factors and variables."""
        variable, value = {"ns": ("node_ns", "nset"), "ss": ("elem_ss", "sset"), "els": ("elem_els", "elset")}[kind]
        numbers = self.nodes if kind == "ns" else self.elements
        count = {"ns": "num_node_sets", "ss": "num_side_sets", "els": "num_elem_sets"}[kind]
        for s in range(1, 1 + self.sizes.get(count, 0)):
            if f"{variable}{s}" not in self.v:
                continue
            factors = self.v.get(f"dist_fact_{kind}{s}")
            values = self.v.get(f"vals_{value}_var1{kind}{s}")
            at = 0
            for k, member in enumerate(self.v[f"{variable}{s}"].tolist()):
                number, side, width = numbers[member - 1], 0, 1
                if kind == "ss":
                    side = int(self.v[f"side_ss{s}"][k])
                    width = len(self.corners(number, side))
                own = () if factors is None else tuple(factors[at:at + width].tolist())
                at += width
                self.of_sets[kind, s, number, side, own, () if values is None else tuple(values[:, k].tolist())] += 1
            assert factors is None or at == len(factors)

    def sides_of(self, kind):
        return SIDES[kind][2:] if kind == "TRI" and self.sizes["num_dim"] == 2 else SIDES[kind]

    def corners(self, element, side):
        """The corners of a side of an element, by their numbers in the whole mesh."""
        return [self.cells[element][k - 1] for k in self.sides_of(self.types[f"connect{self.blocks[element]}"])[side - 1]]

    def common(self):
        """The variables that do not belong to nodes or elements."""
        ends = ("_map1", "_map2")
        begins = ("connect", "attrib", "coordx", "coordy", "coordz", "vals_nod", "vals_elem", "vals_nset",
                  "vals_sset", "node_ns", "elem_ss", "side_ss", "elem_els", "dist_fact", "node_map", "elem_map", "n_comm",
                  "e_comm")
        return {name: values.tolist() for name, values in self.v.items()
                if name not in OF_PIECES and not name.endswith(("_global", "_n_stat", "_e_stat", "_status", *ends))
                and not name.startswith(begins)}


def assert_pieces_of(whole, pieces):
    """Asserts that the pieces together have the content of the whole file."""
    assert sorted(element for piece in pieces for element in piece.elements) == [*range(len(whole.elements))]
    assert {node for piece in pieces for node in piece.nodes} == {*range(len(whole.nodes))}
    found = collections.Counter()
    for piece in pieces:
        for node in piece.nodes:
            assert piece.of_nodes[node] == whole.of_nodes[node]
        for element in piece.elements:
            assert piece.cells[element] == whole.cells[element] and piece.blocks[element] == whole.blocks[element]
            assert piece.of_elements[element] == whole.of_elements[element]
        # a node is in the node sets of every piece that has this node
        for member, count in piece.of_sets.items():
            found[member] = count if member[0] == "ns" else found[member] + count
        assert piece.common() == whole.common()
        assert piece.attributes.items() >= whole.attributes.items()
        for name, members in (("elem_var_tab", "connect"), ("nset_var_tab", "node_ns"), ("sset_var_tab", "elem_ss")):
            filled = [f"{members}{k + 1}" in piece.v for k in range(len(whole.v.get(name, [])))]
            assert (piece.v[name] == whole.v[name] * numpy.array(filled)[:, None]).all() if filled else name not in piece.v
        for name in ("eb_status", "ns_status", "ss_status"):
            begin = {"eb": "connect", "ns": "node_ns", "ss": "elem_ss"}[name[:2]]
            if name in whole.v:
                assert piece.v[name].tolist() == [int(f"{begin}{k + 1}" in piece.v) for k in range(len(whole.v[name]))]
    assert found == whole.of_sets


def by_library(paths):
    """The content as the library of Exodus II reads it."""
    try:
        done = subprocess.run([sys.executable, pathlib.Path(__file__).with_name("nemesis_by_library.py"), *paths],
                              capture_output=True, text=True, check=False)
        if "cannot open shared object" in done.stderr:
            pytest.skip("the library of Exodus II is not installed")
        assert done.returncode == 0 and done.stderr == "", done.stderr
        return json.loads(done.stdout)
    except json.JSONDecodeError:
        return pytest.fail(done.stdout)


def assert_maps(whole, pieces):
    """Asserts that the library reads the nodes and elements of each part, and those that it shares with other parts."""
    parts = len(pieces)
    read = by_library([piece.path for piece in pieces])
    holders = collections.defaultdict(set)
    for p, piece in enumerate(pieces):
        for node in piece.nodes:
            holders[node].add(p)
    sides = collections.defaultdict(dict)  # of volumes and surfaces; by the corners of a side, its number in each cell
    part_of = {element: p for p, piece in enumerate(pieces) for element in piece.elements}
    size = whole.sizes
    for element, row in whole.cells.items():
        kind = whole.types[f"connect{whole.blocks[element]}"]
        for side, corners in enumerate(whole.sides_of(kind), 1):
            if kind in ("SHE", "TRI") and size["num_dim"] == 3 and side < 3:
                continue  # faces of a surface
            sides[frozenset(row[k - 1] for k in corners)][element] = side
    for p, (piece, found) in enumerate(zip(pieces, read)):
        assert (found["processors"], found["in file"], found["kind"]) == (parts, 1, "p")
        assert found["whole"] == [len(whole.nodes), len(whole.elements), size["num_el_blk"], size.get("num_node_sets", 0),
                                  size.get("num_side_sets", 0)]
        counts = [size.get(f"num_el_in_blk{b + 1}", 0) for b in range(size["num_el_blk"])]
        assert found["blocks"] == [whole.v["eb_prop1"].tolist(), counts]
        for name, kind, members in (("node sets", "ns", "num_nod_ns"), ("side sets", "ss", "num_side_ss")):
            ids = whole.v[f"{kind}_prop1"].tolist() if f"{kind}_prop1" in whole.v else []
            assert found[name] == [ids, [size.get(f"{members}{k + 1}", 0) for k in range(len(ids))],
                                   [size.get(f"num_df_{kind}{k + 1}", 0) for k in range(len(ids))]]
        internal, border, external = found["nodes"]
        assert internal == [k + 1 for k, node in enumerate(piece.nodes) if holders[node] == {p}] and external == []
        assert border == [k + 1 for k, node in enumerate(piece.nodes) if holders[node] != {p}]
        neighbours = sorted({q for node in piece.nodes for q in holders[node]} - {p})
        assert found["ids"][0] == neighbours
        for q, (nodes, processors) in zip(neighbours, found["node maps"]):
            assert {*processors} == {q}
            assert [piece.nodes[k - 1] for k in nodes] == sorted({*piece.nodes} & {*pieces[q].nodes})
        # the library reads the sides that cells of both parts share
        shared = collections.Counter()
        for q, (elements, of_elements, processors) in zip(found["ids"][1], found["element maps"]):
            assert {*processors} == {q} and p != q
            numbers = [piece.elements[k - 1] for k in elements]
            corners = [frozenset(whole.corners(*one)) for one in zip(numbers, of_elements)]
            k = read[q]["ids"][1].index(p)
            theirs = [pieces[q].elements[k - 1] for k in read[q]["element maps"][k][0]]
            assert corners == [frozenset(whole.corners(*one)) for one in zip(theirs, read[q]["element maps"][k][1])]
            shared.update(zip(numbers, theirs))
        expected = collections.Counter((a, b) for cells in sides.values() for a in cells for b in cells
                                       if part_of[a] == p and part_of[b] != p)
        assert shared == expected
        assert found["elements"][1] == [k + 1 for k, element in enumerate(piece.elements)
                                        if element in {a for a, _ in expected}]
        assert sorted(found["elements"][0] + found["elements"][1]) == [*range(1, len(piece.elements) + 1)]
        load = [*map(len, found["nodes"]), *map(len, found["elements"]), len(neighbours), len(found["ids"][1])]
        assert found["load"] == load
        for name, status in zip(("int_n", "bor_n", "ext_n", "int_e", "bor_e"), load):
            assert piece.v[f"{name}_stat"].tolist() == [int(status > 0)]


@pytest.mark.parametrize("kind, ranks, parts", [("NETCDF3_64BIT_OFFSET", 2, 4), ("NETCDF4", 3, 4), ("NETCDF3_CLASSIC", 1, 1),
                                                ("NETCDF3_64BIT_OFFSET", 3, 11)])
def test_pieces_together_are_the_whole_file(tmp_path, kind, ranks, parts):
    write_all(tmp_path / "a.exo", kind)
    done = order(ranks, tmp_path / "a.exo", "-o", tmp_path / "b.e", "--pieces", tmp_path / "out.e", "--parts", parts,
                 "--partition", "hilbert", "--json")
    assert own_lines(done) == []
    result = json.loads(done.stdout)
    paths = paths_of(tmp_path / "out.e", parts)
    assert result["files_by"] == "rank 0" and result["pieces"]["file"] == str(paths[0])
    assert sorted(os.listdir(tmp_path)) == sorted(["a.exo", "b.e", *(path.name for path in paths)])
    whole, pieces = Exodus(tmp_path / "b.e", is_piece=False), [Exodus(path) for path in paths]
    assert_pieces_of(whole, pieces)
    assert_maps(whole, pieces)
    assert result["pieces"]["ghost_cells"] == result["pieces"]["ghost_layers"] == 0
    assert result["pieces"]["ghost_vertices"] == sum(len(piece.nodes) for piece in pieces) - len(whole.nodes)
    starts = result["partition"]["first_vertices"]
    for p, piece in enumerate(pieces):
        owners = numpy.searchsorted(starts, piece.nodes, side="right") - 1
        assert [node for _, node in sorted(zip((owners != p).tolist(), piece.nodes))] == piece.nodes
        assert piece.elements == sorted(piece.elements)
        # the numbers that the file of the whole mesh gives
        for of, numbers in (("node", piece.nodes), ("elem", piece.elements)):
            kept = piece.texts[f"{of[0]}map_names"].index("ids of the whole") + 1
            if numbers:
                assert piece.v[f"{of}_map{kept}"].tolist() == whole.v[f"{of}_num_map"][numbers].tolist()


@pytest.mark.parametrize("options", [["--only", "volume"], ["--only", "surface"], ["--ids", "attach"], ["--ids", "keep"],
                                     ["--interface", "last"]])
def test_pieces_follow_the_options(tmp_path, options):
    """The pieces, like the file of the mesh, lack blocks, sets and variables without remaining cells."""
    write_all(tmp_path / "a.exo", "NETCDF3_64BIT_DATA", real="f4")
    order(2, tmp_path / "a.exo", "-o", tmp_path / "b.e", "--pieces", tmp_path / "out.g", "--parts", "5", *options)
    whole, pieces = Exodus(tmp_path / "b.e", is_piece=False), [Exodus(path) for path in paths_of(tmp_path / "out.g", 5)]
    assert_pieces_of(whole, pieces)
    assert_maps(whole, pieces)


@pytest.mark.parametrize("kind, ranks, parts", [("NETCDF3_64BIT_OFFSET", 2, 4), ("NETCDF4", 3, 7), ("NETCDF3_CLASSIC", 1, 1),
                                                ("NETCDF3_64BIT_DATA", 3, 11), ("NETCDF3_64BIT_OFFSET", 5, 2)])
def test_all_ranks_write_what_one_writes(tmp_path, kind, ranks, parts):
    """With --strict, rank 0 reads and writes."""
    write_all(tmp_path / "a.exo", kind)
    for name, options in (("all", []), ("one", ["--strict"])):
        (tmp_path / name).mkdir()
        done = order(ranks, tmp_path / "a.exo", "--pieces", tmp_path / name / "out.e", "--maps", tmp_path / name / "m",
                     "--parts", parts, "--partition", "hilbert", "--json", *options)
        assert own_lines(done) == []
        result = json.loads(done.stdout)
        assert result["files_by"] == {"all": "all ranks", "one": "rank 0"}[name]
        assert result["pieces"]["file"] == str(paths_of(tmp_path / name / "out.e", parts)[0])
    assert sorted(os.listdir(tmp_path / "all")) == sorted(os.listdir(tmp_path / "one"))
    for path in [*paths_of("out.e", parts), *(path for path in os.listdir(tmp_path / "one") if path.endswith(".npy"))]:
        assert (tmp_path / "all" / path).read_bytes() == (tmp_path / "one" / path).read_bytes(), path


@pytest.mark.parametrize("ids", [[7, 2**31 - 1], [7, 2**40]])
def test_ids_of_blocks(tmp_path, ids):
    write_blocks_of_one(tmp_path / "a.exo", ids)
    for options in ([], ["--strict"]):
        order(2, tmp_path / "a.exo", "--pieces", tmp_path / "out.e", "--parts", "2", *options)
        for path in paths_of(tmp_path / "out.e", 2):
            with netCDF4.Dataset(path) as piece:
                assert [piece[name][:].tolist() for name in ("eb_prop1", "el_blk_ids_global")] == [ids, ids]
                assert piece["el_blk_cnt_global"][:].tolist() == [1, 1]


def test_the_same_bytes_on_every_number_of_ranks(tmp_path):
    write_all(tmp_path / "a.exo")
    for ranks in (1, 2, 3):
        (tmp_path / str(ranks)).mkdir()
        order(ranks, tmp_path / "a.exo", "--pieces", tmp_path / str(ranks) / "out.e", "--partition", "hilbert", "--parts", "4")
    for path in paths_of("out.e", 4):
        assert len({(tmp_path / str(ranks) / path).read_bytes() for ranks in (1, 2, 3)}) == 1


@pytest.mark.parametrize("output", ["b.e", "b.vtu"])
def test_meshes_of_other_formats(tmp_path, output):
    """Tetrahedra of two labels and triangles on their faces, with arrays, in an order that mixes the blocks."""
    random = numpy.random.default_rng(3)
    points = random.random((300, 3))
    cells = numpy.array([random.choice(280, 4, replace=False) for _ in range(400)])
    mesh = meshio.Mesh(points, [("tetra", cells), ("triangle", cells[::7, :3])],
                       point_data={"u": random.random((300, 3)), "set:left": (points[:, 0] < 0.4).astype("u1")},
                       cell_data={"label": [random.integers(1, 3, 400), numpy.full(len(cells[::7]), 9)],
                                  "s": [random.random(400), random.random(len(cells[::7]))]})
    mesh.write(tmp_path / "a.vtu")
    done = order(2, tmp_path / "a.vtu", "-o", tmp_path / output, "--pieces", tmp_path / "out.e", "--parts", "5", "--json")
    assert sum("'u' of 3 components is written as the variables" in line for line in own_lines(done)) == 1
    assert json.loads(done.stdout)["files_by"] == "rank 0"
    pieces = [Exodus(path) for path in paths_of(tmp_path / "out.e", 5)]
    if output == "b.e":
        whole = Exodus(tmp_path / output, is_piece=False)
        assert_pieces_of(whole, pieces)
        assert_maps(whole, pieces)
        return
    whole = meshio.read(tmp_path / output)
    rows = [row.tolist() for block in whole.cells for row in block.data]
    labels, s = (numpy.concatenate(whole.cell_data[name]) for name in ("label", "s"))
    assert sorted(element for piece in pieces for element in piece.elements) == [*range(len(rows))]
    for piece in pieces:
        assert piece.texts["name_nod_var"] == ["u_X", "u_Y", "u_Z"] and {*piece.v["eb_prop1"].tolist()} == {1, 2, 9}
        for node in piece.nodes:
            assert [piece.of_nodes[node][f"coord{axis}"] for axis in "xyz"] == whole.points[node].tolist()
            assert piece.of_nodes[node]["vals_nod_var1"] == [whole.point_data["u"][node, 0]]
        for element in piece.elements:
            assert [*piece.cells[element]] == rows[element]
            assert piece.v["eb_prop1"][piece.blocks[element] - 1] == labels[element]
            assert piece.of_elements[element][f"vals_elem_var1eb{piece.blocks[element]}"] == [s[element]]
        left = {number for _, _, number, *_ in piece.of_sets}
        assert left == {node for node in piece.nodes if whole.points[node, 0] < 0.4}


def test_elements_have_the_places_of_another_output(tmp_path):
    """Pieces with blocks of Exodus II beside an output of another format with its own order of elements."""
    write_all(tmp_path / "a.exo")
    done = order(2, tmp_path / "a.exo", "-o", tmp_path / "b.vtk", "--pieces", tmp_path / "out.e", "--parts", "4")
    assert not any("piece" in line for line in own_lines(done))
    grid = meshio.read(tmp_path / "b.vtk")
    rows = [{*row} for block in grid.cells for row in block.data.tolist()]
    labels = numpy.concatenate(grid.cell_data["label"]).ravel()
    pieces, seen = [Exodus(path) for path in paths_of(tmp_path / "out.e", 4)], []
    assert sorted(pieces[0].v["eb_prop1"]) == [5, 7, 10, 20, 30]
    for piece in pieces:
        seen += piece.elements
        assert piece.v["eb_prop1"].tolist() == pieces[0].v["eb_prop1"].tolist() and piece.common() == pieces[0].common()
        for element in piece.elements:
            assert {*piece.cells[element]} == rows[element]
            assert piece.v["eb_prop1"][piece.blocks[element] - 1] == labels[element]
        for node in piece.nodes:
            assert [piece.of_nodes[node][f"coord{axis}"] for axis in "xyz"] == grid.points[node].tolist()
    assert sorted(seen) == [*range(len(rows))] and numpy.diff(labels.astype(int)).astype(bool).sum() > 10


def pyramids(n):
    """Cubes of a lattice, each cut into six pyramids around its centre."""
    points, cubes = lattice(n)
    centres = len(points) + numpy.arange(len(cubes))
    cells = [[*(cube[k] for k in side), centre] for cube, centre in zip(cubes, centres) for side in SIDES_OF_HEX]
    return meshio.Mesh(numpy.concatenate([points, points[cubes].mean(axis=1)]), [("pyramid", cells)])


def squares(n, shape):
    """Squares of a lattice, every other one cut into two triangles; coordinates of `shape` dimensions."""
    at = numpy.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = numpy.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], -1).reshape(-1, 4)
    y, x = numpy.divmod(numpy.arange((n + 1) ** 2), n + 1)
    points = numpy.stack([x, y, x * y / n][:shape], -1).astype(float)
    cut = quads[1::2]
    return meshio.Mesh(points, [("quad", quads[::2]), ("triangle", numpy.concatenate([cut[:, [0, 1, 2]], cut[:, [0, 2, 3]]]))])


@pytest.mark.parametrize("name, make", [("a.vtu", lambda: pyramids(4)), ("a.mesh", lambda: squares(9, 2)),
                                        ("a.vtu", lambda: squares(9, 3))])
def test_sides_between_parts(tmp_path, name, make):
    make().write(tmp_path / name)
    order(2, tmp_path / name, "-o", tmp_path / "b.e", "--pieces", tmp_path / "out.e", "--parts", "5")
    whole, pieces = Exodus(tmp_path / "b.e", is_piece=False), [Exodus(path) for path in paths_of(tmp_path / "out.e", 5)]
    assert_pieces_of(whole, pieces)
    assert_maps(whole, pieces)


def test_parts_without_elements(tmp_path):
    random = numpy.random.default_rng(5)
    points = random.random((25, 3))
    mesh = meshio.Mesh(points, [("tetra", [[0, 1, 2, 3], [1, 2, 3, 4]])], point_data={"u": random.random(25)})
    mesh.write(tmp_path / "a.vtu")
    order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.e", "--pieces", tmp_path / "out.e", "--parts", "12")
    pieces = [Exodus(path) for path in paths_of(tmp_path / "out.e", 12)]
    assert any(not piece.elements for piece in pieces) and any(not piece.nodes for piece in pieces)
    whole = Exodus(tmp_path / "b.e", is_piece=False)
    assert_pieces_of(whole, pieces)
    assert_maps(whole, pieces)


def test_vtk_reads_a_piece(tmp_path, ball):
    order(3, ball, "-o", tmp_path / "b.vtu", "--pieces", tmp_path / "out.e", "--parts", "3")
    whole = meshio.read(tmp_path / "b.vtu")
    for path in paths_of(tmp_path / "out.e", 3):
        piece, reader = Exodus(path), vtkExodusIIReader()
        reader.SetFileName(str(path))
        reader.GenerateGlobalNodeIdArrayOn()
        reader.GenerateGlobalElementIdArrayOn()
        reader.Update()
        assert reader.GetErrorCode() == 0
        blocks = reader.GetOutput().GetBlock(0)
        assert blocks.GetNumberOfBlocks() == 1
        grid = blocks.GetBlock(0)
        points = convert.vtk_to_numpy(grid.GetPoints().GetData())
        nodes = convert.vtk_to_numpy(grid.GetPointData().GetArray("GlobalNodeId")) - 1
        assert sorted(nodes) == sorted(piece.nodes) and (points == whole.points[nodes].astype("f4")).all()
        elements = convert.vtk_to_numpy(grid.GetCellData().GetArray("GlobalElementId")) - 1
        rows = convert.vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
        assert (nodes[rows] == whole.cells_dict["tetra"][elements]).all() and elements.tolist() == piece.elements


def test_the_command_reads_a_piece_and_does_not_order_it(tmp_path):
    write_all(tmp_path / "a.exo")
    order(2, tmp_path / "a.exo", "--pieces", tmp_path / "out.e", "--parts", "4")
    piece = tmp_path / "out.e.4.1"
    done = serial("info", piece, "--json")
    found, expected = json.loads(done.stdout), Exodus(piece)
    assert [found["vertices"], sum(found["cells"].values())] == [len(expected.nodes), len(expected.elements)]
    assert sum("is a piece of a decomposed mesh: its communication maps" in line for line in own_lines(done)) == 1
    done = launch(1, "order", piece, "-o", tmp_path / "c.e")
    assert done.returncode == 2 and "order the whole mesh before it is decomposed" in own_lines(done)[0], done.stderr
    assert not (tmp_path / "c.e").exists()
    done = launch(2, "order", piece, "--pieces", tmp_path / "d.e")
    assert done.returncode == 2 and "order the whole mesh before it is decomposed" in own_lines(done)[0], done.stderr
    assert not [*tmp_path.glob("d.e*")]
    order(1, piece, "-o", tmp_path / "c.vtu")
    assert len(meshio.read(tmp_path / "c.vtu").points) == len(expected.nodes)


def test_fewer_pieces_than_before_leave_none_of_these(tmp_path):
    write_all(tmp_path / "a.exo")
    order(2, tmp_path / "a.exo", "--pieces", tmp_path / "out.e", "--parts", "6")
    for name in ("out.e.6", "out.e.6.1.txt", "out.e.6.x", "about.e.6.1"):
        (tmp_path / name).write_text("another file")
    order(2, tmp_path / "a.exo", "--pieces", tmp_path / "out.e", "--parts", "3")
    assert sorted(os.listdir(tmp_path)) == sorted(["a.exo", "out.e.6", "out.e.6.1.txt", "out.e.6.x", "about.e.6.1",
                                                   *(path.name for path in paths_of("out.e", 3))])


@pytest.mark.parametrize("arguments, words", [
    (["--pieces", "taken.e"], "taken.e.8.3: has the name of a piece, but meshorder did not write it"),
    (["--pieces", "other.e"], "other.e.4.0: has the name of a piece, but meshorder did not write it"),
    (["--pieces", "folder.e"], "folder.e"),
    (["--pieces", "nowhere/out.e"], "nowhere"),
    (["--pieces", "out.e", "--ghosts", "1"], "no ghost cells"),
    (["--pieces", "out.e", "-o", "full.vtu"], "full"),
])
def test_faults_leave_nothing(tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    write_all("a.exo")
    (tmp_path / "taken.e.8.3").write_text("somebody's")
    write_all("other.e.4.0")
    (tmp_path / "folder.e").mkdir()
    os.symlink("/dev/full", "full.vtu")
    before = sorted(os.listdir())
    done = launch(3, "order", "a.exo", *arguments)
    assert done.returncode == 2, done.stderr
    assert len(own_lines(done)) == 1 and words in own_lines(done)[0], done.stderr
    assert sorted(os.listdir()) == before
    order(2, "a.exo", "--pieces", "out.e", "--ghosts", "0")


def test_no_loss_where_none_is_allowed(tmp_path):
    write_all(tmp_path / "a.exo")
    order(2, tmp_path / "a.exo", "--pieces", tmp_path / "out.e", "--strict")
    meshio.Mesh(numpy.random.default_rng(1).random((4, 3)), [("tetra", [[0, 1, 2, 3]])],
                point_data={"u": numpy.ones((4, 3))}).write(tmp_path / "b.vtu")
    done = launch(2, "order", tmp_path / "b.vtu", "--pieces", tmp_path / "new.e", "--strict")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and "forbids data loss" in own_lines(done)[0], done.stderr
    assert not [*tmp_path.glob("new*")]


def test_a_full_disk_leaves_the_old_pieces(tmp_path):
    folder = tmp_path / "small"
    folder.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "none", folder], capture_output=True, check=False).returncode:
        pytest.skip("needs the right to mount a file system")
    try:
        write_all(tmp_path / "a.exo")
        order(2, tmp_path / "a.exo", "--pieces", folder / "out.e", "--parts", "2")
        before = {name: (folder / name).read_bytes() for name in os.listdir(folder)}
        write_all(tmp_path / "a.exo", n=12)
        done = launch(2, "order", tmp_path / "a.exo", "--pieces", folder / "out.e", "--parts", "2")
        assert done.returncode == 2, done.stderr
        assert len(own_lines(done)) == 1 and "out.e.2." in own_lines(done)[0], done.stderr
        assert before == {name: (folder / name).read_bytes() for name in os.listdir(folder)}
    finally:
        subprocess.run(["umount", folder], check=True)
