# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Where the manual's tests find what they test."""

import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
for folder in ("tests/command", "docs/site", "scripts"):
    sys.path.insert(0, str(ROOT / folder))
# what is predicted is the same on every machine, and none is measured first
os.environ["MESHORDER_MACHINE"] = "zen3"
