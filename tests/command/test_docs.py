# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The documentation's examples work as described, and its figures agree with its data."""
import json
import re
import shlex
import subprocess
import sys
import textwrap

import numpy
import pytest
import scipy.sparse

import conftest
import meshes


def blocks(document, language):
    text = (conftest.ROOT / "docs" / document).read_text()
    return re.findall(rf"^```{language}\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)


def test_dofs_in_python(command, tmp_path, monkeypatch):
    made = command.json("models", "make", "grid", "--size", "4")["models"][0]["path"]
    command.ok("order", made, "-o", "mesh.node", "--vertices", "scrambled")
    points, cells = meshes.read_tetgen(tmp_path / "mesh.node")
    shell, = blocks("dofs.md", "sh")
    program, *arguments = shlex.split(shell)
    assert program == "meshorder"
    command.ok(*arguments)
    new_points, new_cells = meshes.read_tetgen(tmp_path / "ordered.node")

    def stiffness(of_points, of_cells):
        """A matrix with three degrees of freedom per vertex that depends only on the mesh."""
        graph = meshes.adjacency(len(of_points), of_cells)
        return scipy.sparse.kron(graph + scipy.sparse.diags(of_points[:, 0]), numpy.arange(9).reshape(3, 3) + 1).tocsr()

    monkeypatch.chdir(tmp_path)
    names = {"u": numpy.random.default_rng(1).random(3 * len(points)), "matrix": stiffness(points, cells),
             "fixed": numpy.array([0, 5, 17])}
    code, = blocks("dofs.md", "python")
    exec(compile(code, "docs/dofs.md", "exec"), names)
    assert (new_points[names["old_to_new"]] == points).all()
    assert abs(names["matrix_new"] - stiffness(new_points, new_cells)).max() == 0
    assert (names["u_new"][names["fixed_new"]] == names["u"][names["fixed"]]).all()
    assert (names["back"] == names["u"]).all()
    assert names["matrix_new"] @ names["u_new"] == \
        pytest.approx((names["matrix"] @ names["u"])[names["rows"]])


def test_dofs_in_cpp_are_those_that_are_compiled():
    shown, = blocks("dofs.md", "cpp")
    test = (conftest.ROOT / "tests" / "io" / "dofs_test.cpp").read_text()
    compiled = re.search(r"// \[docs/dofs.md\n(.*?)^ *// docs/dofs.md\]", test, flags=re.MULTILINE | re.DOTALL).group(1)
    assert textwrap.dedent(compiled) == shown


def test_what_orders_bring_in_programs_is_what_was_kept():
    kept = conftest.ROOT / "docs" / "pictures" / "programs.json"
    printed = subprocess.run([sys.executable, conftest.ROOT / "benchmarks" / "programs.py", "--from", kept], check=True,
                             capture_output=True, text=True).stdout
    assert printed in (conftest.ROOT / "docs" / "hosts.md").read_text()
    of_readme = ["icofoam-pcg", "freefem", "ngsolve", "petsc", "ccx-spooles", "dolfinx"]
    for picture, programs in (("programs", []), ("gains", of_readme)):
        script = conftest.ROOT / "docs" / "pictures" / "draw_programs.py"
        drawn = subprocess.run([sys.executable, script, kept, "/dev/stdout", *programs], check=True, capture_output=True,
                               text=True).stdout
        assert drawn == (kept.parent / f"{picture}.svg").read_text()


def test_what_the_readme_says_of_programs_is_what_was_kept():
    kept = json.loads((conftest.ROOT / "docs" / "pictures" / "programs.json").read_text())
    readme = (conftest.ROOT / "README.md").read_text()
    rows = re.findall(r"^\| (\w+), .*? \| ([\d.]+) s \| ([\d.]+) s \| (?:\*\*([\d.]+) times|no gain)", readme, re.MULTILINE)
    assert len(rows) == 6
    for program, as_it_is, best, times in rows:
        found, = [one for name, one in kept.items() if one["title"].startswith(program)
                  and f"{one['orders'][0]['time']:.3g}" == as_it_is]
        order, = [order for order in found["orders"] if order["name"] == found["best"]]
        assert f"{order['time']:.3g}" == best
        assert (found["verdict"] == "faster") == bool(times)
        assert not times or f"{order['ratio']:.1f}" == times


def test_simulations(command, tmp_path):
    (tmp_path / "my.json").write_text(blocks("simulate.md", "json")[0])
    for line in blocks("simulate.md", "sh")[1].splitlines():
        program, *arguments = shlex.split(line)
        assert program == "meshorder"
        assert "a step" in command.ok(*arguments).stdout
    for folder in ("original", "ordered"):
        assert len(list((tmp_path / folder).glob("my-beam-*.vtu"))) == 51
    assert (tmp_path / "my.state").exists()


@pytest.mark.parametrize("results, tables", [("results.json", "tables.md"), ("zen4.json", "zen4-tables.md"),
                                             ("zen4-short.json", "zen4-short-tables.md"),
                                             ("300k.json", "300k-tables.md"), ("2m.json", "2m-tables.md")])
def test_the_reproduction_is_what_its_results_say(command, tmp_path, results, tables):
    """The command makes the committed tables from the committed results."""
    committed = conftest.ROOT / "docs" / "reproduction"
    (tmp_path / "results.json").write_bytes((committed / results).read_bytes())
    command.ok("report", ".")
    assert (tmp_path / "tables.md").read_text() == (committed / tables).read_text()


@pytest.mark.parametrize("table, name", enumerate(["results.json", "zen4.json", "zen4-short.json",
                                                   "300k.json", "2m.json"]))
def test_speedups_in_the_reproduction_are_those_of_its_results(table, name):
    text = (conftest.ROOT / "docs" / "reproduction.md").read_text()
    results = json.loads((conftest.ROOT / "docs" / "reproduction" / name).read_text())
    orders = [ordering["name"] for ordering in results["orderings"] if ordering["name"] != "scrambled"]
    for scenario in results["scenarios"]:
        row = re.findall(rf"^\| {scenario['name']} \| \d.*$", text, flags=re.MULTILINE)[table]
        told = [float(number) for number in re.findall(r"[+-]\d+\.\d", row.replace("−", "-"))]
        by_name = {order["ordering"]: order["speedup"] for order in scenario["orders"]}
        speedups = [by_name[order][key] for order in orders for key in ("percent", "low", "high")]
        assert told == pytest.approx(speedups, abs=0.051)


def test_the_two_studies_compare_as_committed(command, tmp_path, monkeypatch):
    committed = conftest.ROOT / "docs" / "reproduction"
    for name in ("results.json", "zen4.json"):
        (tmp_path / name).write_bytes((committed / name).read_bytes())
    monkeypatch.chdir(tmp_path)
    command.ok("report", "results.json", "zen4.json", "-o", "comparison.html")
    assert (tmp_path / "comparison.md").read_text() == (committed / "comparison.md").read_text()


def test_the_manual_keeps_the_hyphens_of_the_help(monkeypatch):
    monkeypatch.syspath_prepend(conftest.ROOT / "docs" / "site")
    import command_reference
    assert command_reference.escaped("after --. Write `a --b` or --json") == "after `--`. Write `a --b` or `--json`"


def test_each_page_is_in_the_contents():
    """The builder of the manual requires this, but CI reaches it an hour later."""
    docs = conftest.ROOT / "docs"
    pages = {page.relative_to(docs).with_suffix("").as_posix() for page in docs.rglob("*.md")} - {"index"}
    listed = set()
    for page in docs.rglob("*.md"):
        for tree in re.findall(r"^```\{toctree\}\n(.*?)^```$", page.read_text(), flags=re.MULTILINE | re.DOTALL):
            for line in tree.splitlines():
                if line.strip() and not line.startswith(":"):
                    entry = re.sub(r"^.*<(.*)>$", r"\1", line.strip())
                    listed.add((page.parent / entry).relative_to(docs).as_posix())
    assert pages - listed == set()
