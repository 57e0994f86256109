# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""PyTorch's tensors as graphs: edge_index, and sparse matrices in COO or CSR form."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._errors import InvalidArgument, TooLarge
from .._graphs import Order, compressed, order_graph
from .._meshes import Mesh, MeshOrder
from .._permutation import Permutation
from .host import Host

_MOST_NODES = 2**31 - 1


class TorchGraph(Host):
    """An edge_index of 2 × E node numbers, or a square sparse matrix."""

    takes_weights = True

    def __init__(self, tensor: Any) -> None:
        self.given = tensor
        shape = tuple(tensor.shape)
        if is_sparse(tensor):
            if len(shape) < 2 or shape[0] != shape[1]:
                raise InvalidArgument(f"graph: expected a square matrix, not one of shape {shape}")
            self._ends, self._count = to_numpy(entries(tensor.detach()).indices()), shape[0]
        elif len(shape) != 2 or shape[0] != 2:
            hint = "; pass its transpose, .t()" if shape[1:] == (2,) else ""
            raise InvalidArgument(f"graph: expected a sparse matrix or an edge_index of shape (2, E), not shape {shape}{hint}")
        else:
            self._ends = node_numbers(tensor, "edge_index")
            self._count = int(self._ends.max(initial=-1)) + 1

    def graph(self, mirror: bool) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        return compressed(self._ends, self._count, mirror and not is_sparse(self.given))

    def order(self, vertices: str, elements: str, options: dict[str, Any]) -> MeshOrder:
        found = order_graph(self.given, vertices, None, None, options)
        ends = found.old_to_new[self._ends]
        if not is_sparse(self.given):
            return MeshOrder(found, order_of_edges(ends[0], ends[1], elements))
        if elements != "auto":
            raise InvalidArgument("elements: the entries of a sparse matrix are always sorted by rows; leave 'auto'")
        return MeshOrder(found, order_of_edges(ends[1], ends[0], elements, "rows", "entries by their new row"))

    def moved(self, order: MeshOrder, inplace: bool) -> Any:
        if inplace:
            raise InvalidArgument("inplace: tensors are not changed; use the one that reorder returns")
        nodes = order.vertices.permutation
        if is_sparse(self.given):
            return moved_matrix(self.given, nodes, nodes)
        return renumbered(moved_rows(self.given, order.cells.permutation, 1), nodes)

    def mesh(self) -> Mesh:
        raise InvalidArgument("mesh: a tensor has no coordinates; pass a Data of torch_geometric with pos, or a mesh")


def is_sparse(value: Any) -> bool:
    """Returns whether a value is a sparse tensor."""
    return str(getattr(value, "layout", "")).startswith("torch.sparse")


def is_tensor(value: Any) -> bool:
    """Returns whether a value is a tensor, dense or sparse."""
    return hasattr(value, "index_select") and hasattr(value, "layout")


def to_numpy(tensor: Any) -> NDArray[Any]:
    """Returns the values of a tensor on any device."""
    array: NDArray[Any] = tensor.detach().cpu().numpy()
    return array


def node_numbers(tensor: Any, name: str, count: Any = _MOST_NODES) -> NDArray[np.int64]:
    """Returns the node numbers in a tensor.

    Args:
        tensor: the tensor.
        name: its name in error messages.
        count: number of nodes, or a column with this number for each row of the tensor.

    Raises:
        InvalidArgument: a type other than int32 and int64, a number that is not a node.
        TooLarge: a number of 2³¹ − 1 or more.
    """
    if hasattr(tensor, "as_tensor"):
        raise InvalidArgument(f"{name}: an EdgeIndex knows how it is sorted, which an order changes; pass .as_tensor()")
    if str(getattr(tensor, "dtype", "")) not in ("torch.int64", "torch.int32"):
        raise InvalidArgument(f"{name}: expected torch.int64 or torch.int32, not {getattr(tensor, 'dtype', type(tensor))}")
    numbers = to_numpy(tensor).astype(np.int64, copy=False)
    wrong = numbers[(numbers < 0) | (numbers >= count)]
    if len(wrong) and np.ndim(count) == 0 and count == _MOST_NODES and wrong.max() > 0:
        raise TooLarge(f"{name}: node {wrong.max()} is beyond the largest number that can be ordered, 2³¹ − 2")
    if len(wrong):
        raise InvalidArgument(f"{name}: there is no node {wrong[0]}")
    return numbers


def entries(matrix: Any) -> Any:
    """Returns a sparse matrix in COO form, with entries ascending by row and column and repeated ones added.

    Raises:
        InvalidArgument: a form other than COO and CSR, more than two sparse dimensions.
    """
    form = str(matrix.layout).removeprefix("torch.sparse_")
    if form not in ("coo", "csr") or (matrix.sparse_dim() != 2 if form == "coo" else matrix.ndim != 2):
        raise InvalidArgument(f"graph: a {matrix.ndim}-D tensor in {form.upper()} form; expected a matrix in COO or CSR form")
    return (matrix if form == "coo" else matrix.to_sparse()).coalesce()


def order_of_edges(
    sources: NDArray[Any], targets: NDArray[Any], elements: str, name: str = "target",
    reason: str = "edges by their new target, then source",
) -> Order:  # fmt: skip
    """Returns the order of edges between new numbers: by target, then source; or, for "original", unchanged.

    Raises:
        InvalidArgument: ``elements`` is neither "auto" nor "original".
    """
    if elements not in ("auto", "original"):
        raise InvalidArgument(
            f"elements: edges are sorted by their target ('auto') or stay ('original'); {elements!r} is for meshes")
    if elements == "original":
        name, reason, places = "original", "", np.arange(len(sources))
    else:
        width = int(sources.max(initial=0)) + 1
        places = np.argsort(targets.astype(np.int64) * width + sources, kind="stable")
    return Order(Permutation(new_to_old=places), name, reason, [], None, True, 0.0, [])


def moved_rows(values: Any, permutation: Permutation, axis: int) -> Any:
    """Returns a tensor with its rows along an axis moved to their new places, on its device."""
    import torch

    return values.index_select(axis, torch.tensor(permutation.new_to_old, dtype=torch.int64, device=values.device))


def renumbered(numbers: Any, permutation: Permutation) -> Any:
    """Returns a tensor with new node numbers, of the same type and on the same device."""
    import torch

    node_numbers(numbers, "numbers", len(permutation))
    return torch.tensor(permutation.old_to_new, dtype=numbers.dtype, device=numbers.device)[numbers.long()]


def stacked(rows: Any) -> Any:
    """Returns one tensor, or array, whose rows are the given ones."""
    import torch

    return torch.stack(rows) if is_tensor(rows[0]) else np.stack(rows)


def moved_matrix(matrix: Any, rows: Permutation, columns: Permutation) -> Any:
    """Returns a sparse matrix with its rows and columns moved, in the same form and on the same device."""
    import torch

    if tuple(matrix.shape[:2]) != (len(rows), len(columns)):
        raise InvalidArgument(f"a matrix of shape {tuple(matrix.shape)} cannot move as {len(rows)} × {len(columns)} items")
    old = entries(matrix)
    ends = stacked([renumbered(end, places) for end, places in zip(old.indices(), (rows, columns))])
    moved = torch.sparse_coo_tensor(ends, old.values(), matrix.shape).coalesce()
    return moved if matrix.layout == torch.sparse_coo else moved.to_sparse_csr()


def host(tensor: Any) -> Host:
    """Returns the host of a tensor."""
    if isinstance(tensor, type) or not is_tensor(tensor):
        name = tensor.__name__ if isinstance(tensor, type) else type(tensor).__name__
        hint = "; pass .to_torch_sparse_csr_tensor()" if name == "SparseTensor" else ""
        raise InvalidArgument(f"graph: expected an edge_index or a sparse tensor of PyTorch, not a {name}{hint}")
    return TorchGraph(tensor)
