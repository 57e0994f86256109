#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Prints what fuzz/run did as a Markdown table:

    table.py BUILD-FOLDER [FAMILY…]    all families that have run, or these

Executions and seconds are those of all runs with logs; coverage is that of the corpus in the last run.
Exit status 1 if a family has findings of its own.
"""
import os
import pathlib
import re
import subprocess
import sys

PROGRESS = re.compile(r"^#(\d+)[:\t ].*?cov: (\d+) ft: (\d+)", re.MULTILINE)
SECONDS = re.compile(r"^(?:Done \d+ runs in (\d+) second|INFO: fuzzed for (\d+) seconds|#\d+:.* time: (\d+)s)", re.MULTILINE)
FRAME = re.compile(r"^\s*#\d+ 0x[0-9a-f]+ +(?:in (\S+).*?)?\(?(/[^\s:()]+)", re.MULTILINE)
LIBRARIES = ("libhdf5", "libnetcdf", "libcgns", "libmed", "libz.", "libsz", "libaec", "libxml", "libcurl")
# files of the sanitizers, the fuzzing engine and the C library, and their functions where a report names no file
RUNTIME = re.compile(r"compiler-rt|sanitizer|libFuzzer|libc\.so|libstdc\+\+|/csu/|/nptl/|/sysdeps/|/raise|/abort")
RUNTIME_FUNCTION = re.compile(r"fuzzer::|__(asan|lsan|ubsan|sanitizer|interceptor)|operator$|(malloc|calloc|realloc|free|abort|raise|"
                              r"mem(cpy|move|set|cmp|chr)|str(n?len|n?cpy|n?cmp|chr|dup))\b")


def progress(family, build):
    """Returns executions and seconds of all runs, and edges and features of the last run."""
    executions = seconds = edges = features = 0
    for log in sorted((build / "logs").glob(f"{family}.*.log")):
        text = log.read_text(encoding="utf-8", errors="replace")
        found = PROGRESS.findall(text)
        if not found:
            continue
        executions += int(found[-1][0])
        times = [int(next(filter(None, groups))) for groups in SECONDS.findall(text)]
        seconds += times[-1] if times else 0
        edges, features = int(found[-1][1]), int(found[-1][2])
    return executions, seconds, edges, features


def is_of_a_library(report):
    """Returns whether the first function in a report outside the sanitizers is in a library that reads files for us."""
    for function, path in FRAME.findall(report):
        if any(name in os.path.basename(path) for name in LIBRARIES):
            return True
        if not RUNTIME.search(path) and not RUNTIME_FUNCTION.match(function):
            return False
    return False


def findings(family, build):
    """Returns the inputs on which our own code breaks a promise, and those on which a library breaks one."""
    own, of_libraries = [], []
    program = build / "bin" / f"meshorder_fuzz_{family}"
    for path in sorted((build / "findings" / family).glob("*-*")):
        if path.name.startswith("slow-unit"):
            continue
        run = subprocess.run([program, "-timeout=20", "-rss_limit_mb=2048", "-malloc_limit_mb=1024", path],
                             capture_output=True, text=True, errors="replace", timeout=120, check=False)
        if run.returncode != 0:
            (of_libraries if is_of_a_library(run.stderr) else own).append(path)
    return own, of_libraries


def main():
    build = pathlib.Path(sys.argv[1])
    families = sys.argv[2:] or sorted({log.name.split(".")[0] for log in (build / "logs").glob("*.log")})
    print("| family | executions | seconds | edges | features | findings | in libraries |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    total_executions = total_seconds = 0
    all_own = []
    for family in families:
        executions, seconds, edges, features = progress(family, build)
        own, of_libraries = findings(family, build)
        total_executions += executions
        total_seconds += seconds
        all_own += own
        print(f"| {family} | {executions:,} | {seconds:,} | {edges:,} | {features:,} | {len(own)} | {len(of_libraries)} |")
    print(f"| all | {total_executions:,} | {total_seconds:,} | | | {len(all_own)} | |")
    for path in all_own:
        print(f"breaks a promise: {path}")
    sys.exit(1 if all_own else 0)


if __name__ == "__main__":
    main()
