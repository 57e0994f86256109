# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The time to read a file grows linearly with the number of items that may repeat in it.

Four times as many items take about four times as long; a search among all others for each would take sixteen times. The
bound lies between. Times are processor times, less the time for a file with few items.
"""
import resource
import subprocess

import pytest

from conftest import MESHORDER

TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]


def lines(n, row):
    return "".join(row(k) for k in range(n))


def msh2(more, groups=""):
    return ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + groups + "$Nodes\n4\n"
            + lines(4, lambda k: "%d %d %d %d\n" % (k + 1, *TETRAHEDRON[k]))
            + "$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n" + more)


def vtk(more):
    return ("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n"
            "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n" + more)


def vtu(point_data="", cell_data="", field_data=""):
    array = '<DataArray type="{}" Name="{}" {} format="ascii">{}</DataArray>'
    return ('<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>'
            f'<FieldData>{field_data}</FieldData><Piece NumberOfPoints="4" NumberOfCells="1">'
            f"<PointData>{point_data}</PointData><CellData>{cell_data}</CellData><Points>"
            + array.format("Float64", "Points", 'NumberOfComponents="3"', "0 0 0 1 0 0 0 1 0 0 0 1")
            + "</Points><Cells>" + array.format("Int64", "connectivity", "", "0 1 2 3")
            + array.format("Int64", "offsets", "", "4") + array.format("UInt8", "types", "", "10")
            + "</Cells></Piece></UnstructuredGrid></VTKFile>")


def vega(more):
    return ("*VERTICES\n4 3 0 0\n" + lines(4, lambda k: "%d %d %d %d\n" % (k + 1, *TETRAHEDRON[k]))
            + "*ELEMENTS\nTET\n1 4 0\n1 1 2 3 4\n" + more)


def inp(more, before=""):
    return (before + "*NODE\n" + lines(4, lambda k: "%d,%d,%d,%d\n" % (k + 1, *TETRAHEDRON[k]))
            + "*ELEMENT,TYPE=C3D4,ELSET=E\n1,1,2,3,4\n" + more)


def bdf(more):
    return ("CEND\nBEGIN BULK\n" + lines(4, lambda k: "GRID,%d,,%d.,%d.,%d.\n" % (k + 1, *TETRAHEDRON[k]))
            + "CTETRA,1,1,1,2,3,4\nPSOLID,1,1\n" + more + "ENDDATA\n")


def ply(header="", vertex="", vertex_row="", more="", rows=""):
    return ("ply\nformat ascii 1.0\n" + header + "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            + vertex + "element face 1\nproperty list uchar int vertex_indices\n" + more + "end_header\n"
            + lines(3, lambda k: "%d %d 0%s\n" % (k, k * k, vertex_row)) + "3 0 1 2\n" + rows)


def obj(row):
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + row + "f 1 2 3\n"


def unv(more):
    block = "    -1\n%6d\n%s    -1\n"
    nodes = lines(4, lambda k: "%10d%10d%10d%10d\n%25.16E%25.16E%25.16E\n" % (k + 1, 1, 1, 11, *TETRAHEDRON[k]))
    return block % (2411, nodes) + block % (2412, "%10d%10d%10d%10d%10d%10d\n" % (1, 111, 1, 1, 7, 4)
                                            + "%10d%10d%10d%10d\n" % (1, 2, 3, 4)) + more


def unv_group(k):
    return "%10d" % (k + 1) + "%10d" * 6 % (0, 0, 0, 0, 0, 0) + "%10d\nG%d\n" % (1, k) + "%10d" * 4 % (7, 1, 0, 0) + "\n"


def su2(more):
    return "NDIME= 2\nNELEM= 1\n5 0 1 2 0\nNPOIN= 3\n0 0 0\n1 0 1\n0 1 2\n" + more


def medit(more):
    return ("MeshVersionFormatted 2\nDimension 3\nVertices\n4\n" + lines(4, lambda k: "%d %d %d 0\n" % TETRAHEDRON[k])
            + "Tetrahedra\n1\n1 2 3 4 0\n" + more + "End\n")


def xdmf(more):
    return ('<Xdmf Version="3.0"><Domain><Grid><Topology TopologyType="Tetrahedron" NumberOfElements="1">'
            '<DataItem Dimensions="1 4" NumberType="Int" Format="XML">0 1 2 3</DataItem></Topology><Geometry>'
            '<DataItem Dimensions="4 3" NumberType="Float" Format="XML">0 0 0 1 0 0 0 1 0 0 0 1</DataItem></Geometry>'
            + more + "</Grid></Domain></Xdmf>")


ARRAY = '<DataArray type="Int32" Name="a%d" format="ascii">%s</DataArray>'
ITEM = '<DataItem Dimensions="%d" NumberType="Int" Format="XML">%s</DataItem>'

#: by extension and repeated item: the number of repetitions, and the file with n of them
REPEATED = {
    "msh data of one name": (4000, lambda n: msh2(
        '$NodeData\n1\n"v"\n1\n0\n3\n0\n1\n1\n1 1\n$EndNodeData\n' * n)),
    "msh data of many names": (4000, lambda n: msh2(lines(n, lambda k: (
        f'$NodeData\n1\n"v{k}"\n1\n0\n3\n0\n1\n1\n1 1\n$EndNodeData\n')))),
    "msh physical names": (10000, lambda n: msh2(
        "", f"$PhysicalNames\n{n}\n" + lines(n, lambda k: f'3 {k + 1} "g{k}"\n') + "$EndPhysicalNames\n")),
    "msh sections of others": (10000, lambda n: msh2(lines(n, lambda k: f"$Own{k}\n1\n$EndOwn{k}\n"))),
    "vtk scalars": (4000, lambda n: vtk("POINT_DATA 4\n" + lines(
        n, lambda k: f"SCALARS a{k} int 1\nLOOKUP_TABLE default\n0 0 0 0\n"))),
    "vtk scalars of one name": (4000, lambda n: vtk(
        "POINT_DATA 4\n" + "SCALARS a int 1\nLOOKUP_TABLE default\n0 0 0 0\n" * n)),
    "vtk fields of cells": (4000, lambda n: vtk(f"CELL_DATA 1\nFIELD f {n}\n" + lines(n, lambda k: f"a{k} 1 1 int\n7\n"))),
    "vtk fields": (4000, lambda n: vtk("POINT_DATA 4\n" + lines(n, lambda k: f"FIELD f{k} 1\na{k} 1 4 int\n7 7 7 7\n"))),
    "vtk tables": (4000, lambda n: vtk("POINT_DATA 4\n" + lines(
        n, lambda k: f"LOOKUP_TABLE t{k} 1\n0 0 0 1\n"))),
    "vtu arrays": (4000, lambda n: vtu(lines(n, lambda k: ARRAY % (k, "0 0 0 0")))),
    "vtu arrays of cells": (4000, lambda n: vtu("", lines(n, lambda k: ARRAY % (k, "0")))),
    "vtu field data": (4000, lambda n: vtu("", "", lines(n, lambda k: (ARRAY % (k, "0")).replace(
        " format", ' NumberOfTuples="1" format')))),
    "veg sets": (5000, lambda n: vega(lines(n, lambda k: f"*SET s{k}\n1,\n"))),
    "veg regions": (5000, lambda n: vega(
        "*SET s\n1\n*MATERIAL m\nENU, 1, 1, 0.1\n" + "*REGION\ns, m\n" * n)),
    "veg regions of a large set": (3000, lambda n: vega(
        "*SET s\n" + "1," * n + "\n*MATERIAL m\nENU, 1, 1, 0.1\n" + "*REGION\ns, m\n" * n)),
    "veg regions of many sets": (5000, lambda n: vega(
        lines(n, lambda k: f"*SET s{k}\n1\n") + lines(n, lambda k: f"*MATERIAL m{k}\nENU, 1, 1, 0.1\n")
        + lines(n, lambda k: f"*REGION\ns{k}, m{k}\n"))),
    "inp sets of nodes": (5000, lambda n: inp(lines(n, lambda k: f"*NSET,NSET=N{k}\n1,2\n"))),
    "inp sets of one name": (5000, lambda n: inp("*NSET,NSET=N\n1,2\n" * n)),
    "inp sets of elements": (5000, lambda n: inp(lines(n, lambda k: f"*ELSET,ELSET=E{k}\n1\n"))),
    "inp sets of sets": (2500, lambda n: inp("*NSET,NSET=N0\n1,2\n" + lines(n, lambda k: f"*NSET,NSET=N{k + 1}\nN{k}\n"))),
    "inp blocks of elements": (5000, lambda n: inp(lines(n, lambda k: f"*ELEMENT,TYPE=C3D4,ELSET=B{k}\n{k + 2},1,2,3,4\n"))),
    "inp blocks of nodes": (5000, lambda n: inp(lines(n, lambda k: f"*NODE,NSET=B{k}\n{k + 5},1,2,{k}\n"))),
    "inp cards": (10000, lambda n: inp(lines(n, lambda k: f"*MATERIAL,NAME=M{k}\n*ELASTIC\n1.,.3\n"))),
    "inp surfaces": (4000, lambda n: inp(lines(n, lambda k: f"*SURFACE,NAME=S{k}\n1,S1\n"))),
    "inp steps": (4000, lambda n: inp("*STEP\n*STATIC\n*CLOAD\n1,1,1.\n*END STEP\n" * n)),
    "bdf sets": (5000, lambda n: bdf(lines(n, lambda k: f"SPC1,{k + 1},123,1,2\n"))),
    "bdf properties": (5000, lambda n: bdf(lines(n, lambda k: f"PSOLID,{k + 2},1\n"))),
    "bdf systems": (2500, lambda n: bdf(lines(
        n, lambda k: f"CORD2R,{k + 1},{k},0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"))),
    "bdf points of systems": (2500, lambda n: bdf(lines(
        n, lambda k: f"CORD2R,{k + 1},{k},0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,{k + 9},{k + 1},{k}.,1.,2.\n"))),
    "unv groups": (5000, lambda n: unv("    -1\n  2467\n" + lines(n, unv_group) + "    -1\n")),
    "unv datasets": (5000, lambda n: unv("    -1\n  9999\n    1\n    -1\n" * n)),
    "su2 markers": (5000, lambda n: su2(f"NMARK= {n}\n" + lines(
        n, lambda k: f"MARKER_TAG= m{k}\nMARKER_ELEMS= 1\n3 {k % 3} {(k + 1) % 3}\n"))),
    "mesh sections": (10000, lambda n: medit("Corners\n1\n1\n" * n)),
    "obj groups": (5000, lambda n: obj(lines(n, lambda k: f"g g{k}\nf 1 2 3\n"))),
    "obj materials": (5000, lambda n: obj(lines(n, lambda k: f"usemtl m{k}\nf 1 2 3\n"))),
    "obj libraries": (10000, lambda n: obj(lines(n, lambda k: f"mtllib m{k}.mtl\n"))),
    "ply properties": (4000, lambda n: ply("", lines(n, lambda k: f"property int p{k}\n"), " 0" * n)),
    "ply elements": (4000, lambda n: ply(more=lines(n, lambda k: f"element e{k} 1\nproperty float x{k}\n"), rows="0\n" * n)),
    "ply comments": (10000, lambda n: ply(lines(n, lambda k: f"comment c{k}\n"))),
    "stl solids": (4000, lambda n: lines(n, lambda k: (
        f"solid s{k}\nfacet normal 0 0 1\nouter loop\nvertex {k} 0 0\nvertex {k} 1 0\nvertex {k} 0 1\nendloop\nendfacet\n"
        f"endsolid s{k}\n"))),
    "mtx comments": (10000, lambda n: ("%%MatrixMarket matrix coordinate pattern symmetric\n" + "%c\n" * n
                                       + "3 3 2\n2 1\n3 2\n")),
    "graph comments": (10000, lambda n: "%c\n" * n + "3 2\n2\n1 3\n2\n"),
    "xdmf attributes": (2500, lambda n: xdmf(lines(
        n, lambda k: f'<Attribute Name="a{k}" Center="Node">' + ITEM % (4, "0 0 0 0") + "</Attribute>"))),
    "xdmf sets": (2500, lambda n: xdmf(lines(
        n, lambda k: f'<Set Name="s{k}" SetType="Cell">' + ITEM % (1, "0") + "</Set>"))),
    "xdmf information": (5000, lambda n: xdmf(lines(n, lambda k: f'<Information Name="i{k}" Value="1"/>'))),
}  # fmt: skip


def seconds(command, *arguments):
    """The processor time of a command, even if it refuses the file."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([MESHORDER, *arguments, "-q", "--threads", "1"], cwd=command.folder, capture_output=True,
                   stdin=subprocess.DEVNULL, check=False, timeout=300)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


@pytest.mark.parametrize("what", REPEATED)
def test_time_grows_with_the_number(command, tmp_path, what):
    kind = what.split()[0]
    n, text = REPEATED[what]
    for name, count in (("few", 8), ("some", n), ("many", 4 * n)):
        (tmp_path / f"{name}.{kind}").write_text(text(count))
    for arguments in (["info"], ["order", "--vertices", "scrambled", "-o", f"out.{kind}"]):
        least, some, many = (
            min(seconds(command, arguments[0], f"{name}.{kind}", *arguments[1:]) for _ in range(2))
            for name in ("few", "some", "many")
        )
        assert many - least <= 9 * max(some - least, 0.04), (arguments[0], least, some, many)
