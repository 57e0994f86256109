# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The changes of a mesh that was written and read back, and whether the writer noted them."""

import dataclasses
from typing import Any

import meshorder
import numpy as np


@dataclasses.dataclass
class Changes:
    """Differences after writing and reading. `silent` lists those that no note of the writer mentions."""

    notes: list[str]
    silent: list[str] = dataclasses.field(default_factory=list)

    def unless_noted(self, what, *words):
        """Adds a difference unless one note has all the words."""
        if not any(all(word in note for word in words) for note in self.notes):
            self.silent.append(what)

    def of_name(self, what, name):
        """Adds a difference unless a note quotes the name, as it is or with its odd characters replaced."""
        quoted = [f"'{name}", *(f"'{name[:size]}" for size in (30, 40) if len(name) > size)]
        plain = "".join(c for c in name if c.isascii() and c.isalnum())
        told = [note for note in self.notes if "'" in note and plain in note] if plain != name else []
        if not told and not any(start in note for start in quoted for note in self.notes):
            self.silent.append(what)


def cell_keys(mesh):
    """A unique key of each cell: its shape, its vertices, and the number of equal cells before it."""
    seen: dict[Any, int] = {}
    keys = []
    for shape, rows in mesh.cells:
        for row in rows:
            key = (shape, tuple(sorted(row.tolist())))
            seen[key] = seen.get(key, -1) + 1
            keys.append((*key, seen[key]))
    return keys


def same_numbers(old, new):
    """Whether all values are equal; their types may differ. NaN equals NaN, 0.0 does not equal −0.0."""
    if np.shape(old) != np.shape(new):
        return False
    if old.dtype.kind in "iu" and new.dtype.kind in "iu":
        return [int(x) for x in old.ravel()] == [int(x) for x in new.ravel()]
    if old.dtype.kind in "iu" or new.dtype.kind in "iu":  # whole numbers that a float holds exactly
        pairs = zip(old.ravel().tolist(), new.ravel().tolist())
        return all(np.isfinite(x) and np.isfinite(y) and int(x) == int(y) and x == y for x, y in pairs)
    with np.errstate(invalid="ignore"):
        return new.dtype.kind == "f" and bool(
            np.all((np.isnan(old) & np.isnan(new)) | ((old == new) & (np.signbit(old) == np.signbit(new))))
        )


def arrays_of(mesh):
    return {
        (name, of_vertices): (values, rows)
        for name, of_vertices, values, rows in mesh._handle.data
        if not isinstance(values, list)
    }


def compare(before, after, notes):
    """Returns the changes that no note mentions, one line for each."""
    changes = Changes(notes)
    vertices = len(before.points)
    if len(after.points) != vertices:
        changes.unless_noted(f"{vertices} vertices became {len(after.points)}", "vertices")
        return changes.silent
    if not np.array_equal(before.points, after.points):
        changes.unless_noted("coordinates changed", "coordinate")
    old_keys, new_keys = cell_keys(before), cell_keys(after)
    place = {key: c for c, key in enumerate(new_keys)}
    for shape in {key[0] for key in set(old_keys) - place.keys()}:
        changes.unless_noted(f"cells of shape {shape} are lost", "left out")
    for shape in {key[0] for key in place.keys() - set(old_keys)}:
        changes.unless_noted(f"cells of shape {shape} came in", "cells")
    kept = [(c, place[key]) for c, key in enumerate(old_keys) if key in place]
    old_cells, new_cells = np.array(kept, dtype=int).reshape(-1, 2).T
    for c, d in kept:
        old, new = (mesh.connectivity[mesh.offsets[k] : mesh.offsets[k + 1]] for mesh, k in ((before, c), (after, d)))
        if not np.array_equal(old, new):
            changes.silent.append(f"the vertices of a cell of shape {old_keys[c][0]} are in another order")
            break
    compare_arrays(before, after, (old_cells, new_cells), changes)
    compare_sets(before, after, dict(kept), changes)
    for of, places in (("vertices", (slice(None), slice(None))), ("cells", (old_cells, new_cells))):
        old, new = ((m.vertex_ids if of == "vertices" else m.cell_ids) for m in (before, after))
        if len(old) and not (len(new) and np.array_equal(old[places[0]], new[places[1]])):
            if not any(("ids of " + of) in note or "renumbered" in note for note in notes):
                # the numbers that readers give by position
                given = np.arange(len(old)) + (1 if old.min() == 1 else 0)
                if not np.array_equal(old, given):
                    changes.silent.append(f"the ids of {of} are lost")
    return changes.silent


def compare_arrays(before, after, cells, changes):
    new_arrays = arrays_of(after)
    for (name, of_vertices), (values, rows) in arrays_of(before).items():
        if name == "label" and (not np.any(values) or np.all(values == 1)):
            continue  # 0 means no label; formats that require labels write 1 for all
        what = f"the array {name!r} on {'vertices' if of_vertices else 'cells'} ({values.dtype}, {values.shape})"
        new, new_rows = new_arrays.get((name, of_vertices), (None, ()))
        if new is not None and len(rows) == len(new_rows) == 0:
            old = values if of_vertices else values[cells[0]]
            fresh = new if of_vertices else new[cells[1]]
            if name == "label":  # cells without a label may get that of their set
                old, fresh = (numbers[np.atleast_1d(old != 0)] for numbers in (old, fresh))
            if same_numbers(old, fresh):
                continue
            what += f" changed from {old.ravel()[:9].tolist()} to {fresh.ravel()[:9].tolist()}"
        elif new is not None and len(rows) and len(new_rows):
            of_old = dict(zip(cells[0].tolist(), cells[1].tolist())) if not of_vertices else None
            old = {(r if of_old is None else of_old.get(r)): np.ravel(v).tolist() for r, v in zip(rows.tolist(), values)}
            fresh = {r: np.ravel(v).tolist() for r, v in zip(new_rows.tolist(), new)}
            if old == fresh:
                continue
            what += " on some rows changed"
        else:
            what += " is lost" if new is None else " covers other rows"
        if name == "label" and any("label" in note for note in changes.notes):
            continue
        changes.of_name(what, name)


def compare_sets(before, after, kept, changes):
    old, new = (
        {(name, of_vertices): sorted(members.tolist()) for name, of_vertices, members in mesh._handle.sets}
        for mesh in (before, after)
    )
    for (name, of_vertices), members in old.items():
        expected = members if of_vertices else sorted(kept[m] for m in members if m in kept)
        if new.get((name, of_vertices)) != expected:
            of = "vertices" if of_vertices else "cells"
            changes.of_name(f"the set {name!r} of {of} {expected} became {new.get((name, of_vertices))}", name)


class Unreadable(AssertionError):
    """Our reader refuses what our writer wrote."""


def hop(mesh, path):
    """Writes the mesh and reads it back. Returns the new mesh and the silent changes, or None if the writer refuses."""
    try:
        notes = meshorder.write(mesh, path)
    except meshorder.InputError:
        assert not path.exists()
        return None
    try:
        after = meshorder.read(path)
    except meshorder.Error as error:
        raise Unreadable(str(error)) from error
    return after, compare(mesh, after, notes)
