# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""MED files, made by MED's own library and by meshio. h5py and the library's tools judge what is written."""
import ctypes.util
import os
import pathlib
import re
import shutil
import subprocess
import sys

import h5py
import meshio
import numpy
import pytest
from conftest import MESHORDER
from hdf5_lists import listed, records_order

MAKER = pathlib.Path(__file__).with_name("med_by_library.py")
NO_PROFILE = "MED_NO_PROFILE_INTERNAL"
NODES = {"TE4": 4, "PE6": 6, "HE8": 8, "TR3": 3, "QU4": 4, "SE2": 2, "PO1": 1, "PY5": 5}


@pytest.fixture
def by_library(tmp_path):
    """A file by MED's library."""
    if ctypes.util.find_library("medC") is None:
        pytest.skip("MED's library is not installed")
    path = tmp_path / "library.med"
    subprocess.run([sys.executable, MAKER, path], check=True, capture_output=True)
    return path


def text(attribute):
    return attribute.decode("latin-1") if isinstance(attribute, bytes) else attribute


def names_in(dataset):
    rows = dataset[()].reshape(len(dataset), -1).view("S1").reshape(len(dataset), -1)
    return [b"".join(row).rstrip(b" \0").decode() for row in rows]


def families_of(file, mesh, kind):
    root = file["FAS"][mesh].get(kind, {})
    return {int(family.attrs["NUM"]): (name, sorted(names_in(family["GRO/NOM"])) if "GRO" in family else [])
            for name, family in root.items()}


class Content:
    """The content of a file on vertices and cells, which their coordinates identify."""

    def __init__(self, path):
        with h5py.File(path) as file:
            self.others = {}
            file.visititems(self.keep)
            mesh, = file["ENS_MAA"]
            step, = file["ENS_MAA"][mesh].values()
            points = step["NOE/COO"][()].reshape(int(file["ENS_MAA"][mesh].attrs["ESP"]), -1).T
            self.keys = {"NOE": [tuple(point) for point in points]}
            for kind, group in step["MAI"].items():
                rows = group["NOD"][()].reshape(NODES[kind], -1).T
                self.keys[kind] = [tuple(tuple(points[node - 1]) for node in row) for row in rows]
            self.items = self.of_items("NOE", step["NOE"], families_of(file, mesh, "NOEUD"))
            for kind, group in step["MAI"].items():
                self.items |= self.of_items(kind, group, families_of(file, mesh, "ELEME"))
            self.fields = {}
            for name, field in file.get("CHA", {}).items():
                for number, at in field.items():
                    for support, group in at.items():
                        self.read_field(file, (name, number, support), int(field.attrs["NCO"]), group)
            self.pairs = {}
            for name, equivalence in file["EQS"][mesh].items() if "EQS" in file else ():
                for support, group in next(iter(equivalence.values())).items():
                    keys = self.keys[support.replace("MAI.", "")]
                    self.pairs[name, support] = [[keys[k - 1] for k in pair] for pair in group["COR"][()].reshape(-1, 2)]

    def keep(self, name, item):
        """Keeps attributes, and the values of datasets that do not belong to vertices or cells."""
        if name.startswith("PROFILS/") or "/NOE" in name or "/MAI" in name:
            return
        attributes = {key: value if isinstance(value, (bytes, numpy.generic)) else list(value)
                      for key, value in item.attrs.items()}
        of_item = isinstance(item, h5py.Dataset) and name.startswith("GAUSS")
        self.others[name] = (attributes, item[()].tolist() if of_item else None)

    def of_items(self, kind, group, families):
        keys = self.keys[kind]
        columns = {name: group[name][()] for name in ("NUM", "GLB", "FAM") if name in group}
        if "NOM" in group:
            columns["NOM"] = names_in(group["NOM"])
        if "FAM" in columns:
            columns["groups"] = [(int(number), families.get(int(number))) for number in columns["FAM"]]
        for name in set(group) & {"COO", "NOD", "FAM", "NUM", "GLB", "NOM"}:
            assert group[name].attrs["NBR"] == len(keys)
        return {(kind, name): dict(zip(keys, values)) for name, values in columns.items()}

    def read_field(self, file, key, components, support):
        keys = self.keys[key[2].replace("MAI.", "").replace("NOE.", "")]
        for profile, group in support.items():
            places = range(1, len(keys) + 1)
            if profile != NO_PROFILE:
                places = file["PROFILS"][profile]["PFL"][()]
                assert file["PROFILS"][profile].attrs["NBR"] == len(places)
            assert group.attrs["NBR"] in (len(places), len(keys))
            values = group["CO"][()].reshape(components, len(places), -1)
            self.fields[key] = {keys[place - 1]: values[:, row].tolist() for row, place in enumerate(places)}


def assert_same(found, expected, but_for=()):
    for part in ("items", "fields", "pairs", "others"):
        one, other = getattr(found, part), getattr(expected, part)
        assert one.keys() == other.keys()
        for key in one.keys() - set(but_for):
            assert one[key] == other[key], key


def numbers_of(content):
    return {key: values for key, values in content.items.items() if key[1] == "NUM"}


@pytest.mark.parametrize("ids", ["keep", "renumber"])
def test_all_that_a_file_of_the_library_has_moves_with_its_mesh(command, by_library, ids):
    command.ok("order", by_library, "-o", "new.med", "--vertices", "scrambled", "--elements", "scrambled", "--ids", ids)
    before, after = Content(by_library), Content(command.folder / "new.med")
    assert before.keys["NOE"] != after.keys["NOE"] and before.keys["TE4"] != after.keys["TE4"]
    assert len(before.fields) == 11 and len(before.pairs) == 2
    if ids == "keep":
        # tetrahedra had no numbers and now have some
        after.items.pop(("TE4", "NUM"))
        return assert_same(after, before)
    assert_same(after, before, but_for=numbers_of(before))
    for key, numbers in numbers_of(after).items():
        # the numbers ascend along the new order
        assert list(numbers.values()) == sorted(numbers.values()), key
    assert sorted(after.items["NOE", "NUM"].values()) == sorted(before.items["NOE", "NUM"].values())


def test_a_file_that_keeps_its_order_stays_as_it_is(command, by_library):
    command.ok("order", by_library, "-o", "new.med", "--vertices", "original", "--elements", "original")
    before, after = Content(by_library), Content(command.folder / "new.med")
    assert after.keys == before.keys
    assert_same(after, before)


def dump(path):
    tool = shutil.which("mdump4") or pytest.skip("MED's tools are not installed")
    done = subprocess.run([tool, path, "NODALE", "FULL_INTERLACE", "0"], capture_output=True, text=True, check=False)
    # the first lines name the file
    return [line for line in done.stdout.splitlines() if str(path) not in line], done.stderr


def test_the_tools_of_the_library_read_what_is_written(command, by_library):
    command.ok("order", by_library, "-o", "same.med", "--vertices", "original", "--elements", "original")
    command.ok("order", by_library, "-o", "new.med", "--vertices", "rcm", "--elements", "min")
    old, faults = dump(by_library)
    assert len(old) > 500
    assert dump(command.folder / "same.med")[0][1:-1] == old[1:-1]
    new, new_faults = dump(command.folder / "new.med")
    assert len(new_faults) <= len(faults) and abs(len(new) - len(old)) < 40
    for name in ("same.med", "new.med"):
        told = subprocess.run(["medconforme", command.folder / name], capture_output=True, text=True, check=True).stdout
        assert told.count("conforme") >= 2 and "non conforme" not in told


def test_profiles_that_two_types_shared_are_parted(command, by_library):
    command.ok("order", by_library, "-o", "new.med", "--vertices", "scrambled", "--elements", "scrambled")
    with h5py.File(command.folder / "new.med") as file:
        support = next(iter(file["CHA/SIEF"].values()))
        names = [text(support[kind].attrs["PFL"]) for kind in ("MAI.PE6", "MAI.TR3")]
        assert sorted(names) == ["few", "few_2"]
        for name in names:
            assert (numpy.diff(file["PROFILS"][name]["PFL"][()]) > 0).all()


def by_meshio(path, chance=numpy.random.default_rng(2), triangle_count=8):
    """Tetrahedra and triangles with families, groups and fields, as meshio writes them."""
    points = chance.uniform(size=(30, 3))
    tetrahedra = numpy.array([chance.permutation(30)[:4] for _ in range(20)])
    low = points[tetrahedra]
    turned = numpy.linalg.det(low[:, 1:] - low[:, :1]) < 0
    tetrahedra[turned] = tetrahedra[turned][:, [0, 2, 1, 3]]
    triangles = tetrahedra[:triangle_count, :3]
    mesh = meshio.Mesh(points, [("tetra", tetrahedra), ("triangle", triangles)],
                       point_data={"point_tags": chance.integers(0, 3, 30), "heat": chance.uniform(size=30)},
                       cell_data={"cell_tags": [-chance.integers(0, 3, 20), -chance.integers(0, 3, triangle_count)],
                                  "flux": [chance.uniform(size=(20, 3)), chance.uniform(size=(triangle_count, 3))]})
    mesh.point_tags = {1: ["held"], 2: ["held", "hot"]}
    mesh.cell_tags = {-1: ["steel"], -2: ["skin"]}
    meshio.write(path, mesh)
    return mesh


def test_datasets_that_two_types_share_are_parted(command):
    by_meshio(command.folder / "old.med", triangle_count=20)

    def share(file, mesh, step):
        del step["MAI/TR3/FAM"]
        step["MAI/TR3/FAM"] = step["MAI/TE4/FAM"]
        flux, = file["CHA/flux"].values()
        del flux["MAI.TR3"]
        flux["MAI.TR3"] = flux["MAI.TE4"]

    change(command.folder / "old.med", share)
    command.ok("order", "old.med", "-o", "new.med", "--vertices", "scrambled", "--elements", "scrambled")
    assert_same(Content(command.folder / "new.med"), Content(command.folder / "old.med"))


def test_a_group_of_two_paths_is_written_to_by_one(command):
    """The added family zero must go to /FAS only, not become a type of cells."""
    by_meshio(command.folder / "old.med")

    def share(file, mesh, step):
        del file["FAS"]
        file["FAS"] = step["MAI"]

    change(command.folder / "old.med", share)
    command.ok("order", "old.med", "-o", "new.med", "--vertices", "scrambled", "--elements", "scrambled")
    command.ok("order", "new.med", "-o", "again.med", "--vertices", "original", "--elements", "original")
    with h5py.File(command.folder / "again.med") as file:
        step, = file["ENS_MAA/mesh"].values()
        assert set(step["MAI"]) == {"TE4", "TR3"}
        assert set(file["FAS/mesh"]) == {"FAMILLE_ZERO"}


def test_numbers_of_families_that_are_not_there_stay(command):
    """Numbers of cells' families should be negative, of nodes' positive."""
    by_meshio(command.folder / "old.med")
    chance = numpy.random.default_rng(4)

    def renumber(file, mesh, step):
        rewrite(step["MAI/TE4"], "FAM", chance.integers(-9, 9, 20))
        rewrite(step["NOE"], "FAM", chance.integers(-9, 9, 30))

    change(command.folder / "old.med", renumber)
    command.ok("order", "old.med", "-o", "new.med", "--vertices", "scrambled", "--elements", "scrambled")
    assert_same(Content(command.folder / "new.med"), Content(command.folder / "old.med"))


def test_a_file_of_meshio_stays_the_same_mesh_to_it(command):
    by_meshio(command.folder / "old.med")
    done = command.ok("order", "old.med", "-o", "new.med", "--vertices", "scrambled", "--elements", "scrambled",
                      "--maps", "maps")
    assert "the nodes of volumes have the sequence of meshio" in done.stderr
    old, new = (meshio.read(command.folder / name) for name in ("old.med", "new.med"))
    place = numpy.load(command.folder / "maps.vertices.old_to_new.npy")
    assert (new.points[place] == old.points).all()
    assert (new.point_data["heat"][place] == old.point_data["heat"]).all()
    assert (new.point_data["point_tags"][place] == old.point_data["point_tags"]).all()
    assert new.point_tags == old.point_tags and new.cell_tags == old.cell_tags
    for b, block in enumerate(old.cells):
        def row(mesh, cells, k):
            return (tuple(cells.data[k]), mesh.cell_data["cell_tags"][b][k], tuple(mesh.cell_data["flux"][b][k]))
        expected = {(tuple(place[list(nodes)]), tag, flux) for nodes, tag, flux in
                    (row(old, block, k) for k in range(len(block.data)))}
        assert {row(new, new.cells[b], k) for k in range(len(block.data))} == expected


def test_groups_become_sets_and_sets_groups(command):
    by_meshio(command.folder / "old.med")
    old = meshio.read(command.folder / "old.med")
    command.ok("order", "old.med", "-o", "between.msh", "--vertices", "original", "--elements", "original")
    command.ok("order", "between.msh", "-o", "new.med", "--vertices", "original", "--elements", "original")
    new = meshio.read(command.folder / "new.med")

    def members(mesh, group):
        result = set()
        for block, tags in zip(mesh.cells, mesh.cell_data["cell_tags"]):
            for nodes, tag in zip(block.data, tags):
                if group in mesh.cell_tags.get(tag, []):
                    result.add(frozenset(map(tuple, mesh.points[nodes])))
        return result

    for group in ("steel", "skin"):
        assert members(new, group) == members(old, group) != set()
    # tetrahedra have MED's orientation
    corners = new.points[next(block.data for block in new.cells if block.type == "tetra")]
    assert (numpy.linalg.det(corners[:, 1:] - corners[:, :1]) < 0).all()


def add_families(file, count):
    """Families whose names are in another sequence than their numbers."""
    del file["FAS/mesh/ELEME"]
    families = file["FAS/mesh"].create_group("ELEME", track_order=True)
    for k in range(count):
        family = families.create_group(f"the family named {(7 * k + 3) % count}")
        family.attrs["NUM"] = -1 - k
        group = family.create_group("GRO")
        group.attrs["NBR"] = 1
        group["NOM"] = numpy.array([f"face{k}"], "S80")


@pytest.mark.parametrize("count", [3, 6, 20])
def test_steps_and_families_keep_their_sequence(command, count):
    """Boundary conditions go by the sequence of families, and a program reads the last step."""
    by_meshio(command.folder / "old.med")

    def add(file, mesh, step):
        field = file["CHA"].create_group("T", track_order=True)
        for key, value in file["CHA/heat"].attrs.items():
            field.attrs[key] = value
        old, = file["CHA/heat"].values()
        for k in range(count):
            number = (7 * k + 4) % count
            file.copy(old, field, name=f"{number:020d}{-1:020d}")
            field[f"{number:020d}{-1:020d}"].attrs.modify("NDT", number)
        add_families(file, count)
        rewrite(step["MAI/TE4"], "FAM", -1 - numpy.arange(20) % count)
        rewrite(step["MAI/TR3"], "FAM", -1 - numpy.arange(8) % count)

    change(command.folder / "old.med", add)
    old = listed(command.folder / "old.med")
    for vertices, elements in (("original", "original"), ("scrambled", "scrambled")):
        command.ok("order", "old.med", "-o", "new.med", "--vertices", vertices, "--elements", elements)
        new = listed(command.folder / "new.med")
        for group in ("CHA/T", "FAS/mesh/ELEME"):
            assert new[group] == old[group] and len(new[group]) == count


def test_families_are_listed_in_the_sequence_of_groups(command):
    """Files before version 3.2 are listed by name, later ones by creation."""
    by_meshio(command.folder / "old.med")

    def add(file, mesh, step):
        add_families(file, 12)
        rewrite(step["MAI/TE4"], "FAM", -1 - numpy.arange(20) % 12)
        rewrite(step["MAI/TR3"], "FAM", numpy.zeros(8, int))

    change(command.folder / "old.med", add)
    command.ok("order", "old.med", "-o", "between.vtu", "--vertices", "original", "--elements", "original")
    command.ok("order", "between.vtu", "-o", "new.med", "--vertices", "original", "--elements", "original")
    names = listed(command.folder / "new.med")["FAS/mesh/ELEME"]
    with h5py.File(command.folder / "new.med") as file:
        families = file["FAS/mesh/ELEME"]
        assert records_order(families) and names == sorted(names)
        assert [names_in(families[name]["GRO/NOM"]) for name in names] == [[f"face{k}"] for k in range(12)]


def test_steps_come_back_from_other_formats(command, by_library):
    command.ok("order", by_library, "-o", "between.vtu", "--vertices", "rcm", "--elements", "min")
    command.ok("order", "between.vtu", "-o", "new.med", "--vertices", "original", "--elements", "original")
    old, new = Content(by_library), Content(command.folder / "new.med")
    for step in (1, 2, 3):
        of_old = old.fields["DEPL", f"{step - 1:020d}-0000000000000000001", "NOE"]
        assert new.fields["DEPL", f"{step:020d}-0000000000000000001", "NOE"] == of_old
    with h5py.File(command.folder / "new.med") as file:
        assert text(file["CHA/DEPL"].attrs["NOM"]).split() == ["DX", "DY", "DZ"]


def change(path, work):
    with h5py.File(path, "r+") as file:
        mesh, = file["ENS_MAA"].values()
        step, = mesh.values()
        work(file, mesh, step)


def rewrite(group, name, values):
    attributes = dict(group[name].attrs)
    del group[name]
    group[name] = values
    group[name].attrs.update(attributes)


REFUSED = {
    "structured": (lambda f, m, s: m.attrs.modify("TYP", 1), "is structured; its order is fixed by the grid"),
    "version": (lambda f, m, s: f["INFOS_GENERALES"].attrs.modify("MAJ", 2), "is of version 2 of MED; write it"),
    "two meshes": (lambda f, m, s: f.copy(m, "ENS_MAA/other"), "has 2 meshes: mesh, other; save each"),
    "steps": (lambda f, m, s: f.copy(s, m.name + "/later"), "changes over 2 steps; save one"),
    "polygons": (lambda f, m, s: s["MAI"].create_group("POG"), "has polygons; cut them"),
    "polyhedra": (lambda f, m, s: s["MAI"].create_group("POE"), "has polyhedra; cut them"),
    "structural": (lambda f, m, s: s["MAI"].create_group("MED_PARTICLE"), "has cells of an unknown type; points"),
    "joints": (lambda f, m, s: f.create_group("JNT/mesh/other"), "says that the mesh is a piece of a larger one"),
    "faces": (lambda f, m, s: s.create_group("FAC/TR3"), "describes its cells by faces"),
    "node": (lambda f, m, s: s["MAI/TE4/NOD"].write_direct(numpy.full(80, 31)), "names node 31 in cell 1, which does"),
    "short": (lambda f, m, s: rewrite(s["MAI/TE4"], "NOD", numpy.arange(1, 10)), "has 9 values, which do not make rows of 4"),
    "families": (lambda f, m, s: rewrite(s["NOE"], "FAM", numpy.zeros(29, int)), "has 29 whole numbers, not 30"),
    "no nodes": (lambda f, m, s: s["NOE"].pop("COO"), "NOE/COO' is missing or damaged"),
    "not a number": (lambda f, m, s: rewrite(s["NOE"], "COO", numpy.full(90, numpy.nan)), "is not finite"),
    "field": (lambda f, m, s: f["CHA/heat"].attrs.modify("NCO", 7), "has 30 values, not 7 components × 1 points × 30"),
    "no mesh": (lambda f, m, s: f.pop("ENS_MAA"), "has no mesh; a file of MED has its meshes"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_understood_is_refused_in_one_line(command, name):
    path = command.folder / "a.med"
    by_meshio(path)
    work, message = REFUSED[name]
    change(path, work)
    assert message in command.fails("order", "a.med", "-o", "b.med")
    assert not (command.folder / "b.med").exists()


def test_other_groups_and_other_meshes_stay(command):
    path = command.folder / "a.med"
    by_meshio(path)

    def add(file, mesh, step):
        file.copy(mesh, "ENS_MAA/grid")
        file["ENS_MAA/grid"].attrs.modify("TYP", 1)
        file["PARAMS"] = numpy.arange(5)
        file.copy("CHA/heat", "CHA/of grid")
        file["CHA/of grid"].attrs["MAI"] = numpy.bytes_("grid")

    change(path, add)
    done = command.ok("order", "a.med", "-o", "b.med", "--vertices", "scrambled", "--elements", "scrambled")
    assert "the mesh 'mesh' is read; structured ones stay as they are: grid" in done.stderr
    with h5py.File(path) as old, h5py.File(command.folder / "b.med") as new:
        assert new["PARAMS"][()].tolist() == [0, 1, 2, 3, 4]
        for group in ("ENS_MAA/grid", "CHA/of grid"):
            def same(name, item, other=new[group]):
                if isinstance(item, h5py.Dataset):
                    assert (item[()] == other[name][()]).all()
            old[group].visititems(same)


@pytest.mark.parametrize("signature", ["SNOD", "HEAP", "TREE"])
def test_no_group_that_cannot_be_read_is_taken_for_an_absent_one(command, signature):
    """Damages the list of entries, or of their names, in one group after another."""
    by_meshio(command.folder / "a.med")
    whole = (command.folder / "a.med").read_bytes()
    keep = ("--vertices", "original", "--elements", "original")
    places = [match.start() for match in re.finditer(signature.encode(), whole)]
    assert len(places) > 10
    for place in places:
        (command.folder / "broken.med").write_bytes(whole[:place] + b"none" + whole[place + 4:])
        done = command.run("order", "broken.med", "-o", "out.med", *keep)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1), f"byte {place}: {done.stderr}"
        assert "broken.med" in done.stderr


def test_damaged_files_never_crash(command, by_library):
    small = command.folder / "small.med"
    by_meshio(small)
    chance = numpy.random.default_rng(7)
    # libhdf5 allocates as much memory as a damaged file claims, and leaks some after an error
    settings = os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0:allocator_may_return_null=1"
    environment = {**os.environ, "ASAN_OPTIONS": settings}
    for path in (small, by_library):
        whole = path.read_bytes()
        for k in range(40):
            broken = bytearray(whole[: chance.integers(1, len(whole))] if k % 4 == 0 else whole)
            for place in chance.integers(0, len(broken), chance.integers(1, 20)):
                broken[place] = chance.integers(0, 256)
            (command.folder / "broken.med").write_bytes(broken)
            done = subprocess.run([MESHORDER, "order", "broken.med", "-o", "out.med", "--vertices", "original"],
                                  cwd=command.folder, capture_output=True, timeout=60, check=False, env=environment)
            assert done.returncode in (0, 2)
