#!/usr/bin/env python3
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Writes the files that the unit tests hold as text in their sources, as further seeds:

    samples.py FOLDER

In few bytes, they use all features of their formats. Each constant of a test is an input of the family of that test;
TetGen's files are joined to one input, as fuzz/input_files.hpp describes.
"""
import ast
import pathlib
import re
import sys

TESTS = pathlib.Path(__file__).resolve().parents[1] / "tests"
# family: its test, and the beginning of each text that is a file
FAMILIES = {
    "medit": ("io/medit_test.cpp", ""), "vtk": ("vtk/vtk_legacy_test.cpp", "# vtk"), "vtu": ("vtk/vtu_test.cpp", "<"),
    "vega": ("io/vega_test.cpp", ""), "off": ("io/off_test.cpp", ""), "ply": ("io/ply_test.cpp", "ply"),
    "obj": ("io/obj_test.cpp", ""), "stl": ("io/stl_test.cpp", ""), "su2": ("io/su2_test.cpp", ""),
    "abaqus": ("io/abaqus_test.cpp", ""), "nastran": ("io/nastran_test.cpp", ""), "unv": ("io/unv_test.cpp", " "),
    "ucd": ("io/ucd_test.cpp", "#"),
    "xdmf": ("io/xdmf_test.cpp", "<"), "matrix": ("io/matrix_test.cpp", "%%"), "graph": ("io/matrix_test.cpp", ""),
}
NAME = r"^(?:constexpr std::string_view|const std::string) (k\w+)\s*=\s*"
PLAIN = re.compile(NAME + r'((?:"(?:\\.|[^"\\])*"\s*)+);', re.MULTILINE)
RAW = re.compile(NAME + r'R"\((.*?)\)";', re.MULTILINE | re.DOTALL)
LITERAL = re.compile(r'"(?:\\.|[^"\\])*"')
TETGEN = {"kNode": "mesh.node", "kEle": "mesh.ele", "kFace": "mesh.face", "kEdge": "mesh.edge"}


def constants(path):
    """Returns the texts of more than two lines in a source, by their names."""
    source = path.read_text(encoding="utf-8")
    found = dict(RAW.findall(source))
    for name, literals in PLAIN.findall(source):
        found.setdefault(name, "".join(ast.literal_eval(literal) for literal in LITERAL.findall(literals)))
    return {name: text for name, text in found.items() if text.count("\n") > 2}


def main():
    folder = pathlib.Path(sys.argv[1])
    inputs = [(family, name, text) for family, (test, start) in FAMILIES.items()
              for name, text in constants(TESTS / test).items() if text.startswith(start)]
    files = constants(TESTS / "io/tetgen_test.cpp")
    inputs.append(("tetgen", "all", files["kNode"] + "".join(f"\n%%file {file}\n{files[name]}"
                                                             for name, file in list(TETGEN.items())[1:])))
    for family, name, text in inputs:
        (folder / family).mkdir(parents=True, exist_ok=True)
        (folder / family / f"sample-{name}").write_bytes(text.encode("utf-8"))


if __name__ == "__main__":
    main()
