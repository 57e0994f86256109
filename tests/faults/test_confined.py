# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Libraries parse files in a process without rights: a library under an attacker's control does no harm there, and its
crash is reported as one line."""
import os
import pathlib
import pty
import resource
import select
import signal
import subprocess
import time

import pytest

import cases
import interposed

HOSTILE = interposed.INTERPOSER.with_name("libmeshorder_hostile.so")
LIBRARIES = {"exo": "netCDF", "med": "HDF5", "cgns": "CGNS", "vtkhdf": "HDF5", "xdmf": "HDF5"}
CRASHES = ("crash", "give back nonsense", "abort")
ATTACKS = ("read", "write", "cut", "remove", "rename", "link", "hard link", "make a folder", "change the mode",
           "use the network", "use a local socket", "start a process", "start a program", "signal the parent",
           "trace the parent")


def landlock():
    """The kernel's version of Landlock; 0 for none."""
    import ctypes
    libc = ctypes.CDLL(None, use_errno=True)
    return max(0, libc.syscall(444, None, 0, 1))


def run(folder, *arguments, hostile=None, path="", seconds=None, **options):
    """Runs the command with the attack `hostile` in its libraries, within `seconds` of processor time."""
    environment = dict(os.environ)
    if hostile is not None:
        environment |= {"LD_PRELOAD": str(HOSTILE), "HOSTILE": hostile, "HOSTILE_PATH": str(path)}

    def limit():
        if seconds is not None:
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, resource.RLIM_INFINITY))

    options = {"stdin": subprocess.DEVNULL, "env": environment, **options}
    return subprocess.run([interposed.MESHORDER, *map(str, arguments)], cwd=folder, capture_output=True, text=True,
                          timeout=interposed.SECONDS, check=False, preexec_fn=limit, **options)


@pytest.fixture(params=LIBRARIES)
def extension(request, tmp_path):
    cases.solid(request.param)(tmp_path)
    return request.param


@pytest.fixture
def med(tmp_path):
    cases.solid("med")(tmp_path)
    return tmp_path


def one_line(done, mesh, *words):
    """Asserts that a run ended with one line of error that has these words."""
    lines = done.stderr.splitlines()
    assert done.returncode == 2 and len(lines) == 1 and done.stdout == "", (done.returncode, done.stdout, done.stderr)
    assert lines[0].startswith(f"meshorder: {mesh}: "), lines[0]
    for word in words:
        assert word in lines[0]


@pytest.mark.parametrize("how", CRASHES)
def test_a_crash_is_one_line(extension, tmp_path, how):
    before = interposed.contents(tmp_path)
    for arguments in (["info"], ["order", "-o", f"out.{extension}", "--maps", "m"]):
        done = run(tmp_path, *arguments, f"mesh.{extension}", hostile=how)
        one_line(done, f"mesh.{extension}", f"the library {LIBRARIES[extension]} crashed", "damaged")
    assert interposed.contents(tmp_path) == before


def test_a_library_that_is_not_there_is_one_line(extension, tmp_path):
    before = interposed.contents(tmp_path)
    for arguments, named in ((["info"], "mesh"), (["order", "-o", f"out.{extension}"], "out")):
        done = run(tmp_path, *arguments, f"mesh.{extension}", hostile="be absent")
        one_line(done, f"{named}.{extension}", LIBRARIES[extension], "could not be loaded (libabsent.so.1", "install it")
    assert interposed.contents(tmp_path) == before


def test_a_crash_is_the_users_where_files_are_trusted(med):
    assert run(med, "info", "mesh.med", "--trust", hostile="crash").returncode == -signal.SIGSEGV


@pytest.mark.parametrize("how", ["loop", "wait"])
def test_what_never_ends_is_one_line(med, how):
    began = time.monotonic()
    done = run(med, "order", "mesh.med", "-o", "out.med", hostile=how, seconds=1)
    one_line(done, "mesh.med", "HDF5 did not finish reading it within 1 s", "damaged")
    assert time.monotonic() - began < 30
    assert not (med / "out.med").exists() and not list(med.glob(".meshorder*"))


def victim(folder, attack):
    """A file outside of the command's reach, or a free name."""
    elsewhere = folder.with_name(folder.name + "-elsewhere")
    elsewhere.mkdir(exist_ok=True)
    path = elsewhere / "file"
    path.unlink(missing_ok=True)
    if attack not in ("write", "link", "make a folder"):
        path.write_text("of the user\n")
        path.chmod(0o600)
    return path


@pytest.mark.parametrize("attack", ATTACKS)
def test_an_attack_fails(extension, tmp_path, attack):
    """The process has no rights: the attack fails, the user's files stay the same, and the mesh is read nevertheless."""
    if attack in ("read", "write", "remove", "rename", "link", "hard link", "make a folder") and landlock() < 2:
        pytest.skip("this kernel has no Landlock, or one without hard links")
    path = victim(tmp_path, attack)
    before = interposed.contents(path.parent)
    done = run(tmp_path, "info", f"mesh.{extension}", "-q", hostile=attack, path=path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(f"hostile: {attack}: "), done.stdout
    assert interposed.contents(path.parent) == before
    if path.exists():
        assert path.stat().st_mode & 0o777 == 0o600


@pytest.mark.parametrize("attack", ATTACKS)
def test_an_attack_on_who_trusts_succeeds(med, attack):
    """Otherwise the test above would prove nothing."""
    done = run(med, "info", "mesh.med", "-q", "--trust", hostile=attack, path=victim(med, attack))
    assert done.stdout == ("" if attack == "start a program" else f"hostile: {attack} done\n")


def test_nothing_is_typed_into_the_terminal(med):
    control, terminal = pty.openpty()
    done = run(med, "info", "mesh.med", "-q", hostile="type", stdin=terminal, start_new_session=True)
    os.close(control)
    os.close(terminal)
    assert done.stdout == "hostile: type: Operation not permitted\n"


@pytest.mark.skipif(landlock() < 1, reason="this kernel has no Landlock")
@pytest.mark.parametrize("place", ["beside the mesh", "over the mesh", "beside the output", "over the output"])
def test_an_attack_reaches_no_file_beside_inputs_and_outputs(med, place):
    (med / "out").mkdir()
    (med / "out" / "out.med").write_text("old")
    path = {"beside the mesh": "new", "over the mesh": "mesh.med", "beside the output": "out/new",
            "over the output": "out/out.med"}[place]
    before = interposed.contents(med)
    for attack in ("write", "remove", "rename"):
        done = run(med, "order", "mesh.med", "-o", "out/out.med", "-q", hostile=attack, path=path)
        assert done.returncode == 0 and done.stdout.startswith(f"hostile: {attack}: "), (done.stdout, done.stderr)
        after = interposed.contents(med)
        assert {**after, "out/out.med": before["out/out.med"]} == before


@pytest.mark.parametrize("name", [".ncrc", ".dodsrc", ".daprc"])
def test_settings_of_netcdf_in_the_folder_are_not_read(tmp_path, name):
    cases.solid("exo")(tmp_path)
    os.mkfifo(tmp_path / name)
    done = run(tmp_path, "info", "mesh.exo", env={**os.environ, "HOME": str(tmp_path)})
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signals_end_both_processes(med, number):
    environment = {**os.environ, "LD_PRELOAD": str(HOSTILE), "HOSTILE": "wait"}
    with subprocess.Popen([interposed.MESHORDER, "order", "mesh.med", "-o", "out.med"], cwd=med, env=environment,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while not children.read_text().split():
            time.sleep(0.01)
        child = children.read_text().split()[0]
        status = pathlib.Path(f"/proc/{child}/status")
        while "State:\tS" not in status.read_text():
            time.sleep(0.01)
        process.send_signal(number)
        _, stderr = process.communicate(timeout=120)
    assert process.returncode == -number
    assert stderr == f"meshorder: stopped by {number.name}; unfinished outputs are removed\n"
    assert not pathlib.Path(f"/proc/{child}").exists()
    assert sorted(path.name for path in med.iterdir()) == ["mesh.med"]


def test_a_killed_command_leaves_no_process(med):
    environment = {**os.environ, "LD_PRELOAD": str(HOSTILE), "HOSTILE": "wait"}
    with subprocess.Popen([interposed.MESHORDER, "info", "mesh.med"], cwd=med, env=environment,
                          stdin=subprocess.DEVNULL) as process:
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while not children.read_text().split():
            time.sleep(0.01)
        child = pathlib.Path(f"/proc/{children.read_text().split()[0]}")
        process.kill()
        process.wait()
    ends = time.monotonic() + 10
    while child.exists() and "State:\tZ" not in (child / "status").read_text() and time.monotonic() < ends:
        time.sleep(0.01)
    assert not child.exists() or "State:\tZ" in (child / "status").read_text()


@pytest.mark.parametrize("arguments", [["order", "-o", "out.med"], ["info"], ["compare"]], ids=lambda words: words[0])
def test_progress_is_drawn_while_a_child_works(med, arguments):
    environment = {**os.environ, "LD_PRELOAD": str(HOSTILE), "HOSTILE": "wait"}
    control, terminal = pty.openpty()
    with subprocess.Popen([interposed.MESHORDER, *arguments, "mesh.med"], cwd=med, env=environment,
                          stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=terminal) as process:
        os.close(terminal)
        drawn = os.read(control, 1000) if select.select([control], [], [], 60)[0] else b""
        process.kill()
    os.close(control)
    assert drawn.startswith(b"\rreading mesh.med, ")


def test_companions_and_maps_are_reached(tmp_path):
    """The values beside an XDMF file, maps in another folder, a report, and links that the user names."""
    cases.solid("xdmf")(tmp_path)
    (tmp_path / "maps").mkdir()
    (tmp_path / "link.xdmf").symlink_to("mesh.xdmf")
    for arguments in (["order", "mesh.xdmf", "-o", "out.node", "--maps", "maps/m"],
                      ["apply", "maps/m", "mesh.xdmf", "-o", "again.xdmf"],
                      ["apply", "maps/m", "out.node", "-o", "back.med", "--inverse"],
                      ["info", "link.xdmf"],
                      ["report", "mesh.xdmf", "-o", "page.html", "--budget", "0.1"]):
        done = run(tmp_path, *arguments, env={**os.environ, "MESHORDER_MACHINE": "zen3"})
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "page.html").stat().st_size > 10000
    assert not list(tmp_path.rglob(".meshorder*"))
