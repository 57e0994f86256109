# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`--plugin FILE`: users' methods from a shared library."""
import os
import pathlib
import shutil

import meshes
import numpy
import pytest


@pytest.fixture
def plugin(tmp_path):
    """The plug-in of examples/own_method.cpp, which was built beside the command."""
    built = pathlib.Path(os.environ["MESHORDER"]).resolve().parents[1]
    found = [*built.rglob("libdegree.so")]
    if not found:
        pytest.skip("the example's plug-in was not built")
    shutil.copy(found[0], tmp_path / "libdegree.so")
    return "libdegree.so"


def test_a_plugins_method_is_listed_ordered_by_and_compared(command, plugin, tmp_path):
    meshes.write_tetgen(tmp_path)
    listed = {method["name"]: method["sentence"] for method in command.json("--plugin", plugin, "methods")["vertices"]}
    assert listed["degree"] == "by falling degree"
    assert "by falling degree" not in command.ok("methods").stdout
    command.ok("order", "mesh.node", "-o", "new.node", "--vertices", "degree", "--maps", "m", "--plugin", plugin)
    new_to_old = numpy.load(tmp_path / "m.vertices.new_to_old.npy")
    neighbours = [set() for _ in new_to_old]
    for cell in meshes.read_tetgen(tmp_path / "mesh.node")[1]:
        for v in cell:
            neighbours[v] |= set(cell) - {v}
    degrees = [len(neighbours[v]) for v in new_to_old]
    assert degrees == sorted(degrees, reverse=True)
    methods = command.json("--plugin", plugin, "compare", "mesh.node", "--budget", "0.1")["methods"]
    assert "degree" in [method["vertices"] for method in methods]


def test_what_is_no_plugin_is_refused(command, tmp_path):
    (tmp_path / "text.so").write_text("no library")
    command.fails("--plugin", "text.so", "methods")
    command.fails("--plugin", "missing.so", "methods")
