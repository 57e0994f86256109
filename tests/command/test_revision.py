# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The git revision that a build records: cmake/revision.cmake in checkouts made for it."""
import re
import shutil
import subprocess

import pytest

import conftest

SCRIPT = conftest.ROOT / "cmake" / "revision.cmake"
TEMPLATE = conftest.ROOT / "lab" / "support" / "revision.cpp.in"
pytestmark = pytest.mark.skipif(not shutil.which("cmake") or not shutil.which("git"), reason="needs cmake and git")


def git(folder, *arguments):
    identity = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org", "-c", "commit.gpgsign=false"]
    return subprocess.run(["git", "-C", str(folder), *identity, *arguments], check=True, capture_output=True,
                          text=True).stdout.strip()


def revision(folder):
    """The revision that a build of the sources in that folder records."""
    output = folder.parent / "revision.cpp"
    subprocess.run(["cmake", f"-DSOURCE={folder}", f"-DTEMPLATE={TEMPLATE}", f"-DOUTPUT={output}", "-P", str(SCRIPT)],
                   check=True, capture_output=True)
    return re.search(r'return "(.*)"', output.read_text()).group(1)


@pytest.fixture
def checkout(tmp_path):
    folder = tmp_path / "a checkout"
    (folder / "src").mkdir(parents=True)
    (folder / "docs").mkdir()
    (folder / "src" / "a.cpp").write_text("int a;\n")
    (folder / "docs" / "a.md").write_text("a\n")
    git(tmp_path, "init", "-q", str(folder))
    git(folder, "add", ".")
    git(folder, "commit", "-qm", "first")
    return folder


def test_a_checkout_has_the_revision_of_its_commit(checkout):
    assert revision(checkout) == git(checkout, "rev-parse", "HEAD")
    (checkout / "docs" / "a.md").write_text("b\n")  # no part of a program
    assert revision(checkout) == git(checkout, "rev-parse", "HEAD")


def test_changes_are_distinguished(checkout):
    commit = git(checkout, "rev-parse", "HEAD")
    seen = set()
    for text in ("int b;\n", "int c; // ; [ ]\n"):
        (checkout / "src" / "a.cpp").write_text(text)
        changed = revision(checkout)
        assert re.fullmatch(commit + r"\+[0-9a-f]{8}", changed)
        assert revision(checkout) == changed
        seen.add(changed)
    assert len(seen) == 2
    git(checkout, "commit", "-qam", "second")
    assert revision(checkout) == git(checkout, "rev-parse", "HEAD") != commit


def test_the_source_is_written_only_when_the_revision_changes(checkout):
    revision(checkout)
    before = (checkout.parent / "revision.cpp").stat().st_mtime_ns
    revision(checkout)
    assert (checkout.parent / "revision.cpp").stat().st_mtime_ns == before


def test_sources_from_a_tarball_have_none_even_within_another_checkout(checkout, tmp_path):
    unpacked = checkout / "vendor"
    shutil.copytree(checkout / "src", unpacked / "src")
    (tmp_path / "plain").mkdir()
    for folder in (unpacked, tmp_path / "plain"):
        assert revision(folder) == ""


def test_only_one_source_has_the_revision():
    """If other sources included the revision, each commit would compile them again, without hits in ccache."""
    said = [path.relative_to(conftest.ROOT).as_posix() for folder in ("src", "lab", "apps", "include")
            for path in (conftest.ROOT / folder).rglob("*") if path.is_file()
            and re.search(r'support/revision\.hpp"|@REVISION@', path.read_text(errors="replace"))]
    assert sorted(said) == ["lab/support/machine.cpp", "lab/support/revision.cpp.in"]
