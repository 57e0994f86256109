# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""What all tests below this folder share: Gmsh's module, and the reasons for which a test may be skipped in CI."""
import importlib.util
import os
import pathlib
import re
import sys

import pytest

PYTHON = f"python{sys.version_info.major}.{sys.version_info.minor}"
GMSH = pathlib.Path(__file__).resolve().parents[1] / "build" / "venv" / "lib" / PYTHON / "site-packages" / "gmsh.py"

#: What a machine on which ./test has installed its packages may lack. Any other skip fails where CI is set.
EXPECTED_SKIPS = re.compile("|".join([
    # programs that Debian 12 does not have or that ./test does not install
    "needs OpenFOAM", r"no clang\+\+", "no zsh", "no fish",
    # rights of the user, and the kernel and file system
    "root may write everywhere", "needs root, who", "needs rights that this user does not have", "needs the right to mount",
    "this kernel has no Landlock", "the file system has no",
    # builds with sanitizers
    "sanitizers take memory of their own",
    # where the test is done otherwise
    "compiled by tests/io", "it was done before it could be stopped",
]))


class GmshOfVenv:
    """Finds Gmsh's module in build/venv for Debian's Python: only this module, as the other packages differ."""

    @staticmethod
    def find_spec(name, path=None, target=None):
        return importlib.util.spec_from_file_location(name, GMSH) if name == "gmsh" and GMSH.exists() else None


sys.meta_path.append(GmshOfVenv)


def refuse_skip(report):
    """Makes a failure of an unexpected skip in CI, where a missing package would otherwise hide a test for good."""
    if report.outcome != "skipped" or hasattr(report, "wasxfail") or not os.environ.get("CI"):
        return
    reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
    if not EXPECTED_SKIPS.search(reason):
        report.outcome = "failed"
        report.longrepr = f"{reason}\nIn CI, tests are skipped only for the reasons that tests/conftest.py lists."


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport():
    outcome = yield
    refuse_skip(outcome.get_result())


@pytest.hookimpl(hookwrapper=True)
def pytest_make_collect_report():
    outcome = yield
    refuse_skip(outcome.get_result())
