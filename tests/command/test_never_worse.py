# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`auto` keeps an order that it cannot improve; a method that the user names is applied all the same, with a warning."""
import os
import meshio
import numpy
import pytest
import scipy.sparse
import scipy.sparse.linalg

import meshes


def graph_of(path):
    mesh = meshio.read(path)
    return meshes.adjacency(len(mesh.points), mesh.cells[0].data)


def spans(graph):
    upper = scipy.sparse.triu(graph, k=1).tocoo()
    return upper.col - upper.row


def factor_entries(graph):
    """The factor's entries below the diagonal, by SuperLU without pivoting, in the order of the rows."""
    matrix = scipy.sparse.diags(numpy.asarray(graph.sum(axis=1)).ravel() + 1.0) - graph
    factors = scipy.sparse.linalg.splu(matrix.tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0,
                                       options={"SymmetricMode": True})
    assert (factors.perm_r == numpy.arange(graph.shape[0])).all()
    return factors.L.nnz - graph.shape[0]


@pytest.fixture
def lattice(command, model):
    """Writes a lattice in its own order and in a random one, as .vtu."""
    source = model("grid", "--size", "10")
    command.ok("order", source, "-o", "rows.vtu", "--vertices", "original", "--elements", "original")
    command.ok("order", source, "-o", "random.vtu", "--vertices", "scrambled", "--elements", "scrambled")


@pytest.mark.parametrize("use", ["all", "spmv", "element", "assembly", "springs"])
def test_a_good_order_is_kept(command, lattice, tmp_path, use):
    before = spans(graph_of(tmp_path / "rows.vtu")).mean()
    result = command.json("order", "rows.vtu", "-o", "out.vtu", "--maps", "m", "--for", use)
    assert (numpy.load(tmp_path / "m.vertices.old_to_new.npy") == numpy.arange(result["vertices"]["count"])).all()
    assert (result["vertices"]["method"], result["vertices"]["chosen_by"], result["vertices"]["kept"]) == ("original", "auto", True)
    assert f"hilbert-fronts is no better: the mean edge span is {before:.1f} in the old order" in result["vertices"]["because"]
    assert spans(graph_of(tmp_path / "out.vtu")).mean() == before


@pytest.mark.parametrize("use", ["all", "bandwidth", "fill"])
def test_a_poor_order_is_not_kept_and_what_counts_falls(command, lattice, tmp_path, use):
    what_counts = {"all": lambda graph: spans(graph).mean(), "bandwidth": lambda graph: spans(graph).max(),
                   "fill": factor_entries}[use]
    result = command.json("order", "random.vtu", "-o", "out.vtu", "--for", use)
    assert not result["vertices"]["kept"]
    assert what_counts(graph_of(tmp_path / "out.vtu")) < 0.6 * what_counts(graph_of(tmp_path / "random.vtu"))


def test_bandwidth_never_grows(command, lattice, tmp_path):
    before = spans(graph_of(tmp_path / "rows.vtu")).max()
    command.ok("order", "rows.vtu", "-o", "out.vtu", "--for", "bandwidth")
    after = spans(graph_of(tmp_path / "out.vtu")).max()
    assert after <= before
    # the mesh is in its best order already
    result = command.json("order", "out.vtu", "-o", "again.vtu", "--for", "bandwidth")
    assert spans(graph_of(tmp_path / "again.vtu")).max() <= after
    assert result["vertices"]["kept"]


def sectors_of_additions(path):
    """The sectors that a GPU's atomic additions of four numbers of 4 bytes write. A sector holds two vertices; for each warp
    of 32 threads it counts t times, where t is the largest number of threads that add to one of its vertices."""
    cells = meshio.read(path).cells[0].data
    total = 0
    for begin in range(0, len(cells), 32):
        for corner in cells[begin:begin + 32].T:
            vertices, threads = numpy.unique(corner, return_counts=True)
            most = {}
            for vertex, count in zip(vertices, threads):
                most[vertex // 2] = max(most.get(vertex // 2, 0), count)
            total += sum(most.values())
    return total


def test_for_a_gpu_additions_cost_less_or_nothing_moves(command, lattice, tmp_path):
    result = command.json("order", "rows.vtu", "-o", "out.vtu", "--for", "gpu")
    assert result["vertices"]["kept"] and result["cells"]["kept"]
    assert "on a graphics processor" in result["cells"]["because"]
    result = command.json("order", "random.vtu", "-o", "out.vtu", "--for", "gpu")
    assert (result["vertices"]["method"], result["cells"]["method"]) == ("rcm", "lexmax")
    assert sectors_of_additions(tmp_path / "out.vtu") < 0.7 * sectors_of_additions(tmp_path / "random.vtu")
    assert "do not apply to --for gpu" in command.fails("order", "random.vtu", "-o", "b.vtu", "--for", "gpu", "--measure")


def test_fill_is_judged_by_the_entries_of_the_factor(command, tmp_path):
    # a strip of triangles: the factor fills exactly the matrix's band
    points = [[0.5 * k, k % 2, 0] for k in range(400)]
    meshio.write(tmp_path / "strip.vtu", meshio.Mesh(points, [("triangle", [[k, k + 1, k + 2] for k in range(398)])]))
    entries = factor_entries(graph_of(tmp_path / "strip.vtu"))
    result = command.json("order", "strip.vtu", "-o", "out.vtu", "--for", "fill")
    assert f"the number of entries in the factor is {entries} in the old order" in result["vertices"]["because"]
    assert result["vertices"]["kept"]


def test_a_method_asked_for_by_name_is_obeyed_with_a_warning(command, lattice, tmp_path):
    done = command.run("order", "rows.vtu", "-o", "out.vtu", "--maps", "m", "--vertices", "hilbert")
    assert done.returncode == 0
    assert "hilbert is no better: the mean edge span is " in done.stderr
    assert "--vertices original keeps the order" in done.stderr
    moved = numpy.load(tmp_path / "m.vertices.old_to_new.npy")
    assert (moved != numpy.arange(len(moved))).any()
    done = command.run("order", "random.vtu", "-o", "out.vtu", "--vertices", "hilbert")
    assert "no better" not in done.stderr


def distinct_vertices(cells, count=64):
    """The mean number of vertices that `count` consecutive cells use."""
    return numpy.mean([len(numpy.unique(cells[k:k + count])) for k in range(0, len(cells), count)])


def test_elements_are_judged_apart(command, lattice, tmp_path):
    before = meshio.read(tmp_path / "random.vtu").cells[0].data
    result = command.json("order", "random.vtu", "-o", "out.vtu", "--vertices", "original")
    assert result["vertices"]["kept"] and not result["cells"]["kept"] and result["cells"]["method"] == "lexmax"
    after = meshio.read(tmp_path / "out.vtu").cells[0].data
    assert distinct_vertices(after) < 0.9 * distinct_vertices(before)
    # a good order of vertices and elements is kept
    command.ok("order", "random.vtu", "-o", "good.vtu")
    result = command.json("order", "good.vtu", "-o", "again.vtu", "--maps", "m")
    assert result["cells"]["kept"] and result["cells"]["method"] == "original"
    assert "lexmax is no better: the mean number of vertices that " in result["cells"]["because"]
    assert (tmp_path / "m.cells.old_to_new.npy").exists()
    good = meshio.read(tmp_path / "good.vtu").cells[0].data
    assert distinct_vertices(meshio.read(tmp_path / "again.vtu").cells[0].data) == distinct_vertices(good)


def test_elements_by_a_method_asked_for_by_name_give_a_warning(command, lattice, tmp_path):
    command.ok("order", "random.vtu", "-o", "good.vtu")
    done = command.run("order", "good.vtu", "-o", "out.vtu", "--vertices", "original", "--elements", "scrambled")
    assert done.returncode == 0 and "no better" not in done.stderr  # users of scrambled do not expect a better order
    done = command.run("order", "good.vtu", "-o", "out.vtu", "--vertices", "original", "--elements", "mean")
    assert "warning: mean is no better: the mean number of vertices that " in done.stderr
    assert "--elements original keeps the order" in done.stderr
    done = command.run("order", "random.vtu", "-o", "out.vtu", "--vertices", "original", "--elements", "lexmax")
    assert "no better" not in done.stderr


def test_a_race_takes_what_it_timed_as_the_fastest(command, model, tmp_path):
    command.ok("order", model("grid", "--size", "24"), "-o", "random.vtu", "--vertices", "scrambled", "--elements", "scrambled")
    result = command.json("order", "random.vtu", "-o", "out.vtu", "--measure", "--for", "assembly")
    race = result["race"]
    assert 1 <= len(race["orders"]) <= 3
    milliseconds = {(order["vertices"], order["elements"]): order["measured_milliseconds"]["assembly"] for order in race["orders"]}
    taken = milliseconds[result["vertices"]["method"], result["cells"]["method"]]
    assert taken <= 1.5 * min(milliseconds.values())  # times vary
    assert taken < race["as_it_is"]["measured_milliseconds"]["assembly"]
    assert result["vertices"]["chosen_by"] == "auto"
    assert spans(graph_of(tmp_path / "out.vtu")).mean() < 0.6 * spans(graph_of(tmp_path / "random.vtu")).mean()


@pytest.mark.parametrize("option", ["--measure", "--predict"])
@pytest.mark.parametrize("arguments", [["--for", "fill"], ["--vertices", "rcm"], ["--group-by", "label"]])
def test_a_race_needs_something_to_decide(command, lattice, tmp_path, arguments, option):
    assert option in command.fails("order", "random.vtu", "-o", "out.vtu", option, *arguments)
    assert not (tmp_path / "out.vtu").exists()


def test_predictions_choose_the_same_order_on_every_run(command, model, tmp_path):
    command.ok("order", model("grid", "--size", "24"), "-o", "random.vtu", "--vertices", "scrambled", "--elements", "scrambled")
    arguments = ["random.vtu", "-o", "out.vtu", "--predict", "--machine", "zen3", "--for", "assembly"]
    result = command.json("order", *arguments)
    race = result["race"]
    assert race["machine"] == "zen3" and race["by"] == "prediction" and 1 <= len(race["orders"]) <= 3
    assert all(order["measured_milliseconds"] is None for order in race["orders"])
    predicted = {(order["vertices"], order["elements"]): order["predicted_milliseconds"]["assembly"] for order in race["orders"]}
    taken = result["vertices"]["method"], result["cells"]["method"]
    assert predicted[taken] <= 1.1 * min(predicted.values())
    assert predicted[taken] < race["as_it_is"]["predicted_milliseconds"]["assembly"]
    assert "for zen3" in result["vertices"]["because"]
    first = (tmp_path / "out.vtu").read_bytes()
    assert command.json("order", *arguments)["vertices"]["method"] == taken[0]
    assert (tmp_path / "out.vtu").read_bytes() == first


def test_a_machine_without_predictions_is_refused(command, lattice, tmp_path):
    assert "--predict" in command.fails("order", "random.vtu", "-o", "out.vtu", "--machine", "zen3")
    # without a prediction no machine is needed
    environment = {**os.environ, "MESHORDER_MACHINE": "cray"}
    assert command.run("order", "random.vtu", "-o", "out.vtu", env=environment).returncode == 0
    (tmp_path / "out.vtu").unlink()
    assert "did you mean 'zen3'" in command.fails("order", "random.vtu", "-o", "out.vtu", "--predict", "--machine", "zen6")
    assert not (tmp_path / "out.vtu").exists()
