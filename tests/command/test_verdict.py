# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The verdict of `info`: the cost of the order, and the gain by another one."""
import re

import pytest

import meshes

KERNELS = {"spmv", "element", "assembly", "springs"}


@pytest.fixture
def scrambled(command, model):
    command.ok("order", model("grid", "--size", "24"), "-o", "scrambled.node", "--vertices", "scrambled", "--elements",
               "scrambled")
    return "scrambled.node"


def test_the_answer_says_what_a_scrambled_grid_loses(command, scrambled):
    text = command.ok("info", scrambled).stdout
    name, order, gain, line = text.splitlines()[:4]
    assert name == "scrambled.node"
    assert re.fullmatch(r"order        poor: neighbours are 5,\d{3} places apart on average; `meshorder order` makes it [\d.]+, "
                        r"random would be 5,209", order)
    assert gain.startswith("gain         as it is, ") and re.search(r"[\d.]+ to [\d.]+ times as long as it could", gain)
    assert "`meshorder order` takes" in gain and re.search(r"pays off after \d+ runs? of it", gain)
    assert "A time step here: " in text and "bfs/lexmax" in text
    assert line == "to order it  meshorder order scrambled.node -o ordered-scrambled.node"
    command.ok(*line.split()[4:])
    _, order, gain = command.ok("info", "ordered-scrambled.node").stdout.splitlines()[:3]
    assert order.startswith("order        good: ") and gain.startswith("gain         nothing to gain")


def test_the_order_that_was_advised_has_nothing_to_gain(command, scrambled):
    command.ok("order", scrambled, "-o", "ordered.node")
    result = command.json("info", "ordered.node")["verdict"]
    assert "nothing to gain" in result["sentence"]
    for kernel in KERNELS:
        assert result["kernels"][kernel] == {"factor": None, "interval": None, "order": None, "runs_to_pay": None}
    assert command.json("info", "ordered.node")["order"]["grade"] == "good"


def test_a_tiny_mesh_is_judged_without_running_anything(command, tmp_path, monkeypatch):
    monkeypatch.delenv("MESHORDER_MACHINE", raising=False)
    meshes.write_tetgen(tmp_path)
    done = command.run("info", "mesh.node")
    assert done.stdout.splitlines()[0] == \
        "mesh.node: nothing to gain: its data fit in a processor's first cache, in any order"
    assert done.returncode == 0 and done.stderr == ""  # however busy the machine is
    assert command.json("info", "mesh.node")["verdict"] is None
    for options in (["--measure"], ["--machine", "zen3"]):
        assert command.json("info", "mesh.node", *options)["verdict"] is not None


def test_verdict_keys(command, scrambled):
    result = command.json("info", scrambled)["verdict"]
    assert set(result) == {"sentence", "by", "reliable", "doubt", "machine", "kernel_set", "threads", "kernels", "as_it_is", "orders",
                           "time_step"}
    assert result["reliable"] and result["doubt"] is None
    assert result["by"] == "prediction" and result["machine"] == "zen3" and result["threads"] == 1
    assert "(predicted for zen3)" in result["sentence"]
    assert set(result["kernels"]) == set(result["time_step"]) == KERNELS
    assert set(result["as_it_is"]["predicted_milliseconds"]) == KERNELS
    assert result["as_it_is"]["measured_milliseconds"] is None
    for order in result["orders"]:
        assert set(order) == {"command", "vertices", "elements", "seconds", "time_steps_to_pay",
                              "predicted_milliseconds", "measured_milliseconds"}
        assert order["seconds"] > 0
    assembly = result["kernels"]["assembly"]
    best = result["orders"][assembly["order"]]
    as_is = result["as_it_is"]["predicted_milliseconds"]["assembly"]
    ordered = best["predicted_milliseconds"]["assembly"]
    assert assembly["factor"] == pytest.approx(as_is / ordered) and assembly["factor"] > 1.3
    assert assembly["interval"] == pytest.approx([assembly["factor"] / 1.1, assembly["factor"] * 1.1])
    assert assembly["runs_to_pay"] - 1 <= 1e3 * best["seconds"] / (as_is - ordered) <= assembly["runs_to_pay"]


def test_measuring_replaces_what_is_predicted(command, scrambled):
    result = command.json("info", scrambled, "--measure")["verdict"]
    assert result["by"] == ("measurement" if result["reliable"] else "prediction")
    for costs in [result["as_it_is"], *result["orders"]]:
        assert set(costs["measured_milliseconds"]) == set(costs["predicted_milliseconds"]) == KERNELS
        assert all(ms > 0 for ms in costs["measured_milliseconds"].values())
    done = command.ok("info", scrambled, "--measure")
    if "too busy" not in done.stderr:
        assert "measured here (predicted)" in done.stdout and "(measured here)" in done.stdout.splitlines()[2]


def test_small_meshes_are_measured_unasked(command, scrambled, monkeypatch):
    monkeypatch.delenv("MESHORDER_MACHINE", raising=False)
    monkeypatch.setenv("MESHORDER_CACHE", str(command.folder / "cache"))  # nothing is calibrated
    assert command.json("info", scrambled)["verdict"]["as_it_is"]["measured_milliseconds"]
    done = command.ok("info", scrambled)
    if "too busy" not in done.stderr:
        assert "(measured here" in done.stdout.splitlines()[2] and "predicted" not in done.stdout
    assert "measuring this machine" not in done.stderr and not (command.folder / "cache").exists()
    for options in (("--machine", "zen3"), ("--cache", "32K,1M")):
        assert command.json("info", scrambled, *options)["verdict"]["by"] == "prediction"
    assert "--measure excludes --predict" in command.fails("info", scrambled, "--predict", "--measure")


def test_details_are_shown_when_asked_for(command, scrambled):
    short, long = (command.ok("info", scrambled, *options).stdout for options in ((), ("--details",)))
    for words in ("Edges by span", "Predicted for each run of a kernel", "█"):
        assert words not in short and words in long
    assert len(short.splitlines()) < 24 and short.splitlines()[4:10] == long.splitlines()[4:10]


def test_tuned_kernels_are_measured_only(command, scrambled):
    result = command.json("info", scrambled, "--measure", "--kernels", "tuned")["verdict"]
    assert result["kernel_set"] == "tuned" and result["as_it_is"]["predicted_milliseconds"] is None
    assert command.json("info", scrambled, "--measure")["verdict"]["kernel_set"] == "plain"
    assert "give --measure, too" in command.fails("info", scrambled, "--kernels", "tuned")
    assert "unknown kernels 'fast'; known: plain, tuned" in command.fails("info", scrambled, "--kernels", "fast")


def test_predictions_are_the_same_on_every_run(command, scrambled):
    first, second = (command.json("info", scrambled, "--threads", threads)["verdict"] for threads in "12")
    assert first["kernels"]["assembly"]["factor"] == second["kernels"]["assembly"]["factor"]
    assert first["as_it_is"] == second["as_it_is"]

