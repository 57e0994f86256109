# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
import os

# what is predicted is the same on every machine, and none is measured first
os.environ["MESHORDER_MACHINE"] = "zen3"


def pytest_configure(config):
    config.addinivalue_line("markers", "package: of the package and of what the public headers promise")
