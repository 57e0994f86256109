#!/usr/bin/python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Measures the costs and results of `meshorder order` on many ranks, and predicts its costs on a cluster from them.

    benchmarks/ranks.py build/bin/meshorder --sizes 50000 200000 --ranks 1 2 4 8 --json ranks.json
    benchmarks/ranks.py build/bin/meshorder --mesh ball.vtu --ranks 1 4
    benchmarks/ranks.py --from ranks.json --model

The first measures weak scaling: scrambled lattices of tetrahedra with about as many vertices a rank as --sizes says,
ordered from raw .vtu file to raw .vtu file with one thread a rank; 1 is the command without mpirun. The second measures one
mesh on several numbers of ranks. Tables go to stdout, in Markdown. --json keeps the runs; --from begins with such runs.
--model predicts the costs of 10^7 to 10^9 vertices on 16 to 1,024 ranks from the runs on more than one; see predict().

There may be more ranks than cores, so wall-clock time means nothing. Times are processor time in the program ("user") and
in the system, medians of --rounds runs. Times of stages come from /proc for each rank, in steps of 10 ms, between the ends
of stages at rank 0. They include waiting for other ranks, which polls. Bytes and messages are counted by Open MPI's
monitoring in one more run. Needs Linux, Open MPI, NumPy, and meshorder with MESHORDER_MPI and its models.
"""
import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
import tempfile
import time

import numpy

STAGES = ["read", "distribute", "graph", "partition", "order", "cells", "write"]
TICK = os.sysconf("SC_CLK_TCK")
INTERVAL = 0.005  # seconds between two looks at the processes
WAITING = {"OMPI_MCA_mpi_yield_when_idle": "1"}


class Watch:
    """Processor time of a process, or of its children, as it grows."""

    def __init__(self, pid, of_children):
        self.pid, self.of_children = pid, of_children
        self.files = {} if of_children else {pid: open(f"/proc/{pid}/stat", "rb", buffering=0)}
        self.samples = {}

    def look(self):
        if self.of_children:
            # from 32 ranks on, mpirun starts them from threads, each of which has children of its own
            for thread in pathlib.Path(f"/proc/{self.pid}/task").glob("*/children"):
                try:
                    for child in set(map(int, thread.read_text().split())) - self.files.keys():
                        self.files[child] = open(f"/proc/{child}/stat", "rb", buffering=0)
                except OSError:  # the thread or the child has ended
                    continue
        for pid, file in self.files.items():
            try:
                words = os.pread(file.fileno(), 1000, 0).rsplit(b")", 1)[1].split()
            except OSError:  # the process has ended
                continue
            self.samples.setdefault(pid, []).append((time.monotonic(), int(words[11]) / TICK, int(words[12]) / TICK))

    def close(self):
        for file in self.files.values():
            file.close()

    def between(self, ends):
        """Seconds in the program and in the system between successive times, as [process][interval] each."""
        times = [numpy.array(samples).T for samples in self.samples.values()]
        return [numpy.diff([numpy.interp(ends, t[0], t[column]) for t in times], axis=1) for column in (1, 2)]


def command_of(options, ranks, mesh, output, method, more=()):
    order = [options.program, "order", mesh, "-o", output, "--vertices", method, "--threads", "1", "--json", "-q"]
    if ranks == 1:
        return order
    return [*options.mpirun.split(), "-n", str(ranks), *more, *order]


def run_watched(command, of_children):
    """Runs a command that prints JSON; returns the JSON, the Watch, the time at which it came, and the resources used."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, env={**os.environ, **WAITING}) as process:
        os.set_blocking(process.stdout.fileno(), False)
        watch = Watch(process.pid, of_children)
        text, came, ended = b"", 0.0, 0
        while not ended:
            watch.look()
            more = process.stdout.read()
            if more:
                text, came = text + more, came or time.monotonic()
            time.sleep(INTERVAL)
            ended, status, usage = os.wait4(process.pid, os.WNOHANG)
        process.returncode = os.waitstatus_to_exitcode(status)
        text += process.stdout.read() or b""
        watch.close()
    if process.returncode != 0:
        raise SystemExit(f"ranks.py: status {process.returncode} of {' '.join(map(str, command))}")
    return json.loads(text), watch, came or time.monotonic(), usage


def messages_of(options, ranks, mesh, output, method, folder):
    """Bytes and messages that each rank sends, those inside collective calls included."""
    count = ["--mca", "pml_monitoring_enable", "2", "--mca", "pml_monitoring_enable_output", "3",
             "--mca", "pml_monitoring_filename", str(folder / "sent")]
    subprocess.run(command_of(options, ranks, mesh, output, method, count), check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, **WAITING})
    sent = []
    for rank in range(ranks):
        file = folder / f"sent.{rank}.prof"
        rows = [line.split("\t") for line in file.read_text().splitlines() if line[:2] in ("E\t", "I\t")]
        sent.append([sum(int(row[3].split()[0]) for row in rows), sum(int(row[4].split()[0]) for row in rows)])
        file.unlink()
    return sent


def measure(options, size, ranks, mesh, method, folder):
    """The medians of some runs as a dictionary."""
    output = folder / "ordered.vtu"
    rounds = []
    for _ in range(options.rounds):
        command = command_of(options, ranks, mesh, output, method)
        report, watch, came, usage = run_watched(command, ranks > 1)
        stages = [stage for stage in STAGES if stage in report["seconds"]]
        ends = came - numpy.cumsum([0.0, *(report["seconds"][stage] for stage in reversed(stages))])[::-1]
        user, system = watch.between(ends)
        # for each stage: seconds of all ranks in the program, and in the system; those of the busiest rank in the program
        rounds.append([usage.ru_utime, usage.ru_stime, *user.sum(0), *system.sum(0), *user.max(0)])
    medians = [statistics.median(values) for values in zip(*rounds)]
    run = {"size": size, "ranks": ranks, "method": method, "vertices": report["vertices"]["count"],
           "cells": report["cells"]["count"], "file_bytes": os.path.getsize(mesh), "user": medians[0],
           "system": medians[1], "stages": {stage: medians[2 + s::len(stages)] for s, stage in enumerate(stages)},
           "memory": report.get("memory_bytes", [usage.ru_maxrss * 1024]), "span": report["edge_span"]["after"]}
    if ranks > 1:
        run["sent"] = messages_of(options, ranks, mesh, output, method, folder)
        run |= {key: report["partition"][key] for key in ("edges", "cut", "imbalance", "ghosts")}
    output.unlink()
    return run


def lattice(options, vertices, folder):
    """A scrambled lattice of about so many vertices, as a raw .vtu file."""
    name = f"grid-{round(vertices ** (1 / 3)) - 1}"
    mesh = folder / f"{name}.vtu"
    environment = {**os.environ, "MESHORDER_CACHE": str(folder)}
    subprocess.run([options.program, "models", "make", name, "-q"], check=True, stdout=subprocess.DEVNULL,
                   env=environment)
    made = folder / "models" / f"{name}.node"
    subprocess.run([options.program, "order", made, "-o", mesh, "--vertices", "scrambled", "--elements", "scrambled",
                    "-q"], check=True)
    for file in made.parent.glob(f"{name}.*"):
        file.unlink()
    return mesh


def measure_all(options, keep):
    """Calls keep() with each run."""
    with tempfile.TemporaryDirectory(dir=options.folder) as name:
        folder = pathlib.Path(name)
        for size in [0] if options.mesh else options.sizes:
            for ranks in options.ranks:
                mesh = options.mesh or lattice(options, size * ranks, folder)
                serial, *_ = run_watched(command_of(options, 1, mesh, folder / "serial.vtu", "spectral"), False)
                for method in options.vertices:
                    run = measure(options, size, ranks, mesh, method, folder)
                    keep({**run, "serial_span": serial["edge_span"]["after"]})
                if not options.mesh:
                    mesh.unlink()


def of(runs, method):
    return sorted((run for run in runs if run["method"] == method), key=lambda run: (run["size"], run["ranks"]))


def print_tables(runs):
    for method in dict.fromkeys(run["method"] for run in runs):
        own = of(runs, method)
        print(f"\n`{method}`: processor seconds in the program per million vertices\n")
        print(f"| vertices | ranks | {' | '.join(STAGES)} | order of one process | start and end | all | in the system |")
        print(f"|{' ---: |' * (len(STAGES) + 6)}")
        for run in own:
            per = 1e6 / run["vertices"]
            known = {stage: times[0] * per for stage, times in run["stages"].items()}
            one = run["ranks"] == 1
            cells = [f"{known[stage]:.2f}" if stage in known and not (one and stage == "order") else ""
                     for stage in STAGES]
            cells += [f"{known['order']:.2f}" if one else "", f"{run['user'] * per - sum(known.values()):.2f}",
                      f"{run['user'] * per:.2f}", f"{run['system'] * per:.2f}"]
            print(f"| {run['vertices']:,} | {run['ranks']} | {' | '.join(cells)} |")
        print(f"\n`{method}`: what it yields and needs; spans relative to those of serial `spectral`\n")
        print("| vertices | ranks | edges cut | imbalance | ghosts | mean log₂ span, mean span | most memory of a rank | "
              "for each of its vertices | sent per vertex | most messages of a rank |")
        print(f"|{' ---: |' * 10}")
        for run in own:
            parts, sent = [""] * 3, [""] * 2
            if run["ranks"] > 1:
                parts = [f"{100 * run['cut'] / run['edges']:.2f} %", f"{run['imbalance']:.3f}",
                         f"{100 * run['ghosts'] / run['vertices']:.1f} %"]
                sent = [f"{sum(s[0] for s in run['sent']) / run['vertices']:,.0f} B",
                        f"{max(s[1] for s in run['sent']):,}"]
            span = [run["span"][key] / run["serial_span"][key] for key in ("mean_log2", "mean")]
            memory = max(run["memory"])
            print(f"| {run['vertices']:,} | {run['ranks']} | {' | '.join(parts)} | {span[0]:.3f}, {span[1]:.3f} | "
                  f"{memory / 2**20:,.0f} MiB | {memory * run['ranks'] / run['vertices']:,.0f} B | {' | '.join(sent)} |")


def fitted(columns, values):
    """Returns the columns' coefficients by least squares, all but the first at least 0; columns that would be below 0 get 0."""
    used = list(range(columns.shape[1]))
    while True:
        coefficients = numpy.linalg.lstsq(columns[:, used], values, rcond=None)[0]
        if coefficients[1:].min(initial=0.0) >= 0.0:
            break
        used.pop(1 + int(coefficients[1:].argmin()))
    all_of_them = numpy.zeros(columns.shape[1])
    all_of_them[used] = coefficients
    return all_of_them


class PerVertex:
    """A cost per vertex of a rank. It grows with two logarithms: of the ranks, and of the vertices of a rank."""

    def __init__(self, runs, values):
        self.ranks = [min(run["ranks"] for run in runs), max(run["ranks"] for run in runs)]
        own = [own_vertices(run) for run in runs]
        self.own = [min(own), max(own)]
        several = len({run["size"] for run in runs}) > 1
        columns = [[1.0, numpy.log2(run["ranks"]), numpy.log2(own_vertices(run)) if several else 0.0] for run in runs]
        self.coefficients = fitted(numpy.array(columns), numpy.array(values))

    def at(self, ranks, own):
        """Returns the least cost, that of the nearest runs, and the highest cost, which continues to grow beyond the runs."""
        nearest = [numpy.clip(ranks, *self.ranks), numpy.clip(own, *self.own)]
        beyond = [max(ranks, self.ranks[0]), max(own, self.own[0])]
        return numpy.array([[1.0, *numpy.log2(place)] for place in (nearest, beyond)]) @ self.coefficients

    def measured(self):
        """Returns the cost in the runs with most ranks and vertices a rank, and what doublings of these add."""
        return [float(self.at(self.ranks[1], self.own[1])[0]), *map(float, self.coefficients[1:])]


def own_vertices(run):
    return run["vertices"] / run["ranks"]


class Constants:
    """The constants of the model, from the runs of a method."""

    def __init__(self, runs, method):
        own = [run for run in of(runs, method) if run["ranks"] > 1]
        self.stages = {stage: PerVertex(own, [run["stages"][stage][2] / own_vertices(run) for run in own])
                       for stage in own[0]["stages"]}
        self.sent = PerVertex(own, [max(s[0] for s in run["sent"]) / own_vertices(run) for run in own])
        several = len({run["size"] for run in own}) > 1
        base = [[1.0 if several else 0.0, own_vertices(run)] for run in own]
        self.memory = fitted(numpy.array(base), numpy.array([max(run["memory"]) for run in own]))
        self.messages = fitted(numpy.array([[1.0, run["ranks"]] for run in own]),
                               numpy.array([max(s[1] for s in run["sent"]) for run in own]))
        alone = [run for run in of(runs, method) if run["ranks"] == 1][-1]
        self.system = alone["system"] / alone["vertices"]
        self.file = alone["file_bytes"] / alone["vertices"]


def predict(options, constants, vertices, ranks):
    """Returns the least and the most seconds and bytes of a rank with a core of its own.

    The time of a stage is that of the busiest rank in the program, per vertex of a rank. The least is the cost in the runs with
    the nearest numbers of ranks and of vertices a rank; the most grows on with their logarithms, as it did in the runs. The
    bytes that a rank sends follow the same rule. Added to these are the system's time per vertex of the command without mpirun,
    for pages and files, and the time of messages by latency and bandwidth.
    """
    own = vertices / ranks
    stages = {stage: cost.at(ranks, own) * own for stage, cost in constants.stages.items()}
    sent = constants.sent.at(ranks, own) * own
    messages = max(constants.messages @ [1.0, ranks], 0.0)
    network = sent / (options.bandwidth * 1e9) + messages * options.latency * 1e-6
    system = numpy.full(2, constants.system * own)
    return {"stages": stages, "network": network, "system": system, "all": sum(stages.values()) + network + system,
            "files": numpy.full(2, 2 * constants.file * vertices / (options.file_bandwidth * 1e9)),
            "memory": float(constants.memory @ [1.0, own]), "sent": sent}


def text(low, high):
    digits = 0 if low >= 20 else 1 if high >= 2 else 2
    shown = [f"{value:,.{digits}f}" for value in (low, high)]
    return shown[0] if shown[0] == shown[1] else "–".join(shown)


def print_constants(known):
    print("| of a vertex of a rank | in the largest runs | a doubling of ranks adds | of vertices a rank |")
    print("| --- | ---: | ---: | ---: |")
    for stage, cost in known.stages.items():
        print(f"| {stage} | {' | '.join(f'{1e6 * value:.2f} µs' for value in cost.measured())} |")
    print(f"| in the system, for pages and files | {1e6 * known.system:.2f} µs | | |")
    print(f"| sent | {' | '.join(f'{value:,.0f} B' for value in known.sent.measured())} |")
    print(f"| of the input, and of the output | {known.file:,.0f} B | | |")
    print(f"| memory, beside {known.memory[0] / 2**20:,.0f} MiB | {known.memory[1]:,.0f} B | | |")
    print(f"\nA rank sends {known.messages[1]:,.0f} messages for each rank, {known.messages[0]:+,.0f}.")


def print_model(options, runs):
    for method in dict.fromkeys(run["method"] for run in runs if run["ranks"] > 1):
        known = Constants(runs, method)
        print(f"\n`{method}`, measured\n")
        print_constants(known)
        print(f"\n`{method}`, predicted: seconds, and bytes of a rank\n")
        print(f"| vertices | ranks | {' | '.join(known.stages)} | system | network | in all | files | memory | sent |")
        print(f"|{' ---: |' * (len(known.stages) + 8)}")
        for vertices in (10**7, 10**8, 10**9):
            for ranks in (16, 128, 1024):
                told = predict(options, known, vertices, ranks)
                seconds = [*told["stages"].values(), *(told[what] for what in ("system", "network", "all", "files"))]
                print(f"| {vertices:,} | {ranks:,} | {' | '.join(text(*values) for values in seconds)} | "
                      f"{told['memory'] / 2**30:,.2f} GiB | {text(*told['sent'] / 2**30)} GiB |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", help="build/bin/meshorder, with meshorder-mpi beside it")
    parser.add_argument("--sizes", type=int, nargs="+", default=[50000], help="vertices a rank")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 4, 8, 16, 32])
    parser.add_argument("--vertices", nargs="+", default=["spectral", "fiedler"], help="methods")
    parser.add_argument("--mesh", type=pathlib.Path, help="measure this raw .vtu file on all --ranks instead of lattices")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--mpirun", default="mpirun --oversubscribe", help="what starts ranks")
    parser.add_argument("--folder", help="for the meshes; 50,000 vertices on 32 ranks take 1 GB")
    parser.add_argument("--json", type=pathlib.Path, help="write the runs here")
    parser.add_argument("--from", dest="known", nargs="+", default=[], help="begin with the runs that --json wrote")
    parser.add_argument("--model", action="store_true", help="print the predictions for a cluster")
    parser.add_argument("--latency", type=float, default=2, help="of a message, in µs")
    parser.add_argument("--bandwidth", type=float, default=0.2, help="of the network for a rank, in GB/s")
    parser.add_argument("--file-bandwidth", type=float, default=5, help="of the file system for all ranks, in GB/s")
    options = parser.parse_args()
    if not options.known and not options.program:
        parser.error("give the program, or --from")
    runs = [run for path in options.known for run in json.loads(pathlib.Path(path).read_text())]

    def keep(run):
        runs.append(run)
        if options.json:
            options.json.write_text(json.dumps(runs, indent=1) + "\n")

    if options.model and not any(run["ranks"] == 1 for run in runs) and 1 not in options.ranks:
        parser.error("--model needs runs on 1 rank and on more")
    if options.program:
        measure_all(options, keep)
    print_tables(runs)
    if options.model:
        print_model(options, runs)


if __name__ == "__main__":
    main()
