# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Writes what the programs of a build are made of, as CycloneDX 1.5 in JSON.

A library is named if one of its headers was read while the build compiled: Ninja has noted them. Its version is what that
header says. The same build gives the same bytes.

    sbom.py BUILD VERSION OUTPUT [--three FILE]
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
import re
import subprocess
import uuid
from typing import Any, NamedTuple

SOURCES = pathlib.Path(__file__).resolve().parents[1]
OWN = [SOURCES / folder for folder in ("apps", "include", "lab", "plugins", "python", "src")]


class Library(NamedTuple):
    """A library of others.

    Attributes:
        name: as python/licenses/THIRD_PARTY.md has it.
        headers: what the path of any of its headers contains.
        version_file: the header that tells the version, from the folder that `headers` begins in.
        macros: the macros of the version's numbers, or the one of the version itself.
        licence: an SPDX expression.
        site: where it is from.
    """

    name: str
    headers: str
    version_file: str
    macros: tuple[str, ...]
    licence: str
    site: str


def numbers(prefix: str, *endings: str) -> tuple[str, ...]:
    return tuple(prefix + ending for ending in endings)


VERSION = ("MAJOR", "MINOR", "PATCH")
LIBRARIES = [
    Library("oneTBB", "/oneapi/tbb/", "oneapi/tbb/version.h", numbers("TBB_VERSION_", "MAJOR", "MINOR", "PATCH"),
            "Apache-2.0", "https://github.com/oneapi-src/oneTBB"),
    Library("Eigen", "/Eigen/src/Core/", "Eigen/src/Core/util/Macros.h",
            ("EIGEN_WORLD_VERSION", "EIGEN_MAJOR_VERSION", "EIGEN_MINOR_VERSION"), "MPL-2.0", "https://eigen.tuxfamily.org"),
    Library("Highway", "/hwy/", "hwy/highway.h", numbers("HWY_", *VERSION), "Apache-2.0 OR BSD-3-Clause",
            "https://github.com/google/highway"),
    Library("{fmt}", "/fmt/", "fmt/core.h", ("FMT_VERSION",), "MIT", "https://fmt.dev"),
    Library("CLI11", "/CLI/", "CLI/Version.hpp", numbers("CLI11_VERSION_", *VERSION), "BSD-3-Clause",
            "https://github.com/CLIUtils/CLI11"),
    Library("JSON for Modern C++", "/nlohmann/", "nlohmann/detail/abi_macros.hpp",
            numbers("NLOHMANN_JSON_VERSION_", *VERSION), "MIT", "https://json.nlohmann.me"),
    Library("METIS, with GKlib", "/metis.h", "metis.h", numbers("METIS_VER_", "MAJOR", "MINOR", "SUBMINOR"),
            "Apache-2.0", "https://github.com/KarypisLab/METIS"),
    Library("zlib", "/zlib.h", "zlib.h", ("ZLIB_VERSION",), "Zlib", "https://zlib.net"),
    Library("LZ4", "/lz4.h", "lz4.h", numbers("LZ4_VERSION_", "MAJOR", "MINOR", "RELEASE"), "BSD-2-Clause",
            "https://lz4.org"),
    Library("XZ Utils (liblzma)", "/lzma/", "lzma/version.h", numbers("LZMA_VERSION_", *VERSION),
            "LicenseRef-public-domain", "https://tukaani.org/xz"),
    Library("netCDF", "/netcdf.h", "netcdf_meta.h", numbers("NC_VERSION_", *VERSION), "BSD-3-Clause",
            "https://www.unidata.ucar.edu/software/netcdf"),
    Library("HDF5", "/H5public.h", "H5public.h", numbers("H5_VERS_", "MAJOR", "MINOR", "RELEASE"), "BSD-3-Clause",
            "https://www.hdfgroup.org/solutions/hdf5"),
    Library("CGNS", "/cgns_io.h", "cgnslib.h", ("CGNS_DOTVERS",), "Zlib", "https://cgns.github.io"),
    Library("pugixml", "/pugixml.hpp", "pugixml.hpp", ("PUGIXML_VERSION",), "MIT", "https://pugixml.org"),
    Library("meshoptimizer", "/meshoptimizer.h", "meshoptimizer.h", ("MESHOPTIMIZER_VERSION",), "MIT",
            "https://github.com/zeux/meshoptimizer"),
    Library("CHOLMOD", "/cholmod.h", "cholmod_core.h", numbers("CHOLMOD_", "MAIN_VERSION", "SUB_VERSION", "SUBSUB_VERSION"),
            "LGPL-2.1-or-later", "https://github.com/DrTimothyAldenDavis/SuiteSparse"),
    Library("nanobind", "/include/nanobind/", "include/nanobind/nanobind.h", numbers("NB_VERSION_", *VERSION), "BSD-3-Clause",
            "https://github.com/wjakob/nanobind"),
    Library("robin-map", "/tsl/", "tsl/robin_growth_policy.h", numbers("TSL_RH_VERSION_", *VERSION), "MIT",
            "https://github.com/Tessil/robin-map"),
]  # fmt: skip


def headers_of(build: pathlib.Path) -> set[str]:
    """The headers of others that Ninja knows of, some of them as ccache names them, from the build; `-n`, as Ninja may be
    running this."""
    told = subprocess.run(["ninja", "-n", "-C", build, "-t", "deps"], capture_output=True, text=True, check=True).stdout
    paths = {pathlib.Path(os.path.normpath(build / line.strip())) for line in told.splitlines() if line.startswith("    ")}
    return {str(path) for path in paths if not any(path.is_relative_to(folder) for folder in OWN)}


def version_in(text: str, macros: tuple[str, ...]) -> str:
    """The version that a header's macros give, "" where it has none of them."""
    found = [re.search(rf'#\s*define\s+{macro}\s+"?([\w.]+)', text) for macro in macros]
    parts = [match[1] for match in found if match]
    if len(macros) == 1 and parts and parts[0].isdigit():  # 90100 is 9.1.0, 1130 is 1.13, 180 is 0.18
        number = int(parts[0])
        if number >= 10000:
            return f"{number // 10000}.{number // 100 % 100}.{number % 100}"
        return f"{number // 1000}.{number // 10 % 100}"
    return ".".join(parts)


def component_of(library: Library, headers: set[str]) -> dict[str, Any] | None:
    own = sorted(path for path in headers if library.headers in path)
    if not own:
        return None
    folder = own[0][: own[0].index(library.headers) + 1]
    file = pathlib.Path(folder) / library.version_file
    version = version_in(file.read_text(encoding="utf-8", errors="replace"), library.macros) if file.exists() else ""
    return described(library.name, version, library.licence, library.site)


def described(name: str, version: str, licence: str, site: str) -> dict[str, Any]:
    return {
        "type": "library", "bom-ref": name, "name": name, "version": version or "unknown",
        "licenses": [{"expression": licence}], "externalReferences": [{"type": "website", "url": site}],
    }  # fmt: skip


def document(version: str, components: list[dict[str, Any]]) -> dict[str, Any]:
    own = {"type": "application", "bom-ref": "meshorder", "name": "meshorder", "version": version,
           "licenses": [{"expression": "MIT"}]}  # fmt: skip
    names = [component["bom-ref"] for component in components]
    number = uuid.uuid5(uuid.NAMESPACE_URL, json.dumps([own, components], sort_keys=True))
    return {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "serialNumber": f"urn:uuid:{number}", "version": 1,
        "metadata": {"component": own}, "components": components,
        "dependencies": [{"ref": "meshorder", "dependsOn": names}, *({"ref": name} for name in names)],
    }  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description="Writes what the programs of a build are made of")
    parser.add_argument("build", type=pathlib.Path, help="a folder in which Ninja has built")
    parser.add_argument("version", help="of meshorder")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--three", type=pathlib.Path, help="three.min.js, where the build has it inside")
    given = parser.parse_args()
    headers = headers_of(given.build)
    components = [made for made in (component_of(library, headers) for library in LIBRARIES) if made]
    if given.three:
        found = re.search(r'REVISION ?= ?"(\d+)"', given.three.read_text(encoding="utf-8", errors="replace"))
        components.append(described("three.js", f"r{found[1]}" if found else "", "MIT", "https://threejs.org"))
    given.output.write_text(json.dumps(document(given.version, components), indent=1, ensure_ascii=False) + "\n",
                            encoding="utf-8")  # fmt: skip


if __name__ == "__main__":
    main()
