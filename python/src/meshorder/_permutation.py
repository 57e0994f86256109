# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Permutations, and moving what belongs to the things that they permute."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from . import _core, _html
from ._arrays import integers
from ._errors import InvalidArgument


class Permutation:
    """Places of n things before and after they moved. Immutable.

    Both directions have names, since they are easily taken for each other:

    - ``old_to_new[i]`` is the new place of what stood at place i;
    - ``new_to_old[k]`` is the old place of what stands at place k now, so that ``a[p.new_to_old]`` moves the rows
      of an array and ``A[p.new_to_old][:, p.new_to_old]`` a matrix.

    Args:
        old_to_new: makes a permutation of this map; or
        new_to_old: of this one. Exactly one must be given.

    Raises:
        InvalidArgument: the map is no bijection of 0 … n−1.
    """

    __slots__ = ("_handle",)
    _handle: _core.Permutation

    def __init__(self, *, old_to_new: Any = None, new_to_old: Any = None) -> None:
        if (old_to_new is None) == (new_to_old is None):
            raise InvalidArgument("Permutation: give exactly one of old_to_new and new_to_old")
        if old_to_new is not None:
            made = _core.Permutation.from_old_to_new(integers(old_to_new, "old_to_new"))
        else:
            made = _core.Permutation.from_new_to_old(integers(new_to_old, "new_to_old"))
        object.__setattr__(self, "_handle", made)

    @classmethod
    def _of(cls, made: _core.Permutation) -> Permutation:
        permutation = cls.__new__(cls)
        object.__setattr__(permutation, "_handle", made)
        return permutation

    @classmethod
    def identity(cls, n: int) -> Permutation:
        """The permutation of n things that moves none."""
        return cls(old_to_new=np.arange(n, dtype=np.int32))

    @property
    def old_to_new(self) -> NDArray[np.int32]:
        """The new place of each old thing; read-only, without a copy."""
        return self._handle.old_to_new

    @property
    def new_to_old(self) -> NDArray[np.int32]:
        """The old place of what stands at each place; read-only, without a copy."""
        return self._handle.new_to_old

    def inverse(self) -> Permutation:
        """The permutation that moves everything back."""
        return Permutation._of(self._handle.inverse())

    def then(self, other: Permutation) -> Permutation:
        """This permutation followed by another."""
        return Permutation._of(self._handle.then(other._handle))

    def repeated(self, components: int, node_major: bool = True) -> Permutation:
        """The permutation of degrees of freedom, some for each thing.

        Args:
            components: of each thing, ≥ 1.
            node_major: component c of thing i has the number ``components * i + c``, else ``c * n + i``.
        """
        return Permutation._of(self._handle.repeated(components, node_major))

    def move(self, a: Any, axis: int = 0, out: NDArray[Any] | None = None) -> Any:
        """What belongs to the things, moved with them.

        Args:
            a: an array, a list, a pandas object, or a square SciPy matrix, whose rows and columns move.
            axis: of an array or a pandas object, the number of the one that the things lie along.
            out: an array to write to, of the same shape and type; of arrays only.

        Returns:
            The same kind of object; ``out`` if it is given.

        Raises:
            InvalidArgument: ``a`` has not as many things as the permutation, or ``axis`` and ``out`` are not for it.
        """
        if hasattr(a, "iloc"):
            return self._move_pandas(a, axis, out)
        if hasattr(a, "tocsr") and hasattr(a, "nnz"):
            _refuse(axis, out, "a matrix")
            return self._move_matrix(a)
        if isinstance(a, (list, tuple)):
            _refuse(axis, out, "a list")
            if len(a) != len(self):
                raise InvalidArgument(f"move: {len(a)} entries for a permutation of {len(self)}")
            return type(a)([a[k] for k in self.new_to_old])
        array = np.asanyarray(a)
        self._check_shape(array.shape, axis)
        if out is not None and not _takes(out, array):
            raise InvalidArgument("move: out must be contiguous and writeable, with the shape and type of the array")
        plain = array.flags.c_contiguous and not array.dtype.hasobject and not isinstance(array, np.ma.MaskedArray)
        if axis not in (0, -array.ndim) or not plain:
            return np.take(array, self.new_to_old, axis=axis, out=out)
        if out is None:
            out = np.empty_like(array)
        if array.size:
            self._handle.move_rows(_bytes_of(array), _bytes_of(out))
        return out

    def _check_shape(self, shape: tuple[int, ...], axis: int) -> None:
        if axis not in range(-len(shape), len(shape)) or shape[axis] != len(self):
            raise InvalidArgument(f"move: axis {axis!r} of the shape {shape} for a permutation of {len(self)}")

    def _move_pandas(self, a: Any, axis: int, out: Any) -> Any:
        _refuse(0, out, "a pandas object")
        self._check_shape(a.shape, axis)
        return a.iloc[self.new_to_old] if axis % a.ndim == 0 else a.iloc[:, self.new_to_old]

    def _move_matrix(self, a: Any) -> Any:
        matrix = a.tocsr()
        n = len(self)
        if matrix.shape != (n, n):
            raise InvalidArgument(f"move: a matrix of shape {matrix.shape} for a permutation of {n}")
        indptr, indices = integers(matrix.indptr, "indptr"), integers(matrix.indices, "indices")
        values = np.ascontiguousarray(matrix.data)
        moved = np.empty_like(indptr), np.empty_like(indices), np.empty_like(values)
        self._handle.move_matrix(indptr, indices, values.view(np.uint8), moved[0], moved[1], moved[2].view(np.uint8))
        result = type(matrix)((moved[2], moved[1], moved[0]), shape=matrix.shape)
        return result.asformat(a.format)

    def renumber(self, numbers: Any, out: NDArray[Any] | None = None) -> NDArray[Any]:
        """Numbers of things, as a mesh's connectivity has them, replaced by the new ones.

        Args:
            numbers: integers of 0 … n−1, of any shape.
            out: an array to write to, of the same shape and of 32 or 64 bits; ``out=numbers`` works in place.
        """
        if out is None:
            out = integers(numbers, "numbers", rank=None).copy()
        elif not isinstance(out, np.ndarray) or not out.flags.c_contiguous or not out.flags.writeable:
            raise InvalidArgument("renumber: out must be a contiguous and writeable array")
        elif out is not numbers:
            renumbered = self.renumber(numbers)  # before the numbers take another type
            if out.shape != renumbered.shape or out.dtype.kind not in "iu" or out.dtype.itemsize < 4:
                raise InvalidArgument("renumber: out must have the shape of the numbers, and 32 or 64 bits")
            np.copyto(out, renumbered, casting="unsafe")
            return out
        self._handle.renumber(out.reshape(-1), 0)
        return out

    def as_matrix(self) -> Any:
        """A SciPy LinearOperator P with ``P @ x == move(x)``."""
        from scipy.sparse.linalg import LinearOperator

        n = len(self)
        return LinearOperator(
            (n, n),
            matvec=lambda x: np.take(x, self.new_to_old, axis=0),
            rmatvec=lambda x: np.take(x, self.old_to_new, axis=0),
            matmat=lambda x: np.take(x, self.new_to_old, axis=0),
            dtype=np.float64,
        )

    def __len__(self) -> int:
        return len(self._handle)

    def __eq__(self, other: object) -> bool:
        return self._handle == other._handle if isinstance(other, Permutation) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.old_to_new.tobytes())

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (np.asarray(self.old_to_new).copy(),)

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError("a Permutation does not change")

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NoReturn:
        raise TypeError("which direction? a permutation has .new_to_old, for A[p][:, p], and .old_to_new")

    def __iter__(self) -> NoReturn:
        raise TypeError("which direction? a permutation has .new_to_old and .old_to_new")

    def __repr__(self) -> str:
        n = len(self)
        moved = float(np.abs(self.old_to_new - np.arange(n, dtype=np.int64)).mean()) if n else 0.0
        return f"<Permutation of {n:,}: moved by {moved:,.1f} places on average>"

    def _repr_html_(self) -> str:
        return _html.permutation(self)


def _refuse(axis: int, out: Any, what: str) -> None:
    if axis != 0 or out is not None:
        raise InvalidArgument(f"move: {what} has no {'axis' if axis != 0 else 'out'}; it is for arrays")


def _takes(out: Any, array: NDArray[Any]) -> bool:
    """Whether the rows of an array can be written to another."""
    if not isinstance(out, np.ndarray) or not out.flags.c_contiguous or not out.flags.writeable:
        return False
    fits: bool = out.shape == array.shape and out.dtype == array.dtype
    return fits


def _bytes_of(array: NDArray[Any]) -> NDArray[np.uint8]:
    """The rows of a contiguous array as bytes."""
    return array.view(np.ndarray).reshape(len(array), -1).view(np.uint8)


def _unpickled(old_to_new: NDArray[np.int32]) -> Permutation:
    return Permutation(old_to_new=old_to_new)
