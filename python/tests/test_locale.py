# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""A process whose locale has decimal commas reads, writes and orders like any other."""

import os
import pathlib
import shutil
import subprocess
import sys

import pytest

DEFINITION = pathlib.Path("/usr/share/i18n/locales/de_DE")
PROGRAM = """
import hashlib, locale, sys
locale.setlocale(locale.LC_ALL, sys.argv[1])
assert locale.localeconv()["decimal_point"] == sys.argv[2]
import meshorder, numpy as np
points = np.array([[0.25, 0.5, 1e-3], [1.125, 0, 0], [0, 1.5, 0], [0, 0, 1234567.75], [2.5, 2.5, 2.5]])
mesh = meshorder.make_mesh(points, {"tetrahedron": np.array([[0, 1, 2, 3], [1, 2, 3, 4]])})
mesh._handle.add_data("heat", True, points[:, 0].copy())
for name, _, single in meshorder._core.formats():
    try:
        made = meshorder.to_bytes(mesh, name)
    except meshorder.Error as refused:
        print(name, refused)
        continue
    if name not in ("cgns", "med"):  # which hold the time
        print(name, hashlib.sha256(made).hexdigest())
    again = meshorder.read(made, name)
    print(name, again.points.tolist(), {key: value.tolist() for key, value in again.point_data.items()})
grid = np.arange(400).reshape(20, 20)
cells = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=-1).reshape(-1, 4)
places = np.stack([np.arange(400) % 20 * 0.1, np.arange(400) // 20 * 0.3], axis=1)
for method in ("fiedler", "minla", "spectral", "hilbert", "rcm"):
    print(method, meshorder.order_mesh(places, {"quad": cells}, vertices=method).vertices.new_to_old.tolist())
print(meshorder.make_mesh(places, {"quad": cells}))
"""


def said(name, point, **environment):
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, name, point],
        capture_output=True, text=True, env={**os.environ, **environment}, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_decimal_commas_change_nothing(tmp_path):
    if not (shutil.which("localedef") and DEFINITION.exists()):
        pytest.skip("there are no sources of locales")
    subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", tmp_path / "de_DE.UTF-8"], check=True)
    expected = said("C", ".")
    assert "1234567.75" in expected
    assert said("de_DE.UTF-8", ",", LOCPATH=str(tmp_path)) == expected
