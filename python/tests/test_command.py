# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The package's own command, and its conversions through meshio."""

import itertools
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

import meshio
import meshorder
import numpy as np
import pytest
from meshorder import _command

COMMAND = pathlib.Path(sys.executable).with_name("meshorder")
pytestmark = pytest.mark.skipif(not COMMAND.exists(), reason="the wheel is not installed")


def run(*arguments, cwd, **options):
    return subprocess.run([COMMAND, *arguments], cwd=cwd, capture_output=True, text=True, **options)


def ok(*arguments, cwd, **options):
    done = run(*arguments, cwd=cwd, **options)
    assert done.returncode == 0, done.stderr
    return done


def listed_subcommands(program):
    text = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    return re.findall(r"^  ([a-z-]+)  ", text.split("Subcommands:")[1], re.M)


@pytest.fixture
def deck(mesh, tmp_path):
    """Writes tetrahedra with data as HMF, meshio's own format, and tetrahedra with sets as an Abaqus deck."""
    points, cells = mesh
    made = meshio.Mesh(
        points,
        [("tetra", cells)],
        point_data={"t": points @ [1, 10, 100]},
        cell_data={"centre": [points[cells].mean(axis=1)]},
    )
    made.write(tmp_path / "deck.hmf")
    of_abaqus = meshio.Mesh(
        points,
        [("tetra", cells)],
        point_sets={"left": np.flatnonzero(points[:, 0] == 0)},
        cell_sets={"some": [np.arange(5, len(cells), 7)], "last": [np.array([8, 2])]},
    )
    of_abaqus.write(tmp_path / "deck.inp", float_fmt=".10e")
    return made


def cells_by_corners(mesh, values=None):
    """The corners of every cell, sorted, with the cell's value: independent of the order of the mesh."""
    rows = []
    for k, block in enumerate(mesh.cells):
        corners = mesh.points[block.data]
        for c in range(len(block.data)):
            value = () if values is None else np.atleast_1d(values[k][c]).tolist()
            rows.append((block.type, *sorted(map(tuple, corners[c].round(9).tolist())), *value))
    return sorted(rows, key=str)


def test_what_the_package_lacks_is_refused_in_one_line(tmp_path):
    here = listed_subcommands(COMMAND)
    assert here == ["order", "apply", "info", "compare", "try", "openfoam", "calibrate", "methods"]
    full = pathlib.Path(__file__).parents[2] / "build" / "bin" / "meshorder"
    others = {"simulate", "reproduce", "report", "models"}
    if full.exists():
        others |= set(listed_subcommands(full)) - set(here)
    for word, arguments in zip(sorted(others), itertools.cycle(([], ["--help"], ["x", "--steps", "3"]))):
        done = run(word, *arguments, cwd=tmp_path)
        assert done.returncode == 2 and done.stdout == ""
        assert re.fullmatch(rf"meshorder: {word} is in the full build only.*\n", done.stderr)
    assert "unknown command 'simulat'" in run("simulat", cwd=tmp_path).stderr


def test_streams_and_status_are_the_commands_own(mesh, tmp_path):
    meshorder.write(meshorder.make_mesh(*mesh), tmp_path / "a.msh")
    for arguments in (["methods"], ["info", "none.vtu"], ["info", "a.msh", "--json"], ["info", "a.xyz"]):
        done = run(*arguments, cwd=tmp_path)
        direct = subprocess.run([_command.program(), *arguments], cwd=tmp_path, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (direct.returncode, direct.stderr)
        if "--json" not in arguments:  # JSON contains times
            assert done.stdout == direct.stdout
    assert ok("--version", cwd=tmp_path).stdout.strip() == meshorder.__version__
    # a closed pipe ends the command by SIGPIPE, as it ends other programs
    with subprocess.Popen([COMMAND, "methods"], stdout=subprocess.PIPE) as child:
        assert child.stdout
        child.stdout.close()
    assert child.returncode in (-signal.SIGPIPE, 0)


def test_flags_are_those_that_help_shows(tmp_path):
    found = set()
    for subcommand in _command._MESH_PLACE:
        text = ok(subcommand, "--help", cwd=tmp_path).stdout
        for line in re.findall(r"^ +(-\S.*?)(?:  |$)", text, re.M):
            names, *value = line.partition(" Excludes:")[0].split()
            if not value and "help" not in names:
                found |= set(names.split(","))
    assert found == _command._FLAGS


@pytest.mark.parametrize(
    "line, mesh, output",
    [
        ("order a.mdpa -o b.hmf --json", "a.mdpa", "b.hmf"),
        ("--plugin x.so order -q --vertices rcm a.mdpa --output=b.hmf", "a.mdpa", "b.hmf"),
        ("apply m.mdpa a.mdpa -ob.hmf", "a.mdpa", "b.hmf"),
        ("order -qo b.hmf a.mdpa", "a.mdpa", "b.hmf"),
        ("order a.mdpa -qob.hmf", "a.mdpa", "b.hmf"),
        ("order --maps c.mdpa -- a.mdpa", "a.mdpa", None),
        ("info a.mdpa --measure", "a.mdpa", None),
    ],
)
def test_files_are_found_among_the_arguments(line, mesh, output):
    words = _command._Words.of(line.split())
    assert words and words.mesh.path == mesh
    assert (words.output and words.output.path) == output
    if words.output:
        arguments = line.split()
        words.output.put(arguments, "c.vtu")
        assert " ".join(arguments) == line.replace("b.hmf", "c.vtu")


@pytest.mark.parametrize("line", ["", "info", "methods a.mdpa", "order --help", "apply m", "simulate a.mdpa"])
def test_no_files_are_found_where_there_are_none(line):
    assert _command._Words.of(line.split()) is None


def test_order_of_a_file_of_meshios_into_another(deck, tmp_path):
    done = ok("order", "deck.hmf", "-o", "out.hmf", "--vertices", "rcm", "--maps", "m", "--json", cwd=tmp_path)
    result = json.loads(done.stdout)
    assert (result["input"], result["output"]) == ("deck.hmf", "out.hmf")
    assert "deck.hmf: read by meshio" in done.stderr and "out.hmf: written by meshio" in done.stderr
    assert "meshorder-" not in done.stdout + done.stderr
    assert [f"meshorder: warning: {note}" for note in result["notes"]] == done.stderr.splitlines()
    # no checksums of the mesh that meshio wrote
    identity = json.loads((tmp_path / "m.maps.json").read_text())
    assert identity["before"] and identity["after"] is None
    before, moved = meshio.read(tmp_path / "deck.hmf"), meshio.read(tmp_path / "out.hmf")
    places = np.load(tmp_path / "m.vertices.new_to_old.npy")
    np.testing.assert_array_equal(moved.points, before.points[places])
    assert cells_by_corners(moved) == cells_by_corners(before)
    # the map of cells is that of the file
    places = np.load(tmp_path / "m.cells.new_to_old.npy")
    centres = np.concatenate(before.cell_data["centre"])[places]
    np.testing.assert_array_equal(np.concatenate(moved.cell_data["centre"]), centres)
    assert sorted(path.name for path in tmp_path.iterdir() if path.name.startswith((".", "out"))) == ["out.hmf"]


def test_own_formats_on_one_side(deck, tmp_path):
    ok("order", "deck.hmf", "-o", "out.vtu", cwd=tmp_path)
    moved, before = meshio.read(tmp_path / "out.vtu"), meshio.read(tmp_path / "deck.hmf")
    assert cells_by_corners(moved) == cells_by_corners(before)

    ok("order", "deck.inp", "-o", "sets.vtu", cwd=tmp_path)
    done = ok("order", "sets.vtu", "-o", "back.mdpa", cwd=tmp_path)
    assert "back.mdpa: the file lacks the point sets 'left'" in done.stderr
    assert cells_by_corners(meshio.read(tmp_path / "back.mdpa")) == cells_by_corners(meshio.read(tmp_path / "deck.inp"))


def test_apply_undoes_order(deck, tmp_path):
    for name, ordered, back in (("deck.hmf", "o.hmf", "b.hmf"), ("deck.hmf", "o.vtu", "b.hmf")):
        ok("order", name, "-o", ordered, "--maps", "m", "--vertices", "scrambled", cwd=tmp_path)
        assert "order" in run("apply", "m", ordered, "-o", back, cwd=tmp_path).stderr.splitlines()[-1]
        assert "already" in run("apply", "m", name, "-o", back, "--inverse", cwd=tmp_path).stderr
        ok("apply", "m", ordered, "-o", back, "--inverse", cwd=tmp_path)
        np.testing.assert_array_equal(meshio.read(tmp_path / back).points, meshio.read(tmp_path / name).points)


def test_info_and_compare_name_the_users_file(deck, tmp_path):
    done = ok("info", "deck.hmf", "--json", cwd=tmp_path)
    assert json.loads(done.stdout)["file"] == "deck.hmf" and json.loads(done.stdout)["format"] == "meshio"
    assert ok("info", "deck.hmf", "-q", cwd=tmp_path).stderr == ""
    done = ok("compare", "deck.hmf", "--methods", "rcm", "--budget", "0.1", cwd=tmp_path)
    assert done.stdout.startswith("deck.hmf: ")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="Linux's")
def test_a_stdout_on_a_full_disk_is_an_error(deck, tmp_path):
    with open("/dev/full", "w") as full:
        for line in ("info deck.hmf", "methods"):
            words = [str(COMMAND), *line.split()]
            done = subprocess.run(words, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True)
            assert done.returncode == 2
            assert done.stderr.splitlines()[-1].startswith("meshorder: standard output: ")


def test_cells_are_never_lost(mesh, tmp_path):
    points, cells = mesh
    blocks = [("tetra", cells), ("wedge", cells[:3, [0, 1, 2, 3, 0, 1]])]
    meshio.Mesh(points, blocks).write(tmp_path / "a.xmf")
    before = sorted(os.listdir(tmp_path))
    for name in ("b.wkt", "b.svg", "b.xml"):
        done = run("order", "a.xmf", "-o", name, cwd=tmp_path)
        assert done.returncode == 2 and done.stdout == ""
        assert done.stderr.splitlines()[-1].startswith(f"meshorder: {name}: ")
        assert sorted(os.listdir(tmp_path)) == before
        assert run("order", "a.xmf", "-o", name, "--maps", "m", cwd=tmp_path).returncode == 2
        assert sorted(os.listdir(tmp_path)) == before


def test_strict_allows_meshio_no_loss_either(deck, tmp_path):
    ok("order", "deck.inp", "-o", "sets.vtu", cwd=tmp_path)
    before = sorted(os.listdir(tmp_path))
    done = run("order", "sets.vtu", "-o", "back.mdpa", "--strict", "--maps", "m", cwd=tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.splitlines()[-1].startswith("meshorder: back.mdpa: the file lacks the point sets")
    assert sorted(os.listdir(tmp_path)) == before
    ok("order", "deck.hmf", "-o", "all.hmf", "--strict", cwd=tmp_path)


def test_maps_of_an_earlier_run_go(deck, tmp_path):
    for name in ("m.cells.kept.npy", "m.vertices.ids.npy", "m.notes.npy"):
        (tmp_path / name).write_bytes(b"")
    done = ok("order", "deck.hmf", "-o", "out.hmf", "--maps", "m", cwd=tmp_path)
    maps = sorted(path.name for path in tmp_path.glob("m.*"))
    assert maps == ["m.cells.new_to_old.npy", "m.cells.old_to_new.npy", "m.maps.json", "m.notes.npy",
                    "m.vertices.new_to_old.npy", "m.vertices.old_to_new.npy"]  # fmt: skip
    assert "m.maps.json" in done.stdout.split() and "meshorder-" not in done.stdout
    told = json.loads(ok("order", "deck.hmf", "-o", "out.hmf", "--maps", "m", "--json", cwd=tmp_path).stdout)["maps"]
    assert sorted(told) == [name for name in maps if "notes" not in name]
    (tmp_path / "ids.inp").write_text("*NODE\n11,0,0,0\n12,1,0,0\n13,0,1,0\n14,0,0,1\n*ELEMENT, TYPE=C3D4\n7,11,12,13,14\n")
    ok("order", "ids.inp", "-o", "out.hmf", "--maps", "m", cwd=tmp_path)
    assert np.load(tmp_path / "m.vertices.ids.npy").tolist() == [11, 12, 13, 14]


def test_what_cannot_be_read_or_written_gives_one_line(tmp_path):
    (tmp_path / "bad.hmf").write_text("nothing\n")
    (tmp_path / "empty.cgns").write_text("")
    for line in ("info bad.hmf", "info none.mdpa", "info empty.cgns", "order bad.hmf -o no/b.hmf"):
        done = run(*line.split(), cwd=tmp_path)
        assert done.returncode == 2 and done.stdout == ""
        assert re.fullmatch(r"(meshorder: .*\n)+", done.stderr)
    assert "Traceback" not in done.stderr


def test_without_meshio_one_line_says_how_to_get_it(tmp_path):
    (tmp_path / "meshio.py").write_text("raise ImportError\n")
    done = run("info", "a.mdpa", cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(tmp_path)})
    assert done.returncode == 2 and done.stdout == ""
    assert re.fullmatch(r"meshorder: a\.mdpa: .*pip install meshio.*\n", done.stderr)


@pytest.mark.skipif(os.name == "nt", reason="POSIX's signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_it(deck, tmp_path, number):
    temporary = tmp_path / "tmp"
    temporary.mkdir()
    command = [str(COMMAND), "compare", "deck.hmf", "--budget", "60"]
    environment = {**os.environ, "TMPDIR": str(temporary)}

    def heed():  # processes in the background ignore SIGINT
        signal.signal(number, signal.SIG_DFL)

    with subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, env=environment, preexec_fn=heed
    ) as child:
        assert child.stderr
        child.stderr.readline()  # the note that meshio was used
        time.sleep(1)
        child.send_signal(number)
        assert child.wait(10) == -number
    assert not list(temporary.iterdir())
