# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files by others do no harm: reading changes nothing, and no output follows a planted link."""
import json
import os
import shutil
import stat
import subprocess

import pytest

import conftest
import foam_cases
import meshes
from test_outputs import snapshot

LINK = "is a symbolic link, and links are followed only in names that you give; remove it or choose another name"
SCENARIO = {
    "name": "fall", "title": "A small body falls", "mesh": "mesh.node",
    "material": {"model": "corotational", "young": 1e5, "poisson": 0.3, "density": 1000},
    "integrator": {"time_step": 0.01}, "steps": 8,
}


@pytest.fixture
def mesh(tmp_path):
    return meshes.write_tetgen(tmp_path).name


@pytest.fixture
def precious(tmp_path_factory):
    """A folder of files that the command must not change."""
    folder = tmp_path_factory.mktemp("precious")
    for name in ("lock", "old", "new", "thesis.tex"):
        (folder / name).write_text("mine")
    before = snapshot(folder)
    yield folder
    assert snapshot(folder) == before


def hash_of(name):
    """The hash in the names of hidden folders of an earlier version."""
    value = 0xCBF29CE484222325
    for word in (len(name), *name.encode()):
        value = (((value ^ word) * 0x100000001B3) % 2**64) ^ (value >> 32)
    return f"{value:016x}"


def plant(folder, names, precious):
    """Makes hidden folders with names that this or an earlier version uses, and with malicious content."""
    for name in names:
        left = folder / f".meshorder-{hash_of(name)}.set"
        left.mkdir()
        (left / "lock").touch()
        (left / "set").write_text(left.name)
        (left / "new").write_text("a stranger's")
        entries = [("w", left.name, precious / "thesis.tex"), ("r", left.name, precious / "old"), ("c", precious, "none")]
        (left / "journal").write_text("".join(f"{step}{scratch}\0{target}\0" for step, scratch, target in entries))
    dead = folder / ".meshorder-0123456789abcdef.new"
    dead.mkdir()
    for name in ("lock", "old", "thesis.tex"):
        (dead / name).write_text("a stranger's")
    (dead / "new").symlink_to(precious / "thesis.tex")
    (folder / ".meshorder-1123456789abcdef.new").symlink_to(precious)
    pipes = folder / ".meshorder-2123456789abcdef.new"
    pipes.mkdir()
    os.mkfifo(pipes / "lock")


READING = {
    "info": ("info", "mesh.node"),
    "info of another": ("info", "mesh.vtu", "--json"),
    "compare": ("compare", "mesh.node", "--methods", "rcm", "--budget", "0.01"),
    "openfoam": ("openfoam", "case", "--dry-run"),
    "methods": ("methods",),
    "scenarios": ("simulate", "--list"),
    "simulate": ("simulate", "fall.json"),
    "machines": ("calibrate", "--list"),
    "models": ("models", "list"),
}


@pytest.mark.parametrize("name", READING)
def test_reading_changes_nothing(command, tmp_path, mesh, precious, name, monkeypatch):
    command.ok("order", mesh, "-o", "mesh.vtu", "--maps", "m", "-q")
    foam_cases.write_case(tmp_path / "case", foam_cases.block(2, 2, 2))
    (tmp_path / "fall.json").write_text(json.dumps(SCENARIO))
    (tmp_path / "cache").mkdir()
    monkeypatch.setenv("MESHORDER_CACHE", str(tmp_path / "cache"))
    plant(tmp_path, ("mesh.node", "mesh.ele", "mesh.vtu", "m.maps.json", "fall.json"), precious)
    before = snapshot(tmp_path)
    command.ok(*READING[name])
    assert snapshot(tmp_path) == before


def test_writing_removes_no_files_of_others(command, tmp_path, mesh, precious):
    """The command does not wait at the pipe either."""
    plant(tmp_path, ("mesh.node", "out.node"), precious)
    before = snapshot(tmp_path)
    command.ok("order", mesh, "-o", "out.node", "-q")
    after = snapshot(tmp_path)
    gone = set(before) - set(after)
    assert gone == {*(f".meshorder-0123456789abcdef.new/{name}" for name in ("lock", "old", "new")),
                    ".meshorder-2123456789abcdef.new", ".meshorder-2123456789abcdef.new/lock"}
    assert (tmp_path / ".meshorder-0123456789abcdef.new/thesis.tex").read_text() == "a stranger's"


# the name of a link, and a command that writes to that name although the user typed another one
DERIVED = {
    "tetgen": ("out.ele", ("order", "mesh.node", "-o", "out.node")),
    "tetgen by its cells": ("out.node", ("order", "mesh.node", "-o", "out.ele")),
    "xdmf": ("out.h5", ("order", "mesh.node", "-o", "out.xdmf")),
    "order of maps": ("m.vertices.old_to_new.npy", ("order", "mesh.node", "-o", "out.vtu", "--maps", "m")),
    "inverse of maps": ("m.cells.new_to_old.npy", ("order", "mesh.node", "-o", "out.vtu", "--maps", "m")),
    "maps": ("m.maps.json", ("order", "mesh.node", "-o", "out.vtu", "--maps", "m")),
    "openfoam": ("case/constant/cellOrder", ("openfoam", "case")),
    "openfoam's dictionary": ("case/system/renumberMeshDict", ("openfoam", "case", "--force")),
    "frames": ("frames/fall.pvd", ("simulate", "fall.json", "--vtk", "frames")),
    "a frame": ("frames/fall-000000.vtu", ("simulate", "fall.json", "--vtk", "frames")),
    "report": ("study/report.html", ("report", "study")),
    "tables": ("study/tables.md", ("report", "study")),
    "report of a mesh": ("report.html", ("report", "mesh.node", "--budget", "0.01")),
    "comparison of that name": ("comparison.html", ("report", "study", "study")),
    "comparison": ("two.csv", ("report", "study", "study", "-o", "two.html")),
}


@pytest.mark.parametrize("name", DERIVED)
@pytest.mark.parametrize("target", ["thesis.tex", "none"])
def test_links_are_not_followed_in_derived_names(command, tmp_path, mesh, precious, name, target):
    link, arguments = DERIVED[name]
    foam_cases.write_case(tmp_path / "case", foam_cases.block(2, 2, 2))
    (tmp_path / "fall.json").write_text(json.dumps(SCENARIO))
    (tmp_path / "frames").mkdir()
    (tmp_path / "study").mkdir()
    shutil.copy(conftest.ROOT / "docs/reproduction/results.json", tmp_path / "study")
    (tmp_path / link).unlink(missing_ok=True)
    (tmp_path / link).symlink_to(precious / target)
    before = snapshot(tmp_path)
    assert f"{link}: {LINK}" in command.run(*arguments, "-q").stderr
    after = snapshot(tmp_path)
    changed = {path for path in set(before) | set(after) if before.get(path) != after.get(path)}
    # a simulation may have written frames before it met the link; folders changed as they held unfinished files
    assert not {path for path in changed if not path.startswith("frames") and not (tmp_path / path).is_dir()}


@pytest.mark.parametrize("folder", ["case/constant", "case/system"])
def test_folders_that_are_links_are_not_followed(command, tmp_path, precious, folder):
    foam_cases.write_case(tmp_path / "case", foam_cases.block(2, 2, 2))
    (tmp_path / "case/system").mkdir(exist_ok=True)
    (tmp_path / folder).rename(tmp_path / "moved")
    (tmp_path / folder).symlink_to(tmp_path / "moved")
    before = snapshot(tmp_path / "moved")
    assert f"{folder}: {LINK}" in command.fails("openfoam", "case", "-q")
    assert snapshot(tmp_path / "moved") == before


def test_links_are_followed_in_names_that_the_user_types(command, tmp_path, mesh):
    (tmp_path / "store").mkdir()
    (tmp_path / "link.node").symlink_to("store/real.node")
    command.ok("order", mesh, "-o", "link.node", "-q")
    assert (tmp_path / "link.node").is_symlink() and (tmp_path / "store/real.node").is_file()
    assert (tmp_path / "link.ele").is_file()
    foam_cases.write_case(tmp_path / "real case", foam_cases.block(2, 2, 2))
    (tmp_path / "case").symlink_to("real case")
    command.ok("openfoam", "case", "-q")
    assert (tmp_path / "real case/constant/cellOrder").is_file()


def test_derived_names_are_no_pipes(command, tmp_path, mesh):
    os.mkfifo(tmp_path / "out.ele")
    assert "out.ele: is not an ordinary file" in command.fails("order", mesh, "-o", "out.node")


def test_a_study_removes_what_it_made_alone(command, tmp_path, mesh):
    (tmp_path / "fall.json").write_text(json.dumps(SCENARIO))
    data = tmp_path / "project/data"
    data.mkdir(parents=True)
    for name in (".env", ".gitignore", ".rcm-fall-motion.npy"):
        (data / name).write_text("mine")
    left = data / ".meshorder-0123456789abcdef.new"
    left.mkdir()
    for name in ("lock", "new"):
        (left / name).touch()
    command.ok("reproduce", "--scenario", "fall.json", "--runs", "1", "--budget", "0.05", "--no-pin", "--threads", "1", "-o",
               "project", "-q")
    for name in (".env", ".gitignore", ".rcm-fall-motion.npy"):
        assert (data / name).read_text() == "mine"
    assert not left.exists() and (data / "fall-motion.npy").is_file()
    assert not [path for path in data.iterdir() if path.name.startswith(".meshorder")]


def test_a_study_goes_through_a_link_that_the_user_names(command, tmp_path, mesh):
    (tmp_path / "fall.json").write_text(json.dumps(SCENARIO))
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "results").symlink_to("elsewhere")
    arguments = ("reproduce", "--scenario", "fall.json", "--runs", "1", "--budget", "0.05", "--no-pin", "-q")
    assert f"results: {LINK}" in command.fails(*arguments)
    assert not list((tmp_path / "elsewhere").iterdir())
    command.ok(*arguments, "-o", "results")
    assert (tmp_path / "elsewhere/report.html").is_file()


def test_a_study_goes_through_no_link(command, tmp_path, mesh, precious):
    (tmp_path / "fall.json").write_text(json.dumps(SCENARIO))
    (tmp_path / "project").mkdir()
    (tmp_path / "project/data").symlink_to(precious)
    line = command.fails("reproduce", "--scenario", "fall.json", "--runs", "1", "--budget", "0.05", "--no-pin", "-o", "project",
                         "-q")
    assert f"project/data: {LINK}" in line


def test_a_calibration_is_written_through_no_link(command, tmp_path, precious, monkeypatch):
    cache = tmp_path / "cache"
    monkeypatch.setenv("MESHORDER_CACHE", str(cache))
    command.ok("calibrate", "--budget", "0.2", "-q")
    (file,) = (cache / "calibrations").glob("*.json")
    assert stat.S_ISREG(file.lstat().st_mode)
    script = f'ln -s {precious}/thesis.tex {file}.$$.unfinished; exec "$@"'
    calibrate = [conftest.MESHORDER, "calibrate", "--budget", "0.2", "-q"]
    subprocess.run(["sh", "-c", script, "sh", *calibrate], cwd=tmp_path, check=True, stdin=subprocess.DEVNULL)
    file.unlink()
    file.symlink_to(precious / "thesis.tex")
    assert LINK.partition(";")[0] in command.run("calibrate", "--budget", "0.2").stderr


@pytest.mark.parametrize("arguments", [["models"], ["order", "mesh.off", "--parts", "2"]])
@pytest.mark.parametrize("has_proc", [True, False])
def test_no_program_of_the_present_folder_is_executed(tmp_path, arguments, has_proc):
    """The command runs the programs beside its own file, not those in the current folder or beside a link to it."""
    for name in ("meshorder-lab", "meshorder-mpi"):
        planted = tmp_path / name
        planted.write_text("#!/bin/sh\necho planted\n")
        planted.chmod(0o755)
    (tmp_path / "meshorder").symlink_to(conftest.MESHORDER)
    command = ["./meshorder", *arguments]
    if not has_proc:  # as in a bare chroot
        command = ["unshare", "--mount", "sh", "-c", 'mount -t tmpfs none /proc && exec "$0" "$@"', *command]
        if subprocess.run(["unshare", "--mount", "true"], check=False, capture_output=True).returncode:
            pytest.skip("unshare needs rights that this user does not have")
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    assert "planted" not in done.stdout
    if not has_proc:
        assert done.returncode == 2 and "beside" in done.stderr and done.stderr.count("\n") == 1, done.stderr
