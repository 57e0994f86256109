# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Gmsh's running model, checked by Gmsh's functions and by the files that Gmsh writes."""

import meshio
import meshorder
import numpy as np
import pytest
from meshorder import InvalidArgument

gmsh = pytest.importorskip("gmsh")


def make_box(order=1, size=0.3, recombine=False):
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.addBox(1, 0, 0, 1, 1, 1)
    gmsh.model.occ.fragment([(3, 1)], [(3, 2)])
    gmsh.model.occ.synchronize()
    gmsh.model.addPhysicalGroup(3, [1], 7, "left")
    gmsh.model.addPhysicalGroup(3, [2], 9, "right")
    gmsh.model.addPhysicalGroup(2, [1], 8, "wall")
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    if recombine:
        for _, curve in gmsh.model.getEntities(1):
            gmsh.model.mesh.setTransfiniteCurve(curve, 5)
        for dimension in (2, 3):
            for _, entity in gmsh.model.getEntities(dimension):
                if dimension == 2:
                    gmsh.model.mesh.setTransfiniteSurface(entity)
                    gmsh.model.mesh.setRecombine(2, entity)
                else:
                    gmsh.model.mesh.setTransfiniteVolume(entity)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)


def nodes():
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    return dict(zip(tags.tolist(), map(tuple, coordinates.reshape(-1, 3).tolist())))


def elements():
    """For each entity and type the tags of its elements, and the coordinates of their nodes."""
    place, found = nodes(), {}
    for entity in gmsh.model.getEntities():
        for kind, tags, ends in zip(*gmsh.model.mesh.getElements(*entity)):
            corners = [[place[end] for end in row] for row in ends.reshape(len(tags), -1).tolist()]
            found[*entity, kind] = tags, np.array(corners)
    return found


@pytest.mark.parametrize("order, recombine", [(1, False), (2, False), (1, True), (2, True)])
def test_model_is_the_same_in_its_new_order(model, order, recombine):
    make_box(order, recombine=recombine)
    before, old_nodes = elements(), nodes()
    made = meshorder.gmsh.reorder(vertices="rcm", elements="lexmax")
    after, new_nodes = elements(), nodes()
    tags = sorted(old_nodes)
    assert sorted(new_nodes) == tags
    assert [new_nodes[tag] for tag in tags] == [old_nodes[tags[old]] for old in made.vertices.new_to_old]
    assert before.keys() == after.keys()
    begin = 0
    for block, (old_tags, corners) in before.items():
        new_tags, moved = after[block]
        places = made.cells.new_to_old[begin : begin + len(old_tags)] - begin
        begin += len(old_tags)
        np.testing.assert_array_equal(new_tags, np.sort(old_tags))
        np.testing.assert_array_equal(moved, corners[places])
        if block[0] == 3:
            assert (model.mesh.getElementQualities(new_tags) > 0).all()
        last = [new_nodes[end] for end in model.mesh.getElement(int(new_tags[-1]))[1]]
        np.testing.assert_array_equal(last, moved[-1])
    assert begin == len(made.cells.permutation)


@pytest.mark.parametrize("version", [2.2, 4.1])
def test_file_is_what_others_read(model, tmp_path, version):
    make_box()
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.write(str(tmp_path / "before.msh"))
    made = meshorder.gmsh.reorder(vertices="rcm")
    gmsh.write(str(tmp_path / "after.msh"))
    before, after = (meshio.read(tmp_path / f"{name}.msh") for name in ("before", "after"))

    def volumes(mesh):
        corners = mesh.points[mesh.get_cells_type("tetra")]
        edges = corners[:, 1:] - corners[:, :1]
        return np.sort(np.abs(np.linalg.det(edges)))

    np.testing.assert_allclose(volumes(after), volumes(before))
    for name in ("left", "right", "wall"):
        group = before.field_data[name][0]
        sizes = [sum((values == group).sum() for values in mesh.cell_data["gmsh:physical"]) for mesh in (before, after)]
        assert sizes[0] == sizes[1] > 0
    read = meshorder.read(tmp_path / "after.msh")
    # files of both versions list nodes by entity; 4.1 keeps the nodes' tags, 2.2 renumbers the nodes
    assert (len(read.vertex_ids) == 0) == (version == 2.2)
    if version == 4.1:
        expected = meshorder.read(tmp_path / "before.msh")
        in_order = expected.points[np.argsort(expected.vertex_ids)] if len(expected.vertex_ids) else expected.points
        np.testing.assert_array_equal(
            read.points[np.argsort(read.vertex_ids)], in_order[made.vertices.new_to_old]
        )


def test_groups_stay_together(model):
    make_box()
    made = meshorder.gmsh.reorder(group_by="physical")
    groups: dict[int, set[tuple[int, ...]]] = {7: set(), 9: set()}
    for (dimension, entity, _), (_, corners) in elements().items():
        if dimension == 3:
            groups[model.getPhysicalGroupsForEntity(3, entity)[0]] |= set(map(tuple, corners.reshape(-1, 3).tolist()))
    place = {at: tag for tag, at in nodes().items()}
    left, right_only = (sorted(place[at] for at in part) for part in (groups[7], groups[9] - groups[7]))
    assert max(left) < min(right_only) and len(left) + len(right_only) == len(made.vertices.permutation)


def test_periodic_nodes_stay_pairs(model):
    model.occ.addBox(0, 0, 0, 1, 1, 1)
    model.occ.synchronize()
    model.mesh.setPeriodic(2, [2], [1], [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    model.mesh.generate(3)
    meshorder.gmsh.reorder(vertices="scrambled")
    _, slaves, masters, _ = model.mesh.getPeriodicNodes(2, 2)
    place = nodes()
    np.testing.assert_allclose([place[s] for s in slaves], np.array([place[m] for m in masters]) + [1, 0, 0], atol=1e-9)
    assert len(slaves) > 4


def test_advice_and_order_change_nothing(model):
    make_box()
    before = nodes()
    assert str(meshorder.gmsh.advise()) and len(meshorder.gmsh.compare(["rcm"])) == 2
    assert len(meshorder.order(model).permutation) == len(before) == len(meshorder.make_mesh(model).points)
    with pytest.raises(InvalidArgument, match="inplace"):
        meshorder.reorder(model)
    assert nodes() == before
    assert meshorder.reorder(model, inplace=True)[0] is model


def test_refusals():
    with pytest.raises(InvalidArgument, match="initialize"):
        meshorder.gmsh.reorder()
    gmsh.initialize(interruptible=False)
    try:
        with pytest.raises(InvalidArgument, match="no mesh"):
            meshorder.gmsh.reorder()
        with pytest.raises(InvalidArgument, match="gmsh.model"):
            meshorder.reorder(gmsh.option)
    finally:
        gmsh.finalize()


def groups():
    """For each named physical group the nodes of its elements by their coordinates, sorted."""
    place, found = nodes(), {}
    for dimension, tag in gmsh.model.getPhysicalGroups():
        cells = []
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
            for _, tags, ends in zip(*gmsh.model.mesh.getElements(dimension, entity)):
                corners = np.round([place[end] for end in ends.tolist()], 12) + 0.0
                cells += corners.reshape(len(tags), -1).tolist()
        found[dimension, gmsh.model.getPhysicalName(dimension, tag)] = sorted(cells)
    return {group: cells for group, cells in found.items() if group[1]}


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("source", [".msh", ".unv"])
def test_groups_of_universal_files_are_found_again(model, tmp_path, source, order):
    make_box(order)
    before = groups()
    assert {name for _, name in before} == {"left", "right", "wall"}
    gmsh.write(str(tmp_path / f"a{source}"))
    mesh, _ = meshorder.reorder(meshorder.read(tmp_path / f"a{source}"), vertices="rcm")
    meshorder.write(mesh, tmp_path / "b.unv")
    gmsh.clear()
    gmsh.open(str(tmp_path / "b.unv"))
    assert groups() == before


def test_model_of_nodes_alone(model):
    model.addDiscreteEntity(0, 1)
    places = np.random.default_rng(9).random(30)
    model.mesh.addNodes(0, 1, range(1, 11), places)
    order = meshorder.gmsh.reorder(vertices="hilbert")
    tags, coordinates, _ = model.mesh.getNodes()
    by_tag = coordinates.reshape(-1, 3)[np.argsort(tags)]
    np.testing.assert_array_equal(by_tag, places.reshape(-1, 3)[order.vertices.new_to_old])
