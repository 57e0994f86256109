# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Runs the snippets of the manual and the README: Python code and quick commands; C and C++ code is compiled.

The snippets of a page run one after another in one folder, with small meshes under the file names that pages use, and
share their variables. A comment of a page contains the code that its snippets presuppose: `<!-- python`, code, `-->`.
"""

import dataclasses
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import command_pages
import meshorder
import numpy
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = os.environ.get("MESHORDER", str(ROOT / "build" / "bin" / "meshorder"))
#: the Python package's command, which the page on Python shows
PACKAGE_COMMAND = pathlib.Path(sys.executable).with_name("meshorder")
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
#: subcommands that end within a second on a small mesh; of others only the options are checked
QUICK = {"order", "info", "compare", "apply", "methods"}
#: pages whose fragments are part of tests/io/dofs_test.cpp; tests/command/test_docs.py checks that both are the same
COMPILED_ELSEWHERE = {"docs/dofs.md"}
BLOCK = re.compile(r"^```([^\n]*)\n(.*?)^```$|^<!-- (python)\n(.*?)^-->$", re.MULTILINE | re.DOTALL)


@dataclasses.dataclass
class Snippet:
    """A fenced block of a page, or a comment that prepares the blocks after it."""

    page: pathlib.Path
    line: int
    language: str
    code: str

    @property
    def place(self):
        return f"{self.page.relative_to(ROOT)}:{self.line}"


def snippets(page):
    text = page.read_text()
    for found in BLOCK.finditer(text):
        line = text.count("\n", 0, found.start()) + 2
        yield Snippet(page, line, found[1] or found[3] or "", found[2] if found[2] is not None else found[4])


def commands(snippet):
    """The calls of meshorder in a block of shell commands or of terminal output."""
    if snippet.language in ("", "sh", "text"):
        for line in snippet.code.replace("\\\n", "").splitlines():
            words = shlex.split(line.removeprefix("$ "), comments=True) if re.match(r"(\$ )?meshorder ", line) else []
            if words and "…" not in line:
                yield words


def of(*languages):
    return [page for page in PAGES if any(one.language in languages for one in snippets(page))]


def names(pages):
    return [str(page.relative_to(ROOT)) for page in pages]


@pytest.fixture(scope="session")
def sample_files(tmp_path_factory):
    """The files that pages use: a lattice of tetrahedra with random vertex numbers, and its matrix."""
    folder = tmp_path_factory.mktemp("files")
    n = 5
    place = numpy.random.default_rng(2).permutation(n**3)
    corners = place.reshape(n, n, n)
    points = numpy.empty((n**3, 3))
    points[place] = numpy.indices((n, n, n)).reshape(3, -1).T
    cube = [
        corners[i : n - 1 + i, j : n - 1 + j, k : n - 1 + k].ravel() for i in (0, 1) for j in (0, 1) for k in (0, 1)
    ]
    # six tetrahedra around each cube's diagonal from corner 0 to corner 7
    around = (1, 3, 2, 6, 4, 5, 1)
    cells = numpy.concatenate(
        [numpy.stack([cube[0], cube[a], cube[b], cube[7]], axis=1) for a, b in zip(around, around[1:])]
    )
    mesh = meshorder.make_mesh(points, {"tetra": cells})
    for name in (
        "my-mesh.msh",
        "my-mesh.vtu",
        "mesh.msh",
        "mesh.node",
        "mesh.vtu",
        "part.msh",
        "ball.node",
        "dragon.node",
        "dragon.msh",
        "dragon.veg",
        "first.vtu",
        "second.vtu",
        "mesh.mesh",
        "my-mesh.mesh",
        "my-mesh.su2",
        "my-mesh.xdmf",
        "my-mesh.exo",
        "my-mesh.bdf",
        "my-mesh.med",
    ):
        meshorder.write(mesh, folder / name)
    import meshio

    for name in ("my-mesh.inp", "part.avs"):
        meshio.write(folder / name, meshio.Mesh(points, [("tetra", cells)]))
    import scipy.io
    import scipy.sparse

    pairs = [(a, b) for a in range(4) for b in range(4)]
    rows, columns = (numpy.concatenate([cells[:, pair[side]] for pair in pairs]) for side in (0, 1))
    matrix = scipy.sparse.coo_array((numpy.ones(len(rows)), (rows, columns))).tocsr()
    scipy.io.mmwrite(folder / "my-matrix.mtx", matrix + 50 * scipy.sparse.eye_array(n**3))
    return folder


@pytest.fixture
def folder(tmp_path, monkeypatch, sample_files):
    shutil.copytree(sample_files, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_command(words, page, place):
    command = PACKAGE_COMMAND if page.name == "python.md" and PACKAGE_COMMAND.exists() else COMMAND
    subcommand, *arguments = words[1:]
    if subcommand == "compare":
        arguments += [] if "--budget" in arguments else ["--budget", "0.1"]
    done = subprocess.run([command, subcommand, *arguments], capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, f"{place}: {shlex.join(words)}\n{done.stderr}"


@pytest.mark.parametrize("page", of("python", "sh", "", "text"), ids=names(of("python", "sh", "", "text")))
def test_python_and_commands_run_as_the_page_shows_them(page, folder):
    shared = {"__name__": "snippet"}
    for snippet in snippets(page):
        if snippet.language == "python":
            code = "\n" * (snippet.line - 1) + snippet.code
            exec(compile(code, str(page), "exec"), shared)
        for words in commands(snippet):
            if words[1] in QUICK:
                run_command(words, page, snippet.place)


@pytest.fixture(scope="session")
def known_options():
    """For each subcommand the options that it takes."""
    pages = command_pages.all_pages(COMMAND)
    return {tuple(page.words): {name for entry in page.options for name in entry.names} for page in pages}


@pytest.mark.parametrize("page", of("sh", "", "text"), ids=names(of("sh", "", "text")))
def test_commands_name_subcommands_and_options_that_exist(page, known_options):
    for snippet in snippets(page):
        for words in commands(snippet):
            told = tuple(words[:3]) if tuple(words[:3]) in known_options else tuple(words[:2])
            known = known_options.get(told, set()) | known_options[("meshorder",)]
            assert told in known_options or words[1].startswith("-"), f"{snippet.place}: no subcommand {words[1]}"
            own = words[1 : words.index("--")] if "--" in words else words[1:]  # another program's come after --
            for option in own:
                if option.startswith("-"):
                    assert option.partition("=")[0] in known, (
                        f"{snippet.place}: {shlex.join(told)} has no option {option}"
                    )


@pytest.fixture(scope="session")
def generated_headers(tmp_path_factory):
    """The header that CMake makes."""
    folder = tmp_path_factory.mktemp("include")
    (folder / "meshorder").mkdir()
    template = (ROOT / "include" / "meshorder" / "version.hpp.in").read_text()
    (folder / "meshorder" / "version.hpp").write_text(re.sub(r"@\w+@", "0", template))
    return folder


@pytest.mark.parametrize("page", of("cpp", "c"), ids=names(of("cpp", "c")))
def test_cpp_compiles(page, tmp_path, generated_headers):
    if str(page.relative_to(ROOT)) in COMPILED_ELSEWHERE:
        pytest.skip("compiled by tests/io")
    for snippet in snippets(page):
        if snippet.language not in ("cpp", "c"):
            continue
        source = tmp_path / f"snippet.{snippet.language}"
        source.write_text(f'#line {snippet.line} "{page.relative_to(ROOT)}"\n{snippet.code}')
        compiler = ["c++", "-std=c++20"] if snippet.language == "cpp" else ["cc", "-std=c99"]
        if "distributed.hpp" in snippet.code:  # MPI's own C++ interface is not needed and gives warnings
            compiler = ["mpicxx", "-std=c++20", "-DOMPI_SKIP_MPICXX"]
        if "eigen.hpp" in snippet.code:
            compiler += ["-isystem", "/usr/include/eigen3"]
        done = subprocess.run(
            [
                *compiler,
                "-fsyntax-only",
                "-Wall",
                "-Wextra",
                "-Werror",
                f"-I{ROOT / 'include'}",
                f"-I{generated_headers}",
                str(source),
            ],
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr


def test_snippets_are_found():
    """The patterns above find the snippets."""
    found = [one for page in PAGES for one in snippets(page)]
    assert sum(one.language == "python" for one in found) >= 5
    assert sum(one.language == "cpp" for one in found) >= 2
    assert sum(len(list(commands(one))) for one in found) >= 15
