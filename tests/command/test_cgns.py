# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""CGNS: files made by h5py node by node, ordered, read by h5py again and checked by the CGNS library's own tools."""
import shutil
import subprocess

import h5py
import meshio
import numpy
import pytest

KUHN = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
ADF = bytes([0xC0, 0xA8, 0xA3, 0xA9]) + b"ADF Database Version"
NODES = {2: 1, 3: 2, 5: 3, 7: 4, 10: 4, 12: 5, 14: 6, 17: 8}
TYPES = {numpy.dtype("int8"): "C1", numpy.dtype("int32"): "I4", numpy.dtype("int64"): "I8",
         numpy.dtype("float32"): "R4", numpy.dtype("float64"): "R8", numpy.dtype("uint8"): "B1"}

needs_tools = pytest.mark.skipif(shutil.which("cgnscheck") is None, reason="no cgnscheck (Debian's cgns-convert)")


def box(n, seed, at=0.0):
    """A cube of tetrahedra and the triangles of its lower face, with points in random order."""
    axis = numpy.arange(n + 1)
    z, y, x = numpy.meshgrid(axis, axis, axis, indexing="ij")
    points = numpy.stack([x + at, y, z], -1).reshape(-1, 3).astype(float)
    place = x + (n + 1) * (y + (n + 1) * z)
    low = place[:-1, :-1, :-1].ravel()
    steps = numpy.array([0, 1, n + 2, n + 1])
    corners = low[:, None] + numpy.concatenate([steps, steps + (n + 1) ** 2])
    tetrahedra = numpy.concatenate([corners[:, kuhn] for kuhn in KUHN])
    lower = corners[low < n * (n + 1)]
    triangles = numpy.concatenate([lower[:, [0, 2, 1]], lower[:, [0, 3, 2]]])
    chance = numpy.random.default_rng(seed)
    shuffle = chance.permutation(len(points))
    moved = numpy.empty_like(points)
    moved[shuffle] = points
    return moved, chance.permutation(shuffle[tetrahedra]), chance.permutation(shuffle[triangles])


# ---- writing and reading nodes

def text(value):
    return numpy.frombuffer(value.encode(), "int8")


def texts(values):
    return numpy.frombuffer("".join(value.ljust(32) for value in values).encode(), "int8").reshape(len(values), 32)


def put(parent, name, label, data=None):
    """Adds a node to a node of a CGNS file in HDF5; arrays run as in C, with the last dimension fastest."""
    node = parent.create_group(name, track_order=True)
    if data is None:
        kind = "MT"
    else:
        data = numpy.asarray(data)
        kind = TYPES[data.dtype]
        node.create_dataset(" data", data=data)
    node.attrs.create("flags", numpy.array([1], "int32"))
    for key, value, size in (("label", label, 33), ("name", name, 33), ("type", kind, 3)):
        node.attrs.create(key, numpy.bytes_(value), dtype=f"S{size}")
    return node


def new_file(path, version=3.3):
    file = h5py.File(path, "w", track_order=True)
    for key, value, size in (("label", "Root Node of HDF5 File", 33), ("name", "HDF5 MotherNode", 33), ("type", "MT", 3)):
        file.attrs.create(key, numpy.bytes_(value), dtype=f"S{size}")
    file.create_dataset(" format", data=text("IEEE_LITTLE_32\0"))
    file.create_dataset(" hdf5version", data=text("HDF5 Version 1.10.8".ljust(33, "\0")))
    put(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", numpy.array([version], "float32"))
    return file


def put_zone(base, name, points, cells, whole="int32", real="float64"):
    zone = put(base, name, "Zone_t", numpy.array([[len(points)], [cells], [0]], whole))
    put(zone, "ZoneType", "ZoneType_t", text("Unstructured"))
    grid = put(zone, "GridCoordinates", "GridCoordinates_t")
    for axis, values in zip("XYZ", points.T):
        put(grid, f"Coordinate{axis}", "DataArray_t", values.astype(real))
    return zone


def put_section(zone, name, number, first, count, connectivity, whole="int32", offsets=None):
    section = put(zone, name, "Elements_t", numpy.array([number, 0], "int32"))
    put(section, "ElementRange", "IndexRange_t", numpy.array([first, first + count - 1], whole))
    put(section, "ElementConnectivity", "DataArray_t", numpy.asarray(connectivity, whole).ravel())
    if offsets is not None:
        put(section, "ElementStartOffset", "DataArray_t", numpy.asarray(offsets, whole))
    return section


def put_condition(zone, name, location, points, whole="int32", kind="BCWall"):
    """`points`: numbers, or a pair of the first and the last number."""
    conditions = zone["ZoneBC"] if "ZoneBC" in zone else put(zone, "ZoneBC", "ZoneBC_t")
    condition = put(conditions, name, "BC_t", text(kind))
    if isinstance(points, tuple):
        put(condition, "PointRange", "IndexRange_t", numpy.array(points, whole)[:, None])
    else:
        put(condition, "PointList", "IndexArray_t", numpy.asarray(points, whole)[:, None])
    put(condition, "GridLocation", "GridLocation_t", text(location))
    return condition


def word(node):
    return node[" data"][...].tobytes().decode().rstrip()


def label(node):
    return node.attrs["label"].decode()


def children(node, wanted):
    return [child for child in node.values() if isinstance(child, h5py.Group) and label(child) == wanted]


class Zone:
    """The content of a zone, with points and cells instead of their numbers."""

    def __init__(self, node):
        self.node = node
        grid = node["GridCoordinates"]
        axes = [grid[f"Coordinate{axis}"][" data"][...] for axis in "XYZ" if f"Coordinate{axis}" in grid]
        self.points = [tuple(point) for point in numpy.stack(axes, -1).astype(float).tolist()]
        self.cells = {}
        self.sections = {}
        for section in children(node, "Elements_t"):
            first, last = section["ElementRange"][" data"][...].tolist()
            kind = int(section[" data"][0])
            numbers = section["ElementConnectivity"][" data"][...].tolist()
            found, at, starts = [], 0, [0]
            for element in range(first, last + 1):
                own = kind
                if kind == 20:
                    own = numbers[at]
                    at += 1
                cell = tuple(self.points[v - 1] for v in numbers[at:at + NODES[own]])
                at += NODES[own]
                starts.append(at)
                self.cells[element] = (own, cell)
                found.append((own, cell))
            assert at == len(numbers)
            if "ElementStartOffset" in section:
                assert section["ElementStartOffset"][" data"][...].tolist() == starts
            self.sections[section.name] = sorted(found)
        assert sorted(self.cells) == list(range(1, len(self.cells) + 1))

    def items(self, node, inherited="Vertex"):
        """The points or cells that a node belongs to, in its order."""
        location = word(node["GridLocation"]) if "GridLocation" in node else inherited
        of = dict(enumerate(self.points, 1)) if location == "Vertex" else self.cells
        if "PointList" in node:
            return [of[k] for k in node["PointList"][" data"][...].ravel().tolist()]
        if "PointRange" in node:
            first, last = node["PointRange"][" data"][...].ravel().tolist()
            return [of[k] for k in range(first, last + 1)]
        if location == "Vertex":
            return self.points
        return [self.cells[k] for k in sorted(self.cells) if self.cells[k][0] >= 10]

    def solutions(self):
        result = {}
        for solution in children(self.node, "FlowSolution_t"):
            for array in children(solution, "DataArray_t"):
                values = array[" data"][...]
                pairs = sorted(zip(self.items(solution), values.tolist()), key=repr)
                result[array.name] = (array.attrs["type"], pairs)
        return result

    def conditions(self):
        result = {}
        for conditions in children(self.node, "ZoneBC_t"):
            for condition in children(conditions, "BC_t"):
                items = self.items(condition)
                data = {}
                for local in children(condition, "BCDataSet_t"):
                    for array in [a for values in children(local, "BCData_t") for a in children(values, "DataArray_t")]:
                        data[array.name] = sorted(zip(items, array[" data"][...].tolist()), key=repr)
                result[condition.name] = (word(condition), sorted(items, key=repr), data)
        return result

    def parents(self):
        result = {}
        for section in children(self.node, "Elements_t"):
            if "ParentElements" not in section:
                continue
            first = int(section["ElementRange"][" data"][0])
            rows = zip(section["ParentElements"][" data"][...].T.tolist(),
                       section["ParentElementsPosition"][" data"][...].T.tolist())
            result[section.name] = sorted(
                ((self.cells[first + k], [self.cells.get(p) for p in cells], sides)
                 for k, (cells, sides) in enumerate(rows)), key=repr)
        return result


def content(path):
    """The content of a file by node name, and the bytes of all nodes that refer to no points or cells."""
    with h5py.File(path) as file:
        zones = {zone.name: Zone(zone) for base in children(file, "CGNSBase_t") for zone in children(base, "Zone_t")}
        result = {}
        for name, zone in zones.items():
            result[name] = [sorted(zone.points), zone.sections, zone.solutions(), zone.conditions(), zone.parents(),
                            zone.node[" data"][...].tolist()]
            for connections in children(zone.node, "ZoneGridConnectivity_t"):
                for connection in children(connections, "GridConnectivity_t"):
                    donor = zones[f"/Base/{word(connection)}"]
                    pairs = zip(connection["PointList"][" data"][...].ravel().tolist(),
                                connection["PointListDonor"][" data"][...].ravel().tolist())
                    result[connection.name] = sorted((zone.points[a - 1], donor.points[b - 1]) for a, b in pairs)
        plain = {}
        moving = ("Elements_t", "FlowSolution_t", "GridCoordinates_t", "ZoneGridConnectivity_t")

        def visit(name, item):
            if not isinstance(item, h5py.Group) or label(item) in ("Zone_t", "IndexArray_t", "IndexRange_t"):
                return
            parts = ["/" + "/".join(name.split("/")[:k + 1]) for k in range(name.count("/") + 1)]
            if any(label(file[part]) in moving for part in parts):
                return
            plain["/" + name] = (label(item), item.attrs["type"],
                                 item[" data"][...].tolist() if " data" in item else None)

        file.visititems(visit)
        result["plain"] = plain
        return result


def numbers(path, zone="/Base/A"):
    with h5py.File(path) as file:
        return {section.name: section["ElementConnectivity"][" data"][...].tolist()
                for section in children(file[zone], "Elements_t")}


def write_rich(path, whole="int32", offsets=False, real="float64"):
    """Two zones with conditions, solutions, parents of faces and a connectivity; one has sections by type, one is mixed."""
    points, tetrahedra, triangles = box(3, 1)
    others, more, faces = box(2, 2, at=3.0)
    with new_file(path, 4.0 if offsets else 3.3) as file:
        base = put(file, "Base", "CGNSBase_t", numpy.array([3, 3], "int32"))
        put(base, "About", "Descriptor_t", text("made by hand"))
        family = put(base, "walls", "Family_t")
        put(family, "FamBC", "FamilyBC_t", text("BCWall"))
        state = put(base, "ReferenceState", "ReferenceState_t")
        put(state, "Mach", "DataArray_t", numpy.array([0.8]))

        zone = put_zone(base, "A", points, len(tetrahedra), whole, real)
        count, low = len(tetrahedra), len(triangles)
        # boundaries have the first numbers, and cells are in two sections
        side = put_section(zone, "side", 5, 1, low, triangles + 1, whole)
        put_section(zone, "front", 10, low + 1, 60, tetrahedra[:60] + 1, whole)
        put_section(zone, "rest", 10, low + 61, count - 60, tetrahedra[60:] + 1, whole)
        parent = {frozenset(cell[i] for i in face): (k, side) for k, cell in enumerate(tetrahedra.tolist(), low + 1)
                  for side, face in enumerate(((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)), 1)}
        of_faces = numpy.array([parent[frozenset(face)] for face in triangles.tolist()], whole)
        for k, name in enumerate(("ParentElements", "ParentElementsPosition")):
            put(side, name, "DataArray_t", numpy.stack([of_faces[:, k], 0 * of_faces[:, k]]))
        put_condition(zone, "low", "FaceCenter", (1, low), whole)
        corner = put_condition(zone, "corner", "Vertex", [5, 2, 9], whole, "BCDirichlet")
        values = put(put(corner, "Data", "BCDataSet_t", text("BCDirichlet")), "DirichletData", "BCData_t")
        put(values, "Temperature", "DataArray_t", numpy.array([50.0, 20.0, 90.0]))
        put_condition(zone, "some", "FaceCenter", [3, 7, 4], whole)
        for step in (1, 2):
            solution = put(zone, f"Solution{step}", "FlowSolution_t")
            put(solution, "GridLocation", "GridLocation_t", text("Vertex"))
            put(solution, "Pressure", "DataArray_t", (points @ [1, 10, 100] + step).astype("float32"))
        centre = put(zone, "AtCells", "FlowSolution_t")
        put(centre, "GridLocation", "GridLocation_t", text("CellCenter"))
        put(centre, "Number", "DataArray_t", numpy.arange(count, dtype="int64"))
        put(centre, "Volume", "DataArray_t", points[tetrahedra].mean(1) @ [1, 10, 100])
        times = put(zone, "ZoneIterativeData", "ZoneIterativeData_t")
        put(times, "FlowSolutionPointers", "DataArray_t", texts(["Solution1", "Solution2"]))
        put(put(base, "Times", "BaseIterativeData_t", numpy.array([2], "int32")), "TimeValues", "DataArray_t",
            numpy.array([0.5, 1.5]))

        second = put_zone(base, "B", others, len(more), whole, real)
        mixed, starts = [], [0]
        for kind, cell in [(10, cell) for cell in more.tolist()] + [(5, face) for face in faces.tolist()]:
            mixed += [kind] + [v + 1 for v in cell]
            starts.append(len(mixed))
        put_section(second, "all", 20, 1, len(more) + len(faces), mixed, whole, starts if offsets else None)
        put_condition(second, "low", "FaceCenter", (len(more) + 1, len(more) + len(faces)), whole)
        centre = put(second, "AtCells", "FlowSolution_t")
        put(centre, "GridLocation", "GridLocation_t", text("CellCenter"))
        put(centre, "Volume", "DataArray_t", others[more].mean(1) @ [1, 10, 100])

        place = {tuple(point): k for k, point in enumerate(points.tolist(), 1)}
        shared = [(place[tuple(point)], k) for k, point in enumerate(others.tolist(), 1) if tuple(point) in place]
        assert len(shared) == 9
        connection = put(put(zone, "ZoneGridConnectivity", "ZoneGridConnectivity_t"), "to B", "GridConnectivity_t", text("B"))
        put(connection, "GridConnectivityType", "GridConnectivityType_t", text("Abutting1to1"))
        put(connection, "PointList", "IndexArray_t", numpy.array(shared, whole)[:, :1])
        put(connection, "PointListDonor", "IndexArray_t", numpy.array(shared, whole)[:, 1:])


def keep(command, source, target, *options):
    """Writes a file again, or in another format, in the same order."""
    return command.ok("order", source, "-o", target, "--vertices", "original", "--elements", "original", *options)


def checked(folder, name):
    """The output of cgnscheck for a file, in which it must find no error."""
    done = subprocess.run(["cgnscheck", name], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "ERROR" not in done.stdout + done.stderr, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("whole", ["int32", "int64"])
@pytest.mark.parametrize("offsets", [False, True])
def test_everything_moves_with_its_vertices_and_cells(command, tmp_path, whole, offsets):
    write_rich(tmp_path / "a.cgns", whole, offsets, "float32" if offsets else "float64")
    before = content(tmp_path / "a.cgns")
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    after = content(tmp_path / "b.cgns")
    assert after == before
    assert numbers(tmp_path / "b.cgns") != numbers(tmp_path / "a.cgns")
    assert numbers(tmp_path / "b.cgns", "/Base/B") != numbers(tmp_path / "a.cgns", "/Base/B")
    keep(command, "b.cgns", "c.cgns")
    assert content(tmp_path / "c.cgns") == before
    assert numbers(tmp_path / "c.cgns") == numbers(tmp_path / "b.cgns")
    if whole == "int32" and not offsets and shutil.which("cgnscheck"):
        checked(tmp_path, "b.cgns")


@pytest.mark.parametrize("named", [False, True])
def test_data_of_ranges_stay_with_their_elements(command, tmp_path, named):
    points, tetrahedra, triangles = box(2, 1)
    of_faces = points[triangles].mean(1) @ [1, 10, 100]
    with new_file(tmp_path / "a.cgns") as file:
        base = put(file, "Base", "CGNSBase_t", numpy.array([3, 3], "int32"))
        zone = put_zone(base, "A", points, len(tetrahedra))
        put_section(zone, "cells", 10, 1, len(tetrahedra), tetrahedra + 1)
        put_section(zone, "faces", 5, len(tetrahedra) + 1, len(triangles), triangles + 1)
        span = (len(tetrahedra) + 1, len(tetrahedra) + len(triangles))
        put_condition(zone, "bare", "FaceCenter", span)
        wall = put_condition(zone, "wall", "FaceCenter", span)
        if named:
            region = put(zone, "Region", "ZoneSubRegion_t", numpy.array([2], "int32"))
            put(region, "BCRegionName", "Descriptor_t", text("wall"))
            put(region, "Heat", "DataArray_t", of_faces)
        else:
            values = put(put(wall, "Data", "BCDataSet_t", text("BCDirichlet")), "DirichletData", "BCData_t")
            put(values, "Heat", "DataArray_t", of_faces)
        part = put(zone, "Part", "FlowSolution_t")
        put(part, "GridLocation", "GridLocation_t", text("Vertex"))
        put(part, "PointRange", "IndexRange_t", numpy.array([[1], [9]], "int32"))
        put(part, "Pressure", "DataArray_t", points[:9] @ [1, 10, 100])
    before = content(tmp_path / "a.cgns")
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "scrambled", "--elements", "scrambled")
    assert content(tmp_path / "b.cgns") == before
    with h5py.File(tmp_path / "b.cgns") as file:
        zone = file["Base/A"]
        heat = (zone["Region/Heat"] if named else zone["ZoneBC/wall/Data/DirichletData/Heat"])[" data"][...]
        faces = [numpy.mean(face, 0) @ [1, 10, 100] for _, face in Zone(zone).items(zone["ZoneBC/wall"])]
        assert numpy.allclose(heat, faces)
        assert ("PointRange" in zone["ZoneBC/bare"]) == (not named)


@pytest.mark.parametrize("location", ["Vertex", "CellCenter"])
def test_ranges_of_holes_become_one_list(command, tmp_path, location):
    points, tetrahedra, _ = box(2, 1)
    with new_file(tmp_path / "a.cgns") as file:
        base = put(file, "Base", "CGNSBase_t", numpy.array([3, 3], "int32"))
        zone = put_zone(base, "A", points, len(tetrahedra))
        put_section(zone, "cells", 10, 1, len(tetrahedra), tetrahedra + 1)
        holes = put(put(zone, "ZoneGridConnectivity", "ZoneGridConnectivity_t"), "Holes", "OversetHoles_t")
        put(holes, "GridLocation", "GridLocation_t", text(location))
        for name, span in (("PointRange1", (1, 3)), ("PointRange2", (3, 4)), ("PointRange3", (8, 9))):
            put(holes, name, "IndexRange_t", numpy.array(span, "int32")[:, None])

    def in_holes(path):
        with h5py.File(path) as opened:
            parts = Zone(opened["Base/A"])
            node = opened["Base/A/ZoneGridConnectivity/Holes"]
            return sorted(parts.items(node, location)), [child for child in node if child.startswith("Point")]

    keep(command, "a.cgns", "b.cgns")
    command.ok("order", "b.cgns", "-o", "c.cgns", "--vertices", "scrambled", "--elements", "scrambled")
    items = [tuple(point) for point in points.tolist()]
    if location == "CellCenter":
        items = [(10, tuple(items[v] for v in cell)) for cell in tetrahedra]
    wanted = sorted(items[k - 1] for k in (1, 2, 3, 4, 8, 9))
    assert in_holes(tmp_path / "b.cgns") == (wanted, ["PointList"])
    assert in_holes(tmp_path / "c.cgns") == (wanted, ["PointList"])
    if shutil.which("cgnscheck"):
        checked(tmp_path, "c.cgns")


def test_arrays_sets_and_steps_get_names(command, tmp_path):
    write_rich(tmp_path / "a.cgns")
    info = command.ok("info", "a.cgns").stdout
    for name in ("Pressure step 1", "Pressure step 2", "Volume", "Number", "A.low", "B.low", "corner", "some", "zone"):
        assert name in info
    done = keep(command, "a.cgns", "b.vtu")
    mesh = meshio.read(tmp_path / "b.vtu")
    assert numpy.allclose(mesh.point_data["Pressure step 2"][:64], mesh.points[:64] @ [1, 10, 100] + 2)
    volumes = numpy.concatenate([mesh.cell_data["Volume"][k] for k, block in enumerate(mesh.cells) if block.type == "tetra"])
    centres = numpy.concatenate([mesh.points[block.data].mean(1) for block in mesh.cells if block.type == "tetra"])
    assert numpy.allclose(volumes, centres @ [1, 10, 100])
    for lost in ("BCDataSet_t", "Family_t", "ZoneGridConnectivity_t"):
        assert lost in done.stderr


def test_zones_stay_apart_and_the_maps_can_say_so(command, tmp_path):
    write_rich(tmp_path / "a.cgns")
    hint = "the vertices are written zone by zone"
    assert hint in command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "scrambled").stderr
    done = command.ok("order", "a.cgns", "-o", "c.cgns", "--vertices", "rcm", "--group-by", "zone", "--maps", "m")
    assert hint not in done.stderr
    old_to_new = numpy.load(tmp_path / "m.vertices.old_to_new.npy")
    with h5py.File(tmp_path / "a.cgns") as a, h5py.File(tmp_path / "c.cgns") as c:
        x = [numpy.concatenate([file[f"Base/{zone}/GridCoordinates/CoordinateX/ data"][...] for zone in "AB"])
             for file in (a, c)]
    assert numpy.array_equal(x[1][old_to_new], x[0])


def test_values_of_each_type_move_and_keep_it(command, tmp_path):
    points, tets, _ = box(3, 1)
    with new_file(tmp_path / "a.cgns") as file:
        base = put(file, "Base", "CGNSBase_t", numpy.array([3, 3], "int32"))
        for name, real in (("A", "float64"), ("B", "float32")):
            zone = put_zone(base, name, points, len(tets), real=real)
            put_section(zone, "Tets", 10, 1, len(tets), tets + 1)
            solution = put(zone, "Solution", "FlowSolution_t")
            place = numpy.round(points @ [7, 49, 343])
            put(solution, "Density", "DataArray_t", (place * (1e165 if real == "float64" else 1)).astype(real))
            put(solution, "Mark", "DataArray_t", (place % 256).astype("uint8"))
            put(solution, "Letters", "DataArray_t", numpy.full(len(points), ord("a"), "int8"))
            put(solution, "Nothing", "DataArray_t")
    done = command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "scrambled", "--elements", "original")
    assert "/Base/A/Solution/Letters' is kept as it is, though it has as many characters as there are vertices" in done.stderr
    with h5py.File(tmp_path / "a.cgns") as a, h5py.File(tmp_path / "b.cgns") as b:
        for zone in "AB":
            def rows(file):
                node = file[f"Base/{zone}"]  # noqa: B023
                columns = [node[f"GridCoordinates/Coordinate{axis}/ data"][...] for axis in "XYZ"]
                columns += [node[f"Solution/{name}/ data"][...] for name in ("Density", "Mark")]
                assert "Nothing" in node["Solution"] and " data" not in node["Solution/Nothing"]
                return [column.dtype for column in columns], list(zip(*(column.tolist() for column in columns)))
            before, after = rows(a), rows(b)
            assert before[0] == after[0] and before[1] != after[1] and sorted(before[1]) == sorted(after[1])


def test_blanks_at_the_ends_of_names_and_labels_fill_up_their_places(command, tmp_path):
    write_rich(tmp_path / "a.cgns")
    def contents_in_words():
        return command.ok("info", "a.cgns").stdout.split("\nformat ")[1].split("\nKernels ")[0]

    before, told = content(tmp_path / "a.cgns"), contents_in_words()
    with h5py.File(tmp_path / "a.cgns", "r+") as file:

        def fill(_, item):
            if isinstance(item, h5py.Group):
                for key in ("name", "label"):
                    item.attrs.create(key, item.attrs[key].ljust(32), dtype="S33")

        file.visititems(fill)
    assert contents_in_words() == told
    command.ok("order", "a.cgns", "-o", "b.cgns", "--vertices", "rcm", "--elements", "min")
    assert content(tmp_path / "b.cgns") == before


@needs_tools
def test_adf_stays_adf(command, tmp_path):
    write_rich(tmp_path / "a.cgns", real="float32")
    subprocess.run(["hdf2adf", "a.cgns", "adf.cgns"], cwd=tmp_path, check=True, capture_output=True)
    assert (tmp_path / "adf.cgns").read_bytes().startswith(ADF)
    command.ok("order", "adf.cgns", "-o", "ordered.cgns", "--vertices", "rcm", "--elements", "min")
    assert (tmp_path / "ordered.cgns").read_bytes().startswith(ADF)
    checked(tmp_path, "ordered.cgns")
    subprocess.run(["adf2hdf", "ordered.cgns", "b.cgns"], cwd=tmp_path, check=True, capture_output=True)
    after, before = content(tmp_path / "b.cgns"), content(tmp_path / "a.cgns")
    assert after == before


@needs_tools
def test_an_unchanged_file_is_the_same_to_cgnsdiff(command, tmp_path):
    write_rich(tmp_path / "a.cgns")
    keep(command, "a.cgns", "b.cgns")
    done = subprocess.run(["cgnsdiff", "-d", "a.cgns", "b.cgns"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "" and done.returncode == 0, done.stdout


def write_grouped(folder):
    """A mesh of Gmsh with groups of volumes and of triangles, and values of points and cells."""
    points, tetrahedra, triangles = box(3, 4)
    tags = [1 + (numpy.arange(len(tetrahedra)) % 2), 3 + (numpy.arange(len(triangles)) % 2)]
    mesh = meshio.Mesh(points, [("tetra", tetrahedra), ("triangle", triangles)],
                       point_data={"u": points * 2.0, "n": numpy.arange(len(points), dtype="int32")},
                       cell_data={"q": [points[tetrahedra].mean(1)[:, 0], points[triangles].mean(1)[:, 0]],
                                  "label": [tag.astype("int32") for tag in tags]})
    meshio.write(folder / "a.vtu", mesh)
    return points, tetrahedra, triangles, tags


@needs_tools
def test_meshes_of_other_formats_become_files_that_cgnscheck_accepts(command, tmp_path):
    points, tetrahedra, triangles, tags = write_grouped(tmp_path)
    keep(command, "a.vtu", "b.cgns")
    checked(tmp_path, "b.cgns")
    with h5py.File(tmp_path / "b.cgns") as file:
        zone = Zone(file["Base/Zone"])
        found = zone.solutions()
        kinds = {name.rsplit("/", 1)[1]: len(cells) for name, cells in zone.sections.items()}
    assert kinds == {f"TETRA_4_{k}": len(tetrahedra) // 2 for k in (1, 2)} | {f"TRI_3_{k}": len(triangles) // 2 for k in (3, 4)}
    for axis, name in enumerate("XYZ"):
        kind, pairs = found[f"/Base/Zone/VertexSolution/u{name}"]
        assert kind == b"R8" and all(value == 2 * point[axis] for point, value in pairs)
    assert found["/Base/Zone/VertexSolution/n"][0] == b"I4"
    _, pairs = found["/Base/Zone/CellSolution/q"]
    assert all(abs(value - numpy.mean([p[0] for p in cell])) < 1e-12 for (_, cell), value in pairs)
    # and back: values and labels of triangles, too
    keep(command, "b.cgns", "c.vtu")
    mesh = meshio.read(tmp_path / "c.vtu")
    for block, labels, q in zip(mesh.cells, mesh.cell_data["label"], mesh.cell_data["q"]):
        assert numpy.allclose(q, mesh.points[block.data].mean(1)[:, 0])
        source, of = (tetrahedra, tags[0]) if block.type == "tetra" else (triangles, tags[1])
        known = {frozenset(map(tuple, points[cell])): tag for cell, tag in zip(source, of)}
        assert [known[frozenset(map(tuple, mesh.points[cell]))] for cell in block.data] == labels.tolist()


def test_groups_become_conditions_and_come_back(command, tmp_path):
    points, tetrahedra, triangles = box(2, 5)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '2 7 "inlet"', '2 8 "wall"', '3 9 "fluid"',
             "$EndPhysicalNames", "$Nodes", str(len(points))]
    lines += [f"{k} {x} {y} {z}" for k, (x, y, z) in enumerate(points, 1)]
    cells = [(2, 7 + k % 2, cell) for k, cell in enumerate(triangles)] + [(4, 9, cell) for cell in tetrahedra]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [" ".join(map(str, [k, kind, 2, tag, tag, *(cell + 1)])) for k, (kind, tag, cell) in enumerate(cells, 1)]
    (tmp_path / "a.msh").write_text("\n".join([*lines, "$EndElements", ""]))
    command.ok("order", "a.msh", "-o", "b.cgns")
    if shutil.which("cgnscheck"):
        checked(tmp_path, "b.cgns")
    with h5py.File(tmp_path / "b.cgns") as file:
        zone = Zone(file["Base/Zone"])
        found = {name.rsplit("/", 1)[1]: items for name, (_, items, _) in zone.conditions().items()}
        assert set(found) == {"inlet", "wall"} == set(file["Base/Zone"]) & {"inlet", "wall"}
        assert len(zone.items(file["Base/Zone/fluid"])) == len(tetrahedra)
    for k, name in enumerate(("inlet", "wall")):
        assert sorted(cell for _, cell in found[name]) == sorted(tuple(map(tuple, points[c].tolist())) for c in triangles[k::2])
    keep(command, "b.cgns", "c.msh")
    mesh = meshio.read(tmp_path / "c.msh")
    assert set(mesh.field_data) == {"inlet", "wall", "fluid"}


def test_left_out_cells_leave_no_traces(command, tmp_path):
    write_rich(tmp_path / "a.cgns")
    done = keep(command, "a.cgns", "b.cgns", "--only", "volume")
    found = content(tmp_path / "b.cgns")
    assert set(found["/Base/A"][1]) == {"/Base/A/front", "/Base/A/rest"}
    assert set(found["/Base/A"][3]) == {"/Base/A/ZoneBC/corner"}
    assert found["/Base/A"][2] == content(tmp_path / "a.cgns")["/Base/A"][2]
    assert "left out" in done.stderr


# ---- what cannot be read

def broken(name):
    return {
        "structured": (lambda f: f["Base/A/ZoneType"][" data"].write_direct(text("Structured  ")), "structured"),
        "vertex": (lambda f: f["Base/A/front/ElementConnectivity/ data"].__setitem__(5, 65), "element 2: vertex 65 does not exist"),
        "zero": (lambda f: f["Base/A/front/ElementConnectivity/ data"].__setitem__(0, 0), "vertex 0 does not exist"),
        "range": (lambda f: f["Base/A/front/ElementRange/ data"].__setitem__(1, 90), "numbers"),
        "type": (lambda f: f["Base/A/front/ data"].__setitem__(0, 99), "unknown type 99"),
        "polyhedra": (lambda f: f["Base/A/front/ data"].__setitem__(0, 22), "front, element 19: is a polygon of 2 vertices"),
        "list": (lambda f: f["Base/A/ZoneBC/corner/PointList/ data"].__setitem__((0, 0), 1000), "vertex 1000 does not exist"),
        "element": (lambda f: f["Base/A/ZoneBC/some/PointList/ data"].__setitem__((0, 0), -4), "element -4 does not exist"),
        "nan": (lambda f: f["Base/A/GridCoordinates/CoordinateX/ data"].__setitem__(0, float("nan")), "finite"),
        "count": (lambda f: f["Base/A/ data"].__setitem__((0, 0), 2000000000), "values for 2000000000 vertices"),
        "label": (lambda f: f["Base/A"].attrs.__delitem__("label"), "'label' is missing"),
        "long": (lambda f: f["Base/A"].attrs.create("name", numpy.bytes_("A" * 300), dtype="S300"), "at most 33 bytes"),
        "kind": (lambda f: f["Base/A/front/ElementConnectivity"].attrs.create("type", numpy.bytes_("R8"), dtype="S3"), "'R8' but has others"),
        "link": (lambda f: f["Base"].__setitem__("C", h5py.ExternalLink("other.cgns", "/Base/A")), "is a link"),
        "loop": (lambda f: f["Base/A"].__setitem__("again", f["Base"]), "is in the file twice"),
        "donor": (lambda f: f["Base/A/ZoneGridConnectivity/to B/ data"].write_direct(text("C")), "zone 'C', which does not exist"),
        "no base": (lambda f: f.__delitem__("Base"), "has no base"),
        "no version": (lambda f: f.__delitem__("CGNSLibraryVersion"), "version of CGNS"),
        "coordinate": (lambda f: f["Base/A/GridCoordinates"].__delitem__("CoordinateY"), "has no CoordinateY"),
        "solution": (lambda f: f["Base/B/AtCells/GridLocation/ data"].write_direct(text("Vertex    ")), "values for 27 vertices"),
        "two bases": (lambda f: put(f, "Two", "CGNSBase_t", numpy.array([3, 3], "int32")), "two bases"),
    }[name]


@pytest.mark.parametrize("name", ["structured", "vertex", "zero", "range", "type", "polyhedra", "list", "element", "nan", "count",
                                  "label", "long", "kind", "link", "loop", "donor", "no base", "no version", "coordinate",
                                  "solution", "two bases"])
def test_faults_are_named(command, tmp_path, name):
    write_rich(tmp_path / "a.cgns")
    change, words = broken(name)
    with h5py.File(tmp_path / "a.cgns", "r+") as file:
        change(file)
    assert words in command.fails("order", "a.cgns", "-o", "b.cgns")
    assert not (tmp_path / "b.cgns").exists()


def test_files_cut_short_are_refused(command, tmp_path):
    write_rich(tmp_path / "a.cgns")
    whole = (tmp_path / "a.cgns").read_bytes()
    for length in (1, 8, 100, 2000, len(whole) // 2, len(whole) - 1):
        (tmp_path / "cut.cgns").write_bytes(whole[:length])
        command.fails("order", "cut.cgns", "-o", "b.cgns")
    (tmp_path / "empty.cgns").write_bytes(b"")
    assert "is empty" in command.fails("order", "empty.cgns", "-o", "b.cgns")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.cgns", "cut.cgns", "empty.cgns"]


@needs_tools
def test_adf_files_cut_short_are_refused(command, tmp_path):
    write_rich(tmp_path / "a.cgns")
    subprocess.run(["hdf2adf", "a.cgns", "adf.cgns"], cwd=tmp_path, check=True, capture_output=True)
    whole = (tmp_path / "adf.cgns").read_bytes()
    for length in (10, 200, 2000, len(whole) // 2):
        (tmp_path / "cut.cgns").write_bytes(whole[:length])
        command.fails("order", "cut.cgns", "-o", "b.cgns")
