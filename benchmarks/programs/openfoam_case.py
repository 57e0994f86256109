# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""A box of fluid whose lid moves, for icoFoam of OpenFOAM."""
import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "command"))
import foam_cases  # noqa: E402

STEPS = 5
CONTROL = ("application icoFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {end}; deltaT {step}; "
           "writeControl timeStep; writeInterval 1000; writeFormat binary; timeFormat general;")
SOLUTION = ("solvers {{ p {{ solver {pressure}; tolerance 1e-6; relTol 0.01; }} pFinal {{ $p; relTol 0; }} "
            "U {{ solver smoothSolver; smoother symGaussSeidel; tolerance 1e-5; relTol 0; }} }} "
            "PISO {{ nCorrectors 2; nNonOrthogonalCorrectors {corrections}; pRefPoint (0.01 0.01 0.01); pRefValue 0; }}")
SCHEMES_OF_TETRAHEDRA = ("ddtSchemes { default Euler; } gradSchemes { default Gauss linear; } "
                         "divSchemes { default none; div(phi,U) Gauss upwind; } "
                         "laplacianSchemes { default Gauss linear limited 0.5; } "
                         "interpolationSchemes { default linear; } snGradSchemes { default limited 0.5; }")
PRESSURE = {"PCG": "PCG; preconditioner DIC", "GAMG": "GAMG; smoother GaussSeidel"}


def write_tetrahedra(path, size):
    import gmsh
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    for name, value in (("MeshSizeMin", size), ("MeshSizeMax", size), ("MshFileVersion", 2.2)):
        gmsh.option.setNumber(f"Mesh.{name}", value)
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    faces = gmsh.model.getEntities(2)
    lid = [tag for _, tag in faces if abs(gmsh.model.occ.getCenterOfMass(2, tag)[1] - 1) < 1e-9]
    walls = [tag for _, tag in faces if tag not in lid]
    for dimension, tags, group, name in ((2, lid, 1, "lid"), (2, walls, 2, "walls"), (3, [1], 3, "box")):
        gmsh.model.addPhysicalGroup(dimension, tags, group)
        gmsh.model.setPhysicalName(dimension, group, name)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(path))
    gmsh.finalize()


def write(case, size, pressure, cubes):
    """Writes a case: tetrahedra of that size as Gmsh leaves them, or blockMesh's cubes; the pressure by PCG or GAMG."""
    solution = SOLUTION.format(pressure=PRESSURE[pressure], corrections=0 if cubes else 1)
    schemes = {} if cubes else {"fvSchemes": SCHEMES_OF_TETRAHEDRA}
    foam_cases.write_settings(case, fvSolution=solution, controlDict=CONTROL.format(end=STEPS * 0.004, step=0.004), **schemes)
    if cubes:
        foam_cases.block_mesh(case, " ".join([str(round(0.5 / size) * 3)] * 3))
    else:
        write_tetrahedra(case / "box.msh", size)
        foam_cases.openfoam("gmshToFoam", case, str(case / "box.msh"))
        (case / "box.msh").unlink()
    foam_cases.write_fields(case)
