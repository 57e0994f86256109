# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files of every version of Gmsh's format, written and read again by Gmsh itself."""
import re
from collections import Counter

import pytest

gmsh = pytest.importorskip("gmsh")


@pytest.fixture
def model():
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield gmsh.model
    gmsh.finalize()


def make(path, version, order, binary=0, parametric=0, partitions=0):
    """Writes a box of two regions of tetrahedra with named groups, faces and a periodic pair."""
    gmsh.clear()
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.addBox(1, 0, 0, 1, 1, 1)
    gmsh.model.occ.fragment([(3, 1)], [(3, 2)])
    gmsh.model.occ.synchronize()
    low, high = (gmsh.model.getEntitiesInBoundingBox(-1, -1, z - 0.1, 3, 3, z + 0.1, 2) for z in (0, 1))
    shift = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1]
    gmsh.model.mesh.setPeriodic(2, [tag for _, tag in high], [tag for _, tag in low], shift)
    gmsh.model.addPhysicalGroup(3, [1], 7, "left")
    gmsh.model.addPhysicalGroup(3, [2], 8, "right")
    gmsh.model.addPhysicalGroup(2, [tag for _, tag in low], 3, "floor")
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.4)
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.option.setNumber("Mesh.SaveParametric", parametric)
    gmsh.model.mesh.generate(3)
    if partitions:
        gmsh.model.mesh.partition(partitions)
    gmsh.write(str(path))


def content(path):
    """Gmsh's view of a file: nodes and elements by the coordinates of their nodes, with groups and periodic pairs."""
    gmsh.clear()
    gmsh.open(str(path))
    mesh = gmsh.model.mesh
    tags, places, _ = mesh.getNodes()
    place = dict(zip(tags, map(tuple, places.reshape(-1, 3))))
    found = Counter()
    for dimension, entity in gmsh.model.getEntities():
        groups = tuple(gmsh.model.getPhysicalGroupsForEntity(dimension, entity))
        names = tuple(gmsh.model.getPhysicalName(dimension, group) for group in groups)
        for kind, _, nodes in zip(*mesh.getElements(dimension, entity)):
            size = mesh.getElementProperties(kind)[3]
            for first in range(0, len(nodes), size):
                found[(dimension, entity, groups, names, kind, tuple(place[v] for v in nodes[first:first + size]))] += 1
        if dimension == 2:
            master, own, others, affine = mesh.getPeriodicNodes(2, entity)
            for pair in zip(own, others):
                found[("periodic", entity, master, tuple(affine), place[pair[0]], place[pair[1]])] += 1
        found[("nodes", dimension, entity, len(mesh.getNodes(dimension, entity)[0]))] += 1
    return set(place.values()), found


@pytest.mark.parametrize("version, order, more", [
    (1, 1, {}), (1, 2, {}), (2.2, 1, {}), (2.2, 2, {"binary": 1}), (4.0, 1, {}), (4.0, 2, {"parametric": 1}),
    (4.0, 1, {"partitions": 2}), (4.1, 2, {}), (4.1, 1, {"binary": 1, "parametric": 1})])
def test_gmsh_finds_the_same_in_its_own_version(command, tmp_path, model, version, order, more):
    make(tmp_path / "a.msh", version, order, **more)
    head = (tmp_path / "a.msh").read_bytes().split(b"\n")[:2]
    assert head[0] == b"$NOD" if version == 1 else head[1].startswith(b"%g " % version)
    command.ok("order", tmp_path / "a.msh", "-o", tmp_path / "b.msh", "--vertices", "rcm", "--elements", "min")
    assert (tmp_path / "b.msh").read_bytes().split(b"\n")[:2] == head
    before, after = content(tmp_path / "a.msh"), content(tmp_path / "b.msh")
    assert before[0] == after[0]
    assert before[1] == after[1]
    assert (tmp_path / "b.msh").read_bytes() != (tmp_path / "a.msh").read_bytes()


def test_a_misspelt_end_is_read_as_gmsh_reads_it(command, tmp_path, model):
    make(tmp_path / "a.msh", 4.1, 1)
    text = (tmp_path / "a.msh").read_text()
    data = '$ElementData\n1\n"v"\n1\n0\n3\n0\n1\n1\n{} 5\n$EndElementData\n'
    element = re.search(r"\$Elements\n.*\n.*\n(\d+) ", text)[1]
    (tmp_path / "a.msh").write_text(text + data.format(element))
    (tmp_path / "b.msh").write_text(text + data.format(element).replace("EndElement", "EndElememt"))
    for name in ("a", "b"):
        done = command.ok("order", tmp_path / f"{name}.msh", "-o", tmp_path / f"{name}-ordered.msh", "--vertices", "rcm",
                          "--elements", "min")
        assert ("$EndElememtData is read as $EndElementData" in done.stderr) == (name == "b")
    assert (tmp_path / "a-ordered.msh").read_bytes() == (tmp_path / "b-ordered.msh").read_bytes()
    assert content(tmp_path / "b.msh") == content(tmp_path / "a.msh")
