# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
def pytest_configure(config):
    config.addinivalue_line("markers", "package: of the package and of what the public headers promise")
