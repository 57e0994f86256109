# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`meshorder calibrate`, and commands that use its measurement of the machine."""
import json
import os

import pytest

KERNELS = ["spmv", "element", "assembly", "springs"]
KEYS = ["schema", "processor", "build", "date", "machine", "caches", "memory_nanoseconds", "threads", "read_bandwidth",
        "kernels", "steadiness", "seconds", "file", "version", "notes"]


@pytest.fixture
def here(command, monkeypatch):
    """The command without MESHORDER_MACHINE, and with its own cache folder."""
    monkeypatch.delenv("MESHORDER_MACHINE")
    monkeypatch.setenv("MESHORDER_CACHE", str(command.folder / "cache"))
    monkeypatch.setenv("MESHORDER_CALIBRATION_SECONDS", "0.1")
    mesh = command.folder / "mesh.node"
    mesh.write_text("5 3 0 0\n" + "".join(f"{i} {i % 3} {i % 2} {i // 2}\n" for i in range(5)))
    mesh.with_suffix(".ele").write_text("2 4 0\n0 0 1 2 3\n1 1 2 3 4\n")
    return command


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """A calibration of this machine, made once: the output of `calibrate --json`, which names its file."""
    folder = tmp_path_factory.mktemp("calibration")
    environment = {**os.environ, "MESHORDER_CACHE": str(folder)}
    from conftest import Command

    done = Command(folder).run("calibrate", "--budget", "0.1", "--json", "--quiet", env=environment)
    assert done.returncode == 0, done.stderr
    assert done.stderr == "" or "this machine is too busy to time kernels" in done.stderr
    return json.loads(done.stdout)


@pytest.fixture
def stored(here, measured):
    """The file of an existing calibration; its date distinguishes it from one made now."""
    file = here.folder / "cache" / "calibrations" / os.path.basename(measured["file"])
    file.parent.mkdir(parents=True)
    content = {key: value for key, value in measured.items() if key not in ("file", "version", "notes")}
    file.write_text(json.dumps({**content, "date": "2026-01-02", "steadiness": {"waiting": 0, "pace": 0, "repeat": 0}}))
    return file


def test_a_calibration_says_what_it_measured(measured):
    assert list(measured) == KEYS
    caches = measured["caches"]
    assert list(caches) == ["reported", "found", "used"]
    assert caches["used"] and caches["used"] == sorted(caches["used"])
    latencies = [level["nanoseconds"] for level in caches["found"]] + [measured["memory_nanoseconds"]]
    assert latencies == sorted(latencies) and latencies[0] > 0
    assert list(measured["kernels"]) == KERNELS
    for kernel in measured["kernels"].values():
        assert list(kernel) == ["solid", "flat", "condition", "error", "floor", "all_threads"]
        assert list(kernel["all_threads"]) == ["solid", "flat", "condition", "error", "floor"]
        for costs in kernel["solid"], kernel["flat"], kernel["all_threads"]["solid"], kernel["all_threads"]["flat"]:
            assert list(costs) == ["access", "miss", "jump", "turn"]
            assert len(costs["miss"]) == len(costs["jump"]) == 4
            assert min([*costs["miss"], *costs["jump"], costs["access"], costs["turn"]]) >= 0
    assert all(rate > 0 for rate in measured["read_bandwidth"].values())
    assert os.path.dirname(measured["file"]).endswith("calibrations") and os.path.exists(measured["file"])
    assert os.listdir(os.path.dirname(measured["file"])) == [os.path.basename(measured["file"])]


def test_predictions_are_of_the_machine_that_was_calibrated(here, stored, measured):
    result = here.json("info", "mesh.node", "--predict")
    assert result["verdict"]["machine"] == "this machine, calibrated 2026-01-02"
    assert result["caches"] == measured["caches"]["used"]
    assert "predicted for this machine, calibrated 2026-01-02" in here.ok("info", "mesh.node", "--predict").stdout
    text = here.ok("calibrate", "--list").stdout
    assert text.splitlines()[0].split() == ["this", "this", "machine,", "calibrated", "2026-01-02"]
    listed = here.json("calibrate", "--list")["machines"]
    assert [machine["name"] for machine in listed] == ["this", "zen3"]
    assert listed[0]["calibrated"] == "2026-01-02"


@pytest.mark.parametrize("by", ["option", "variable"])
def test_another_machine_is_predicted_for_by_its_name(here, stored, monkeypatch, by):
    words = ["--machine", "zen3"] if by == "option" else []
    if by == "variable":
        monkeypatch.setenv("MESHORDER_MACHINE", "zen3")
    result = here.json("info", "mesh.node", *words)
    assert result["verdict"]["machine"] == "zen3" and result["caches"] == [32 << 10, 512 << 10, 16 << 20]
    assert here.json("compare", "mesh.node", "--budget", "0.01", "--methods", "rcm", *words)["caches"] == result["caches"]
    assert here.json("info", "mesh.node", "--machine", "this")["verdict"]["machine"].startswith("this machine")


def test_an_unknown_machine_gets_the_nearest_name(here, monkeypatch):
    for command in "info", "compare":
        assert "unknown machine 'zen6'; did you mean 'zen3'?" in here.fails(command, "mesh.node", "--machine", "zen6")
    monkeypatch.setenv("MESHORDER_MACHINE", "cray")
    assert "unknown machine 'cray'; known: this, zen3" in here.fails("info", "mesh.node")


def test_the_first_prediction_calibrates_and_the_next_one_does_not(here):
    first = here.run("info", "mesh.node", "--predict")
    assert first.returncode == 0 and "measuring this machine once" in first.stderr
    assert "predicted for this machine, calibrated 20" in first.stdout
    second = here.run("info", "mesh.node", "--predict")
    assert second.returncode == 0 and second.stderr == ""
    assert "predicted for this machine, calibrated 20" in second.stdout


def test_kernels_are_judged_as_all_threads_share_them(here, measured):
    threads = ["--threads", str(measured["threads"])]
    on = "" if measured["threads"] == 1 else f" on {measured['threads']} threads"
    assert here.json("info", "mesh.node", "--measure", *threads)["verdict"]["threads"] == 1
    for words in ["info", "mesh.node", "--predict"], ["info", "mesh.node", "--measure"], ["order", "mesh.node", "-o", "out.node", "--predict"]:
        result = here.json(*words, "--all-threads", *threads)
        verdict = result["verdict"] if words[0] == "info" else result["race"]
        assert verdict["threads"] == measured["threads"]
        if "--measure" in words:
            assert verdict["machine"] is None and verdict["as_it_is"]["measured_milliseconds"]["spmv"] > 0
        else:
            assert verdict["machine"].startswith(f"this machine{on}, calibrated ")
    measured_here = here.ok("info", "mesh.node", "--measure", "--all-threads", *threads)
    assert f"measured here{on}" in measured_here.stdout or "too busy to time" in measured_here.stderr


def test_costs_of_all_threads_that_are_not_known_are_refused(here, stored):
    content = json.loads(stored.read_text())
    if content["threads"] > 1:
        fault = here.fails("info", "mesh.node", "--machine", "zen3", "--all-threads")
        assert "the costs of 'zen3' are those of one thread; calibrate this machine to predict for all its threads" in fault
    stored.write_text(json.dumps({**content, "threads": content["threads"] + 1}))
    fault = here.fails("order", "mesh.node", "-o", "out.node", "--predict", "--all-threads")
    assert f"was calibrated on {content['threads'] + 1} threads, and now there are" in fault
    assert not (here.folder / "out.node").exists()
    assert "--all-threads is for --predict and --measure" in here.fails("order", "mesh.node", "-o", "out.node", "--all-threads")


def test_measuring_does_not_wait_for_a_calibration(here):
    result = here.json("info", "mesh.node", "--measure")
    # the processor's family decides whose costs are used
    stands_in = [f"this machine's caches at the costs of {name}" for name in ("zen3",)]
    assert result["verdict"]["machine"] in stands_in
    assert not (here.folder / "cache").exists()


@pytest.mark.parametrize("content", ["", "{", "[]", '{"schema": "another"}', '{"schema": 3}', '{"schema": null}'])
def test_a_damaged_calibration_is_measured_anew_with_one_warning(here, stored, content):
    stored.write_text(content)
    done = here.run("info", "mesh.node", "--json", "--predict")
    assert done.returncode == 0
    notes = [note for note in json.loads(done.stdout)["notes"] if "is not used" in note]
    assert len(notes) == 1 and str(stored) in notes[0] and "measured again" in notes[0]
    assert json.loads(stored.read_text())["date"] != "2026-01-02"
    assert "is not used" not in here.ok("info", "mesh.node", "--predict").stderr


def test_a_folder_that_cannot_be_written_is_one_warning(here, monkeypatch):
    blocked = here.folder / "file"
    blocked.write_text("")
    monkeypatch.setenv("MESHORDER_CACHE", str(blocked / "cache"))
    done = here.run("info", "mesh.node", "--json", "--predict")
    assert done.returncode == 0
    result = json.loads(done.stdout)
    assert len([note for note in result["notes"] if "cannot be written" in note]) == 1
    assert result["verdict"]["machine"].startswith("this machine, calibrated ")


def test_costs_are_printed_in_columns(here):
    lines = here.ok("calibrate", "--budget", "1").stdout.splitlines()
    heading = next(k for k, line in enumerate(lines) if line.split()[:2] == ["access", "misses"])
    assert lines[heading].split() == ["access", "misses", "jumps", "turn", "condition", "error", "floor"]
    row = lines[heading + 1].removeprefix("SpMV").split()
    # costs of an access, of four kinds of misses, of four kinds of jumps and of a turn
    assert len(row) == 13 and all(float(number) >= 0 for number in row[:10])


def test_a_machine_that_moved_is_noticed(here, stored):
    content = json.loads(stored.read_text())
    for kernel in content["kernels"].values():
        kernel.update(error=0.01, floor=0.01)
        for costs in kernel["solid"], kernel["flat"]:
            for levels in "miss", "jump":
                costs[levels] = [10 * cost for cost in costs[levels]]
            for single in "access", "turn":
                costs[single] *= 10
    stored.write_text(json.dumps(content))
    result = here.json("calibrate", "--recheck")
    assert result["moved"] and all(ratio < 0.5 for ratio in result["ratio"].values())
    assert "has changed since it was calibrated" in here.ok("calibrate", "--recheck").stdout


def test_nothing_to_recheck_is_said(here):
    assert "is not calibrated; `meshorder calibrate` calibrates it" in here.fails("calibrate", "--recheck")
