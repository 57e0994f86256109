# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""On a busy machine the command states no measured gain, and says why."""
import contextlib
import os
import subprocess
import sys

DOUBT = "this machine is too busy to time kernels: "


@contextlib.contextmanager
def busy_machine():
    """Keeps every processor busy with two other programs."""
    others = [subprocess.Popen([sys.executable, "-c", "while True: pass"])
              for _ in range(2 * len(os.sched_getaffinity(0)))]
    try:
        yield
    finally:
        for other in others:
            other.kill()
        for other in others:
            other.wait()


def test_compare_doubts_times_of_a_busy_machine(command, model):
    mesh = model("grid", "--size", "16")
    with busy_machine():
        done = command.json("compare", mesh, "--methods", "hilbert", "--budget", "2")
    assert [note for note in done["notes"] if note.startswith("on 1 thread: " + DOUBT)]
    [steadiness] = done["steadiness"]
    assert steadiness["threads"] == 1 and set(steadiness) == {"threads", "waiting", "pace", "repeat"}
    assert 0.05 < steadiness["waiting"] < 1
    assert not done["verdict"]["reliable"] and done["verdict"]["best"] is None
    assert not any(times["told_apart"] for method in done["methods"] for times in method["kernels"].values())


def test_sentence_and_table_of_a_busy_machine_name_no_measured_gain(command, model):
    command.ok("order", model("grid", "--size", "16"), "-o", "s.node", "--vertices", "scrambled", "--elements", "scrambled")
    with busy_machine():
        compared = command.ok("compare", "s.node", "--methods", "hilbert", "--budget", "2").stdout
        advised = command.json("info", "s.node", "--measure")
    assert compared.startswith("s.node: the gain is not known: " + DOUBT)
    [row] = [line for line in compared.splitlines() if line.startswith("hilbert ")]
    assert row.split()[3:8] == ["=*"] * 5
    verdict = advised["verdict"]
    assert verdict["by"] == "prediction" and not verdict["reliable"] and verdict["doubt"].startswith(DOUBT)
    assert "(predicted for" in verdict["sentence"] and advised["order"]["grade"] == "poor"


def test_info_and_report_doubt_them_too(command, model):
    mesh = model("grid", "--size", "16")
    with busy_machine():
        info = command.ok("info", mesh, "--measure")
        report = command.ok("report", mesh, "--budget", "2", "-o", "page.html")
    assert f"meshorder: warning: {DOUBT}" in info.stderr
    assert f"meshorder: warning: grid-16: {DOUBT}" in report.stderr
    assert f"But {DOUBT}" in (command.folder / "page.html").read_text()


def test_predictions_have_nothing_to_doubt(command, model):
    with busy_machine():
        assert DOUBT not in command.ok("info", model("grid", "--size", "16")).stderr
