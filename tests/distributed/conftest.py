# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""What all tests under mpirun share."""
import os
import tempfile

import pytest


@pytest.fixture(scope="session", autouse=True)
def folder_of_sessions():
    """A folder for the sessions of each test process: one mpirun that ends removes what another one that begins has just found."""
    with tempfile.TemporaryDirectory(prefix="mpi-") as folder:
        os.environ["OMPI_MCA_orte_tmpdir_base"] = folder
        yield
        del os.environ["OMPI_MCA_orte_tmpdir_base"]
