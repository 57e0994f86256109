# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""./run, with a command that prints its arguments instead of the built one."""
import shutil
import subprocess

import pytest

import conftest

SETUP = """packages_to_run=() packages_for_mpi=()
install_missing() { :; }
configure() { :; }
build() { :; }
"""
PROGRAM = '#!/bin/sh\necho "$PWD: $*"\n'


@pytest.fixture
def root(tmp_path):
    folder = tmp_path / "project"
    (folder / "scripts").mkdir(parents=True)
    (folder / "build/bin").mkdir(parents=True)
    shutil.copy(conftest.ROOT / "run", folder)
    (folder / "scripts/setup.sh").write_text(SETUP)
    (folder / "build/bin/meshorder").write_text(PROGRAM)
    (folder / "build/bin/meshorder").chmod(0o755)
    return folder


@pytest.mark.parametrize("given, passed", [
    ((), "-o mesh-ordered.off"),
    (("--maps", "sub/m"), "-o mesh-ordered.off --maps sub/m"),
    (("--maps=sub/m", "-o", "out.off"), "-o out.off --maps=sub/m"),
    (("--output=sub/out.off",), "-o sub/out.off"),
    (("-osub/out.off", "--plugin", "own.so"), "-o sub/out.off --plugin own.so"),
])
def test_paths_are_those_of_the_caller(root, tmp_path, given, passed):
    caller = tmp_path / "caller"
    caller.mkdir()
    (caller / "mesh.off").touch()
    done = subprocess.run([root / "run", "mesh.off", *given], cwd=caller, capture_output=True, text=True, check=True)
    steps = [line for line in done.stdout.splitlines() if line.startswith("== ")]
    assert steps == ["== 1 of 3: packages", "== 2 of 3: build", "== 3 of 3: mesh.off"]
    assert done.stdout.splitlines()[len(steps)] == f"{caller}: order mesh.off {passed}"
