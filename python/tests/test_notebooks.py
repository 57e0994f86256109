# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Runs the notebooks of examples/notebooks from the first cell to the last.

They are stored with the output of their last run:

    jupyter execute --inplace --NotebookClient.record_timing=False examples/notebooks/*.ipynb
"""

import json
import pathlib
import re

import pytest

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")

FOLDER = pathlib.Path(__file__).parents[2] / "examples" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
pytestmark = pytest.mark.skipif(not NOTEBOOKS, reason="needs examples/notebooks")
NEEDS = {"assembly_orders": "skfem", "meshio_pipeline": "meshio", "scipy_solver": "scipy"}


def code_cells(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def test_there_are_notebooks():
    assert {path.stem for path in NOTEBOOKS} == set(NEEDS)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path):
    pytest.importorskip("matplotlib")
    pytest.importorskip(NEEDS[path.stem])
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in code_cells(notebook) for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert not [output for output in outputs if output.get("name") == "stderr"]
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_as_one_run_left_it(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    assert [cell.execution_count for cell in code_cells(notebook)] == list(range(1, len(code_cells(notebook)) + 1))
    assert not [output for cell in code_cells(notebook) for output in cell.outputs if output.output_type == "error"]
    assert path.stat().st_size < 500_000
    texts = [[cell.source, [output.get("text", "") for output in cell.get("outputs", [])]] for cell in notebook.cells]
    assert not re.search(r"/(tmp|home|root|work|Users)/", json.dumps(texts))


def test_show_appears_in_the_notebook_and_opens_no_browser():
    code = """
import webbrowser
webbrowser.open = None  # would fail
import numpy as np, meshorder
try:
    shown = meshorder.show((np.eye(4, 3), np.arange(4)[np.newaxis]))
except meshorder.Unavailable:
    shown = None
shown"""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)])
    nbclient.NotebookClient(notebook, timeout=120).execute()
    outputs = notebook.cells[0].outputs
    if not outputs:
        pytest.skip("this build is without three.js")
    assert outputs[0].data["text/html"].startswith("<iframe") and "4 triangles" in outputs[0].data["text/plain"]
