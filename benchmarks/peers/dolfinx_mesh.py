#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""DOLFINx's own partition and order: `mpirun -n N dolfinx_mesh.py TETRAHEDRA OUT` makes a mesh on N ranks of the folder's
tetrahedra.npy and points.npy, without ghost cells, and writes in OUT the new number of each vertex as numbers.npy and the first one of
each rank as starts.npy. Prints the processor seconds in user mode that dolfinx.mesh.create_mesh takes on all ranks."""
import pathlib
import resource
import sys

import numpy
import ufl
from mpi4py import MPI

import dolfinx.mesh


def main():
    source, target = map(pathlib.Path, sys.argv[1:3])
    comm = MPI.COMM_WORLD
    arrays = []
    for name in ("tetrahedra", "points"):
        rows = numpy.load(source / f"{name}.npy", mmap_mode="r")
        begin, end = (len(rows) * (comm.rank + k) // comm.size for k in (0, 1))
        arrays.append(numpy.array(rows[begin:end]))
    tetrahedra, points = arrays
    domain = ufl.Mesh(ufl.VectorElement("Lagrange", "tetrahedron", 1))
    comm.Barrier()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
    mesh = dolfinx.mesh.create_mesh(comm, tetrahedra, points, domain, dolfinx.mesh.GhostMode.none)
    seconds = comm.reduce(resource.getrusage(resource.RUSAGE_SELF).ru_utime - before)
    own = mesh.geometry.index_map().size_local
    first = mesh.geometry.index_map().local_range[0]
    inputs = comm.gather(numpy.array(mesh.geometry.input_global_indices[:own]))
    starts = comm.gather(first)
    if comm.rank == 0:
        order = numpy.concatenate(inputs)
        numbers = numpy.empty(len(order), dtype=numpy.int64)
        numbers[order] = numpy.arange(len(order))
        numpy.save(target / "numbers.npy", numbers)
        numpy.save(target / "starts.npy", numpy.array([*starts, len(order)]))
        print(seconds)


if __name__ == "__main__":
    main()
