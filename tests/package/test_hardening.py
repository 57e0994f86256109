# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The hardening of programs and shared libraries, as readelf shows it."""
import os
import pathlib
import platform
import re
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("MESHORDER_BUILD", ROOT / "build"))
pytestmark = [pytest.mark.package,
              pytest.mark.skipif(not shutil.which("readelf"), reason="there is no readelf")]
PROGRAM = BUILD / "bin" / "meshorder"
LIBRARY = BUILD / "src" / "libmeshorder_c.so"


def readelf(option, path):
    return subprocess.run(["readelf", "--wide", option, path], capture_output=True, text=True, check=True).stdout


def built_with_guards():
    cache = (BUILD / "CMakeCache.txt").read_text()
    return "MESHORDER_HARDENED:BOOL=ON" in cache and "CMAKE_BUILD_TYPE:STRING=Release" in cache


@pytest.fixture(params=[PROGRAM, LIBRARY], ids=lambda path: path.name)
def binary(request):
    if not built_with_guards():
        pytest.skip("no hardened Release build")
    return request.param


def test_table_of_functions_is_read_only(binary):
    assert "GNU_RELRO" in readelf("--program-headers", binary)
    assert re.search(r"\(FLAGS(_1)?\).*\b(BIND_)?NOW\b", readelf("--dynamic", binary))


def test_stack_holds_no_code(binary):
    stack = next(line for line in readelf("--program-headers", binary).splitlines() if "GNU_STACK" in line)
    assert "E" not in stack.split()[-2]


def test_address_is_random(binary):
    assert "DYN" in re.search(r"Type: +(\w+)", readelf("--file-header", binary))[1]
    if binary == PROGRAM:
        assert re.search(r"\(FLAGS_1\).*\bPIE\b", readelf("--dynamic", binary))


def test_stack_is_watched(binary):
    assert "__stack_chk_fail" in readelf("--dyn-syms", binary)


def test_copies_are_checked():
    if not built_with_guards():
        pytest.skip("no hardened Release build")
    assert re.search(r"__(mem|str|read|v?f?s?n?printf)\w*_chk\b", readelf("--dyn-syms", PROGRAM))


def test_flags_are_those_of_every_source():
    """Small binaries do not show every flag: the test reads the compile commands."""
    if not built_with_guards():
        pytest.skip("no hardened Release build")
    wanted = ["-fstack-protector-strong", "-fstack-clash-protection", "-D_FORTIFY_SOURCE="]
    if platform.machine() == "x86_64":
        wanted.append("-fcf-protection")
    commands = (BUILD / "compile_commands.json").read_text().splitlines()
    ours = [line for line in commands if '"command"' in line and re.search(r" -c \S*/Unity/unity_", line)]
    assert ours
    assert not [line for line in ours if not all(flag in line for flag in wanted)]
