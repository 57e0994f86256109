# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`meshorder order` under mpirun, as a user runs it: results, independence of the number of ranks, endings."""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

import meshio
import numpy
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MESHORDER = pathlib.Path(os.environ.get("MESHORDER", ROOT / "build" / "bin" / "meshorder"))
#: meshes of Gmsh and TetGen
DATA = ROOT / "tests" / "data"
# more ranks than cores, none bound to a core
MPIRUN = ["mpirun", "--oversubscribe", "--bind-to", "none"]
SECONDS = 60  # after which ranks are taken to wait for each other

if not MESHORDER.with_name("meshorder-mpi").exists():
    pytest.skip("needs a build with MESHORDER_MPI=ON", allow_module_level=True)


def environment(**variables):
    """The environment for Open MPI: two variables allow it to run as root, one makes ranks that share cores yield."""
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_mpi_yield_when_idle": "1", **variables}


def launch(ranks, *arguments, program=MESHORDER):
    """Starts ranks and returns the completed process. One rank is started without mpirun."""
    start = [*MPIRUN, "-n", str(ranks)] if ranks > 1 else []
    program = program if ranks > 1 else program.with_name("meshorder-mpi")
    return subprocess.run([*start, program, *map(str, arguments)], env=environment(), capture_output=True, text=True,
                          timeout=SECONDS, check=False)


def order(ranks, *arguments):
    done = launch(ranks, "order", *arguments)
    assert done.returncode == 0, done.stderr
    return done


def serial(*arguments):
    return subprocess.run([MESHORDER, *map(str, arguments)], capture_output=True, text=True, check=True)


def own_lines(done):
    """The errors and warnings of meshorder, without mpirun's."""
    return [line for line in done.stderr.splitlines() if line.startswith("meshorder: ")]


@pytest.fixture(scope="module")
def ball():
    made = serial("models", "make", "ball", "--size", "12", "--json")
    return pathlib.Path(json.loads(made.stdout)["models"][0]["path"])


def mixed(folder):
    """Tetrahedra, a triangle on every seventh of them, data on both and on points, and points that no cell uses."""
    random = numpy.random.default_rng(3)
    points = random.random((300, 3))
    tetrahedra = numpy.array([random.choice(290, 4, replace=False) for _ in range(500)])
    mesh = meshio.Mesh(points, [("tetra", tetrahedra), ("triangle", tetrahedra[::7, :3])],
                       point_data={"u": random.random(300)},
                       cell_data={"s": [random.random(500), random.random(len(tetrahedra[::7]))]})
    mesh.write(folder / "mixed.vtu")
    return folder / "mixed.vtu"


@pytest.mark.parametrize("name, ranks", [("ball", 1), ("ball", 2), ("ball", 5), ("mixed", 3), ("ball.msh", 3),
                                         ("arch.veg", 3), ("ring.node", 3)])
def test_inverse_gives_the_file_back(tmp_path, ball, name, ranks):
    source = ball if name == "ball" else mixed(tmp_path) if name == "mixed" else DATA / name
    if name == "arch.veg":
        source = tmp_path / name
        serial("order", DATA / "arch.msh", "-o", source, "--vertices", "scrambled")
    extension = source.suffix
    out = tmp_path / f"ordered{extension}"
    order(ranks, source, "-o", out, "--parts", "4", "--maps", tmp_path / "m")
    serial("apply", tmp_path / "m", out, "-o", tmp_path / f"back{extension}", "--inverse")
    serial("order", source, "-o", tmp_path / f"same{extension}", "--vertices", "original", "--elements", "original")
    assert (tmp_path / f"back{extension}").read_bytes() == (tmp_path / f"same{extension}").read_bytes()
    serial("apply", tmp_path / "m", source, "-o", tmp_path / f"again{extension}")
    assert (tmp_path / f"again{extension}").read_bytes() == out.read_bytes()


def test_inverse_restores_cells_that_the_output_sorts_by_type(tmp_path):
    source = mixed(tmp_path)
    mesh = meshio.read(source)  # triangles and tetrahedra in turn; Medit groups cells by type
    turns = [block for pair in zip(numpy.array_split(mesh.cells_dict["triangle"], 3),
                                   numpy.array_split(mesh.cells_dict["tetra"], 3)) for block in pair]
    meshio.Mesh(mesh.points, [("triangle" if len(block[0]) == 3 else "tetra", block) for block in turns]).write(source)
    order(2, source, "-o", tmp_path / "ordered.mesh", "--maps", tmp_path / "m")
    serial("apply", tmp_path / "m", source, "-o", tmp_path / "again.mesh")
    assert (tmp_path / "again.mesh").read_bytes() == (tmp_path / "ordered.mesh").read_bytes()


def test_maps_have_the_serial_names(tmp_path, ball):
    order(2, ball, "-o", tmp_path / "a.vtu", "--maps", tmp_path / "parallel")
    serial("order", ball, "-o", tmp_path / "b.vtu", "--maps", tmp_path / "serial")
    names = {path.name.removeprefix("parallel") for path in tmp_path.glob("parallel*")}
    of_parts = {".vertices.parts.npy", ".cells.parts.npy"}
    assert names == {path.name.removeprefix("serial") for path in tmp_path.glob("serial*")} | of_parts and len(names) == 7


def test_parts_of_vertices_and_cells_are_written_with_the_maps(tmp_path, ball):
    result = json.loads(order(3, ball, "-o", tmp_path / "a.vtu", "--parts", "8", "--maps", tmp_path / "m", "--json").stdout)
    vertices, cells = (numpy.load(tmp_path / f"m.{what}.parts.npy") for what in ("vertices", "cells"))
    mesh = meshio.read(tmp_path / "a.vtu")
    assert list(vertices) == sorted(vertices) and set(vertices) == set(range(8)) and len(vertices) == len(mesh.points)
    assert list(numpy.searchsorted(vertices, range(8))) == result["partition"]["first_vertices"]
    assert list(cells) == sorted(cells)
    assert (cells == vertices[mesh.cells[0].data.max(axis=1)]).all()
    serial("order", ball, "-o", tmp_path / "b.vtu", "--maps", tmp_path / "m")
    assert not list(tmp_path.glob("*.parts.npy"))


def test_the_same_bits_in_every_run(tmp_path, ball):
    files = []
    for k in range(3):
        order(3, ball, "-o", tmp_path / f"{k}.vtu", "--parts", "8", "--threads", 1 + k % 2)
        files.append((tmp_path / f"{k}.vtu").read_bytes())
    assert files[0] == files[1] == files[2]


def test_hilbert_gives_the_same_bits_on_every_number_of_ranks(tmp_path, ball):
    files = []
    for ranks in (1, 2, 3, 5):
        order(ranks, ball, "-o", tmp_path / f"{ranks}.vtu", "--partition", "hilbert", "--parts", "7")
        files.append((tmp_path / f"{ranks}.vtu").read_bytes())
    assert files[0] == files[1] == files[2] == files[3]


def test_json_has_parts_ranks_and_stages(tmp_path, ball):
    result = json.loads(order(3, ball, "-o", tmp_path / "a.vtu", "--parts", "6", "--json").stdout)
    expected = json.loads(serial("order", ball, "-o", tmp_path / "b.vtu", "--vertices", "spectral", "--json").stdout)
    assert result["ranks"] == 3 and result["parts"] == 6 and len(result["memory_bytes"]) == 3
    assert result["partition"]["method"] == "ptscotch" and result["partition"]["because"] is None
    assert 0 < result["partition"]["cut"] < result["partition"]["edges"] and result["partition"]["ghosts"] > 0
    assert result["edge_span"]["before"] == pytest.approx(expected["edge_span"]["before"])
    assert set(result["seconds"]) == {"read", "distribute", "graph", "partition", "order", "cells", "write"}
    assert result["vertices"]["count"] == expected["vertices"]["count"]


@pytest.mark.parametrize("partition", ["ptscotch", "hilbert"])
def test_parts_have_equally_much_of_the_elements(tmp_path, partition):
    """Tetrahedra in one half of a row of cubes, each cut into six, and hexahedra in the other."""
    n, m = 40, 8
    points = numpy.array([(x, y, z) for x in range(n + 1) for y in range(m + 1) for z in range(m + 1)], dtype=float)
    corner = lambda x, y, z: (x * (m + 1) + y) * (m + 1) + z  # noqa: E731
    cubes = numpy.array([[corner(x + a, y + b, z + c) for a, b, c in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1),
                                                                      (1, 0, 1), (1, 1, 1), (0, 1, 1))]
                         for x in range(n) for y in range(m) for z in range(m)])
    half = len(cubes) // 2
    tetrahedra = cubes[:half][:, [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]].reshape(-1, 4)
    meshio.Mesh(points, [("tetra", tetrahedra), ("hexahedron", cubes[half:])]).write(tmp_path / "a.vtu")
    elements = {}
    for balance in ("vertices", "cells"):
        done = order(2, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--maps", tmp_path / "m", "--parts", "4", "--partition",
                     partition, "--balance", balance, "--json")
        result = json.loads(done.stdout)["partition"]
        assert result["balance"] == balance and 1 <= result["imbalance"] <= 1.03 and result["method"] == partition
        elements[balance] = numpy.bincount(numpy.load(tmp_path / "m.cells.parts.npy"), minlength=4)
    # elements between two parts belong to the later part
    assert elements["cells"].max() < 1.25 * elements["cells"].mean() < 1.5 * elements["vertices"].mean() < elements["vertices"].max()


def fiedler_order(ranks, *arguments):
    """The output of `--json` for an order by one Fiedler vector."""
    result = json.loads(order(ranks, *arguments, "--vertices", "fiedler", "--json").stdout)
    assert result["partition"]["method"] == "order" and "partition" not in result["seconds"]
    return result


@pytest.fixture(scope="module")
def torus():
    """A mesh with more vertices than one rank solves alone."""
    made = serial("models", "make", "torus", "--size", "20", "--json")
    return pathlib.Path(json.loads(made.stdout)["models"][0]["path"])


def test_fiedler_is_one_vector_of_all_ranks(tmp_path, torus):
    expected = json.loads(serial("order", torus, "-o", tmp_path / "serial.vtu", "--vertices", "fiedler", "--json").stdout)
    lambda2 = expected["fiedler"]["components"][0]["lambda2"]
    for ranks in (2, 4):
        result = fiedler_order(ranks, torus, "-o", tmp_path / "a.vtu")
        component, = result["fiedler"]["components"]
        assert component["converged"] and component["size"] == 70560 and component["iterations"] < 15
        assert component["lambda2"] == pytest.approx(lambda2, rel=0.01)
        assert result["edge_span"]["after"]["mean"] <= 1.02 * expected["edge_span"]["after"]["mean"]
    parted = json.loads(order(4, torus, "-o", tmp_path / "b.vtu", "--vertices", "fiedler", "--partition", "ptscotch",
                              "--json").stdout)
    assert parted["partition"]["method"] == "ptscotch" and parted["fiedler"] == {"components": []}


def test_the_fiedler_order_has_the_same_bits_in_every_run(tmp_path, torus):
    files = set()
    for threads in (1, 1, 2, 1, 1):
        order(3, torus, "-o", tmp_path / "a.vtu", "--vertices", "fiedler", "--threads", str(threads))
        files.add((tmp_path / "a.vtu").read_bytes())
    assert len(files) == 1


@pytest.mark.parametrize("parts", [2, 7])
def test_spectral_bisection_cuts_as_few_edges_as_ptscotch(tmp_path, torus, parts):
    def cut(method):
        done = order(3, torus, "-o", tmp_path / f"{method}.vtu", "--partition", method, "--parts", parts, "--json")
        return json.loads(done.stdout)["partition"]

    result = cut("rsb")
    assert result["method"] == "rsb" and result["because"] is None and result["imbalance"] < 1.002
    assert result["cut"] <= 1.15 * cut("ptscotch")["cut"]
    first = (tmp_path / "rsb.vtu").read_bytes()
    cut("rsb")
    assert (tmp_path / "rsb.vtu").read_bytes() == first


def test_spectral_bisection_shares_out_cells(tmp_path, torus):
    done = order(2, torus, "-o", tmp_path / "a.vtu", "--partition", "rsb", "--parts", 5, "--balance", "cells", "--json")
    result = json.loads(done.stdout)["partition"]
    assert result["balance"] == "cells" and result["imbalance"] < 1.01


def test_parts_of_the_fiedler_order_are_equal_ranges_of_it(tmp_path, ball):
    result = fiedler_order(3, ball, "-o", tmp_path / "a.vtu", "--parts", "7", "--maps", tmp_path / "m", "--pieces", tmp_path / "p")
    counts = numpy.bincount(numpy.load(tmp_path / "m.vertices.parts.npy"))
    assert len(counts) == 7 and counts.max() - counts.min() <= 1
    assert list(numpy.cumsum(counts) - counts) == result["partition"]["first_vertices"]
    mesh = meshio.read(tmp_path / "a.vtu")
    tetrahedra = mesh.cells_dict["tetra"]
    edges = numpy.unique(numpy.sort(numpy.concatenate([tetrahedra[:, pair] for pair in
                                                       ([0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3])])), axis=0)
    part = numpy.searchsorted(result["partition"]["first_vertices"], edges, side="right")
    crossing = edges[part[:, 0] != part[:, 1]]
    assert result["partition"]["cut"] == len(crossing) and result["partition"]["edges"] == len(edges)
    assert sum(result["partition"]["interface_vertices"]) == len(numpy.unique(crossing))
    needed = {(int(there), int(vertex)) for edge, parts in zip(edges, part) for vertex, here, there in
              ((edge[0], parts[0], parts[1]), (edge[1], parts[1], parts[0])) if here != there}
    assert result["partition"]["ghosts"] == len(needed)
    assert len(list((tmp_path / "p").glob("*.vtu"))) == 7
    serial("apply", tmp_path / "m", tmp_path / "a.vtu", "-o", tmp_path / "back.vtu", "--inverse")
    serial("order", ball, "-o", tmp_path / "same.vtu", "--vertices", "original", "--elements", "original")
    assert (tmp_path / "back.vtu").read_bytes() == (tmp_path / "same.vtu").read_bytes()


def test_a_fiedler_order_of_few_vertices_in_pieces_that_nothing_joins(tmp_path):
    points = numpy.array([[0, 0, 0], [5, 0, 0], [0, 1, 0], [1, 0, 0], [5, 1, 0], [6, 0, 0], [1, 1, 0], [9, 9, 9]], float)
    meshio.Mesh(points, [("triangle", numpy.array([[1, 4, 5], [0, 2, 3], [2, 3, 6]]))]).write(tmp_path / "a.vtu")
    result = fiedler_order(5, tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", "--maps", tmp_path / "m")
    assert [component["size"] for component in result["fiedler"]["components"]] == [4, 3]
    places = numpy.load(tmp_path / "m.vertices.old_to_new.npy")
    assert set(places[[0, 2, 3, 6]]) == {0, 1, 2, 3} and set(places[[1, 4, 5]]) == {4, 5, 6} and places[7] == 7


def test_small_meshes_are_cut_along_the_curve_with_a_note(tmp_path):
    grid = json.loads(serial("models", "make", "grid", "--size", "3", "--json").stdout)["models"][0]["path"]
    done = order(2, grid, "-o", tmp_path / "a.vtu", "--json")
    assert json.loads(done.stdout)["partition"]["method"] == "hilbert"
    assert len(own_lines(done)) == 1 and "Hilbert's curve" in done.stderr


@pytest.mark.parametrize("arguments, part", [
    (["order", "nothing.vtu", "-o", "out.vtu"], "nothing.vtu: no such file"),
    (["order", "damaged.vtu", "-o", "out.vtu"], "damaged.vtu"),
    (["order", "BALL", "-o", "nowhere/out.vtu"], "nowhere"),
    (["order", "BALL", "-o", "full.vtu"], "full"),
    (["order", "BALL", "-o", "out.vtu", "--vertices", "original"], "'original' within parts"),
    (["order", "BALL", "-o", "out.vtu", "--partition", "metis"], "metis"),
    (["order", "BALL", "-o", "out.vtu", "--partition", "order"], "partitions ptscotch"),
    (["order", "BALL", "-o", "out.vtu", "--vertices", "fiedler", "--interface", "last"], "partitions ptscotch"),
    (["order", "BALL", "-o", "out.vtu", "--vertices", "fiedler", "--balance", "cells"], "partitions ptscotch"),
    (["order", "BALL", "-o", "out.vtu", "--part", "2"], "unknown option '--part'"),
    (["order", "BALL", "-o", "out.vtu", "--parts", "100000000"], "vertices, too few for 100,000,000 parts"),
    (["order", "BALL", "-o", "out.vtu", "--maps", ""], "--maps: the value is empty"),
    (["info", "BALL"], "start `info` without mpirun"),
])
def test_what_fails_ends_all_ranks_with_one_line(tmp_path, monkeypatch, ball, arguments, part):
    monkeypatch.chdir(tmp_path)
    serial("order", ball, "-o", "whole.vtu")
    whole = pathlib.Path("whole.vtu").read_bytes()
    pathlib.Path("damaged.vtu").write_bytes(whole[:len(whole) // 2])
    os.symlink("/dev/full", "full.vtu")
    before = sorted(os.listdir())
    done = launch(3, *[str(ball) if word == "BALL" else word for word in arguments])
    assert done.returncode == 2, done.stderr
    assert len(own_lines(done)) == 1 and part in own_lines(done)[0], done.stderr
    assert sorted(os.listdir()) == before


@pytest.mark.parametrize("kind, unseen, options", [
    *((kind, "input", ["-o", "{all}/b.{kind}"]) for kind in ("vtu", "vtkhdf", "xdmf")),
    *((kind, "output", ["-o", "out/b.{kind}"]) for kind in ("vtu", "vtkhdf", "xdmf")),
    *((kind, "maps", ["-o", "{all}/b.{kind}", "--maps", "out/m"]) for kind in ("vtu", "vtkhdf", "xdmf")),
    *((kind, "pieces", ["--pieces", f"out/p{end}"]) for kind in ("vtu", "vtkhdf") for end in ("", ".vtkhdf")),
])
def test_what_only_rank_0_sees_ends_all_ranks(tmp_path, ball, kind, unseen, options):
    for folder in ("here", "there"):
        (tmp_path / folder).mkdir()
        if unseen != "input" or folder == "here":
            subprocess.run([MESHORDER, "order", ball, "-q", "-o", tmp_path / folder / f"a.{kind}"], check=True)
    (tmp_path / "here" / "out").mkdir()
    before = sorted(str(path) for path in tmp_path.rglob("*"))
    command = [str(MESHORDER), "order", f"a.{kind}", *(option.format(kind=kind, all=tmp_path) for option in options)]
    start = [*MPIRUN, "-n", "1", "--wdir", tmp_path / "here", *command, ":", "-n", "2", "--wdir", tmp_path / "there", *command]
    done = subprocess.run(start, env=environment(), capture_output=True, text=True, timeout=SECONDS, check=False)
    assert done.returncode == 2 and len(own_lines(done)) == 1, done.stderr
    assert "rank 1: " in own_lines(done)[0] and "o such file" in own_lines(done)[0], done.stderr
    assert sorted(str(path) for path in tmp_path.rglob("*")) == before


@pytest.mark.parametrize("limited", [0, 1])
@pytest.mark.parametrize("options", [["-o", "b.vtu"], ["-o", "b.vtkhdf"], ["-o", "b.msh"], ["--pieces", "p"],
                                     ["--pieces", "p.vtkhdf"], ["--pieces", "p.e"]])
def test_one_rank_that_cannot_write_ends_all(tmp_path, ball, options, limited):
    """A limit on the size of one rank's files acts like a full disk."""
    kind = options[1].partition(".")[2] if "-o" in options else "e"
    subprocess.run([MESHORDER, "order", ball, "-q", "-o", tmp_path / f"a.{kind}"], check=True)
    words = [MESHORDER, "order", tmp_path / f"a.{kind}", options[0], tmp_path / options[1]]
    start = [*MPIRUN]
    for rank in range(3):
        limit = ["bash", "-c", 'ulimit -f 40; exec "$@"', "-"] if rank == limited else []
        start += [":"] * (rank > 0) + ["-n", "1", *limit, *words]
    began = time.monotonic()
    done = subprocess.run(start, env=environment(), capture_output=True, text=True, timeout=SECONDS, check=False)
    if done.returncode == 0:  # this rank writes less than the limit, or nothing
        assert limited == 1, done.stderr
        return
    assert time.monotonic() - began < 20
    assert done.returncode == 2 and len(own_lines(done)) == 1, done.stderr
    assert os.listdir(tmp_path) == [f"a.{kind}"]


def test_options_of_one_process_are_named_as_such(tmp_path):
    """The parallel command has the options of the serial one, or its message says that the serial one has them."""
    helps = (subprocess.run([MESHORDER.with_name(program), "order", "--help"], capture_output=True, text=True, check=True)
             for program in ("meshorder", "meshorder-mpi"))
    of_order, of_ranks = (set(re.findall(r"^  (?:-.,)?(--[a-z-]+)", shown.stdout, re.MULTILINE)) for shown in helps)
    for option in sorted(of_order - of_ranks):
        done = launch(1, "order", tmp_path / "a.vtu", "-o", tmp_path / "b.vtu", option, "value")
        assert done.returncode == 2
        assert own_lines(done) == [
            f"meshorder: '{option}' is not supported with --parts or several ranks; leave it out"]
    assert {"--for", "--elements", "--group-by"} <= of_order - of_ranks


def test_parts_keep_the_groups_of_obj_together(tmp_path):
    faces = [f"f {k + 1} {k + 2} {k + 22}" for k in range(400) if k % 21 < 20]
    lines = [f"v {k % 21} {k // 21} 0" for k in range(441)]
    for group in range(4):
        lines += [f"g part{group}", *faces[group::4]]
    (tmp_path / "a.obj").write_text("\n".join(lines) + "\n")
    done = launch(1, "order", tmp_path / "a.obj", "-o", tmp_path / "b.obj", "--parts", "3")
    assert done.returncode == 0, done.stderr
    assert sum(line.startswith("g ") for line in (tmp_path / "b.obj").read_text().splitlines()) == 4


def test_one_rank_started_by_mpirun_makes_one_piece(tmp_path, ball):
    done = subprocess.run([*MPIRUN, "-n", "1", MESHORDER, "order", ball, "--pieces", tmp_path / "out"], env=environment(),
                          capture_output=True, text=True, timeout=SECONDS, check=False)
    assert done.returncode == 0, done.stderr
    assert len(os.listdir(tmp_path / "out")) == 2


def test_one_process_needs_the_number_of_pieces(tmp_path, ball):
    done = launch(1, "order", ball, "--pieces", tmp_path / "out")
    assert done.returncode == 2 and "give --parts N, or start it with mpirun -n N" in own_lines(done)[0]
    assert os.listdir(tmp_path) == []


@pytest.fixture
def matrix(tmp_path):
    """A chain whose rows are in a poor order, as a matrix without coordinates."""
    places = numpy.random.default_rng(1).permutation(400)
    entries = [f"{max(a, b) + 1} {min(a, b) + 1} {k}.5\n" for k, (a, b) in enumerate(zip(places, places[1:]))]
    (tmp_path / "a.mtx").write_text("%%MatrixMarket matrix coordinate real symmetric\n400 400 399\n" + "".join(entries))
    return tmp_path / "a.mtx"


@pytest.mark.parametrize("options, needs", [(["--vertices", "hilbert"], "the order 'hilbert'"),
                                            (["--partition", "hilbert"], "the partition 'hilbert'")])
def test_a_matrix_without_coordinates_has_no_geometric_order(tmp_path, matrix, options, needs):
    done = launch(2, "order", matrix, "-o", tmp_path / "b.mtx", *options)
    assert done.returncode == 2 and len(own_lines(done)) == 1
    assert f"a.mtx has no coordinates, which {needs} needs; give them with --points FILE" in own_lines(done)[0]
    assert not (tmp_path / "b.mtx").exists()
    numpy.savetxt(tmp_path / "points.txt", numpy.random.default_rng(2).random((400, 3)))
    order(2, matrix, "-o", tmp_path / "b.mtx", "--points", tmp_path / "points.txt", *options)


def test_more_parts_than_rows_are_refused_in_the_terms_of_matrices(tmp_path, matrix):
    done = launch(2, "order", matrix, "-o", tmp_path / "b.mtx", "--parts", "500")
    assert done.returncode == 2
    assert own_lines(done) == ["meshorder: --parts: the matrix has 400 rows, too few for 500 parts"]


def test_a_matrix_is_spoken_of_as_by_one_process(tmp_path, matrix):
    one = serial("order", matrix, "-o", tmp_path / "b.mtx", "--vertices", "spectral").stdout
    done = order(2, matrix, "-o", tmp_path / "b.mtx", "--vertices", "spectral").stdout
    for line in ("rows       spectral", "entries    keep their places in the file", "distance   mean "):
        assert line in one and line in done
    assert "elements" not in done
    old, new = (numpy.loadtxt(name, skiprows=2)[:, 2] for name in (matrix, tmp_path / "b.mtx"))
    assert (old == new).all()


@pytest.mark.parametrize("name", ["a.mtx", "a.graph"])
def test_maps_of_a_matrix_give_it_back(tmp_path, matrix, name):
    if name == "a.graph":
        ends = numpy.loadtxt(matrix, skiprows=2)[:, :2].astype(int)
        rows = [sorted([*ends[ends[:, 0] == v, 1], *ends[ends[:, 1] == v, 0]]) for v in range(1, 401)]
        (tmp_path / name).write_text("400 399\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows))
    kind = name[1:]
    order(2, tmp_path / name, "-o", tmp_path / f"b{kind}", "--maps", tmp_path / "m")
    serial("apply", tmp_path / "m", tmp_path / f"b{kind}", "-o", tmp_path / f"back{kind}", "--inverse")
    serial("order", tmp_path / name, "-o", tmp_path / f"same{kind}", "--vertices", "original")
    assert (tmp_path / f"back{kind}").read_bytes() == (tmp_path / f"same{kind}").read_bytes()


def test_without_arguments_it_ends_as_one_process_does():
    done = launch(2)
    assert done.returncode == 2 and done.stdout == "" and "SUBCOMMAND" in done.stderr
    assert launch(2, "--help").returncode == 0


def is_running(process):
    """Whether a process exists and is no zombie."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def ranks_of(parent):
    children = subprocess.run(["ps", "--ppid", str(parent), "-o", "pid=,comm="], capture_output=True, text=True,
                              check=False).stdout.split("\n")
    return [int(line.split()[0]) for line in children if "meshorder-mpi" in line]


@pytest.mark.parametrize("which", [0, -1])
def test_a_rank_that_is_killed_ends_all_and_leaves_nothing(tmp_path, which):
    large = json.loads(serial("models", "make", "ball", "--size", "45", "--json").stdout)["models"][0]["path"]
    with subprocess.Popen([*MPIRUN, "-n", "3", MESHORDER, "order", large, "-o", tmp_path / "out.vtu"],
                          env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        ranks = []
        while len(ranks) < 3 and running.poll() is None:
            ranks = ranks_of(running.pid)
        time.sleep(0.3)
        os.kill(ranks[which], signal.SIGKILL)
        killed = time.monotonic()
        while any(map(is_running, ranks)) and time.monotonic() - killed < SECONDS:
            time.sleep(0.02)
        seconds = time.monotonic() - killed
        try:
            running.communicate(timeout=10)
        except subprocess.TimeoutExpired:  # Open MPI 4.1.4's launcher may stay when all its ranks have ended
            running.kill()
    assert seconds < 5
    assert running.returncode != 0
    assert os.listdir(tmp_path) == []


def test_without_the_program_beside_it_says_what_to_build(tmp_path, ball):
    alone = tmp_path / "meshorder"
    shutil.copy(MESHORDER, alone)
    words = [alone, "order", ball, "-o", tmp_path / "out.vtu"]
    for rank, lines in ((0, 1), (1, 0)):
        for size_name, rank_name in (("OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"), ("PMI_SIZE", "PMI_RANK"),
                                     ("SLURM_STEP_NUM_TASKS", "SLURM_PROCID")):
            done = subprocess.run(words, env=environment(**{size_name: "2", rank_name: str(rank)}), capture_output=True,
                                  text=True, check=False)
            assert done.returncode == 2 and len(done.stderr.splitlines()) == lines
            assert not lines or "MESHORDER_MPI=ON" in done.stderr
    assert not (tmp_path / "out.vtu").exists()


@pytest.mark.parametrize("variables", [{"SLURM_NTASKS": "4"}, {"OMPI_COMM_WORLD_SIZE": "1", "PMIX_RANK": "0"}])
def test_one_process_orders_by_itself(tmp_path, ball, variables):
    done = subprocess.run([MESHORDER, "order", ball, "-o", tmp_path / "out.vtu", "--json"], env=environment(**variables),
                          capture_output=True, text=True, check=True)
    assert "ranks" not in json.loads(done.stdout)


def test_one_process_makes_the_same_parts(tmp_path, ball):
    for start in ([], [*MPIRUN, "-n", "1"], [*MPIRUN, "-n", "3"]):
        name = str(tmp_path / f"{len(start)}{start[-1:]}")
        words = [*start, MESHORDER, "order", ball, "-o", f"{name}.vtu", "--maps", name, "--parts=5", "--partition", "hilbert"]
        subprocess.run(words, env=environment(), check=True, timeout=SECONDS, capture_output=True)
    for end in (".vtu", ".vertices.old_to_new.npy", ".cells.parts.npy"):
        assert len({path.read_bytes() for path in tmp_path.glob(f"*{end}")}) == 1, end


@pytest.mark.parametrize("size, rank", [("PMI_SIZE", "PMI_RANK"), ("SLURM_STEP_NUM_TASKS", "SLURM_PROCID")])
def test_a_launcher_of_another_mpi_is_reported(tmp_path, ball, size, rank):
    """Otherwise each process would order the mesh by itself and write the same file."""
    for k, lines in ((0, 1), (1, 0)):
        done = subprocess.run([MESHORDER, "order", ball, "-o", tmp_path / "out.vtu"], capture_output=True, text=True, check=False,
                              env=environment(**{size: "2", rank: str(k)}), timeout=SECONDS)
        assert done.returncode == 2 and len(own_lines(done)) == lines, done.stderr
        assert not lines or "MPI sees each of them alone" in own_lines(done)[0], done.stderr
    assert os.listdir(tmp_path) == []


def test_a_vertex_with_a_million_neighbours(tmp_path):
    count = 1_000_000
    points = numpy.zeros((count + 1, 3))
    points[1:, 0], points[1:, 1] = numpy.arange(count), numpy.arange(count) % 7
    rim = numpy.arange(1, count)
    meshio.Mesh(points, [("triangle", numpy.column_stack([0 * rim, rim, rim + 1]))]).write(tmp_path / "fan.vtu", binary=True)
    done = json.loads(order(3, tmp_path / "fan.vtu", "-o", tmp_path / "b.vtu", "--partition", "hilbert", "--json").stdout)
    assert max(done["memory_bytes"]) < 1 << 30
    assert sorted(meshio.read(tmp_path / "b.vtu").points[:, 0]) == sorted(points[:, 0])
