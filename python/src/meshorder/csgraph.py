# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Functions with the names and signatures of scipy.sparse.csgraph's."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._graphs import order_graph

__all__ = ["reverse_cuthill_mckee"]


def reverse_cuthill_mckee(graph: Any, symmetric_mode: bool = False) -> NDArray[np.int32]:
    """As scipy.sparse.csgraph.reverse_cuthill_mckee: returns ``new_to_old``, to be used as ``A[p][:, p]``.

    Ties are broken otherwise, so the order differs from SciPy's.

    Args:
        graph: a square matrix in CSR or CSC form.
        symmetric_mode: True takes for granted that the matrix is symmetric; otherwise A + Aᵀ is ordered.
    """
    made = order_graph(graph, "rcm", None, None, {"symmetric": symmetric_mode, "check": "fast"})
    return np.array(made.new_to_old)
