# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Files that belong together, such as a mesh and its maps: if a call fails, all stay the old ones."""
import itertools

import pytest

import cases
import interposed
from interposed import Fault, spread

SETS = ("order with maps", "openfoam", "node in place", "xdmf in place", "node over another")


def faults_of_set(case, kind, nth, what):
    """The faults of the files after a failed call, as sentences."""
    ending = case.with_fault(Fault(kind, nth, what))
    yield from case.faults_of(ending, kind)
    if ending.status != 0:
        yield from case.faults_of_set("old")


@pytest.mark.parametrize("name", SETS)
def test_a_call_that_fails_leaves_all_old_files(tmp_path, name):
    case = cases.case(name, tmp_path)
    for kind in ("open", "write", "sync", "close", "rename"):
        errors = itertools.cycle(error for error in interposed.ERRORS[kind] if error != "short")
        for nth in spread(case.clean.calls[kind], 8):
            what = next(errors)
            faults = list(faults_of_set(case, kind, nth, what))
            assert not faults, (str(Fault(kind, nth, what)), faults)
