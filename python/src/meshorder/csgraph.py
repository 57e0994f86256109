# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Functions with names and signatures of ``scipy.sparse.csgraph``."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._graphs import order_graph

__all__ = ["reverse_cuthill_mckee"]


def reverse_cuthill_mckee(graph: Any, symmetric_mode: bool = False) -> NDArray[np.int32]:
    """Orders a matrix by reverse Cuthill–McKee, as scipy.sparse.csgraph.reverse_cuthill_mckee does.

    Ties are broken differently, so the order differs from SciPy's, and its bandwidth a little.

    Args:
        graph: a square SciPy matrix, or another graph that `meshorder.order` takes, but not a mesh.
        symmetric_mode: True: the pattern is taken to be symmetric, without a check; False: the order is that of
            A + Aᵀ.

    Returns:
        ``new_to_old``, n numbers p for which ``A[p][:, p]`` is the matrix in its new order.

    Raises:
        InvalidArgument: a faulty matrix, or one that is not square.

    Example:
        >>> import scipy.sparse
        >>> matrix = scipy.sparse.csr_array([[2, 0, 1], [0, 2, 1], [1, 1, 2]])
        >>> p = meshorder.csgraph.reverse_cuthill_mckee(matrix, symmetric_mode=True)
        >>> matrix[p][:, p].toarray().tolist()
        [[2, 1, 0], [1, 2, 1], [0, 1, 2]]
    """
    made = order_graph(graph, "rcm", None, None, {"symmetric": symmetric_mode, "check": "fast"})
    return np.array(made.new_to_old)
