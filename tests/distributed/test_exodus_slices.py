# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Exodus files that all ranks read at once: pieces and maps are the same as if rank 0 reads the mesh."""
import json
import os
import subprocess
import sys

import numpy
import pytest
from test_mpi import MESHORDER, MPIRUN, ROOT, SECONDS, environment, launch, order, own_lines
from test_pieces import Grid

sys.path.insert(0, str(ROOT / "tests" / "command"))
from test_exodus import KINDS, put_names, write_all  # noqa: E402

netCDF4 = pytest.importorskip("netCDF4")

#: blocks of several shapes and orders, one of them empty
BLOCKS = [("HEX20", 20, 60), ("TETRA10", 10, 90), ("NULL", 0, 0), ("WEDGE15", 15, 40), ("QUAD8", 8, 30), ("BAR2", 2, 20)]


def write(path, blocks=BLOCKS, points=400, kind="NETCDF3_64BIT_OFFSET", seed=1, order="", **stored):
    """Writes elements, points and ids in random order, and values at two steps. `stored`: options of netCDF4."""
    chance = numpy.random.default_rng(seed)
    elements = sum(count for *_, count in blocks)
    with netCDF4.Dataset(path, "w", format=kind) as f:
        for name, length in [("len_string", 33), ("len_name", 33), ("time_step", None), ("num_dim", 3), ("num_nodes", points),
                             ("num_elem", elements), ("num_el_blk", len(blocks)), ("num_nod_var", 1), ("num_elem_var", 1)]:
            f.createDimension(name, length)

        def add(name, values, dimensions, type_name, /, **attributes):
            endian = {"<": "little", ">": "big"}.get(order, "native")
            variable = f.createVariable(name, order + type_name, dimensions, endian=endian, **stored)
            variable.setncatts(attributes)
            variable[:] = values

        add("time_whole", [0, 1], ("time_step",), "f8")
        add("coord", chance.random((3, points)), ("num_dim", "num_nodes"), "f8")
        add("eb_prop1", 10 * numpy.arange(len(blocks)) + 5, ("num_el_blk",), "i4", name="ID")
        add("node_num_map", 7 + 3 * chance.permutation(points), ("num_nodes",), "i4")
        add("elem_num_map", 1 + chance.permutation(elements), ("num_elem",), "i4")
        put_names(f, "name_nod_var", "num_nod_var", ["u"])
        put_names(f, "name_elem_var", "num_elem_var", ["s"])
        add("vals_nod_var1", chance.random((2, points)), ("time_step", "num_nodes"), "f4")
        for b, (kind_of_block, nodes, count) in enumerate(blocks, 1):
            if count == 0:
                continue
            f.createDimension(f"num_el_in_blk{b}", count)
            f.createDimension(f"num_nod_per_el{b}", nodes)
            rows = numpy.array([1 + chance.choice(points - 20, nodes, replace=False) for _ in range(count)])
            add(f"connect{b}", rows, (f"num_el_in_blk{b}", f"num_nod_per_el{b}"), "i4", elem_type=kind_of_block)
            if b != 2:
                add(f"vals_elem_var1eb{b}", chance.random((2, count)), ("time_step", f"num_el_in_blk{b}"), "f8")
    return path


def by(done):
    return json.loads(done.stdout)["files_by"]


def files_of(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def assert_same_by_all_and_by_rank_0(source, folder, ranks, *options):
    """Asserts the same pieces, maps and warnings if all ranks read, and if rank 0 reads because of another output."""
    (folder / "other").mkdir()
    parts = ["--parts", 3, "--json", *options]
    for_all = order(ranks, source, "--pieces", folder / "all", "--maps", folder / "all-maps", *parts)
    for_root = order(ranks, source, "-o", folder / "other" / f"{source.stem}.vtu", "--pieces", folder / "root", "--maps",
                     folder / "root-maps", *parts)
    assert (by(for_all), by(for_root)) == ("all ranks", "rank 0")
    assert files_of(folder / "all") == files_of(folder / "root")
    maps = [{path.name[len(who):]: path.read_bytes() for path in folder.glob(f"{who}-maps.*")} for who in ("all", "root")]
    assert maps[0] == maps[1] and len(maps[0]) >= 7
    assert sorted(own_lines(for_all)) == sorted(own_lines(for_root))
    all_json, root_json = json.loads(for_all.stdout), json.loads(for_root.stdout)
    for key in ("vertices", "cells", "partition", "edge_span", "pieces"):
        a, b = (json.dumps(result[key]).replace(f"/{name}/", "/") for result, name in ((all_json, "all"), (root_json, "root")))
        assert a == b, key
    return for_all


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("ranks", [1, 4])
def test_all_that_a_file_holds_is_what_rank_0_reads(tmp_path, kind, ranks):
    write_all(tmp_path / "a.e", kind)
    assert_same_by_all_and_by_rank_0(tmp_path / "a.e", tmp_path, ranks)
    piece = Grid(tmp_path / "all" / "a_0000.vtu")
    assert {"vertex_id", "ux step 3", "set:left", "map owners"} <= set(piece.of_points)
    assert {"cell_id", "label", "set:steel", "side set pressed", "side set pressed factors"} <= set(piece.of_cells)


@pytest.mark.parametrize("stored", [{}, {"kind": "NETCDF4", "zlib": True, "chunksizes": None},
                                    {"kind": "NETCDF4", "order": ">"}, {"kind": "NETCDF4", "order": "<", "fletcher32": True}])
@pytest.mark.parametrize("ranks", [2, 5])
def test_blocks_of_higher_order_in_every_storage(tmp_path, ranks, stored):
    write(tmp_path / "a.e", **stored)
    assert_same_by_all_and_by_rank_0(tmp_path / "a.e", tmp_path, ranks)


def test_fewer_elements_than_ranks(tmp_path):
    write(tmp_path / "a.e", blocks=[("TETRA", 4, 2), ("NULL", 0, 0), ("TRI3", 3, 1)], points=28)
    assert_same_by_all_and_by_rank_0(tmp_path / "a.e", tmp_path, 5)


def edit(change):
    """Changes variables of a file in place."""
    def work(path):
        with netCDF4.Dataset(path, "a") as f:
            f.set_auto_mask(False)
            change(f.variables)
    return work


def put(name, place, value):
    def change(variables):
        variables[name][place] = value
    return edit(change)


def repeat_members(variables):
    variables["node_ns1"][3] = variables["node_ns1"][0]
    variables["elem_els1"][2] = variables["elem_els1"][1]
    variables["elem_ss1"][5], variables["side_ss1"][5] = variables["elem_ss1"][0], variables["side_ss1"][0]
    variables["node_num_map"][-1] = variables["node_num_map"][0]


def test_members_and_numbers_that_are_given_twice(tmp_path):
    write_all(tmp_path / "a.e")
    edit(repeat_members)(tmp_path / "a.e")
    done = assert_same_by_all_and_by_rank_0(tmp_path / "a.e", tmp_path, 4)
    said = "\n".join(own_lines(done))
    for note in ("node_num_map is left out: it gives the number 100 twice", "node set left names 1 members twice",
                 "side set pressed names 1 members twice", "element set some names 1 members twice"):
        assert note in said, said
    assert not (tmp_path / "all-maps.vertices.ids.npy").exists() and (tmp_path / "all-maps.cells.ids.npy").exists()


def test_maps_of_an_earlier_run_go(tmp_path):
    write_all(tmp_path / "a.e")
    order(2, tmp_path / "a.e", "--pieces", tmp_path / "p", "--maps", tmp_path / "m")
    assert numpy.load(tmp_path / "m.vertices.ids.npy")[:2].tolist() == [100, 102]
    edit(lambda variables: variables["node_num_map"].__setitem__(slice(None), 1 + numpy.arange(64)))(tmp_path / "a.e")
    order(2, tmp_path / "a.e", "--pieces", tmp_path / "p", "--maps", tmp_path / "m")
    assert not (tmp_path / "m.vertices.ids.npy").exists() and (tmp_path / "m.cells.ids.npy").exists()


@pytest.mark.parametrize("options", [["-o", "b.e"], ["--ids", "keep"], ["--only", "volume"], ["--strict"]])
def test_what_needs_the_whole_mesh_is_done_by_rank_0(tmp_path, options):
    write(tmp_path / "a.e", blocks=BLOCKS[:1])
    options = [tmp_path / option if option == "b.e" else option for option in options]
    done = launch(2, "order", tmp_path / "a.e", "--pieces", tmp_path / "p", "--json", *options)
    if "--strict" in options:  # in pieces, sets and ids would become arrays
        assert done.returncode == 2 and "--strict forbids data loss" in own_lines(done)[0]
    else:
        assert done.returncode == 0 and by(done) == "rank 0", done.stderr


def cut(path):
    os.truncate(path, os.path.getsize(path) - 2000)


def lie(path):
    """Makes the file claim fewer elements than the blocks have."""
    with netCDF4.Dataset(path, "a") as f:
        f.renameDimension("num_elem", "was_num_elem")
        f.createDimension("num_elem", 5)


FAULTS = {
    "unexpected end of file": cut,
    "vertex 390 has a coordinate that is not finite": put("coord", (1, 390), numpy.nan),
    "connect6, element 19: node 401 does not exist": put("connect6", (18, 1), 401),
    "connect1, element 1: node 0 does not exist": put("connect1", (0, 0), 0),
    "connect1 has more elements than num_elem, 5, leaves": lie,
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_on_any_rank_ends_all_with_one_line(tmp_path, fault):
    FAULTS[fault](write(tmp_path / "a.e"))
    done = launch(3, "order", tmp_path / "a.e", "--pieces", tmp_path / "p")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and fault in own_lines(done)[0], done.stderr
    assert os.listdir(tmp_path) == ["a.e"]


MEMBERS = {
    "node_ns1, entry 2: node 65 does not exist": put("node_ns1", 1, 65),
    "side_ss1, entry 5: a wedge has no side 6": put("side_ss1", 4, 6),
    "elem_els1, entry 4: element -1 does not exist": put("elem_els1", 3, -1),
}


@pytest.mark.parametrize("fault", MEMBERS)
def test_a_faulty_set_ends_all_ranks(tmp_path, fault):
    write_all(tmp_path / "a.e")
    MEMBERS[fault](tmp_path / "a.e")
    done = launch(3, "order", tmp_path / "a.e", "--pieces", tmp_path / "p")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and fault in own_lines(done)[0], done.stderr
    assert os.listdir(tmp_path) == ["a.e"]


def test_a_file_that_only_rank_0_sees(tmp_path):
    for folder in ("here", "there"):
        (tmp_path / folder).mkdir()
    write(tmp_path / "here" / "a.e")
    command = [str(MESHORDER), "order", "a.e", "--pieces", str(tmp_path / "p")]
    ranks = [*MPIRUN, "-n", "1", "--wdir", tmp_path / "here", *command, ":", "-n", "2", "--wdir", tmp_path / "there", *command]
    done = subprocess.run(ranks, env=environment(), capture_output=True, text=True, timeout=SECONDS, check=False)
    assert done.returncode == 2 and len(own_lines(done)) == 1 and "a.e: " in own_lines(done)[0], done.stderr
    assert not (tmp_path / "p").exists()


def test_what_a_file_claims_is_limited_on_each_rank(tmp_path):
    write(tmp_path / "a.e", blocks=[("TETRA", 4, 40000)], points=9000, kind="NETCDF4", zlib=True, complevel=9)
    done = launch(2, "order", tmp_path / "a.e", "--pieces", tmp_path / "p", "--limit-memory", "300K")
    assert done.returncode == 2 and len(own_lines(done)) == 1 and "--limit-memory" in own_lines(done)[0], done.stderr
    order(2, tmp_path / "a.e", "--pieces", tmp_path / "p", "--limit-memory", "40M")
