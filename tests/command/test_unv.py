# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""I-deas universal files, read back by a small reader of the test's own and, where it is installed, by OpenFOAM."""
import re

import numpy
import pytest

import foam_cases

needs_openfoam = pytest.mark.skipif(not foam_cases.has_openfoam(), reason="needs OpenFOAM")
TRIANGLE, QUAD, WEDGE, HEXAHEDRON = 91, 94, 112, 115


class UnvFile:
    """Nodes, elements, groups and results of a universal file by their numbers; other datasets as text."""

    def __init__(self, path):
        self.nodes, self.elements, self.groups, self.results, self.others = {}, {}, {}, [], {}
        for block in re.findall(r"^    -1\n(.*?)^    -1$", path.read_text(), re.S | re.M):
            number, lines = block.split("\n", 1)
            {2411: self.read_nodes, 2412: self.read_elements, 2467: self.read_groups, 2477: self.read_groups,
             2414: self.read_results}.get(int(number), lambda rest: self.others.update({int(number): rest}))(lines)

    def read_nodes(self, text):
        lines = text.splitlines()
        for head, place in zip(lines[::2], lines[1::2]):
            self.nodes[int(head[:10])] = tuple(float(x.replace("D", "E")) for x in place.split())

    def read_elements(self, text):
        words = iter(map(int, text.split()))
        for number in words:
            kind, *fields, count = (next(words) for _ in range(5))
            self.elements[number] = (kind, fields, [next(words) for _ in range(count)])

    def read_groups(self, text):
        lines = iter(text.splitlines())
        for head in lines:
            count, name, members = int(head.split()[-1]), next(lines), []
            while len(members) < 4 * count:
                members += map(int, next(lines).split())
            self.groups[name] = list(zip(members[::4], members[1::4]))

    def read_results(self, text):
        lines = text.splitlines()
        values, width = {}, 2 if int(lines[2]) == 2 else 1
        for head, row in zip(lines[13::2], lines[14::2]):
            assert len(head.split()) == width
            values[int(head.split()[0])] = tuple(map(float, row.split()))
        self.results.append((lines[1].strip(), int(lines[2]), values))

    def shape_of(self, element):
        """An element independent of numbering: its type, its fields and the coordinates of its nodes in order."""
        kind, fields, nodes = self.elements[element]
        return kind, tuple(fields), tuple(self.nodes[node] for node in nodes)

    def content(self):
        """The content that a new order must not change."""
        def item(code, number):
            return self.nodes[number] if code == 7 else self.shape_of(number)
        return {
            "nodes": sorted(self.nodes.values()),
            "elements": sorted(map(self.shape_of, self.elements)),
            "groups": {name: sorted((code, item(code, number)) for code, number in members)
                       for name, members in self.groups.items()},
            "results": [(name, where, sorted((item(7 if where == 1 else 8, number), row)
                                             for number, row in values.items()))
                        for name, where, values in self.results],
            "others": self.others,
        }


def block(n):
    """A cube of hexahedra and wedges with the quads below and the triangles above, shuffled: points and cells by type."""
    axis = numpy.linspace(0, 1, n + 1) ** 1.25
    z, y, x = numpy.meshgrid(axis, axis, axis, indexing="ij")
    at = numpy.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    low = at[:-1, :-1, :-1].ravel()
    right, behind, above = 1, n + 1, (n + 1) ** 2
    quads = numpy.stack([low, low + right, low + right + behind, low + behind], 1)
    half = n * n * (n // 2)
    hexahedra = numpy.concatenate([quads[:half], quads[:half] + above], 1)
    wedges = numpy.concatenate([
        numpy.concatenate([quads[half:][:, pick], quads[half:][:, pick] + above], 1) for pick in ([0, 1, 2], [0, 2, 3])
    ])
    top = quads[-n * n:] + above
    triangles = numpy.concatenate([top[:, [0, 1, 2]], top[:, [0, 2, 3]]])
    shuffle = numpy.random.default_rng(4).permutation(x.size)
    points = numpy.empty((x.size, 3))
    points[shuffle] = numpy.stack([x, y, z], -1).reshape(-1, 3)
    return points, [(HEXAHEDRON, shuffle[hexahedra]), (WEDGE, shuffle[wedges]), (QUAD, shuffle[quads[:n * n]]),
                    (TRIANGLE, shuffle[triangles])]


def write_unv(path, points, cells, extra=""):
    """Numbers nodes in steps of three and elements from 101; adds groups of the lower and upper faces and both kinds of
    results."""
    def fields(*numbers):
        return "".join(f"{number:10d}" for number in numbers) + "\n"

    def members(numbers):
        return "".join(fields(*row) for row in numpy.array([(8, n, 0, 0) for n in numbers]).reshape(-1, 8).tolist())

    one = f"{1:25.17E}"
    text = f"    -1\n   164\n         1SI: units                    2\n{one * 3}\n{one}\n    -1\n    -1\n  2411\n"
    for v, point in enumerate(points.tolist()):
        text += fields(3 * v + 1, 1, 1, 11) + "".join(f"{x:25.16E}" for x in point) + "\n"
    text += "    -1\n    -1\n  2412\n"
    number, by_type = 101, {}
    for kind, rows in cells:
        by_type[kind] = range(number, number + len(rows))
        for row in rows.tolist():
            text += fields(number, kind, kind % 7, 2, 7, len(row)) + fields(*(3 * v + 1 for v in row))
            number += 1
    text += "    -1\n    -1\n  2467\n"
    for group, (name, kind) in enumerate((("lower face", QUAD), ("upper", TRIANGLE)), 1):
        text += fields(group, 0, 0, 0, 0, 0, 0, len(by_type[kind])) + name + "\n" + members(by_type[kind])
    text += "    -1\n"
    for where, numbers in ((1, range(1, 3 * len(points), 3)), (2, by_type[WEDGE])):
        for step in range(2):
            text += f"    -1\n  2414\n{fields(step + 1)}heat\n{fields(where)}" + "NONE\n" * 5
            text += fields(1, 4, 2, 8, 2, 3) + fields(*[0] * 8) + fields(0, 0) + ("  0.00000E+00" * 6 + "\n") * 2
            for n in numbers:
                text += fields(n) if where == 1 else fields(n, 3)
                text += "".join(f"{x:13.5E}" for x in (n, step, -n / 7)) + "\n"
            text += "    -1\n"
    path.write_text(text + extra)


@pytest.mark.parametrize("ids", ["renumber", "keep"])
def test_all_that_a_file_holds_moves_together(command, tmp_path, ids):
    points, cells = block(4)
    write_unv(tmp_path / "a.unv", points, cells)
    command.ok("order", "a.unv", "-o", "b.unv", "--vertices", "rcm", "--elements", "min", "--ids", ids)
    before, after = UnvFile(tmp_path / "a.unv"), UnvFile(tmp_path / "b.unv")
    assert after.content() == before.content()
    assert len(before.results) == 4 and set(before.groups) == {"lower face", "upper"}
    assert sorted(after.nodes) == sorted(before.nodes) and sorted(after.elements) == sorted(before.elements)
    moved = [after.nodes[number] != place for number, place in before.nodes.items()]
    assert any(moved) == (ids == "renumber")
    assert list(after.nodes.values()) != list(before.nodes.values())


def test_loads_keep_the_numbers(command, tmp_path):
    points, cells = block(2)
    loads = "    -1\n   790\n         4         1\n    -1\n"
    write_unv(tmp_path / "a.unv", points, cells, loads)
    done = command.ok("order", "a.unv", "-o", "b.unv", "--vertices", "rcm")
    assert "keep their numbers" in done.stderr and "dataset 790" in done.stderr
    before, after = UnvFile(tmp_path / "a.unv"), UnvFile(tmp_path / "b.unv")
    assert after.nodes == before.nodes and list(after.nodes) != list(before.nodes)
    assert (tmp_path / "b.unv").read_text().endswith(loads)


def test_steps_go_to_another_format_and_back(command, tmp_path):
    points, cells = block(2)
    write_unv(tmp_path / "a.unv", points, cells)
    command.ok("order", "a.unv", "-o", "b.vtu", "--vertices", "original", "--elements", "original")
    command.ok("order", "b.vtu", "-o", "c.unv", "--vertices", "original", "--elements", "original")
    before, after = UnvFile(tmp_path / "a.unv"), UnvFile(tmp_path / "c.unv")
    assert sorted(after.nodes.values()) == sorted(before.nodes.values())
    assert sorted((kind, tuple(after.nodes[n] for n in nodes)) for kind, _, nodes in after.elements.values()) == \
        sorted((kind, tuple(before.nodes[n] for n in nodes)) for kind, _, nodes in before.elements.values())
    heat = [values for name, where, values in after.results if name == "heat step 2" and where == 1]
    assert [row[1] for row in heat[0].values()] == [1] * len(points)


def test_elements_of_other_types_are_named(command, tmp_path):
    nodes = "".join(f"{n:10}         1         1        11\n   {n}.0D+00   {n % 2}.0D+00   0.0D+00\n" for n in (1, 2, 3))
    element = "         1       300         2         1         7         3\n         1         2         3\n"
    (tmp_path / "a.unv").write_text(f"    -1\n  2411\n{nodes}    -1\n    -1\n  2412\n{element}    -1\n")
    assert "its only elements are of types that are not cells here (300); nothing can be reordered" in \
        command.fails("order", "a.unv", "-o", "b.unv")


@needs_openfoam
def test_openfoam_makes_the_same_mesh(command, tmp_path):
    points, cells = block(4)
    write_unv(tmp_path / "a.unv", points, cells)
    command.ok("order", "a.unv", "-o", "b.unv", "--vertices", "rcm", "--elements", "min")
    found = []
    for name in "ab":
        case = tmp_path / f"case-{name}"
        foam_cases.write_settings(case)
        foam_cases.openfoam("ideasUnvToFoam", case, tmp_path / f"{name}.unv")
        assert "Mesh OK." in foam_cases.openfoam("checkMesh", case)
        mesh = case / "constant" / "polyMesh"
        patches = dict(re.findall(r"^\s*(\S+)\s*\{[^}]*nFaces\s+(\d+);", foam_cases.body(mesh / "boundary"), re.M))
        found.append((patches, sorted(numpy.round(foam_cases.centres(mesh), 6).tolist())))
    assert found[0] == found[1]
    assert {"16", "32"} <= set(found[0][0].values())
