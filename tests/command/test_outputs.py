# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Outputs are complete or absent, and those of one command belong together, however the command ends."""
import fcntl
import json
import os
import resource
import shutil
import signal
import stat
import struct
import subprocess
import threading
import time

import pytest

import conftest
import meshes

# Replaces the FAULT_NUMBERth system call of the name FAULT_CALL: FAULT is `kill`, which kills the process before the
# call, `error`, or `pause`, which creates the file FAULT_MARK and waits.
INTERPOSER = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int faulty(const char* call) {
  static int count = 0;
  const char* wanted = getenv("FAULT_CALL");
  if (wanted == NULL || strcmp(wanted, call) != 0 || ++count != atoi(getenv("FAULT_NUMBER"))) return 0;
  if (strcmp(getenv("FAULT"), "kill") == 0) kill(getpid(), SIGKILL);
  if (strcmp(getenv("FAULT"), "pause") == 0) {
    close(creat(getenv("FAULT_MARK"), 0600));
    for (;;) pause();
  }
  errno = EIO;
  return 1;
}

int rename(const char* from, const char* to) {
  if (faulty("rename")) return -1;
  return ((int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename"))(from, to);
}

int unlink(const char* path) {
  if (faulty("unlink")) return -1;
  return ((int (*)(const char*))dlsym(RTLD_NEXT, "unlink"))(path);
}

int remove(const char* path) {
  if (faulty("unlink")) return -1;
  return ((int (*)(const char*))dlsym(RTLD_NEXT, "remove"))(path);
}

int fsync(int file) {
  if (faulty("fsync")) return -1;
  return ((int (*)(int))dlsym(RTLD_NEXT, "fsync"))(file);
}
"""


@pytest.fixture(scope="session")
def interposer(tmp_path_factory):
    folder = tmp_path_factory.mktemp("interposer")
    (folder / "faults.c").write_text(INTERPOSER)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", folder / "faults.so", folder / "faults.c", "-ldl"], check=True)
    return folder / "faults.so"


@pytest.fixture
def mark(tmp_path_factory):
    """The file that a command makes when it pauses."""
    return tmp_path_factory.mktemp("mark") / "paused"


@pytest.fixture
def faulty(tmp_path, interposer, mark):
    """Starts a command with a fault at a system call."""
    def start(fault, call, number, *arguments, **options):
        environment = {**os.environ, "LD_PRELOAD": str(interposer), "FAULT": fault, "FAULT_CALL": call,
                       "FAULT_NUMBER": str(number), "FAULT_MARK": str(mark)}
        return subprocess.Popen([conftest.MESHORDER, *map(str, arguments)], cwd=tmp_path, env=environment, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)

    return start


@pytest.fixture
def mesh(tmp_path):
    return meshes.write_tetgen(tmp_path).name


def content_of(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def unfinished_in(folder):
    """The outputs that a command has not yet moved into place; call it only while the command is paused."""
    return [path for path in folder.glob(".meshorder-*/new") if path.stat().st_size]


def wait_for(mark):
    end = time.monotonic() + 30
    while not mark.exists():
        assert time.monotonic() < end
        time.sleep(0.01)


ORDER = ("--vertices", "scrambled", "--elements", "scrambled", "--seed", "3", "--maps", "m", "-q")


def test_maps_that_cannot_be_written_leave_the_mesh(command, tmp_path, mesh):
    before = content_of(tmp_path)
    line = command.fails("order", mesh, "-o", mesh, "--vertices", "scrambled", "--maps", "nofolder/m")
    assert line == "meshorder: nofolder/m.maps.json: its folder does not exist; make nofolder first"
    assert content_of(tmp_path) == before


def states_of(folder, old, new):
    """The state of each file of a set, "old" or "new"; any other content is an error."""
    now = content_of(folder)
    assert set(now) <= set(old) | set(new)
    assert all(content in (old.get(name), new.get(name)) for name, content in now.items())
    return {"new" if now.get(name) == new.get(name) else "old" for name in set(old) | set(new)
            if old.get(name) != new.get(name)}


def snapshot(folder):
    """All that is in a folder: names, kinds, modes, times and contents."""
    return {str(path.relative_to(folder)): (path.lstat().st_mode, path.lstat().st_mtime_ns, path.lstat().st_ino,
                                            path.read_bytes() if stat.S_ISREG(path.lstat().st_mode) else None)
            for path in sorted(folder.rglob("*"))}


# a set of files, the command that writes it, and one that reads it
SETS = {
    "tetgen": ("out.node", (), ("info", "set/out.node")),
    "xdmf": ("out.xdmf", (), ("info", "set/out.xdmf")),
    "maps": ("../out.vtu", ("--maps", "set/m"), ("apply", "set/m", "from.vtu", "-o", "applied.vtu")),
}


@pytest.mark.parametrize("name", SETS)
def test_files_of_a_killed_command_are_all_old_or_all_new_or_refused(command, faulty, tmp_path, mesh, name):
    """The command is killed before each rename: files of two runs are never read as one set, and the next run succeeds."""
    target, options, reader = SETS[name]
    folder = tmp_path / "set"
    folder.mkdir()
    command.ok("order", mesh, "-o", "from.vtu", "-q")

    def order(seed):
        return ("order", "from.vtu", "-o", f"set/{target}", "--vertices", "scrambled", "--elements", "scrambled", "--seed",
                str(seed), *options, "-q")

    command.ok(*order(3))
    old = content_of(folder)
    command.ok(*order(4))
    new = content_of(folder)
    assert set(old) == set(new) and old != new
    mixtures = 0
    for number in range(1, 100):
        for path in folder.iterdir():
            path.unlink()
        for file, content in old.items():
            (folder / file).write_bytes(content)
        child = faulty("kill", "rename", number, *order(4))
        child.communicate()
        if child.returncode == 0:
            break
        assert child.returncode == -signal.SIGKILL
        before = snapshot(folder)
        if len(states_of(folder, old, new)) > 1:
            mixtures += 1
            assert "was not written together" in command.fails(*reader)
        else:
            command.ok(*reader)
        assert snapshot(folder) == before
        command.ok(*order(4))
        assert content_of(folder) == new and len(list(folder.iterdir())) == len(new)
    assert mixtures > 0


def test_maps_of_an_earlier_run_that_are_left_over_are_refused(command, tmp_path, mesh):
    """Maps that only some meshes have: the numbers of vertices and cells, and the list of kept cells."""
    command.ok("order", mesh, "-o", "out.vtu", "--maps", "m", "-q")
    np = pytest.importorskip("numpy")
    for kind in ("vertices.ids", "cells.ids", "cells.kept"):
        count = len(np.load(tmp_path / f"m.{kind.split('.')[0]}.old_to_new.npy"))
        left = tmp_path / f"m.{kind}.npy"
        np.save(left, np.arange(count, dtype=np.int64))
        assert "was not written together with these maps" in command.fails("apply", "m", mesh, "-o", "applied.vtu")
        left.unlink()
    command.ok("apply", "m", mesh, "-o", "applied.vtu")


@pytest.mark.parametrize("same", [False, True], ids=["other output", "in place"])
def test_many_commands_write_one_set_at_once(tmp_path, command, mesh, same):
    target = mesh if same else "out.node"
    children = [subprocess.Popen([conftest.MESHORDER, "order", mesh, "-o", target, "--vertices", "scrambled", "--elements",
                                  "scrambled", "--seed", str(seed), "-q"], cwd=tmp_path, text=True,
                                 stdin=subprocess.DEVNULL, stderr=subprocess.PIPE) for seed in range(20)]
    assert [child.communicate()[1] for child in children] == [""] * len(children)
    assert all(child.returncode == 0 for child in children)
    command.ok("info", target)
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")]


def test_a_folder_that_somebody_holds_locked_is_written_all_the_same(command, tmp_path, mesh):
    """The command waits for some seconds first."""
    holder = os.open(tmp_path, os.O_RDONLY)
    fcntl.flock(holder, fcntl.LOCK_EX)
    try:
        command.ok("order", mesh, "-o", "out.node", "-q")
    finally:
        os.close(holder)


@pytest.mark.parametrize("call", ["rename", "fsync"])
def test_an_error_rolls_all_files_back(command, faulty, tmp_path, mesh, call):
    before = content_of(tmp_path)
    for number in range(1, 200):
        child = faulty("error", call, number, "order", mesh, "-o", mesh, *ORDER)
        stdout, stderr = child.communicate()
        if child.returncode == 0:
            break
        assert child.returncode == 2 and stdout == ""
        assert "input/output error" in stderr and len(stderr.splitlines()) == 1, stderr
        assert content_of(tmp_path) == before
        assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []
    assert number > 7


def test_maps_of_two_runs_are_refused(command, tmp_path, mesh):
    for prefix, seed in (("m", "3"), ("n", "4")):
        command.ok("order", mesh, "-o", f"{prefix}.vtu", "--vertices", "scrambled", "--seed", seed, "--maps", prefix)
    shutil.copy(tmp_path / "n.vertices.old_to_new.npy", tmp_path / "m.vertices.old_to_new.npy")
    line = command.fails("apply", "m", mesh, "-o", "out.vtu")
    assert line == ("meshorder: m.maps.json: was not written together with these maps; give all files of one run of "
                    "`order`")
    assert not (tmp_path / "out.vtu").exists()


def test_symbolic_links_are_followed(command, tmp_path, mesh):
    (tmp_path / "store").mkdir()
    (tmp_path / "out.vtu").symlink_to("store/real.vtu")
    for _ in range(2):
        command.ok("order", mesh, "-o", "out.vtu", "-q")
        assert (tmp_path / "out.vtu").is_symlink() and (tmp_path / "store/real.vtu").is_file()
    (tmp_path / "circle.vtu").symlink_to("circle.vtu")
    assert "circle" in command.fails("order", mesh, "-o", "circle.vtu")


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o444])
def test_the_mode_of_the_old_file_is_kept(command, tmp_path, mesh, mode):
    for extension in ("vtu", "med", "cgns", "exo"):
        out = tmp_path / f"out.{extension}"
        out.write_text("old")
        out.chmod(mode)
        if command.run("order", mesh, "-o", out, "-q").returncode == 0:
            assert stat.S_IMODE(out.stat().st_mode) == mode
        else:
            assert out.read_text() == "old"  # this build lacks the format's library


def test_the_owner_and_the_group_are_kept(command, tmp_path, mesh):
    if os.geteuid() != 0:
        pytest.skip("needs root, who may give files away")
    os.chown(tmp_path / "mesh.node", 4321, 1234)
    command.ok("order", mesh, "-o", mesh, "-q")
    status = (tmp_path / "mesh.node").stat()
    assert (status.st_uid, status.st_gid) == (4321, 1234)


def test_extended_attributes_are_kept(command, tmp_path, mesh):
    try:
        os.setxattr(tmp_path / mesh, "user.origin", b"scanner 7")
    except OSError:
        pytest.skip("the file system has no extended attributes")
    command.ok("order", mesh, "-o", mesh, "-q")
    assert os.getxattr(tmp_path / mesh, "user.origin") == b"scanner 7"


def acl_of(user, owner, others):
    """An access control list in the kernel's format: rights of the owner, of one more user, the group (none) and others."""
    nobody = 2**32 - 1
    entries = [(1, owner, nobody), (2, 4, user), (4, 0, nobody), (16, 4, nobody), (32, others, nobody)]
    return struct.pack("<I", 2) + b"".join(struct.pack("<HHI", *entry) for entry in entries)


def test_access_control_lists_are_kept(command, tmp_path, mesh):
    acl = acl_of(4321, 6, 0)
    try:
        os.setxattr(tmp_path / mesh, "system.posix_acl_access", acl)
    except OSError:
        pytest.skip("the file system has no access control lists")
    command.ok("order", mesh, "-o", mesh, "-q")
    assert os.getxattr(tmp_path / mesh, "system.posix_acl_access") == acl
    # the folder's default list must not give more users access than before
    os.setxattr(tmp_path, "system.posix_acl_default", acl_of(4322, 7, 4))
    (tmp_path / "plain.vtu").write_text("old")
    os.removexattr(tmp_path / "plain.vtu", "system.posix_acl_access")
    (tmp_path / "plain.vtu").chmod(0o600)
    for output in (mesh, "plain.vtu", "new.vtu"):
        command.ok("order", mesh, "-o", output, "-q")
    assert os.getxattr(tmp_path / mesh, "system.posix_acl_access") == acl
    assert "system.posix_acl_access" not in os.listxattr(tmp_path / "plain.vtu")
    assert stat.S_IMODE((tmp_path / "plain.vtu").stat().st_mode) == 0o600
    assert os.getxattr(tmp_path / "new.vtu", "system.posix_acl_access") == acl_of(4322, 6, 4)


def test_hard_links_keep_the_old_content_and_are_named(command, tmp_path, mesh):
    os.link(tmp_path / mesh, tmp_path / "second-name")
    old = (tmp_path / mesh).read_bytes()
    done = command.ok("order", mesh, "-o", mesh, "--vertices", "scrambled")
    assert "mesh.node has 1 further name (hard links), which keeps the old content" in done.stderr
    assert (tmp_path / "second-name").read_bytes() == old != (tmp_path / mesh).read_bytes()


def test_a_pipe_is_written_through(command, tmp_path, mesh):
    command.ok("order", mesh, "-o", "file.vtu", "-q")
    os.mkfifo(tmp_path / "pipe.vtu")
    read = []
    reader = threading.Thread(target=lambda: read.append((tmp_path / "pipe.vtu").read_bytes()), daemon=True)
    reader.start()
    command.ok("order", mesh, "-o", "pipe.vtu", "-q")
    reader.join(timeout=30)
    assert read == [(tmp_path / "file.vtu").read_bytes()]
    assert stat.S_ISFIFO((tmp_path / "pipe.vtu").stat().st_mode)


def test_standard_output_is_written_through(command, tmp_path, mesh):
    command.ok("order", mesh, "-o", "file.mesh", "-q")
    (tmp_path / "out.mesh").symlink_to("/dev/stdout")
    expected = (tmp_path / "file.mesh").read_text()
    assert command.ok("order", mesh, "-o", "out.mesh", "-q").stdout == expected
    with open(tmp_path / "log", "w") as log:
        log.write("before\n")
        log.flush()
        order = [conftest.MESHORDER, "order", mesh, "-o", "out.mesh", "-q"]
        subprocess.run(order, cwd=tmp_path, stdout=log, check=True)
    assert (tmp_path / "log").read_text() == "before\n" + expected
    assert (tmp_path / "out.mesh").is_symlink()


@pytest.mark.parametrize("extension", ["med", "cgns", "exo"])
def test_a_format_of_a_library_refuses_a_pipe(command, tmp_path, mesh, extension):
    os.mkfifo(tmp_path / f"pipe.{extension}")
    line = command.fails("order", mesh, "-o", f"pipe.{extension}")
    assert "write an ordinary file, then copy it" in line or "build" in line


def test_a_full_device_has_its_own_words(command, tmp_path, mesh):
    (tmp_path / "full.vtu").symlink_to("/dev/full")
    assert "full.vtu: cannot be written to the end: the disk is full; free some space" in command.fails(
        "order", mesh, "-o", "full.vtu")


def test_a_name_of_255_bytes_is_written(command, tmp_path, mesh):
    name = "n" * 251 + ".vtu"
    command.ok("order", mesh, "-o", name, "-q")
    assert (tmp_path / name).is_file()
    assert "its name is too long" in command.fails("order", mesh, "-o", "n" + name)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signals_leave_no_unfinished_files(faulty, mark, tmp_path, mesh, number):
    before = content_of(tmp_path)
    child = faulty("pause", "fsync", 3, "order", mesh, "-o", mesh, *ORDER,
                   preexec_fn=lambda: signal.signal(number, signal.SIG_DFL))  # nohup and shells ignore some
    wait_for(mark)
    assert unfinished_in(tmp_path)
    child.send_signal(number)
    stdout, stderr = child.communicate(timeout=30)
    assert child.returncode == -number
    assert stderr == f"meshorder: stopped by {number.name}; unfinished outputs are removed\n" and stdout == ""
    assert content_of(tmp_path) == before and len(list(tmp_path.iterdir())) == 2


def test_the_limit_on_file_sizes_leaves_no_unfinished_files(command, tmp_path):
    points = [f"{number} {number / 7} {number % 3} {number % 5}\n" for number in range(1, 2001)]
    (tmp_path / "mesh.node").write_text(f"{len(points)} 3 0 0\n" + "".join(points))
    (tmp_path / "mesh.ele").write_text("1 4 0\n1 1 2 3 5\n")

    def small_files_only():
        resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    done = command.run("order", "mesh.node", "-o", "out.msh", preexec_fn=small_files_only)
    assert done.returncode == -signal.SIGXFSZ
    assert "SIGXFSZ" in done.stderr and "ulimit -f" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mesh.ele", "mesh.node"]


def test_ignored_signals_stay_ignored(faulty, mark, mesh):
    """As under nohup."""
    child = faulty("pause", "fsync", 1, "order", mesh, "-o", "a.vtu",
                   preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    wait_for(mark)
    child.send_signal(signal.SIGHUP)
    with pytest.raises(subprocess.TimeoutExpired):
        child.wait(timeout=0.3)
    child.kill()
    child.communicate()


def test_what_killed_commands_left_is_removed_by_the_next_one(command, faulty, tmp_path, mesh):
    for number in (1, 3):
        faulty("kill", "fsync", number, "order", mesh, "-o", "a.node", *ORDER).communicate()
    left = [path for path in tmp_path.iterdir() if path.name.startswith(".meshorder-")]
    assert left and all(stat.S_IMODE(path.stat().st_mode) == 0o700 for path in left)
    command.ok("order", mesh, "-o", "b.vtu", "-q")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b.vtu", "mesh.ele", "mesh.node"]


def test_what_a_living_command_writes_is_left_alone(command, faulty, mark, tmp_path, mesh):
    child = faulty("pause", "fsync", 1, "order", mesh, "-o", "a.vtu", "-q")
    wait_for(mark)
    unfinished = unfinished_in(tmp_path)
    command.ok("order", mesh, "-o", "b.vtu", "-q")
    assert unfinished and unfinished_in(tmp_path) == unfinished
    child.kill()
    child.communicate()


def test_a_link_of_others_in_a_shared_folder_is_not_followed(command, tmp_path, mesh):
    if os.geteuid() != 0:
        pytest.skip("needs root, who may give files away")
    shared = tmp_path / "shared"
    shared.mkdir()
    os.chown(shared, 4322, -1)
    shared.chmod(0o1777)
    (tmp_path / "precious").write_text("old")
    (shared / "out.vtu").symlink_to(tmp_path / "precious")
    os.chown(shared / "out.vtu", 4321, -1, follow_symlinks=False)
    assert "symbolic link of another user" in command.fails("order", mesh, "-o", "shared/out.vtu")
    assert (tmp_path / "precious").read_text() == "old"


def test_a_folder_without_write_permission_is_an_error(tmp_path, mesh):
    """The command runs as a user without privileges, even if root runs the tests."""
    (tmp_path / "closed").mkdir(mode=0o555)
    done = subprocess.run([conftest.MESHORDER, "order", mesh, "-o", "closed/a.vtu"], cwd=tmp_path, text=True,
                          capture_output=True, check=False,
                          preexec_fn=lambda: os.geteuid() == 0 and drop_privileges(tmp_path))
    assert done.returncode == 2
    assert done.stderr.splitlines()[0] == ("meshorder: closed/a.vtu: cannot be written: permission denied; check the "
                                           "permissions of the file and its folder")


def drop_privileges(folder):
    os.chown(folder, 65534, 65534)
    os.setgroups([])
    os.setgid(65534)
    os.setuid(65534)


def test_json_names_hard_links_in_its_notes(command, tmp_path, mesh):
    os.link(tmp_path / mesh, tmp_path / "second-name")
    done = command.run("order", mesh, "-o", mesh, "--json")
    assert any("hard links" in note for note in json.loads(done.stdout)["notes"])
