# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Import paths and environment of the manual's tests."""

import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
for folder in ("tests/command", "docs/site", "scripts"):
    sys.path.insert(0, str(ROOT / folder))
# the same predictions on every machine, and no measurement before them
os.environ["MESHORDER_MACHINE"] = "zen3"
