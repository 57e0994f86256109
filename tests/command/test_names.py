# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Unusual names of arrays, sets, files and scenarios: in files and in printed text."""
import fcntl
import json
import os
import re
import subprocess
import time
import xml.etree.ElementTree as ElementTree

import pytest

import conftest

# written as VTK does, each byte that is no plain letter as %XX
NAMES = {
    "escape": "%1B[31mred%1B[0m",
    "bell": "ring%07",
    "return": "a%0Dmeshorder:%20wrote%20nothing",
    "lines": "a%0Amesh%20is%20fine",
    "delete": "a%7F",
    "c1": "%C2%9B31m",
    "bidi": "%E2%80%AEtxt.vtu",
    "latin1": "Stra%DFe",
    "markup": "<b>&amp;|`_*",
}
# characters that a terminal acts on, except the end of a line
ACTED_ON = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


@pytest.fixture
def mesh(tmp_path):
    """Two tetrahedra with an array and a set of cells of each name."""
    fields = [f"{name} 1 2 double\n{k} 0.5\n" for k, name in enumerate(NAMES.values())]
    sets = [f"set:{name} 1 2 char\n1 0\n" for name in NAMES.values()]
    (tmp_path / "named.vtk").write_text(
        "# vtk DataFile Version 3.0\nnames\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
        "0 0 0  1 0 0  0 1 0  0 0 1  1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10 10\n"
        f"CELL_DATA 2\nFIELD FieldData {len(fields) + len(sets)}\n" + "".join(fields + sets))
    return "named.vtk"


def run_raw(folder, *arguments):
    """Runs the command; its output stays bytes."""
    return subprocess.run([conftest.MESHORDER, *arguments], cwd=folder, capture_output=True, check=False,
                          stdin=subprocess.DEVNULL, timeout=600)


def shown(raw):
    """The printed text, which must be UTF-8 without characters that a terminal acts on."""
    text = raw.decode()
    assert not ACTED_ON.search(text), text
    return text


@pytest.mark.parametrize("line", ["info named.vtk", "info named.vtk --json", "order named.vtk -o a.off --strict",
                                  "order named.vtk -o a.inp", "order named.vtk -o a.inp --json",
                                  "order named.vtk -o a.vtu --group-by sets", "compare named.vtk --methods rcm --budget 0.1"])
def test_terminals_see_escapes(tmp_path, mesh, line):
    done = run_raw(tmp_path, *line.split())
    out, errors = shown(done.stdout), shown(done.stderr)
    assert done.returncode == (2 if "strict" in line else 0), errors
    assert all(part.startswith("meshorder: ") for part in errors.splitlines())
    if "--json" in line:
        assert json.loads(out)
    elif line.startswith("info"):
        assert "\\u001b[31mred" in out and "Stra\\xdfe" in out and "\\u202e" in out
        assert not [part for part in out.splitlines() if part.startswith("mesh is fine")]


def test_json_holds_names_of_any_bytes(tmp_path, mesh):
    data = json.loads(run_raw(tmp_path, "info", mesh, "--json").stdout)["data"]
    names = [array["name"] for array in data]
    assert "\x1b[31mred\x1b[0m" in names and "Stra\ufffde" in names and "\u202etxt.vtu" in names


@pytest.mark.parametrize("extension", ["vtu", "msh", "json"])
def test_files_may_have_names_of_any_bytes(tmp_path, mesh, extension):
    name, out, maps = b"Stra\xdfe\x1b[31m.vtk", b"\xff.vtu", b"maps\xfe"
    os.rename(tmp_path / mesh, os.path.join(os.fsencode(tmp_path), name))
    done = run_raw(tmp_path, "order", name, "-o", out, "--maps", maps, "--json")
    assert done.returncode == 0 and json.loads(shown(done.stdout))
    assert out in os.listdir(os.fsencode(tmp_path))
    done = run_raw(tmp_path, "apply", maps, name, "-o", b"again.vtu", "--json")
    assert done.returncode == 0 and json.loads(shown(done.stdout)), done.stderr
    done = run_raw(tmp_path, "info", b"no\x1b[2J" + name + extension.encode())
    assert done.returncode == 2 and "no\\u001b[2JStra\\xdfe" in shown(done.stderr)


def xml_of(path):
    """The XML of a .vtu or .xdmf, without numbers that are appended."""
    text = path.read_bytes()
    appended = text.find(b"<AppendedData")
    return ElementTree.fromstring(text if appended < 0 else text[:appended] + b"</VTKFile>")


@pytest.mark.parametrize("output", ["a.vtu", "a.xdmf"])
def test_xml_is_xml_whatever_the_names(command, mesh, output):
    notes = command.json("order", mesh, "-o", output)["notes"]
    names = {element.get("Name") for element in xml_of(command.folder / output).iter() if element.get("Name")}
    assert {"\\u001b[31mred\\u001b[0m", "Stra\\xdfe", "<b>&amp;|`_*", "\u202etxt.vtu", "a\nmesh is fine"} <= names
    assert any("Stra" in note and "is written as" in note for note in notes)
    again = {array["name"] for array in command.json("info", output)["data"]}
    assert {"\\u001b[31mred\\u001b[0m", "Stra\\xdfe", "a\nmesh is fine"} <= again


def test_vtk_keeps_names_of_any_bytes(tmp_path, mesh):
    assert run_raw(tmp_path, "order", mesh, "-o", "a.vtk").returncode == 0
    written = (tmp_path / "a.vtk").read_bytes()
    assert all(name.encode() in written for key, name in NAMES.items() if key != "markup")


def scenario_of(folder, **changes):
    """A scenario without the title, which is optional."""
    scenario = json.loads((conftest.ROOT / "scenarios" / "constrained.json").read_text())
    del scenario["title"]
    scenario.update({"name": "untitled", **changes})
    (folder / "untitled.json").write_text(json.dumps(scenario))
    return "untitled.json"


STUDY = ["reproduce", "-o", "study", "--steps", "2", "--runs", "1", "--budget", "0.05"]


def test_a_study_of_any_names_is_read_again(tmp_path, command):
    name = b"Stra\xdfe <b>_x_.vtk"
    made = command.json("models", "make", "grid", "--size", "3")["models"][0]["path"]
    command.ok("order", made, "-o", "plain.vtk")
    os.rename(tmp_path / "plain.vtk", os.path.join(os.fsencode(tmp_path), name))
    arguments = [*STUDY, "--scenario", scenario_of(tmp_path), "--mesh", name]
    first = run_raw(tmp_path, *arguments)
    assert first.returncode == 0, first.stderr
    results = json.loads((tmp_path / "study" / "results.json").read_text())
    assert [(scenario["name"], scenario["title"]) for scenario in results["scenarios"]] == [("untitled", "untitled")]
    assert [mesh["name"] for mesh in results["meshes"]] == ["Stra\\xdfe <b>_x_"]
    assert run_raw(tmp_path, *arguments).returncode == 0  # resumed, with nothing left to do
    assert json.loads((tmp_path / "study" / "results.json").read_text()) == results
    # a study of an earlier version, with an empty title
    results["scenarios"][0]["title"] = ""
    (tmp_path / "study" / "results.json").write_text(json.dumps(results))
    command.ok("report", "study")
    tables = (tmp_path / "study" / "tables.md").read_text()
    assert "<b>" not in tables.replace("\\<b\\>", "") and "Stra\\\\xdfe \\<b\\>\\_x\\_" in tables
    assert "Stra\\xdfe <b>" not in (tmp_path / "study" / "report.html").read_text().split("<script")[0]


@pytest.mark.parametrize("name", ["n" * 101, "a\nb", "a\u001b[31m", "a/b"])
def test_scenarios_have_names_for_files(command, name):
    assert "file names" in shown(command.fails("simulate", scenario_of(command.folder, name=name)).encode())


def is_locked(folder):
    """Whether another process holds the folder's lock."""
    if not folder.is_dir():
        return False
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return False
    except BlockingIOError:
        return True
    finally:
        os.close(descriptor)


def test_two_studies_do_not_share_a_folder(tmp_path, command):
    scenario = scenario_of(tmp_path)
    arguments = ["reproduce", "-o", "study", "--scenario", scenario, "--mesh", "ball-8", "--runs", "1000", "--budget",
                 "0.05"]
    with subprocess.Popen([conftest.MESHORDER, *arguments], cwd=tmp_path, stderr=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL) as first:
        try:
            while not is_locked(tmp_path / "study"):
                assert first.poll() is None
                time.sleep(0.05)
            (tmp_path / "study" / "data" / "ball-8.vtu").write_text("of the first study")
            words = command.fails(*arguments)
            assert f"process {first.pid} is using the study" in words and "study" in words
            assert (tmp_path / "study" / "data" / "ball-8.vtu").read_text() == "of the first study"
        finally:
            first.terminate()
            first.wait(timeout=60)
    # a lock ends with its process
    assert command.run(*STUDY, "--scenario", scenario, "--mesh", "ball-3").returncode in (0, 2)


@pytest.mark.parametrize("arguments, words", [
    (["--tolerance", "nan"], "--tolerance: nan is not allowed"),
    (["--tolerance", "-1"], "--tolerance: -1 is not allowed"),
    (["--tolerance", "1e999"], "--tolerance: 1e999 is not allowed"),
    (["--tolerance", "x"], "--tolerance: 'x' is not a number"),
    (["--seed", "-1"], "--seed: -1 is not allowed"),
    (["--seed", "18446744073709551616"], "--seed: 18446744073709551616 is not allowed"),
    (["--seed", "1e3"], "--seed: '1e3' is not a whole number"),
    (["--threads", "-1"], "--threads: -1 is not allowed"),
    (["--threads", "99999999999"], "--threads: 99999999999 is not allowed"),
    (["--threads", "\x1b[2J"], "--threads: '\\u001b[2J' is not a whole number"),
    (["--group-by", "g" * 250], "g" * 250),
    (["--vertices", "m" * 250], "m" * 250),
    (["--maps", "x" * 250], "cannot be written"),
    (["-o", "o" * 252 + ".vtu"], "its name is too long"),
])
def test_one_line_says_what_is_wrong(command, mesh, arguments, words):
    output = [] if arguments[0] == "-o" else ["-o", "a.vtu"]
    assert words in shown(command.fails("order", mesh, *output, *arguments).encode())
    assert sorted(path.name for path in command.folder.iterdir()) == [mesh]


def test_any_number_of_threads_will_do(command, mesh):
    for threads in (0, 1, 2147483647):
        command.ok("order", mesh, "-o", f"{threads}.vtk", "--threads", threads)
    assert len({(command.folder / f"{threads}.vtk").read_bytes() for threads in (0, 1, 2147483647)}) == 1


def test_a_name_of_255_bytes_is_no_fault(command, mesh):
    name = "n" * 251 + ".vtk"
    os.rename(command.folder / mesh, command.folder / name)
    assert command.json("info", name)["vertices"] == 5
