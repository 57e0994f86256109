# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The include lines follow the dependencies that CONTRIBUTING.md shows."""
import pathlib
import re

import pytest

pytestmark = pytest.mark.package
ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)

# folders of src/, each with the others that it may include; all may include public headers
CORE = {"base": set(), "graph": {"base"}}
CORE["cells"] = {"base", "graph"}
CORE["spectral"] = {"base", "graph"}
CORE["metrics"] = {"base", "graph"}
CORE["ordering"] = {"base", "graph", "cells", "spectral", "metrics"}
LAYERS = {
    **CORE,
    "c": {*CORE, "distributed"},
    "mesh": set(CORE),
    "io": {*CORE, "mesh"},
    "kernels": {*CORE, "mesh"},
    "payoff": {*CORE, "mesh", "io", "kernels"},
    "distributed": {*CORE, "mesh", "io"},
}
# libraries, by the first word of their headers, and the folders that may include them
LIBRARIES = {
    "tbb": {*CORE, "kernels", "payoff"},
    "Eigen": set(CORE),
    "metis.h": {"base", "ordering"},
    "fmt": {"mesh", "io", "kernels", "payoff", "distributed"},
    "hwy": {"kernels", "payoff"},
    "nlohmann": {"payoff"},
    "lz4.h": {"io"},
    "lzma.h": {"io"},
    "netcdf.h": {"io"},
    "netcdf_mem.h": {"io"},
    "cgns_io.h": {"io"},
    "hdf5.h": {"io"},
    "pugixml.hpp": {"io"},
    "zlib.h": {"io"},
    "mpi.h": {"distributed", "c"},
    "ptscotch.h": {"distributed"},
}
# plugins/: the prefixes of each solver's headers, and the headers that plugins give to users
HOSTS = {"petsc": ("petsc",), "dealii": ("deal.II/",), "dolfinx": ("dolfinx", "basix/", "xtl/", "mpi.h", "petsc")}
OF_PLUGINS = {"meshorder/dealii.hpp", "meshorder/dolfinx.hpp"}
#: public headers, each with another header that it may include: for MPI's communicator or Eigen's matrices
OF_OTHERS = {("distributed.hpp", "mpi.h"), ("distributed.hpp", "meshorder_mpi.h"), ("meshorder_mpi.h", "meshorder.h"),
             ("eigen.hpp", "Eigen/Core"), ("eigen.hpp", "Eigen/SparseCore")}
SYSTEM = re.compile(r"(dirent|dlfcn|fcntl|poll|sched|spawn|unistd|sys/\w+)\.h")


def files(folder):
    return sorted(path for path in (ROOT / folder).rglob("*") if path.suffix in (".cpp", ".hpp", ".h", ".c", ".in"))


def includes(path):
    """Returns pairs (angle or quote, header)."""
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def is_standard(header):
    return re.fullmatch(r"[a-z_]+|std\w+\.h|string\.h", header) is not None


def test_public_headers_include_public_and_standard_headers_only():
    wrong = [f"{path.name}: {header}" for path in files("include") for kind, header in includes(path)
             if kind != "<" or not (header.startswith("meshorder/") or is_standard(header))
             and (path.name, header) not in OF_OTHERS]
    assert not wrong


def test_every_public_header_that_is_included_exists():
    there = {str(path.relative_to(ROOT / "include")).removesuffix(".in") for path in files("include")}
    wrong = [f"{path}: {header}" for top in ("include", "src", "lab", "apps", "examples", "plugins")
             for path in files(top) for kind, header in includes(path)
             if kind == "<" and header.startswith("meshorder") and header not in there | OF_PLUGINS]
    assert not wrong


def test_every_folder_of_src_has_a_row():
    assert {path.name for path in (ROOT / "src").iterdir() if path.is_dir()} == set(LAYERS)


@pytest.mark.parametrize("layer", LAYERS)
def test_layer_includes_only_those_below(layer):
    wrong = []
    for path in files(f"src/{layer}"):
        for kind, header in includes(path):
            first = header.split("/")[0]
            if kind == '"':
                fine = (ROOT / "src" / header).exists() and (first == layer or first in LAYERS[layer])
            elif first in LIBRARIES:
                fine = layer in LIBRARIES[first]
            else:
                fine = header.startswith("meshorder") or is_standard(header) or SYSTEM.fullmatch(header)
            if not fine:
                wrong.append(f"{path.relative_to(ROOT)}: {header}")
    assert not wrong


def test_plugins_include_public_headers_and_their_solver_s():
    """A header beside a plugin's source may be generated from a .py file, as for DOLFINx's forms."""
    wrong = [f"{path.relative_to(ROOT)}: {header}" for host, beginnings in HOSTS.items()
             for path in files(f"plugins/{host}") for kind, header in includes(path)
             if not (header.startswith(("meshorder", *beginnings)) or is_standard(header) if kind == "<"
                     else any((path.parent / header).with_suffix(suffix).exists() for suffix in (".h", ".hpp", ".py")))]
    assert not wrong
    assert {path.name for path in (ROOT / "plugins").iterdir() if path.is_dir()} == set(HOSTS)


def test_folders_of_distributed_include_those_before_them():
    order = ["comm", "order", "files"]
    wrong = [f"{path.relative_to(ROOT)}: {header}" for number, name in enumerate(order)
             for path in files(f"src/distributed/{name}") for kind, header in includes(path)
             if kind == '"' and header.startswith("distributed/") and header.split("/")[1] not in order[:number + 1]]
    assert not wrong
    assert {path.name for path in (ROOT / "src/distributed").iterdir()} == set(order)


@pytest.mark.parametrize("folder, above", [("src", ("lab/", "apps/", "tests/")), ("lab", ("apps/", "tests/"))])
def test_nothing_below_includes_what_is_above(folder, above):
    def target(path, header):
        beside = (path.parent / header).resolve()
        return str(beside.relative_to(ROOT)) if beside.exists() and ROOT in beside.parents else header

    wrong = [f"{path.relative_to(ROOT)}: {header}" for path in files(folder) for kind, header in includes(path)
             if kind == '"' and target(path, header).startswith(above)]
    assert not wrong


# calls that open a file for reading, and the sources that may contain them: the common opener, and sources that query
# the system, lock a file, check a file just written by the same process, or open folders to allow or clean them
OPENING = re.compile(r"\b(ifstream|fopen|freopen)\b|(?<!\w)::open(at)?\(")
MAY_OPEN = {
    "src/base/input_file.cpp", "src/io/stream/descriptor.cpp", "src/base/memory.cpp", "src/base/host.cpp",
    "src/payoff/machine.cpp", "lab/support/machine.cpp", "lab/study/folder_lock.cpp", "lab/study/study_turns.cpp", "lab/models/cache.cpp",
    "apps/meshorder/standard_streams.cpp", "apps/meshorder-models/surface.cpp",
    "apps/meshorder/output_deputy.cpp", "apps/meshorder/restrictions.cpp", "src/io/stream/scratch.cpp",
    "apps/meshorder/trial_program.cpp",
}


def test_files_are_opened_in_one_place():
    found = {str(path.relative_to(ROOT)) for top in ("src", "lab", "apps") for path in files(top)
             if OPENING.search(re.sub(r"//.*", "", path.read_text(encoding="utf-8")))}
    assert found <= MAY_OPEN
