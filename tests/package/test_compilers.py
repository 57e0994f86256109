# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Orders have the committed hashes (tests/threads/order_hashes.txt) also with another compiler and other options."""
import os
import shutil
import subprocess

import pytest

from test_package import ROOT

pytestmark = [pytest.mark.package, pytest.mark.long]
CLANG = shutil.which("clang++") or shutil.which("clang++-14")


#: docs/limits.md promises nothing for instructions that fuse operations
FUSED = pytest.param("g++", "-O3 -march=x86-64-v3", marks=pytest.mark.xfail(strict=True, reason="fused operations"))


@pytest.mark.parametrize("compiler, flags", [(CLANG, "-O1"), (CLANG, "-O3"), FUSED])
def test_orders_have_the_committed_hashes(compiler, flags, tmp_path):
    if not compiler:
        pytest.skip("there is no clang++")
    options = ["-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_CXX_FLAGS_RELEASE={flags} -DNDEBUG", f"-DCMAKE_CXX_COMPILER={compiler}",
               "-DMESHORDER_TEST_LAYERS=threads", "-DMESHORDER_MODELS_TOOL=OFF", "-DMESHORDER_EXAMPLES=OFF",
               *[f"-DMESHORDER_{library}=OFF" for library in ("NETCDF", "HDF5", "CGNS")]]
    for command in (["cmake", "-S", ROOT, "-B", tmp_path, "-G", "Ninja", *options],
                    ["ninja", "-C", tmp_path, "-j", str(min(4, os.cpu_count() or 1)), "threads_tests"],
                    [tmp_path / "bin/threads_tests", "--gtest_filter=OrderHashes.*"]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, (done.stdout + done.stderr)[-4000:]
