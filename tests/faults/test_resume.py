# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""A simulation that is killed again and again goes on from its checkpoint, to the same bits."""
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


def resumed_to_the_end(folder, kills, instants):
    """Kills the simulation that many times, and resumes it each time. Returns its result and how often it was alive."""
    alive = 0
    for turn in range(kills + 1):
        resume = ("--resume", "state") if (folder / "state").exists() else ()
        with start(folder, *RUN, *resume, "--checkpoint", "state", "--checkpoint-every", 1) as child:
            try:
                out, err = child.communicate(timeout=instants.uniform(0, 0.3) if turn < kills else interposed.SECONDS)
            except subprocess.TimeoutExpired:
                child.kill()
                child.communicate()
                alive += child.returncode == -signal.SIGKILL
                continue
        assert child.returncode == 0, err
    return json.loads(out), alive


def killed_and_resumed(folder, kills, seed):
    cases.scenario(folder)
    with start(folder, *RUN) as child:
        out, err = child.communicate(timeout=interposed.SECONDS)
    assert child.returncode == 0, err
    whole, frames = json.loads(out), interposed.contents(folder / "frames")
    parts, alive = resumed_to_the_end(folder, kills, random.Random(seed))
    assert all(parts[key] == whole[key] for key in ("energy", "momentum", "angular_momentum", "newton_iterations"))
    assert interposed.contents(folder / "frames") == frames
    return alive


def test_a_killed_simulation_goes_on_to_the_same_bits(tmp_path):
    assert killed_and_resumed(tmp_path, 6, seed=1) > 0


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_a_simulation_killed_many_times_goes_on_to_the_same_bits(tmp_path, seed):
    alive = killed_and_resumed(tmp_path, 40, seed)
    print(f"simulate: {alive} kills")
    assert alive > 20
