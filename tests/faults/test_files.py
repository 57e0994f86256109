# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""One call after another that reads or writes files fails: the command reports it and leaves the old or the new files."""
import errno
import gzip
import itertools
import json
import os
import resource
import signal
import subprocess

import pytest

import cases
import interposed
from interposed import Fault, spread

KINDS = ("open", "read", "write", "sync", "close", "rename", "thread")


def failures_of(case, most, every_error):
    """Lets calls of each kind fail, at most `most` of a kind. Returns the number of failures, and the faults of each run."""
    failed, wrong = 0, {}
    for kind in KINDS:
        errors = itertools.cycle(interposed.ERRORS[kind])
        for nth in spread(case.clean.calls[kind], min(most, case.line.most)):
            for what in interposed.ERRORS[kind] if every_error else [next(errors)]:
                fault = Fault(kind, nth, what)
                ending = case.with_fault(fault)
                failed += ending.failures > 0
                # libhdf5 crashes when it copies data that it could not read
                faults = list(case.faults_of_files() if ending.culprit() else case.faults_of(ending, kind))
                if what == "short" and ending.status != 0 and not ending.culprit():
                    faults.append(f"does not go on where a part was done: {ending.stderr!r}")
                if faults:
                    wrong[str(fault)] = faults
    return failed, wrong


def shown(name, failed, wrong):
    line = f"{name}: {failed} calls failed, {len(wrong)} ended badly"
    return "\n".join([line, *(f"  {fault}: {'; '.join(faults)}" for fault, faults in list(wrong.items())[:8])])


@pytest.mark.parametrize("name", cases.COMMANDS)
def test_a_call_that_fails_is_reported(tmp_path, name):
    case = cases.case(name, tmp_path)
    failed, wrong = failures_of(case, 5, every_error=False)
    assert failed or name == "methods"
    assert not wrong, shown(name, failed, wrong)


@pytest.mark.long
@pytest.mark.parametrize("name", cases.COMMANDS)
def test_every_call_that_fails_is_reported(tmp_path, name):
    case = cases.case(name, tmp_path)
    failed, wrong = failures_of(case, 60, every_error=True)
    print(shown(name, failed, wrong))
    assert not wrong, shown(name, failed, wrong)


@pytest.mark.parametrize("name", ["node in place", "vtu in place", "med in place", "order with maps"])
def test_a_call_that_a_signal_interrupts_is_repeated(tmp_path, name):
    case = cases.case(name, tmp_path)
    for kind in ("read", "write"):
        for nth in spread(case.clean.calls[kind], 4):
            ending = case.with_fault(Fault(kind, nth, errno.EINTR))
            assert ending.status == 0, (kind, nth, ending.stderr)
            assert not list(case.faults_of(ending))


@pytest.mark.parametrize("name", ["order with maps", "vtu in place", "cgns in place", "med in place", "exo in place"])
def test_what_a_failing_disk_leaves_unread_is_no_mesh(tmp_path, name):
    """Every read from the nth on fails: the part read before must not be taken for the mesh."""
    case = cases.case(name, tmp_path)
    for nth in spread(case.clean.calls["read"], 6):
        ending = case.with_fault(Fault("read", nth, errno.EIO, later=True))
        # libhdf5 crashes when it copies data that it could not read
        faults = list(case.faults_of_files() if ending.culprit() else case.faults_of(ending))
        assert not faults, (nth, faults)
        if ending.status == 0:  # only reads of the system's description failed, which the command does not need
            assert not list(case.faults_of_set("new"))


@pytest.mark.parametrize("name", ("order with maps", "node in place", "xdmf in place", "simulate", "openfoam"))
@pytest.mark.parametrize("bytes_", [0, 1, 100, 1000])
@pytest.mark.parametrize("ignored", [False, True], ids=["SIGXFSZ", "EFBIG"])
def test_a_limit_on_file_sizes_is_reported(tmp_path, name, bytes_, ignored):
    case = cases.case(name, tmp_path)

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_, bytes_))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN if ignored else signal.SIG_DFL)

    case.restore()
    # without the interposer, since the limit holds for its log, too
    done = subprocess.run([interposed.MESHORDER, *map(str, case.arguments)], cwd=case.folder, preexec_fn=limit, text=True,
                          capture_output=True, stdin=subprocess.DEVNULL, timeout=interposed.SECONDS, check=False)
    told = done.returncode == -signal.SIGXFSZ and "SIGXFSZ" in done.stderr  # the command cleans up, then ends by the signal
    ending = interposed.Ending(2 if told else done.returncode, "", done.stderr, {}, 0, "")
    assert not list(case.faults_of(ending))


@pytest.mark.parametrize("given", [".exo", ".med", ".cgns"])
@pytest.mark.parametrize("wanted", [".vtkhdf", ".xdmf", ".med", ".cgns", ".exo"])
def test_libraries_that_cannot_complete_a_file_end_well(tmp_path, given, wanted):
    """libhdf5 crashes when it tries again at the end of the process, whichever library called it first."""
    made = subprocess.run([interposed.MESHORDER, "models", "make", "ball", "--size", "6", "--json"], check=True, capture_output=True)
    ball = json.loads(made.stdout)["models"][0]["path"]
    for name in ("a" + given, "whole" + wanted):
        subprocess.run([interposed.MESHORDER, "order", ball, "-o", tmp_path / name, "-q"], check=True)
    size = max(path.stat().st_size for path in tmp_path.glob("whole*"))
    before = sorted(path.name for path in tmp_path.iterdir())
    for share in (0.05, 0.3, 0.6, 0.9):
        def limit(most=int(share * size)):
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

        done = subprocess.run([interposed.MESHORDER, "order", "a" + given, "-o", "b" + wanted], cwd=tmp_path, preexec_fn=limit,
                              text=True, capture_output=True, timeout=interposed.SECONDS, check=False)
        assert done.returncode == 2, (share, done.returncode, done.stderr)
        assert len([line for line in done.stderr.splitlines() if "b." in line]) == 1, done.stderr
        assert sorted(path.name for path in tmp_path.iterdir()) == before


def mounted(folder, size):
    """Mounts a small file system, and returns whether this was possible."""
    folder.mkdir()
    return subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", folder], check=False,
                          capture_output=True).returncode == 0


@pytest.fixture
def small_disk(tmp_path):
    """A file system of few pages; skips the test if none can be mounted."""
    folder = tmp_path / "disk"
    if not mounted(folder, "256k"):
        pytest.skip("needs the right to mount a file system")
    yield folder
    subprocess.run(["umount", folder], check=True)


@pytest.mark.parametrize("name", ("order with maps", "node in place", "xdmf in place", "simulate", "openfoam"))
def test_a_full_disk_is_reported(tmp_path, small_disk, name):
    """With each number of free pages, from 0 on, the disk becomes full at another file."""
    case = cases.case(name, tmp_path)
    case.folder = small_disk / "work"
    statuses = []
    page = os.sysconf("SC_PAGE_SIZE")
    for free in range(12):
        filling = small_disk / "filling"
        filling.unlink(missing_ok=True)
        case.restore()
        space = os.statvfs(small_disk).f_bavail * page
        filling.write_bytes(bytes(max(0, space - free * page)))
        ending = interposed.run(case.arguments, case.folder, log=tmp_path / "log")
        statuses.append(ending.status)
        filling.unlink()  # the check of the files needs room
        assert not list(case.faults_of(ending)), (free, list(case.faults_of(ending)))
        assert ending.status in (0, 2) and (ending.status == 0 or "full" in ending.stderr), ending.stderr
    assert statuses[0] == 2


def test_a_full_folder_for_temporary_files_is_reported(tmp_path, small_disk, monkeypatch):
    """Compressed CGNS files are unpacked into this folder for libcgns."""
    work = tmp_path / "work"
    work.mkdir()
    cases.write_cube(work, 8)
    made = interposed.run(["order", "mesh.node", "-o", "mesh.cgns"], work)
    assert made.status == 0, made.stderr
    (work / "mesh.cgns.gz").write_bytes(gzip.compress((work / "mesh.cgns").read_bytes()))
    line = ["order", "mesh.cgns.gz", "-o", "new.cgns"]
    monkeypatch.setenv("TMPDIR", str(small_disk))
    assert (work / "mesh.cgns").stat().st_size < os.statvfs(small_disk).f_bavail * os.statvfs(small_disk).f_frsize
    assert interposed.run(line, work).status == 0
    (work / "new.cgns").unlink()
    before = interposed.contents(work)
    filling = small_disk / "filling"
    filling.write_bytes(bytes(os.statvfs(small_disk).f_bavail * os.statvfs(small_disk).f_frsize - os.sysconf("SC_PAGE_SIZE")))
    ending = interposed.run(line, work, log=tmp_path / "log")
    assert ending.status == 2 and "TMPDIR" in ending.stderr and ending.stderr.count("\n") == 1, ending.stderr
    assert interposed.contents(work) == before
    assert list(small_disk.iterdir()) == [filling]
