# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Fixtures of all tests under mpirun."""
import os
import tempfile

import pytest


@pytest.fixture(scope="session", autouse=True)
def folder_of_sessions():
    """Gives each test process its own folder for Open MPI's sessions: mpirun removes even a shared one at its end."""
    with tempfile.TemporaryDirectory(prefix="mpi-") as folder:
        os.environ["OMPI_MCA_orte_tmpdir_base"] = folder
        yield
        del os.environ["OMPI_MCA_orte_tmpdir_base"]
