# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""A simulation that is killed repeatedly resumes from its checkpoint and gives the same bits."""
import json
import random
import signal
import subprocess

import pytest

import cases
import interposed

STEPS = 60
RUN = ("simulate", "small.json", "--steps", STEPS, "--vtk", "frames", "--every", 20, "--json")


def start(folder, *arguments):
    return subprocess.Popen([interposed.MESHORDER, *map(str, arguments)], cwd=folder, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def killed(child, seconds):
    """Kills a process after some seconds. Returns whether it was still running."""
    try:
        child.wait(seconds)
    except subprocess.TimeoutExpired:
        child.kill()
    out, err = child.communicate(timeout=interposed.SECONDS)
    assert child.returncode in (0, -signal.SIGKILL), err
    return child.returncode != 0


def resumed_to_the_end(folder, kills, instants):
    """Kills the simulation `kills` times, and resumes it each time; starts from the beginning if it ends before a kill.
    Returns its result."""
    state = folder / "state"
    while True:
        resume = ("--resume", "state") if state.exists() else ()
        with start(folder, *RUN, *resume, "--checkpoint", "state", "--checkpoint-every", 1) as child:
            if kills > 0:
                if killed(child, instants.uniform(0, 0.3)):
                    kills -= 1
                else:
                    state.unlink()
                continue
            out, err = child.communicate(timeout=interposed.SECONDS)
        assert child.returncode == 0, err
        return json.loads(out)


def killed_and_resumed(folder, kills, seed):
    cases.scenario(folder)
    with start(folder, *RUN) as child:
        out, err = child.communicate(timeout=interposed.SECONDS)
    assert child.returncode == 0, err
    whole, frames = json.loads(out), interposed.contents(folder / "frames")
    parts = resumed_to_the_end(folder, kills, random.Random(seed))
    assert all(parts[key] == whole[key] for key in ("energy", "momentum", "angular_momentum", "newton_iterations"))
    assert interposed.contents(folder / "frames") == frames


def test_a_killed_simulation_goes_on_to_the_same_bits(tmp_path):
    killed_and_resumed(tmp_path, 6, seed=1)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_a_simulation_killed_many_times_goes_on_to_the_same_bits(tmp_path, seed):
    killed_and_resumed(tmp_path, 40, seed)
