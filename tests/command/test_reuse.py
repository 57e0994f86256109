# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Predicted cache misses of `info` and `compare` against simulated caches."""
import collections
import math

import meshes
import pytest


def spmv_lines(points, cells):
    """The lines of 64 bytes that a product with the matrix of 3 × 3 blocks touches, in order. Lines of offsets, columns,
    values and y, which are read once from end to end, appear once."""
    neighbours = [{v} for v in range(len(points))]
    for cell in cells:
        for v in cell:
            neighbours[v].update(map(int, cell))
    read = set()

    def lines_of(array, byte, count, once=True):
        for line in range(byte // 64, (byte + count - 1) // 64 + 1):
            if once and (array, line) in read:
                continue
            read.add((array, line))
            yield array, line

    block = 0
    yield from lines_of("offsets", 0, 8)
    for v, row in enumerate(neighbours):
        yield from lines_of("offsets", 8 * (v + 1), 8)
        for column in sorted(row):
            yield from lines_of("columns", 4 * block, 4)
            yield from lines_of("values", 8 * block, 8)
            yield from lines_of("x", 8 * column, 8, once=False)
            block += 1
        yield from lines_of("y", 8 * v, 8)


def misses_when_repeated(lines, capacity):
    held = collections.OrderedDict()
    for run in range(2):
        misses = 0
        for line in lines:
            if line in held:
                held.move_to_end(line)
                continue
            misses += 1
            held[line] = True
            if len(held) > capacity:
                held.popitem(last=False)
    return misses


def mean_log2_when_repeated(lines):
    stack = []
    for run in range(2):
        distances = []
        for line in lines:
            if line in stack:
                distances.append(len(stack) - 1 - stack.index(line))
                stack.remove(line)
            stack.append(line)
    return sum(math.log2(distance + 1) for distance in distances) / len(distances)


def test_info_predicts_the_misses_of_caches(command):
    made = command.json("models", "make", "grid", "--size", "6")["models"][0]["path"]
    lines = list(spmv_lines(*meshes.read_tetgen(made)))
    result = command.json("info", made, "--cache", "1K,4K,64K,1G")
    assert result["caches"] == [2**10, 2**12, 2**16, 2**30]
    assert set(result["reuse"]) == {"spmv", "element", "assembly", "springs"}
    spmv = result["reuse"]["spmv"]
    assert spmv["accesses"] == len(lines)
    assert spmv["misses"] == [misses_when_repeated(lines, size // 64) for size in result["caches"]]
    assert all(0 <= jumps <= misses for jumps, misses in zip(spmv["jumps"], spmv["misses"]))
    assert 0 < spmv["misses"][1] < spmv["misses"][0] < len(lines) and spmv["misses"][3] == 0
    assert spmv["mean_log2"] == pytest.approx(mean_log2_when_repeated(lines), abs=1e-2)


def test_compare_predicts_what_info_says_of_the_reordered_file(command):
    made = command.json("models", "make", "grid", "--size", "6")["models"][0]["path"]
    result = command.json("compare", made, "--methods", "scrambled,rcm", "--budget", "0.1", "--cache", "2K,16K")
    assert result["caches"] == [2**11, 2**14]
    original, scrambled, rcm = (method["reuse"] for method in result["methods"])
    assert original == command.json("info", made, "--cache", "2K,16K")["reuse"]
    command.ok("order", made, "-o", "rcm.node", "--vertices", "rcm", "--elements", "lexmax")
    assert rcm == command.json("info", "rcm.node", "--cache", "2K,16K")["reuse"]
    for kernel in original:
        assert original[kernel]["misses"][0] < scrambled[kernel]["misses"][0]


def test_compare_predicts_obj_files_whose_faces_are_grouped_by_material(command):
    """`order` keeps the faces of a material together, and so cannot give every cell its best place."""
    side = 12
    lines = [f"v {x} {y} 0" for y in range(side) for x in range(side)]
    for y in range(side - 1):
        for x in range(side - 1):
            v = y * side + x + 1
            lines += [f"usemtl m{(x + y) % 3}", f"f {v} {v + 1} {v + side}", f"f {v + 1} {v + side + 1} {v + side}"]
    (command.folder / "a.obj").write_text("\n".join(lines) + "\n")
    result = command.json("compare", "a.obj", "--methods", "scrambled/lexmax", "--budget", "0.1", "--cache", "1K,4K")
    command.ok("order", "a.obj", "-o", "b.obj", "--vertices", "scrambled", "--elements", "lexmax")
    assert result["methods"][1]["reuse"] == command.json("info", "b.obj", "--cache", "1K,4K")["reuse"]


def test_threads_do_not_change_predictions(command):
    made = command.json("models", "make", "grid", "--size", "6")["models"][0]["path"]
    one, three = (command.json("info", made, "--threads", threads) for threads in "13")
    del one["verdict"], three["verdict"]  # contain times
    assert one == three


def test_caches_are_the_papers_or_this_machines(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    assert command.json("info", "mesh.node", "--cache", "paper")["caches"] == [2**15, 2**18, 10 * 2**20]
    here = command.json("info", "mesh.node")["caches"]
    assert here and here == sorted(here) == command.json("compare", "mesh.node", "--budget", "0.01", "--methods", "rcm")["caches"]
    assert "48K" in command.ok("info", "mesh.node", "--details", "--cache", "48K").stdout


def test_senseless_caches_are_refused(command, tmp_path):
    meshes.write_tetgen(tmp_path)
    for caches in "big", "48", "1M,48K":
        assert "caches" in command.fails("info", "mesh.node", "--cache", caches)
        assert "caches" in command.fails("compare", "mesh.node", "--cache", caches)
