# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Permutations, which move arrays and matrices."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from . import _core, _devices, _html
from ._arrays import integers
from ._errors import InvalidArgument


class Permutation:
    """A permutation of n items (vertices, cells, rows): their places before and after a move. Immutable.

    Both directions have names, because they are easily confused:

    - ``old_to_new[i]`` is the new place of the item that was at place i;
    - ``new_to_old[k]`` is the old place of the item that is now at place k, so that ``a[p.new_to_old]`` moves the rows
      of an array and ``A[p.new_to_old][:, p.new_to_old]`` the rows and columns of a matrix.

    Permutations can be compared, hashed and pickled; ``len(p)`` is n. Memory: 8 n bytes.

    Args:
        old_to_new: the new place of each item: each of 0 … n−1 once.
        new_to_old: the old place of the item at each new place: each of 0 … n−1 once. Exactly one of the two must be
            given.

    Raises:
        InvalidArgument: both maps or none are given, or the map is not a bijection of 0 … n−1.
        TooLarge: 2³¹ or more items.

    Example:
        >>> p = meshorder.Permutation(new_to_old=[2, 0, 1])
        >>> p.move(["a", "b", "c"])
        ['c', 'a', 'b']
        >>> p.old_to_new.tolist()
        [1, 2, 0]
        >>> p.renumber([[0, 1], [1, 2]]).tolist()
        [[1, 2], [2, 0]]
    """

    __slots__ = ("_handle",)
    _handle: _core.Permutation

    def __init__(self, *unnamed: Any, old_to_new: Any = None, new_to_old: Any = None) -> None:
        if unnamed:
            raise InvalidArgument("Permutation: which direction? Pass new_to_old=p if a[p] has the new order, else old_to_new=p")
        if (old_to_new is None) == (new_to_old is None):
            given = "none" if old_to_new is None else "both"
            raise InvalidArgument(f"Permutation: expected exactly one of old_to_new and new_to_old, not {given}")
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
        """Returns the permutation of n ≥ 0 items that moves nothing."""
        if n < 0:
            raise InvalidArgument(f"identity: expected 0 or more items, not {n}")
        return cls(old_to_new=np.arange(n, dtype=np.int32))

    @property
    def old_to_new(self) -> NDArray[np.int32]:
        """The new place of each old item; n numbers, read-only, without a copy."""
        return self._handle.old_to_new

    @property
    def new_to_old(self) -> NDArray[np.int32]:
        """The old place of the item at each new place; n numbers, read-only, without a copy."""
        return self._handle.new_to_old

    def inverse(self) -> Permutation:
        """Returns the permutation that moves everything back. O(n)."""
        return Permutation._of(self._handle.inverse())

    def then(self, other: Permutation) -> Permutation:
        """Returns this permutation followed by another. O(n).

        Its ``old_to_new`` is ``other.old_to_new[self.old_to_new]``.

        Raises:
            InvalidArgument: the permutations have different sizes.
        """
        return Permutation._of(self._handle.then(other._handle))

    def repeated(self, components: int, node_major: bool = True) -> Permutation:
        """Returns the permutation of degrees of freedom, several for each item.

        Args:
            components: degrees of freedom of each item, ≥ 1.
            node_major: True: component c of item i has the number ``components * i + c``; False: ``c * n + i``.

        Returns:
            A permutation of ``components * n`` degrees of freedom; each gets its number from its item's new
            place.

        Raises:
            InvalidArgument: ``components`` is below 1.
            TooLarge: 2³¹ or more degrees of freedom.
        """
        return Permutation._of(self._handle.repeated(components, node_major))

    def move(self, a: Any, axis: int = 0, out: NDArray[Any] | None = None) -> Any:
        """Moves data of the items to their new places: entry k of the result is entry ``new_to_old[k]`` of ``a``.

        Args:
            a: an array with n entries along ``axis``, a list or tuple of n entries, a pandas Series or DataFrame with n
                entries along ``axis``, or an n × n matrix of SciPy or PyTorch (COO or CSR), whose rows and columns both
                move. Unchanged. Arrays of PyTorch, JAX, CuPy, Warp and other libraries that follow the Python array API
                standard stay on their device, and gradients of PyTorch and JAX flow through.
            axis: the axis of an array or a pandas object along which the items lie.
            out: for arrays of NumPy, where to write the result: of the same shape and dtype, C-contiguous, sharing no memory
                with ``a``.

        Returns:
            An object of the same kind; ``out`` if it is given.

        Raises:
            InvalidArgument: ``a`` has another number of entries, ``out`` does not fit, or ``axis`` or ``out`` is given
                with an object that is not an array.
        """
        if hasattr(a, "index_select"):
            return self._move_tensor(a, axis, out)
        if hasattr(a, "iloc"):
            return self._move_pandas(a, axis, out)
        if hasattr(a, "tocsr") and hasattr(a, "nnz"):
            _refuse(axis, out, "a matrix")
            return self._move_matrix(a)
        if isinstance(a, (list, tuple)):
            _refuse(axis, out, "a list")
            if len(a) != len(self):
                raise InvalidArgument(f"move: expected {len(self)} entries, not {len(a)}")
            return type(a)([a[k] for k in self.new_to_old])
        if hasattr(a, "adjacency"):
            raise InvalidArgument("move: a networkx graph has no rows; [list(graph)[k] for k in new_to_old] orders its nodes")
        library = _devices.library_of(a)
        if library is not None:
            _refuse(0, out, "an array of another library")
            self._check_shape(tuple(a.shape), axis)
            return library.moved(a, self.new_to_old, axis)
        array = np.asanyarray(a)
        self._check_shape(array.shape, axis)
        if out is not None and not _takes(out, array):
            raise InvalidArgument(f"move: out must be C-contiguous and writeable, of shape {array.shape} and type {array.dtype}")
        plain = array.flags.c_contiguous and not array.dtype.hasobject and not isinstance(array, np.ma.MaskedArray)
        if axis not in (0, -array.ndim) or not plain:
            return np.take(array, self.new_to_old, axis=axis, out=out)
        if out is None:
            out = np.empty_like(array)
        if array.size:
            self._handle.move_rows(_bytes_of(array), _bytes_of(out))
        return out

    def _check_shape(self, shape: tuple[int, ...], axis: int) -> None:
        if axis in range(-len(shape), len(shape)) and shape[axis] == len(self):
            return
        fitting = [f"; axis={place} has as many" for place, size in enumerate(shape) if size == len(self)]
        raise InvalidArgument(
            f"move: expected {len(self)} entries along axis {axis!r}, not the shape {shape}{(fitting or [''])[0]}"
        )

    def _move_tensor(self, a: Any, axis: int, out: Any) -> Any:
        from .hosts import torch  # which imports this module

        _refuse(0, out, "a tensor")
        self._check_shape(tuple(a.shape), axis)
        if not torch.is_sparse(a):
            return torch.moved_rows(a, self, axis)
        _refuse(axis, out, "a matrix")
        return torch.moved_matrix(a, self, self)

    def _move_pandas(self, a: Any, axis: int, out: Any) -> Any:
        _refuse(0, out, "a pandas object")
        self._check_shape(a.shape, axis)
        return a.iloc[self.new_to_old] if axis % a.ndim == 0 else a.iloc[:, self.new_to_old]

    def _move_matrix(self, a: Any) -> Any:
        matrix = a.tocsr()
        n = len(self)
        if matrix.shape != (n, n):
            raise InvalidArgument(f"move: expected a matrix of shape {(n, n)}, not {matrix.shape}")
        indptr, indices = integers(matrix.indptr, "indptr"), integers(matrix.indices, "indices")
        values = np.ascontiguousarray(matrix.data)
        moved = np.empty_like(indptr), np.empty_like(indices), np.empty_like(values)
        self._handle.move_matrix(indptr, indices, values.view(np.uint8), moved[0], moved[1], moved[2].view(np.uint8))
        result = type(matrix)((moved[2], moved[1], moved[0]), shape=matrix.shape)
        return result.asformat(a.format)

    def renumber(self, numbers: Any, out: NDArray[Any] | None = None) -> Any:
        """Replaces numbers of items, such as a mesh's connectivity, by their new numbers.

        Entry i of the result is ``old_to_new[numbers[i]]``. Unlike `move`, this does not change the places of the numbers.

        Args:
            numbers: integers in 0 … n−1, of any shape, in an array of any library that `move` takes. Unchanged unless it
                is ``out``.
            out: for arrays of NumPy, a C-contiguous array of 32- or 64-bit integers of the same shape, to write to;
                ``out=numbers`` works in place. None: a new array.

        Returns:
            ``out``, or a new array of the type and library of ``numbers``, on its device; integers of less than 32 bits give
            int32, except for tensors of PyTorch.

        Raises:
            InvalidArgument: a number outside 0 … n−1, an array of other types, an ``out`` that does not fit.
        """
        if hasattr(numbers, "index_select"):
            from .hosts import torch  # which imports this module

            if out is not None:
                raise InvalidArgument("renumber: a tensor has no out; it is for arrays of NumPy")
            return torch.renumbered(numbers, self)
        library = _devices.library_of(numbers)
        if library is not None:
            if out is not None:
                raise InvalidArgument("renumber: an array of another library has no out; it is for arrays of NumPy")
            return library.renumbered(numbers, self.old_to_new)
        if out is None:
            out = integers(numbers, "numbers", rank=None).copy()
        elif not isinstance(out, np.ndarray) or not out.flags.c_contiguous or not out.flags.writeable:
            raise InvalidArgument("renumber: out must be a C-contiguous and writeable array")
        elif out is not numbers:
            renumbered = self.renumber(numbers)  # before the numbers are converted to the type of out
            if out.shape != renumbered.shape or out.dtype.kind not in "iu" or out.dtype.itemsize < 4:
                raise InvalidArgument("renumber: out must have the shape of the numbers, and 32 or 64 bits")
            np.copyto(out, renumbered, casting="unsafe")
            return out
        self._handle.renumber(out.reshape(-1), 0)
        return out

    def as_matrix(self) -> Any:
        """Returns an n × n SciPy LinearOperator P with ``P @ x == move(x)``; its adjoint ``P.H`` moves back.

        Raises:
            ImportError: SciPy is not installed.
        """
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
        raise AttributeError("a Permutation cannot be changed")

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
        raise InvalidArgument(f"move: {what} has no {'axis' if axis != 0 else 'out'}; it is for arrays of NumPy")


def _takes(out: Any, array: NDArray[Any]) -> bool:
    """Returns whether the moved rows of an array can be written to ``out``."""
    if not isinstance(out, np.ndarray) or not out.flags.c_contiguous or not out.flags.writeable:
        return False
    fits: bool = out.shape == array.shape and out.dtype == array.dtype
    return fits


def _bytes_of(array: NDArray[Any]) -> NDArray[np.uint8]:
    """Returns the rows of a C-contiguous array as bytes, without a copy."""
    return array.view(np.ndarray).reshape(len(array), -1).view(np.uint8)


def _unpickled(old_to_new: NDArray[np.int32]) -> Permutation:
    return Permutation(old_to_new=old_to_new)
