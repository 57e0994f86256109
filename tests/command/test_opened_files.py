# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The command opens only the files that docs/limits.md names, in whatever folder it runs. The interposer of tests/faults
lists them; its source says which it does not see."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import time

import netCDF4
import numpy
import pytest

import conftest
import meshes

INTERPOSER = pathlib.Path(conftest.MESHORDER).resolve().parents[1] / "lib" / "libmeshorder_faults.so"
SYSTEM = re.compile(r"/(proc|sys|usr/lib|usr/share|lib|lib64|etc/ld\.so)\b|/dev/(null|urandom)$")
SETTINGS = (".ncrc", ".daprc", ".dodsrc", ".netrc", ".aws/config", ".aws/credentials", "mesh", "cgns.rc")
SURFACE = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"
MATRIX = "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 1\n2 1 1\n2 2 1\n3 2 1\n3 3 1\n"
LIST_OF_PIECES = ('<VTKFile type="PUnstructuredGrid" version="0.1"><PUnstructuredGrid><PPoints>'
                  '<PDataArray type="Float64" NumberOfComponents="3"/></PPoints><Piece Source="m.vtu"/>'
                  '</PUnstructuredGrid></VTKFile>')
FAR_TOO_LONG = 20  # seconds


class Traced:
    """Runs the command in a folder of settings that it must not read, with the mesh in another one."""

    def __init__(self, folder):
        places = [folder / name for name in ("meshes", "here", "home", "cache", "tmp")]
        self.meshes, self.here, self.home, self.cache, self.tmp = places
        self.log = folder / "opened"
        for place in places:
            place.mkdir()
        for place in (self.here, self.home):
            (place / ".aws").mkdir()
            for name in SETTINGS:
                (place / name).write_text("[default]\n")

    def run(self, *arguments, program=conftest.MESHORDER):
        self.log.write_text("")
        environment = {**os.environ, "LD_PRELOAD": str(INTERPOSER), "FAULTS_OPENED": str(self.log), "HOME": str(self.home),
                       "MESHORDER_CACHE": str(self.cache), "TMPDIR": str(self.tmp)}
        return subprocess.run([program, *map(str, arguments)], cwd=self.here, env=environment, capture_output=True,
                              text=True, stdin=subprocess.DEVNULL, timeout=600, check=False)

    def strangers(self):
        """Other files that the last run opened: not the system's, not beside the mesh, no cache, no temporary files."""
        opened = set(self.log.read_text(errors="replace").splitlines())
        assert any(path.startswith(str(self.meshes)) for path in opened), opened
        own = (f"{self.meshes}/", f"{self.cache}/", f"{self.tmp}/", "/dev/shm/", "/memfd:", "pipe:", "socket:")
        return {path for path in opened if not path.startswith(own) and path != str(self.meshes) and not SYSTEM.match(path)}


@pytest.fixture
def traced(tmp_path):
    return Traced(tmp_path)


def extensions():
    """All extensions of files that this build reads."""
    done = subprocess.run([conftest.MESHORDER, "info", "x.unknown"], capture_output=True, text=True, check=False)
    return re.search(r"; known: ([^;]*);", done.stderr).group(1).split()


def write_sample(traced, extension):
    """Writes m.EXT: tetrahedra, or else a surface, or else a matrix."""
    path = traced.meshes / f"m{extension}"
    if extension == ".pvtu":
        write_sample(traced, ".vtu")
        path.write_text(LIST_OF_PIECES)
        return path
    if extension in (".face", ".edge"):  # TetGen writes these beside other files
        meshes.write_tetgen(traced.meshes, "m")
        path.write_text("1 0\n1 1 2 3\n" if extension == ".face" else "1 0\n1 1 2\n")
        return path
    (traced.meshes / "surface.off").write_text(SURFACE)
    (traced.meshes / "matrix.mtx").write_text(MATRIX)
    sources = [meshes.write_tetgen(traced.meshes, "volume"), traced.meshes / "surface.off", traced.meshes / "matrix.mtx"]
    faults = []
    for source in sources:
        done = traced.run("order", source, "-o", path, "-q")
        if done.returncode == 0:
            return path
        faults.append(done.stderr)
    raise AssertionError(faults)


@pytest.mark.parametrize("extension", extensions())
def test_a_reader_opens_nothing_but_the_mesh(traced, extension):
    path, written = write_sample(traced, extension), ".vtu" if extension == ".pvtu" else extension
    runs = {"info": ["info", path], "order": ["order", path, "-o", traced.meshes / f"o{written}", "--maps", traced.meshes / "p"],
            "apply": ["apply", traced.meshes / "p", path, "-o", traced.meshes / f"q{written}"]}
    for name, arguments in runs.items():
        done = traced.run(*arguments, "-q")
        assert done.returncode == 0, done.stderr
        assert traced.strangers() == set(), name


def test_a_report_on_meshes_of_all_formats_opens_nothing_else(traced):
    by_the_same_readers = {".ele", ".face", ".edge", ".avs", ".nas", ".fem", ".uff", ".e", ".ex2", ".g", ".xmf", ".vtu"}
    paths = [write_sample(traced, extension) for extension in extensions()
             if extension not in by_the_same_readers]
    done = traced.run("report", *paths, "-o", traced.meshes / "page.html", "--budget", "0.01", "-q",
                      program=f"{conftest.MESHORDER}-lab")
    assert done.returncode == 0, done.stderr
    assert traced.strangers() == set()


def test_the_list_of_opened_files_has_those_that_are_opened(traced):
    """Otherwise the test above could pass because the interposer misses files."""
    (traced.here / "a.off").write_text(SURFACE)
    (traced.meshes / "a.off").write_text(SURFACE)
    assert traced.run("info", "a.off", "-q").returncode == 0
    traced.log.write_text(traced.log.read_text() + f"{traced.meshes}/a.off\n")
    assert traced.strangers() == {str(traced.here / "a.off")}


# ---- settings of libnetcdf

@pytest.mark.parametrize("kind", ["pipe", "long line", "escape"])
def test_settings_of_netcdf_in_the_current_folder_are_not_read(traced, kind):
    path = write_sample(traced, ".exo")
    for name in (".ncrc", ".dodsrc", ".daprc"):
        (traced.here / name).unlink()
        if kind == "pipe":
            os.mkfifo(traced.here / name)
        else:
            (traced.here / name).write_text("[" + "A" * 3000000 + "]" if kind == "long line" else "[\033]0;x\007\033[31mRED\n")
    done = subprocess.run([conftest.MESHORDER, "info", str(path), "-q"], cwd=traced.here, capture_output=True, text=True,
                          timeout=FAR_TOO_LONG, check=False)
    assert done.returncode == 0 and "\033" not in done.stdout + done.stderr


# ---- references to other files that HDF5 and netCDF would follow

def exodus(path):
    """One tetrahedron in a file of netCDF-4."""
    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts({"api_version": numpy.float32(5), "version": numpy.float32(5), "floating_point_word_size": 8,
                        "file_size": 1, "title": "t"})
        for name, length in {"num_dim": 3, "num_nodes": 4, "num_elem": 1, "num_el_blk": 1, "num_el_in_blk1": 1,
                             "num_nod_per_el1": 4}.items():
            file.createDimension(name, length)
        for axis, values in {"x": [0, 1, 0, 0], "y": [0, 0, 1, 0], "z": [0, 0, 0, 1]}.items():
            file.createVariable(f"coord{axis}", "f8", ("num_nodes",))[:] = values
        file.createVariable("eb_prop1", "i4", ("num_el_blk",)).setncattr("name", "ID")
        file["eb_prop1"][:] = 1
        connectivity = file.createVariable("connect1", "i4", ("num_el_in_blk1", "num_nod_per_el1"))
        connectivity.setncattr("elem_type", "TETRA")
        connectivity[:] = [[1, 2, 3, 4]]
    return path


@pytest.mark.parametrize("kind", ["link", "external", "virtual", "group"])
def test_an_exodus_file_that_leads_to_others_is_refused(traced, kind):
    h5py = pytest.importorskip("h5py")
    path = exodus(traced.meshes / "m.exo")
    assert traced.run("info", path, "-q").returncode == 0
    with h5py.File(traced.here / "secret.h5", "w") as secret:
        secret["x"] = numpy.arange(4.0)
    (traced.here / "raw").write_bytes(bytes(32))
    with h5py.File(path, "a") as file:
        if kind == "link":
            file["vals"] = h5py.ExternalLink(str(traced.here / "secret.h5"), "/x")
        elif kind == "external":
            file.create_dataset("vals", (4,), "f8", external=[(str(traced.here / "raw"), 0, 32)])
        elif kind == "virtual":
            layout = h5py.VirtualLayout((4,), "f8")
            layout[:] = h5py.VirtualSource(str(traced.here / "secret.h5"), "x", (4,))
            file.create_virtual_dataset("vals", layout)
        else:
            file.create_group("vals")["inner"] = h5py.ExternalLink(str(traced.here / "secret.h5"), "/x")
    done = traced.run("info", path, "-q")
    assert done.returncode == 2 and "m.exo: 'vals' " in done.stderr
    assert traced.strangers() == set()


# ---- pipes, devices and links where the user named a folder or a prefix

SHAPES = {"pipe": lambda path: os.mkfifo(path), "device": lambda path: path.symlink_to("/dev/zero"),
          "outside": lambda path: path.symlink_to("/etc/hostname")}


@pytest.fixture(params=SHAPES)
def plant(request):
    """Replaces a file by a pipe, a link to a device or a link to a file elsewhere."""

    def replace(path):
        path.unlink(missing_ok=True)
        SHAPES[request.param](path)

    return replace


def refused(command, *arguments, **options):
    """Runs a command that must fail soon, with little memory, and returns its line of error."""
    begun = time.monotonic()
    done = subprocess.run(["prlimit", f"--as={4 << 30}", conftest.MESHORDER, *map(str, arguments)], cwd=command.folder,
                          capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=FAR_TOO_LONG, check=False, **options)
    assert done.returncode == 2, done.stderr
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1 and time.monotonic() - begun < FAR_TOO_LONG
    return lines[0]


@pytest.mark.parametrize("name", ["m.maps.json", "m.vertices.old_to_new.npy", "m.cells.old_to_new.npy"])
def test_maps(command, tmp_path, plant, name):
    meshes.write_tetgen(tmp_path)
    command.ok("order", "mesh.node", "-o", "o.node", "--maps", "m")
    plant(tmp_path / name)
    assert re.search(rf"{name}: (is a pipe|is outside the folder)", refused(command, "apply", "m", "mesh.node", "-o", "p.node"))
    assert not (tmp_path / "p.node").exists()


def test_companions(command, tmp_path, plant):
    meshes.write_tetgen(tmp_path)
    plant(tmp_path / "mesh.ele")
    assert re.search(r"mesh.ele: (is a pipe|is outside the folder)", refused(command, "info", "mesh.node"))


def test_companions_of_allowed_folders(command, tmp_path):
    (tmp_path / "store").mkdir()
    (tmp_path / "d").mkdir()
    meshes.write_tetgen(tmp_path / "store")
    for name in ("mesh.node", "mesh.ele"):
        (tmp_path / "d" / name).symlink_to(tmp_path / "store" / name)
    assert "mesh.ele: is outside the folder" in command.fails("info", "d/mesh.node")
    command.ok("info", "d/mesh.node", "--allow-includes-from", "store")


def test_files_of_openfoam(command, tmp_path, plant):
    folder = tmp_path / "case" / "constant" / "polyMesh"
    folder.mkdir(parents=True)
    (tmp_path / "case" / "system").mkdir()
    for name, numbers in {"owner": "7(0 0 0 1 1 0 1)", "neighbour": "1(1)"}.items():
        (folder / name).write_text("FoamFile { version 2.0; format ascii; class labelList; object x; }\n" + numbers + "\n")
    (folder / "boundary").write_text("FoamFile { class polyBoundaryMesh; }\n1(a { nFaces 6; startFace 1; })\n")
    for name in ("points", "faces"):
        (folder / name).write_text("unread")
    command.ok("openfoam", "case", "--cells", "fiedler")
    plant(folder / "owner")
    assert re.search(r"owner: (is a pipe|is outside the folder)", refused(command, "openfoam", "case", "--cells", "fiedler"))


def test_a_pipe_without_a_writer_is_not_waited_for(command, tmp_path):
    os.mkfifo(tmp_path / "a.off")
    assert "a.off: is a pipe that nobody writes to" in refused(command, "info", "a.off")
    os.mkfifo(tmp_path / "c")
    assert "c: is a pipe that nobody writes to" in refused(command, "simulate", "falling", "--mesh", "grid-2", "--resume", "c")
    with subprocess.Popen(["sh", "-c", f"sleep 1; printf '{SURFACE}' > a.off"], cwd=tmp_path):
        assert command.json("info", "a.off")["vertices"] == 4


# ---- names in scenarios and studies

@pytest.fixture
def scenario(command, tmp_path):
    """Writes a scenario and runs it; returns the printed error."""
    text = json.loads((conftest.ROOT / "scenarios" / "falling.json").read_text())

    def run(mesh, *options):
        (tmp_path / "s").mkdir(exist_ok=True)
        (tmp_path / "s" / "s.json").write_text(json.dumps({**text, "mesh": str(mesh), "steps": 1}))
        return command.run("simulate", "s/s.json", "-q", *options)

    return run


def test_the_mesh_of_a_scenario_is_below_its_folder(scenario, tmp_path, model):
    (tmp_path / "s").mkdir()
    for place in (tmp_path, tmp_path / "s"):
        for end in (".node", ".ele"):
            shutil.copy(pathlib.Path(model("grid-2")).with_suffix(end), place / f"g{end}")
    assert scenario("g.node").returncode == 0
    for mesh in ("../g.node", tmp_path / "g.node"):
        done = scenario(mesh)
        assert done.returncode == 2 and "g.node: is outside the folder" in done.stderr
        assert scenario(mesh, "--allow-includes-from", ".").returncode == 0
    assert scenario("none.node", "--mesh", "g.node").returncode == 0


STUDY = conftest.ROOT / "docs" / "reproduction"


@pytest.mark.parametrize("of", ["meshes", "scenarios", "orderings"])
def test_names_of_a_study_stay_in_its_folder(command, tmp_path, of):
    results = (STUDY / "results.json").read_text()
    name = json.loads(results)[of][0]["name"]
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "results.json").write_text(results.replace(f'"{name}"', '"../../b"'))
    assert "'../../b' contains a slash; leave it out" in command.fails("report", "study")
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["results.json", "study"]


def test_files_of_a_study(command, tmp_path, plant):
    (tmp_path / "study").mkdir()
    plant(tmp_path / "study" / "results.json")
    assert re.search(r"results.json: (is a pipe|is outside the folder)", refused(command, "report", "study"))
