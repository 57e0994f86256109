# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""`meshorder try`: a stand-in program whose time depends on the order of its mesh, and programs that misbehave."""
import gzip
import html
import json
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

import meshes
import pytest
from conftest import MESHORDER

# reads a Medit mesh; computes for argv[2] milliseconds if neighbours have near numbers, else for argv[3]
SOLVER = """
import sys, time
words = open(sys.argv[1]).read().split()
at = words.index("Triangles")
triangles = [[int(x) for x in words[k:k + 3]] for k in range(at + 2, at + 2 + 4 * int(words[at + 1]), 4)]
span = sum(max(t) - min(t) for t in triangles) / len(triangles)
milliseconds = float(sys.argv[2 if span < 40 else 3])
while time.process_time() < milliseconds / 1e3:
    pass
print("span", span)
print("seconds:", milliseconds / 1e3)
print("step 1: 99 iterations\\nstep 2:", 14 if span < 40 else 17, "iterations")
print("energy = +1.25D+00")
"""


# prints "span 10" if the mesh has its own order, else "span 12"
SPAN = "zcat mesh.mesh.gz | cmp -s - $1 && echo span 10 || echo span 12"


def write_lattice(path, side=12):
    """A square of triangles, its vertices in random order."""
    number = list(range(side * side))
    random.Random(1).shuffle(number)
    place = {new: old for old, new in enumerate(number)}
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(side * side)]
    lines += [f"{place[v] // side} {place[v] % side} 0 0" for v in range(side * side)]
    corners = [(i * side + j, i * side + j + 1, (i + 1) * side + j, (i + 1) * side + j + 1)
               for i in range(side - 1) for j in range(side - 1)]
    triangles = [t for a, b, c, d in corners for t in ((a, b, c), (b, c, d))]
    lines += ["Triangles", str(len(triangles))]
    lines += [" ".join(str(number[v] + 1) for v in t) + " 1" for t in triangles]
    path.write_text("\n".join([*lines, "End"]) + "\n")


class Folder:
    """The folder of a mesh. Detects files that a trial leaves in it or among the temporary files."""

    def __init__(self, command, temporary):
        self.command = command
        self.path = command.folder
        self.temporary = temporary
        self.environment = {**os.environ, "TMPDIR": str(temporary)}
        write_lattice(self.path / "mesh.mesh")
        (self.path / "mesh.mesh.gz").write_bytes(gzip.compress((self.path / "mesh.mesh").read_bytes()))
        (self.path / "solver.py").write_text(SOLVER)
        self.before = self.contents()

    def contents(self):
        return {path: path.read_bytes() for path in self.path.rglob("*") if path.is_file()}

    def check_untouched(self):
        assert self.contents() == self.before
        assert not list(self.temporary.iterdir())

    def json(self, *arguments):
        done = self.command.run("try", *arguments, env=self.environment)
        assert done.returncode == 0, done.stderr
        self.check_untouched()
        return json.loads(done.stdout)

    def fails(self, *arguments):
        done = self.command.run("try", *arguments, env=self.environment)
        assert done.returncode == 2, done.stderr
        assert done.stdout == ""
        line, = done.stderr.splitlines()
        self.check_untouched()
        return line


@pytest.fixture
def folder(tmp_path):
    from conftest import Command
    (tmp_path / "work").mkdir()
    (tmp_path / "temporary").mkdir()
    return Folder(Command(tmp_path / "work"), tmp_path / "temporary")


def solver(in_order, as_it_is):
    return ("--", sys.executable, "-S", "-E", "solver.py", "{}", in_order, as_it_is)


def shell(script):
    """A script that reads the mesh."""
    return ("--", "/bin/sh", "-c", f"cat $1 > /dev/null; {script}", "sh", "{}")


def by_name(result):
    return {order["name"]: order for order in result["orders"]}


def test_a_program_that_runs_twice_as_fast_is_found(folder):
    result = folder.json("mesh.mesh", "--budget", "90", "--json", *solver(60, 240))
    assert result["verdict"] == "faster"
    assert result["best"] in ("bfs", "rcm", "hilbert", "spectral-fronts", "hilbert-fronts")
    best = by_name(result)[result["best"]]
    low, high = best["interval"]
    assert 1.3 < low < best["ratio"] < high
    assert result["order_command"].startswith("meshorder order mesh.mesh -o ordered-mesh.mesh")
    assert result["runs_to_pay"] >= 1
    assert result["finding"].startswith("solver.py runs ")  # the script, not its interpreter
    assert result["needed_budget"] is None
    assert all(order["peak_bytes"] > 1e6 and order["runs"] >= 1 for order in result["orders"])
    command = result["order_command"].split()[1:]
    folder.command.ok(*command)
    assert (folder.path / "ordered-mesh.mesh").exists()


def test_text_begins_with_the_finding(folder):
    done = folder.command.ok("try", "mesh.mesh", "--budget", "90", "--methods", "rcm", *solver(60, 240))
    assert " runs " in done.stdout.splitlines()[0] and "× faster (" in done.stdout.splitlines()[0]
    assert "\noriginal " in done.stdout and "\nrcm " in done.stdout and "█" in done.stdout


def test_a_page_shows_the_findings(folder):
    page = folder.path.parent / "page.html"
    (folder.path / "a&b.mesh").write_bytes((folder.path / "mesh.mesh").read_bytes())
    folder.before = folder.contents()
    folder.json("a&b.mesh", "--page", str(page), "--methods", "rcm,hilbert", "--time", r"seconds: (\S+)", "--budget", "9",
                "--json", *solver(20, 40))
    text = page.read_text()
    assert "<h1>solver.py runs" in text and "runs 2.00× faster" in text and text.count("<b style=") >= 2
    assert 'width:100.00%' in text and 'width:50.00%' in text
    assert "a&amp;b.mesh" in text and "a&b" not in text
    assert "<script" not in text and "http" not in text
    assert "that is the mesh" in folder.fails("mesh.mesh", "--page", "mesh.mesh", *solver(20, 40))
    assert "no-such" in folder.fails("mesh.mesh", "--page", "no-such/page.html", *solver(20, 40))


def test_what_the_program_prints_can_be_its_time(folder):
    result = folder.json("mesh.mesh", "--time", r"seconds: (\S+)", "--budget", "9", "--json", *solver(20, 40))
    assert result["verdict"] == "faster" and result["runs_to_pay"] is None
    for name, order in by_name(result).items():
        assert order["time"] == pytest.approx(0.04 if name == "original" else 0.02)
    # exactly the same in all orders
    result = folder.json("mesh.mesh", "--time", r"seconds: (\S+)", "--budget", "9", "--json", *solver(20, 20))
    assert result["verdict"] == "tie"
    assert result["finding"].startswith("tie: no order tried makes solver.py faster by more than 1.5 %; in ")
    assert re.search(r"it is 1.000× as fast \((0.99\d|1.000)–1.00\d\)$", result["finding"])
    result = folder.json("mesh.mesh", "--time", r"seconds: (\S+)", "--budget", "9", "--json", *solver(40, 20))
    assert result["verdict"] == "slower"
    assert result["finding"].startswith("slower: solver.py runs fastest in the mesh's own order; in ")
    assert re.search(r"it is 0.50× as fast \(0.50–0.50\)$", result["finding"])


def test_counts_are_the_last_that_are_printed(folder):
    result = folder.json("mesh.mesh", "--count", r"(\d+) iterations", "--methods", "rcm", "--budget", "3", "--json",
                         *solver(10, 10))
    assert {name: order["count"] for name, order in by_name(result).items()} == {"original": 17, "rcm": 14}
    assert not any("--count" in note for note in result["notes"])
    result = folder.json("mesh.mesh", "--count", r"span (\S+)", "--methods", "rcm,scrambled", "--budget", "3", "--json",
                         *shell(SPAN))
    note, = (note for note in result["notes"] if "--count" in note)
    assert note == "--count is larger in other orders: 10 in the mesh's own, 12 in rcm, 12 in scrambled"


def test_times_agree_with_ratios(folder, tmp_path):
    """Each run is shorter than the one before: medians over different numbers of rounds do not give the ratio."""
    (tmp_path / "log").mkdir()
    log = tmp_path / "log" / "runs"
    script = f'echo >> {log}; runs=$(wc -l < {log}); echo seconds: $((1000000 / (runs + 10)))'
    result = folder.json("mesh.mesh", "--methods", "rcm,hilbert,scrambled,bfs", "--time", r"seconds: (\S+)", "--budget",
                         "3", "--json", *shell(script))
    original, *others = result["orders"]
    assert {order["runs"] for order in others} != {original["runs"]}
    for order in (order for order in others if order["ratio"]):
        assert order["time"] * order["ratio"] == pytest.approx(original["time"])


def test_the_clock_can_count(folder):
    result = folder.json("mesh.mesh", "--time", "wall", "--methods", "rcm", "--budget", "4", "--json",
                         *shell("sleep 0.2"))
    assert by_name(result)["original"]["time"] > 0.2
    result = folder.json("mesh.mesh", "--methods", "rcm", "--budget", "3", "--json", *shell("sleep 0.2"))
    assert by_name(result)["original"]["time"] < 0.1


def test_processor_time_of_children_counts(folder):
    script = f"{sys.executable} -S -E solver.py $1 60 60 & wait"
    result = folder.json("mesh.mesh", "--methods", "rcm", "--budget", "10", "--json", *shell(script))
    assert by_name(result)["original"]["time"] > 0.055


def test_results_must_agree(folder):
    arguments = ("mesh.mesh", "--methods", "rcm", "--budget", "3", "--json")
    result = folder.json(*arguments, "--same", r"energy = (\S+)", *solver(10, 10))
    assert by_name(result)["rcm"]["fault"] is None
    fault = folder.fails(*arguments, "--same", r"span (\S+)", *solver(10, 10))
    assert "same results only in the mesh's own order" in fault and "results differ" in fault
    assert "--tolerance larger than 1e-06" in fault
    assert folder.json(*arguments, "--same", r"span (\S+)", "--tolerance", "1", *solver(10, 10))


def test_an_order_whose_results_differ_gives_its_place_to_others(folder, tmp_path):
    """The budget suffices for one order besides the mesh's own."""
    (tmp_path / "log").mkdir()
    log = tmp_path / "log" / "runs"
    script = f"echo >> {log}; sleep 0.3; test $(wc -l < {log}) {{}} && echo sum 12 || echo sum 10"
    judged = ("--same", r"sum (\S+)")
    result = folder.json("mesh.mesh", *judged, "--budget", "4", "--json", *shell(script.format("= 2")))
    _, first, second = result["orders"]
    assert first["fault"] == "the results differ: 12 instead of 10"
    assert second["fault"] is None and second["runs"] >= 1 and result["left_out"]
    note, = (note for note in result["notes"] if "results differ" in note)
    assert note == (f"left out: {first['name']} (the results differ: 12 instead of 10); --tolerance, now 1e-06, allows "
                    "larger differences")
    log.unlink()
    fault = folder.fails("mesh.mesh", *judged, "--budget", "0.5", *shell(script.format("-gt 1")))
    assert f"in {first['name']}: the results differ" in fault
    assert "--budget leaves no time for" in fault and "rcm" in fault


@pytest.mark.parametrize("own, other, agree", [("2.16e-14", "-8e-14", True), ("2.16e-14", "1.1e-10", False)])
def test_sums_that_are_zero_but_for_rounding_agree(folder, own, other, agree):
    script = f'test "$({SPAN})" = "span 10" && echo "F: -1.02E+02 {own}" || echo "F: -1.02E+02 {other}"'
    arguments = ("mesh.mesh", "--methods", "scrambled", "--budget", "2", "--json")
    for judged, command in (("--same-file", shell(f"({script}) > result.dat")), ("--same", shell(script))):
        value = "result.dat" if judged == "--same-file" else r"(-?[0-9.]+[eE][-+]?[0-9]+)"
        if agree:
            assert by_name(folder.json(*arguments, judged, value, *command))["scrambled"]["fault"] is None
        else:
            assert "results differ" in folder.fails(*arguments, judged, value, *command)


def test_files_must_agree(folder):
    arguments = ("mesh.mesh", "--methods", "rcm", "--budget", "1", "--json")
    write = 'cat $1 > /dev/null; echo "total 1.0000001 ok" > result.txt; cp result.txt $2'
    command = ("--", "/bin/sh", "-c", write, "sh", "{}", "{out}")
    assert folder.json(*arguments, "--same-file", "result.txt", *command)
    assert folder.json(*arguments, "--same-file", "{out}", *command)
    assert "writes no file other.txt" in folder.fails(*arguments, "--same-file", "other.txt", *command)
    assert folder.json(*arguments, "--same-file", "{stem}.dat", *shell("echo 1 > mesh.dat"))
    assert folder.json(*arguments, "--same-file", "{}.dat", *shell("echo 1 > mesh.mesh.dat"))
    assert folder.json(*arguments, "--same-file", "{out}/a", "--", "/bin/sh", "-c", "cat $1; mkdir $2; echo 1 > $2/a", "sh", "{}",
                       "{out}")
    assert "in the folder" in folder.fails(*arguments, "--same-file", "../x", *command)
    assert "results differ" in folder.fails(*arguments, "--same-file", "copy", *shell("cp $1 copy"))


def test_an_order_that_fails_is_out(folder):
    result = folder.json("mesh.mesh", "--methods", "scrambled,rcm", "--budget", "10", "--json", "--time",
                         r"seconds: (\S+)", "--", "/bin/sh", "-c",
                         f"{sys.executable} -S -E solver.py $1 10 20 > log; cat log; "
                         "cmp -s $1 first || { test -e first || exit 0; }", "sh", "{}")
    assert by_name(result)["rcm"]["fault"] is None


def test_every_run_finds_the_same_files(folder):
    (folder.path / "sub").mkdir()
    (folder.path / "sub" / "include.txt").write_text("kept")
    (folder.path / ".hidden").write_text("not copied")
    folder.before = folder.contents()
    script = ("test ! -e left -a ! -e sub/left -a ! -e .hidden || { echo found >&2; exit 1; }; "
              "test $(cat sub/include.txt) = kept || { echo changed >&2; exit 1; }; "
              "touch left sub/left; echo changed > sub/include.txt; rm solver.py; mkdir -p new/deep; touch new/deep/x")
    folder.json("mesh.mesh", "--methods", "rcm", "--budget", "3", "--json", *shell(script))


def test_named_files_alone_are_copied(folder):
    script = "test -e solver.py -a ! -e other.txt"
    (folder.path / "other.txt").write_text("")
    folder.before = folder.contents()
    folder.json("mesh.mesh", "--with", "solver.py", "--methods", "rcm", "--budget", "3", "--json", *shell(script))
    assert "--with nothing.txt" in folder.fails("mesh.mesh", "--with", "nothing.txt", *shell(script))


def landlock_version():
    import ctypes
    return ctypes.CDLL(None).syscall(444, None, 0, 1)


protected = pytest.mark.skipif(landlock_version() < 3, reason="needs Linux 6.2")


def test_an_earlier_result_that_the_program_writes_anew_stays(folder):
    """Also if it is large, or if a link leads to it."""
    elsewhere = folder.path.parent / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "old.txt").write_text("old")
    (elsewhere / "self").symlink_to(".")
    (folder.path / "results").symlink_to(elsewhere)
    (folder.path / "linked.txt").symlink_to(elsewhere / "old.txt")
    os.link(elsewhere / "old.txt", folder.path / "hard.txt")
    with open(folder.path / "mesh.frd", "wb") as large:
        large.write(os.urandom(1000))
        large.truncate(70 << 20)
    folder.before = folder.contents()
    script = ("test $(cat results/old.txt linked.txt hard.txt) = oldoldold || exit 3; "
              "for file in mesh.frd linked.txt hard.txt; do echo new > $file || exit 4; done; "
              "rm -r results/* && echo new > results/new.txt")
    assert folder.json("mesh.mesh", "--methods", "rcm", "--budget", "1", "--json", *shell(script))
    assert [path.name for path in elsewhere.glob("*.txt")] == ["old.txt"]
    assert (elsewhere / "old.txt").read_text() == "old"


def test_what_is_too_large_to_copy_is_read_but_not_written(folder):
    with open(folder.path / "large", "wb") as large:
        large.truncate(3 << 30)

    def run(script, *options):
        return folder.command.run("try", "mesh.mesh", "--methods", "rcm", "--budget", "1", *options, *shell(script),
                                  env=folder.environment)

    refused = run("true", "--unprotected")
    assert refused.returncode == 2 and "too large to copy" in refused.stderr and "--with" in refused.stderr
    denied = run("head -c 9 large; echo >> large")
    assert denied.returncode == 2 and (folder.path / "large").stat().st_size == 3 << 30
    if landlock_version() >= 3:
        assert "Permission denied" in denied.stderr and "write to {out}" in denied.stderr
        assert run("head -c 9 large").returncode == 0
    (folder.path / "large").unlink()
    folder.check_untouched()


ATTACKS = ["echo >> mesh.mesh", "rm mesh.mesh", "echo > new", "mkdir new", "ln mesh.mesh {out}", "mv solver.py {out}",
           "mv . {out}", "truncate -s 1 mesh.mesh", "cd /proc/$PPID/cwd && echo > new", "ln -s / new"]


@protected
@pytest.mark.parametrize("attack", ATTACKS)
def test_a_program_cannot_write_to_the_folder_of_the_mesh(folder, attack):
    """Also not by its full path, which the program may have from a file of settings."""
    folder.environment["SETTING"] = str(folder.path)
    folder.environment["OLDPWD"] = str(folder.path)
    attack = attack.replace("{out}", str(folder.temporary / "*" / "out"))
    fault = folder.fails("mesh.mesh", "--methods", "rcm", *shell(f"cd $SETTING; {attack} || exit 5"))
    assert "exit status" in fault


def test_without_protection_a_change_is_noticed(folder):
    folder.environment["SETTING"] = str(folder.path)
    for script in ("echo >> $SETTING/solver.py", "mkdir $SETTING/new"):
        done = folder.command.run("try", "mesh.mesh", "--unprotected", *shell(script), env=folder.environment)
        assert done.returncode == 2 and "changed while the program ran" in done.stderr


@pytest.mark.parametrize("word", ["{}", "--mesh={}", "-m{}", "a:{}", "cd {}; solve"])
@pytest.mark.parametrize("place", ["", "mesh.mesh", "alias"])
def test_a_command_does_not_name_the_original(folder, word, place):
    (folder.path / "alias").symlink_to("mesh.mesh")
    folder.before = folder.contents()
    fault = folder.fails("mesh.mesh", *shell("true"), word.replace("{}", str(folder.path / place)))
    assert "each run needs its own copy" in fault and ("{}" in fault or "write ." in fault)


def test_a_command_may_name_other_files(folder):
    words = [str(folder.path / "solver.py"), str(folder.path.parent), "/", "a/b", "//", "--x="]
    assert folder.json("mesh.mesh", "--methods", "rcm", "--budget", "1", "--json", *shell("true"), *words)


def test_a_run_that_does_not_read_its_copy_is_a_fault(folder):
    read = ("--", "/bin/sh", "-c", "test -e $1 && {}", "sh", "{}")
    command = [word.replace("&& {}", "") for word in read]
    assert folder.fails("mesh.mesh", *command) == (
        "meshorder: sh, in the mesh's own order: it did not read its copy of the mesh, mesh.mesh; have it read {}")
    for script in ("cat $1", "cp $1 a; cat a", "mv $1 a; cat a; mv a $1",
                   f"{sys.executable} -c 'import mmap, sys; f = open(sys.argv[1]); mmap.mmap(f.fileno(), 0, mmap.MAP_PRIVATE, 1)[0]' $1"):
        assert folder.json("mesh.mesh", "--methods", "rcm", "--budget", "1", "--json", "--", "/bin/sh", "-c", script, "sh", "{}")


def test_a_mesh_of_several_files_moves_as_one(folder):
    meshes.write_tetgen(folder.path)
    folder.before = folder.contents()
    result = folder.json("mesh.node", "--methods", "rcm,scrambled", "--budget", "3", "--json",
                         *shell("cat mesh.ele > /dev/null"))
    assert result["orders"][0]["runs"] >= 1


def test_words_of_the_program_are_its_own(folder):
    script = 'cat $2; test "$1" = mesh -a "$2" = mesh.mesh -a "$3" = "[a,b]" -a "$4" = --json= -a "$5" = "" || exit 1'
    folder.json("mesh.mesh", "--methods", "rcm", "--budget", "2", "--json", "--", "/bin/sh", "-c", script, "sh",
                "{stem}", "{}", "[a,b]", "--json=", "")


def test_first_outputs_can_be_kept(folder):
    done = folder.command.ok("try", "mesh.mesh", "--keep", "kept", "--methods", "rcm,hilbert/original", "--budget", "2",
                             *shell("echo written > result; echo said"))
    assert "kept" in done.stdout
    for name in ("original", "rcm", "hilbert_original"):
        assert (folder.path / "kept" / name / "result").read_text() == "written\n"
        assert (folder.path / "kept" / name / "stdout.txt").read_text() == "said\n"
        assert {path.name for path in (folder.path / "kept" / name).iterdir()} == {
            "mesh.mesh", "result", "stdout.txt", "stderr.txt"}
    assert "already exists" in folder.command.fails("try", "mesh.mesh", "--keep", "kept", *shell("true"))
    (folder.path / "empty").touch()
    assert "already exists" in folder.command.fails("try", "mesh.mesh", "--keep", "empty", *shell("true"))


def test_orders_that_the_budget_leaves_no_time_for_are_named(folder):
    done = folder.command.run("try", "mesh.mesh", "--budget", "2", "--json", *solver(150, 150), env=folder.environment)
    assert done.returncode == 0
    result = json.loads(done.stdout)
    assert result["left_out"] and len(result["orders"]) == 2
    assert result["run_seconds"] < 4
    note, = (note for note in result["notes"] if "there is no time for" in note)
    assert note.endswith(" runs")


def test_too_few_runs_are_no_finding(folder):
    """Without a pair of runs, the finding says what to do and calls no order the best."""
    result = folder.json("mesh.mesh", "--methods", "rcm", "--budget", "0.7", "--json", *shell("sleep 0.3"))
    assert result["verdict"] == "undecided" and result["needed_budget"] > 4
    assert result["finding"] == f"undecided: too few runs of sh to say; raise --budget to {result['needed_budget']:g} s"


def test_above_the_noise_no_factor_is_printed(folder):
    """Neither in the sentence, nor in the table, the page and the JSON."""
    page = folder.path.parent / "page.html"
    arguments = ("mesh.mesh", "--methods", "rcm", "--budget", "6", "--time", r"(\d+)", "--page", str(page))
    command = shell("date +%N | tail -c 4 | sed 's/^0*/1/'")
    result = folder.json(*arguments, "--json", *command)
    rcm = by_name(result)["rcm"]
    assert result["verdict"] == "not told apart" and rcm["ratio"] is None and rcm["time"] is None
    low, high = rcm["interval"]
    assert low < 1 < high and result["control"][0] <= result["control"][1]
    assert result["finding"].startswith("not told apart: the runs of sh vary too much; rcm makes it ")
    assert result["finding"].endswith("and --budget 24 halves this range")
    assert "not told apart 0." in page.read_text() or "not told apart 1." in page.read_text()
    text = folder.command.ok("try", *arguments, *command).stdout
    row, = (line for line in text.splitlines() if line.startswith("rcm "))
    assert row.endswith("not told apart") and row.count(".") <= 3
    assert "\noriginal again " in text


def test_four_pairs_can_decide(folder):
    """As many as `--budget 50` allows for a program of five seconds."""
    result = folder.json("mesh.mesh", "--methods", "rcm", "--budget", "60", "--time", r"(\d+)", "--json",
                         *shell(f'({SPAN}) | sed "s/span 10/1300/; s/span 12/1000/"'))
    rcm = by_name(result)["rcm"]
    assert result["verdict"] == "faster" and rcm["runs"] == 4
    assert rcm["ratio"] == pytest.approx(1.3) and 1.2 < rcm["interval"][0] < 1.3 < rcm["interval"][1]


def test_the_command_of_a_page_can_be_repeated(folder):
    page = folder.path.parent / "page.html"
    kept = folder.path.parent / "kept"
    folder.json("mesh.mesh", "--page", str(page), "--keep", str(kept), "--methods=rcm", "--time", r"(\d+)", "--budget", "0.5",
                "--json", *shell("echo 12"))
    first = page.read_text()
    call = html.unescape(re.search("<p><code>(meshorder try .*?)</code>", first, re.DOTALL)[1])
    assert "--keep" not in call
    page.unlink()
    subprocess.run(["/bin/sh", "-c", call.replace("meshorder", MESHORDER, 1)], cwd=folder.path, check=True,
                   capture_output=True, env=folder.environment)
    assert call in html.unescape(page.read_text())


def test_orders_that_the_user_names_share_the_budget(folder):
    result = folder.json("mesh.mesh", "--methods", "auto,hilbert,rcm,scrambled", "--budget", "6", "--json",
                         *shell("sleep 0.3"))
    assert result["left_out"] == [] and {"hilbert", "rcm", "scrambled"} <= set(by_name(result))
    assert all(order["runs"] >= 1 for order in result["orders"])


def write_program(folder, name, script):
    (folder.path / name).write_text("#!/bin/sh\n" + script)
    (folder.path / name).chmod(0o755)
    folder.before = folder.contents()
    return f"./{name}"


@pytest.mark.parametrize("line", [" *ERROR in readinput: no file", "--ERROR: no mesh", "[error] no mesh", "# Error: no"])
def test_an_error_that_the_program_prints_is_a_warning(folder, line):
    """Even if the program ends with status 0."""
    program = write_program(folder, "claims", f'cat $1 > mesh; echo "{line}"; echo done')
    result = folder.json("mesh.mesh", "--methods", "rcm,hilbert", "--budget", "1", "--json", "--", program, "{}")
    note, = (note for note in result["notes"] if "printed" in note)
    assert note == f"the program printed '{line.strip()}': did it read the mesh?"


@pytest.mark.parametrize("line", ["error = 1e-9", "Error: 0.5", "errors 3", "no error", "error_norm 3",
                                  "error condition (0=good, 1=bad) = 0"])
def test_results_are_no_errors(folder, line):
    program = write_program(folder, "converges", f'cat $1 > mesh; echo "{line}"')
    result = folder.json("mesh.mesh", "--methods", "rcm", "--budget", "1", "--json", "--", program, "{}")
    assert not any("printed" in note for note in result["notes"])


def test_calculix_adds_the_extension(folder):
    ccx = write_program(folder, "ccx_2.20", 'cat $1.inp && exit 0; echo " *ERROR: cannot open $1.inp"\n'
                                            'echo "CalculiX stops."; exit $2')
    (folder.path / "mesh.inp").write_text("*NODE\n1, 0, 0, 0\n2, 0, 1, 0\n3, 1, 0, 0\n4, 0, 0, 1\n"
                                          "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n")
    folder.before = folder.contents()
    arguments = ("mesh.inp", "--methods", "scrambled", "--budget", "1", "--json", "--", ccx)
    remedy = "(CalculiX adds .inp by itself: write {stem} in place of {})"
    fault = folder.fails(*arguments, "{}", "0")
    assert f"it did not read its copy of the mesh, mesh.inp; have it read {{}}; it printed '*ERROR: cannot open" in fault
    assert fault.endswith(remedy)
    fault = folder.fails(*arguments, "{}", "201")
    assert "exit status 201: *ERROR: cannot open mesh.inp.inp" in fault and remedy in fault and "stops" not in fault
    assert not any("printed" in note for note in folder.json(*arguments, "{stem}", "0")["notes"])


@pytest.mark.parametrize("arguments, fault", [
    (("mesh.mesh",), "there is no program to try"),
    (("mesh.mesh", "cat", "{}"), "unexpected argument 'cat': -- must come before the program"),
    (("mesh.mesh", "cat", "-i", "{}"), "-- must come before the program; write meshorder try mesh.mesh -- cat …"),
    (("mesh.mesh", "--methods", "rcmm", "--", "cat", "{}"), "--methods rcmm: there is no such order; did you mean 'rcm'?"),
    (("mesh.mesh", "--methods", "rcm/lexmx", "--", "cat", "{}"), "did you mean 'lexmax'?"),
    (("mesh.mesh", "--", "true"), "has no {}"),
    (("mesh.mesh", "--", "./nothing", "{}"), "./nothing: there is no executable program"),
    (("mesh.mesh", "--", "no-such-program", "{}"), "no folder of PATH"),
    (("mesh.mesh", "--", "./solver.py", "{}"), "executable program"),
    (("none.mesh", "--", "cat", "{}"), "none.mesh: there is no such file"),
    (("mesh.mesh.gz", "--", "cat", "{}"), "compressed"),
    (("mesh.xyz", "--", "cat", "{}"), "unknown extension"),
    (("mesh.pvtu", "--", "cat", "{}"), "lists pieces"),
    (("mesh.mesh", "--methods", "best", "--", "cat", "{}"), "--methods best"),
    (("mesh.mesh", "--time", "(", "--", "cat", "{}"), "not a regular expression"),
    (("mesh.mesh", "--same", "(a)(b)", "--", "cat", "{}"), "several groups"),
    (("mesh.mesh", "--time", "seconds (.*)", "--", "cat", "{}"), "no line of the program's output matches"),
    (("mesh.mesh", "--count", "MeshVersion(.*)", "--", "cat", "{}"), "captures 'Formatted 2', which is not a number"),
    (("mesh.mesh", *shell("echo first >&2; echo last >&2; exit 3")), "exit status 3: last"),
    (("mesh.mesh", *shell("kill -9 $$")), "ended by signal 9"),
    (("mesh.mesh", "--timeout", "0.3", *shell("sleep 60 & sleep 61")), "did not end within 300 ms"),
    (("mesh.mesh", *shell("echo >> $1")), "changes its mesh"),
    (("mesh.mesh", *shell("rm $1")), "changes its mesh"),
    (("mesh.mesh", *shell("cp $1 x; mv x $1; echo >> $1")), "changes its mesh"),
])
def test_bad_input_is_one_line(folder, arguments, fault):
    assert fault in folder.fails(*arguments)


def test_orders_that_move_nothing_are_left_out(folder):
    entries = [(i, i) for i in range(1, 40)] + [(i + 1, i) for i in range(1, 39)]
    lines = ["%%MatrixMarket matrix coordinate real symmetric", f"39 39 {len(entries)}"]
    (folder.path / "a.mtx").write_text("\n".join([*lines, *(f"{i} {j} 1.5" for i, j in entries)]) + "\n")
    folder.before = folder.contents()
    command = ("a.mtx", "--budget", "2", "--json", *shell("cat $1 > /dev/null"))
    result = folder.json("--methods", "scrambled", *command)
    assert set(by_name(result)) == {"original", "scrambled"}
    result = folder.json(*command)
    assert set(by_name(result)) <= {"original", "rcm", "spectral-fronts"}
    assert not any("coordinates" in note for note in result["notes"])
    assert any(note.startswith("the same as the mesh's own order") and "auto" in note for note in result["notes"])
    assert "has no coordinates, which the order 'hilbert' needs" in folder.fails("--methods", "hilbert", *command)
    result = folder.json("--methods", "original", *command)
    assert result["best"] is None and result["verdict"] == "undecided"
    assert "not tried in another order" in result["finding"]


def test_results_that_vary_by_themselves_are_refused(folder):
    fault = folder.fails("mesh.mesh", "--methods", "rcm", "--same", r"(\d+)", "--budget", "5",
                         *shell("date +%N | sed s/^0*//"))
    assert "vary" in fault or "results differ" in fault


def is_running(marker):
    for process in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if marker.encode() in process.read_bytes():
                return True
        except OSError:
            pass
    return False


def test_what_the_program_leaves_running_is_ended(folder):
    seconds = f"{random.randrange(10**6, 10**7)}.5"
    result = folder.json("mesh.mesh", "--methods", "rcm", "--budget", "2", "--json", *shell(f"setsid sleep {seconds} & true"))
    assert any("leaves processes running" in note for note in result["notes"])
    assert not is_running(seconds)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGQUIT, signal.SIGUSR1, signal.SIGPIPE,
                                    signal.SIGALRM, signal.SIGRTMIN])
def test_a_signal_ends_the_program_and_leaves_nothing(folder, number):
    seconds = f"{random.randrange(10**6, 10**7)}.5"
    running = subprocess.Popen([MESHORDER, "try", "mesh.mesh", *shell(f"sleep {seconds} & sleep 60")], cwd=folder.path,
                               env=folder.environment, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while not is_running(f"sleep\0{seconds}") and time.monotonic() < deadline:
        time.sleep(0.02)
    running.send_signal(number)
    _, stderr = running.communicate(timeout=60)
    assert running.returncode == -number
    assert stderr.startswith("meshorder: stopped by SIG") == (number in (signal.SIGINT, signal.SIGTERM))
    assert not is_running(f"sleep\0{seconds}")
    folder.check_untouched()


def test_a_program_that_leaves_its_group_ends_at_its_timeout(folder):
    seconds = f"{random.randrange(10**6, 10**7)}.5"
    leave = f"import os, sys, time; os.setpgid(0, os.getpgid(os.getppid())); time.sleep({seconds})"
    began = time.monotonic()
    fault = folder.fails("mesh.mesh", "--timeout", "0.5", "--", sys.executable, "-S", "-c", leave, "{}")
    assert "did not end within 500 ms" in fault and time.monotonic() - began < 20
    assert not is_running(seconds)


@pytest.mark.parametrize("option", ["--time", "--same", "--count"])
def test_an_expression_without_end_is_a_fault(folder, option):
    began = time.monotonic()
    fault = folder.fails("mesh.mesh", "--timeout", "2", option, r"(?:a+)+b|t (\S+) s", *shell(f"echo {'a' * 60}c; echo t 1 s"))
    assert "matching it takes more than 2.0 s" in fault and time.monotonic() - began < 30


def test_a_signal_ends_an_expression_without_end(folder):
    running = subprocess.Popen([MESHORDER, "try", "mesh.mesh", "--time", "(?:a+)+b", *shell(f"echo {'a' * 60}c")], cwd=folder.path,
                               env=folder.environment, stderr=subprocess.DEVNULL)
    time.sleep(2)
    running.send_signal(signal.SIGTERM)
    assert running.wait(timeout=60) == -signal.SIGTERM
    folder.check_untouched()


@pytest.mark.parametrize("number", ["nan", "inf", "-inf", "0", "-1"])
def test_numbers_that_cannot_be_compared_are_faults(folder, number):
    arguments = ("mesh.mesh", "--methods", "rcm", "--budget", "1")
    assert "cannot be compared" in folder.fails(*arguments, "--time", r"t (\S+)", *shell(f"echo t {number}"))
    if number not in ("0", "-1"):
        assert "nothing to compare" in folder.fails(*arguments, "--same", r"t (\S+)", *shell(f"echo t {number}"))
        script = f"printf 'step e\\n1 {number}\\n2 {number}\\n' > file"
        assert "nothing to compare" in folder.fails(*arguments, "--same-file", "file", *shell(script))
    assert "nothing to compare: it is empty" in folder.fails(*arguments, "--same-file", "file", *shell("echo > file"))


@pytest.mark.parametrize("other, agree", [("1 2e2 -1e-12", True), ("1 2e2 1e-3", False), ("1 3e2 1e-13", False),
                                          ("2 2e2 1e-13", False)])
def test_numbers_are_compared_with_the_largest_of_their_column(folder, other, agree):
    """Here a moment that is zero but for rounding, beside a force, and in other rows of another table."""
    table = "echo step force moment; echo 0 1 1e-1; echo 1 2e2 {}; echo step energy; echo 5 1e-9"
    script = f'(test "$({SPAN})" = "span 10" && {{ {table.format("1e-13")}; }} || ' \
             f'{{ {table.replace("1 2e2 {}", other)}; }}) > file'
    arguments = ("mesh.mesh", "--methods", "scrambled", "--budget", "1", "--json", "--same-file", "file")
    if agree:
        assert by_name(folder.json(*arguments, *shell(script)))["scrambled"]["fault"] is None
    else:
        assert "results differ" in folder.fails(*arguments, *shell(script))


def test_what_cannot_be_kept_is_left_out(folder):
    script = "mkfifo pipe; ln -s . self; mkdir $2; mkfifo $2/pipe; echo 1 > $2/file; cat $1"
    folder.command.ok("try", "mesh.mesh", "--keep", "kept", "--methods", "rcm", "--budget", "0.5", "--", "/bin/sh", "-c", script,
                      "sh", "{}", "{out}")
    assert (folder.path / "kept" / "rcm" / "out" / "file").exists()
    assert not (folder.path / "kept" / "rcm" / "pipe").exists()


def test_the_folder_for_temporary_files(folder):
    (folder.path / "own").mkdir()
    folder.before = folder.contents()
    folder.environment["TMPDIR"] = "own"
    arguments = ("mesh.mesh", "--methods", "rcm", "--budget", "0.5", "--json", *shell("test -d $TMPDIR && echo > $TMPDIR/file"))
    assert folder.json(*arguments)
    folder.environment["TMPDIR"] = "none"
    assert "none: there is no such folder for temporary files; set TMPDIR" in folder.fails(*arguments)


def test_without_further_threads_and_processes_one_line_says_what_to_do(tmp_path):
    with tempfile.TemporaryDirectory() as place:  # that another user can enter
        os.chmod(place, 0o777)
        write_lattice(pathlib.Path(place) / "mesh.mesh", 60)

        def limit():
            if os.geteuid() == 0:
                os.setuid(65534)  # root has no limit
            resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))

        for command, fault in ((["order", "mesh.mesh", "-o", "new.mesh"], "--threads 1"),
                               (["try", "mesh.mesh", "--", "cat", "{}"], "ulimit -u")):
            done = subprocess.run([MESHORDER, *command], cwd=place, preexec_fn=limit, capture_output=True, text=True, check=False)
            line, = done.stderr.splitlines()
            assert done.returncode == 2 and fault in line, line
        assert os.listdir(place) == ["mesh.mesh"]


def test_braces_in_a_name_stay(folder):
    (folder.path / "a{}b.mesh").write_bytes((folder.path / "mesh.mesh").read_bytes())
    folder.before = folder.contents()
    assert folder.json("a{}b.mesh", "--methods", "rcm", "--budget", "0.5", "--json", "--", "/bin/sh", "-c",
                       'cat "$1" "$2.mesh"', "sh", "{}", "{stem}")


# ---- cases of OpenFOAM

# moves the cells as OpenFOAM does: by constant/cellOrder, or by its own order, which is the reverse one here
RENUMBER_MESH = """
import pathlib, sys
import numpy
sys.path.insert(0, {tests!r})
import foam_cases as foam
case = pathlib.Path(sys.argv[sys.argv.index("-case") + 1])
mesh = case / "constant" / "polyMesh"
owners, neighbours = foam.read_labels(mesh / "owner"), foam.read_labels(mesh / "neighbour")
cells = max(owners) + 1
order = foam.read_labels(case / "constant" / "cellOrder") if "-dict" in sys.argv else numpy.arange(cells)[::-1]
place = numpy.argsort(order)
for name, labels in (("owner", owners), ("neighbour", neighbours)):
    text = foam.header("labelList", name, "constant/polyMesh")
    (mesh / name).write_text(text + foam.text_list(list(place[labels])))
field = numpy.array((case / "0" / "p").read_text().split())
(case / "0" / "p").write_text("\\n".join(field[order]))
"""

# computes for 50 ms if cells that share a face have near numbers, else for 200 ms
FLOW = """
import pathlib, sys, time
sys.path.insert(0, {tests!r})
import foam_cases as foam
mesh = pathlib.Path("constant/polyMesh")
neighbours = foam.read_labels(mesh / "neighbour")
spans = abs(foam.read_labels(mesh / "owner")[:len(neighbours)] - neighbours)
begin = time.process_time()
while time.process_time() - begin < (0.05 if max(spans) < 60 else 0.2):
    pass
print("sum", sum(map(float, pathlib.Path("0/p").read_text().split())), "cells")
pathlib.Path("0.1").mkdir()
pathlib.Path("0.1/p").write_text("what the run leaves")
"""


@pytest.fixture
def case(folder, tmp_path):
    import foam_cases
    tests = str(pathlib.Path(__file__).parent)
    path = foam_cases.write_case(folder.path / "cavity", foam_cases.shuffled(foam_cases.block(8, 7, 6), 3))
    (path / "system" / "controlDict").write_text("startTime 0;\n")
    (path / "0").mkdir()
    (path / "0" / "p").write_text("\n".join(str(cell) for cell in range(8 * 7 * 6)))
    programs = tmp_path / "programs"
    programs.mkdir()
    for name, text in (("renumberMesh", RENUMBER_MESH), ("flow", FLOW)):
        (programs / name).write_text(f"#!{sys.executable}\n" + text.format(tests=tests))
        (programs / name).chmod(0o755)
    folder.environment["PATH"] = f"{programs}:{os.environ['PATH']}"
    folder.before = folder.contents()
    return path


def test_the_cells_of_a_case_are_tried(folder, case):
    result = folder.json("cavity", "--methods", "auto,renumberMesh,scrambled", "--budget", "90", "--same", r"sum (\S+)",
                         "--json", "--", "flow")
    orders = by_name(result)
    assert list(orders) == ["original", "rcm", "renumberMesh", "scrambled"]
    assert result["verdict"] == "faster" and result["best"] == "rcm"
    assert orders["rcm"]["ratio"] > 1.2
    assert orders["rcm"]["order_seconds"] > 0
    assert not any(order["fault"] for order in result["orders"])
    command, move = result["order_command"].split(" && ")
    assert command == "meshorder openfoam cavity"
    assert move == "renumberMesh -case cavity -overwrite -dict system/renumberMeshDict"
    # the commands in the finding make that case
    folder.command.ok(*command.split()[1:])
    subprocess.run(move.split(), check=True, env=folder.environment, cwd=folder.path)
    import foam_cases
    assert foam_cases.figures(foam_cases.graph(case / "constant" / "polyMesh"))[0] < 60


def test_a_case_is_named_by_its_foam_file(folder, case):
    (case / "cavity.foam").write_text("")
    folder.before = folder.contents()
    kept = folder.path.parent / "kept"
    folder.json("cavity/cavity.foam", "--methods", "rcm", "--budget", "6", "--keep", str(kept), "--json", "--", "flow")
    assert (kept / "rcm" / "0.1" / "p").read_text() == "what the run leaves"
    assert (kept / "original" / "0.1" / "p").exists()
    moved = [float(x) for x in (kept / "rcm" / "0" / "p").read_text().split()]
    assert sorted(moved) == [float(cell) for cell in range(8 * 7 * 6)] and moved != sorted(moved)


@pytest.mark.parametrize("linked", ["0", "constant/polyMesh", "system"])
@pytest.mark.parametrize("method", ["rcm", "renumberMesh"])
def test_what_links_of_a_case_lead_to_stays(folder, case, linked, method):
    (folder.path / "elsewhere").mkdir()
    target = (case / linked).rename(folder.path / "elsewhere" / "folder")
    (case / linked).symlink_to(target)
    folder.before = folder.contents()
    assert any("elsewhere" in path.parts for path in folder.before)
    result = folder.json("cavity", "--methods", method, "--budget", "6", "--json", "--", "flow")
    assert by_name(result)[method]["fault"] is None


@pytest.mark.parametrize("place", ["", "constant", "constant/polyMesh", "system/.."])
def test_a_program_runs_on_the_copy_of_a_case(folder, case, place):
    fault = folder.fails("cavity", "--", "flow", "-case", str(case / place))
    assert fault.endswith("each run needs its own copy of it; write {} in its place")
    assert "did not read its copy of the mesh, constant/polyMesh" in folder.fails("cavity", "--", "/bin/true")
    script = "import pathlib, sys; (pathlib.Path(sys.argv[1].replace('+', '/')) / '0.02').mkdir()"
    folder.environment["SETTING"] = str(case)
    if landlock_version() >= 3:
        assert "cannot write" in folder.fails("cavity", "--", sys.executable, "-c", script, str(case).replace("/", "+"))


def test_a_case_with_meshes_of_processes_is_tried_only_without_them(folder, case):
    """A parallel program reads these meshes, which stay in their order."""
    (case / "processor0" / "constant" / "polyMesh").mkdir(parents=True)
    (case / "processor0" / "constant" / "polyMesh" / "owner").write_text("")
    folder.before = folder.contents()
    for options in ([], ["--with", "0,constant,system,processor0"]):
        fault = folder.fails("cavity", *options, "--", "flow")
        assert "others in processor folders" in fault and "--with 0,constant,system" in fault
    result = folder.json("cavity", "--methods", "rcm", "--budget", "6", "--with", "0,constant,system", "--json", "--", "flow")
    assert by_name(result)["rcm"]["fault"] is None


def test_faults_of_cases(folder, case):
    assert "there is no mesh of OpenFOAM" in folder.fails(".", "--", "flow")
    assert "there is no such order; give a vertex method" in folder.fails("cavity", "--methods", "lexmax", "--", "flow")
    assert "did you mean 'renumberMesh'?" in folder.fails("cavity", "--methods", "renumbermesh", "--", "flow")
    assert "no such numbers" in folder.fails("cavity", "--ids", "keep", "--", "flow")
    assert "no program to try" in folder.fails("cavity")
    (folder.path / "pieces" / "processor0" / "constant" / "polyMesh").mkdir(parents=True)
    fault = folder.fails("pieces", "--", "flow")
    assert "decomposed cases cannot be tried" in fault and "reconstructParMesh" in fault
    (case / "constant" / "polyMesh" / "owner").write_text("cut")
    folder.before = folder.contents()
    line = folder.fails("cavity", "--", "/bin/sh", "-c", "cat constant/polyMesh/owner")
    assert "cavity" in line and str(folder.temporary) not in line
    folder.environment["PATH"] = "/usr/bin:/bin"
    assert "renumberMesh" in folder.fails("cavity", "--", "/bin/true")
    assert "no program to try" in folder.fails("cavity")
