# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Two builds of the same sources in two folders, without ccache, give the same bytes."""
import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
pytestmark = [pytest.mark.package, pytest.mark.long,
              pytest.mark.skipif(not (ROOT / ".git").exists(), reason="not a checkout of the sources")]
#: the content of the packages: the command and the shared libraries
PRODUCTS = ["bin/meshorder", "src/libmeshorder.so", "src/libmeshorder_c.so"]


def build(folder):
    """Copies the sources of the working tree into the folder, and builds them there."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    for name in filter(None, listed.decode().split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    environment = {**os.environ, "CCACHE_DISABLE": "1", "SOURCE_DATE_EPOCH": "1700000000"}
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DBUILD_SHARED_LIBS=ON", "-DMESHORDER_LAB=OFF", "-DMESHORDER_TESTS=OFF",
               "-DMESHORDER_EXAMPLES=OFF", "-DMESHORDER_MODELS_TOOL=OFF", "-DMESHORDER_PYTHON=OFF"]
    for command in (["cmake", "-S", ".", "-B", "out", "-G", "Ninja", *options],
                    ["ninja", "-C", "out", "-j", str(min(4, os.cpu_count() or 1)), "meshorder", "meshorder_library",
                     "meshorder_c"]):
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    return folder / "out"


def test_two_builds_are_the_same_bytes(tmp_path):
    one, other = build(tmp_path / "one"), build(tmp_path / "another folder's name")
    for product in PRODUCTS:
        assert (one / product).read_bytes() == (other / product).read_bytes(), product
        assert str(tmp_path).encode() not in (one / product).read_bytes(), f"{product} names the folder of its build"


def test_no_source_asks_for_the_time_of_its_compilation():
    listed = subprocess.run(["git", "grep", "-lE", r"__(DATE|TIME|TIMESTAMP)__", "--", "src", "lab", "apps", "include",
                             "python/bind"], cwd=ROOT, capture_output=True, text=True, check=False).stdout
    assert listed == ""
