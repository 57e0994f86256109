# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Writes a MED file with everything that a mesh can have, by MED's own library. It is a separate program because the library
brings its own HDF5.

    python3 med_by_library.py OUT.med [SEED]
"""
import ctypes
import itertools
import sys

import numpy

FULL, ALL, CELL, NODE, NODE_OF_ELEMENT, COMPACT = 0, 0, 0, 3, 4, 2
TE4, PE6, HE8, TR3, QU4, SE2 = 304, 306, 308, 203, 204, 102
Int = ctypes.c_int  # med_int of Debian's library
File = ctypes.c_long


def lattice(n, seed):
    """Points and cells by type, in MED's order, points and cells shuffled."""
    chance = numpy.random.default_rng(seed)
    axis = numpy.arange(n + 1)
    z, y, x = numpy.meshgrid(axis, axis, axis, indexing="ij")
    points = numpy.stack([x, y, z], -1).reshape(-1, 3) + chance.uniform(0, 0.1, ((n + 1) ** 3, 3))
    at = lambda i, j, k: i + (n + 1) * (j + (n + 1) * k)  # noqa: E731
    corners = [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0), (0, 0, 1), (0, 1, 1), (1, 1, 1), (1, 0, 1)]
    cubes = numpy.array([[at(i + a, j + b, k + c) for a, b, c in corners]
                         for i, j, k in itertools.product(range(n), repeat=3)])
    thirds = numpy.array_split(cubes, 3)
    tetrahedra = numpy.concatenate([thirds[2][:, list(pick)] for pick in (
        (0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))])
    wedges = numpy.concatenate([thirds[1][:, [0, 1, 2, 4, 5, 6]], thirds[1][:, [0, 2, 3, 4, 6, 7]]])
    cells = {HE8: thirds[0], PE6: wedges, TE4: tetrahedra, QU4: thirds[0][:, :4], TR3: tetrahedra[:, :3],
             SE2: thirds[1][:, :2]}
    place = chance.permutation(len(points))
    shuffled = numpy.empty_like(points)
    shuffled[place] = points
    return shuffled, {kind: chance.permutation(place[rows]) for kind, rows in cells.items()}


def main(path, seed=1):
    med = ctypes.CDLL("libmedC.so.11")
    med.MEDfileOpen.restype = File
    chance = numpy.random.default_rng(seed)
    points, cells = lattice(4, seed)
    mesh, step, time, count = b"part", (Int(-1), Int(-1)), ctypes.c_double(0), len(points)

    def call(name, *arguments):
        def converted(value):
            if isinstance(value, numpy.ndarray):
                return numpy.ascontiguousarray(value).ctypes.data_as(ctypes.c_void_p)
            return value
        assert getattr(med, name)(file, *map(converted, arguments)) == 0, name

    def ints(values):
        return numpy.asarray(values, numpy.int32)

    def words(*texts, width=16):
        return b"".join(text.encode().ljust(width) for text in texts)

    file = File(med.MEDfileOpen(path.encode(), 3))
    call("MEDmeshCr", mesh, Int(3), Int(3), 0, b"made by the library", b"s", 0, 0, words("X", "Y", "Z"),
         words("mm", "mm", "mm"))
    call("MEDmeshNodeCoordinateWr", mesh, *step, time, FULL, Int(count), points)
    call("MEDmeshEntityNumberWr", mesh, *step, NODE, 0, Int(count), ints(100 + 3 * chance.permutation(count)))
    call("MEDmeshEntityNameWr", mesh, *step, NODE, 0, Int(count), words(*(f"N{k}" for k in range(count))))
    call("MEDmeshGlobalNumberWr", mesh, *step, NODE, 0, Int(count), ints(5000 + numpy.arange(count)))
    call("MEDmeshEntityFamilyNumberWr", mesh, *step, NODE, 0, Int(count), ints(chance.integers(0, 4, count)))
    for kind, rows in cells.items():
        call("MEDmeshElementConnectivityWr", mesh, *step, time, CELL, kind, 0, FULL, Int(len(rows)), ints(rows + 1))
        if kind != TE4:  # tetrahedra get no numbers and names
            call("MEDmeshEntityNumberWr", mesh, *step, CELL, kind, Int(len(rows)),
                 ints(1000 * kind + 2 * chance.permutation(len(rows))))
            call("MEDmeshEntityNameWr", mesh, *step, CELL, kind, Int(len(rows)),
                 words(*(f"M{kind}_{k}" for k in range(len(rows)))))
        if kind != SE2:
            call("MEDmeshEntityFamilyNumberWr", mesh, *step, CELL, kind, Int(len(rows)),
                 ints(-chance.integers(0, 5, len(rows))))
    families = [(b"FAMILLE_ZERO", 0, ()), (b"fixed", 1, ("fixed",)), (b"top and fixed", 2, ("top", "fixed")),
                (b"free of groups", 3, ()), (b"steel", -1, ("steel",)), (b"steel, hot", -2, ("steel", "hot")),
                (b"hot", -4, ("hot",)), (b"of nothing", -9, ("nothing",))]  # no family has -3, which cells use
    for name, number, groups in families:
        call("MEDfamilyCr", mesh, name, Int(number), Int(len(groups)), words(*groups, width=80))

    def field(name, components, kind=6):
        call("MEDfieldCr", name, kind, Int(len(components)), words(*components), words(*(["Pa"] * len(components))),
             b"s", mesh)

    def values(rows, points_of_item, components):
        return chance.uniform(size=(rows, points_of_item, components))

    field(b"DEPL", ("DX", "DY", "DZ"))
    for k in range(3):
        call("MEDfieldValueWr", b"DEPL", Int(k), Int(-1), ctypes.c_double(0.5 * k), NODE, 0, FULL, ALL, Int(count),
             values(count, 1, 3))
    some = numpy.sort(chance.permutation(count)[: count // 3]) + 1
    call("MEDprofileWr", b"some", Int(len(some)), ints(some))
    field(b"HEAT", ("T",))
    call("MEDfieldValueWithProfileWr", b"HEAT", *step, time, NODE, 0, COMPACT, b"some", b"", FULL, ALL, Int(count),
         values(len(some), 1, 1))
    few = ints([2, 3, 5, 8])  # one profile for two types
    call("MEDprofileWr", b"few", Int(len(few)), few)
    field(b"SIEF", ("SXX", "SYY"))
    call("MEDfieldValueWr", b"SIEF", *step, time, CELL, HE8, FULL, ALL, Int(len(cells[HE8])), values(len(cells[HE8]), 1, 2))
    for kind in (TR3, PE6):
        call("MEDfieldValueWithProfileWr", b"SIEF", *step, time, CELL, kind, COMPACT, b"few", b"", FULL, ALL,
             Int(len(cells[kind])), values(len(few), 1, 2))
    for kind, nodes in ((TE4, 4), (HE8, 8)):
        call("MEDfieldValueWr", b"SIEF", *step, time, NODE_OF_ELEMENT, kind, FULL, ALL, Int(len(cells[kind])),
             values(len(cells[kind]), nodes, 2))
    med.MEDlocalizationWr.argtypes = [File, ctypes.c_char_p, ctypes.c_int, Int, ctypes.c_void_p, ctypes.c_int, Int,
                                      ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_char_p]
    call("MEDlocalizationWr", b"gauss3", TR3, Int(2), numpy.array([0.0, 0, 1, 0, 0, 1]), FULL, Int(3),
         numpy.array([0.1, 0.1, 0.8, 0.1, 0.1, 0.8]), numpy.array([0.1, 0.2, 0.2]), b"", b"")
    field(b"EPSI", ("EXX", "EYY"))
    call("MEDfieldValueWithProfileWr", b"EPSI", *step, time, CELL, TR3, COMPACT, b"", b"gauss3", FULL, ALL,
         Int(len(cells[TR3])), values(len(cells[TR3]), 3, 2))
    field(b"WHOLE", ("",), 26)
    call("MEDfieldValueWr", b"WHOLE", *step, time, NODE, 0, FULL, ALL, Int(count), chance.integers(0, 2**40, count))
    call("MEDequivalenceCr", mesh, b"same", b"nodes and lines")
    call("MEDequivalenceCorrespondenceWr", mesh, b"same", *step, NODE, 0, Int(3), ints([1, 2, 9, 4, 7, 30]))
    call("MEDequivalenceCorrespondenceWr", mesh, b"same", *step, CELL, SE2, Int(2), ints([1, 2, 5, 3]))
    assert med.MEDfileClose(file) == 0


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:]))
