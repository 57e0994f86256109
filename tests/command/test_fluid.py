# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`meshorder simulate` of water: messages, frames, checkpoints, orders, and a missing program."""
import json
import os
import shutil
import struct
import subprocess
import xml.etree.ElementTree
import zlib

import meshio
import numpy
import pytest

import browser
import conftest
import schemas

POOL = {
    "name": "pool",
    "water": {"basin": [2, 3, 0.5], "column": [1, 1, 0.5], "spacing": 0.125},
    "order": {"vertices": "hilbert", "elements": "lexmax", "every": 2},
    "material": {"model": "fluid", "density": 1000, "viscosity": 1e-3},
    "integrator": {"method": "particle-fem", "time_step": 0.02, "gravity": [0, -9.81, 0]},
    "steps": 6,
}

pytestmark = pytest.mark.skipif(shutil.which("meshorder-delaunay") is None, reason="meshorder-delaunay is not built")


@pytest.fixture
def pool(tmp_path):
    def write(**changes):
        (tmp_path / "pool.json").write_text(json.dumps({**POOL, **changes}))
        return "pool.json"
    return write


def test_says_where_the_time_went(command, pool):
    words = command.ok("simulate", pool()).stdout
    assert "405 particles 0.125 m apart" in words
    assert "particles hilbert, again every 2 steps, tetrahedra lexmax in each step" in words
    assert "triangulation" in words and "3 more times" in words
    result = command.json("simulate", pool())
    assert result["mesh"] is None and result["steps"] == 6 and result["fresh_orders"] == 3
    assert len(result["time_steps"]) == 6 and max(result["time_steps"]) <= 0.02
    parts = result["seconds"]
    assert parts["total"] == pytest.approx(sum(parts.values()) - parts["total"])
    assert result["volume"] == pytest.approx(0.5, rel=0.03)
    totals = [energy["total"] for energy in result["energy"]]
    assert totals == pytest.approx([totals[0]] * 7, rel=0.03)


def test_frames_are_read_by_another_reader(command, pool, tmp_path):
    result = command.json("simulate", pool(), "--vtk", "frames", "--every", "3")
    entries = xml.etree.ElementTree.parse(tmp_path / "frames" / "pool.pvd").getroot().iter("DataSet")
    times = {entry.get("file"): float(entry.get("timestep")) for entry in entries}
    assert list(times) == [f"pool-{step:06}.vtu" for step in (0, 3, 6)]
    assert times["pool-000006.vtu"] == pytest.approx(sum(result["time_steps"]))
    frame = meshio.read(tmp_path / "frames" / "pool-000006.vtu")
    tetrahedra = frame.points[frame.cells_dict["tetra"]]
    volumes = numpy.linalg.det(tetrahedra[:, 1:] - tetrahedra[:, :1]) / 6
    assert volumes.sum() == pytest.approx(0.5, rel=0.03)
    assert sorted(frame.point_data["original_vertex"]) == list(range(405))
    assert frame.point_data["velocity"].shape == (405, 3) and frame.point_data["pressure"].max() > 5000


def test_resumed_runs_are_the_same_to_the_last_bit(command, pool):
    whole = command.json("simulate", pool(), "--threads", "1", "--vtk", "whole")
    command.ok("simulate", pool(), "--threads", "2", "--steps", "3", "--vtk", "parts", "--checkpoint", "state")
    rest = command.json("simulate", pool(), "--threads", "2", "--resume", "state", "--vtk", "parts")
    assert rest["energy"] == whole["energy"] and rest["time_steps"] == whole["time_steps"]
    for path in sorted((command.folder / "whole").iterdir()):
        assert path.read_bytes() == (command.folder / "parts" / path.name).read_bytes(), path.name
    assert "of another scenario" in command.fails(
        "simulate", pool(material={**POOL["material"], "viscosity": 2e-3}), "--resume", "state")
    assert "of another order" in command.fails("simulate", pool(), "--order", "rcm", "--resume", "state")


@pytest.mark.parametrize("place, value", [(0, float("nan")), (405, 64), (810, -1), (810, 405), (810, float("nan")), (811, 0),
                                          (1215, -1), (1216, 256), (1217, 7)])
def test_changed_checkpoints_are_refused(command, pool, place, value):
    command.ok("simulate", pool(), "--steps", "2", "--checkpoint", "state")
    state = bytearray((command.folder / "state").read_bytes())
    memory = 32 + 3 * 8 + 4 + 8 + 8 + 405 * 6 * 8 + 8
    assert struct.unpack_from("<q", state, memory - 8)[0] > 1216
    struct.pack_into("<d", state, memory + 8 * place, value)
    struct.pack_into("<I", state, len(state) - 4, zlib.crc32(state[:-4]))
    (command.folder / "state").write_bytes(state)
    assert "state: " in command.fails("simulate", pool(), "--resume", "state")


@pytest.mark.parametrize("order", ["original", "scrambled", "auto", "fiedler"])
def test_every_order_has_the_same_flow(command, pool, order):
    expected = command.json("simulate", pool(), "--order", "original/original")["energy"][-1]
    result = command.json("simulate", pool(), "--order", order, "--order-every", "0")["energy"][-1]
    assert result["total"] == pytest.approx(expected["total"], rel=1e-6)


def test_study_times_its_phases_and_plays_its_surface(command, pool, tmp_path):
    command.ok("reproduce", "--quick", "--scenario", pool(), "--budget", "0.2", "--steps", "12", "-o", "study")
    results = json.loads((tmp_path / "study" / "results.json").read_text())
    assert schemas.faults(results, schemas.read_schema(conftest.ROOT / "docs" / "results.schema.json")) == []
    scenario = results["scenarios"][0]
    assert (scenario["name"], scenario["method"], scenario["mesh"]) == ("pool", "particle-fem", "pool")
    by_order = {order["ordering"]: order["runs"][0]["seconds"] for order in scenario["orders"]}
    assert len(by_order) == 6
    for name, seconds in by_order.items():
        assert min(seconds[part] for part in ("triangulation", "order", "assembly", "solve", "motion")) > 0, name
    assert by_order["fiedler"]["order"] > by_order["scrambled"]["order"]  # each step computes the order anew
    assert all(order["motion"]["largest"] < 1e-4 for order in scenario["orders"])
    assert "Mesh, s" in (tmp_path / "study" / "tables.csv").read_text()
    driver = browser.open_chromium(tmp_path / "profile")
    try:
        page = browser.Browser(driver)
        page.open(tmp_path / "study" / "report.html")
        page.tab("motion")
        page.wait("views.motion.motion instanceof FluidScene")
        counts = page.run("return views.motion.motion.geometries.map((one) => one.index.count)")
        assert len(counts) == 13 and min(counts) > 100
        page.run("views.motion.go(12)")
        page.settle()
        assert page.run("return views.motion.motion.mesh.geometry === views.motion.motion.geometries[12]")
        assert page.complaints() == []
    finally:
        driver.quit()
    assert "makes its own mesh" in command.fails("reproduce", "--scenario", pool(), "--mesh", "grid-4", "-o", "other")


def test_refuses_what_means_nothing_to_water(command, pool):
    for option, value in (("--mesh", "grid-4"), ("--preconditioner", "multigrid"), ("--precision", "single")):
        assert option in command.fails("simulate", pool(), option, value)
    assert "--order-every is for fluids" in command.fails("simulate", "falling", "--order-every", "3")
    assert "unknown" in command.fails("simulate", pool(), "--vertices", "nonsense")
    assert "unknown" in command.fails("simulate", pool(), "--elements", "nonsense")


def test_schema_describes_water():
    schema = schemas.read_schema(conftest.ROOT / "scenarios" / "scenario.schema.json")
    assert schemas.faults(POOL, schema) == []
    for change in ({"water": {}}, {"water": {**POOL["water"], "spacing": 0}}, {"water": {**POOL["water"], "depth": 1}},
                   {"integrator": {**POOL["integrator"], "courant": 2}}, {"order": {"every": -1}},
                   {"mesh": "dragon"}, {"scale": {"height": 1}}):
        assert schemas.faults({**POOL, **change}, schema) != [], change


def test_says_which_program_is_missing_or_foreign(tmp_path, pool):
    alone = tmp_path / "bin" / "meshorder"
    alone.parent.mkdir()
    shutil.copy(conftest.MESHORDER, alone)
    shutil.copy(f"{conftest.MESHORDER}-lab", alone.parent)

    def error(**environment):
        done = subprocess.run([alone, "simulate", tmp_path / pool()], capture_output=True, text=True, check=False,
                              stdin=subprocess.DEVNULL, timeout=60, env={**os.environ, **environment})
        assert done.returncode == 2 and done.stdout == "", done.stderr
        return done.stderr

    assert "meshorder-delaunay: is neither beside this program nor on PATH" in error(PATH="/nowhere")
    other = alone.parent / "meshorder-delaunay"
    for script, expected in (("exit 3", "ended with status 3"),
                             ("head -c 5000000 /dev/zero | tr '\\0' '\\7'", "its answer is not a triangulation")):
        other.write_text(f"#!/bin/sh\n{script}\n")
        other.chmod(0o755)
        assert expected in error()
