# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The command `meshorder` of the Python package.

It runs the C++ command that the package contains; `compare --gpu` is in Python. A mesh in a format that only meshio has is
converted to .vtu first. For an output in such a format the command writes .vtu, which is then converted.
"""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import IO, NoReturn

import numpy as np
from numpy.typing import NDArray

from . import _core, _files, _foreign
from ._errors import Error, InputError
from .hosts.meshio import GROUPED, Blocks, to_meshio

#: subcommands that take a mesh, and the place of the mesh among their positional arguments
_MESH_PLACE = {"order": 0, "apply": 1, "info": 0, "compare": 0}
#: options without a value; all others have one
_FLAGS = {"--json", "--quiet", "-q", "--inverse", "--measure", "--predict", "--strict", "--timings", "--all-threads", "--trust",
          "--details", "--gpu"}
#: the options that may come with --gpu
_WITH_GPU = {"--gpu", "--methods", "--threads", "--json", "--quiet", "-q"}
_BAD_INPUT = 2


def program() -> str:
    """Returns the path of the C++ command."""
    folder = pathlib.Path(str(_core.__file__)).parent / "bin"
    return str(folder / ("meshorder.exe" if os.name == "nt" else "meshorder"))


def main() -> int:
    """Runs the command with the arguments of this process.

    Returns:
        The exit status, unless the command replaces this process.
    """
    arguments = sys.argv[1:]
    try:
        words = _Words.of(arguments)
        if words is not None and words.subcommand == "compare" and "--gpu" in words.options:
            return _compare_on_gpu(words)
        if words is None or not any(_foreign.format_of_meshio(path) for path in words.files()):
            return _run_as_is(arguments)
        return _run_through_meshio(arguments, words)
    except Error as error:
        print(f"meshorder: {error}", file=sys.stderr)
        return _BAD_INPUT
    except _Signalled as signalled:
        _die_by(signalled.number)


def _run_as_is(arguments: list[str]) -> int:
    if os.name == "nt":
        return subprocess.call([program(), *arguments])
    for ignored in ("SIGPIPE", "SIGXFSZ"):  # Python ignores these signals; the command must not
        signal.signal(getattr(signal, ignored), signal.SIG_DFL)
    os.execv(program(), ["meshorder", *arguments])


@dataclass
class _Word:
    """The name of a file on the command line: an argument, or the part of an argument after "=", as in --output=FILE.

    Attributes:
        path: the name of the file.
        place: position among the arguments.
        before: the part of the argument before the name.
    """

    path: str
    place: int
    before: str = ""

    def put(self, arguments: list[str], path: str) -> None:
        arguments[self.place] = self.before + path


@dataclass
class _Words:
    """The files and options of a command line that the conversion needs."""

    subcommand: str
    mesh: _Word
    output: _Word | None = None
    maps: _Word | None = None
    json: bool = False
    quiet: bool = False
    strict: bool = False
    options: dict[str, str | None] = field(default_factory=dict)  #: by name, with their value
    others: list[str] = field(default_factory=list)  #: further positional arguments

    def files(self) -> Iterator[str]:
        yield self.mesh.path
        if self.output is not None:
            yield self.output.path

    @classmethod
    def of(cls, arguments: list[str]) -> _Words | None:
        """Returns the words of a command line; None if they name no mesh or ask for help."""
        plain: list[int] = []
        values: dict[str, _Word] = {}
        flags: set[str] = set()
        place = 0
        while place < len(arguments):
            word = arguments[place]
            name, equals, value = word.partition("=")
            option = word
            if word.startswith("-q") and len(word) > 2:  # -q together with another option, as in -qo FILE
                flags.add("-q")
                option = f"-{word[2:]}"
            if word == "--":
                plain += range(place + 1, len(arguments))
                break
            if word in ("-h", "--help"):
                return None
            if not word.startswith("-") or word == "-":
                plain.append(place)
            elif word.startswith("--") and equals:
                values[name] = _Word(value, place, name + equals)
            elif word in _FLAGS:
                flags.add(word)
            elif option.startswith("-o") and len(option) > 2:
                values["-o"] = _Word(option[2:], place, word[: -len(option) + 2])
            elif place + 1 < len(arguments):
                place += 1
                values[option] = _Word(arguments[place], place)
            else:
                flags.add(word)  # its value is missing
            place += 1
        subcommand = arguments[plain[0]] if plain else ""
        mesh = _MESH_PLACE.get(subcommand, len(arguments)) + 1
        if mesh >= len(plain):
            return None
        return cls(
            subcommand,
            _Word(arguments[plain[mesh]], plain[mesh]),
            values.get("-o", values.get("--output")),
            values.get("--maps"),
            "--json" in flags,
            not flags.isdisjoint({"--quiet", "-q"}),
            "--strict" in flags,
            {**dict.fromkeys(flags), **{name: word.path for name, word in values.items()}},
            [arguments[place] for place in plain[mesh + 1 :]],
        )


def _compare_on_gpu(words: _Words) -> int:
    """Runs ``compare --gpu``, which the C++ command does not have."""
    from ._gpu.comparison import compare_on_gpu

    for name in sorted(words.options.keys() - _WITH_GPU):
        raise Error(f"{name} is not possible with --gpu; only --methods, --threads, --json and --quiet are")
    if words.others:
        raise Error(f"unexpected argument '{words.others[0]}'; see meshorder compare --help")
    methods = words.options.get("--methods")
    if "--methods" in words.options and not methods:
        raise Error("--methods: the value is empty; see meshorder compare --help")
    threads = words.options.get("--threads", "0") or ""
    if not threads.isdecimal():
        raise Error(f"--threads: expected a whole number, not '{threads}'; see meshorder compare --help")
    found = compare_on_gpu(words.mesh.path, methods.split(",") if methods else None, threads=int(threads))
    if not words.quiet:
        for note in found.notes:
            print(f"meshorder: warning: {note}", file=sys.stderr)
    if words.json:
        result = {**found.as_dict(), "version": _core.version}
        _print(json.dumps(result, indent=2, ensure_ascii=False) + "\n")
    elif not words.quiet:
        _print(f"{found}\n")
    return 0


class _Maps:
    """Files of maps. They are put in place when their mesh has been written.

    Attributes:
        prefix: prefix of their final names.
        scratch: prefix of their temporary names.
    """

    #: maps that only some runs write; those of an earlier run are removed
    _OPTIONAL = ("vertices.ids", "cells.ids", "cells.kept", "vertices.parts", "cells.parts")

    def __init__(self, prefix: str, folder: str) -> None:
        self.prefix = prefix
        self.scratch = os.path.join(folder, os.path.basename(prefix))

    def take_their_place(self) -> None:
        folder, name = os.path.split(self.scratch)
        written = os.listdir(folder)
        for file in written:
            os.replace(os.path.join(folder, file), self.prefix + file[len(name) :])
        for what in self._OPTIONAL:
            if f"{name}.{what}.npy" not in written:
                with contextlib.suppress(FileNotFoundError):
                    os.remove(f"{self.prefix}.{what}.npy")


class _Signalled(BaseException):
    """A signal that asks this process to end."""

    def __init__(self, number: int) -> None:
        self.number = number


def _raise_signalled(number: int, _: object) -> NoReturn:
    raise _Signalled(number)


def _die_by(number: int) -> NoReturn:
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)
    sys.exit(128 + number)


def _run_through_meshio(arguments: list[str], words: _Words) -> int:
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _raise_signalled)

    warnings: list[str] = []

    def warn(notes: list[str]) -> None:
        warnings.extend(notes)
        for note in notes if not words.quiet else []:
            print(f"meshorder: warning: {note}", file=sys.stderr)

    arguments = list(arguments)
    format = _foreign.format_of_meshio(words.mesh.path)
    output_format = _foreign.format_of_meshio(words.output.path) if words.output is not None else None
    output = words.output if output_format else None
    dimension = 3
    names = {}
    made = ""
    maps = None
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="meshorder-"))
        if output is not None:
            stack.enter_context(_foreign.folder_beside(output.path))  # fails before the work if nothing can be written
            made = os.path.join(folder, "out.vtu")
            output.put(arguments, made)
            names[made] = output.path
            if words.maps is not None and words.maps.path:
                maps = _Maps(words.maps.path, stack.enter_context(_foreign.folder_beside(words.maps.path)))
                words.maps.put(arguments, maps.scratch)
                names[maps.scratch] = maps.prefix
        if format:
            mesh = _foreign.read(words.mesh.path, format)
            dimension = mesh._handle.dimension
            scratch = os.path.join(folder, "in.vtu")
            notes = [*mesh.notes, *_files.write(mesh, scratch)]
            warn([f"{words.mesh.path}: {note}" for note in notes])
            del mesh
            words.mesh.put(arguments, scratch)
            names[scratch] = words.mesh.path
        status, printed = _run_in_other_names(arguments, names, words)
        if status < 0:
            raise _Signalled(-status)
        if status == 0 and output is not None and output_format:
            notes = _write(made, output.path, output_format, words, dimension, maps)
            warn([f"{output.path}: {note}" for note in notes])
            if maps is not None:
                maps.take_their_place()
    if words.json and status == 0:
        result = json.loads(printed)
        result["notes"] = warnings + result["notes"]
        if maps is not None:
            result["maps"] = [path.replace(maps.scratch, maps.prefix) for path in result["maps"]]
        printed = json.dumps(result, indent=2, ensure_ascii=False) + "\n"
    _print(printed)
    return status


def _print(text: str) -> None:
    """Writes text to stdout; drops it if the reader of a pipe has closed it.

    Raises:
        Error: stdout cannot be written to for another reason.
    """
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python flushes its buffer there at exit
        if not isinstance(error, BrokenPipeError):
            raise Error("standard output: cannot be written to the end; is the disk full?") from error


def _write(made: str, path: str, format: str, words: _Words, dimension: int, maps: _Maps | None) -> list[str]:
    """Converts the file that the command made with meshio, and returns notes."""
    ordered = words.subcommand == "order"
    moved = _files.read(made)

    def write(blocks: Blocks) -> list[str]:
        mesh, order, notes = to_meshio(moved, blocks)
        mesh.points = mesh.points[:, :dimension]
        lost = [note for note in notes if note != GROUPED]
        if words.strict and lost:
            raise InputError(f"{path}: {lost[0]}; file not written: --strict forbids data loss")
        written, *missing = _foreign.write_meshio(mesh, path, format, words.strict)
        if ordered and maps is not None:
            _reorder_map_of_cells(maps.scratch, order)
            _forget_mesh_after(maps.scratch)
        return [written, *notes, *missing]

    try:
        return write(Blocks.OF_TYPES_IN_RUNS if ordered else Blocks.AS_THEY_COME)
    except InputError:
        if not ordered or maps is not None:  # the cells must stay in the order of the maps
            raise
        return write(Blocks.OF_TYPES)


def _reorder_map_of_cells(prefix: str, order: NDArray[np.int64]) -> None:
    """Rewrites the maps of cells for cells that were sorted by type after they were reordered.

    Args:
        prefix: the value of --maps.
        order: for each cell of the file, its place in the reordered mesh.
    """
    file = f"{prefix}.cells.new_to_old.npy"
    written = np.load(file)
    new_to_old = written[order]
    np.save(file, new_to_old)
    old_to_new = np.empty_like(written)
    old_to_new[new_to_old] = np.arange(len(written), dtype=written.dtype)
    np.save(f"{prefix}.cells.old_to_new.npy", old_to_new)


def _forget_mesh_after(prefix: str) -> None:
    """Removes the checksums of the maps and of the reordered mesh: meshio may write other cells and digits."""
    file = pathlib.Path(f"{prefix}.maps.json")
    identity = json.loads(file.read_text(encoding="utf-8"))
    identity["after"] = None
    identity.pop("maps", None)
    file.write_text(json.dumps(identity, indent=2) + "\n", encoding="utf-8")


def _run_in_other_names(arguments: list[str], names: dict[str, str], words: _Words) -> tuple[int, str]:
    """Runs the command and replaces the names of temporary files in its output by those of the user's files.

    Args:
        arguments: arguments of the command.
        names: for each temporary file the user's file.
        words: the files and options of the command line.

    Returns:
        The exit status, negative if a signal ended the command; and its text on stdout.
    """
    with subprocess.Popen(
        [program(), *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        errors="surrogateescape",
    ) as child:
        assert child.stdout is not None and child.stderr is not None

        def renamed(text: str, written: Callable[[str], str] = str) -> str:
            for scratch, name in names.items():
                text = text.replace(written(scratch), written(name))
            return text

        def pass_on(lines: IO[str]) -> None:
            for line in lines:
                sys.stderr.write(renamed(line))
                sys.stderr.flush()

        errors = threading.Thread(target=pass_on, args=(child.stderr,))
        errors.start()
        try:
            printed = child.stdout.read()
            status = child.wait()
        except _Signalled as signalled:
            child.send_signal(signalled.number)
            raise
        finally:
            child.wait()
            errors.join()
    printed = renamed(printed, lambda name: json.dumps(name, ensure_ascii=False)) if words.json else renamed(printed)
    if words.subcommand == "info":  # it prints the format of the file that it read
        printed = printed.replace('"format": "VTU"', '"format": "meshio"')
        printed = printed.replace(f"{words.mesh.path}, VTU", words.mesh.path)
    return status, printed
