# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The order of calls: all new files are synced before the first one replaces an old file; their folders are synced last."""
import pathlib

import pytest

import cases
import interposed


def calls_of(case, log):
    """The calls that change files: the verb, then absolute paths."""
    case.restore()
    ending = interposed.run(case.arguments, case.folder, log=log)
    assert ending.status == 0, ending.stderr
    for line in ending.log.splitlines():
        verb, *paths = line.split(" ")
        yield verb, *[str((case.folder / path).resolve()) for path in paths]


def moved(path, source, target):
    """Where a path is after a rename of itself or of a folder that it is in."""
    below = pathlib.PurePath(path).is_relative_to(source)
    return str(pathlib.PurePath(target) / pathlib.PurePath(path).relative_to(source)) if below else path


@pytest.mark.parametrize("name", ["order with maps", "apply", "openfoam", "simulate", *cases.OVER])
def test_files_are_on_the_disk_before_they_replace_others(tmp_path, name):
    case = cases.case(name, tmp_path)
    calls = list(calls_of(case, tmp_path / "log"))
    targets = {str(case.folder / path) for path in case.new
               if case.new[path] is not None and case.new[path] != case.old.get(path)}
    renames = [at for at, (verb, *paths) in enumerate(calls) if verb == "rename" and paths[1] in targets]
    assert {calls[at][2] for at in renames} == targets, "a target was written in place"
    groups = [renames] if case.line.together else [[at] for at in renames]
    for group in groups:
        for at in group:
            state, path = "not written", calls[at][2]
            # backwards from the rename: the file's earlier path, and the last write or sync
            for verb, *paths in reversed(calls[:at + 1]):
                if verb == "rename":
                    path = moved(path, paths[1], paths[0])
                elif verb in ("write", "sync") and paths[0] == path:
                    state = verb
                    break
            assert state == "sync", f"{calls[at][2]}: its last call before the rename is {state}"
        begin, end = group[0], group[-1]
        late = [paths[0] for verb, *paths in calls[begin:end] if verb == "write"]
        assert not late, f"written between the renames: {late}"
        synced_later = {paths[0] for verb, *paths in calls[end + 1:] if verb == "sync"}
        for at in group:
            folder = str(pathlib.PurePath(calls[at][2]).parent)
            assert folder in synced_later, f"{folder} is not synced after the rename"
