# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Short simulations in a build with ThreadSanitizer, which is made in build-threads/ as ./test does."""
import os
import subprocess

import pytest

import conftest

pytestmark = pytest.mark.long
BUILD = conftest.ROOT / "build-threads"


@pytest.fixture(scope="module")
def program():
    options = ["-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -g1", "-DMESHORDER_SANITIZER=thread",
               "-DMESHORDER_MODELS_TOOL=OFF", "-DMESHORDER_EXAMPLES=OFF", "-DMESHORDER_TEST_LAYERS=threads"]
    for command in (["cmake", "-S", conftest.ROOT, "-B", BUILD, "-G", "Ninja", *options],
                    ["ninja", "-C", BUILD, "-j", "2", "meshorder"]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    return BUILD / "bin" / "meshorder"


@pytest.mark.parametrize("scenario", ["falling", "constrained", "stretch", "unsquash", "bowl", "bounce"])
def test_no_race(program, scenario, tmp_path):
    done = subprocess.run([program, "simulate", scenario, "--mesh", "ball-12", "--steps", "6", "--threads", "4"],
                          cwd=tmp_path, capture_output=True, text=True, timeout=3600, check=False,
                          env={**os.environ, "XDG_CACHE_HOME": str(tmp_path), "TSAN_OPTIONS": "halt_on_error=0"})
    assert "ThreadSanitizer" not in done.stderr, done.stderr[:4000]
    assert done.returncode == 0, done.stderr
