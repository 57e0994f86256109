# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Every allocation fails once: the command reports it, leaves complete files, and neither aborts nor hangs."""
import collections
import errno
import resource

import pytest

import cases
import interposed
from interposed import Fault, spread


SET_UP = 3200  # allocations for the command's options, the same in all cases; `methods` makes no others


def places_of(case, name, most):
    """At most `most` allocations that are to fail, spread from the first after the set-up to the last."""
    first = 0 if name == "methods" else SET_UP
    return [first + place for place in spread(case.clean.calls["allocation"] - first, min(most, case.line.most))]


def failures_of(case, places, later=False):
    """Runs the case with a failure at each of these allocations. Returns the number of failures, the faults by place, and
    the number of failures that each foreign library mishandled."""
    failed, wrong, foreign = 0, {}, collections.Counter()
    for nth in places:
        ending = case.with_fault(Fault("allocation", nth, errno.ENOMEM, later))
        if ending.failures == 0:
            continue
        failed += 1
        faults = list(case.faults_of(ending, "allocation"))
        if faults and (culprit := ending.culprit()):
            foreign[culprit] += 1
            faults = list(case.faults_of_files())
        if faults:
            wrong[str(Fault("allocation", nth, errno.ENOMEM, later))] = faults
    return failed, wrong, foreign


def shown(name, failed, wrong, foreign):
    """The result as a line, and the first faults."""
    line = f"{name}: {failed} allocations failed, {len(wrong)} ended badly, in other libraries: {dict(foreign)}"
    return "\n".join([line, *(f"  {place}: {'; '.join(faults)}" for place, faults in list(wrong.items())[:8])])


@pytest.mark.parametrize("name", cases.COMMANDS)
def test_an_allocation_that_fails_is_reported(tmp_path, name):
    """Lets a few single allocations fail, then a few together with all later ones."""
    case = cases.case(name, tmp_path)
    places = places_of(case, name, 10)
    failed, wrong, foreign = failures_of(case, places)
    assert failed
    assert not wrong, shown(name, failed, wrong, foreign)
    failed, wrong, foreign = failures_of(case, places[::4], later=True)
    assert not wrong, shown(name, failed, wrong, foreign)


@pytest.mark.long
@pytest.mark.parametrize("name", cases.COMMANDS)
def test_every_allocation_that_fails_is_reported(tmp_path, name):
    case = cases.case(name, tmp_path)
    places = places_of(case, name, 4000)
    failed, wrong, foreign = failures_of(case, places)
    print(shown(name, failed, wrong, foreign))
    assert failed > 0.9 * len(places)
    assert not wrong, shown(name, failed, wrong, foreign)


@pytest.mark.parametrize("name", ["order with maps", "cgns in place", "order by spectral"])
def test_a_memory_limit_is_reported(tmp_path, name):
    """Limits of the address space: the first is too low to load the program, the last suffices."""
    case = cases.case(name, tmp_path)
    statuses = []
    for megabytes in range(60, 1100, 130):
        case.restore()
        limit = megabytes << 20
        ending = interposed.run(case.arguments, case.folder,
                                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        statuses.append(ending.status)
        if ending.status != 127:  # the loader's status
            assert not list(case.faults_of(ending)), (megabytes, list(case.faults_of(ending)))
    assert statuses[-1] == 0
