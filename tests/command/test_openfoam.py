# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`meshorder openfoam`, judged by SciPy and, where it is installed, by OpenFOAM itself."""
import gzip
import json
import resource
import shlex
import shutil
import struct

import numpy
import pytest
import scipy.sparse.csgraph

import foam_cases

needs_openfoam = pytest.mark.skipif(not foam_cases.has_openfoam(), reason="needs OpenFOAM")


@pytest.fixture
def case(tmp_path):
    """A block of cells in a random order."""
    return foam_cases.write_case(tmp_path / "case", foam_cases.shuffled(foam_cases.block(6, 5, 4), seed=3))


def moved(matrix, new_to_old):
    return matrix[new_to_old][:, new_to_old]


@pytest.mark.parametrize("method", ["auto", "rcm", "hilbert", "spectral", "scrambled"])
def test_the_figures_are_those_of_the_matrix(command, case, method):
    result = command.json("openfoam", "case", "--cells", method)
    (mesh,) = result["meshes"]
    matrix = foam_cases.graph(case / "constant" / "polyMesh")
    new_to_old = foam_cases.read_labels(case / "constant" / "cellOrder")
    assert sorted(new_to_old) == list(range(120)) == list(range(mesh["cells"]))
    assert mesh["internal_faces"] == matrix.nnz / 2
    for when, ordered in (("before", matrix), ("after", moved(matrix, new_to_old))):
        band, profile, span = foam_cases.figures(ordered)
        assert mesh["edge_span"][when]["max"] == band
        assert mesh["profile"][when] == profile
        assert mesh["edge_span"][when]["mean"] == pytest.approx(span)


def test_auto_takes_an_order_as_narrow_as_scipys(command, case):
    (mesh,) = command.json("openfoam", "case")["meshes"]
    assert (mesh["method"], mesh["chosen_by"], mesh["kept"]) == ("rcm", "auto", False)
    matrix = foam_cases.graph(case / "constant" / "polyMesh")
    scipys = scipy.sparse.csgraph.reverse_cuthill_mckee(matrix, symmetric_mode=True)
    assert mesh["edge_span"]["after"]["max"] <= 1.1 * foam_cases.figures(moved(matrix, scipys))[0]


def test_hilbert_goes_through_the_centres(command, case):
    """Most steps of the curve lead to a cell that shares a face."""
    command.ok("openfoam", "case", "--cells", "hilbert")
    new_to_old = foam_cases.read_labels(case / "constant" / "cellOrder")
    centres = foam_cases.centres(case / "constant" / "polyMesh")
    steps = numpy.linalg.norm(numpy.diff(centres[new_to_old], axis=0), axis=1)
    assert steps.mean() < 0.6 * numpy.linalg.norm(numpy.diff(centres, axis=0), axis=1).mean()


def test_an_order_that_cannot_be_improved_is_kept(command, tmp_path):
    foam_cases.write_case(tmp_path / "channel", foam_cases.block(1, 1, 30))
    result = command.json("openfoam", "channel")
    (mesh,) = result["meshes"]
    assert mesh["kept"] and mesh["method"] == "original" and "rcm is no better" in mesh["because"]
    assert result["next"] is None
    assert list(foam_cases.read_labels(tmp_path / "channel" / "constant" / "cellOrder")) == list(range(30))
    text = command.ok("openfoam", "channel").stdout
    assert "next       nothing: all cells stay where they are" in text
    done = command.ok("openfoam", "channel", "--cells", "rcm")
    assert "warning: rcm is no better" in done.stderr and "--cells original" in done.stderr


def test_it_says_what_to_do_next(command, case):
    text = command.ok("openfoam", "case").stdout
    assert all(len(line) <= 100 for line in text.splitlines())
    assert "next       renumberMesh -case case -overwrite -dict system/renumberMeshDict\n" in text
    case.rename(case.with_name("my case"))
    words = shlex.split(command.json("openfoam", "my case", "--time", "constant")["next"])
    assert words[:3] == ["renumberMesh", "-case", "my case"]


def test_a_dry_run_writes_nothing(command, case):
    before = foam_cases.folder_files(case)
    result = command.json("openfoam", "case", "--dry-run")
    assert result["files"] == [] and result["next"] is None and result["meshes"][0]["map"] is None
    assert "next" not in command.ok("openfoam", "case", "--dry-run").stdout
    assert foam_cases.folder_files(case) == before


def test_a_users_dictionary_stays(command, case):
    dictionary = case / "system" / "renumberMeshDict"
    command.ok("openfoam", "case")
    own = dictionary.read_text()
    assert command.ok("openfoam", "case").stderr == "" and dictionary.read_text() == own

    users = foam_cases.header("dictionary", "renumberMeshDict") + "method CuthillMcKee;\nblockSize 100;\n"
    dictionary.write_text(users)
    done = command.ok("openfoam", "case")
    assert len(done.stderr.splitlines()) == 1
    assert 'put `writeMaps false; method manual; manualCoeffs { dataFile "cellOrder"; }` into it' in done.stderr
    assert dictionary.read_text() == users
    result = command.json("openfoam", "case")
    assert result["next"] == (f"change case/system/renumberMeshDict, which requests another order; then renumberMesh "
                              "-case case -overwrite -dict system/renumberMeshDict")
    assert "next       " + result["next"] in done.stdout
    assert command.ok("openfoam", "case", "--force").stderr == "" and dictionary.read_text() == own
    # a dictionary that asks for the order keeps its other settings
    users = own + "sortCoupledFaceCells true;\n"
    dictionary.write_text(users)
    assert command.ok("openfoam", "case").stderr == "" and dictionary.read_text() == users


def test_compressed_and_binary_files_are_the_same_mesh(command, case):
    command.ok("openfoam", "case", "--cells", "hilbert")
    expected = (case / "constant" / "cellOrder").read_text()
    folder = case / "constant" / "polyMesh"
    text = {name: (folder / name).read_text() for name in ("owner", "neighbour", "points", "faces")}
    for name, content in text.items():
        half = len(content) // 2
        (folder / name).unlink()
        parts = [gzip.compress(part.encode()) for part in (content[:half], content[half:])]
        (folder / f"{name}.gz").write_bytes(b"".join(parts))
    command.ok("openfoam", "case", "--cells", "hilbert")
    assert (case / "constant" / "cellOrder").read_text() == expected

    def numbers(text):
        cleaned = text.partition("}")[2].replace("(", " ").replace(")", " ").split()
        return int(cleaned[0]), [float(x) for x in cleaned[1:]]

    def block(label, values):
        return f"{len(values)}\n(".encode() + struct.pack(f"<{len(values)}{label}", *values) + b")"

    _, faces = numbers(text["faces"])
    offsets = list(range(0, len(faces) // 5 * 4 + 1, 4))
    corners = [int(p) for k, p in enumerate(faces) if k % 5]
    count, coordinates = numbers(text["points"])
    binary = {name: block("q", [int(x) for x in numbers(text[name])[1]]) for name in ("owner", "neighbour")}
    binary["faces"] = block("q", offsets) + b"\n" + block("q", corners)
    binary["points"] = f"{count}\n(".encode() + struct.pack(f"<{3 * count}d", *coordinates) + b")"
    for name, content in binary.items():
        (folder / f"{name}.gz").unlink()
        head = foam_cases.header("faceCompactList" if name == "faces" else "labelList", name)
        head = head.replace("ascii;", 'binary;\n    arch "LSB;label=64;scalar=64";')
        (folder / name).write_bytes(head.encode() + content)
    command.ok("openfoam", "case", "--cells", "hilbert")
    assert (case / "constant" / "cellOrder").read_text() == expected


@pytest.mark.parametrize("cut", [5, 12, 300, -9, -1])
def test_cut_compressed_files_are_refused(command, case, cut):
    owner = case / "constant" / "polyMesh" / "owner"
    compressed = gzip.compress(owner.read_bytes())
    owner.unlink()
    (owner.parent / "owner.gz").write_bytes(compressed[:cut])
    assert "owner.gz: byte" in command.fails("openfoam", "case")
    (owner.parent / "owner.gz").write_bytes(compressed[:100] + b"\xff\xfe\xfd" + compressed[103:])
    assert "damaged" in command.fails("openfoam", "case")
    assert not (case / "constant" / "cellOrder").exists()


def test_regions(command, case):
    (case / "constant" / "polyMesh").rename(case / "constant" / "keep")
    for name in ("fluid", "solid"):
        shutil.copytree(case / "constant" / "keep", case / "constant" / name / "polyMesh")
        (case / "system" / name).mkdir()
    assert command.fails("openfoam", "case").endswith("give --region, which may be fluid, solid")
    assert command.fails("openfoam", "case", "--region", "air").endswith("check --region and --time")
    result = command.json("openfoam", "case", "--region", "solid")
    assert result["files"] == ["case/constant/solid/cellOrder", "case/system/solid/renumberMeshDict"]
    assert " -region solid " in result["next"]
    assert not (case / "constant" / "fluid" / "cellOrder").exists()


def test_times(command, case):
    shutil.copytree(case / "constant" / "polyMesh", case / "0.5" / "polyMesh")
    (case / "postProcessing").mkdir()
    done = command.ok("openfoam", "case")
    assert "there are others for the times 0.5, which --time orders" in done.stderr
    assert "fields" not in done.stderr
    result = command.json("openfoam", "case", "--time", "0.5")
    assert result["notes"] == [] and result["files"] == ["case/0.5/cellOrder"] and " -time 0.5 " in result["next"]
    (case / "0.25").mkdir()
    assert "folders of 2 times" in command.ok("openfoam", "case", "--time", "0.5").stderr
    command.fails("openfoam", "case", "--time", "0.25")


def test_decomposed_cases(command, case):
    mesh = case / "constant" / "polyMesh"
    shutil.copytree(mesh, case / "processor0" / "constant" / "polyMesh")
    foam_cases.write_poly_mesh(case / "processor1" / "constant" / "polyMesh", foam_cases.block(3, 2, 1))
    result = command.json("openfoam", "case", "--parallel")
    assert [mesh["cells"] for mesh in result["meshes"]] == [120, 6]
    assert result["next"].startswith("mpirun -np 2 renumberMesh -parallel -case case ")
    for processor, n in (("processor0", 120), ("processor1", 6)):
        assert len(foam_cases.read_labels(case / processor / "constant" / "cellOrder")) == n
    assert not (case / "constant" / "cellOrder").exists()
    shutil.copytree(case / "processor1", case / "processor3")
    assert "processor2: the folder is missing, but processor3 exists" in command.fails("openfoam", "case", "--parallel")
    shutil.rmtree(case / "processor3")
    text = command.ok("openfoam", "case", "--parallel").stdout
    assert "processor0   120 cells, rcm (auto): band " in text and "processor1   6 cells, " in text
    shutil.rmtree(mesh)
    assert command.fails("openfoam", "case").endswith("the case is decomposed: give --parallel")
    (case / "processor1" / "constant" / "polyMesh" / "owner").unlink()
    assert "processor1" in command.fails("openfoam", "case", "--parallel")
    for name in ("processor0", "processor1"):
        shutil.rmtree(case / name)
    assert command.fails("openfoam", "case", "--parallel").endswith("run decomposePar first")
    (case / "processors2").mkdir()
    assert command.fails("openfoam", "case", "--parallel").endswith("with decomposePar -fileHandler uncollated")


def test_faults_leave_no_file(command, case):
    before = foam_cases.folder_files(case)
    owner = case / "constant" / "polyMesh" / "owner"
    text = owner.read_text()
    owner.write_text(text.replace("\n(\n", "\n(\n-7\n", 1))
    assert "case/constant/polyMesh/owner:12: the owner is -7" in command.fails("openfoam", "case")
    owner.write_text(text)
    assert "hilbrt" in command.fails("openfoam", "case", "--cells", "hilbrt")
    (case / "constant" / "polyMesh" / "points").write_text("no mesh")
    assert "points:1: is not an OpenFOAM file" in command.fails("openfoam", "case", "--cells", "hilbert")
    assert foam_cases.folder_files(case) == before
    command.ok("openfoam", "case")  # needs no points
    (case / "system" / "renumberMeshDict").write_text("method")
    assert "system/renumberMeshDict:1: is not an OpenFOAM file" in command.fails("openfoam", "case")
    shutil.rmtree(case / "system")
    assert "system" in command.fails("openfoam", "case")
    assert command.fails("openfoam", "none").endswith("none: no such folder; give an OpenFOAM case")
    (case / "system").mkdir()
    for name in ("boundary", "points", "owner"):
        (case / "constant" / "polyMesh" / name).unlink()
        message = command.fails("openfoam", "case")
        assert message.endswith(f"polyMesh/{name}: is missing, but a mesh of OpenFOAM needs it; restore it, or make the mesh again")
    shutil.rmtree(case / "constant" / "polyMesh")
    assert command.fails("openfoam", "case").endswith("make the mesh first, for instance with blockMesh")


def test_cases_that_contradict_themselves_are_refused(command, case):
    mesh = case / "constant" / "polyMesh"
    before = foam_cases.folder_files(case)
    (mesh / "boundary").write_text((mesh / "boundary").read_text().replace("nFaces 148", "nFaces 147"))
    assert "boundary: the patches cover faces" in command.fails("openfoam", "case")
    assert foam_cases.folder_files(case) == before


def test_other_paths_than_a_case(command, case, tmp_path):
    for path in ("case/constant/polyMesh", "case/constant", "case/system"):
        assert command.fails("openfoam", path) == (
            f"meshorder: {path}: is a folder of an OpenFOAM case; give the case: meshorder openfoam case")
    assert command.fails("report", "case").endswith("order its cells with meshorder openfoam case")
    (tmp_path / "wing.su2").write_text("NDIME= 2\n")
    assert command.fails("openfoam", "wing.su2").endswith(
        "wing.su2: is a file, not an OpenFOAM case; order a mesh file with meshorder order wing.su2")


def test_more_processors_than_open_files(command, case):
    mesh = case / "processor0" / "constant" / "polyMesh"
    foam_cases.write_poly_mesh(mesh, foam_cases.shuffled(foam_cases.block(3, 2, 1), 1))
    for processor in range(1, 40):
        shutil.copytree(mesh, case / f"processor{processor}" / "constant" / "polyMesh")
    done = command.run("openfoam", "case", "--parallel",
                       preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (25, 25)))
    assert done.returncode == 0, done.stderr
    assert len(list(case.glob("processor*/constant/cellOrder"))) == 40


def test_an_empty_processor_mesh_has_an_empty_map(command, case):
    empty = case / "processor0" / "constant" / "polyMesh"
    empty.mkdir(parents=True)
    for name in ("owner", "neighbour", "points", "faces", "boundary"):
        (empty / name).write_text(foam_cases.header("labelList", name) + "0()\n")
    (mesh,) = command.json("openfoam", "case", "--parallel")["meshes"]
    assert mesh["cells"] == 0
    assert len(foam_cases.read_labels(case / "processor0" / "constant" / "cellOrder")) == 0


def test_other_subcommands_name_it(command, case):
    for line in ("info case", "order case -o a.vtu", "compare case/case.foam", "info case/case.foam"):
        assert command.fails(*line.split()).endswith("is an OpenFOAM case; order its cells with meshorder openfoam case")
    (case / "case.foam").touch()
    assert command.json("openfoam", "case/case.foam")["case"] == "case"


# ---- checks by OpenFOAM itself


def renumbered(command, case, *arguments):
    """Orders the cells and runs the command that it prints; returns the new cells' old numbers and the log."""
    result = json.loads(command.ok("openfoam", case, *arguments, "--json").stdout)
    words = shlex.split(result["next"])
    at = words.index("-case")
    program = words.index("renumberMesh")
    rest = words[program + 1:at] + words[at + 2:]
    log = foam_cases.openfoam("renumberMesh", words[at + 1], *rest, before=words[:program])
    return result, log


@needs_openfoam
def test_the_direction_of_the_map(command, tmp_path):
    """A random order is not its own inverse: the inverse map would put cells and fields in other places."""
    case = foam_cases.write_cavity(tmp_path / "cavity")
    before = foam_cases.centres(case / "constant" / "polyMesh")
    renumbered(command, case, "--cells", "scrambled", "--seed", "3")
    new_to_old = foam_cases.read_labels(case / "constant" / "cellOrder")
    assert (new_to_old[new_to_old] != numpy.arange(60)).any()
    assert (foam_cases.read_field(case / "0" / "number") == new_to_old).all()
    numpy.testing.assert_allclose(foam_cases.centres(case / "constant" / "polyMesh"), before[new_to_old], atol=1e-12)


@needs_openfoam
@pytest.mark.parametrize("write, file, begins", [("writeFormat ascii;", "faces", b"FoamFile"),
                                                 ("writeFormat binary;", "faces", b"binary"),
                                                 ("writeFormat ascii; writeCompression on;", "faces.gz", b"\x1f\x8b")])
def test_renumber_mesh_prints_the_same_figures(command, tmp_path, write, file, begins):
    case = foam_cases.write_cavity(tmp_path / "cavity", cells="9 7 5")
    control = case / "system" / "controlDict"
    control.write_text(control.read_text().replace("writeFormat ascii;", write))
    renumbered(command, case, "--cells", "scrambled")  # written in that format
    assert begins in (case / "constant" / "polyMesh" / file).read_bytes()
    result, log = renumbered(command, case)
    (mesh,) = result["meshes"]
    ours = [(mesh["edge_span"][when]["max"], mesh["profile"][when]) for when in ("before", "after")]
    assert foam_cases.printed_figures(log) == ours
    assert "Mesh OK." in foam_cases.openfoam("checkMesh", case, "-constant")


@needs_openfoam
@pytest.mark.parametrize("method", ["auto", "hilbert"])
def test_the_solver_finds_the_same_flow(command, tmp_path, method):
    case = foam_cases.write_cavity(tmp_path / "cavity", cells="8 6 5")
    foam_cases.openfoam("icoFoam", case)
    fields = {name: foam_cases.read_field(case / "0.04" / name) for name in ("U", "p")}
    shutil.rmtree(case / "0.04")
    renumbered(command, case, "--cells", method)
    assert "Mesh OK." in foam_cases.openfoam("checkMesh", case, "-constant")
    foam_cases.openfoam("icoFoam", case)
    new_to_old = foam_cases.read_labels(case / "constant" / "cellOrder")
    assert (new_to_old != numpy.arange(240)).any()
    for name, old in fields.items():
        new = foam_cases.read_field(case / "0.04" / name)
        scale = abs(old).max()
        numpy.testing.assert_allclose(new.reshape(240, -1), old.reshape(240, -1)[new_to_old], atol=1e-7 * scale)


@needs_openfoam
def test_regions_of_openfoam(command, tmp_path):
    case = foam_cases.write_cavity(tmp_path / "cavity", region="fluid")
    renumbered(command, case, "--region", "fluid")
    new_to_old = foam_cases.read_labels(case / "constant" / "fluid" / "cellOrder")
    assert (foam_cases.read_field(case / "0" / "fluid" / "number") == new_to_old).all()


@needs_openfoam
def test_times_of_openfoam(command, tmp_path):
    case = foam_cases.write_cavity(tmp_path / "cavity")
    shutil.copytree(case / "0", case / "0.5")
    (case / "constant" / "polyMesh").rename(case / "0.5" / "polyMesh")
    renumbered(command, case, "--time", "0.5")
    new_to_old = foam_cases.read_labels(case / "0.5" / "cellOrder")
    assert (foam_cases.read_field(case / "0.5" / "number") == new_to_old).all()


@needs_openfoam
def test_renumber_mesh_moves_the_fields_of_one_time_only(command, tmp_path):
    """The command warns of fields of other times for this reason."""
    case = foam_cases.write_cavity(tmp_path / "cavity")
    shutil.copytree(case / "0", case / "1")
    assert "they would stay in the old order" in command.ok("openfoam", "cavity").stderr
    renumbered(command, case)
    new_to_old = foam_cases.read_labels(case / "constant" / "cellOrder")
    assert (foam_cases.read_field(case / "0" / "number") == new_to_old).all()
    assert (foam_cases.read_field(case / "1" / "number") == numpy.arange(60)).all()


@needs_openfoam
@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs MPI")
def test_decomposed_cases_of_openfoam(command, tmp_path):
    case = foam_cases.write_cavity(tmp_path / "cavity")
    (case / "system" / "decomposeParDict").write_text(
        foam_cases.header("dictionary", "decomposeParDict") +
        "numberOfSubdomains 2; method simple; simpleCoeffs { n (2 1 1); delta 0.001; }\n")
    foam_cases.openfoam("decomposePar", case)
    parts = [case / f"processor{p}" for p in range(2)]
    before = [foam_cases.read_field(part / "0" / "number") for part in parts]
    renumbered(command, case, "--parallel", "--cells", "scrambled")
    for part, numbers in zip(parts, before):
        new_to_old = foam_cases.read_labels(part / "constant" / "cellOrder")
        assert (foam_cases.read_field(part / "0" / "number") == numbers[new_to_old]).all()
    (case / "0" / "number").unlink()
    foam_cases.openfoam("reconstructPar", case, "-withZero")
    assert (foam_cases.read_field(case / "0" / "number") == numpy.arange(60)).all()
