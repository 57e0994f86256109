# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The source distribution, and the wheel that ./test made."""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile

import meshorder
import pytest
from meshorder import _command, _core

ROOT = pathlib.Path(__file__).parents[2]
MEBIBYTE = 1 << 20
#: libraries that exist on every machine for which wheels are made
SYSTEMS = {"libstdc++", "libgcc_s", "libm", "libc", "libpthread", "libdl", "librt", "ld-linux-x86-64"}
#: the other libraries' names in THIRD_PARTY.md
NAMES = {
    "libtbb": "oneTBB", "libmetis": "METIS", "libz": "zlib", "liblzma": "XZ Utils", "liblz4": "LZ4", "libfmt": "{fmt}",
    "libhwy": "Highway", "libnetcdf": "netCDF", "libhdf5_serial": "HDF5", "libhdf5": "HDF5", "libpugixml": "pugixml", "libcgns": "CGNS",
}  # fmt: skip

of_sources = pytest.mark.skipif(not (ROOT / ".git").exists(), reason="not a checkout of the sources")


def wheel():
    found = sorted((ROOT / "build" / "wheel").glob("meshorder-*.whl"))
    if not found:
        pytest.skip("./test has made no wheel")
    return found[-1]


@pytest.fixture(scope="module")
def sdist(tmp_path_factory):
    pytest.importorskip("scikit_build_core")
    folder = tmp_path_factory.mktemp("sdist")
    program = f"from scikit_build_core.build import build_sdist; build_sdist({str(folder)!r})"
    subprocess.run([sys.executable, "-c", program], cwd=ROOT, check=True, capture_output=True)
    return next(folder.iterdir())


@of_sources
def test_sdist_holds_what_the_wheel_is_made_of(sdist):
    with tarfile.open(sdist) as archive:
        found = {name.partition("/")[2] for name in archive.getnames()}
    listed = ["CHANGELOG.md", "CITATION.cff", "CMakeLists.txt", "LICENSE", "README.md", "pyproject.toml"]
    listed += ["apps/meshorder", "cmake", "include", "packaging/sbom.py", "python", "src", "viewer"]
    tracked = subprocess.run(["git", "ls-files", *listed], cwd=ROOT, capture_output=True, text=True, check=True)
    assert set(tracked.stdout.split()) <= found
    # the distribution may contain untracked files, but no build products
    assert all(name.startswith((*listed, "PKG-INFO")) for name in found)
    assert not [name for name in found if re.search(r"\.(so|pyc|pyi|o)$", name)]


def test_wheel_is_complete():
    with zipfile.ZipFile(wheel()) as archive:
        entries = {entry.filename: entry for entry in archive.infolist()}
    licences = {name.rpartition("/")[2] for name in entries if "/licenses/" in name}
    assert licences == {"LICENSE", "THIRD_PARTY.md", "Apache-2.0.txt", "LGPL-2.1.txt", "MPL-2.0.txt"}
    assert {"meshorder/py.typed", "meshorder/_core.pyi"} <= entries.keys()
    assert entries["meshorder/bin/meshorder"].external_attr >> 16 & 0o111
    assert not [name for name in entries if not name.startswith(("meshorder/", "meshorder-"))]
    assert wheel().stat().st_size <= 6.7 * MEBIBYTE


def test_list_of_what_is_inside_names_every_library():
    """The wheel's SBOM is valid, has a version of each library that the binaries need, and lists none that the notice lacks."""
    validation = pytest.importorskip("cyclonedx.validation.json")
    schema = pytest.importorskip("cyclonedx.schema")
    with zipfile.ZipFile(wheel()) as archive:
        [name] = [name for name in archive.namelist() if name.endswith(".dist-info/sboms/meshorder.cdx.json")]
        text = archive.read(name).decode()
    assert validation.JsonStrictValidator(schema.SchemaVersion.V1_5).validate_str(text) is None
    made_of = {component["name"]: component["version"] for component in json.loads(text)["components"]}
    assert {"nanobind", "Eigen", "CLI11", "JSON for Modern C++"} <= made_of.keys()
    assert all(re.match(r"r?\d", version) for version in made_of.values()), made_of
    notice = (ROOT / "python" / "licenses" / "THIRD_PARTY.md").read_text()
    assert not [name for name in made_of if f"| {name} |" not in notice and name != "three.js"]
    for file in (_core.__file__, _command.program()):
        for library in needed_by(file):
            assert any(name.startswith(NAMES[library]) for name in made_of), library


def needed_by(file):
    """The shared libraries that a binary needs, without the system's."""
    if not shutil.which("readelf"):
        pytest.skip("there is no readelf")
    text = subprocess.run(["readelf", "-d", file], capture_output=True, text=True, check=True).stdout
    # auditwheel adds a part of the hash to the names of the libraries that it bundles
    return {re.sub(r"-[0-9a-f]{8}$", "", name) for name in re.findall(r"NEEDED.*\[([^\].]+)", text)} - SYSTEMS


def test_notice_names_every_library():
    notice = (ROOT / "python" / "licenses" / "THIRD_PARTY.md").read_text()
    for file in (_core.__file__, _command.program()):
        for name in needed_by(file):
            assert f"| {NAMES[name]}" in notice


@pytest.mark.filterwarnings("ignore")
def test_the_index_takes_both(sdist):
    pytest.importorskip("twine")
    files = [sdist, *(ROOT / "build" / "wheel").glob("meshorder-*.whl")]
    done = subprocess.run([sys.executable, "-m", "twine", "check", "--strict", *files], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    # relative links do not work on the package index
    page = (ROOT / "python" / "README.md").read_text()
    assert all(target.startswith("https://") for target in re.findall(r"\]\(([^)]*)\)", page))


@of_sources
def test_all_name_one_version():
    version = meshorder.__version__
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    assert f"Version {version}}}" in (ROOT / "docs" / "start.md").read_text()


@of_sources
def test_oldest_versions_are_those_that_the_package_allows():
    tomllib = pytest.importorskip("tomllib")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needed = [*project["dependencies"], *project["optional-dependencies"]["all"]]
    allowed = dict(re.findall(r"^([\w-]+)>=([\d.]+)", "\n".join(needed), re.M))
    pinned = dict(re.findall(r"^([\w-]+)==([\d.]+)", (ROOT / "python/tests/requirements-oldest.txt").read_text(), re.M))
    for name, version in allowed.items():
        if name in pinned:
            assert pinned[name].removesuffix(".0") == version.removesuffix(".0")
    assert "numpy" in pinned
