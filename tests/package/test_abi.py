# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The binary interface of libmeshorder_c.so.1 stays as meshorder_c.abi records it.

    python3 tests/package/test_abi.py

writes a new record. Do this after adding a function, or a member at the end of a struct that begins with its size. Any
other change breaks linked programs and needs another soname.
"""
import pathlib
import platform
import shutil
import subprocess
import sys

import pytest

import test_package

ROOT = test_package.ROOT
RECORD = pathlib.Path(__file__).with_name("meshorder_c.abi")

pytestmark = [
    pytest.mark.package,
    pytest.mark.skipif(not shutil.which("abidiff"), reason="needs abidiff (Debian: abigail-tools)"),
    pytest.mark.skipif(platform.machine() != "x86_64" or platform.system() != "Linux", reason="the record is of x86-64"),
]


def describe(folder, include=ROOT / "include"):
    """abidw's description of the functions of meshorder.h and their types, from debugging information."""
    library = folder / "libmeshorder_c.so.1"
    test_package.run(test_package.cache_value("CMAKE_CXX_COMPILER"), "-std=c++20", "-g", "-O0", "-fPIC", "-shared",
                     "-fvisibility=hidden", f"-fdebug-prefix-map={ROOT}=.", "-DMESHORDER_BUILDING", "-I", include,
                     f"-I{ROOT}/src", f"-I{test_package.BUILD}/src/include", "-isystem", "/usr/include/eigen3",
                     *(ROOT / f"src/c/{name}.cpp" for name in ("arguments", "c_interface", "layouts")),
                     f"-Wl,--version-script={ROOT}/src/c/exports.map", "-Wl,-soname,libmeshorder_c.so.1", "-o", library)
    test_package.run("abidw", "--exported-interfaces-only", "--headers-dir", include, "--drop-private-types",
                     "--drop-undefined-syms", "--no-corpus-path", "--no-comp-dir-path", "--no-show-locs",
                     "--no-elf-needed", "--type-id-style", "hash", "--out-file", folder / "now.abi", library)
    return folder / "now.abi"


def differences(before, now):
    return subprocess.run(["abidiff", str(before), str(now)], capture_output=True, text=True, check=False).stdout


def test_the_interface_is_the_recorded_one(tmp_path):
    assert not differences(RECORD, describe(tmp_path)), f"see {pathlib.Path(__file__).name}"


def test_a_change_would_be_seen(tmp_path):
    shutil.copytree(ROOT / "include", tmp_path / "include")
    header = tmp_path / "include" / "meshorder.h"
    header.write_text(header.read_text().replace("double tolerance;", "float tolerance; "))
    assert "double tolerance" in differences(RECORD, describe(tmp_path, tmp_path / "include"))


if __name__ == "__main__":
    work = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "abi")
    work.mkdir(parents=True, exist_ok=True)
    shutil.copy(describe(work), RECORD)
