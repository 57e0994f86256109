# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""OpenFOAM cases: writes a mesh as text without OpenFOAM, writes the solver's settings, and reads the files back."""
import os
import pathlib
import re
import shutil
import subprocess

import numpy
import scipy.sparse

ETC = "/usr/share/openfoam"  # where Debian's package has its settings


def header(class_name, name, location=""):
    return (f"FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {class_name};\n"
            f"    location    \"{location}\";\n    object      {name};\n}}\n\n")


def text_list(rows):
    return f"{len(rows)}\n(\n" + "".join(f"{row}\n" for row in rows) + ")\n"


def block(nx, ny, nz):
    """Points, faces, owners and neighbours of a block of boxes, whose sizes change at another rate along each axis.
    Cells are numbered with x fastest, faces in OpenFOAM's order."""
    sizes = nx, ny, nz
    axes = [numpy.linspace(0, 1, n + 1) ** (1.2 + 0.3 * a) for a, n in enumerate(sizes)]
    points = [(x, y, z) for z in axes[2] for y in axes[1] for x in axes[0]]

    def point(i, j, k):
        return i + (nx + 1) * (j + (ny + 1) * k)

    inside, outside = [], []
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                cell = i + nx * (j + ny * k)
                for axis, step in ((0, 1), (1, nx), (2, nx * ny)):
                    for side in (0, 1):
                        at, a, b = [i, j, k], [0, 0, 0], [0, 0, 0]
                        at[axis] += side
                        a[(axis + 1) % 3], b[(axis + 2) % 3] = 1, 1
                        first = numpy.array(at)
                        corners = [first, first + a, first + a + b, first + b]
                        face = [point(*c) for c in (corners if side else corners[::-1])]
                        if not 0 <= [i, j, k][axis] + (1 if side else -1) < sizes[axis]:
                            outside.append((cell, face))
                        elif side:
                            inside.append((cell, cell + step, face))
    inside.sort(key=lambda face: face[:2])
    owners = [face[0] for face in inside] + [face[0] for face in outside]
    return points, [face[-1] for face in inside + outside], owners, [face[1] for face in inside]


def write_poly_mesh(folder, mesh):
    points, faces, owners, neighbours = mesh
    folder.mkdir(parents=True, exist_ok=True)
    for name, class_name, rows in (
            ("points", "vectorField", ["({!r} {!r} {!r})".format(*map(float, p)) for p in points]),
            ("faces", "faceList", [f"{len(face)}({' '.join(map(str, face))})" for face in faces]),
            ("owner", "labelList", owners), ("neighbour", "labelList", neighbours)):
        (folder / name).write_text(header(class_name, name, "constant/polyMesh") + text_list(rows))
    patch = f"walls\n{{\n    type wall;\n    nFaces {len(owners) - len(neighbours)};\n    startFace {len(neighbours)};\n}}"
    (folder / "boundary").write_text(header("polyBoundaryMesh", "boundary") + text_list([patch]))


def shuffled(mesh, seed):
    """The mesh with its cells in a random order."""
    points, faces, owners, neighbours = mesh
    places = numpy.random.default_rng(seed).permutation(max(owners) + 1)
    inside = []
    for face, a, b in zip(faces, places[owners], places[neighbours]):
        inside.append((min(a, b), max(a, b), face if a < b else face[::-1]))
    inside.sort(key=lambda face: face[:2])
    rest = [(places[cell], face) for cell, face in zip(owners[len(inside):], faces[len(inside):])]
    return (points, [face[-1] for face in inside] + [face for _, face in rest],
            [face[0] for face in inside] + [cell for cell, _ in rest], [face[1] for face in inside])


def write_case(folder, mesh):
    write_poly_mesh(folder / "constant" / "polyMesh", mesh)
    (folder / "system").mkdir(exist_ok=True)
    return folder


# ---- what is read back


def body(path):
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", path.read_text(), flags=re.S)
    return text[text.index("}", text.index("FoamFile")) + 1:]


def read_labels(path):
    count, rows = re.fullmatch(r"\s*(\d+)\s*\(([\d\s]*)\)\s*", body(path)).groups()
    labels = numpy.array(rows.split(), dtype=int)
    assert len(labels) == int(count)
    return labels


def graph(poly_mesh):
    """The matrix of the graph of cells."""
    owners, neighbours = read_labels(poly_mesh / "owner"), read_labels(poly_mesh / "neighbour")
    n = max(owners.max(), neighbours.max()) + 1
    entries = numpy.ones(len(neighbours))
    half = scipy.sparse.coo_matrix((entries, (owners[:len(neighbours)], neighbours)), shape=(n, n))
    return (half + half.T).tocsr()


def figures(matrix):
    """The bandwidth, the profile and the mean span of a matrix."""
    rows, columns = matrix.nonzero()
    spans = rows - columns
    profile = numpy.zeros(matrix.shape[0], dtype=int)
    numpy.maximum.at(profile, rows, spans)
    return spans.max(), profile.sum(), spans[spans > 0].mean()


def centres(poly_mesh):
    """The mean of the centres of each cell's faces."""
    numbers = [[float(x) for x in row.split()] for row in re.findall(r"\(([^()]+)\)", body(poly_mesh / "points"))]
    points = numpy.array(numbers)
    faces = [points[[int(p) for p in row.split()]].mean(axis=0)
             for row in re.findall(r"\(([^()]+)\)", body(poly_mesh / "faces"))]
    owners, neighbours = read_labels(poly_mesh / "owner"), read_labels(poly_mesh / "neighbour")
    cells = numpy.concatenate([owners, neighbours])
    faces = numpy.array(faces + faces[:len(neighbours)])
    sums = numpy.zeros((cells.max() + 1, 3))
    numpy.add.at(sums, cells, faces)
    return sums / numpy.bincount(cells)[:, None]


def read_field(path):
    """The values of a field on cells, a row each."""
    values = re.search(r"internalField\s+nonuniform\s+List<\w+>\s+\d+\s*\((.*?)\)\s*;", body(path), re.S)[1]
    return numpy.array(values.replace("(", " ").replace(")", " ").split(), dtype=float)


# ---- OpenFOAM itself


def has_openfoam():
    return shutil.which("renumberMesh") is not None


def openfoam(program, case, *arguments, before=()):
    """Runs a program of OpenFOAM; returns what it prints."""
    environment = {"WM_PROJECT_DIR": ETC, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    done = subprocess.run([*before, program, "-case", str(case), *arguments], capture_output=True, text=True,
                          timeout=500, check=False, stdin=subprocess.DEVNULL, env={**environment, **os.environ})
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def write_settings(case, region="", **entries):
    """Writes the dictionaries of a flow that a moving lid drives; `entries` replaces some of them. All are texts."""
    known = {
        "controlDict": "application icoFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 0.04; "
                       "deltaT 0.01; writeControl timeStep; writeInterval 4; writeFormat ascii; writePrecision 15; "
                       "timeFormat general;",
        "fvSchemes": "ddtSchemes { default Euler; } gradSchemes { default Gauss linear; } "
                     "divSchemes { default none; div(phi,U) Gauss linear; } "
                     "laplacianSchemes { default Gauss linear orthogonal; } "
                     "interpolationSchemes { default linear; } snGradSchemes { default orthogonal; }",
        "fvSolution": "solvers { p { solver PCG; preconditioner DIC; tolerance 1e-11; relTol 0; } pFinal { $p; } "
                      "U { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-11; relTol 0; } } "
                      "PISO { nCorrectors 2; pRefPoint (0.01 0.01 0.01); pRefValue 0; }",
        **entries,
    }
    files = {f"system/{name}": text for name, text in known.items()}
    if region:
        files |= {f"system/{region}/{name}": text for name, text in known.items()}
    files["constant/transportProperties"] = "nu 0.01;"
    for name, text in files.items():
        path = case / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(header("dictionary", path.name) + text + "\n")


def block_mesh(case, cells, grading="1 1 1", region=""):
    """Makes the mesh of a box with blockMesh, and the patches lid and walls."""
    path = case / "system" / region / "blockMeshDict"
    path.write_text(
        header("dictionary", "blockMeshDict") +
        "vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1));\n"
        f"blocks (hex (0 1 2 3 4 5 6 7) ({cells}) simpleGrading ({grading})); edges ();\n"
        "boundary (lid { type wall; faces ((3 7 6 2)); } walls { type wall; faces "
        "((0 4 7 3) (2 6 5 1) (1 5 4 0) (0 3 2 1) (4 5 6 7)); }); mergePatchPairs ();\n")
    openfoam("blockMesh", case, *(["-region", region] if region else []))


def write_fields(case, region=""):
    """Writes a fluid at rest below its lid."""
    fields = {"p": ("volScalarField", "[0 2 -2 0 0 0 0]", "uniform 0", "type zeroGradient;", "type zeroGradient;"),
              "U": ("volVectorField", "[0 1 -1 0 0 0 0]", "uniform (0 0 0)", "type fixedValue; value uniform (1 0 0);",
                    "type noSlip;")}
    for name, field in fields.items():
        write_field(case / "0" / region / name, *field)


def write_field(path, class_name, dimensions, values, lid, walls):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(header(class_name, path.name) + f"dimensions {dimensions};\ninternalField {values};\n"
                    f"boundaryField\n{{\nlid {{ {lid} }}\nwalls {{ {walls} }}\n\"proc.*\" {{ type processor; }}\n}}\n")


def write_cavity(case, cells="5 4 3", grading="2 3 1", region=""):
    """A box of fluid whose lid moves, and a field with the number of each cell; its mesh is made by blockMesh."""
    write_settings(case, region)
    block_mesh(case, cells, grading, region)
    write_fields(case, region)
    count = numpy.prod([int(n) for n in cells.split()])
    write_field(case / "0" / region / "number", "volScalarField", "[0 0 0 0 0 0 0]",
                "nonuniform List<scalar> " + text_list(range(count)), "type zeroGradient;", "type zeroGradient;")
    return case


def printed_figures(log):
    """The bands and profiles that renumberMesh prints, before and after."""
    return [tuple(float(x) for x in pair) for pair in re.findall(r"band\s*: (\S+)\s*profile\s*: (\S+)", log)]


def folder_files(folder):
    return {str(path.relative_to(folder)) for path in pathlib.Path(folder).rglob("*") if path.is_file()}
