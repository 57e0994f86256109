#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Fuzzes the Python package with arrays of all types, shapes and strides, by atheris:

    python arrays.py -max_total_time=60 CORPUS

Each call must return a bijection or raise one of the exceptions that the package documents.
"""
import sys

import atheris

with atheris.instrument_imports(include=["meshorder"]):
    import meshorder

import numpy as np

TYPES = ["i1", "u1", "i2", "i4", "u4", "i8", "u8", "f4", "f8", ">i4", ">f8", "c16", "?", "S3", "O", "M8[s]"]
METHODS = [method.name for method in meshorder.methods()] + ["auto", "nothing"]


def numbers(data, size, end):
    """Returns an array of about `size` numbers, most of them from 0 to `end`."""
    count = size if data.ConsumeProbability() < 0.9 else data.ConsumeIntInRange(0, 2 * size + 2)
    kind = data.PickValueInList(TYPES) if data.ConsumeProbability() < 0.3 else "i8"
    values = [data.ConsumeIntInRange(-1, end) if data.ConsumeProbability() < 0.95 else data.ConsumeInt(8) for _ in range(count)]
    with np.errstate(all="ignore"):
        try:
            array = np.array(values, dtype="O").astype(kind)
        except (OverflowError, ValueError):
            array = np.array([value % 100 for value in values], dtype="i8")
    how = data.ConsumeIntInRange(0, 7)
    if how == 1:
        array = np.repeat(array, 2)[::2]
    elif how == 2:
        array = array[::-1]
    elif how == 3:
        array = array.reshape(-1, 1)
    elif how == 4:
        array.flags.writeable = False
    elif how == 5:
        return array.tolist()
    return array


def offsets(data, rows, entries):
    """Returns offsets of rows, which ascend most of the time."""
    inner = sorted(data.ConsumeIntInRange(0, entries) for _ in range(max(rows - 1, 0)))
    array = np.array([0, *inner, entries][: rows + 1])
    if data.ConsumeProbability() < 0.1 and len(array):
        array[data.ConsumeIntInRange(0, len(array) - 1)] = data.ConsumeInt(8)
    return array


def reals(data, rows, columns):
    array = np.array([data.ConsumeFloat() if data.ConsumeProbability() < 0.1 else data.ConsumeIntInRange(0, 99)
                      for _ in range(rows * columns)], dtype=data.PickValueInList(["f8", "f4", "f8", "i4"]))
    array = array.reshape(rows, columns)
    return np.asfortranarray(array) if data.ConsumeBool() else array


def expect_bijection(permutation, n):
    if sorted(permutation.new_to_old) != list(range(n)):
        raise AssertionError("an order is no bijection")


def order_graph(data):
    n, entries = data.ConsumeIntInRange(0, 24), data.ConsumeIntInRange(0, 80)
    graph = (offsets(data, n, entries), numbers(data, entries, max(n - 1, 0)))
    options = {"symmetrize": data.ConsumeBool(), "threads": 1}
    if data.ConsumeBool():
        options["points"] = reals(data, n, data.ConsumeIntInRange(0, 4))
    order = meshorder.order(graph, data.PickValueInList(METHODS), **options)
    expect_bijection(order.permutation, n)
    meshorder.quality(graph, order)


def order_mesh(data):
    n, cells, size = data.ConsumeIntInRange(0, 24), data.ConsumeIntInRange(0, 24), data.ConsumeIntInRange(0, 9)
    kind = data.PickValueInList(["tetra", "triangle", "hexahedron", "line", "nonsense"])
    connectivity = np.asarray(numbers(data, cells * size, max(n - 1, 0)))
    if connectivity.size == cells * size:
        connectivity = connectivity.reshape(cells, size)
    order = meshorder.order_mesh(reals(data, n, data.ConsumeIntInRange(1, 4)), [(kind, connectivity)],
                                 vertices=data.PickValueInList(METHODS), threads=1)
    expect_bijection(order.vertices.permutation, n)


def permutation(data):
    n = data.ConsumeIntInRange(0, 16)
    order = meshorder.Permutation(new_to_old=numbers(data, n, max(n - 1, 0)))
    expect_bijection(order, len(order))
    order.move(numbers(data, n, 9))
    order.renumber(numbers(data, n, max(n - 1, 0)))


def read(data):
    kind = data.PickValueInList(["gmsh", "vtu", "off", "ply", ""])
    meshorder.read(data.ConsumeBytes(4096), **({"format": kind} if kind else {}))


def test_one_input(input_bytes):
    data = atheris.FuzzedDataProvider(input_bytes)
    try:
        data.PickValueInList([order_graph, order_mesh, permutation, read])(data)
    except (meshorder.InternalError, SystemError, MemoryError):
        raise
    except (meshorder.Error, TypeError, ValueError, OverflowError, IndexError):
        pass


if __name__ == "__main__":
    atheris.Setup(sys.argv, test_one_input)
    atheris.Fuzz()
