# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Texts as other programs and editors leave them: each is read like the plain text, or refused for its true reason."""
import pytest

BANNER = "%%MatrixMarket matrix coordinate real general\n"
UNV = """    -1
  2411
         1         1         1        11
   0.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00
         2         1         1        11
   1.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00
         3         1         1        11
   0.0000000000000000D+00   1.0000000000000000D+00   0.0000000000000000D+00
    -1
    -1
  2412
         1        91         1         1         7         3
         1         2         3
    -1
"""
VTU = """<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="1">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
"""
#: a triangle, or a matrix of two rows, in each format of text
PLAIN = {
    "obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1 2 3\n",
    "off": "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "ply": "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "stl": "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
           "endsolid a\n",
    "msh": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
           "$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n",
    "mesh": "MeshVersionFormatted 2\nDimension 3\nVertices\n3\n0 0 0 0\n1 0 0 0\n0 1 0 0\nTriangles\n1\n1 2 3 1\nEnd\n",
    "su2": "NDIME= 2\nNELEM= 1\n5 0 1 2 0\nNPOIN= 3\n0 0 0\n1 0 1\n0 1 2\nNMARK= 0\n",
    "inp": "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,0.,1.,0.\n*ELEMENT,TYPE=S3\n1,1,2,3\n",
    "avs": "3 1 0 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 1 tri 1 2 3\n",
    "bdf": "CEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nCTRIA3,1,1,1,2,3\nENDDATA\n",
    "unv": UNV,
    "vtk": "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n"
           "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n",
    "vtu": VTU,
    "veg": "*VERTICES\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n*ELEMENTS\nTET\n1 4 0\n1 1 2 3 4\n",
    "mtx": BANNER + "2 2 2\n1 1 3\n2 1 1\n",
    "graph": "3 2\n2\n1 3\n2\n",
}
#: what an editor, a transfer or an old system makes of any text
OF_ALL = {
    "carriage returns": lambda text: text.replace("\n", "\r"),
    "zero bytes": lambda text: text.replace("\n", "\r\n") + "\0\0\0",
    "ctrl-z": lambda text: text + "\x1a",
    "byte order mark": lambda text: "\ufeff" + text,
    "blank lines at the end": lambda text: text + "\n \n",
}
#: the extension, what is replaced in the plain text, and what replaces it
READ = [
    ("obj", "f 1 2 3", "f 1// 2// 3//"), ("obj", "f 1 2 3", "f -3/ +2// -1"),
    ("off", "OFF\n3 1 0", "OFF +3 +1 +0"), ("ply", "vertex 3", "vertex +3"), ("stl", "solid a", "\n \nSOLID"),
    ("msh", "$MeshFormat", "\n\n$MeshFormat"), ("msh", "$Nodes", "\f$Nodes"), ("msh", "1 2 3\n$", "+1 +2 +3\n$"),
    ("mesh", "1 2 3 1", "+1 +2 +3 +1"), ("su2", "NPOIN= 3", "NPOIN = +3"), ("inp", "2,1.", "+2, +1.D0"),
    ("bdf", "GRID,2,,1.", "GRID,+2,,+1.-0"), ("bdf", "GRID,1,,0.,0.,0.", "GRID\t1\t\t0.\t0.\t0."),
    ("avs", "tri 1", "tri +1"), ("veg", "1 1 2", "+1 +1 2"), ("vtk", "POINTS 3", "POINTS +3"),
    ("unv", "         2         1         1        11\n", "        +2         1         11234567890  a comment\n"),
    ("unv", "    -1\n    -1\n", "    -1\nmade by hand\n\f\n    -1\n"), ("unv", "D+00", "d+00"),
    ("vtu", 'Points="3"', "Points='\t +3\n'"), ("vtu", "<VTKFile", "\n\n<!-- made by hand -->\n<VTKFile"),
    ("mtx", BANNER, BANNER.upper()), ("mtx", "2 2 2\n1 1 3", "+2 +2 +2\n+1 +1 +3D0"), ("graph", "3 2\n", "% a comment\n+3 +2\n"),
]
REFUSED = [
    ("obj", "f 1 2 3", "", "has no cells"), ("obj", "f 1 2 3", "f 1//1 2//1 3", ":5: corners of one cell have different"),
    ("obj", "f 1 2 3", "f 1 2", ":5: a face has 2 corners; it needs 3 or more, and a line is written as 'l 1 2'"),
    ("obj", "f 1 2 3", "f 1.0 2.0 3.0", ":5: a number of v is '1.0'; a whole number is needed"),
    ("vtu", 'Points="3"', 'Points="0x3"', ":2: NumberOfPoints is '0x3'; a whole number"),
    ("vtu", 'Points="3"', 'Points="+-3"', ":2: NumberOfPoints is '+-3'; a whole number"),
    ("unv", "         1        11\n", "         1**********\n", ":3: a field of the node is '**********'; a whole number"),
    ("unv", "    -1\n    -1\n", "    -1\n", ":10: expected a line of -1, which begins a dataset, found '2412'"),
    ("mtx", "1 1 3", "1 1 0x3", ":3: a value is '0x3'; a number is needed"),
    ("mtx", "2 2 2\n", "2 2\n2\n", ":2: the line of sizes has 2 numbers; three are needed"),
    ("inp", PLAIN["inp"], PLAIN["bdf"], "looks like Nastran, not like Abaqus; name it .bdf"),
    ("vtk", PLAIN["vtk"], VTU, "looks like VTU, not like VTK; name it .vtu"),
    ("msh", "1 0 0 0\n", "1 0 \0 0\n", ":6: a coordinate is '?'"),
]


@pytest.fixture
def ordered(command, tmp_path):
    """Orders a text and returns the bytes of the output in a format that keeps no text."""

    def order(extension, text):
        (tmp_path / f"a.{extension}").write_bytes(text.encode())
        out = "b.mtx" if extension in ("mtx", "graph", "metis") else "b.vtu"
        command.ok("order", f"a.{extension}", "-o", out)
        return (tmp_path / out).read_bytes()

    return order


@pytest.mark.parametrize("extension", PLAIN)
def test_any_text_may_be_changed_by_editors_and_transfers(ordered, extension):
    plain = ordered(extension, PLAIN[extension])
    for name, change in OF_ALL.items():
        assert ordered(extension, change(PLAIN[extension])) == plain, name


def test_metis_is_an_extension_of_its_graphs(ordered):
    assert ordered("graph", PLAIN["graph"]) == ordered("metis", PLAIN["graph"])


@pytest.mark.parametrize("extension, old, new", READ)
def test_odd_texts_are_read(ordered, extension, old, new):
    assert old in PLAIN[extension]
    assert ordered(extension, PLAIN[extension].replace(old, new, 1)) == ordered(extension, PLAIN[extension])


@pytest.mark.parametrize("extension, old, new, words", REFUSED)
def test_faults_are_named_truly(command, tmp_path, extension, old, new, words):
    assert old in PLAIN[extension]
    (tmp_path / f"a.{extension}").write_bytes(PLAIN[extension].replace(old, new, 1).encode())
    assert words in command.fails("order", f"a.{extension}", "-o", "b.vtu")
    assert not (tmp_path / "b.vtu").exists()
