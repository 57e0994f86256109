#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Runs clang-tidy over the project's own sources of a finished build; sources that have passed are not checked again.

    tidy.py BUILD JOBS            all sources; sources of one unity file are checked together, in a third of the time
    tidy.py BUILD JOBS WORD…      sources whose path has one of the words, each alone: this also shows missing includes

Sources that pass leave a stamp, whose name is a checksum of all that clang-tidy read: the files, their headers, their
flags, the checks and clang-tidy itself. While these stay the same, in any checkout, the sources are not checked again.
Stamps are in ccache's folder: a copy of that folder on another machine has the stamps, too.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
# tests and benchmarks follow fewer rules, and programs with CGAL have its style
LEFT_OUT = re.compile(r"^(tests|benchmarks|apps/meshorder-models|apps/meshorder-delaunay)/")
DAYS_KEPT = 30
OWN_CODE = "meshorder-own-code"  # the plugin's name for itself


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def stamps_folder():
    if shutil.which("ccache"):
        kept = pathlib.Path(output("ccache", "--get-config", "cache_dir").strip())
    else:
        kept = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
    folder = kept / "meshorder-tidy"
    folder.mkdir(parents=True, exist_ok=True)
    for stamp in folder.iterdir():
        if time.time() - stamp.stat().st_mtime > DAYS_KEPT * 86400:
            stamp.unlink(missing_ok=True)
    return folder


def entries_of(build, words):
    """Yields the compile commands of our sources: each entry with "sources", the paths of its sources from the root.
    Without words the sources of one unity file share an entry, unless the file has generated sources, too."""
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        paths = [entry["file"]]
        if "/Unity/unity_" in entry["file"]:
            paths = re.findall(r'^#include "(.*)"', pathlib.Path(entry["file"]).read_text(encoding="utf-8"), re.MULTILINE)
        own = [path for path in map(pathlib.Path, paths) if path.is_relative_to(ROOT) and not path.is_relative_to(build)]
        sources = [str(path.relative_to(ROOT)) for path in own]
        sources = [source for source in sources if not LEFT_OUT.match(source)]
        if words or len(sources) < len(paths):  # generated sources are not ours
            for source in sources:
                if not words or any(word in source for word in words):
                    yield {**entry, "file": str(ROOT / source), "sources": [source]}
        elif sources:
            yield {**entry, "file": entry["file"] if len(sources) > 1 else str(ROOT / sources[0]), "sources": sources}


def flags(entry):
    """Returns the flags of a compile command for clang-tidy: without GCC's precompiled header, which clang cannot read
    and no file may need."""
    words = shlex.split(entry["command"])
    while os.path.basename(words[0]).startswith(("ccache", "c++", "g++", "clang++")):
        words.pop(0)
    kept = []
    while words:
        word = words.pop(0)
        if word in ("-o", "-c", "-MF", "-MT"):
            words.pop(0)
        elif word == "-include" and "cmake_pch" in words[0]:
            words.pop(0)
        elif word not in ("-Winvalid-pch", "-fpch-preprocess", "-MD"):
            kept.append(word)
    return kept


def headers_by_object(build):
    """Returns, by ninja, the files that the compiler of each object has read, without those of a precompiled header."""
    found, current = {}, None
    for line in output("ninja", "-C", str(build), "-t", "deps").splitlines():
        if line.startswith("    ") and current is not None:
            current.append(os.path.normpath(build / line.strip()))
        elif ": #deps" in line:
            name, state = line.split(": #deps")
            current = found[name] = [] if "(VALID)" in state else None
    return found


def headers_of(entry, by_object):
    """Returns the headers of an entry; None if ninja does not know all. Sources compiled together share their headers."""
    words = shlex.split(entry["command"])
    objects = [entry.get("output") or words[words.index("-o") + 1]]
    objects += [f"{after}.gch" for word, after in zip(words, words[1:]) if word == "-include" and "cmake_pch" in after]
    known = [by_object.get(os.path.relpath(os.path.join(entry["directory"], name), entry["directory"])) for name in objects]
    if None in known:
        return None
    return {path for paths in known for path in paths if "cmake_pch" not in path and not path.endswith((".cpp", ".cxx"))}


class Fingerprints:
    """Fingerprints of files: by content for our own files, by name, size and time for others, which packages keep."""

    def __init__(self):
        self.known = {}

    def __call__(self, path):
        if path not in self.known:
            own = pathlib.Path(path).is_relative_to(ROOT)
            if own:
                what = (os.path.relpath(path, ROOT), hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest())
            else:
                status = os.stat(path)
                what = (path, status.st_size, int(status.st_mtime))
            self.known[path] = repr(what)
        return self.known[path]


def key(entry, headers, fingerprint, general):
    """Names the stamp of an entry."""
    folders = [ROOT, *(p for p in pathlib.Path(entry["file"]).parents if p.is_relative_to(ROOT))]
    checks = {str(folder / ".clang-tidy") for folder in folders if (folder / ".clang-tidy").exists()}
    seen = [general, *entry["sources"], shlex.join(flags(entry)).replace(str(ROOT), ".")]
    read = checks | headers | {str(ROOT / source) for source in entry["sources"]}
    seen += sorted(fingerprint(path) for path in read)  # independent of the checkout's path
    return hashlib.sha256("\n".join(seen).encode()).hexdigest()


def plugin(build):
    """Builds own_code.cpp and returns the option that loads it; no option if clang's headers are missing or do not fit.
    The findings are the same without the plugin."""
    installed = pathlib.Path(shutil.which("clang-tidy")).resolve().parents[1]
    module, log = build / "tidy" / "own_code.so", build / "tidy" / "own_code.log"
    module.parent.mkdir(exist_ok=True)
    launcher = ["ccache"] if shutil.which("ccache") else []
    compile_it = [*launcher, "c++", "-std=c++17", "-O1", "-fPIC", "-fno-rtti", "-w", "-isystem", installed / "include", "-c",
                  HERE / "own_code.cpp", "-o", module.with_suffix(".o")]
    link_it = ["c++", "-shared", module.with_suffix(".o"), "-o", module]
    load = f"--load={module}"
    with open(log, "w", encoding="utf-8") as said:
        for command in (compile_it, link_it, ["clang-tidy", load, f"--checks={OWN_CODE}", "--list-checks"]):
            if subprocess.run(command, stdout=said, stderr=said, check=False).returncode != 0:
                print(f"clang-tidy takes several times as long without its plugin: see {log}", flush=True)
                return []
    return [load]


def look_at(entry, load, stamp):
    """Returns the findings of clang-tidy; an empty text if there are none."""
    checks = [OWN_CODE] if load else []
    if len(entry["sources"]) > 1:
        # a unity file includes sources, and clang-tidy 14 reports exceptions in it that its sources alone do not have
        checks.append("-bugprone-suspicious-include,-bugprone-exception-escape")
    done = subprocess.run(["clang-tidy", "--quiet", *load, f"--checks={','.join(checks)}", entry["file"], "--", *flags(entry)],
                          cwd=entry["directory"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode == 0:
        if stamp:
            stamp.touch()
        return ""
    return done.stdout or f"{entry['file']}: clang-tidy ended with {done.returncode}"


def main():
    build, jobs, words = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]), sys.argv[3:]
    entries = {tuple(entry["sources"]): entry for entry in entries_of(build, words)}
    by_object, fingerprint, folder = headers_by_object(build), Fingerprints(), stamps_folder()
    general = output("clang-tidy", "--version") + fingerprint(str(HERE / "tidy.py")) + fingerprint(str(HERE / "own_code.cpp"))

    todo = []
    for sources, entry in sorted(entries.items()):
        headers = headers_of(entry, by_object)
        stamp = folder / key(entry, headers, fingerprint, general) if headers else None
        if stamp and stamp.exists():
            stamp.touch()
        else:
            todo.append((len(sources), entry, stamp))
    count, left = sum(map(len, entries)), sum(files for files, _, _ in todo)
    print(f"{count - left} of {count} files have passed before", flush=True)
    if not todo:
        return 0

    load, seen, failed = plugin(build), 0, 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for (files, _, _), found in zip(todo, pool.map(lambda job: look_at(job[1], load, job[2]), todo)):
            seen += files
            if found:
                failed += files
                print(found, flush=True)
            elif seen // 50 > (seen - files) // 50:
                print(f"{seen} of {left} looked at", flush=True)
    print(f"{left - failed} passed, {failed} failed, or are compiled together with one that did" if failed else f"{left} passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
