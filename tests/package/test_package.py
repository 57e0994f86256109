# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The package as another project uses it: installed, by pkg-config, and as a subproject.

MESHORDER_BUILD names the build folder to install; the default is build/. MESHORDER_USER_BUILD names the folder in which
the subproject is built and kept for the next run; the default is build-package/.
"""
import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess

import pytest

pytestmark = pytest.mark.package
ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("MESHORDER_BUILD", ROOT / "build"))
USER_BUILD = pathlib.Path(os.environ.get("MESHORDER_USER_BUILD", ROOT / "build-package"))
USER = ROOT / "tests" / "package" / "user"
FORTRAN = shutil.which("gfortran")


def run(*command, status=0, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, timeout=900,
                          **options)
    assert done.returncode == status, f"{' '.join(map(str, command))}\n{done.stdout}\n{done.stderr}"
    return done.stdout + done.stderr


def cache_value(name):
    return re.search(rf"^{name}:\w+=(.*)$", (BUILD / "CMakeCache.txt").read_text(), re.MULTILINE)[1]


def configure(source, build, *options):
    """Runs CMake with the compilers of the build, and ccache if the build uses it. Returns CMake's output."""
    launcher = re.search(r"^CMAKE_CXX_COMPILER_LAUNCHER:\w+=(.+)$", (BUILD / "CMakeCache.txt").read_text(),
                         re.MULTILINE)
    return run("cmake", "-S", source, "-B", build, "-G", "Ninja",
               f"-DCMAKE_CXX_COMPILER={cache_value('CMAKE_CXX_COMPILER')}",
               f"-DCMAKE_C_COMPILER={cache_value('CMAKE_C_COMPILER')}",
               *([f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher[1]}"] if launcher else []), *options)


def run_tests(build, expected):
    said = run("ctest", "--test-dir", build, "--output-on-failure", "--no-tests=error")
    assert f"100% tests passed, 0 tests failed out of {expected}" in said


@pytest.fixture(scope="session")
def prefix(tmp_path_factory):
    """An installed tree that was moved after its installation."""
    folder = tmp_path_factory.mktemp("package")
    run("cmake", "--install", BUILD, "--prefix", folder / "installed")
    (folder / "installed").rename(folder / "moved")
    return folder / "moved"


@pytest.fixture
def environment(prefix):
    """The environment for programs that are linked with the installed libraries, and for pkg-config."""
    folder = next(prefix.glob("**/pkgconfig")).parent
    assert folder.is_relative_to(prefix / "lib")
    return {**os.environ, "PKG_CONFIG_PATH": str(folder / "pkgconfig"), "LD_LIBRARY_PATH": str(folder)}


# ---- build options

CHOICES = [
    *(["--preset", preset["name"]] for preset in json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]
      if not preset.get("hidden") and preset["name"] != "browser"),  # which needs emscripten
    ["-DMESHORDER_CLI=OFF", "-DMESHORDER_TESTS=OFF"],
    ["-DMESHORDER_CLI=OFF", "-DMESHORDER_TESTS=OFF", "-DMESHORDER_COMPONENTS=core;c"],
    ["-DMESHORDER_LAB=OFF", "-DMESHORDER_TESTS=OFF"],
    ["-DMESHORDER_HDF5=OFF", "-DMESHORDER_NETCDF=OFF", "-DMESHORDER_CGNS=OFF", "-DMESHORDER_TESTS=OFF"],
]


@pytest.mark.parametrize("options", CHOICES, ids=" ".join)
def test_all_that_is_chosen_can_be_built(tmp_path, options):
    run("cmake", "-S", ROOT, "-B", tmp_path, "-G", "Ninja", *options, cwd=ROOT)
    run("ninja", "-C", tmp_path, "-n")  # fails if no rule makes a needed file
    assert "-Werror" not in (tmp_path / "build.ninja").read_text(), "a newer compiler's warning must not stop users"


def test_only_the_projects_own_tests_make_warnings_errors():
    for path in ("pyproject.toml", "CMakePresets.json", "run", "scripts/setup.sh", "packaging/spack/package.py"):
        assert "MESHORDER_WERROR" not in (ROOT / path).read_text(), path
    for path in ("test", "scripts/test-hosts"):
        assert "-DMESHORDER_WERROR=ON" in (ROOT / path).read_text(), path


# ---- installed files


def test_installed_files_name_no_folder_of_the_build(prefix):
    for path in prefix.rglob("*"):
        if path.suffix in (".cmake", ".pc", ".hpp", ".h", ".fish", "") and path.is_file() and path.parent.name != "bin":
            text = path.read_text(encoding="utf-8")
            for folder in (ROOT, BUILD, prefix.parent / "installed"):
                assert str(folder) not in text, path
            # system libraries by name, never by path
            if path.suffix in (".cmake", ".pc"):
                assert not re.search(r"/usr/\S+\.(so|a)\b", text), path


def test_staged_tree_has_all_files_below_the_stage(tmp_path):
    run("cmake", "--install", BUILD, "--prefix", "/opt/meshorder", env={**os.environ, "DESTDIR": str(tmp_path)})
    assert [path.name for path in tmp_path.iterdir()] == ["opt"]
    assert (tmp_path / "opt/meshorder/include/meshorder.h").exists()


def without_comments(text):
    return re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)


def test_public_headers_are_few_and_name_no_other_library(prefix):
    headers = [path for path in (prefix / "include").rglob("*") if path.is_file()]
    assert 10 <= len(headers) <= 26
    for path in headers:
        if path.name == "eigen.hpp":
            continue  # whoever includes it brings Eigen
        found = re.findall(r"\b(?:tbb|eigen|fmt|metis|hwy)\b", without_comments(path.read_text(encoding="utf-8")),
                           re.IGNORECASE)
        assert not found, path


def test_the_header_for_eigen_is_installed_and_compiles(prefix, tmp_path):
    if not pathlib.Path("/usr/include/eigen3").exists():
        pytest.skip("no Eigen")
    (tmp_path / "eigen.cpp").write_text("#include <meshorder/eigen.hpp>\n")
    run("c++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{prefix / 'include'}",
        "-isystem", "/usr/include/eigen3", tmp_path / "eigen.cpp")


@pytest.mark.parametrize("compiler", ["c++", "clang++"])
def test_public_headers_compile_as_those_of_a_shared_library(prefix, tmp_path, compiler):
    if not shutil.which(compiler):
        pytest.skip(f"no {compiler}")
    (tmp_path / "all.cpp").write_text("#include <meshorder/meshorder.hpp>\n")
    run(compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-DMESHORDER_SHARED",
        f"-I{prefix / 'include'}", tmp_path / "all.cpp")


def test_the_installed_command_works(prefix, tmp_path):
    (tmp_path / "path.off").write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n")
    run(prefix / "bin" / "meshorder", "order", "path.off", "-o", "ordered.off", cwd=tmp_path)
    assert (tmp_path / "ordered.off").exists()


def test_every_subcommand_has_a_manual_page(prefix, tmp_path):
    pages = {path.name.removesuffix(".1.gz"): path for path in (prefix / "share/man/man1").glob("*.1.gz")}
    listed = run(prefix / "bin" / "meshorder", "--help").split("Subcommands:\n")[1]
    for name in re.findall(r"^  (\w+)", listed, re.MULTILINE):
        text = gzip.decompress(pages.pop(f"meshorder-{name}").read_bytes()).decode()
        for section in ("NAME", "SYNOPSIS", "OPTIONS", "EXAMPLES", "SEE ALSO"):
            assert f".SH {section}\n" in text, name
    assert set(pages) == {"meshorder", "meshorder-models-list", "meshorder-models-make"}
    if shutil.which("groff"):
        for path in (prefix / "share/man/man1").glob("*.gz"):
            (tmp_path / "page.1").write_bytes(gzip.decompress(path.read_bytes()))
            assert run("groff", "-K", "utf8", "-man", "-ww", "-z", tmp_path / "page.1") == "", path


@pytest.mark.parametrize("typed, completed", [
    ("meshorder o", "order openfoam"),
    ("meshorder models ", "list make"),
    ("meshorder order --vert", "--vertices"),
    ("meshorder order mesh.off --vertices lex", ""),
    ("meshorder order mesh.off --elements lex", "lexmax"),
    ("meshorder simulate --order hilb", "hilbert hilbert-fronts"),
    ("meshorder models make dr", "dragon"),
    ("meshorder compare mesh.off --methods rcm,hilb", "rcm,hilbert rcm,hilbert-fronts"),
    ("meshorder compare mesh.off --methods rcm,bfs,mo", "rcm,bfs,morton"),
    ("meshorder order mesh.off --vertices rcm,hilb", ""),
    ("meshorder info mesh.off --machine ", "this zen3"),
    ("meshorder order ", ""),  # files
])
def test_bash_completes(prefix, typed, completed):
    file = prefix / "share/bash-completion/completions/meshorder"
    script = f"""source {file}; IFS=' ' read -ra COMP_WORDS <<<'{typed}'; [ "{typed[-1]}" != ' ' ] || COMP_WORDS+=('')
        COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _meshorder; echo "${{COMPREPLY[*]}}" """
    assert run("bash", "-c", script).strip() == completed


@pytest.mark.parametrize("shell, file", [("zsh", "zsh/*/_meshorder"),
                                         ("fish", "fish/vendor_completions.d/meshorder.fish")])
def test_completions_of_other_shells_are_sound(prefix, shell, file):
    if not shutil.which(shell):
        pytest.skip(f"no {shell}")
    run(shell, "-n", next((prefix / "share").glob(file)))


# ---- use by other projects


def test_find_package(prefix, tmp_path, environment):
    said = configure(USER, tmp_path, f"-DCMAKE_PREFIX_PATH={prefix}")
    assert "METIS: O" in said
    run("cmake", "--build", tmp_path)
    run_tests(tmp_path, 3 if FORTRAN else 2)
    assert environment


@pytest.mark.parametrize("request_, reason", [
    ("0.3 COMPONENTS c", None),
    ("0.2", "0.3.0"),
    ("0.4", "0.3.0"),
    ("0.3 COMPONENTS c gpu", "the component 'gpu' is not installed; installed are c, core"),
    ("0.3 COMPONENTS Core", "the component 'Core' is not installed; installed are c, core"),
    ("0.3 COMPONENTS c OPTIONAL_COMPONENTS gpu", None),
])
def test_find_package_says_what_is_missing(prefix, tmp_path, request_, reason):
    (tmp_path / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.25)\nproject(asks LANGUAGES C)\nfind_package(meshorder {request_} REQUIRED)\n"
        "if(meshorder_gpu_FOUND OR NOT TARGET meshorder::c OR TARGET meshorder::core)\n  message(FATAL_ERROR wrong)\n"
        "endif()\n")
    said = run("cmake", "-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}",
               status=0 if reason is None else 1)
    assert reason is None or reason in " ".join(said.split())


def test_pkg_config(prefix, tmp_path, environment):
    def flags(module):
        return run("pkg-config", "--cflags", "--libs", module, env=environment).split()

    compilers = [("cpp", cache_value("CMAKE_CXX_COMPILER"), "-std=c++20", "core"),
                 ("c", cache_value("CMAKE_C_COMPILER"), "-std=c99", "c")]
    if FORTRAN:
        compilers.append(("f90", FORTRAN, "-std=f2008", "c"))
    for suffix, compiler, standard, component in compilers:
        run(compiler, standard, USER / f"order.{suffix}", *flags(f"meshorder-{component}"), "-o", tmp_path / suffix,
            env=environment)
        run(tmp_path / suffix, env=environment)
    assert run("pkg-config", "--modversion", "meshorder-io", env=environment).strip() == cache_value(
        "CMAKE_PROJECT_VERSION")
    run("pkg-config", "--validate", "meshorder-payoff", env=environment)
    assert prefix.exists()


def test_the_lines_of_the_manual_make_programs_that_start(prefix, tmp_path):
    lines = re.search(r"^export PKG_CONFIG_PATH=.*?(?=^```)", (ROOT / "docs" / "install.md").read_text(),
                      re.MULTILINE | re.DOTALL)[0]
    (tmp_path / "meshorder").symlink_to(prefix)
    programs = 0
    for suffix in ("cpp", "c", "f90"):
        if suffix == "f90" and not FORTRAN:
            continue
        shutil.copy(USER / f"order.{suffix}", tmp_path / f"solver.{suffix}")
        [line] = [line for line in lines.splitlines() if f"solver.{suffix} " in line]
        without = {name: value for name, value in os.environ.items() if name != "LD_LIBRARY_PATH"}
        run("bash", "-ec", f"{lines.splitlines()[0]}\n{line}\n./solver", cwd=tmp_path,
            env={**without, "HOME": str(tmp_path)})
        programs += 1
    assert programs >= 2


@pytest.mark.parametrize("header", ["meshorder.hpp", "order.hpp"])
def test_headers_ask_for_the_standard_that_they_need(prefix, tmp_path, header):
    (tmp_path / "old.cpp").write_text(f"#include <meshorder/{header}>\n")
    said = run("c++", "-std=c++17", "-fsyntax-only", f"-I{prefix / 'include'}", tmp_path / "old.cpp", status=1)
    errors = [line for line in said.splitlines() if ": error: " in line]
    assert "meshorder needs C++20" in errors[0]


@pytest.mark.parametrize("source, options", [("matrix_test", True), ("plex_test", False)])
def test_the_plugin_for_petsc(prefix, tmp_path, environment, source, options):
    """PETSc loads the plugin into a program, and the plugin finds its library beside itself; another program links to it."""
    plugin = prefix / "lib" / "libmeshorder_petsc.so"
    if not plugin.exists():
        pytest.skip("built without MESHORDER_PETSC")
    module = "PETSc" if options else "meshorder-petsc"
    flags = run("pkg-config", "--cflags", "--libs", module, env=environment).split()
    run("mpicc", ROOT / "plugins" / "petsc" / f"{source}.c", *flags, "-lm", "-o", tmp_path / source, env=environment)
    if options:
        run(tmp_path / source, "-dll_append", plugin, env={**os.environ, "OMPI_MCA_plm": "isolated"})
    else:
        run(tmp_path / source, env={**environment, "OMPI_MCA_plm": "isolated"})


@pytest.mark.parametrize("by", ["find_package", "pkg-config"])
def test_the_library_for_many_ranks(prefix, tmp_path, environment, by):
    if not (prefix / "lib" / "libmeshorder_mpi.so").exists():
        pytest.skip("built without MESHORDER_MPI")
    source = ROOT / "examples" / "ranks_of_a_solver.cpp"
    if by == "find_package":
        (tmp_path / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(solver LANGUAGES C CXX)\n"
            "find_package(meshorder 0.3 REQUIRED COMPONENTS mpi)\n"
            f"add_executable(solver {source})\ntarget_link_libraries(solver PRIVATE meshorder::mpi)\n")
        configure(tmp_path, tmp_path, f"-DCMAKE_PREFIX_PATH={prefix}")
        run("cmake", "--build", tmp_path)
    else:
        flags = run("pkg-config", "--cflags", "--libs", "meshorder-mpi", env=environment).split()
        run("mpicxx", "-std=c++20", source, *flags, "-o", tmp_path / "solver", env=environment)
    said = run("mpirun", "--oversubscribe", "--bind-to", "none", "-n", "2", tmp_path / "solver",
               env={**environment, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
    assert said.count("mean span") == 2


def test_subproject():
    """The core without METIS, within a project that sets no build type. Compiled files are kept."""
    said = configure(USER, USER_BUILD, "--fresh", f"-DMESHORDER_SOURCE={ROOT}", "-DMESHORDER_METIS=OFF")
    assert "Warning" not in said
    rules = (USER_BUILD / "build.ninja").read_text()
    assert "-Werror" not in rules and "gtest" not in rules and "march" not in rules
    assert " -O3 -DNDEBUG" in rules, "optimised where nobody says how"
    assert "ordering/metis.cpp" not in rules, "what needs METIS's header is left out"
    run("cmake", "--build", USER_BUILD)
    run_tests(USER_BUILD, 1)
    assert not list(USER_BUILD.rglob("cmake_install.cmake")) or not list(USER_BUILD.rglob("meshorder-config.cmake"))
