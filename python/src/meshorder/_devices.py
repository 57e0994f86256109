# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Moves arrays of other libraries on their device, a GPU for instance.

These are JAX, CuPy and other libraries with the Python array API standard (https://data-apis.org/array-api/), and Warp.
hosts/torch.py does the same for PyTorch.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import InvalidArgument


class Standard:
    """Arrays with the functions of the array API standard.

    Args:
        functions: the library's namespace.
    """

    def __init__(self, functions: Any) -> None:
        self._functions = functions

    def moved(self, values: Any, new_to_old: NDArray[np.int32], axis: int) -> Any:
        """Returns an array with its entries along an axis in their new places."""
        return self._functions.take(values, self._beside(values, new_to_old), axis=axis)

    def renumbered(self, numbers: Any, old_to_new: NDArray[np.int32]) -> Any:
        """Returns an array with the new number for each old number; raises InvalidArgument for numbers out of range."""
        functions = self._functions
        try:
            bits = functions.iinfo(numbers.dtype).bits
        except (TypeError, ValueError):
            raise InvalidArgument(f"numbers: expected integers, not {numbers.dtype}") from None
        flat = functions.reshape(numbers, (-1,))
        if flat.shape[0]:
            _require_range(int(functions.min(flat)), int(functions.max(flat)), len(old_to_new))
            flat = functions.take(self._beside(numbers, old_to_new), flat, axis=0)
        dtype = numbers.dtype if bits >= 32 else functions.int32
        return functions.astype(functions.reshape(flat, numbers.shape), dtype)

    def _beside(self, values: Any, numbers: NDArray[np.int32]) -> Any:
        """Returns numbers on the device of an array."""
        device: Any = getattr(values, "device", None)  # None while JAX traces
        if hasattr(device, "__enter__"):  # a device of CuPy, which has to be made current
            with device:
                return self._functions.asarray(numbers)
        return self._functions.asarray(numbers, device=device)


class Warp:
    """Arrays of NVIDIA Warp, whose entries may be vectors or structs."""

    def moved(self, values: Any, new_to_old: NDArray[np.int32], axis: int) -> Any:
        """Returns an array with its entries along an axis in their new places."""
        import warp

        indices: list[Any] = [None] * values.ndim
        indices[axis] = warp.array(new_to_old, dtype=warp.int32, device=values.device)
        view: Any = warp.indexedarray(values, indices)
        return view.contiguous()

    def renumbered(self, numbers: Any, old_to_new: NDArray[np.int32]) -> Any:
        """Returns an array with the new number for each old number, made on the host; raises as `Standard` does."""
        import warp

        old = numbers.numpy()
        if old.dtype.kind not in "iu" or old.dtype.itemsize < 4:
            raise InvalidArgument(f"numbers: expected integers of 32 or 64 bits, not {old.dtype}")
        if old.size:
            _require_range(int(old.min()), int(old.max()), len(old_to_new))
        return warp.array(old_to_new[old].astype(old.dtype), dtype=numbers.dtype, device=numbers.device)


def library_of(values: Any) -> Standard | Warp | None:
    """Returns the object that moves arrays of another library; None for NumPy's arrays and for other objects."""
    if isinstance(values, (np.ndarray, np.generic)):
        return None
    package = type(values).__module__.partition(".")[0]
    if package == "warp" and hasattr(values, "__dlpack__"):
        return Warp()
    if package == "cupy":
        return Standard(sys.modules[package])
    if hasattr(values, "__array_namespace__"):
        return Standard(values.__array_namespace__())
    return None


def _require_range(least: int, most: int, n: int) -> None:
    if least < 0 or most >= n:
        wrong = least if least < 0 else most
        raise InvalidArgument(f"permutation: number {wrong} is outside 0 … {n - 1}")
