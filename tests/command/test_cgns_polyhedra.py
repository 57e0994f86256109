# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""CGNS with polygons and polyhedra (NGON_n, NFACE_n): made by h5py, ordered, read by h5py and by VTK's own reader."""
import itertools
import shutil
import subprocess

import h5py
import numpy
import pytest
import scipy.spatial
from test_cgns import KUHN, checked, children, keep, new_file, put, put_condition, put_zone, text, word
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOCGNSReader import vtkCGNSReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

# the faces of cells in VTK's order, with outward normals; wedges are those whose first triangle faces inward
FACES = {
    4: ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    5: ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    6: ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    8: ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
}
VTK_TYPES = {10: 4, 14: 5, 13: 6, 12: 8}


def mixed(n, seed, at=0.0):
    """Hexahedra with pyramids above, and beside them wedges and tetrahedra; points and cells in random order."""
    chance = numpy.random.default_rng(seed)
    points = {}
    cells = []

    def number(point):
        return points.setdefault(point, len(points))

    def cube(x, y, z):
        steps = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
        return [number((at + x + i, float(y + j), float(z + k))) for i, j, k in steps]

    for x, y, z in itertools.product(range(n), repeat=3):
        if z < n - 1:
            cells.append(cube(x, y, z))
        else:
            centre = number((at + x + 0.5, y + 0.5, z + 0.5))
            cells += [[cube(x, y, z)[k] for k in face[::-1]] + [centre] for face in FACES[8]]
    for y, z in itertools.product(range(n), repeat=2):
        corners = cube(-4, y, z)
        cells += [[corners[k] for k in wedge] for wedge in ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7))]
    for y in range(n):
        cells += [[cube(-8, y, 0)[k] for k in kuhn] for kuhn in KUHN]
    shuffle = chance.permutation(len(points))
    moved = numpy.empty((len(points), 3))
    moved[shuffle] = list(points)
    cells = [cells[k] for k in chance.permutation(len(cells))]
    return moved, [[int(shuffle[v]) for v in cell] for cell in cells]


def voronoi(count, seed, at=0.0):
    """The Voronoi cells of random sites in a cube: points, corners of each cell, faces, and signed cells of each face."""
    chance = numpy.random.default_rng(seed)
    sites = chance.random((count, 3))
    images = [sites]
    for axis, wall in itertools.product(range(3), (0.0, 1.0)):
        image = sites.copy()
        image[:, axis] = 2 * wall - image[:, axis]
        images.append(image)
    diagram = scipy.spatial.Voronoi(numpy.concatenate(images))
    faces, users = [], []
    for sides, corners in zip(diagram.ridge_points.tolist(), diagram.ridge_vertices):
        inside = sorted(side for side in sides if side < count)
        if not inside:
            continue
        points = diagram.vertices[corners]
        normal = numpy.cross(points[1] - points[0], points[2] - points[0])
        outward = normal @ (points.mean(0) - sites[inside[0]]) > 0
        faces.append(corners)
        users.append([(cell, sign if outward else -sign) for cell, sign in zip(inside, (1, -1))])
    used = numpy.unique([v for face in faces for v in face])
    number = {int(old): new for new, old in enumerate(chance.permutation(used))}
    points = numpy.empty((len(used), 3))
    for old, new in number.items():
        points[new] = diagram.vertices[old] + [at, 0, 0]
    faces = [[number[v] for v in face] for face in faces]
    cells = [set() for _ in range(count)]
    for face, sides in zip(faces, users):
        for cell, _ in sides:
            cells[cell].update(face)
    return points, [sorted(cell) for cell in cells], faces, users


def faces_of_cells(cells, chance):
    """The faces of standard cells, in random rotations, and the signed cells of each face."""
    known, faces, users = {}, [], []
    for number, cell in enumerate(cells):
        for face in FACES[len(cell)]:
            corners = [cell[k] for k in face]
            place = known.setdefault(frozenset(corners), len(faces))
            if place == len(faces):
                turn = int(chance.integers(len(corners)))
                corners = corners[turn:] + corners[:turn]
                inward = bool(chance.integers(2))
                faces.append(corners[::-1] if inward else corners)
                users.append([(number, -1 if inward else 1)])
            else:
                users[place].append((number, -users[place][0][1]))
    return faces, users


def polyhedra(faces, users, chance, signs=True):
    """The faces, with the boundary's last, their cells, and the signed faces of each cell; all in random order."""
    inner = [k for k in chance.permutation(len(faces)) if len(users[k]) == 2]
    outer = [k for k in chance.permutation(len(faces)) if len(users[k]) == 1]
    outer.sort(key=lambda k: len(faces[k]))
    order = inner + outer
    of_cells = [[] for _ in range(1 + max(cell for user in users for cell, _ in user))]
    for new, old in enumerate(order, 1):
        for cell, sign in users[old]:
            of_cells[cell].append(new * sign if signs else new)
    for row in of_cells:
        chance.shuffle(row)
    return [faces[k] for k in order], [[c for c, _ in sorted(users[k], key=lambda u: -u[1])] for k in order], of_cells, len(inner)


def put_rows(zone, name, kind, first, rows, offsets, whole="int32", shift=0):
    section = put(zone, name, "Elements_t", numpy.array([kind, 0], "int32"))
    put(section, "ElementRange", "IndexRange_t", numpy.array([first, first + len(rows) - 1], whole))
    if offsets:
        starts = numpy.concatenate([[0], numpy.cumsum([len(row) for row in rows])])
        put(section, "ElementStartOffset", "DataArray_t", starts.astype(whole))
        numbers = [v + shift for row in rows for v in row]
    else:
        numbers = [v for row in rows for v in [len(row), *(k + shift for k in row)]]
    put(section, "ElementConnectivity", "DataArray_t", numpy.array(numbers, whole))
    return section


def write_zone(base, name, n, seed, offsets=True, whole="int32", at=0.0, signs=1, parents="elements", cells_first=False,
               general=False):
    """If `general`, n³ Voronoi cells; else polyhedra that have the shapes of standard cells."""
    chance = numpy.random.default_rng(seed)
    if general:
        points, cells, faces, users = voronoi(n**3, seed, at)
    else:
        points, cells = mixed(n, seed, at)
        faces, users = faces_of_cells(cells, chance)
    faces, users, of_cells, inner = polyhedra(faces, users, chance, bool(signs))
    zone = put_zone(base, name, points, len(cells), whole)
    first_face, first_cell = (len(cells) + 1, 1) if cells_first else (1, len(faces) + 1)
    polygons = put_rows(zone, "faces", 22, first_face, faces, offsets, whole, shift=1)
    put_rows(zone, "cells", 23, first_cell,
             [[(k + numpy.sign(k) * (first_face - 1)) * (signs or 1) for k in row] for row in of_cells], offsets, whole)
    if parents:
        shift = first_cell if parents == "elements" else 1
        table = numpy.array([[c + shift for c in user] + [0] * (2 - len(user)) for user in users], whole)
        put(polygons, "ParentElements", "DataArray_t", table.T.copy())
    triangles = sum(len(face) == 3 for face in faces[inner:])
    middle = first_face + inner + triangles
    put_condition(zone, "triangles", "FaceCenter", (first_face + inner, middle - 1), whole)
    put_condition(zone, "some quads", "FaceCenter", numpy.arange(middle, first_face + len(faces), 3)[::-1], whole)
    put_condition(zone, "corner", "Vertex", [5, 2, 9], whole)
    centre = put(zone, "AtCells", "FlowSolution_t")
    put(centre, "GridLocation", "GridLocation_t", text("CellCenter"))
    put(centre, "Number", "DataArray_t", numpy.arange(len(cells), dtype="int64"))
    put(centre, "Where", "DataArray_t", numpy.array([points[cell].mean(0) @ [1, 10, 100] for cell in cells]))
    vertices = put(zone, "AtVertices", "FlowSolution_t")
    put(vertices, "GridLocation", "GridLocation_t", text("Vertex"))
    put(vertices, "Pressure", "DataArray_t", (points @ [1, 10, 100]).astype("float32"))
    return points, cells, faces, inner


def write_polyhedra(path, n=3, seed=1, offsets=True, **options):
    with new_file(path, 3.4 if offsets else 3.3) as file:
        base = put(file, "Base", "CGNSBase_t", numpy.array([3, 3], "int32"))
        return write_zone(base, "A", n, seed, offsets, **options)


def rows_of(section):
    first, last = section["ElementRange"][" data"][...].tolist()
    numbers = section["ElementConnectivity"][" data"][...].tolist()
    if "ElementStartOffset" in section:
        starts = section["ElementStartOffset"][" data"][...].tolist()
        assert len(starts) == last - first + 2 and starts[0] == 0 and starts[-1] == len(numbers)
        return first, [numbers[a:b] for a, b in zip(starts, starts[1:])]
    rows, at = [], 0
    for _ in range(first, last + 1):
        rows.append(numbers[at + 1:at + 1 + numbers[at]])
        at += 1 + numbers[at]
    assert at == len(numbers)
    return first, rows


def turned(corners):
    """The corners of a face, rotated to begin with the lowest one."""
    low = corners.index(min(corners))
    return tuple(corners[low:] + corners[:low])


class PolyhedralZone:
    """The content of a zone, with points and polygons instead of their numbers."""

    def __init__(self, node):
        self.node = node
        axes = [node["GridCoordinates"][f"Coordinate{axis}"][" data"][...] for axis in "XYZ"]
        self.points = [tuple(point) for point in numpy.stack(axes, -1).tolist()]
        self.faces, self.cells, self.inside = {}, {}, {}
        for section in children(node, "Elements_t"):
            if section[" data"][0] == 22:
                first, rows = rows_of(section)
                self.faces |= {k: turned([self.points[v - 1] for v in row]) for k, row in enumerate(rows, first)}
        for section in children(node, "Elements_t"):
            if section[" data"][0] == 23:
                first, rows = rows_of(section)
                for k, row in enumerate(rows, first):
                    outward = [self.faces[f] if f > 0 else turned(list(self.faces[-f][::-1])) for f in row]
                    self.cells[k] = tuple(sorted(outward))
                    for f in row:
                        self.inside.setdefault(abs(f), []).append(k)

    def items(self, node):
        location = word(node["GridLocation"])
        of = dict(enumerate(self.points, 1)) if location == "Vertex" else self.faces
        if "PointList" in node:
            return [of[k] for k in node["PointList"][" data"][...].ravel().tolist()]
        first, last = node["PointRange"][" data"][...].ravel().tolist()
        return [of[k] for k in range(first, last + 1)]

    def content(self):
        result = {"faces": sorted(self.faces.values()), "cells": sorted(self.cells.values()),
                  "size": self.node[" data"][...].tolist()}
        for conditions in children(self.node, "ZoneBC_t"):
            for condition in children(conditions, "BC_t"):
                result[condition.name] = (sorted(self.items(condition)), "PointRange" in condition)
        for solution in children(self.node, "FlowSolution_t"):
            if "PointList" in solution:
                owners = self.items(solution)
            elif word(solution["GridLocation"]) == "Vertex":
                owners = self.points
            else:
                owners = [self.cells[k] for k in sorted(self.cells)]
            for array in children(solution, "DataArray_t"):
                result[array.name] = sorted(zip(owners, array[" data"][...].tolist()))
        for section in children(self.node, "Elements_t"):
            if "ParentElements" not in section:
                continue
            first = int(section["ElementRange"][" data"][0])
            parents = section["ParentElements"][" data"][...].T.tolist()
            assert len(parents) == len(rows_of(section)[1])
            low = min(self.cells)
            from_one = max(map(max, parents)) <= len(self.cells) < low + len(self.cells) - 1
            cells = {0: (), **{k - low + 1 if from_one else k: cell for k, cell in self.cells.items()}}
            result[f"parents {section.name}"] = sorted(
                (self.faces[k], cells[a], cells[b]) for k, (a, b) in enumerate(parents, first))
        return result


def content(path):
    with h5py.File(path) as file:
        return {zone.name: PolyhedralZone(zone).content() for zone in children(file["Base"], "Zone_t")}


def rows(path, section, zone="A"):
    with h5py.File(path) as file:
        return rows_of(file[f"Base/{zone}/{section}"])[1]


def polyhedra_by_vtk(path):
    """The cells of the first zone as VTK reads them: their faces by coordinates, with the values of the cells."""
    reader = vtkCGNSReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    reader.EnableAllCellArrays()
    reader.Update()
    grid = reader.GetOutput().GetBlock(0).GetBlock(0)
    assert isinstance(grid, vtkUnstructuredGrid)
    values = grid.GetCellData().GetArray("Where")
    return sorted(
        (tuple(sorted(tuple(sorted(face(cell, k))) for k in range(cell.GetNumberOfFaces()))), values.GetValue(c))
        for c, cell in ((c, grid.GetCell(c)) for c in range(grid.GetNumberOfCells())) if cell.GetCellDimension() == 3)


def face(cell, k):
    points = cell.GetFace(k).GetPoints()
    return [tuple(round(x, 9) for x in points.GetPoint(p)) for p in range(points.GetNumberOfPoints())]


def cells_in_vtu(path):
    """For each type of cells in a .vtu file, their number and their least volume, by VTK's faces. Also whether values
    fit the cells' centres."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    where = grid.GetCellData().GetArray("Where")
    counts, least, right = {}, {}, True
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        kind = cell.GetCellType()
        counts[kind] = counts.get(kind, 0) + 1
        if cell.GetCellDimension() < 3:
            continue
        volume = 0.0
        for k in range(cell.GetNumberOfFaces()):
            corners = numpy.array(face(cell, k))
            volume += sum(numpy.linalg.det(numpy.array([corners[0], corners[i], corners[i + 1]])) / 6
                          for i in range(1, len(corners) - 1))
        least[kind] = min(volume, least.get(kind, volume))
        points = numpy.array([cell.GetPoints().GetPoint(p) for p in range(cell.GetNumberOfPoints())])
        right = right and abs(where.GetValue(c) - points.mean(0) @ [1, 10, 100]) < 1e-9
    return counts, least, right


@pytest.mark.parametrize("whole", ["int32", "int64"])
@pytest.mark.parametrize("offsets", [False, True])
@pytest.mark.parametrize("cells_first", [False, True])
@pytest.mark.parametrize("general", [False, True])
def test_polyhedra_move_with_all_that_belongs_to_them(command, tmp_path, whole, offsets, cells_first, general):
    write_polyhedra(tmp_path / "a.cgns", offsets=offsets, whole=whole, cells_first=cells_first, general=general)
    before = content(tmp_path / "a.cgns")
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    assert content(tmp_path / "b.cgns") == before
    for section in ("faces", "cells"):
        assert rows(tmp_path / "b.cgns", section) != rows(tmp_path / "a.cgns", section)
    keep(command, "b.cgns", "c.cgns")
    assert content(tmp_path / "c.cgns") == before
    for section in ("faces", "cells"):
        assert rows(tmp_path / "c.cgns", section) == rows(tmp_path / "b.cgns", section)


def test_faces_between_cells_follow_these(command, tmp_path):
    _, _, _, inner = write_polyhedra(tmp_path / "a.cgns")
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    for name, is_sorted in (("a", False), ("b", True)):
        with h5py.File(tmp_path / f"{name}.cgns") as file:
            sides = PolyhedralZone(file["Base/A"]).inside
        pairs = [sorted(sides[k]) for k in range(1, inner + 1)]
        assert all(len(pair) == 2 for pair in pairs) and (pairs == sorted(pairs)) == is_sorted


@pytest.mark.parametrize("general", [False, True])
def test_vtk_reads_the_same_polyhedra(command, tmp_path, general):
    write_polyhedra(tmp_path / "a.cgns", offsets=False, general=general)
    before = polyhedra_by_vtk(tmp_path / "a.cgns")
    assert len(before) == len(rows(tmp_path / "a.cgns", "cells"))
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    assert polyhedra_by_vtk(tmp_path / "b.cgns") == before


@pytest.mark.skipif(shutil.which("cgnscheck") is None, reason="no cgnscheck (Debian's cgns-convert)")
@pytest.mark.parametrize("offsets", [False, True])
@pytest.mark.parametrize("general", [False, True])
def test_tools_of_cgns_accept_the_files(command, tmp_path, offsets, general):
    write_polyhedra(tmp_path / "a.cgns", offsets=offsets, general=general)
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    assert checked(tmp_path, "b.cgns").count("WARNING") == checked(tmp_path, "a.cgns").count("WARNING")
    keep(command, "a.cgns", "c.cgns")
    done = subprocess.run(["cgnsdiff", "-d", "a.cgns", "c.cgns"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "" and done.returncode == 0, done.stdout
    subprocess.run(["hdf2adf", "a.cgns", "adf.cgns"], cwd=tmp_path, check=True, capture_output=True)
    command.ok("order", "adf.cgns", "-o", "ordered.cgns", "--vertices", "rcm", "--elements", "min")
    subprocess.run(["adf2hdf", "ordered.cgns", "d.cgns"], cwd=tmp_path, check=True, capture_output=True)
    assert content(tmp_path / "d.cgns") == content(tmp_path / "a.cgns")


@pytest.mark.parametrize(("signs", "words"), [(1, ""), (-1, "point into the cells"), (0, "contradict each other")])
def test_polyhedra_become_cells_of_positive_volume(command, tmp_path, signs, words):
    _, cells, faces, inner = write_polyhedra(tmp_path / "a.cgns", signs=signs)
    done = keep(command, "a.cgns", "b.vtu")
    counts, least, right = cells_in_vtu(tmp_path / "b.vtu")
    sizes = [len(cell) for cell in cells]
    assert {kind: counts[kind] for kind in VTK_TYPES} == {kind: sizes.count(size) for kind, size in VTK_TYPES.items()}
    assert all(sizes.count(size) > 0 for size in VTK_TYPES.values())
    assert counts[5] + counts[9] == len(faces) - inner
    assert all(volume > 0.1 for volume in least.values()) and right
    assert (words in done.stderr) if words else "signs" not in done.stderr


def test_ranges_of_a_boundary_stay_ranges(command, tmp_path):
    write_polyhedra(tmp_path / "a.cgns")
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    found = content(tmp_path / "b.cgns")["/Base/A"]
    assert found["/Base/A/ZoneBC/triangles"][1] and not found["/Base/A/ZoneBC/some quads"][1]
    info = command.ok("info", "b.cgns").stdout
    assert "triangles" in info and "some quads" in info


def test_parents_may_count_cells_from_one(command, tmp_path):
    write_polyhedra(tmp_path / "a.cgns", parents="from one")
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    before = content(tmp_path / "a.cgns")
    assert any(name.startswith("parents") for name in before["/Base/A"])
    assert content(tmp_path / "b.cgns") == before
    with h5py.File(tmp_path / "b.cgns") as file:
        assert file["Base/A/faces/ParentElements/ data"][...].max() == len(rows_of(file["Base/A/cells"])[1])


def test_faces_that_a_solution_names_are_cells(command, tmp_path):
    _, _, faces, inner = write_polyhedra(tmp_path / "a.cgns", n=2)
    named = [3, 1, len(faces), 7]
    assert inner > 7
    with h5py.File(tmp_path / "a.cgns", "r+") as file:
        flux = put(file["Base/A"], "Fluxes", "FlowSolution_t")
        put(flux, "GridLocation", "GridLocation_t", text("FaceCenter"))
        put(flux, "PointList", "IndexArray_t", numpy.array(named, "int32")[:, None])
        put(flux, "Flux", "DataArray_t", numpy.array([0.5, 1.5, 2.5, 3.5]))
    before = content(tmp_path / "a.cgns")
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    assert content(tmp_path / "b.cgns") == before
    keep(command, "a.cgns", "c.vtu")
    counts, *_ = cells_in_vtu(tmp_path / "c.vtu")
    assert counts[5] + counts[9] == len(faces) - inner + 3


def test_zones_of_polyhedra_stay_apart(command, tmp_path):
    with new_file(tmp_path / "a.cgns", 4.0) as file:
        base = put(file, "Base", "CGNSBase_t", numpy.array([3, 3], "int32"))
        places = []
        for name, at, seed in (("A", 0.0, 1), ("B", 2.0, 2)):
            points, _, faces, _ = write_zone(base, name, 2, seed, at=at, cells_first=name == "B")
            first = rows_of(base[name]["faces"])[0]
            places.append({frozenset(map(tuple, points[corners].tolist())): k for k, corners in enumerate(faces, first)})
        shared = [(places[0][key], places[1][key]) for key in places[0] if key in places[1]]
        assert len(shared) >= 4
        connection = put(put(base["A"], "ZoneGridConnectivity", "ZoneGridConnectivity_t"), "to B", "GridConnectivity_t", text("B"))
        put(connection, "GridConnectivityType", "GridConnectivityType_t", text("Abutting1to1"))
        put(connection, "GridLocation", "GridLocation_t", text("FaceCenter"))
        put(connection, "PointList", "IndexArray_t", numpy.array(shared, "int32")[:, :1])
        put(connection, "PointListDonor", "IndexArray_t", numpy.array(shared, "int32")[:, 1:])

    def joints(path):
        with h5py.File(path) as file:
            zones = [PolyhedralZone(file[f"Base/{name}"]) for name in "AB"]
            lists = [file[f"Base/A/ZoneGridConnectivity/to B/{name}/ data"][...].ravel().tolist()
                     for name in ("PointList", "PointListDonor")]
            return sorted((zones[0].faces[a], zones[1].faces[b]) for a, b in zip(*lists))

    before = content(tmp_path / "a.cgns"), joints(tmp_path / "a.cgns")
    assert all(sorted(a) == sorted(b) for a, b in before[1])
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    assert (content(tmp_path / "b.cgns"), joints(tmp_path / "b.cgns")) == before


def test_old_places_of_cells_and_faces_are_attached(command, tmp_path):
    _, cells, faces, inner = write_polyhedra(tmp_path / "a.cgns", n=2)
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min", "--ids", "attach")
    keep(command, "b.cgns", "c.vtu")
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(tmp_path / "c.vtu"))
    reader.Update()
    original = reader.GetOutput().GetCellData().GetArray("original")
    count = len(cells) + len(faces) - inner
    assert sorted(original.GetTuple1(c) for c in range(original.GetNumberOfTuples())) == list(range(count))
    # fewer values than polygons cannot be assigned to cells
    with h5py.File(tmp_path / "b.cgns", "r+") as file:
        reshape("faces/CellValues/original", lambda values: values[1:])(file)
    assert "is kept as it is" in keep(command, "b.cgns", "d.cgns").stderr


def test_polygons_without_polyhedra_become_surfaces(command, tmp_path):
    points = numpy.array([[x, y] for y in range(4) for x in range(4)], float)
    polygons = [[0, 1, 5, 4], [1, 2, 3, 7, 6, 5], [4, 5, 9, 8], [5, 6, 10], [5, 10, 9], [6, 7, 11, 15, 10], [8, 9, 10, 15, 14, 13, 12]]
    with new_file(tmp_path / "a.cgns", 4.0) as file:
        base = put(file, "Base", "CGNSBase_t", numpy.array([2, 2], "int32"))
        zone = put_zone(base, "A", points, len(polygons))
        put_rows(zone, "faces", 22, 1, polygons, True, shift=1)
        centre = put(zone, "AtCells", "FlowSolution_t")
        put(centre, "GridLocation", "GridLocation_t", text("CellCenter"))
        put(centre, "Corners", "DataArray_t", numpy.array([len(p) for p in polygons], "int32"))
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "scrambled", "--elements", "scrambled")
    with h5py.File(tmp_path / "b.cgns") as file:
        zone = file["Base/A"]
        found = numpy.stack([zone[f"GridCoordinates/Coordinate{axis}/ data"][...] for axis in "XY"], -1)
        new = rows_of(zone["faces"])[1]
        assert zone["AtCells/Corners/ data"][...].tolist() == [len(row) for row in new]
    assert new != [[v + 1 for v in p] for p in polygons]
    assert (sorted(found[numpy.array(row) - 1].tolist() for row in new)
            == sorted(points[numpy.array(p)].tolist() for p in polygons))
    keep(command, "b.cgns", "c.vtu")
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(tmp_path / "c.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    assert sorted(grid.GetCellType(c) for c in range(7)) == [5, 5, 7, 7, 7, 9, 9]


def test_parts_of_a_mesh_are_written_without_the_others(command, tmp_path):
    points, cells, faces, inner = write_polyhedra(tmp_path / "a.cgns")
    keep(command, "a.cgns", "b.cgns", "--only", "volume")
    assert rows(tmp_path / "b.cgns", "faces") == rows(tmp_path / "a.cgns", "faces")
    assert rows(tmp_path / "b.cgns", "cells") == rows(tmp_path / "a.cgns", "cells")
    with h5py.File(tmp_path / "b.cgns") as file:
        assert set(file["Base/A/ZoneBC"]) == {"corner"}
    keep(command, "a.cgns", "c.cgns", "--only", "surface")
    with h5py.File(tmp_path / "c.cgns") as file:
        assert "cells" not in file["Base/A"]
        assert len(rows_of(file["Base/A/faces"])[1]) == len(faces) - inner
        assert set(file["Base/A/ZoneBC"]) == {"corner", "triangles", "some quads"}


# ---- what cannot be read

def set_number(path, place, value):
    return lambda file: file[f"Base/A/{path}/ data"].__setitem__(place, value)


def reshape(path, change):
    def apply(file):
        node = file[f"Base/A/{path}"]
        values = change(node[" data"][...])
        del node[" data"]
        node.create_dataset(" data", data=values)
    return apply


def open_cell(file):
    """Makes a polyhedron list a boundary face twice, the second time instead of another face."""
    rows = rows_of(file["Base/A/cells"])[1]
    used = [abs(number) for row in rows for number in row]
    cell = next(k for k, row in enumerate(rows) if used.count(abs(row[0])) == 1)
    at = sum(map(len, rows[:cell]))
    file["Base/A/cells/ElementConnectivity/ data"][at + 1] = rows[cell][0]


def reals(file):
    reshape("cells/ElementConnectivity", lambda values: values.astype("float32"))(file)
    file["Base/A/cells/ElementConnectivity"].attrs.create("type", numpy.bytes_("R4"), dtype="S3")


FAULTS = {
    "vertex": (set_number("faces/ElementConnectivity", 1, 999), "faces, element 1: vertex 999 does not exist"),
    "vertex 0": (set_number("faces/ElementConnectivity", 1, 0), "faces, element 1: vertex 0 does not exist"),
    "face": (set_number("cells/ElementConnectivity", 1, -99999), "face -99999 does not exist"),
    "face 0": (set_number("cells/ElementConnectivity", 1, 0), "face 0 does not exist"),
    "descending": (set_number("faces/ElementStartOffset", 2, 1), "faces, element 2: ends before it begins"),
    "not from 0": (set_number("faces/ElementStartOffset", 0, 1), "the first of them 0"),
    "beyond": (set_number("faces/ElementStartOffset", -1, 10**6), "more members than ElementConnectivity"),
    "offsets": (reshape("cells/ElementStartOffset", lambda values: values[:-1]), "one more than elements is expected"),
    "short": (reshape("faces/ElementConnectivity", lambda values: values[:-1]), "more members than ElementConnectivity"),
    "long": (reshape("faces/ElementConnectivity", lambda values: numpy.append(values, values[-1:])), "1 numbers more than"),
    "two corners": (set_number("faces/ElementStartOffset", 1, 2), "element 1: is a polygon of 2 vertices"),
    "open": (open_cell, "faces do not enclose a volume"),
    "three": (lambda file: put_rows(file["Base/A"], "more", 23, 5001, rows_of(file["Base/A/cells"])[1][:1], True),
              "face of three polyhedra"),
    "no faces": (lambda file: file["Base/A"].__delitem__("faces"), "does not exist"),
    "no polyhedra": (lambda file: file["Base/A"].__delitem__("cells"), "ParentElements of their faces only"),
    "parents": (lambda file: file["Base/A/faces/ParentElements/ data"].__setitem__((0, 0), 10**6), "is not a cell of the zone"),
    "reals": (reals, "does not hold whole numbers"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_faults_of_polyhedra_are_named(command, tmp_path, name):
    write_polyhedra(tmp_path / "a.cgns", n=2)
    change, words = FAULTS[name]
    with h5py.File(tmp_path / "a.cgns", "r+") as file:
        change(file)
    message = command.fails("order", "a.cgns", "-o", "b.cgns")
    assert words in message and "/Base/A" in message
    assert not (tmp_path / "b.cgns").exists()


@pytest.mark.parametrize(("change", "words"), [
    (set_number("faces/ElementConnectivity", 0, -3), "element 1: counts -3 members"),
    (set_number("faces/ElementConnectivity", 0, 10**8), "element 1: has more members"),
    (set_number("faces/ElementConnectivity", 0, 0), "element 1: is a polygon of 0 vertices"),
    (reshape("cells/ElementConnectivity", lambda values: values[:1]), "element 90: has more members"),
    (reshape("cells/ElementConnectivity", lambda values: numpy.append(values, values[-1:])), "1 numbers more than"),
])
def test_faults_of_counted_polyhedra_are_named(command, tmp_path, change, words):
    write_polyhedra(tmp_path / "a.cgns", n=2, offsets=False)
    first = rows_of_first(tmp_path / "a.cgns")
    with h5py.File(tmp_path / "a.cgns", "r+") as file:
        change(file)
    assert words.replace("element 90", f"element {first}") in command.fails("order", "a.cgns", "-o", "b.cgns")


def rows_of_first(path):
    with h5py.File(path) as file:
        return int(file["Base/A/cells/ElementRange/ data"][0])


def write_pair(path):
    """A cube with one face cut in two, and a cube above it."""
    points = numpy.array([[x, y, z] for z in (0, 1, 2) for y in (0, 1) for x in (0, 1)], float)
    cube = [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
    upper = [[4, 5, 9, 8], [5, 7, 11, 9], [7, 6, 10, 11], [6, 4, 8, 10], [8, 9, 11, 10]]
    halves = [[4, 5, 7], [4, 7, 6]]
    with new_file(path, 4.0) as file:
        zone = put_zone(put(file, "Base", "CGNSBase_t", numpy.array([3, 3], "int32")), "A", points, 2)
        put_rows(zone, "faces", 22, 1, cube + halves + upper, True, shift=1)
        put_rows(zone, "cells", 23, 13, [[1, 2, 3, 4, 5, 6, 7], [-6, -7, 8, 9, 10, 11, 12]], True)


def test_a_face_cut_in_two_makes_polyhedra(command, tmp_path):
    write_pair(tmp_path / "a.cgns")
    assert "2 polyhedra" in command.ok("info", "a.cgns").stdout
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "fiedler")
    assert content(tmp_path / "b.cgns") == content(tmp_path / "a.cgns")


@pytest.mark.parametrize("method", ["fiedler", "fiedler-facet", "min", "hilbert", "auto"])
def test_neighbouring_polyhedra_come_near_each_other(command, tmp_path, method):
    write_polyhedra(tmp_path / "a.cgns", n=8, general=True)
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "spectral", "--elements", method)
    gaps = []
    for name in "ab":
        with h5py.File(tmp_path / f"{name}.cgns") as file:
            sides = PolyhedralZone(file["Base/A"]).inside
        gaps.append(numpy.mean([abs(pair[1] - pair[0]) for pair in sides.values() if len(pair) == 2]))
    assert gaps[1] < 0.5 * gaps[0]
    assert content(tmp_path / "b.cgns") == content(tmp_path / "a.cgns")


def test_the_order_of_polyhedra_can_be_undone(command, tmp_path):
    write_polyhedra(tmp_path / "a.cgns", general=True)
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min", "--maps", "m")
    command.ok("apply", "m", "b.cgns", "--inverse", "-o", "c.cgns")
    assert rows(tmp_path / "c.cgns", "cells") != rows(tmp_path / "b.cgns", "cells")
    assert content(tmp_path / "c.cgns") == content(tmp_path / "a.cgns")


@pytest.mark.parametrize("to", ["b.vtu", "b.msh", "b.e", "b.inp", "b.med"])
def test_formats_without_polyhedra_refuse_them(command, tmp_path, to):
    write_pair(tmp_path / "a.cgns")
    message = command.fails("order", "a.cgns", "-o", to)
    assert "polyhedron" in message and ".cgns" in message and not (tmp_path / to).exists()


def test_polyhedra_are_not_simulated(command, tmp_path):
    write_pair(tmp_path / "a.cgns")
    message = command.fails("simulate", "falling", "--mesh", "a.cgns")
    assert "has polyhedra" in message and "Tetrahedralize" in message


def test_a_part_with_polyhedra_is_written(command, tmp_path):
    write_polyhedra(tmp_path / "a.cgns", general=True)
    command.ok("order", "a.cgns", "-o", "b.cgns", "--only", "volume", "--vertices", "rcm", "--elements", "min")
    before, after = content(tmp_path / "a.cgns")["/Base/A"], content(tmp_path / "b.cgns")["/Base/A"]
    assert after["cells"] == before["cells"] and after["faces"] == before["faces"]
    assert "/Base/A/ZoneBC/triangles" not in after
