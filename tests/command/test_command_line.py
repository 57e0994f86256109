# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Messages of the command, their streams and exit statuses: warnings, --quiet, wrong usage, a full disk."""
import json
import os
import re
import shlex
import signal
import subprocess

import pytest

import conftest
import meshes

GRID = ("models", "make", "grid", "--size", "4")


def run_into(arguments, stdout, folder, **options):
    with open(stdout, "w") as file:
        return subprocess.run([conftest.MESHORDER, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=file,
                              stderr=subprocess.PIPE, text=True, timeout=600, check=False, **options)


@pytest.fixture
def mesh(tmp_path):
    """A mesh with attributes of its points. .veg cannot hold them, and the conversion to it warns."""
    return meshes.write_tetgen(tmp_path).name


@pytest.mark.parametrize("line", ["info mesh.node", "info mesh.node --json", "methods", "methods --json", "--help",
                                  "order --help", "--version", "order mesh.node -o a.vtu", "models list",
                                  "simulate --list --json", "compare mesh.node --methods rcm --budget 0.1"])
def test_a_stdout_on_a_full_disk_is_an_error(tmp_path, mesh, line):
    done = run_into(line.split(), "/dev/full", tmp_path)
    assert done.returncode in (1, 2)
    *warnings, fault = done.stderr.splitlines()
    assert "standard output" in fault and not fault.startswith("meshorder: warning")
    assert all(warning.startswith("meshorder: warning: ") for warning in warnings)


def closes(stream):
    """Closes a stream, as a shell does for >&- (1) and 2>&- (2)."""
    return lambda: os.close(stream)


def test_closed_streams_are_not_written_into_files(tmp_path, mesh):
    """The next file that is opened would get the number of a closed stream, and the printed text with it."""
    def order(*arguments, **options):
        return subprocess.run([conftest.MESHORDER, "order", mesh, *arguments], cwd=tmp_path, check=False, text=True,
                              capture_output=True, **options)

    assert order("-o", "a.veg").returncode == 0
    done = order("-o", "b.veg", preexec_fn=closes(1))
    assert done.returncode == 2 and "standard output" in done.stderr
    assert order("-o", "c.veg", "-q", preexec_fn=closes(1)).returncode == 0
    assert order("-o", "d.veg", preexec_fn=closes(2)).returncode == 0  # it has warnings
    assert order("-o", "none/d.veg", preexec_fn=closes(2)).returncode == 2
    assert len({(tmp_path / f"{name}.veg").read_bytes() for name in "abcd"}) == 1


@pytest.mark.parametrize("restore_signals", [True, False], ids=["SIGPIPE", "EPIPE"])
@pytest.mark.parametrize("line", ["methods", "info mesh.node --json", "order --help"])
def test_a_closed_pipe_is_no_error(tmp_path, mesh, line, restore_signals):
    with subprocess.Popen([conftest.MESHORDER, *line.split()], cwd=tmp_path, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, restore_signals=restore_signals) as child:
        child.stdout.close()
        assert child.stderr.read() == ""
    assert child.returncode in (0, -signal.SIGPIPE)


def test_warnings_differ_from_errors(command, mesh):
    done = command.ok("order", mesh, "-o", "a.veg")
    assert done.stderr and all(line.startswith("meshorder: warning: ") for line in done.stderr.splitlines())
    assert "warning" not in command.fails("order", "none.node", "-o", "a.veg")


@pytest.mark.parametrize("line", ["order mesh.node -o a.veg --maps m", "apply m mesh.node -o b.veg", "info mesh.node",
                                  "compare mesh.node --methods rcm --budget 0.1",
                                  "models make torus --size 2", "report mesh.node --budget 0.1",
                                  "simulate falling --mesh mesh.node --steps 1"])
def test_quiet_prints_nothing_but_json_and_errors(command, mesh, line):
    command.ok("order", mesh, "-o", "a.veg", "--maps", "m")
    loud = command.ok(*line.split())
    assert loud.stdout
    quiet = command.ok(*line.split(), "-q")
    assert (quiet.stdout, quiet.stderr) == ("", "")
    quiet = command.ok(*line.split(), "-q", "--json")
    assert json.loads(quiet.stdout) and quiet.stderr == ""
    assert command.fails(*line.replace("mesh.node", "none.node").replace("torus", "none").split(), "-q")


@pytest.mark.parametrize("line", ["methods", "models", "models list", "simulate --list"])
def test_quiet_still_lists(command, line):
    assert command.ok(*line.split(), "--quiet").stdout == command.ok(*line.split()).stdout != ""


def test_options_may_stand_before_make(command):
    made = json.loads(command.ok("models", "--json", "make", "torus", "--size", "2").stdout)["models"]
    assert [model["name"] for model in made] == ["torus-2"]
    assert command.ok("models", "-q", "make", "torus", "--size", "2").stdout == ""


@pytest.mark.parametrize("line", ["order mesh.node -o a.veg", "apply m mesh.node -o b.veg", "info mesh.node",
                                  "compare mesh.node --methods rcm --budget 0.1", "methods", "models list",
                                  "report mesh.node --budget 0.1", "simulate falling --mesh mesh.node --steps 1"])
def test_json_holds_the_version_and_the_warnings(command, mesh, line):
    command.ok("order", mesh, "-o", "a.veg", "--maps", "m")
    done = command.ok(*line.split(), "--json")
    result = json.loads(done.stdout)
    assert result["version"] == command.ok("--version").stdout.strip()
    assert [f"meshorder: warning: {note}" for note in result["notes"]] == done.stderr.splitlines()
    if "veg" in line:
        assert result["notes"]


@pytest.mark.parametrize("line, says", [
    ("ordr x", "unknown command 'ordr'; did you mean 'order'?"),
    ("odrer x -o y", "unknown command 'odrer'; did you mean 'order'?"),
    ("ordr --help", "unknown command 'ordr'; did you mean 'order'?"),
    ("frobnicate", "unknown command 'frobnicate'; see meshorder --help"),
    ("models mak grid", "unknown command 'mak'; did you mean 'make'?"),
    ("--frobnicate", "unknown option '--frobnicate'; see meshorder --help"),
    ("order mesh.node --ouput a.vtu", "unknown option '--ouput'; did you mean '--output'? see meshorder order --help"),
    ("order mesh.node -o a.vtu --vertex=rcm",
     "unknown option '--vertex'; did you mean '--vertices'? see meshorder order --help"),
    ("info mesh.node --JSON", "unknown option '--JSON'; did you mean '--json'? see meshorder info --help"),
    ("order mesh.node -o a.vtu -x", "unknown option '-x'; see meshorder order --help"),
    ("info mesh.node other.node", "unexpected argument 'other.node'; see meshorder info --help"),
    ("models make grid --sise 3", "unknown option '--sise'; did you mean '--size'? see meshorder models make --help"),
    ("help ordr", "unknown command 'ordr'; did you mean 'order'?"),
    ("inof mesh.node", "unknown command 'inof'; did you mean 'info'?"),
    ("order mesh.node -o a.vtu --vertices hilbret", "unknown vertex order 'hilbret'; did you mean 'hilbert'?"),
    ("compare mesh.node --methods rcm/lexmx", "unknown element order 'lexmx'; did you mean 'lexmax'?"),
    ("order mesh.node -o a.vtu --for spring", "unknown workload 'spring'; did you mean 'springs'?"),
    ("order mesh.node -o a.vkt", "a.vkt: unknown extension '.vkt'; did you mean '.vtk'?"),
    ("order mesh.node new.node", "there is no output; write meshorder order mesh.node -o new.node"),
    ("order mesh.node", "there is no output; write meshorder order mesh.node -o ordered-mesh.node"),
    ("order 'a b.msh.gz'", "there is no output; write meshorder order 'a b.msh.gz' -o 'ordered-a b.msh'"),
    ("order", "MESH is required; see meshorder order --help"),
])
def test_what_is_unknown_offers_the_nearest(command, mesh, line, says):
    assert command.fails(*shlex.split(line)) == f"meshorder: {says}"


def test_help_and_version_in_words(command):
    assert command.ok("help").stdout == command.ok("--help").stdout
    assert command.ok("help", "order").stdout == command.ok("order", "--help").stdout
    assert command.ok("help", "models", "make").stdout == command.ok("models", "make", "-h").stdout
    version = command.ok("--version").stdout
    assert re.fullmatch(r"\d+\.\d+\.\d+\n", version)
    assert command.ok("version").stdout == command.ok("-V").stdout == version


@pytest.mark.parametrize("line, says", [
    ("order --threads -1", "--threads: -1 is not allowed, must be 0 or more"),
    ("order --threads -99999999999999999999", "--threads: -99999999999999999999 is not allowed, must be 0 or more"),
    ("order --threads 3.5", "--threads: '3.5' is not a whole number"),
    ("order --threads 99999999999", "--threads: 99999999999 is not allowed, must be 2147483647 or less"),
    ("order --seed -3", "--seed: -3 is not allowed, must be 0 or more"),
    ("order --seed 18446744073709551616",
     "--seed: 18446744073709551616 is not allowed, must be 18446744073709551615 or less"),
    ("order --tolerance 0", "--tolerance: 0 is not allowed, must be more than 0"),
    ("order --tolerance inf", "--tolerance: inf is not allowed, must be more than 0"),
    ("order --tolerance nan", "--tolerance: nan is not allowed, must be more than 0"),
    ("order --tolerance small", "--tolerance: 'small' is not a number"),
    ("compare --budget -0.5", "--budget: -0.5 is not allowed, must be more than 0"),
    ("report --budget 0", "--budget: 0 is not allowed, must be more than 0"),
    ("reproduce --runs 1001", "--runs: 1001 is not allowed, must be from 1 to 1000"),
    ("reproduce --runs -1", "--runs: -1 is not allowed, must be from 1 to 1000"),
    ("reproduce --steps 0", "--steps: 0 is not allowed, must be from 1 to 1000000"),
    ("simulate --steps 0", "--steps: 0 is not allowed, must be from 1 to 1000000"),
    ("simulate falling --vtk a --every 0", "--every: 0 is not allowed, must be 1 or more"),
    ("simulate falling --checkpoint a --checkpoint-every 0",
     "--checkpoint-every: 0 is not allowed, must be 1 or more"),
    ("models make grid --size 0", "--size: 0 is not allowed, must be 1 or more"),
])
def test_numbers_out_of_range_name_the_range(command, line, says):
    words = " ".join(line.split()[:2]) if line.startswith("models") else line.split()[0]
    assert command.fails(*line.split()) == f"meshorder: {says}; see meshorder {words} --help"


@pytest.mark.parametrize("words, option", [
    (["order", "mesh.node", "-o", "a.vtu", "--maps", ""], "--maps"),
    (["order", "mesh.node", "-o", ""], "--output"),
    (["order", "", "-o", "a.vtu"], "MESH"),
    (["info", "mesh.node", "--cache", ""], "--cache"),
    (["compare", "mesh.node", "--methods", ""], "--methods"),
    (["simulate", "falling", "--mesh", "mesh.node", "--resume", ""], "--resume"),
    (["reproduce", "-o", ""], "--output"),
    (["models", "make", ""], "NAME"),
])
def test_empty_values_are_refused(command, mesh, words, option):
    assert command.fails(*words).startswith(f"meshorder: {option}: the value is empty; see meshorder ")
    assert sorted(os.listdir(command.folder)) == sorted(["mesh.node", "mesh.ele"])


@pytest.mark.parametrize("option", ["--maps", "--output", "--seed", "--plugin"])
def test_an_option_without_a_value_takes_no_other_for_it(command, mesh, tmp_path, option):
    before = sorted(tmp_path.iterdir())
    line = command.fails("order", mesh, "-o", "out.vtu", f"{option}=", "-q")
    assert line == f"meshorder: {option}= has no value; give one right after the ="
    assert sorted(tmp_path.iterdir()) == before


def widths(text):
    return [len(line) for line in text.splitlines() if not line.startswith(("grid.node", "order  ", "gain  ", "to order it", "auto takes"))]


@pytest.mark.parametrize("words", [[], ["order"], ["apply"], ["info"], ["compare"], ["simulate"], ["reproduce"],
                                   ["report"], ["models"], ["models", "list"], ["models", "make"], ["methods"]])
def test_help_fits_100_columns(command, words):
    assert max(widths(command.ok(*words, "--help").stdout)) <= 100


@pytest.mark.parametrize("arguments", [["info", "--details"], ["info", "--details", "--cache", "48K,1M,32M"],
                                       ["info", "--measure"],
                                       ["compare", "--budget", "0.2"],
                                       ["compare", "--budget", "0.2", "--threads", "2", "--details", "--cache", "48K,1M,4M,32M"]])
def test_tables_fit_100_columns(command, arguments):
    made = command.json(*GRID)["models"][0]["path"]
    text = command.ok(*arguments, made).stdout.replace(made, "grid.node")
    assert max(widths(text)) <= 100, text


def three_digits(number):
    """The number in the format of tables."""
    return str(number) if number < 1000 else f"{number / 1000:.3g}k"


def test_tables_for_people_are_those_of_json(command):
    """The predicted misses of each kernel are in its own columns."""
    made = command.json(*GRID)["models"][0]["path"]
    arguments = ["compare", made, "--methods", "rcm", "--cache", "4K,64K", "--budget", "0.1"]
    reuse = command.json(*arguments)["methods"][1]["reuse"]
    text = command.ok(*arguments, "--details").stdout
    rows = [line.split()[2:] for line in text.split("Predicted for each")[1].split("Kernels (")[0].splitlines()
            if line.startswith("rcm ")]
    shown = [word for row in rows for word in row]
    expected = []
    for kernel in ("spmv", "element", "assembly", "springs"):
        one = reuse[kernel]
        expected += [f"{one['mean_log2']:.2f}", *map(three_digits, [*one["misses"], one["jumps"][-1]])]
    assert shown == expected
    info = command.ok("info", made, "--details", "--cache", "4K,64K").stdout
    assert all(re.search(rf"^{title} +\d+\.\d\d +\d", info, re.M)
               for title in ("SpMV", "element force", "assembly", "springs"))


PERIODIC = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
$EndNodes
$Elements
2
1 4 2 1 1 1 2 3 4
2 4 2 1 1 2 3 4 5
$EndElements
$Periodic
3
0 1 2
1
1 2
1 5 6
2
1 2
3 5
2 7 8
3
1 2
3 5
4 5
$EndPeriodic
"""


@pytest.mark.parametrize("extension", ["veg", "node", "mesh", "vtu"])
def test_a_periodic_pair_is_one_warning(command, tmp_path, extension):
    (tmp_path / "a.msh").write_text(PERIODIC)
    done = command.ok("order", "a.msh", "-o", f"b.{extension}")
    on_pairs = [line for line in done.stderr.splitlines() if "eriodic" in line]
    assert len(on_pairs) == 1 and "3 periodic entities" in on_pairs[0]


def test_warnings_that_differ_in_a_name_are_one(command, tmp_path):
    names = [f"group {i}" for i in range(6)]
    sets = "".join(f"*SET {name}\n1\n" for name in names)
    meshes.write_tetgen(tmp_path)
    command.ok("order", "mesh.node", "-o", "plain.veg", "--vertices", "original", "--elements", "original")
    (tmp_path / "groups.veg").write_text((tmp_path / "plain.veg").read_text() + sets)
    done = command.ok("order", "groups.veg", "-o", "b.node", "--json")
    named = [note for note in json.loads(done.stdout)["notes"] if "the set '" in note]
    assert len(named) == 1
    assert re.search(r"the set 'label_10' of cells .*\(likewise 'label_20', 'group 0' and 5 more\)", named[0])


@pytest.mark.parametrize("option", ["-q", "--json"])
def test_an_option_before_its_command_gets_its_right_place(command, option):
    line = command.fails(option, "info", "mesh.msh")
    assert line == f"meshorder: '{option}' comes before the command; write meshorder info {option}"
