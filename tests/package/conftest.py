# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
import os

# the same predictions on every machine, and no measurement before them
os.environ["MESHORDER_MACHINE"] = "zen3"


def pytest_configure(config):
    config.addinivalue_line("markers", "package: of the package and of what the public headers promise")
