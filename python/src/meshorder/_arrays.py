# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Converts users' arrays to the form that the library reads: contiguous, in the machine's byte order.

An array in this form is returned as it is. Others are copied; PyTorch's tensors are brought from their device. All
functions raise InvalidArgument for masked entries, other arrays on a GPU, ragged lists and wrong types and ranks.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import InvalidArgument


def _as_array(values: Any, name: str) -> NDArray[Any]:
    if isinstance(values, np.ma.MaskedArray):
        if np.ma.is_masked(values):
            raise InvalidArgument(f"{name}: a masked array has entries without a value; fill them first")
        values = values.data
    if hasattr(values, "index_select") and hasattr(values, "detach"):
        values = values.detach().cpu()  # a tensor of PyTorch
    if getattr(values, "__dlpack_device__", None) is not None and not isinstance(values, np.ndarray):
        if int(values.__dlpack_device__()[0]) != 1:
            raise InvalidArgument(f"{name}: the array is on a GPU; bring it to the CPU first, with .cpu() or .get()")
    try:
        array = np.asarray(values)
    except ValueError as error:  # ragged lists
        raise InvalidArgument(f"{name}: {error}") from None
    return array


def _native(array: NDArray[Any], dtype: Any) -> NDArray[Any]:
    return np.require(array, dtype=dtype, requirements=["C", "A"])


def integers(values: Any, name: str, rank: int | None = 1) -> NDArray[Any]:
    """Returns integers of 32 or 64 bits; smaller ones become int32. ``rank`` None: of any rank."""
    array = _as_array(values, name)
    if rank is not None and array.ndim != rank:
        raise InvalidArgument(f"{name}: expected an array of rank {rank}, not of rank {array.ndim}")
    if array.dtype.kind not in "iu":
        if array.size == 0:
            return np.zeros(array.shape, dtype=np.int32)
        remedy = "; np.flatnonzero makes indices of a mask" if array.dtype == bool else ""
        raise InvalidArgument(f"{name}: expected integers, not {array.dtype}{remedy}")
    dtype = array.dtype.newbyteorder("=") if array.dtype.itemsize >= 4 else np.dtype(np.int32)
    return _native(array, dtype)


def reals(values: Any, name: str, rank: int = 1) -> NDArray[Any]:
    """Returns float32 or float64 numbers; other real numbers become float64."""
    array = _as_array(values, name)
    if array.ndim != rank:
        raise InvalidArgument(f"{name}: expected an array of rank {rank}, not of rank {array.ndim}")
    if array.dtype.kind not in "fiu":
        raise InvalidArgument(f"{name}: expected real numbers, not {array.dtype}")
    dtype = np.float32 if array.dtype == np.float32 else np.float64
    return _native(array, dtype)


def points(values: Any, name: str = "points") -> NDArray[Any]:
    """Returns one row of one to three coordinates for each point, float32 or float64, in any regular layout."""
    array = _as_array(values, name)
    if array.ndim == 1 and array.size:
        array = array[:, np.newaxis]
    if array.ndim != 2 or not 1 <= array.shape[1] <= 3:
        if array.ndim in (1, 2) and len(array) == 0:
            return np.zeros((0, 3))
        remedy = "; pass the transpose, .T" if array.ndim == 2 and 1 <= len(array) <= 3 else ""
        raise InvalidArgument(f"{name}: expected rows of 1 to 3 coordinates, not the shape {array.shape}{remedy}")
    if array.dtype not in (np.float32, np.float64) or not array.dtype.isnative:
        if array.dtype.kind not in "fiu":
            raise InvalidArgument(f"{name}: expected real numbers, not {array.dtype}")
        array = array.astype(np.float64)
    # a copy for rows at misaligned addresses, as in packed records
    return array if array.flags.aligned else array.copy()
