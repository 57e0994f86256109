# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The memory that the command uses for files that claim more data than they hold, and the limit in docs/limits.md."""
import gzip
import os
import struct
import zlib

import pytest
from test_memory import peak_and_status

pytestmark = pytest.mark.skipif("ASAN_OPTIONS" in os.environ, reason="sanitizers take memory of their own")

MEBIBYTE = 1 << 20
BASE = 96 * MEBIBYTE  # the program, its libraries and their buffers
SMALL = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n"
NODES = "*NODE\n" + "".join(f"{k},{k},0,0\n" for k in range(1, 4001)) + "*ELEMENT,TYPE=T3D2\n1,1,2\n"
GRIDS = "BEGIN BULK\n" + "".join(f"GRID,{k}\n" for k in range(1, 4001)) + "CROD,1,1,1,2\n"
VTU = ('<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"{}>'
       '<UnstructuredGrid><Piece NumberOfPoints="{}" NumberOfCells="{}">{}<Points>{}</Points><Cells>{}</Cells></Piece>'
       '</UnstructuredGrid>{}</VTKFile>')


def array(kind, name, text, components=1):
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">{text}</DataArray>')


def one_cell(vtk_type, count):
    """A VTU file of one cell of `count` vertices."""
    cells = (array("Int32", "connectivity", " ".join(map(str, range(count)))) + array("Int32", "offsets", count)
             + array("UInt8", "types", vtk_type))
    return VTU.format("", count, 1, "", array("Float32", "p", "0 1 0 " * count, 3), cells, "").encode()


def compressed_arrays():
    """Points and 30 data arrays that share one compressed block, of 48 MiB of zeros."""
    size = 48 * MEBIBYTE
    packed = zlib.compress(bytes(size), 9)
    block = struct.pack("<4Q", 1, size, 0, len(packed)) + packed
    data = "".join(f'<DataArray type="Float32" Name="u{k}" NumberOfComponents="3" format="appended" offset="0"/>'
                   for k in range(30))
    cells = array("Int32", "connectivity", "0 1 2") + array("Int32", "offsets", 3) + array("UInt8", "types", 5)
    points = '<DataArray type="Float32" NumberOfComponents="3" format="appended" offset="0"/>'
    head, tail = VTU.format(' compressor="vtkZLibDataCompressor"', size // 12, 1, f"<PointData>{data}</PointData>", points,
                            cells, "|").split("|")
    return head.encode() + b'<AppendedData encoding="raw">_' + block + b"</AppendedData>" + tail.encode()


FILES = {
    "blanks.off.gz": lambda: gzip.compress(b"OFF\n" + b" " * (400 * MEBIBYTE), 9),
    "members.msh.gz": lambda: gzip.compress(bytes(256 * MEBIBYTE), 9) * 3,
    "points.off.gz": lambda: gzip.compress(b"OFF\n20000000 1 0\n" + b"0 0 0\n" * 20_000_000 + b"3 0 1 2\n", 9),
    "points.obj.gz": lambda: gzip.compress(b"v 0 0 0\n" * 20_000_000 + b"f 1 2 3\n", 9),
    "blanks.vtk.gz": lambda: gzip.compress(b"# vtk DataFile Version 3.0\n" + b"\n" * (300 * MEBIBYTE), 9),
    "blanks.inp.gz": lambda: gzip.compress(b"*NODE\n" + b"**\n" * (100 * MEBIBYTE), 9),
    "empty-lines.graph.gz": lambda: gzip.compress(b"20000000 1\n2\n1\n" + b"\n" * 20_000_000, 9),
    "empty-lines.mtx.gz": lambda: gzip.compress(
        b"%%MatrixMarket matrix coordinate pattern symmetric\n20000000 20000000 1\n2 1\n" + b"\n" * 20_000_000, 9),
    "arrays.vtu": compressed_arrays,
    "one-set.inp": lambda: (NODES + "*NSET,NSET=N,GENERATE\n" + "1,4000,1\n" * 4000).encode(),
    "sets.inp": lambda: (NODES + "".join(f"*NSET,NSET=N{k},GENERATE\n1,4000,1\n" for k in range(9000))).encode(),
    "set-of-sets.inp": lambda: (NODES + "*NSET,NSET=A,GENERATE\n1,4000\n*NSET,NSET=B\n" + "A\n" * 3000).encode(),
    "lists.bdf": lambda: (GRIDS + "".join(f"SET1,{k},1,THRU,4000\n" for k in range(1, 9000)) + "ENDDATA\n").encode(),
    "points.bdf": lambda: (GRIDS + "".join(f"SPOINT,{k}000000,THRU,{k}999999\n" for k in range(1, 50))
                           + "ENDDATA\n").encode(),
    "polygon.off": lambda: b"OFF\n20000 1 0\n" + b"0 1 0\n" * 20_000 + b"20000 " + b" ".join(
        b"%d" % k for k in range(20_000)) + b"\n",
    "polyline.vtu": lambda: one_cell(4, 20_000),
    "strip.vtu": lambda: one_cell(6, 20_000),
    "cloud.vtu": lambda: one_cell(2, 20_000),
    "wide-line.vtu": lambda: one_cell(68, 20_000),
    "wide-hexahedron.vtu": lambda: one_cell(72, 4_000),
}


def check(folder, name):
    """Runs two commands on a file and returns their statuses; fails if one uses more memory than the limit."""
    limit = 256 * MEBIBYTE + 100 * sum(path.stat().st_size for path in folder.iterdir())
    statuses = []
    for arguments in (("info", name, "-q"), ("order", name, "-o", "out.vtu", "--vertices", "hilbert", "-q")):
        status, most, error = peak_and_status(folder, *arguments)
        assert status in (0, 2), error
        assert most < limit + BASE, f"{arguments}: {most / MEBIBYTE:.0f} MiB, the limit is {limit / MEBIBYTE:.0f}"
        statuses.append(status)
    return statuses


@pytest.mark.parametrize("name", FILES)
def test_what_a_file_claims_stays_within_the_limit(tmp_path, name):
    (tmp_path / name).write_bytes(FILES[name]())
    statuses = check(tmp_path, name)
    if name in ("one-set.inp", "set-of-sets.inp", "polygon.off", "polyline.vtu", "strip.vtu", "cloud.vtu"):
        assert statuses == [0, 0]  # the limit suffices for these


@pytest.mark.parametrize("extension", ["vtkhdf", "med", "cgns", "xdmf"])
def test_chunks_of_hdf5(command, tmp_path, extension):
    """Each dataset of a small mesh becomes part of a chunk of half a gigabyte."""
    h5py = pytest.importorskip("h5py")
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.off").write_text(SMALL)
    command.ok("order", "in/a.off", "-o", f"a.{extension}")
    (tmp_path / "in" / "a.off").unlink()
    (tmp_path / "in").rmdir()
    with h5py.File(tmp_path / ("a.h5" if extension == "xdmf" else f"a.{extension}"), "r+") as file:
        largest = max((item for item in datasets(file) if item.dtype.kind == "f"), key=lambda item: item.size)
        place, values, attributes = largest.name, largest[...], dict(largest.attrs)
        del file[place]
        chunk = ((1 << 26) // max(1, values[0].size), *values.shape[1:])
        new = file.create_dataset(place, data=values, maxshape=(None, *values.shape[1:]), chunks=chunk, compression=9)
        new.attrs.update(attributes)
    assert check(tmp_path, f"a.{extension}") == [2, 2]


def datasets(group):
    for item in group.values():
        yield from datasets(item) if hasattr(item, "values") else (item,)


def test_chunks_of_netcdf(tmp_path):
    netcdf = pytest.importorskip("netCDF4")
    with netcdf.Dataset(tmp_path / "a.exo", "w") as file:
        for name, length in (("num_dim", 3), ("num_el_blk", 1), ("num_elem", 1), ("num_el_in_blk1", 1),
                             ("num_nod_per_el1", 3), ("num_nodes", None)):
            file.createDimension(name, length)
        connect = file.createVariable("connect1", "i4", ("num_el_in_blk1", "num_nod_per_el1"))
        connect.elem_type = "TRI3"
        connect[...] = [[1, 2, 3]]
        chunk = (3, (1 << 26) // 3)
        coordinates = file.createVariable("coord", "f8", ("num_dim", "num_nodes"), zlib=True, complevel=9, chunksizes=chunk)
        coordinates[...] = [[0, 1, 0], [0, 0, 1], [0, 0, 0]]
    assert check(tmp_path, "a.exo") == [2, 2]
