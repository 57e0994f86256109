# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`meshorder report`: a page on meshes, and a study's page written again. The tests read the page without a browser."""
import base64
import html.parser
import json
import pathlib
import re
import zlib

import numpy
import pytest

from conftest import ROOT
from meshes import read_tetgen, write_tetgen


class Page(html.parser.HTMLParser):
    """The script elements of a page by id, its links, and its text."""

    def __init__(self, path):
        super().__init__()
        self.scripts = {}
        self.links = []
        self.text = ""
        self.inside = None
        self.feed(pathlib.Path(path).read_text(encoding="utf-8"))
        self.close()
        self.manifest = json.loads(self.scripts["manifest"])
        self.results = json.loads(self.scripts["results"])

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.links += [attributes[name] for name in ("src", "href", "srcset", "action") if name in attributes]
        self.inside = attributes.get("id", "") if tag == "script" else None
        if self.inside is not None:
            self.scripts[self.inside] = self.scripts.get(self.inside, "")

    def handle_endtag(self, tag):
        self.inside = None

    def handle_data(self, data):
        if self.inside is None:
            self.text += data
        else:
            self.scripts[self.inside] += data

    def array(self, entry):
        """The numbers of an array of the manifest, with positions as coordinates, by the format of viewer/README.md."""
        data = zlib.decompress(base64.b64decode(self.scripts[entry["blob"]], validate=True))
        numbers = numpy.frombuffer(data, "<u" + str(int(entry["type"][4:]) // 8)).reshape(entry["shape"])
        if entry.get("delta"):
            numbers = numpy.cumsum(numbers, axis=0, dtype=numpy.uint16)
        return entry["offset"] + entry["scale"] * numbers.astype(float) if "scale" in entry else numbers


def procedural(command, name="ball", size=8):
    """A small model, in the command's folder."""
    made = command.json("models", "make", name, "--size", size)["models"][0]["path"]
    command.ok("order", made, "--vertices", "original", "--elements", "original", "-o", f"{name}.node")
    return command.folder / f"{name}.node"


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """A page on a ball of 729 vertices, and the command's output."""
    from conftest import Command
    command = Command(tmp_path_factory.mktemp("report"))
    mesh = procedural(command)
    said = command.json("report", mesh, "-o", "ball.html", "--budget", 0.2)
    return command, mesh, said, Page(command.folder / "ball.html")


def surface_vertices(page, points):
    """The vertex of the mesh at the position of each vertex of the page's first mesh."""
    places = page.array(page.manifest["meshes"][0]["positions"])
    distances = numpy.linalg.norm(points[None, :, :] - places[:, None, :], axis=2)
    assert distances.min(axis=1).max() < 1e-4
    return distances.argmin(axis=1)


def test_the_page_holds_each_order_of_the_surface(report):
    command, mesh, _, page = report
    points, cells = read_tetgen(mesh)
    shown = page.manifest["meshes"][0]
    assert shown["name"] == "ball" and shown["vertices"] == len(points)
    vertices = surface_vertices(page, points)
    assert len(set(vertices)) == len(vertices)
    assert (page.array(shown["ranks"]["original"]) == vertices).all()
    command.ok("order", mesh, "--vertices", "fiedler", "--elements", "fiedler", "-o", "f.node", "--maps", "m")
    places = numpy.load(command.folder / "m.vertices.old_to_new.npy")
    for ordering in ("fiedler", "vf-fiedler"):
        assert (page.array(shown["ranks"][ordering]) == places[vertices]).all()
    # the triangles are exactly the faces that belong to one cell only
    faces = numpy.sort(cells[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3), axis=1)
    faces, counts = numpy.unique(faces, axis=0, return_counts=True)
    triangles = numpy.sort(vertices[page.array(shown["triangles"])], axis=1)
    assert (numpy.unique(triangles, axis=0) == faces[counts == 1]).all()


def test_sparsity_patterns_count_every_entry(report):
    _, _, said, page = report
    mesh = said["results"]["meshes"][0]
    for pattern in page.manifest["meshes"][0]["sparsity"].values():
        assert page.array(pattern).sum() == mesh["vertices"] + 2 * mesh["edges"]


def test_the_page_needs_nothing_else(report):
    *_, page = report
    assert all(link.startswith(("data:", "#")) for link in page.links), page.links
    assert "Permission is hereby granted" in "".join(page.scripts.values())


def test_the_page_says_what_the_command_says(report):
    command, mesh, said, page = report
    assert page.results == said["results"]
    assert said["page"] == "ball.html"
    record = said["results"]["meshes"][0]
    assert record["file"] == str(mesh)
    assert [order["ordering"] for order in record["orders"]] == [
        "original", "meshorder", "fiedler", "vf-fiedler", "scrambled"]
    assert record["verdict"] and record["verdict"].replace("`", "").replace(" %", "\u00a0%") in page.text
    text = command.ok("report", mesh, "--budget", 0.1).stdout
    assert "Verdict: " in text and text.endswith("wrote report.html\n")
    assert (command.folder / "report.html").exists()


def test_several_meshes_get_names_of_their_own(command):
    (command.folder / "b").mkdir()
    first, second = write_tetgen(command.folder), write_tetgen(command.folder / "b")
    said = command.json("report", first, second, "--budget", 0.1)
    assert [mesh["name"] for mesh in said["results"]["meshes"]] == ["mesh", "mesh-2"]
    page = Page(command.folder / "report.html")
    assert [mesh["name"] for mesh in page.manifest["meshes"]] == ["mesh", "mesh-2"]


def test_bad_meshes_end_in_one_line_and_no_page(command):
    mesh = write_tetgen(command.folder)
    (command.folder / "lines.obj").write_text("v 0 0 0\nv 1 0 0\nl 1 2\n")
    assert "missing.msh" in command.fails("report", mesh, "missing.msh", "--budget", 0.1)
    assert "lines.obj" in command.fails("report", "lines.obj")
    assert "its folder does not exist" in command.fails("report", mesh, "-o", "none/a.html")
    before = (command.folder / mesh).read_bytes()
    assert "ends in .html" in command.fails("report", mesh, "-o", mesh)
    assert (command.folder / mesh).read_bytes() == before
    assert not list(command.folder.glob("**/*.html"))


@pytest.fixture
def study(command):
    """A study's folder of one mesh in two orders, without scenarios."""
    mesh = procedural(command, size=4)
    results = command.json("report", mesh, "--budget", 0.1)["results"]
    root = command.folder / "results"
    (root / "data").mkdir(parents=True)
    (root / "results.json").write_text(json.dumps(results))
    command.ok("order", mesh, "--vertices", "original", "--elements", "original", "-o", root / "data/ball.vtu")
    n = results["meshes"][0]["vertices"]
    numpy.save(root / "data/ball-original.vertices.npy", numpy.arange(n))
    numpy.save(root / "data/ball-scrambled.vertices.npy", numpy.random.default_rng(1).permutation(n))
    return root


def test_a_studys_report_is_written_again(command, study):
    said = command.json("report", study)
    assert said["page"] == str(study / "report.html")
    assert {str(study / "tables.md"), str(study / "tables.csv")} < set(said["files"])
    assert all(pathlib.Path(file).stat().st_size > 0 for file in said["files"])
    assert any("ball-fiedler.vertices.npy is missing" in note for note in said["notes"])
    page = Page(study / "report.html")
    assert page.results == json.loads((study / "results.json").read_text())
    scrambled = numpy.load(study / "data/ball-scrambled.vertices.npy")
    ranks = page.manifest["meshes"][0]["ranks"]
    assert (page.array(ranks["scrambled"]) == scrambled[page.array(ranks["original"])]).all()
    once = (study / "report.html").read_bytes()
    command.ok("report", study)
    assert (study / "report.html").read_bytes() == once


def test_broken_studies_are_named_and_nothing_is_written(command, study):
    order = study / "data/ball-original.vertices.npy"
    numpy.save(order, numpy.arange(3))
    assert str(order) in command.fails("report", study)
    (study / "results.json").write_text("{")
    assert "results.json" in command.fails("report", study)
    (study / "results.json").unlink()
    assert "holds no results.json" in command.fails("report", study)
    assert not (study / "tables.md").exists() and not (study / "report.html").exists()


def test_a_study_is_reported_by_itself_and_in_its_folder(command, study):
    mesh = command.folder / "ball.node"
    for inputs in ((study, mesh), (mesh, study / "results.json"), (study, study, study)):
        assert "report on one by itself, or compare two" in command.fails("report", *inputs)
    assert "-o" in command.fails("report", study, "-o", "a.html")
    for option in (["--budget", "3"], ["--for", "spmv"], ["--seed", "0"], ["--tolerance", "0.1"]):
        assert f"{option[0]} is for a report on meshes" in command.fails("report", study, *option)
    (study / "mine.json").write_bytes((study / "results.json").read_bytes())
    assert "not called results.json" in command.fails("report", study / "mine.json")


def test_a_study_is_found_by_its_results(command, study):
    once = command.json("report", study)["files"]
    assert command.json("report", study / "results.json")["files"] == once


def reproduction():
    """The committed results of six scenarios."""
    return json.loads((ROOT / "docs" / "reproduction" / "results.json").read_text())


def shifted(results, points):
    """Results as of another machine: every order saves that many more points."""
    results["machine"].update(processor="Another 1", compiler="Clang 19", revision="5eed")
    results["began"] = "2027-01-02T03:04:05Z"
    for scenario in results["scenarios"]:
        for order in scenario["orders"]:
            if order["ordering"] != results["reference"]:
                speedup = order["speedup"]
                for key in ("percent", "low", "high"):
                    speedup[key] += points
                speedup["beyond_noise"] = not speedup["low"] <= 0 <= speedup["high"]
    return results


@pytest.fixture
def two(command):
    """The committed study, and another one 3 points above it."""
    for name, results in (("a", reproduction()), ("b", shifted(reproduction(), 3))):
        (command.folder / name).mkdir()
        (command.folder / name / "results.json").write_text(json.dumps(results))
    return command


def test_two_studies_are_compared(two):
    said = two.json("report", "a/results.json", "b")
    assert said["page"] == "comparison.html"
    assert said["files"] == ["comparison.md", "comparison.csv", "comparison.html"]
    savings = said["savings"]
    assert len(savings) == 24
    for saving in savings:
        a, b, difference = saving["a"], saving["b"], saving["difference"]
        assert difference["points"] == pytest.approx(3)
        # both intervals are equal and symmetric, so that of the difference is √2 times as wide
        half = 2**0.5 * (a["high"] - a["low"]) / 2
        assert difference["low"] == pytest.approx(3 - half) and difference["high"] == pytest.approx(3 + half)
        assert difference["beyond_noise"] == (half < 3)
        assert b["percent"] == pytest.approx(a["percent"] + 3)
    assert {saving["difference"]["beyond_noise"] for saving in savings} == {True, False}

    text = (two.folder / "comparison.md").read_text()
    rows = re.findall(r"^\| (\w+), ([\w ]+) \| .*?, (saves|costs|not told apart) \| .* \| (B saves more|A saves more|not told apart) \|",
                      text, flags=re.MULTILINE)
    assert len(rows) == 24
    for (scenario, _, words, which), saving in zip(rows, savings):
        assert scenario == saving["scenario"]
        assert (which == "B saves more") == saving["difference"]["beyond_noise"]
        assert (words == "not told apart") == (not saving["a"]["beyond_noise"])
    for row in ("| Processor | AMD EPYC | Another 1 | differs |", "| Compiler | GNU 12.2.0 | Clang 19 | differs |",
                "| Began | 2026-11-20T", "| Results | a/results.json | b/results.json |"):
        assert row in text, row
    assert re.search(r"\| Program \| meshorder 0.1.0 \| meshorder 0.1.0, revision 5eed \| differs \|", text)
    page = (two.folder / "comparison.html").read_text()
    assert page.count('class="number saves"') + page.count('class="number costs"') + page.count('class="number open"') == 48
    assert not re.findall(r'(?:src|href)="(?!data:)', page)
    shown = two.ok("report", "a", "b", "-o", "two.html").stdout
    assert "falling, Fiedler" in shown and shown.endswith("wrote two.html\n")
    assert (two.folder / "two.html").read_text() == page


@pytest.mark.parametrize("change, words", [
    (lambda b: b["meshes"][0].update(vertices=46317), "has a mesh dragon of 46,317 vertices"),
    (lambda b: b.update(size="300k"), "has meshes of size 300k, where a/results.json has paper"),
    (lambda b: b["scenarios"].pop(2), "has no scenario stretch"),
    (lambda b: b["scenarios"][0].update(name="mine"), "has no scenario falling"),
    (lambda b: b["scenarios"][0].update(precision="single"), "has falling in the precision single"),
    (lambda b: b["scenarios"][3].update(fingerprint="56ae5f550aa3fbf9" + 16 * "0"), "has another unsquash"),
    (lambda b: b["scenarios"][3].update(fingerprint=32 * "0"), "has unsquash on another mesh of the name armadillo"),
    (lambda b: b["scenarios"].clear(), "has no scenario that was run"),
])
def test_studies_of_other_things_are_not_compared(two, change, words):
    other = shifted(reproduction(), 3)
    change(other)
    (two.folder / "b" / "results.json").write_text(json.dumps(other))
    first = reproduction()
    for scenario in first["scenarios"]:
        scenario["precision"] = "double"
    (two.folder / "a" / "results.json").write_text(json.dumps(first))
    line = two.fails("report", "a/results.json", "b/results.json")
    assert line.startswith("meshorder: b/results.json: ") and words in line, line
    assert not list(two.folder.glob("comparison.*"))


def test_a_comparison_is_not_written_over_something_else(two):
    assert "ends in .html" in two.fails("report", "a", "b", "-o", "a/results.json")
    assert "none/two" in two.fails("report", "a", "b", "-o", "none/two.html")
    assert "c/results.json" in two.fails("report", "a", "c/results.json")
    (two.folder / "c").mkdir()
    assert "c: holds no results.json" in two.fails("report", "a", "c")
