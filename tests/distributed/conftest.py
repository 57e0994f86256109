# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""What all tests under mpirun share."""
import os
import tempfile

import pytest


@pytest.fixture(scope="session", autouse=True)
def folder_of_sessions():
    """Gives each test process a folder for Open MPI's sessions: an mpirun that ends removes a folder that it shares with others."""
    with tempfile.TemporaryDirectory(prefix="mpi-") as folder:
        os.environ["OMPI_MCA_orte_tmpdir_base"] = folder
        yield
        del os.environ["OMPI_MCA_orte_tmpdir_base"]
