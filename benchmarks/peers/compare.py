#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Compares meshorder's Fiedler solver with others' at equal accuracy, each on one thread, from a ready graph.

Every solver gets the largest component of the mesh's vertex graph. Its vector y is judged here, by one rule for all:
the residual ‖Ly − λy‖ / (λ₂ ‖y‖) with λ = yᵀLy / yᵀy, and the cosine of its angle to the exact eigenspace of λ₂, found
by shift and invert. meshorder runs at the accuracy itself. Each other solver runs at the loosest of its tolerances 5, 2,
1, 0.5, 0.2, 0.1 … 1e-12 at which the residual reaches the accuracy and the cosine is above 0.9. These tolerances are
searched first and stored in the work folder. Then all solvers run in turn, round by round, each in a process of its own,
which solves up to three times within a second. A solver's time is its best solve, without start-up and reading.

Debian's packages: libspectra-dev libslepc-real-dev libhypre-dev python3-scipy python3-networkx. PyAMG is not in Debian; it
takes part if this Python has it. Peers that are missing are skipped with a message.

    cmake -B build -DMESHORDER_BENCHMARKS=ON && cmake --build build
    benchmarks/peers/compare.py dragon.node
"""
import argparse
import hashlib
import json
import math
import os
import pathlib
import subprocess
import sys

import numpy

from peer import SOLVERS, eigenpairs, laplacian_of

OURS = "meshorder"
BOOMERAMG = "-st_pc_type hypre -st_pc_hypre_boomeramg_agg_nl 1 -st_pc_hypre_boomeramg_coarsen_type HMIS " \
            "-st_pc_hypre_boomeramg_interp_type ext+i"  # BoomerAMG's own defaults, which are faster than PETSc's
PROGRAMS = {  # name: program, and what follows GRAPH TOLERANCE VECTOR
    OURS: ("peer-meshorder", []),
    "hypre-lobpcg-boomeramg": ("peer-hypre", []),
    "slepc-lobpcg-gamg": ("peer-slepc", ["-st_pc_type", "gamg"]),
    "slepc-lobpcg-boomeramg": ("peer-slepc", BOOMERAMG.split()),
    "spectra-ldlt-amd": ("peer-spectra", []),
    "spectra-ldlt-metis": ("peer-spectra", ["metis"]),
}
PEERS = [*PROGRAMS, *SOLVERS]
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
MIN_COSINE = 0.9


class Problem:
    """A mesh's graph in a folder of its own, its Laplacian, and the exact eigenspace of λ₂."""

    def __init__(self, mesh, programs, work):
        self.folder = work / mesh.stem
        subprocess.run([programs / "peer-graph_of", mesh, self.folder], check=True)
        offsets, self.neighbours = (numpy.load(self.folder / f"{name}.npy") for name in ("offsets", "neighbours"))
        self.rows = numpy.repeat(numpy.arange(len(offsets) - 1), numpy.diff(offsets))
        self.laplacian = laplacian_of(offsets, self.neighbours)
        digest = hashlib.sha256(offsets.tobytes() + self.neighbours.tobytes()).hexdigest()
        self.kept = self.folder / f"{digest[:16]}.npz"
        self.tolerances = self.folder / f"{digest[:16]}.json"
        if not self.kept.exists():
            values, vectors = eigenpairs(self.laplacian, 5, 0)
            numpy.savez(self.kept, values=values, vectors=vectors)
        reference = numpy.load(self.kept)
        values, vectors = reference["values"], reference["vectors"]
        self.lambda2 = values[1]
        self.eigenspace = vectors[:, 1:][:, values[1:] < self.lambda2 * (1 + 1e-6)]

    def judged(self, y):
        """Returns how good a vector is, by the same rule for all solvers."""
        y = y / numpy.linalg.norm(y)
        product = self.laplacian @ y
        value = y @ product
        rank = numpy.empty(len(y))
        rank[numpy.argsort(y, kind="stable")] = numpy.arange(len(y))
        return {"residual": numpy.linalg.norm(product - value * y) / self.lambda2,
                "eigenvalue_error": value / self.lambda2 - 1,
                "cosine": numpy.linalg.norm(self.eigenspace.T @ y),
                "mean_span": numpy.abs(rank[self.rows] - rank[self.neighbours]).mean()}


class Failure(Exception):
    """Why a solver has no result."""


class Missing(Failure):
    """Something that the solver needs is not on this machine."""


class TooSlow(Failure):
    """The solver was stopped; tighter tolerances would not help."""


def run(name, problem, tolerance, options):
    """Runs one process of a solver; returns its seconds, and how good the vector is."""
    vector = problem.folder / "vector"
    vector.unlink(missing_ok=True)
    if name in PROGRAMS:
        program, extra = PROGRAMS[name]
        if not (options.programs / program).exists():
            raise Missing("not built, its library is missing")
        command = [options.programs / program]
    else:
        extra = []
        command = [sys.executable, pathlib.Path(__file__).with_name("peer.py"), name]
    try:
        done = subprocess.run([*command, problem.folder, repr(tolerance), vector, *extra], capture_output=True,
                              text=True, timeout=options.limit, env={**os.environ, **ONE_THREAD})
    except subprocess.TimeoutExpired:
        raise TooSlow(f"more than {options.limit:g} s") from None
    if done.returncode != 0:
        why = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
        raise Missing(why[-1]) if done.returncode == 3 else Failure(why[-1])
    y = numpy.fromfile(vector)
    if not numpy.isfinite(y).all() or not y.any():
        raise Failure("not a vector")
    return {"tolerance": tolerance, "seconds": float(done.stdout), **problem.judged(y)}


def loosest_tolerance(name, problem, accuracy, start, options):
    """Returns the loosest tolerance up to `start` that reaches the accuracy and the right vector: its decade first."""
    def reaches(tolerance):
        result = run(name, problem, tolerance, options)
        return result["residual"] <= accuracy and result["cosine"] > MIN_COSINE

    last = "no tolerance reaches it"
    for exponent in range(min(0, math.ceil(math.log10(start))), -13, -1):
        try:
            if not reaches(10.0 ** exponent):
                continue
        except (Missing, TooSlow):
            raise
        except Failure as failure:
            last = str(failure)
            continue
        for factor in (5, 2):
            try:
                if reaches(factor * 10.0 ** exponent):
                    return factor * 10.0 ** exponent
            except Failure:
                pass
        return 10.0 ** exponent
    raise Failure(last)


def chosen_tolerances(problem, accuracy, options):
    """Returns the tolerance of each solver, or why it has none, from the work folder or a search."""
    known = json.loads(problem.tolerances.read_text()) if problem.tolerances.exists() else {}
    chosen = {}
    for name in options.peers:
        key = f"{name} {accuracy:g}"
        if name == OURS:
            chosen[name] = accuracy
            continue
        if key not in known:
            # the tolerance found for a lower accuracy is an upper bound
            start = min([known[f"{name} {lower:g}"] for lower in options.accuracy
                         if lower > accuracy and isinstance(known.get(f"{name} {lower:g}"), float)], default=1.0)
            try:
                known[key] = loosest_tolerance(name, problem, accuracy, start, options)
            except Missing as missing:
                chosen[name] = str(missing)
                continue
            except Failure as failure:
                known[key] = str(failure)
            problem.tolerances.write_text(json.dumps(known, indent=2))
        chosen[name] = known[key]
    return chosen


def compared(problem, accuracy, options):
    """Rows of the table, one for each solver."""
    chosen = chosen_tolerances(problem, accuracy, options)
    rows = {name: {"solver": name} for name in chosen}
    for _ in range(options.rounds):
        for name, tolerance in chosen.items():
            if isinstance(tolerance, str):
                rows[name]["failure"] = tolerance
                continue
            try:
                result = run(name, problem, tolerance, options)
            except Failure as failure:
                rows[name]["failure"] = str(failure)
                continue
            result["seconds"] = min(result["seconds"], rows[name].get("seconds", numpy.inf))
            rows[name].update(result)
    ours = rows[OURS].get("seconds")
    for row in rows.values():
        if ours and "seconds" in row:
            row["ratio"] = row["seconds"] / ours
    return list(rows.values())


def print_table(rows, accuracy):
    print("| solver | its tolerance | ms | ratio | residual | λ/λ₂ − 1 | cosine | mean span |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for row in rows:
        if "seconds" not in row:
            print(f"| {row['solver']} | – | {row.get('failure', 'not measured')} | | | | | |")
            continue
        missed = " missed" if row["residual"] > accuracy or row["cosine"] <= MIN_COSINE else ""
        print(f"| {row['solver']} | {row['tolerance']:g} | {1e3 * row['seconds']:,.1f} | {row['ratio']:.1f} "
              f"| {row['residual']:.1e}{missed} | {row['eigenvalue_error']:.0e} | {row['cosine']:.4f} "
              f"| {row['mean_span']:,.1f} |", flush=True)


def arguments():
    root = pathlib.Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", type=pathlib.Path, metavar="MESH")
    parser.add_argument("--accuracy", type=float, nargs="+", default=[0.1, 1e-5], help="residuals to reach")
    parser.add_argument("--peers", nargs="+", choices=PEERS, default=PEERS, metavar="NAME",
                        help="some of: " + ", ".join(PEERS[1:]))
    parser.add_argument("--rounds", type=int, default=3, help="0 only searches for the tolerances")
    parser.add_argument("--limit", type=float, default=60, help="seconds that a solver's process may take")
    parser.add_argument("--programs", type=pathlib.Path, default=root / "build/bin", help="where peer-… were built")
    parser.add_argument("--work", type=pathlib.Path, default=root / "build/peers", help="folder for what is kept")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="write the results there as well")
    options = parser.parse_args()
    if not (options.programs / "peer-graph_of").exists():
        parser.error(f"no peer-graph_of in {options.programs}; build with -DMESHORDER_BENCHMARKS=ON, or see --programs")
    options.accuracy.sort(reverse=True)
    options.peers = [OURS, *(name for name in options.peers if name != OURS)]
    return options


def main():
    options = arguments()
    results = []
    for mesh in options.meshes:
        problem = Problem(mesh, options.programs, options.work)
        size, entries = problem.laplacian.shape[0], len(problem.neighbours)
        print(f"\n{mesh.stem}: {size:,} vertices, {entries // 2:,} edges, λ₂ = {problem.lambda2:.6e}")
        for accuracy in options.accuracy:
            rows = compared(problem, accuracy, options)
            results.append({"mesh": mesh.stem, "vertices": size, "edges": entries // 2, "lambda2": problem.lambda2,
                            "accuracy": accuracy, "solvers": rows})
            if options.rounds > 0:
                print(f"\nResidual {accuracy:g}:\n")
                print_table(rows, accuracy)
    if options.json:
        options.json.write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()
