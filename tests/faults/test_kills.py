# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""After the command is killed, each file is the old or the new one, a mixture is refused, and the next run succeeds."""
import random
import signal
import statistics
import subprocess
import time

import pytest

import cases
import interposed
from interposed import Fault, spread

NAMES = ("order with maps", "apply", "openfoam", "simulate", *cases.OVER)


def faults_after(case):
    """The faults after a kill and after the next run, as sentences."""
    yield from case.faults_of_files()
    if case.line.reader and case.without_fault(case.line.reader) == 0:
        yield from case.faults_of_set()
    (case.folder / "read.msh").unlink(missing_ok=True)
    if (status := case.without_fault()) != 0:
        yield f"the next run ends with status {status}"
    yield from case.faults_of_set("new")
    if left := case.left_over():
        yield f"left over after the next run: {left}"


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("what", ["kill", "torn"])
def test_a_kill_within_a_call_loses_nothing(tmp_path, name, what):
    case = cases.case(name, tmp_path)
    for kind in ("open", "write", "sync", "close", "rename"):
        for nth in spread(case.clean.calls[kind], 3 if what == "kill" else 2):
            case.with_fault(Fault(kind, nth, what))
            faults = list(faults_after(case))
            assert not faults, (kind, nth, what, faults)


def killed_at(case, seconds):
    """Runs the case and kills it after some seconds. Returns whether it was still running."""
    case.restore()
    with subprocess.Popen([interposed.MESHORDER, *map(str, case.arguments)], cwd=case.folder, stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as child:
        time.sleep(seconds)
        child.send_signal(signal.SIGKILL)
    return child.returncode == -signal.SIGKILL


def time_of_run(case):
    case.restore()
    began = time.monotonic()
    case.without_fault()
    return time.monotonic() - began


def kill_at_random(case, times, seed):
    """Kills the case `times` times, at random instants of its running time. Returns how often it was still running."""
    length = statistics.median(time_of_run(case) for _ in range(5))
    instants = random.Random(seed)
    alive = 0
    for turn in range(times):
        alive += killed_at(case, instants.uniform(0, 1.1 * length))
        faults = list(faults_after(case))
        assert not faults, (turn, faults)
    return alive


@pytest.mark.parametrize("name", NAMES)
def test_a_kill_at_any_instant_loses_nothing(tmp_path, name):
    assert kill_at_random(cases.case(name, tmp_path), 6, seed=1) > 0


@pytest.mark.long
@pytest.mark.parametrize("name", NAMES)
def test_kills_at_many_instants_lose_nothing(tmp_path, name):
    alive = kill_at_random(cases.case(name, tmp_path), 100, seed=2)
    print(f"{name}: {alive} kills")
    assert alive > 50
