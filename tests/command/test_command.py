# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The command's interface: help, JSON keys, exit codes, one line for an error, and no leftover files."""
import json
import os
import re
import resource
import stat

import pytest

import meshes


def test_help_teaches(command):
    for words in ([], ["order"], ["apply"], ["info"], ["compare"], ["openfoam"], ["calibrate"], ["simulate"], ["reproduce"], ["report"],
                  ["models"], ["models", "make"], ["methods"]):
        text = command.ok(*words, "--help").stdout
        assert "Usage" in text and len(text.splitlines()) > 5
        assert " ".join(["  meshorder", *words]) in text, "no example"


def test_without_arguments_it_shows_the_help(command):
    done = command.run()
    assert done.returncode == 2 and done.stdout == "" and done.stderr == command.ok("--help").stdout


def test_usage_errors_name_the_remedy(command):
    assert command.fails("--frobnicate").endswith("see meshorder --help")
    assert command.fails("order").endswith("see meshorder order --help")
    assert command.fails("models", "make").endswith("see meshorder models make --help")


def test_unknown_options_and_methods_are_refused(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    command.fails("order", "mesh.node", "-o", "a.node", "--frobnicate")
    line = command.fails("order", "mesh.node", "-o", "a.node", "--vertices", "best")
    assert "fiedler" in line and "metis-nd" in line
    command.fails("order", "mesh.node", "-o", "a.node", "--tolerance", "-1")
    assert not (tmp_path / "a.node").exists()


def test_info_keys(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    info = command.json("info", "mesh.node")
    assert info["vertices"] == 5
    assert info["cells"] == {"tetrahedron": 2}
    assert info["graph"]["edges"] == 9
    assert info["graph"]["components"] == 1
    assert info["edge_span"]["max"] == info["bandwidth"] == 3
    assert info["edge_span"]["mean"] == pytest.approx((4 * 1 + 3 * 2 + 2 * 3) / 9)
    assert info["profile"] == 0 + 1 + 2 + 3 + 3
    assert {"mean", "max", "mean_log2"} == set(info["edge_span"])


def test_info_for_people_shows_spans(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    text = command.ok("info", "mesh.node", "--details").stdout
    assert "2 tetrahedra" in text and "█" in text


def test_order_keys(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    done = command.run("order", "mesh.node", "-o", "a.vtu", "--json", "--vertices", "fiedler")
    result = json.loads(done.stdout)
    assert set(result["vertices"]) == {"count", "method", "chosen_by", "because", "kept", "seconds"}
    assert result["vertices"]["count"] == 5 and result["vertices"]["seconds"] >= 0
    assert result["vertices"]["method"] == "fiedler"
    assert result["vertices"]["chosen_by"] == "user" and result["vertices"]["because"] is None
    assert result["cells"]["method"] == "original" and "lexmax is no better" in result["cells"]["because"]
    assert result["for"] == "all" and result["group_by"] is None
    assert set(result["edge_span"]) == {"before", "after"}
    assert set(result["fiedler"]["components"][0]) == {"size", "lambda2", "residual", "iterations", "converged"}
    assert set(result["seconds"]) == {"read", "order", "write"}


def test_order_says_what_each_stage_takes(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    result = json.loads(command.run("order", "mesh.node", "-o", "a.node", "--json").stdout)
    stages = {stage["stage"]: stage for stage in result["timings"]}
    assert list(stages) == ["read", "graph", "order", "spans", "move", "write", "sync"]
    assert all(stage["seconds"] >= 0 for stage in stages.values())
    for stage, name in (("read", "mesh"), ("write", "a"), ("sync", "a")):
        files = [tmp_path / f"{name}{extension}" for extension in (".node", ".ele", ".face", ".edge")]
        assert stages[stage]["bytes"] == sum(file.stat().st_size for file in files if file.exists()) > 0
    assert stages["graph"]["bytes"] is None
    sums = {"read": ["read"], "order": ["graph", "order", "move"], "write": ["write", "sync"]}
    for whole, parts in sums.items():
        assert result["seconds"][whole] == pytest.approx(sum(stages[part]["seconds"] for part in parts))

    raced = json.loads(command.ok("order", "mesh.node", "-o", "b.vtu", "--predict", "--machine", "zen3", "--json").stdout)
    names = [stage["stage"] for stage in raced["timings"]]
    assert names == ["read", "calibrate", "graph", "race", "order", "spans", "move", "write", "sync"]
    printed = command.run("order", "mesh.node", "-o", "a.vtu", "--timings").stdout
    lines = printed[printed.index("time "):].splitlines()
    assert [line[11:].split()[0] for line in lines] == ["read", "graph", "order", "spans", "move", "write", "sync", "all"]
    assert lines[0].endswith(" MB/s") and lines[1].endswith(" s")
    assert "time " not in command.run("order", "mesh.node", "-o", "a.vtu").stdout


def test_auto_says_what_it_took_and_why(command):
    made = command.json("models", "make", "grid", "--size", "6")["models"][0]["path"]
    names = {m["name"] for m in command.json("methods")["vertices"]}
    taken = {}
    for use in ("all", "element", "spmv", "assembly", "springs"):
        result = command.json("order", made, "-o", "a.node", "--for", use)
        taken[use] = result["vertices"]["method"]
        assert result["for"] == use
        for half in ("vertices", "cells"):
            assert result[half]["chosen_by"] == "auto" and result[half]["because"]
        assert taken[use] in names - {"auto"}
        named = command.json("order", made, "-o", "b.node", "--vertices", taken[use], "--elements", "lexmax")
        assert named["edge_span"] == result["edge_span"]
    text = command.ok("order", made, "-o", "a.node").stdout
    elements = command.json("order", made, "-o", "a.node")["cells"]["method"]
    assert f"{taken['all']} (auto)" in text and f"{elements} (auto)" in text
    line = command.fails("order", made, "-o", "a.node", "--for", "everything")
    assert "springs" in line


def test_compare_keys(command):
    made = command.json("models", "make", "grid", "--size", "6")["models"][0]["path"]
    result = command.json("compare", made, "--methods", "original,fiedler,fiedler/fiedler,rcm", "--budget", "0.5")
    names = [(m["vertices"], m["elements"]) for m in result["methods"]]
    assert names == [("original", "original"), ("fiedler", "lexmax"), ("fiedler", "fiedler"), ("rcm", "lexmax")]
    assert result["reference"] == "original" and result["methods"][0]["seconds"] == 0
    for method in result["methods"]:
        assert method["seconds"] >= 0 and method["edge_span"]["mean"] > 0
        assert set(method["kernels"]) == {"spmv", "element", "assembly", "springs"}
        assert method["taken"] == {half: method[half] for half in ("vertices", "elements")}
        for kernel in method["kernels"].values():
            assert kernel["milliseconds"] > 0 and kernel["speedup"] > 0 and kernel["of_band"] > 0
            assert kernel["samples"] >= 2 and kernel["share"] == 1
    band = result["band"]
    assert band["vertices"] == "band" and band["edge_span"]["max"] < 10
    assert set(band["kernels"]) == {"spmv", "element", "assembly", "springs"}
    for name, kernel in band["kernels"].items():
        assert kernel["of_band"] == pytest.approx(1)
        reference = result["methods"][0]["kernels"][name]
        assert reference["of_band"] == pytest.approx(reference["best_milliseconds"] / kernel["best_milliseconds"])
    assert all(kernel["speedup"] == 1 for kernel in result["methods"][0]["kernels"].values())


def test_compare_on_two_threads(command):
    made = command.json("models", "make", "grid", "--size", "6")["models"][0]["path"]
    arguments = ["compare", made, "--methods", "hilbert", "--budget", "0.5"]
    result = command.json(*arguments, "--threads", "2")
    assert result["threads"] == 2
    original, hilbert = result["methods"]
    assert 0 < hilbert["redundancy"] < 1 and 0 < original["redundancy"] < 1
    for row in (original, hilbert, result["band"]):
        assert set(row["parallel_kernels"]) == set(row["kernels"])
        for kernel in row["parallel_kernels"].values():
            assert kernel["milliseconds"] > 0 and kernel["speedup"] > 0 and kernel["of_band"] > 0
    assert all(kernel["speedup"] == 1 for kernel in original["parallel_kernels"].values())
    text = command.ok(*arguments, "--threads", "2", "--details").stdout
    assert "than in the file's own order on 2 threads. =: not told apart from it" in text
    assert "Kernels (plain) on 1 thread:" in text and "Kernels (plain) on 2 threads:" in text
    assert result["kernel_set"] == "plain"
    assert command.json(*arguments, "--kernels", "tuned")["kernel_set"] == "tuned"
    alone = command.json(*arguments, "--threads", "1")
    assert alone["threads"] == 1 and "parallel_kernels" not in alone["methods"][0]


def test_compare_on_a_gpu_is_in_the_python_package(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    said = command.fails("compare", "mesh.node", "--gpu", "--json")
    assert said.startswith("meshorder: --gpu is in the command of the Python package only") and "pip install" in said


def rows_of_compare(text):
    """The numbers of the table by the name of the order, and whether they are marked."""
    table = text.split("*: the best, and orders not told apart from the best\n")[1]
    heads, *rows = table.splitlines()
    assert heads.split() == ["order", "cost", "all", "SpMV", "element", "force", "assembly", "springs"]
    cells = re.compile(r" (\d+\.\d\d|=)([* ])")
    return {row[:26].strip(): [(1 if number == "=" else float(number), mark == "*") for number, mark in cells.findall(row[35:])]
            for row in rows[:rows.index(next(row for row in rows if row.startswith("band is not an order")))]}


def test_compare_for_people(command):
    made = command.json("models", "make", "grid", "--size", "4")["models"][0]["path"]
    text = command.ok("compare", made, "--methods", "auto,rcm/original,scrambled", "--for", "springs", "--budget",
                      "0.1").stdout
    assert text.startswith(f"{made}: ") and "auto takes " in text
    rows = rows_of_compare(text)
    assert list(rows) == ["original (auto)", "rcm/original", "scrambled", "band", "the file's own once more"]
    own = rows["original (auto)"]
    assert own == [(1.0, mark) for _, mark in own] and len(own) == 5
    for column in range(5):
        cells = [rows[name][column] for name in list(rows)[:3]]
        assert max(number for number, _ in cells) == max(number for number, marked in cells if marked)
    assert not any(marked for _, marked in rows["band"])
    rest = "\n".join(line for line in text.splitlines() if not line.startswith("auto takes "))
    for shown in ("Predicted", "milliseconds", "span"):
        assert shown not in rest, "--details shows it"


def test_the_line_that_compare_proposes_makes_the_order_that_it_names(command):
    made = command.json("models", "make", "grid", "--size", "16")["models"][0]["path"]
    command.ok("order", made, "-o", "scrambled.node", "--vertices", "scrambled", "--elements", "scrambled")
    spans = {method["vertices"]: method["edge_span"] for method in
             command.json("compare", "scrambled.node", "--methods", "hilbert,rcm", "--budget", "0.1")["methods"]}
    answer, proposed = command.ok("compare", "scrambled.node", "--methods", "hilbert,rcm").stdout.splitlines()[:2]
    if " faster in " in answer:  # on a busy machine no order may be faster
        order = re.search(" faster in (hilbert|rcm) than in the file's own order", answer)[1]
        command.ok(*proposed.split()[4:])
        assert command.json("info", "ordered-scrambled.node", "--predict", "--machine", "zen3")["edge_span"] == spans[order]
    verdict = command.json("compare", made, "--methods", "original", "--budget", "0.1")["verdict"]
    assert {key: verdict[key] for key in ("sentence", "best", "factor", "interval")} == dict.fromkeys(
        ("sentence", "best", "factor", "interval"))


def test_compare_names_an_order_that_auto_takes_once(command):
    made = command.json("models", "make", "grid", "--size", "4")["models"][0]["path"]
    command.ok("order", made, "-o", "scrambled.node", "--vertices", "scrambled", "--elements", "scrambled")
    methods = command.json("compare", "scrambled.node", "--budget", "0.01")["methods"]
    assert [method["vertices"] for method in methods[:2]] == ["original", "auto"]
    taken = [tuple(method["taken"].values()) for method in methods]
    assert len(set(taken)) == len(taken) and {"scrambled"} & {vertices for vertices, _ in taken} == set()
    named = command.json("compare", "scrambled.node", "--methods", f"auto,{'/'.join(taken[1])}", "--budget", "0.01")["methods"]
    assert [tuple(method["taken"].values()) for method in named[1:]] == [taken[1]] * 2, "but both that somebody names"


def test_the_auto_of_compare_is_what_order_makes(command):
    made = command.json("models", "make", "grid", "--size", "8")["models"][0]["path"]
    command.ok("order", made, "-o", "ordered.node")
    for mesh in (made, "ordered.node"):
        order = command.json("order", mesh, "-o", "again.node")
        [_, auto] = command.json("compare", mesh, "--methods", "auto", "--budget", "0.01")["methods"]
        assert auto["taken"] == {"vertices": order["vertices"]["method"], "elements": order["cells"]["method"]}


def test_compare_shows_an_order_that_auto_keeps_in_one_row(command):
    made = command.json("models", "make", "grid", "--size", "8")["models"][0]["path"]
    command.ok("order", made, "-o", "ordered.node")
    words = ["compare", "ordered.node", "--budget", "0.01", "--methods"]
    shown = command.ok(*words, "auto,rcm").stdout.splitlines()
    assert [line[:26].strip() for line in shown if line.startswith(("original ", "rcm "))] == ["original (auto)", "rcm"]
    [own, auto, rcm] = command.json(*words, "auto,rcm")["methods"]
    assert [order["vertices"] for order in (own, auto, rcm)] == ["original", "auto", "rcm"]
    assert {**auto, "vertices": "original", "elements": "original"} == own, "timed once"
    assert command.ok(*words, "auto,rcm", "--details").stdout.count("\noriginal (auto) ") == 6, "in all tables"
    alone = command.json(*words, "auto")
    assert (len(alone["methods"]), alone["verdict"]["sentence"]) == (2, "auto keeps the file's own order")


def test_models_keys(command, tmp_path, monkeypatch):
    monkeypatch.setenv("MESHORDER_CACHE", str(tmp_path / "cache"))
    listed = {m["name"]: m for m in command.json("models", "list")["models"]}
    assert {"dragon", "armadillo", "bunny", "armadillo-300k", "grid", "ball", "torus"} <= set(listed)
    assert listed["dragon"]["path"] is None
    made = command.json("models", "make", "torus", "--size", "2")["models"][0]
    assert made["elements"] == 6 * 2 * 2 * 16 and os.path.exists(made["path"])
    command.fails("models", "make", "teapot")


@pytest.mark.parametrize("content, where", [
    ("", "mesh.node"),
    ("5 3 0 0\n1 0 0 0\n", "mesh.node:"),
    ("1000000000000 3 0 0\n1 0 0 0\n", "mesh.node:1:"),
    ("5 3 0 0\n1 0 0 nan\n", "mesh.node:"),
    ("\x00\x01\x02\xff\xfe", "mesh.node:1:"),
])
def test_a_broken_file_is_one_line_and_leaves_nothing(command, tmp_path, content, where):
    meshes.write_tetgen(tmp_path)
    (tmp_path / "mesh.node").write_text(content)
    before = sorted(p.name for p in tmp_path.iterdir())
    line = command.fails("order", "mesh.node", "-o", "out.node", "--maps", "m")
    assert where in line
    assert sorted(p.name for p in tmp_path.iterdir()) == before


def test_paths_that_cannot_be(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    assert "no such file" in command.fails("info", "missing.vtu")
    (tmp_path / "folder.vtu").mkdir()
    assert "folder" in command.fails("info", "folder.vtu")
    assert "extension" in command.fails("info", "mesh.txt")
    assert "folder" in command.fails("order", "mesh.node", "-o", "none/out.vtu")
    assert "folder" in command.fails("order", "mesh.node", "-o", "folder.vtu")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_an_unwritable_folder_is_an_error(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    locked = tmp_path / "locked"
    locked.mkdir()
    locked.chmod(stat.S_IRUSR | stat.S_IXUSR)
    command.fails("order", "mesh.node", "-o", "locked/out.vtu")


def test_maps_of_another_mesh_are_refused(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    made = command.json("models", "make", "grid", "--size", "2")["models"][0]["path"]
    command.ok("order", made, "-o", "grid.vtu", "--maps", "g")
    assert "maps" in command.fails("apply", "g", "mesh.node", "-o", "out.node")
    assert "no such file" in command.fails("apply", "none", "mesh.node", "-o", "out.node")


def test_the_input_may_be_the_output(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    before = meshes.read_tetgen(tmp_path / "mesh.node")[0]
    command.ok("order", "mesh.node", "-o", "mesh.node", "--vertices", "scrambled", "--maps", "m")
    command.ok("apply", "m", "mesh.node", "-o", "mesh.node", "--inverse")
    assert (meshes.read_tetgen(tmp_path / "mesh.node")[0] == before).all()


@pytest.mark.parametrize("extension", ["node", "mesh", "msh", "vtu", "vtk", "veg"])
def test_a_full_disk_is_an_error_and_leaves_nothing(command, tmp_path, extension):
    made = command.json("models", "make", "grid", "--size", "12")["models"][0]["path"]

    def small_files_only():
        resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

    # Python ignores SIGXFSZ, which a write over the limit raises; the child inherits this, and the write fails
    done = command.run("order", made, "-o", f"out.{extension}", preexec_fn=small_files_only, restore_signals=False)
    assert done.returncode == 2, done.stderr
    assert f"out.{extension.replace('node', '')}" in done.stderr
    assert list(tmp_path.iterdir()) == []
