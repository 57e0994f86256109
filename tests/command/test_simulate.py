# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`meshorder simulate`: scenarios, frames, checkpoints, and results that must not depend on the order."""
import json
import re
import signal
import struct
import subprocess
import time
import xml.etree.ElementTree

import meshio
import numpy
import pytest

import conftest
import meshes
import schemas

SCENARIOS = conftest.ROOT / "scenarios"
SMALL = {
    "name": "small",
    "mesh": "grid-4",
    "scale": {"longest_side": 2},
    "material": {"model": "corotational", "young": 1e5, "poisson": 0.4, "density": 1000},
    "integrator": {"time_step": 0.02, "rayleigh": {"alpha": 0.5}, "gravity": [0, -9.81, 0]},
    "solver": {"tolerance": 1e-10},
    "fixed": [{"on": {"box": [[0, 0, 0], [0, 1, 1]]}}],
    "forces": [{"on": {"nearest": [1, 1, 1]}, "newtons": [0, 0, 40], "steps": [2, 3]}],
    "steps": 6,
}


# a soft cube that falls on a floor by one corner
FALLING = {
    "name": "small",
    "mesh": "grid-4",
    "scale": {"height": 0.1},
    "place": {"bottom": [0, 0.05, 0]},
    "material": {"model": "neo-hookean", "young": 5e4, "poisson": 0.3, "density": 1000},
    "integrator": {"method": "admm", "time_step": 0.005, "gravity": [0, -9.81, 0], "iterations": 12, "duals": "reset"},
    "contact": {"obstacles": [{"half_space": {"point": [0, 0, 0], "normal": [0.3, 1, 0.1]}}], "with_itself": True, "tolerance": 1e-8},
    "start": [{"on": "all", "velocity": [0, -0.5, 0]}],
    "steps": 12,
}


def write_scenario(folder, base=SMALL, **changes):
    scenario = {**base, **changes}
    (folder / "small.json").write_text(json.dumps({key: value for key, value in scenario.items() if value is not None}))
    return "small.json"


def frames(folder, name="small"):
    """Time and path of every frame that the collection lists."""
    root = xml.etree.ElementTree.parse(folder / f"{name}.pvd").getroot()
    assert root.get("type") == "Collection"
    return [(float(entry.get("timestep")), folder / entry.get("file")) for entry in root.iter("DataSet")]


def contents(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


# ---- messages and results

def test_lists_scenarios_by_name(command):
    listed = {s["name"]: s for s in command.json("simulate", "--list")["scenarios"]}
    assert set(listed) == {path.stem for path in SCENARIOS.glob("*.json")} - {"scenario.schema"}
    assert all(s["title"] and s["mesh"] in ("dragon", "armadillo", "bunny", None) for s in listed.values())
    assert "constrained" in command.ok("simulate", "--list").stdout


def test_json_keys(command, tmp_path):
    result = command.json("simulate", write_scenario(tmp_path), "--threads", "1")
    assert result["scenario"] == "small" and result["steps"] == 6 and result["threads"] == 1
    assert result["vertices"] == 125 and result["elements"] == result["tetrahedra"] == 384
    assert result["mesh"].endswith("grid-4.node")
    for half in ("vertices", "elements"):
        assert set(result["order"][half]) == {"method", "chosen_by", "because", "seconds"}
        assert result["order"][half]["method"] == "original"
    seconds = result["seconds"]
    assert set(seconds) == {"total", "assembly", "solve", "other"}
    assert seconds["total"] == pytest.approx(seconds["assembly"] + seconds["solve"] + seconds["other"])
    assert seconds["total"] == pytest.approx(sum(result["step_seconds"])) and len(result["step_seconds"]) == 6
    assert set(result["setup_seconds"]) == {"read", "order", "body"}
    assert len(result["cg_iterations"]) == len(result["newton_iterations"]) == 6 and min(result["cg_iterations"]) > 0
    assert len(result["energy"]) == len(result["momentum"]) == len(result["angular_momentum"]) == 7
    for energy in result["energy"]:
        assert energy["total"] == pytest.approx(energy["kinetic"] + energy["elastic"] + energy["potential"])
    assert result["solver"] == {"preconditioner": "jacobi", "tolerance": 1e-10, "max_iterations": 10000, "precision": "double"}
    assert result["material"]["model"] == "corotational" and result["integrator"]["alpha"] == 0.5
    assert result["warnings"] == [] and result["bytes"] > 0
    assert result["resumed_from"] is None and result["frames"] is None and result["checkpoint"] is None


def test_json_keys_of_admm(command, tmp_path):
    result = command.json("simulate", write_scenario(tmp_path, FALLING), "--threads", "1")
    assert set(result["seconds"]) == {"total", "local", "global", "collision", "other"}
    assert sum(result["seconds"].values()) == pytest.approx(2 * result["seconds"]["total"])
    assert result["admm_iterations"] == [12] * 12
    for key in ("contacts", "penetration", "contact_iterations", "vertices_in_itself", "shape_distance", "step_seconds"):
        assert len(result[key]) == 12
    assert result["contacts"][0] == 0 and max(result["contacts"]) > 0
    assert max(result["penetration"]) <= 1e-3 * 0.1 and max(result["vertices_in_itself"]) == 0
    assert result["integrator"] == {"method": "admm", "time_step": 0.005, "gravity": [0, -9.81, 0], "iterations": 12,
                                    "tolerance": 0, "duals": "reset"}
    assert result["solver"]["precision"] == "double" and result["solver"]["contact"]["method"] == "uzawa"
    assert result["material"]["model"] == "neo-hookean" and result["material"]["young"] == 5e4
    assert not {"cg_iterations", "newton_iterations"} & set(result)
    energies = [energy["total"] for energy in result["energy"]]
    assert all(later <= earlier + 1e-9 for earlier, later in zip(energies, energies[1:]))


def test_scenarios_start_where_and_as_fast_as_they_say(command, tmp_path):
    start = [{"on": "all", "velocity": [1, 0, 0]}, {"on": {"box": [[0.5, 0, 0], [1, 1, 1]]}, "velocity": [-1, 0, 0], "at": [1, 0, 0.5]}]
    scenario = write_scenario(tmp_path, FALLING, start=start, place={"bottom": [1, 2, 3]}, scale={"height": 2}, steps=1)
    command.ok("simulate", scenario, "--vtk", "out")
    first = meshio.read(frames(tmp_path / "out")[0][1])
    rest = first.points - first.point_data["displacement"]
    assert rest.min(axis=0) == pytest.approx([0, 2, 2]) and rest.max(axis=0) == pytest.approx([2, 4, 4])
    there = rest[:, 0] > 0.99
    assert first.points[there] == pytest.approx(numpy.tile([2, 2, 3], (there.sum(), 1)), abs=1e-6)
    assert first.points[~there] == pytest.approx(rest[~there], abs=1e-6)
    assert (first.point_data["velocity"][:, 0] == numpy.where(there, -1, 1)).all()


def test_obstacles_may_be_files(command, tmp_path):
    """A closed box as the floor, on which the cube comes to rest."""
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 0) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    lines = ["OFF", "8 6 0", *(" ".join(map(str, p)) for p in corners), *("4 " + " ".join(map(str, f)) for f in faces)]
    (tmp_path / "floor.off").write_text("\n".join(lines) + "\n")
    scenario = write_scenario(tmp_path, FALLING, contact={"obstacles": [{"surface": "floor.off", "friction": 0.3}]}, steps=40)
    result = command.json("simulate", scenario)
    assert result["contacts"][-1] >= 20 and max(result["penetration"]) <= 1e-4
    lines[-1] = "4 1 3 7 5"
    (tmp_path / "floor.off").write_text("\n".join(lines) + "\n")
    assert "floor.off" in command.fails("simulate", scenario)
    write_scenario(tmp_path, FALLING, contact={"obstacles": [{"surface": "absent.off"}]})
    assert "absent.off" in command.fails("simulate", scenario)


def test_text_of_admm_says_what_and_how_long(command, tmp_path):
    text = command.ok("simulate", write_scenario(tmp_path, FALLING)).stdout
    for words in ("0.1 m high", "12 iterations, duals reset", "half-space, with itself, by uzawa", "local", "collision",
                  "deepest in an obstacle", "vertices inside the body", "shape"):
        assert words in text, words
    text = command.ok("simulate", "unsquash", "--mesh", "grid-3", "--steps", "60").stdout
    assert re.search(r"within 1 % of the height from step \d+ on", text)


def test_text_says_what_and_how_long(command, tmp_path):
    text = command.ok("simulate", write_scenario(tmp_path, title="A cube hangs")).stdout
    for words in ("small: A cube hangs", "125 vertices, 384 tetrahedra", "a step", "iterations", "kinetic", "momentum"):
        assert words in text


def test_momentum_is_the_forces(command, tmp_path):
    """A free body of known mass under gravity and a force: each step adds their impulse and damps momentum by alpha."""
    scenario = write_scenario(tmp_path, fixed=None)
    result = command.json("simulate", scenario)
    mass, h, alpha = 1000 * 2.0 ** 3, 0.02, 0.5  # the unit cube, scaled to 2 m
    momentum = numpy.zeros(3)
    for step in range(1, 7):
        impulse = h * (mass * numpy.array([0, -9.81, 0]) + (numpy.array([0, 0, 40]) if 2 <= step <= 3 else 0))
        momentum = (momentum + impulse) / (1 + h * alpha)
        assert result["momentum"][step] == pytest.approx(momentum, rel=1e-6, abs=1e-6)


def test_regions_have_their_own_material(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    points, cells = meshes.read_tetgen(tmp_path / "mesh.node")
    volumes = [abs(numpy.linalg.det(points[cell[1:]] - points[cell[0]])) / 6 for cell in cells]
    free = {"mesh": "mesh.node", "scale": None, "fixed": None, "forces": None, "steps": 1}
    regions = {"by": "label", "groups": [{"group": 20, "density": 3000}]}
    scenario = write_scenario(tmp_path, **free, material={**SMALL["material"], "regions": regions})
    result = command.json("simulate", scenario)
    mass = 1000 * volumes[0] + 3000 * volumes[1]
    assert result["momentum"][1] == pytest.approx([0, -9.81 * 0.02 * mass / (1 + 0.02 * 0.5), 0], rel=1e-9, abs=1e-9)
    regions["groups"][0]["group"] = 30
    write_scenario(tmp_path, **free, material={**SMALL["material"], "regions": regions})
    line = command.fails("simulate", scenario)
    assert "small.json: material.regions" in line and "10, 20" in line


def test_override_by_options(command, tmp_path):
    scenario = write_scenario(tmp_path)
    result = command.json("simulate", scenario, "--steps", "2", "--preconditioner", "block-jacobi", "--precision", "single",
                          "--mesh", "ball-3", "--order", "rcm")
    assert result["steps"] == 2 and result["vertices"] == 64
    assert result["solver"]["preconditioner"] == "block-jacobi" and result["solver"]["precision"] == "single"
    assert result["order"]["vertices"]["method"] == "rcm" and result["order"]["elements"]["method"] == "lexmax"
    result = command.json("simulate", scenario, "--steps", "1", "--vertices", "auto")
    assert result["order"]["vertices"]["chosen_by"] == "auto" and result["order"]["elements"]["method"] == "original"


def test_built_in_scenarios_run_on_any_mesh_from_any_folder(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    for name in ("falling", "constrained", "stretch", "unsquash", "bowl", "bounce"):
        result = command.json("simulate", name, "--mesh", "mesh.node", "--steps", "3")
        assert result["scenario"] == name and result["vertices"] == 5 and result["steps"] == 3
        assert "mesh" in result["paper"]


# ---- results that must not depend on the order

def moved_back(path, vertices):
    """Points, displacements and velocities of a frame in the numbering of the mesh's file."""
    frame = meshio.read(path)
    places = frame.point_data["original_vertex"].ravel()
    assert sorted(places) == list(range(vertices))
    result = {}
    for name, values in {"points": frame.points, **frame.point_data}.items():
        result[name] = numpy.empty_like(values)
        result[name][places] = values
    cells = frame.cells_dict["tetra"]
    tetrahedra = numpy.empty_like(cells)
    tetrahedra[frame.cell_data_dict["original_cell"]["tetra"].ravel()] = places[cells]
    return result, tetrahedra


def test_two_orders_give_the_same_motion_in_contact(command, tmp_path, model):
    scenario = write_scenario(tmp_path, FALLING)
    ends = []
    for order in ("original", "scrambled"):
        result = command.json("simulate", scenario, "--order", order, "--vtk", order, "--every", "12")
        assert max(result["contacts"]) >= 1
        ends.append(moved_back(frames(tmp_path / order)[-1][1], 125)[0])
    for name in ("points", "displacement", "velocity"):
        assert ends[0][name] == pytest.approx(ends[1][name], abs=2e-5)
    assert numpy.ptp(ends[0]["velocity"][:, 1]) > 0.01


def test_two_orders_give_the_same_motion(command, tmp_path, model):
    scenario = write_scenario(tmp_path)
    results = {}
    for order in ("original", "scrambled"):
        results[order] = command.json("simulate", scenario, "--order", order, "--vtk", order, "--every", "3")
        assert [time for time, _ in frames(tmp_path / order)] == pytest.approx([0, 0.06, 0.12])
    for a, b in zip(results["original"]["energy"], results["scrambled"]["energy"]):
        assert a["total"] == pytest.approx(b["total"], rel=1e-7, abs=1e-4)
    points, cells = meshes.read_tetgen(model("grid-4"))
    largest = 0
    for (_, path), (_, other) in zip(frames(tmp_path / "original"), frames(tmp_path / "scrambled")):
        (frame, tetrahedra), (scrambled, same_tetrahedra) = moved_back(path, len(points)), moved_back(other, len(points))
        assert (tetrahedra == cells).all() and (same_tetrahedra == cells).all()
        for name in ("points", "displacement", "velocity"):
            assert frame[name] == pytest.approx(scrambled[name], abs=1e-5)
        assert frame["points"] - frame["displacement"] == pytest.approx(2 * points, abs=1e-6)
        largest = numpy.abs(frame["displacement"]).max()
    assert largest > 0.01
    assert frame["displacement"][points[:, 0] == 0] == pytest.approx(0, abs=0)  # fixed by the box
    first = meshio.read(frames(tmp_path / "scrambled")[0][1])
    assert (first.point_data["original_vertex"].ravel() != numpy.arange(len(points))).any()


@pytest.mark.parametrize("base", [SMALL, FALLING], ids=["implicit", "admm"])
def test_threads_change_no_bit(command, tmp_path, base):
    scenario = write_scenario(tmp_path, base, mesh="grid-8")
    one, two = (command.json("simulate", scenario, "--threads", n, "--vtk", f"frames{n}") for n in ("1", "2"))
    assert one["energy"] == two["energy"]
    assert contents(tmp_path / "frames1") == contents(tmp_path / "frames2")


# ---- frames

def test_frames_carry_what_is_attached(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    command.ok("simulate", "falling", "--mesh", "mesh.node", "--steps", "2", "--vtk", "out/deep", "--order", "scrambled")
    assert [time for time, _ in frames(tmp_path / "out" / "deep", "falling")] == pytest.approx([0, 0.01, 0.02])
    frame = meshio.read(frames(tmp_path / "out" / "deep", "falling")[-1][1])
    vertices, cells = frame.point_data["original_vertex"].ravel(), frame.cell_data["original_cell"][0].ravel()
    assert (frame.point_data["label"].ravel() == numpy.array([7, 8, 7, 8, 9])[vertices]).all()
    assert (frame.cell_data["label"][0].ravel() == numpy.array([10, 20])[cells]).all()
    assert frame.point_data["velocity"].shape == frame.point_data["displacement"].shape == (5, 3)
    text = frames(tmp_path / "out" / "deep", "falling")[-1][1].read_bytes()
    assert b"vtkZLibDataCompressor" in text and b'AppendedData encoding="base64"' in text


def test_frames_that_cannot_be_written_are_refused_before_the_work(command, tmp_path):
    (tmp_path / "taken").write_text("a file")
    assert "taken" in command.fails("simulate", write_scenario(tmp_path), "--vtk", "taken")
    assert "checkpoint" in command.fails("simulate", "small.json", "--checkpoint", "no/such/checkpoint")
    command.fails("simulate", "small.json", "--every", "2")


# ---- checkpoints

def test_resumed_run_is_the_same_to_the_last_bit(command, tmp_path):
    scenario = write_scenario(tmp_path)
    whole = command.json("simulate", scenario, "--order", "scrambled", "--vtk", "whole", "--every", "2")
    command.ok("simulate", scenario, "--order", "scrambled", "--vtk", "parts", "--every", "2", "--steps", "3",
               "--checkpoint", "state")
    parts = command.json("simulate", scenario, "--order", "scrambled", "--vtk", "parts", "--every", "2", "--resume", "state",
                         "--threads", "1")
    assert parts["resumed_from"] == 3 and parts["steps"] == 6
    for key in ("energy", "momentum", "angular_momentum", "cg_iterations", "newton_iterations"):
        assert parts[key] == whole[key]
    assert contents(tmp_path / "whole") == contents(tmp_path / "parts")
    again = command.json("simulate", scenario, "--order", "scrambled", "--resume", "state", "--steps", "3",
                         "--checkpoint", "same")
    assert again["energy"] == whole["energy"][:4] and again["checkpoint"] == "same"
    assert (tmp_path / "same").read_bytes() == (tmp_path / "state").read_bytes()


@pytest.mark.parametrize("change", [{}, {"integrator": {**FALLING["integrator"], "duals": "kept"}},
                                    {"solver": {"precision": "single"}}], ids=["reset", "kept", "single"])
def test_resumed_run_of_admm_is_the_same_to_the_last_bit(command, tmp_path, change):
    scenario = write_scenario(tmp_path, FALLING, **change)
    whole = command.json("simulate", scenario)
    command.ok("simulate", scenario, "--steps", "5", "--checkpoint", "state")
    parts = command.json("simulate", scenario, "--resume", "state", "--threads", "1")
    for key in ("energy", "momentum", "contacts", "penetration", "shape_distance", "contact_iterations"):
        assert parts[key] == whole[key]
    write_scenario(tmp_path, FALLING, **{**change, "contact": {"with_itself": True}})
    assert "another scenario" in command.fails("simulate", scenario, "--resume", "state")


@pytest.mark.parametrize("solver", [("block-jacobi", "double"), ("jacobi", "single"),
                                    ("incomplete-cholesky", "double"), ("multigrid", "single")])
def test_solvers_keep_nothing_that_a_checkpoint_lacks(command, tmp_path, solver):
    run = ("simulate", write_scenario(tmp_path), "--preconditioner", solver[0], "--precision", solver[1])
    whole = command.json(*run)
    command.ok(*run, "--steps", "3", "--checkpoint", "state")
    parts = command.json(*run, "--resume", "state")
    assert parts["energy"] == whole["energy"] and parts["cg_iterations"] == whole["cg_iterations"]


def test_resumed_run_is_the_same_after_a_step_that_was_taken_otherwise(command, tmp_path):
    """A crushed body has a step with an indefinite matrix. The checkpoint still holds all that the next steps need."""
    crush = {"on": {"box": [[1, 0, 0], [1, 1, 1]]}, "newtons": [-60000, 0, 0], "steps": [1, 12]}
    scenario = write_scenario(tmp_path, material={**SMALL["material"], "model": "stvk"}, forces=[crush], steps=20)
    whole = command.json("simulate", scenario)
    warning, = (w for w in whole["warnings"] if "not positive definite" in w["sentence"])
    step = warning["first_step"]
    assert 1 < step < 20
    command.ok("simulate", scenario, "--steps", step, "--checkpoint", "state")
    parts = command.json("simulate", scenario, "--resume", "state")
    for key in ("energy", "momentum", "cg_iterations", "warnings"):
        assert parts[key] == whole[key]


def test_other_checkpoints_are_refused(command, tmp_path):
    scenario = write_scenario(tmp_path)
    command.ok("simulate", scenario, "--steps", "3", "--checkpoint", "state")
    resume = ("simulate", scenario, "--resume", "state")
    assert "another mesh" in command.fails(*resume, "--mesh", "grid-3")
    assert "another order" in command.fails(*resume, "--order", "rcm")
    assert "another scenario" in command.fails(*resume, "--preconditioner", "block-jacobi")
    assert "already at step 3" in command.fails(*resume, "--steps", "2")
    write_scenario(tmp_path, steps=9)
    command.ok(*resume)
    write_scenario(tmp_path, forces=[])
    assert "another scenario" in command.fails(*resume)
    write_scenario(tmp_path, scale={"longest_side": 3})
    assert "another mesh or size" in command.fails(*resume)
    assert "nothing.state" in command.fails("simulate", scenario, "--resume", "nothing.state")


def test_damaged_checkpoints_are_refused(command, tmp_path):
    scenario = write_scenario(tmp_path)
    command.ok("simulate", scenario, "--steps", "2", "--checkpoint", "state")
    good = (tmp_path / "state").read_bytes()

    def refused(content):
        (tmp_path / "state").write_bytes(content)
        line = command.fails("simulate", scenario, "--resume", "state")
        assert line.startswith("meshorder: state: byte ") or content == b"", line
        return line

    for size in (1, 15, 16, 20, 24, 31, 32, 100, len(good) // 2, len(good) - 1):
        refused(good[:size])
    assert f"byte {len(good) // 2}: ends here" in refused(good[:len(good) // 2])
    assert f"byte {len(good)}: continues" in refused(good + b"x")
    for place in (40, 60, 80, len(good) // 2, len(good) - 1):
        assert "checksum" in refused(good[:place] + bytes([good[place] ^ 1]) + good[place + 1:])
    assert "is not a checkpoint" in refused(b"solid cube" * 10)
    assert "byte order" in refused(good[:16] + good[16:20][::-1] + good[20:])
    assert "version 77" in refused(good[:20] + struct.pack("=I", 77) + good[24:])
    refused(b"")


def test_interrupted_run_leaves_a_checkpoint(command, tmp_path):
    scenario = write_scenario(tmp_path, mesh="grid-8", steps=200000)
    running = subprocess.Popen([conftest.MESHORDER, "simulate", scenario, "--checkpoint", "state", "--checkpoint-every", "1000000",
                                "--vtk", "frames", "--every", "5"],
                               cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    begun = time.monotonic()
    while not (tmp_path / "frames" / "small-000005.vtu").exists() and time.monotonic() < begun + 60:
        time.sleep(0.02)
    running.send_signal(signal.SIGINT)
    _, log = running.communicate(timeout=60)
    assert running.returncode == 130
    stopped = re.search(r"stopped after step (\d+) of 200000; --resume state continues from there", log)
    step = int(stopped.group(1))
    assert len(frames(tmp_path / "frames")) == step // 5 + 1
    result = command.json("simulate", scenario, "--resume", "state", "--steps", step + 1)
    assert result["resumed_from"] == step and result["steps"] == step + 1


# ---- errors

def test_errors_name_the_file_and_the_place(command, tmp_path):
    assert "falling, constrained, stretch, unsquash, bowl, bounce" in command.fails("simulate", "fallen")
    assert "factors its matrix" in command.fails("simulate", "bounce", "--preconditioner", "jacobi")
    assert "--list" in command.fails("simulate")
    assert "known: jacobi" in command.fails("simulate", "falling", "--preconditioner", "ilu")
    assert "double, single" in command.fails("simulate", "falling", "--precision", "half")
    command.fails("simulate", "falling", "--order", "rcm", "--vertices", "rcm")
    command.fails("simulate", "falling", "--steps", "0")
    (tmp_path / "broken.json").write_text('{\n "name": "a",\n}')
    assert "broken.json:3: not JSON" in command.fails("simulate", "broken.json")
    write_scenario(tmp_path, material={**SMALL["material"], "poisson": 0.5})
    assert "small.json: material.poisson: is 0.5" in command.fails("simulate", "small.json")
    write_scenario(tmp_path, fixed=[{"on": {"set": "left"}}])
    assert "small.json: fixed[0].on: the mesh has no set 'left'" in command.fails("simulate", "small.json")
    write_scenario(tmp_path, mesh="absent.node")
    assert "absent.node" in command.fails("simulate", "small.json")
    write_scenario(tmp_path, mesh="cow")
    assert "unknown model 'cow'" in command.fails("simulate", "small.json")
    write_scenario(tmp_path, order={"vertices": "best"})
    assert "fiedler" in command.fails("simulate", "small.json")


def test_surface_is_refused_with_what_is_needed(command, tmp_path):
    (tmp_path / "surface.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    line = command.fails("simulate", "falling", "--mesh", "surface.off")
    assert "surface.off" in line and "no volume cells" in line and "tetrahedra" in line


def test_mesh_of_a_scenario_file_is_found_from_its_folder(command, tmp_path):
    (tmp_path / "deep").mkdir()
    meshes.write_tetgen(tmp_path / "deep")
    write_scenario(tmp_path / "deep", mesh="mesh.node", fixed=[{"on": {"label": 8}}], forces=[])
    result = command.json("simulate", "deep/small.json")
    assert result["vertices"] == 5


# ---- the schema

def test_schema_takes_what_the_command_takes(command, tmp_path):
    schema = schemas.read_schema(SCENARIOS / "scenario.schema.json")
    for path in SCENARIOS.glob("*.json"):
        if path.name != "scenario.schema.json":
            assert schemas.faults(json.loads(path.read_text()), schema) == []
    assert schemas.faults(SMALL, schema) == [] and schemas.faults(FALLING, schema) == []
    wrong = [{"steps": 0}, {"steps": 1.5}, {"steps": None}, {"speed": 1}, {"name": ""}, {"name": "a/b"}, {"scale": {}},
             {"scale": {"longest_side": 0}}, {"order": {"cells": "rcm"}}, {"material": {**SMALL["material"], "poisson": 0.5}},
             {"material": {**SMALL["material"], "model": "rubber"}}, {"material": {"model": "stvk"}},
             {"integrator": {"time_step": 0}}, {"integrator": {"time_step": 1, "gravity": [1, 2]}},
             {"integrator": {"time_step": 1, "newton": {"iterations": 0}}}, {"solver": {"tolerance": 1}},
             {"solver": {"precision": "half"}}, {"fixed": [{}]}, {"fixed": [{"on": "some"}]}, {"fixed": [{"on": {}}]},
             {"fixed": [{"on": {"box": [[0, 0, 0]]}}]}, {"fixed": [{"on": "all", "steps": [0, 1]}]},
             {"forces": [{"on": "all"}]}, {"prescribed": [{"on": "all", "velocity": 1}]}, {"notes": [""]}]
    for change in wrong:
        scenario = {key: value for key, value in {**SMALL, **change}.items() if value is not None}
        assert schemas.faults(scenario, schema) != [], change
        write_scenario(tmp_path, **change)
        command.fails("simulate", "small.json")
    sphere = {"center": [0, 0, 0], "radius": 1}
    for change in [{"scale": {"height": 1, "longest_side": 1}}, {"place": {}}, {"start": [{"on": "all"}]}, {"start": [{"at": [0, 0, 0]}]},
                   {"contact": {"obstacles": [{}]}}, {"contact": {"obstacles": [{"sphere": {"radius": 1}}]}},
                   {"contact": {"obstacles": [{"sphere": {**sphere, "radius": 0}}]}}, {"contact": {"with_itself": 1}},
                   {"contact": {"obstacles": [{"sphere": sphere, "friction": -1}]}}, {"contact": {"over_relaxation": 2}},
                   {"contact": {"solver": "lemke"}}, {"integrator": {"method": "admm", "time_step": 1, "iterations": 0}},
                   {"integrator": {"method": "admm", "time_step": 1, "duals": "lost"}}, {"material": {"model": "springs", "density": 1}}]:
        scenario = {**FALLING, **change}
        assert schemas.faults(scenario, schema) != [], change
        write_scenario(tmp_path, FALLING, **change)
        command.fails("simulate", "small.json")
