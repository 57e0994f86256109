# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Runs the built command as a user does. MESHORDER names it; the default is build/bin/meshorder."""
import json
import os
import pathlib
import signal
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MESHORDER = os.environ.get("MESHORDER", str(ROOT / "build" / "bin" / "meshorder"))
# the same predictions on every machine, and no measurement before them
os.environ["MESHORDER_MACHINE"] = "zen3"
#: meshes of Gmsh and TetGen
DATA = ROOT / "tests" / "data"


class Command:
    """Runs `meshorder …` in a folder of the test's own."""

    def __init__(self, folder):
        self.folder = folder

    def run(self, *arguments, **options):
        return subprocess.run([MESHORDER, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=600, check=False, **options)

    def ok(self, *arguments):
        done = self.run(*arguments)
        assert done.returncode == 0, done.stderr
        return done

    def json(self, *arguments):
        return json.loads(self.ok(*arguments, "--json").stdout)

    def fails(self, *arguments, status=2):
        """Runs a command that must fail, and returns its one line of error."""
        done = self.run(*arguments)
        assert done.returncode == status, done.stderr
        lines = done.stderr.strip().splitlines()
        assert len(lines) == 1 and lines[0].startswith("meshorder: "), done.stderr
        assert done.stdout == ""
        return lines[0]


@pytest.fixture(autouse=True)
def closed_pipes():
    """A write to a closed pipe fails, as always in Python; the start of Gmsh's module makes it end the process."""
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)


@pytest.fixture
def command(tmp_path):
    return Command(tmp_path)


@pytest.fixture(scope="session")
def model(tmp_path_factory):
    """The path of a model by its name, made if it is not yet in the cache."""
    maker = Command(tmp_path_factory.mktemp("models"))

    def make(name, *options):
        return maker.json("models", "make", name, *options)["models"][0]["path"]

    return make


