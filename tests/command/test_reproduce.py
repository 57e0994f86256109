# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The paper's study, in small: the files in its folder, consistency of the results, stopping and resuming."""
import csv
import json
import signal
import subprocess
import time

import numpy
import pytest

import conftest

ORDERINGS = ["original", "fiedler", "vf-fiedler", "scrambled", "vf-scrambled", "meshorder"]
SMALL = ["--scenario", "constrained", "--scenario", "bounce", "--mesh", "ball-3", "--budget", "0.1"]


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    command = conftest.Command(tmp_path_factory.mktemp("study"))
    command.ok("reproduce", "-o", "study", *SMALL, "--steps", 48, "--runs", 2, "--orders", "hilbert/lexmax")
    return command.folder / "study"


def results_of(study):
    return json.loads((study / "results.json").read_text())


def by_name(records, name, key="ordering"):
    return next(record for record in records if record[key] == name)


def test_everything_is_in_the_folder(study):
    assert {path.name for path in study.iterdir()} == {"results.json", "tables.md", "tables.csv", "figures", "data",
                                                       "report.html"}
    assert len(list((study / "figures").glob("*.svg"))) >= 5
    data = {path.name for path in (study / "data").iterdir()}
    assert {"ball-3.vtu", "constrained-motion.npy", "bounce-motion.npy", "bounce-obstacles.vtu"} <= data
    assert not [name for name in data if name.startswith(".")]  # nothing unfinished
    assert "constrained-obstacles.vtu" not in data


def test_results_are_of_what_was_asked_for(study):
    results = results_of(study)
    assert [ordering["name"] for ordering in results["orderings"]] == [*ORDERINGS, "hilbert-lexmax"]
    assert [scenario["name"] for scenario in results["scenarios"]] == ["constrained", "bounce"]
    for scenario in results["scenarios"]:
        assert scenario["steps"] == 48 and scenario["interleaved"]
        for order in scenario["orders"]:
            assert [len(run["step_seconds"]) for run in order["runs"]] == [48, 48]
    assert results["machine"]["processor"] and results["machine"]["read_bandwidth"] > 0.1


def test_speedups_are_those_of_the_steps(study):
    results = results_of(study)
    costs = {order["ordering"]: order["seconds"] for order in results["meshes"][0]["orders"]}
    for scenario in results["scenarios"]:
        steps = {order["ordering"]: numpy.array([run["step_seconds"] for run in order["runs"]])
                 for order in scenario["orders"]}
        reference = steps["scrambled"]
        for order in scenario["orders"]:
            own = steps[order["ordering"]]
            sums = own.sum(axis=1)
            assert order["time"]["mean"] == pytest.approx(sums.mean())
            assert order["time"]["deviation"] == pytest.approx(sums.std(ddof=1))
            assert order["time"]["undisturbed"] == pytest.approx(own.min(axis=0).sum())
            saved = reference.sum(axis=1).mean() - sums.mean()
            speedup = order["speedup"]
            assert speedup["saved_seconds"] == pytest.approx(saved)
            assert speedup["percent"] == pytest.approx(100 * saved / reference.sum(axis=1).mean())
            assert speedup["low"] <= speedup["percent"] <= speedup["high"]
            if order["ordering"] == "scrambled":
                continue
            paid = numpy.cumsum(reference.mean(axis=0) - own.mean(axis=0)) >= costs[order["ordering"]]
            assert speedup["break_even_step"] == (int(paid.argmax()) + 1 if paid.any() else None)


def test_tables_say_what_the_results_say(study):
    results = results_of(study)
    rows = list(csv.DictReader((study / "tables.csv").open()))
    assert rows
    seconds = [order["time"]["mean"] for scenario in results["scenarios"] for order in scenario["orders"]]
    told = [float(row["value"]) for row in rows if row["table"] == "table-2" and row["value"]]
    for value in seconds:
        assert any(abs(value - other) <= 1e-9 * value for other in told), value
    assert "Table 1" in (study / "tables.md").read_text()


def test_the_motion_is_the_same_in_every_order(study):
    for scenario in results_of(study)["scenarios"]:
        for order in scenario["orders"]:
            assert order["motion"]["largest"] < 1e-6, (scenario["name"], order["ordering"])
    # the body does move
    motion = numpy.load(study / "data" / "bounce-motion.npy")
    assert motion.shape == (49, 64, 3)
    integrator = json.loads((conftest.ROOT / "scenarios" / "bounce.json").read_text())["integrator"]
    # h² g k (k + 1) / 2: free fall by backward Euler's sums, for the steps before the floor is met
    free = numpy.array([motion[0, :, 1].mean() - motion[k, :, 1].mean() for k in range(1, 21)])
    steps = numpy.arange(1, 21)
    per_step = -integrator["gravity"][1] * integrator["time_step"]**2
    assert free == pytest.approx(per_step * steps * (steps + 1) / 2, rel=1e-3)


def test_orders_that_are_kept_are_those_that_were_simulated(study):
    """The span computed from an order's file and the mesh's copy is the span in the results."""
    meshio = pytest.importorskip("meshio")
    mesh = meshio.read(study / "data" / "ball-3.vtu")
    cells = mesh.cells_dict["tetra"]
    pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    edges = numpy.unique(numpy.sort(numpy.concatenate([cells[:, pair] for pair in pairs]), axis=1), axis=0)
    for order in results_of(study)["meshes"][0]["orders"]:
        rank = numpy.load(study / "data" / f"ball-3-{order['ordering']}.vertices.npy").astype(int)
        span = abs(rank[edges[:, 0]] - rank[edges[:, 1]]).mean()
        assert order["span"]["mean"] == pytest.approx(span)


def test_a_study_goes_on_with_what_is_missing(command):
    arguments = ["reproduce", "-o", "study", *SMALL, "--steps", 16]
    command.ok(*arguments, "--runs", 1)
    first = results_of(command.folder / "study")
    result = command.json(*arguments, "--runs", 3)
    assert result["results"] == results_of(command.folder / "study")
    for before, after in zip(first["scenarios"], result["results"]["scenarios"]):
        for old, new in zip(before["orders"], after["orders"]):
            assert new["runs"][0] == old["runs"][0] and len(new["runs"]) == 3
    assert result["results"]["meshes"] == first["meshes"]
    # nothing is missing: nothing is run
    assert command.json(*arguments, "--runs", 3)["results"] == result["results"]


@pytest.fixture(scope="module")
def begun(tmp_path_factory):
    """A study of one run, and its arguments without the steps."""
    command = conftest.Command(tmp_path_factory.mktemp("begun"))
    arguments = ["reproduce", "-o", "study", "--scenario", "bounce", "--mesh", "ball-3", "--budget", "0.1", "--runs", 1]
    command.ok(*arguments, "--steps", 8)
    return command, arguments


@pytest.mark.parametrize("change, words", [
    (["--steps", "8", "--threads", "2"], "1 threads"),
    (["--steps", "8", "--orders", "hilbert/lexmax"], "other orderings"),
    (["--steps", "8", "--size", "300k"], "size paper"),
    (["--steps", "9"], "holds another"),
])
def test_another_study_is_not_mixed_in(begun, change, words):
    command, arguments = begun
    before = (command.folder / "study" / "results.json").read_bytes()
    assert words in command.fails(*arguments, *change)
    assert (command.folder / "study" / "results.json").read_bytes() == before


@pytest.mark.parametrize("change", [
    lambda machine: machine.update(revision="0123456789abcdef0123456789abcdef01234567"),
    lambda machine: machine.update(revision=machine["revision"] + "+5eed5eed"),
    lambda machine: machine.update(program="0.0.9"),
])
def test_results_of_another_revision_are_not_gone_on_with(begun, change):
    command, arguments = begun
    path = command.folder / "study" / "results.json"
    before = path.read_bytes()
    try:
        results = json.loads(before)
        change(results["machine"])
        path.write_text(json.dumps(results))
        line = command.fails(*arguments, "--steps", 8)
        assert "is of a study with meshorder 0." in line and ", where this is meshorder 0." in line
        assert json.loads(path.read_text()) == results
    finally:
        path.write_bytes(before)


def test_without_a_revision_the_version_counts(begun):
    """A build from a tarball records no revision. Results without one come from such a build or from an earlier version."""
    command, arguments = begun
    path = command.folder / "study" / "results.json"
    before = path.read_bytes()
    recorded = json.loads(before)["machine"]["revision"]
    try:
        results = json.loads(before)
        del results["machine"]["revision"]
        path.write_text(json.dumps(results))
        if recorded:
            assert "where this is meshorder" in command.fails(*arguments, "--steps", 8)
        else:
            command.ok(*arguments, "--steps", 8)
    finally:
        path.write_bytes(before)


def test_it_prints_what_the_orders_save(begun):
    command, arguments = begun
    shown = command.ok(*arguments, "--steps", 8).stdout
    assert "Speedup, %" in shown and "bounce, VF Fiedler" in shown


def test_it_stops_in_good_order_and_goes_on(tmp_path):
    command = conftest.Command(tmp_path)
    arguments = ["reproduce", "-o", "study", "--scenario", "bounce", "--scenario", "falling", "--mesh", "ball-5",
                 "--budget", "0.1", "--runs", "2"]
    process = subprocess.Popen([conftest.MESHORDER, *arguments], cwd=tmp_path, stderr=subprocess.PIPE, text=True,
                               stdout=subprocess.DEVNULL)
    results = tmp_path / "study" / "results.json"
    for _ in range(3000):
        if results.exists() and results_of(tmp_path / "study")["scenarios"]:
            break
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    stderr = process.communicate(timeout=300)[1]
    if process.returncode == 0:
        pytest.skip("it was done before it could be stopped")
    assert process.returncode == 130, stderr
    assert "continues from there" in stderr
    assert (tmp_path / "study" / "report.html").exists()
    kept = results_of(tmp_path / "study")["scenarios"][0]["orders"][0]["runs"]
    result = command.json(*arguments)["results"]
    assert result["scenarios"][0]["name"] == "falling"  # in the paper's order
    for scenario in result["scenarios"]:
        assert {len(order["runs"]) for order in scenario["orders"]} == {2}
    assert kept[0] in by_name(result["scenarios"], "bounce", "name")["orders"][0]["runs"]
    assert not [path for path in (tmp_path / "study" / "data").iterdir() if path.name.startswith(".")]


@pytest.mark.parametrize("arguments, words", [
    (["--scenario", "tumble"], "neither a scenario nor a file has this name"),
    (["--orders", "nonsense"], "unknown ordering 'nonsense'"),
    (["--size", "huge"], "unknown size 'huge'"),
    (["--mesh", "none.msh"], "none.msh"),
    (["--quick", "--full"], "excludes"),
    (["--runs", "0"], "--runs"),
])
def test_what_cannot_be_run_is_refused(command, arguments, words):
    assert words in command.fails("reproduce", "-o", "study", *arguments)
    assert not (command.folder / "study" / "results.json").exists()


def test_a_surface_is_refused(command):
    (command.folder / "surface.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    assert "surface.off: is a surface" in command.fails("reproduce", "-o", "study", "--mesh", "surface.off")


def test_a_broken_study_is_named(command):
    (command.folder / "study").mkdir()
    (command.folder / "study" / "results.json").write_text("{")
    assert "results.json" in command.fails("reproduce", "-o", "study", *SMALL)


def test_a_scenario_that_fails_is_named_and_keeps_the_rest(command):
    scenario = json.loads((conftest.ROOT / "scenarios" / "falling.json").read_text())
    scenario["name"] = "blown"
    scenario["forces"][0]["newtons"] = [1e300, 0, 0]
    (command.folder / "blown.json").write_text(json.dumps(scenario))
    words = command.fails("reproduce", "-o", "study", "--scenario", "blown.json", "--mesh", "ball-3", "--budget", "0.1")
    assert "blown" in words
    assert results_of(command.folder / "study")["scenarios"] == []
