# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The counts of `info --gpu` and `compare --gpu-layout` for graphics processors."""
import pytest

import meshes

LAYOUTS = ["packed", "apart", "padded", "patches", "gathered"]
COST = {"requests", "sectors", "floor", "dram_bytes", "dram_floor"}


@pytest.fixture
def scrambled(command, model):
    command.ok("order", model("grid", "--size", "24"), "-o", "scrambled.node", "--vertices", "scrambled", "--elements",
               "scrambled")
    return "scrambled.node"


def test_a_scrambled_grid_gets_the_line_that_orders_it(command, scrambled):
    verdict, line, *rest = command.ok("info", scrambled, "--gpu").stdout.splitlines()
    assert verdict.startswith("scrambled.node: there is a better order for a graphics processor: additions touch ")
    assert "% fewer sectors of memory, products " in verdict and verdict.endswith("% fewer")
    assert line == "to order it: meshorder order scrambled.node -o ordered-scrambled.node --for gpu"
    assert sum(row.startswith(("additions, ", "two passes, ", "product, ")) for row in rest) == 7
    command.ok(*line.split()[4:])
    verdict, *reasons = command.ok("info", "ordered-scrambled.node", "--gpu").stdout.splitlines()
    assert verdict == "ordered-scrambled.node: its order is good for a graphics processor"
    assert reasons[0].startswith("rcm is no better: ") and reasons[1].startswith("lexmax is no better: ")


def test_a_small_mesh_is_bound_by_launches(command, model):
    command.ok("order", model("grid", "--size", "8"), "-o", "small.node", "--vertices", "scrambled", "--elements", "scrambled")
    sentence = command.json("info", "small.node", "--gpu")["gpu"]["sentence"]
    assert "better order" in sentence and sentence.endswith("an H100 takes longer to launch them")


@pytest.mark.parametrize("words", [("grid", "--size", "24"), ("torus", "--size", "20"), ("ball", "--size", "10")])
def test_it_says_what_order_for_gpu_does(command, model, words):
    mesh = model(*words)
    told = command.json("info", mesh, "--gpu")["gpu"]
    done = command.json("order", mesh, "-o", "ordered.node", "--for", "gpu")
    assert told["kept"] == (done["vertices"]["kept"] and done["cells"]["kept"])
    for told_of, done_of in (("vertices", "vertices"), ("elements", "cells")):
        assert told[told_of] == {key: done[done_of][key] for key in ("method", "chosen_by", "because")}
    ordered = command.json("info", "ordered.node", "--gpu")["gpu"]["kernels"]
    for kernel, costs in told["kernels"].items():
        assert costs["ordered"] == ordered[kernel]["as_it_is"]


def test_counts_have_floors(command, scrambled):
    gpu = command.json("info", scrambled, "--gpu")["gpu"]
    assert set(gpu) == {"sentence", "kept", "vertices", "elements", "card", "kernels"}
    assert list(gpu["kernels"]) == [*LAYOUTS, "product_1", "product_8"] and gpu["card"] is None
    for costs in gpu["kernels"].values():
        assert set(costs) == {"as_it_is", "ordered"}
        for cost in costs.values():
            assert set(cost) == COST
            assert cost["sectors"] >= cost["floor"] and cost["dram_bytes"] >= cost["dram_floor"]
        assert costs["ordered"]["sectors"] < costs["as_it_is"]["sectors"]


def test_times_are_for_a_card_and_many_tetrahedra_alone(command, model, scrambled):
    text = command.run("info", scrambled, "--gpu", "--card", "h100")
    assert "--card: no times are shown; they are known for 100,000 linear tetrahedra or more" in text.stderr
    assert "ms:" not in text.stdout
    mesh = model("grid", "--size", "30")
    text = command.ok("info", mesh, "--gpu", "--card", "h100").stdout
    assert "ms: element forces of tetrahedra in single precision on an NVIDIA H100" in text
    gpu = command.json("info", mesh, "--gpu", "--card", "h100")["gpu"]
    assert gpu["card"] == "h100"
    for kernel, costs in gpu["kernels"].items():
        assert ("milliseconds" in costs["as_it_is"]) == (kernel in {"packed", "apart", "padded"})
    packed = gpu["kernels"]["packed"]["as_it_is"]
    assert packed["dram_bytes"] == packed["dram_floor"]  # the cache holds the vertices
    assert packed["milliseconds"] == pytest.approx(4e-3 + 15.9e-9 * packed["sectors"])
    assert "milliseconds" not in command.json("info", mesh, "--gpu")["gpu"]["kernels"]["packed"]["as_it_is"]


def test_options_for_processors_are_refused(command, scrambled):
    for words in (["--measure"], ["--predict"], ["--machine", "zen3"], ["--cache", "this"], ["--kernels", "tuned"],
                  ["--all-threads"]):
        assert words[0] in command.fails("info", scrambled, "--gpu", *words)
    assert "--gpu" in command.fails("info", scrambled, "--card", "h100")
    assert "h100" in command.fails("info", scrambled, "--gpu", "--card", "h200")


def test_a_matrix_has_products_alone(command, tmp_path):
    rows = 500
    entries = [f"{i + 1} {i} 1" for i in range(1, rows)]
    (tmp_path / "path.mtx").write_text("%%MatrixMarket matrix coordinate real symmetric\n"
                                       f"{rows} {rows} {len(entries)}\n" + "\n".join(entries) + "\n")
    gpu = command.json("info", "path.mtx", "--gpu")["gpu"]
    assert list(gpu["kernels"]) == ["product_1", "product_8"] and gpu["kept"]
    assert "--gpu-layout: a matrix or graph has no elements" in command.fails("compare", "path.mtx", "--gpu-layout", "packed")


VTK = """# vtk DataFile Version 3.0
mesh
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 9 float
0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 2 2 2
"""


def test_elements_of_several_sizes_are_said_not_to_be_counted(command, tmp_path):
    (tmp_path / "mixed.vtk").write_text(VTK + "CELLS 2 14\n8 0 1 2 3 4 5 6 7\n4 5 6 7 8\nCELL_TYPES 2\n12 10\n")
    note = "additions are not counted: not all elements have the same number of vertices"
    assert note in command.run("info", "mixed.vtk", "--gpu").stderr
    assert list(command.json("info", "mixed.vtk", "--gpu")["gpu"]["kernels"]) == ["product_1", "product_8"]
    assert "--gpu-layout" in command.fails("compare", "mixed.vtk", "--gpu-layout", "packed")


def test_points_alone_have_nothing_to_count(command, tmp_path):
    (tmp_path / "points.vtk").write_text(VTK + "CELLS 2 4\n1 0\n1 8\nCELL_TYPES 2\n1 1\n")
    assert command.ok("info", "points.vtk", "--gpu").stdout.startswith("points.vtk: nothing to compute: it has no elements")
    assert command.json("info", "points.vtk", "--gpu")["gpu"]["kernels"] == {}


def test_compare_counts_each_order(command, scrambled):
    words = ["compare", scrambled, "--methods", "rcm,hilbert/original", "--budget", "0.1", "--gpu-layout", "padded,gathered"]
    methods = command.json(*words)["methods"]
    for method in methods:
        assert set(method["gpu"]) == {"padded", "gathered"} and set(method["gpu"]["padded"]) == COST
    own, rcm, _ = (method["gpu"]["padded"]["sectors"] for method in methods)
    assert rcm < own == command.json("info", scrambled, "--gpu")["gpu"]["kernels"]["padded"]["as_it_is"]["sectors"]
    text = command.ok(*words).stdout
    head = next(row for row in text.splitlines() if row.startswith("order "))
    assert head.split("cost")[1].endswith("gpu padded  gpu gathered ")
    row = next(row for row in text.splitlines() if row.startswith("rcm"))
    assert f"{own / rcm:.2f}*" in row
    assert "gpu: factor by which atomic additions touch fewer sectors" in text


def test_kernels_of_a_processor_do_not_judge_for_gpus(command, scrambled):
    for layouts in ([], ["--gpu-layout", "padded"]):
        line = command.fails("compare", scrambled, "--for", "gpu", *layouts)
        assert "run on this machine's processor" in line and "`meshorder info --gpu` counts" in line


def test_other_layouts_are_refused(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    assert "packed" in command.fails("compare", "mesh.node", "--gpu-layout", "paked")
