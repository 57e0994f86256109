# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Command lines for runs with faults: every subcommand, and every format read and written in place."""
import dataclasses
import itertools
import json
import subprocess
import sys
import typing

import interposed

sys.path.insert(0, str(interposed.ROOT / "tests" / "command"))
import foam_cases  # noqa: E402



@dataclasses.dataclass
class Line:
    """A command line."""

    arguments: tuple
    before: typing.Callable  # makes the input files in a folder
    varies: tuple = ()  # outputs that contain times; they need only exist
    together: bool = True  # its outputs are to be all old or all new
    reader: tuple = ()  # the arguments of a command that reads the output; it may write read.msh
    most: int = 10000  # limit of faults of a kind, for runs of seconds


SCRAMBLED = ("--vertices", "scrambled", "--elements", "scrambled", "--seed", 3)
SOLIDS = ("node", "veg", "msh", "mesh", "vtu", "vtk", "su2", "inp", "bdf", "unv", "exo", "xdmf", "cgns", "med", "vtkhdf")
SURFACES = ("off", "obj", "ply", "stl")
SCENARIO = {
    "name": "small", "title": "A small cube falls", "mesh": "mesh.node", "scale": {"longest_side": 2},
    "material": {"model": "corotational", "young": 1e5, "poisson": 0.4, "density": 1000},
    "integrator": {"time_step": 0.02, "rayleigh": {"alpha": 0.5}, "gravity": [0, -9.81, 0]},
    "solver": {"tolerance": 1e-10}, "fixed": [{"on": {"box": [[0, 0, 0], [0, 1, 1]]}}], "steps": 2,
}


def write_cube(folder, n=2):
    """mesh.node and mesh.ele: n³ cubes cut into six tetrahedra each, with attributes and regions."""
    def vertex(at):
        return at[0] + (n + 1) * (at[1] + (n + 1) * at[2])

    places = list(itertools.product(range(n + 1), repeat=3))
    cells = []
    for corner in itertools.product(range(n), repeat=3):
        for axes in itertools.permutations(range(3)):
            at, cell = list(corner), [vertex(corner)]
            for axis in axes:
                at[axis] += 1
                cell.append(vertex(at))
            cells.append(cell)
    nodes = [f"{vertex(at)} {at[0] / n} {at[1] / n} {at[2] / n} {sum(at) / 2} {at[0] + 1}" for at in sorted(places, key=vertex)]
    (folder / "mesh.node").write_text("\n".join([f"{len(nodes)} 3 1 1", *nodes, ""]))
    rows = [f"{i} {' '.join(map(str, cell))} {1 + i % 2}" for i, cell in enumerate(cells)]
    (folder / "mesh.ele").write_text("\n".join([f"{len(cells)} 4 1", *rows, ""]))


def write_surface(folder):
    """mesh.off: an octahedron."""
    points = ["1 0 0", "-1 0 0", "0 1 0", "0 -1 0", "0 0 1", "0 0 -1"]
    faces = [f"3 {a} {b} {c}" for a, b, c in itertools.product((0, 1), (2, 3), (4, 5))]
    (folder / "mesh.off").write_text("\n".join(["OFF", f"{len(points)} {len(faces)} 0", *points, *faces, ""]))


def convert(folder, source, target, *options):
    """Writes a mesh in another format, and removes the first one."""
    if source == target:
        return
    made = [interposed.MESHORDER, "order", source, "-o", target, "-q", "--vertices", "original", "--elements", "original",
            *options]
    subprocess.run(made, cwd=folder, check=True, capture_output=True)
    for part in folder.glob("mesh.*"):
        if part.suffix in (".node", ".ele", ".off") and part.name != target:
            part.unlink()


def solid(extension):
    def before(folder):
        write_cube(folder)
        convert(folder, "mesh.node", f"mesh.{extension}")
    return before


def surface(extension):
    def before(folder):
        write_surface(folder)
        convert(folder, "mesh.off", f"mesh.{extension}")
    return before


def with_old_output(folder):
    """A mesh, an older output of it, and the older maps."""
    write_cube(folder)
    (folder / "sub").mkdir()
    made = [interposed.MESHORDER, "order", "mesh.node", "-o", "out.msh", "--maps", "sub/m", "-q", "--seed", "1", *map(str, SCRAMBLED[:4])]
    subprocess.run(made, cwd=folder, check=True, capture_output=True)


def with_other_output(folder):
    """A mesh with its maps, and another mesh where the output of `apply` goes."""
    with_old_output(folder)
    convert(folder, "mesh.node", "out.msh")
    write_cube(folder)


def foam_case(folder):
    foam_cases.write_case(folder / "case", foam_cases.shuffled(foam_cases.block(3, 2, 2), seed=3))


def scenario(folder):
    write_cube(folder)
    (folder / "small.json").write_text(json.dumps(SCENARIO))


def bigger(folder):
    write_cube(folder, 10)


def over(extension):
    """A mesh, and another mesh where the output goes."""
    def before(folder):
        write_cube(folder, 1)
        convert(folder, "mesh.node", f"out.{extension}")
        write_cube(folder)
    return before


COMMANDS = {
    "order with maps": Line(("order", "mesh.node", "-o", "out.msh", "--maps", "sub/m", *SCRAMBLED), with_old_output,
                            reader=("apply", "sub/m", "out.msh", "--inverse", "-o", "read.msh")),
    "order by spectral": Line(("order", "mesh.node", "-o", "out.vtu", "--vertices", "spectral", "--threads", 2), bigger),
    "order by itself": Line(("order", "mesh.node", "-o", "out.vtu", "--json"), solid("node")),
    "apply": Line(("apply", "sub/m", "mesh.node", "-o", "out.msh"), with_other_output, reader=("info", "out.msh")),
    "info": Line(("info", "mesh.node"), solid("node")),
    "info of cgns as JSON": Line(("info", "mesh.cgns", "--json"), solid("cgns")),
    "compare": Line(("compare", "mesh.node", "--methods", "rcm,metis-nd", "--budget", "0.01"), solid("node"), most=2),
    "openfoam": Line(("openfoam", "case"), foam_case),
    "simulate": Line(("simulate", "small.json", "--vtk", "frames", "--checkpoint", "state"), scenario, varies=("state",),
                     together=False),
    "methods": Line(("methods",), lambda folder: None),
}
COMMANDS |= {f"{extension} in place": Line(("order", f"mesh.{extension}", "-o", f"mesh.{extension}", *SCRAMBLED), before)
             for extension, before in [(one, solid(one)) for one in SOLIDS] + [(one, surface(one)) for one in SURFACES]}
# an output that replaces another mesh and is no input: a second run gives the same files
OVER = {f"{extension} over another": Line(("order", "mesh.node", "-o", f"out.{extension}", *SCRAMBLED), over(extension),
                                          reader=("info", f"out.{extension}"))
        for extension in ("node", "vtu", "xdmf", "cgns", "exo")}


def case(name, folder):
    return interposed.Case(folder / name.replace(" ", "_"), (COMMANDS | OVER)[name])
