# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Messages of `info`, `compare`, `order` and `report` on matrices and graphs, also with coordinates in another file."""
import json
import random
import struct

import pytest

from meshes import write_tetgen

OTHER_KERNELS = ("element", "assembly", "springs")


def lattice(n, seed=1):
    """The entries on and below the diagonal of the Laplacian of an n × n × n lattice, and each row's point."""
    places = list(range(n**3))
    random.Random(seed).shuffle(places)
    points = [None] * n**3
    entries = []
    for x in range(n):
        for y in range(n):
            for z in range(n):
                i = (x * n + y) * n + z
                points[places[i]] = (x, y, z)
                entries.append((places[i], places[i]))
                for step, inside in ((1, z + 1 < n), (n, y + 1 < n), (n * n, x + 1 < n)):
                    if inside:
                        a, b = places[i], places[i + step]
                        entries.append((max(a, b), min(a, b)))
    return sorted(entries), points


def write_matrix(path, rows, entries, symmetry="symmetric"):
    lines = [f"{i + 1} {j + 1} {6 if i == j else -1}" for i, j in entries]
    path.write_text(f"%%MatrixMarket matrix coordinate real {symmetry}\n{rows} {rows} {len(entries)}\n"
                    + "\n".join(lines) + "\n")


def write_graph(path, rows, entries):
    lists = [[] for _ in range(rows)]
    for i, j in entries:
        if i != j:
            lists[i].append(j + 1)
            lists[j].append(i + 1)
    path.write_text(f"{rows} {sum(map(len, lists)) // 2}\n" + "".join(" ".join(map(str, row)) + "\n" for row in lists))


def write_points(path, points):
    path.write_text("".join(" ".join(map(str, point)) + "\n" for point in points))


@pytest.fixture
def cube(command, tmp_path):
    """A scrambled Laplacian as a.mtx, its graph as a.graph, its points as a.txt; returns entries and points."""
    entries, points = lattice(14)
    write_matrix(tmp_path / "a.mtx", len(points), entries)
    write_graph(tmp_path / "a.graph", len(points), entries)
    write_points(tmp_path / "a.txt", points)
    return entries, points


def full(entries):
    return set(entries) | {(j, i) for i, j in entries}


def test_compare_for_a_use_judges_the_one_column_of_a_matrix(command, cube):
    for matrix in ("a.mtx", "a.graph"):
        for use in ("spmv", "all"):
            text = command.ok("compare", matrix, "--methods", "rcm", "--budget", "0.2", "--for", use).stdout
            assert "rcm" in text and "█" in text


def test_a_matrix_is_described_in_its_words(command, cube):
    entries, points = cube
    rows, whole = len(points), full(entries)
    far = max(abs(i - j) for i, j in whole)
    done = command.ok("info", "a.mtx", "--details")
    text = done.stdout
    assert f"{rows:,} rows, {len(whole):,} entries" in text
    assert "real; one half is stored: symmetric" in text
    assert f"mean {len(whole) / rows:.1f}, most 7 entries" in text
    assert "\npattern      symmetric\n" in text and "\ndiagonal     complete\n" in text
    assert f"\nbandwidth    {far:,}\n" in text
    assert "1 component\n" in text and "blocks" not in text
    assert "Entries by their distance from the diagonal" in text and "Predicted for each product" in text
    assert text.startswith("a.mtx\norder        ") and "\ngain         the gain is not known: up to 1." in text
    for word in ("vertices", "vertex", "cells", "elements", "element force", "assembly", "springs", "time step", "mesh",
                 "coordinates", "on entries"):
        assert word not in text.replace("meshorder", "") + done.stderr, word


def test_the_keys_of_a_matrix(command, cube):
    entries, points = cube
    whole = full(entries)
    result = command.json("info", "a.mtx")
    bins = {}
    for i, j in whole:
        if i != j:
            bins[abs(i - j).bit_length() - 1] = bins.get(abs(i - j).bit_length() - 1, 0) + 1
    assert result["matrix"] == {
        "kind": "matrix", "rows": len(points), "entries": len(whole), "stored": "half", "field": "real",
        "symmetry": "symmetric", "in_a_row": {"mean": len(whole) / len(points), "most": 7}, "symmetric_pattern": True,
        "missing_diagonal": 0, "blocks": None,
        "distance_histogram_log2": [bins.get(k, 0) for k in range(max(bins) + 1)]}
    assert result["vertices"] == len(points) and result["graph"]["edges"] == (len(whole) - len(points)) // 2
    assert set(result["reuse"]) == set(result["verdict"]["kernels"]) == {"spmv"}
    assert result["verdict"]["time_step"] == {"spmv": 1}
    assert set(result["verdict"]["as_it_is"]["predicted_milliseconds"]) == {"spmv"}
    assert result["verdict"]["orders"][0]["command"] == "meshorder order"


def test_a_general_matrix_is_not_made_symmetric_for_the_product(command, tmp_path):
    entries = [(0, 1), (1, 3), (3, 0), (4, 4), (2, 2), (3, 1), (5, 4)]
    write_matrix(tmp_path / "a.mtx", 7, entries, "general")
    done = command.ok("info", "a.mtx")
    assert "7 rows, 7 entries" in done.stdout and "one half" not in done.stdout
    assert "not symmetric: orders use that of A + A'" in done.stdout
    assert "5 of 7 entries are missing" in done.stdout
    assert "2 components, 2 rows that no entry joins to others" in done.stdout
    # the lines of 64 bytes that a product touches: one gathered line per entry, and starts, columns, values, y
    accesses = command.json("info", "a.mtx")["reuse"]["spmv"]["accesses"]
    assert accesses == 7 + 1 + 1 + 1 + 1
    write_matrix(tmp_path / "b.mtx", 7, sorted(full(entries) | {(i, i) for i in range(7)}), "general")
    assert command.json("info", "b.mtx")["reuse"]["spmv"]["accesses"] > accesses


@pytest.mark.parametrize("block", [2, 3, 6])
def test_dense_blocks_are_found(command, tmp_path, block):
    def entries(missing):
        return [(block * a + i, block * b + j) for a in range(40) for b in (a, (a * 7 + 3) % 40)
                for i in range(block) for j in range(block) if (i + block * j + a) % 10 >= missing]

    write_matrix(tmp_path / "a.mtx", 40 * block, sorted(set(entries(0))), "general")
    assert f"\nblocks       {block}×{block}, 100 % full\n" in command.ok("info", "a.mtx").stdout
    assert command.json("info", "a.mtx")["matrix"]["blocks"] == {"size": block, "fill": 1}
    write_matrix(tmp_path / "a.mtx", 40 * block, sorted(set(entries(4))), "general")
    assert "blocks" not in command.ok("info", "a.mtx").stdout


def test_a_graph_is_described_in_its_words(command, cube):
    entries, points = cube
    edges = sum(i != j for i, j in entries)
    text = command.ok("info", "a.graph", "--details").stdout
    assert f"graph        {len(points):,} vertices, {edges:,} edges\n" in text
    assert f"degree       mean {2 * edges / len(points):.1f}, most 6\n" in text
    assert "Edges by the distance of their ends" in text and "diagonal" not in text and "rows" not in text
    result = command.json("info", "a.graph")["matrix"]
    assert result["kind"] == "graph" and result["entries"] == 2 * edges and result["missing_diagonal"] == len(points)


@pytest.mark.parametrize("name", ["a.mtx", "a.graph"])
def test_orders_of_a_matrix_are_compared_by_its_product(command, cube, name):
    done = command.ok("compare", name, "--methods", "original,rcm", "--budget", "0.1")
    assert "order                          cost product" in done.stdout and done.stdout.startswith(f"{name}: ")
    for word in ("element", "assembly", "springs", "lexmax", "mesh", "cells", "span"):
        assert word not in done.stdout.replace("meshorder", ""), word
    result = command.json("compare", name, "--methods", "original,rcm", "--budget", "0.1")
    assert [method["vertices"] for method in result["methods"]] == ["original", "rcm"]
    for of_order in [*result["methods"], result["band"]]:
        assert set(of_order["kernels"]) == {"spmv"} and of_order["kernels"]["spmv"]["best_milliseconds"] > 0
        assert set(of_order.get("reuse", ["spmv"])) == {"spmv"}
    assert {method["elements"] for method in result["methods"]} == {"original"}


def test_a_comparison_by_default_leaves_out_what_needs_coordinates(command, cube):
    def methods(*options):
        methods = command.json("compare", "a.mtx", "--budget", "0.01", *options)["methods"]
        return {method["taken"]["vertices"] for method in methods}

    without, given = methods(), methods("--points", "a.txt")
    assert given - without == {"hilbert", "morton", "hilbert-fronts"} and without < given


def test_entries_keep_their_places_in_the_file(command, cube, tmp_path):
    done = command.ok("order", "a.mtx", "-o", "b.mtx", "--maps", "m")
    assert "entries    keep their places in the file" in done.stdout and "rows       bfs (auto)" in done.stdout
    assert "vertices " not in done.stdout and "elements" not in done.stdout
    with open(tmp_path / "m.cells.new_to_old.npy", "rb") as file:
        count = len(cube[0])
        assert list(struct.unpack(f"<{count}i", file.read()[-4 * count:])) == list(range(count))
    with open(tmp_path / "m.vertices.old_to_new.npy", "rb") as file:
        count = len(cube[1])
        places = struct.unpack(f"<{count}i", file.read()[-4 * count:])
    moved = [(places[i], places[j]) for i, j in cube[0]]
    written = [tuple(map(int, line.split()[:2])) for line in (tmp_path / "b.mtx").read_text().splitlines()[2:]]
    assert written == [(max(i, j) + 1, min(i, j) + 1) for i, j in moved]
    command.ok("apply", "m", "b.mtx", "-o", "c.mtx", "--inverse")
    assert (tmp_path / "c.mtx").read_bytes() == (tmp_path / "a.mtx").read_bytes()


@pytest.mark.parametrize("option", ["--predict", "--measure"])
def test_a_race_is_of_products(command, cube, option):
    race = command.json("order", "a.mtx", "-o", "b.mtx", option)["race"]
    assert set(race["kernels"]) == {"spmv"} and len(race["orders"]) == 3
    assert "hilbert-fronts" not in {order["vertices"] for order in race["orders"]}


@pytest.mark.parametrize("arguments", [
    ("order", "a.mtx", "-o", "out.mtx", "--vertices", "hilbert"),
    ("order", "a.graph", "-o", "out.graph", "--vertices", "hilbert-fronts"),
    ("order", "a.mtx", "-o", "out.mtx", "--vertices", "rcm", "--elements", "hilbert"),
    ("compare", "a.mtx", "--methods", "rcm,morton"),
])
def test_orders_by_coordinates_are_refused_without_them(command, cube, tmp_path, arguments):
    line = command.fails(*arguments)
    assert f"{arguments[1]} has no coordinates, which the order '" in line
    assert "give them with --points FILE" in line and ", rcm, bfs" in line
    assert "hilbert," not in line.split("needs none: ")[1]
    assert not list(tmp_path.glob("out*"))


@pytest.mark.parametrize("arguments, words", [
    (("compare", "a.mtx", "--methods", "rcm/lexmax"), "no elements to order"),
    (("compare", "a.mtx", "--kernels", "tuned"), "a matrix has only the plain product"),
    (("info", "a.mtx", "--measure", "--kernels", "tuned"), "a matrix has only the plain product"),
    (("order", "a.mtx", "-o", "out.mtx", "--predict", "--for", "springs"), "springs"),
])
def test_what_a_matrix_has_not_is_refused(command, cube, tmp_path, arguments, words):
    assert words in command.fails(*arguments)
    assert not list(tmp_path.glob("out*"))


def array_of(points):
    columns = [value for column in zip(*points) for value in column]
    return (f"%%MatrixMarket matrix array real general\n{len(points)} {len(points[0])}\n"
            + "\n".join(map(str, columns)) + "\n").encode()


def numpy_of(points):
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({len(points)}, {len(points[0])}), }}"
    header = header.ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + b"".join(
        struct.pack("<d", value) for point in points for value in point)


@pytest.mark.parametrize("name, content", [
    ("p.csv", lambda points: "# x, y, z\n" + "".join(f"{x}, {y},{z} % {i}\n" for i, (x, y, z) in enumerate(points))),
    ("p.npy", numpy_of), ("p.mtx", array_of),
])
def test_coordinates_of_every_kind_give_the_order_of_the_mesh(command, cube, tmp_path, name, content):
    entries, points = cube
    made = content(points)
    (tmp_path / name).write_bytes(made if isinstance(made, bytes) else made.encode())
    done = command.ok("order", "a.mtx", "-o", "b.mtx", "--vertices", "hilbert", "--points", name, "--maps", "m",
                      "--strict")
    assert "warning" not in done.stderr and "rows       hilbert" in done.stdout
    # the same as a mesh of lines with these points
    (tmp_path / "a.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in points)
                                    + "".join(f"l {i + 1} {j + 1}\n" for i, j in entries if i != j))
    command.ok("order", "a.obj", "-o", "b.obj", "--vertices", "hilbert", "--maps", "o")
    maps = [(tmp_path / f"{prefix}.vertices.old_to_new.npy").read_bytes() for prefix in "mo"]
    assert maps[0] == maps[1]
    command.ok("apply", "m", "b.mtx", "-o", "c.mtx", "--inverse")
    assert (tmp_path / "c.mtx").read_bytes() == (tmp_path / "a.mtx").read_bytes()
    assert "already in the new order" in command.fails("apply", "m", "b.mtx", "-o", "d.mtx")
    command.ok("order", "a.mtx", "-o", "b.vtu", "--vertices", "hilbert", "--points", name, "--maps", "v")
    command.ok("apply", "v", "b.vtu", "-o", "c.vtu", "--inverse")


def test_given_coordinates_are_used_and_named(command, cube, tmp_path):
    assert "\ncoordinates  in 3 dimensions\n" in command.ok("info", "a.mtx", "--points", "a.txt").stdout
    write_points(tmp_path / "flat.txt", [point[:2] for point in cube[1]])
    assert "\ncoordinates  in 2 dimensions\n" in command.ok("info", "a.graph", "--points", "flat.txt").stdout
    # for a matrix that is no lattice, auto orders by coordinates
    rows, chance = len(cube[1]), random.Random(5)
    places = sorted((chance.random(), chance.random(), i) for i in range(rows))
    entries = {(i, i) for i in range(rows)}
    for k, (x, y, i) in enumerate(places):
        for u, v, j in places[k + 1:k + 200]:
            if (x - u)**2 + (y - v)**2 < 0.0015:
                entries.add((max(i, j), min(i, j)))
    write_matrix(tmp_path / "c.mtx", rows, sorted(entries))
    write_points(tmp_path / "c.txt", [point[:2] for point in sorted(places, key=lambda point: point[2])])
    assert command.json("order", "c.mtx", "-o", "d.mtx")["vertices"]["method"] == "bfs"
    by_points = command.json("order", "c.mtx", "-o", "d.mtx", "--points", "c.txt")["vertices"]
    assert by_points["method"] == "hilbert-fronts"
    race = command.json("order", "c.mtx", "-o", "d.mtx", "--points", "c.txt", "--predict")["race"]
    assert race["orders"][0]["vertices"] == "hilbert-fronts"


@pytest.mark.parametrize("content, words", [
    ("1 2 3\n" * 5, "p.txt:6: has 5 rows of coordinates, where 8 are needed"),
    ("1 2 3\n" * 9, "p.txt:9: has more rows of coordinates, where 8 are needed"),
    ("1 2 3\n1 nan 3\n" * 4, "p.txt:2: a coordinate is nan; finite"),
    ("1 2 3\n1 2\n" * 4, "p.txt:2: the row has 2 numbers"),
    ("1 2 x\n" * 8, "p.txt:1: a coordinate is 'x'"),
    ("1 2 3\n" * 8, "all points are the same"),
    ("", "p.txt"),
    (None, "p.txt"),
])
@pytest.mark.parametrize("arguments", [("info",), ("order", "-o", "out.mtx", "--maps", "out"), ("compare",)])
def test_faulty_coordinates_are_refused(command, tmp_path, content, words, arguments):
    write_matrix(tmp_path / "a.mtx", *(lambda entries: (8, entries[0]))(lattice(2)))
    if content is not None:
        (tmp_path / "p.txt").write_text(content)
    assert words in command.fails(*arguments[:1], "a.mtx", *arguments[1:], "--points", "p.txt")
    assert not list(tmp_path.glob("out*"))


@pytest.mark.parametrize("arguments", [("info",), ("order", "-o", "out.node"), ("compare",)])
def test_a_mesh_has_its_own_coordinates(command, tmp_path, arguments):
    write_tetgen(tmp_path)
    write_points(tmp_path / "p.txt", [(0, 1, 2)] * 4 + [(1, 1, 1)])
    line = command.fails(*arguments[:1], "mesh.node", *arguments[1:], "--points", "p.txt")
    assert "--points is for matrices and graphs: mesh.node is a mesh" in line
    assert not list(tmp_path.glob("out*"))


def test_a_report_shows_patterns_and_no_surface(command, cube, tmp_path):
    done = command.ok("report", "a.mtx", "-o", "r.html", "--budget", "0.1")
    assert done.stdout.startswith(f"a.mtx: 2,744 rows, {len(full(cube[0])):,} entries\nVerdict: ")
    page = (tmp_path / "r.html").read_text()
    assert 'data-has="meshes no-surfaces"' in page
    manifest = json.loads(page.split('id="manifest">')[1].split("</script>")[0])
    assert {"original", "meshorder"} <= set(manifest["meshes"][0]["sparsity"])
    assert manifest["meshes"][0]["triangles"] is None
    assert any(words in page for words in ("products take", "nothing to gain", "the gain is not known"))
    for word in ("assembly", "element force", "VF Fiedler"):
        assert word not in page.split("<section")[1] + page.split('id="spans"')[1].split("<script")[0], word
    results = command.json("report", "a.mtx", "-o", "r.html", "--budget", "0.1")["results"]
    kernels = results["meshes"][0]["orders"][0]["kernels"]
    assert kernels["spmv"]["measured_ms"] > 0
    assert all(kernels[kernel]["accesses"] == 0 for kernel in OTHER_KERNELS)


def test_a_matrix_is_no_scenario(command, cube):
    assert "is not a scenario but a file of MatrixMarket" in command.fails("simulate", "a.mtx")


def test_a_diagonal_matrix_has_nothing_to_gain(command, tmp_path):
    (tmp_path / "a.mtx").write_text("%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 1\n2 2 1\n")
    text = command.ok("info", "a.mtx").stdout
    assert text.startswith("a.mtx: nothing to gain: no entry joins two rows, so every order is equally good\n")
