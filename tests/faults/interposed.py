# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Runs the command with one fault at a time from the interposer, and checks its status and its files."""
import dataclasses
import errno
import hashlib
import os
import pathlib
import re
import shutil
import struct
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
# the same predictions on every machine, and no measurement before them
os.environ["MESHORDER_MACHINE"] = "zen3"
MESHORDER = os.environ.get("MESHORDER", str(ROOT / "build" / "bin" / "meshorder"))
LAB = ("simulate", "reproduce", "report", "models")  # meshorder-lab runs these
INTERPOSER = pathlib.Path(MESHORDER).resolve().parents[1] / "lib" / "libmeshorder_faults.so"

KINDS = ("allocation", "open", "read", "write", "sync", "close", "rename", "thread")
SECONDS = 60  # after which a run is taken to hang

# errors that the system gives for each kind of call
ERRORS = {
    "allocation": [errno.ENOMEM],
    "open": [errno.EACCES, errno.EMFILE, errno.EIO, errno.ENOSPC],
    "read": [errno.EIO, "short"],
    "write": [errno.ENOSPC, errno.EIO, errno.EDQUOT, errno.EFBIG, "short"],
    "sync": [errno.EIO, errno.ENOSPC],
    "close": [errno.EIO, errno.EDQUOT],
    "rename": [errno.EACCES, errno.EIO, errno.EXDEV],
    "thread": [errno.EAGAIN],
}

# libraries that end the process themselves without memory; their endings are counted separately
FOREIGN = ("libhdf5", "libcgns", "libnetcdf", "libtbb", "libgnutls")

# messages of libraries in this case
PRINTED = {"a library has ended the process": "libhdf5", "HDF5-DIAG": "libhdf5", "Error in GnuTLS": "libgnutls"}

# messages of the C library: its heap is damaged, or it has no memory for a library's thread-local variables
C_LIBRARY = re.compile(r"corrupted|double free|invalid (pointer|size|next size|chunk)|thread-local data: ABORT")


def program_of(arguments):
    return f"{MESHORDER}-lab" if arguments[0] in LAB else MESHORDER


@dataclasses.dataclass
class Fault:
    kind: str
    nth: int
    what: object  # a number of errno, "short", "kill" or "torn"
    later: bool = False  # all later calls fail, too

    def __str__(self):
        what = errno.errorcode.get(self.what, self.what)
        return f"{self.kind} {self.nth}{' and all later' if self.later else ''}: {what}"

    def environment(self):
        return {"FAULTS_FAIL": f"{self.kind}:{self.nth}{'+' if self.later else ''}:{self.what}"}


@dataclasses.dataclass
class Ending:
    status: int  # negative: the signal; None: it hung
    stdout: str
    stderr: str
    calls: dict  # number of calls of each kind
    failures: int  # number of calls that failed
    log: str

    def culprit(self):
        """The library that mishandled a lack of memory. It printed a message, or the stack in the interposer's log shows
        that it raised a signal; if the C library ended the process, it is the library whose allocation failed."""
        for text, library in PRINTED.items():
            if text in self.stderr:
                return library
        stack = self.log.partition("failed " if C_LIBRARY.search(self.stderr) else "signal ")[2]
        frames = re.findall(r"^(/\S+?)\(", stack, re.M)
        names = (pathlib.Path(frame).name for frame in frames)
        return next((library for name in names for library in FOREIGN if name.startswith(library)), None)


def run(arguments, folder, fault=None, log=None, **options):
    """Runs `meshorder …` in a folder to its end, with a fault."""
    beside = log.parent if log else folder.parent
    counters = beside / f"{folder.name}.counters"
    counters.write_bytes(bytes(8 * (len(KINDS) + 1)))
    stack = log or beside / f"{folder.name}.log"
    stack.unlink(missing_ok=True)
    environment = {**os.environ, "LD_PRELOAD": str(INTERPOSER), "FAULTS_COUNTERS": str(counters), "FAULTS_LOG": str(stack),
                   **(fault.environment() if fault else {})}
    try:
        done = subprocess.run([program_of(arguments), *map(str, arguments)], cwd=folder, env=environment, capture_output=True,
                              stdin=subprocess.DEVNULL, timeout=SECONDS, check=False, **options)
        status, stdout, stderr = done.returncode, done.stdout.decode(), done.stderr.decode()
    except subprocess.TimeoutExpired:
        status, stdout, stderr = None, "", ""
    numbers = struct.unpack(f"{len(KINDS) + 1}Q", counters.read_bytes())
    return Ending(status, stdout, stderr, dict(zip(KINDS, numbers)), numbers[-1],
                  stack.read_text(errors="replace") if stack.exists() else "")


def contents(folder):
    """The bytes of all files below a folder, by path; None for folders."""
    return {str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None
            for path in sorted(folder.rglob("*"))}


class Case:
    """A command line (`cases.Line`), its input files and its output files."""

    def __init__(self, folder, line):
        self.line, self.arguments, self.varies = line, line.arguments, set(line.varies)
        self.template, self.folder = folder / "before", folder / "work"
        self.template.mkdir(parents=True)
        line.before(self.template)
        self.old = contents(self.template)
        self.restore()
        self.clean = run(self.arguments, self.folder)
        assert self.clean.status == 0, self.clean.stderr
        self.new = contents(self.folder)
        self.meanings = {}

    def restore(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(self.template, self.folder)

    def with_fault(self, fault):
        self.restore()
        return run(self.arguments, self.folder, fault)

    def without_fault(self, arguments=None):
        """Runs the command line, or another one, on the present files. Returns the exit status."""
        return subprocess.run([MESHORDER, *map(str, arguments or self.arguments)], cwd=self.folder, capture_output=True,
                              stdin=subprocess.DEVNULL, timeout=SECONDS, check=False).returncode

    def state(self, path, found):
        """Returns "old", "new", or None for a file that is neither; a file that stays the same is "new"."""
        if path in self.new and (found == self.new[path] or (path in self.varies and found)):
            return "new"
        if path in self.old and found == self.old[path]:
            return "old"
        # HDF5 writes times into its files: is it the same mesh?
        same = path in self.new and found and self.meaning(path, found) == self.meaning(path, self.new[path])
        return "new" if same else None

    def meaning(self, path, content):
        """The mesh in a file, in a format that has no times."""
        key = hashlib.sha256(content).digest()
        if key not in self.meanings:
            there = self.folder.parent / "read"
            shutil.rmtree(there, ignore_errors=True)
            there.mkdir()
            (there / path).parent.mkdir(parents=True, exist_ok=True)
            (there / path).write_bytes(content)
            done = subprocess.run([MESHORDER, "order", path, "-o", "same.msh", "--vertices", "original", "--elements",
                                   "original", "-q"], cwd=there, capture_output=True, timeout=SECONDS, check=False)
            self.meanings[key] = (there / "same.msh").read_bytes() if done.returncode == 0 else None
        return self.meanings[key]

    def left_over(self):
        """The paths of files that should not exist."""
        return [path for path in contents(self.folder) if path not in self.old and path not in self.new]

    def faults_of_files(self):
        """The faults of the old files and the outputs, as sentences."""
        now = contents(self.folder)
        for path in sorted(set(self.old) | set(self.new)):
            if path in self.old and path not in now:
                yield f"{path} is lost"
            elif path in now and self.state(path, now[path]) is None:
                yield f"{path} is neither the old nor the new one"

    def faults_of_set(self, state=None):
        """The faults of the files that belong together, as sentences: all must be old or all new, or all in `state` if
        given."""
        now = contents(self.folder)
        changed = [path for path in self.new if self.new[path] != self.old.get(path)]
        states = {path: self.state(path, now[path]) if path in now else "old" for path in changed}
        if len(set(states.values()) | ({state} if state else set())) > 1:
            yield f"{'not all are ' + state if state else 'a mixture'}: {states}"

    def faults_of(self, ending, kind=None):
        """The faults of a run that was not killed, as sentences, without those of `faults_of_set`. `kind` is the kind of
        the calls that failed."""
        if ending.status is None:
            yield "it hangs"
            return
        if ending.status not in (0, 1, 2):
            yield f"status {ending.status}: {ending.stderr.strip()[-200:]}\n{ending.log[-3000:]}"
        *warnings, last = ending.stderr.splitlines() or [""]
        if ending.status == 0 and last:
            warnings.append(last)
        elif ending.status in (1, 2) and (not last.startswith("meshorder: ") or last.startswith("meshorder: warning: ")):
            yield f"no line that says why: {ending.stderr!r}"
        for warning in warnings:
            if not warning.startswith("meshorder: warning: "):
                yield f"a line that is no warning: {warning!r}"
        yield from self.faults_of_files()
        if ending.status == 0:
            yield from self.faults_of_set("new")
        left = self.left_over()
        if left and kind in ("allocation", "open") and all(".meshorder-" in path for path in left):
            # it could not be removed without memory or descriptors: the next run does it
            self.without_fault()
            left = self.left_over()
        if left:
            yield f"left over: {left}"


def spread(count, most):
    """At most `most` numbers from 1 to `count`, the first and the last among them."""
    if count <= most:
        return list(range(1, count + 1))
    return sorted({1 + round(i * (count - 1) / (most - 1)) for i in range(most)})
