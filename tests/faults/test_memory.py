# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Every allocation fails once: the command says so, leaves whole files, and neither aborts nor hangs."""
import collections
import errno
import resource

import pytest

import cases
import interposed
from interposed import Fault, spread


def failures_of(case, places, later=False):
    """Runs the case with a failure at each of these allocations. Returns how many failed, what was wrong, by the place, and
    what other libraries did."""
    failed, wrong, foreign = 0, {}, collections.Counter()
    for nth in places:
        ending = case.with_fault(Fault("allocation", nth, errno.ENOMEM, later))
        if ending.failures == 0:
            continue
        failed += 1
        faults = list(case.faults_of(ending))
        if faults and (culprit := ending.culprit()):
            foreign[culprit] += 1
            faults = list(case.faults_of_files(killed=True))
        if faults:
            wrong[str(Fault("allocation", nth, errno.ENOMEM, later))] = faults
    return failed, wrong, foreign


def shown(name, failed, wrong, foreign):
    """The result as a line, and the first faults."""
    line = f"{name}: {failed} allocations failed, {len(wrong)} ended badly, in other libraries: {dict(foreign)}"
    return "\n".join([line, *(f"  {place}: {'; '.join(faults)}" for place, faults in list(wrong.items())[:8])])


@pytest.mark.parametrize("name", cases.COMMANDS)
def test_an_allocation_that_fails_is_told(tmp_path, name):
    """A few of them: those that set up the command are the same in each."""
    case = cases.case(name, tmp_path)
    first = 1 if name == "methods" else 3300
    count = case.clean.calls["allocation"]
    places = [first + place for place in spread(count - first, 16)]
    failed, wrong, foreign = failures_of(case, places)
    assert failed > 10
    assert not wrong, shown(name, failed, wrong, foreign)
    failed, wrong, foreign = failures_of(case, places[::5], later=True)
    assert not wrong, shown(name, failed, wrong, foreign)


@pytest.mark.long
@pytest.mark.parametrize("name", cases.COMMANDS)
def test_every_allocation_that_fails_is_told(tmp_path, name, record_property):
    case = cases.case(name, tmp_path)
    first = 1 if name in ("methods", "order with maps") else 3200
    failed, wrong, foreign = failures_of(case, range(first, case.clean.calls["allocation"] + 1))
    record_property("allocations", failed)
    print(shown(name, failed, wrong, foreign))
    assert failed > 100
    assert not wrong, shown(name, failed, wrong, foreign)


@pytest.mark.parametrize("name", ["order with maps", "cgns in place", "order by spectral"])
def test_a_limit_on_memory_is_told(tmp_path, name):
    """From a limit at which the program cannot be loaded to one that suffices."""
    case = cases.case(name, tmp_path)
    statuses = []
    for megabytes in range(40, 1200, 60):
        case.restore()
        limit = megabytes << 20
        ending = interposed.run(case.arguments, case.folder,
                                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        statuses.append(ending.status)
        if ending.status != 127:  # the loader's own
            assert not list(case.faults_of(ending)), (megabytes, list(case.faults_of(ending)))
    assert statuses[-1] == 0
