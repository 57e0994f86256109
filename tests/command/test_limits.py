# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Limits for input files: memory for files that claim more data than they hold, files they may name, and time per byte."""
import contextlib
import gzip
import os
import random
import resource
import struct
import subprocess
import threading
import time
import zlib

import conftest
import pytest

REMEDY = "if you trust the file, raise the memory limit (--limit-memory)"
TETRAHEDRON = "*VERTICES\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n*ELEMENTS\nTET\n1 4 0\n1 1 2 3 4\n"
GIGABYTE = 1 << 30


def run_within(gigabytes, folder, *arguments):
    """Runs the command with a limit of its address space, beyond which allocations fail."""
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (gigabytes * GIGABYTE, gigabytes * GIGABYTE))

    return subprocess.run([conftest.MESHORDER, *map(str, arguments)], cwd=folder, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=120, check=False, preexec_fn=limit)


def refused(folder, *arguments):
    """Returns the one line of error; the file must be refused before memory for its claims is allocated."""
    done = run_within(3, folder, *arguments)
    lines = done.stderr.strip().splitlines()
    assert done.returncode == 2 and len(lines) == 1 and done.stdout == "", done.stderr
    return lines[0]


def vtu(in_grid="", attributes="", appended=b""):
    text = ('<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"'
            f'{attributes}><UnstructuredGrid>\n{in_grid}<Piece NumberOfPoints="3" NumberOfCells="1"><Points>'
            '<DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points>'
            '<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>'
            '<DataArray type="Int32" Name="offsets" format="ascii">3</DataArray>'
            '<DataArray type="Int32" Name="types" format="ascii">5</DataArray></Cells></Piece></UnstructuredGrid>')
    if appended:
        return text.encode() + b'<AppendedData encoding="raw">_' + appended + b"</AppendedData></VTKFile>\n"
    return (text + "</VTKFile>\n").encode()


def test_arrays_that_share_a_compressed_block(command, tmp_path):
    """A file of 28 kB that claims 12.8 GB."""
    size = 64 << 20
    block = zlib.compress(bytes(size), 9)
    arrays = "".join(f'<DataArray type="Int8" Name="f{k}" NumberOfTuples="{size}" format="appended" offset="0"/>\n'
                     for k in range(200))
    file = vtu(f"<FieldData>{arrays}</FieldData>", ' compressor="vtkZLibDataCompressor"',
               struct.pack("<4Q", 1, size, 0, len(block)) + block)
    (tmp_path / "a.vtu").write_bytes(file)
    assert len(file) < 100_000
    line = refused(tmp_path, "info", "a.vtu")
    assert line.startswith("meshorder: a.vtu:") and "would take 256 MiB in addition to 256 MiB, more than the limit of 26" in line
    assert line.endswith(REMEDY)
    done = run_within(1, tmp_path, "info", "a.vtu", "--limit-memory", "none")
    assert done.returncode == 1 and "out of memory" in done.stderr
    assert "more than the limit of 100 MiB; " in command.fails("info", "a.vtu", "--limit-memory", "100M")
    for wrong in ("0", "4X", ""):
        assert "--limit-memory: " in command.fails("info", "a.vtu", "--limit-memory", wrong)


def test_a_gzip_file_of_blanks(tmp_path):
    packed = gzip.compress(b"OFF\n" + b" " * (300 << 20), 9)
    (tmp_path / "a.off.gz").write_bytes(packed)
    line = refused(tmp_path, "info", "a.off.gz")
    assert line.startswith("meshorder: a.off.gz: the decompressed file would take 8 MiB in addition to ")
    assert line.endswith(REMEDY)


XDMF = ('<Xdmf><Domain><Grid><Topology TopologyType="Triangle" NumberOfElements="1"><DataItem Dimensions="1 3" '
        'NumberType="Int" Format="XML">0 1 2</DataItem></Topology><Geometry GeometryType="XYZ"><DataItem '
        'Dimensions="{} 3" Precision="8" Format="{}">{}</DataItem></Geometry>{}</Grid></Domain></Xdmf>\n')


def test_datasets_of_values_that_are_not_there(tmp_path):
    h5py = pytest.importorskip("h5py")
    points = 1 << 20
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.create_dataset("none", shape=(10**12, 3), dtype="f8", chunks=(1 << 16, 3), compression="gzip", fillvalue=1)
        for name, shape in (("p", (points, 3)), ("u", (points,))):
            file.create_dataset(name, shape=shape, dtype="f8", chunks=shape, compression="gzip")[...] = 0
    (tmp_path / "a.xdmf").write_text(XDMF.format(10**12, "HDF", "a.h5:/none", ""))
    assert "claims 3000000000000 values, but only 0 bytes are stored" in refused(tmp_path, "info", "a.xdmf")
    array = '<Attribute Name="a{}" Center="Node"><DataItem Dimensions="{}" Format="HDF">a.h5:/u</DataItem></Attribute>\n'
    arrays = "".join(array.format(k, points) for k in range(400))
    (tmp_path / "b.xdmf").write_text(XDMF.format(points, "HDF", "a.h5:/p", arrays))
    line = refused(tmp_path, "info", "b.xdmf")
    assert line.startswith("meshorder: a.h5: the dataset '/u' ") and " in addition to 256 MiB, more than " in line
    assert line.endswith(REMEDY)


def test_dimensions_of_netcdf(tmp_path):
    netcdf = pytest.importorskip("netCDF4")
    with netcdf.Dataset(tmp_path / "a.exo", "w") as file:
        for name, length in (("num_dim", 3), ("num_el_blk", 1), ("num_elem", 1), ("num_el_in_blk1", 1), ("num_nod_per_el1", 1)):
            file.createDimension(name, length)
        file.createVariable("connect1", "i4", ("num_el_in_blk1", "num_nod_per_el1")).elem_type = "SPHERE"
        file.createDimension("num_nodes", 2_000_000_000)
        file.createVariable("coord", "f8", ("num_dim", "num_nodes"), zlib=True, chunksizes=(1, 1 << 16))
    assert "coord claims more values than a file of" in refused(tmp_path, "info", "a.exo")


def test_cells_of_many_vertices(command, tmp_path):
    """A graph that joins all n vertices of a cell has about n² entries."""
    count = 20_000
    numbers = " ".join(map(str, range(count)))
    (tmp_path / "a.vtk").write_text(f"# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {count} float\n"
                                    + "0 0 0\n" * count + f"CELLS 2 {count + 4}\n2 0 1\n{count} {numbers}\nCELL_TYPES 2\n3\n68\n")
    for arguments in (("info", "a.vtk"), ("compare", "a.vtk"), ("order", "a.vtk", "-o", "b.vtk", "--vertices", "rcm")):
        line = refused(tmp_path, *arguments)
        assert line.startswith("meshorder: cell 1 has 20000 vertices, each joined to all others: the graph would take ")
        assert "more than the limit of 2" in line and line.endswith("(--limit-memory)")
    assert not (tmp_path / "b.vtk").exists()
    count = 3000
    rim = "".join(f"3 0 {k} {k + 1}\n" for k in range(1, count))
    (tmp_path / "fan.off").write_text(f"OFF\n{count + 1} {count - 1} 0\n" + "0 0 0\n" * (count + 1) + rim)
    command.ok("order", "fan.off", "-o", "c.off", "--elements", "fiedler")
    line = command.fails("order", "fan.off", "-o", "c.off", "--elements", "fiedler", "--limit-memory", "100M")
    assert "vertex 0 has 2999 elements, each joined to all others: " in line and "fiedler-facet" in line


def test_a_polyline_joins_consecutive_points(command, tmp_path):
    """Shuffled points of a line: each good order follows the line."""
    order = list(range(600))
    random.Random(1).shuffle(order)
    points = "".join(f"{order.index(k)} 0 0\n" for k in range(600))
    (tmp_path / "a.vtk").write_text("# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 600 float\n"
                                    + points + "CELLS 1 601\n600 " + " ".join(map(str, order)) + "\nCELL_TYPES 1\n4\n")
    spans = command.json("order", "a.vtk", "-o", "b.vtk", "--vertices", "fiedler")["edge_span"]
    assert spans["before"]["mean"] > 100 and spans["after"]["mean"] == 1


def test_pipes_end_at_the_limit(command, tmp_path):
    """A FIFO is read like a file; reading stops at the limit if it never ends."""
    pipe = tmp_path / "a.veg"
    os.mkfifo(pipe)

    def fill(text, times):
        with contextlib.suppress(BrokenPipeError), open(pipe, "w") as stream:
            for _ in range(times):
                stream.write(text)

    for times, limit in ((1, "none"), (10**6, "10M")):
        writer = threading.Thread(target=fill, args=(TETRAHEDRON if times == 1 else "# endless\n" * 100, times))
        writer.start()
        if times == 1:
            assert command.json("info", pipe, "--limit-memory", limit)["cells"] == {"tetrahedron": 1}
        else:
            assert "has no end within 10 MiB" in command.fails("info", pipe, "--limit-memory", limit)
        writer.join()


def test_includes_need_permission(command, tmp_path):
    (tmp_path / "mesh").mkdir()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "material.txt").write_text("*MATERIAL soft\nENU, 1000, 1, .4\n")
    (tmp_path / "mesh" / "a.veg").write_text(TETRAHEDRON + "*INCLUDE ../other/material.txt\n")
    line = command.fails("order", "mesh/a.veg", "-o", "b.veg")
    assert line == ("meshorder: mesh/a.veg:11: the included file '../other/material.txt' is not in the mesh's folder; put "
                    "it below the mesh's folder, or allow its own with --allow-includes-from")
    assert not (tmp_path / "b.veg").exists()
    command.ok("order", "mesh/a.veg", "-o", "b.veg", "--allow-includes-from", "mesh", "--allow-includes-from", "other")
    assert "soft" in (tmp_path / "b.veg").read_text()
    assert "--allow-includes-from: " in command.fails("info", "mesh/a.veg", "--allow-includes-from", "none")


def test_many_nested_includes_take_no_time(command, tmp_path):
    for k in range(9000):
        (tmp_path / f"f{k}.txt").write_text(f"*INCLUDE f{k + 1}.txt\n")
    (tmp_path / "a.veg").write_text(TETRAHEDRON + "*INCLUDE f0.txt\n")
    start = time.monotonic()
    assert "f15.txt:1: files are included more than 16 deep" in command.fails("info", "a.veg")
    assert time.monotonic() - start < 5


def test_hdf5_does_not_lead_elsewhere(command, tmp_path):
    """Datasets whose values are in another file, and data files outside of the mesh's folder."""
    h5py = pytest.importorskip("h5py")
    (tmp_path / "mesh").mkdir()
    secret = tmp_path / "secret"
    secret.write_bytes(bytes(72))
    with h5py.File(tmp_path / "mesh" / "a.h5", "w") as file:
        file.create_dataset("p", shape=(3, 3), dtype="f8", external=[(str(secret), 0, 72)])
        file["q"] = h5py.ExternalLink(str(tmp_path / "b.h5"), "/p")
    with h5py.File(tmp_path / "b.h5", "w") as file:
        file["p"] = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]
    def line_of(place, kind="HDF"):
        (tmp_path / "mesh" / "a.xdmf").write_text(XDMF.format(3, kind, place, ""))
        return command.fails("info", "mesh/a.xdmf")

    assert "has its values in other files" in line_of("a.h5:/p")
    assert "a link to another file; such links are not followed" in line_of("a.h5:/q")
    for place, kind in (("../b.h5:/p", "HDF"), (f"{tmp_path}/b.h5:/p", "HDF"), ("../secret", "Binary"),
                        (str(secret), "Binary")):
        assert "is not in the mesh's folder; put it below" in line_of(place, kind)
    (tmp_path / "mesh" / "a.xdmf").write_text(XDMF.format(3, "HDF", "../b.h5:/p", ""))
    command.ok("info", "mesh/a.xdmf", "--allow-includes-from", ".")


def repeated(head, unit, tail=""):
    """A file of about 400 kB."""
    return head + unit * ((400_000 - len(head)) // len(unit)) + tail


GMSH = ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
        "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n")
VIEW = '$NodeData\n1\n"u"\n1\n0\n3\n0\n1\n1\n1 0\n$EndNodeData\n'
ATTRIBUTE = '<Attribute Name="a" Center="Cell"><DataItem Dimensions="1" Format="XML">1</DataItem></Attribute>\n'
SET = '<Set Name="a" SetType="Cell"><DataItem Dimensions="1" NumberType="Int" Format="XML">0</DataItem></Set>\n'
TRIANGLE = XDMF.format(3, "XML", "0 0 0 1 0 0 0 1 0", "|").split("|")


@pytest.mark.parametrize(("name", "text"), [
    ("views.msh", repeated(GMSH, VIEW)),
    ("attributes.xdmf", repeated(TRIANGLE[0], ATTRIBUTE, TRIANGLE[1])),
    ("sets.xdmf", repeated(TRIANGLE[0], SET, TRIANGLE[1])),
    ("ranges.inp", repeated("*NODE\n" + "".join(f"{k},0,0,{k}\n" for k in range(1, 10_000))
                            + "*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n*NSET,NSET=s,GENERATE\n", "1,1000000000,1\n")),
], ids=lambda value: value if len(value) < 20 else "")
def test_repeated_names_take_linear_time(tmp_path, name, text):
    """Each of these once took a minute or more at 1 MB."""
    (tmp_path / name).write_text(text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run_within(8, tmp_path, "info", name)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 5


@pytest.mark.parametrize(("name", "sets"), [
    ("a.inp", 60_000), ("a.unv", 60_000), ("a.xdmf", 12_000), ("a.med", 12_000)])
def test_many_sets_are_written_in_linear_time(tmp_path, name, sets):
    """Each of these once took 8 to 15 s, except the last one, which took 3 GB."""
    (tmp_path / "sets.inp").write_text(
        "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n"
        + "".join(f"*NSET,NSET=set_{k}\n1\n" for k in range(sets)))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = run_within(2, tmp_path, "order", "sets.inp", "-o", name, "--vertices", "scrambled")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert done.returncode == 0, done.stderr
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 5


@pytest.mark.parametrize(("method", "count"), [("fiedler", 1_000_000), ("rcm", 1_000_000), ("spectral", 250_000),
                                               ("minla", 250_000)])
def test_a_vertex_with_very_many_neighbours(tmp_path, method, count):
    """A fan of triangles, whose hub could make the solver's coarser graphs dense."""
    rim = "".join(f"3 0 {k} {k + 1}\n" for k in range(1, count))
    points = "".join(f"{k} {k % 7} 0\n" for k in range(count + 1))
    (tmp_path / "fan.off").write_text(f"OFF\n{count + 1} {count - 1} 0\n{points}{rim}")
    done = run_within(3, tmp_path, "order", "fan.off", "-o", "b.off", "--vertices", method, "--json")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "b.off").stat().st_size > 10 * count
