# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""The graphs of PyTorch Geometric: Data, HeteroData and batches of them."""

from __future__ import annotations

import copy
import dataclasses
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import integers
from .._errors import InvalidArgument
from .._graphs import Order, compressed, order_graph
from .._meshes import Mesh, MeshOrder
from .._permutation import Permutation
from . import torch as tensors
from .host import Host, Request, parts

#: names of values that belong to nodes even if there are as many edges
_OF_NODES = ("x", "y", "z", "pos", "batch", "norm", "normal", "feat", "n_id")


class PygGraph(Host):
    """A Data or HeteroData.

    Nodes are numbered type after type. One graph of all types and edge types orders them, each type within its own
    numbers; without edges, the sides of the faces are the graph. The cells of an order are the edges, type after type,
    then the faces.
    """

    def __init__(self, data: Any) -> None:
        self.given = data
        with warnings.catch_warnings():  # PyG warns that it guesses from the largest number in edge_index
            warnings.simplefilter("ignore")
            self._sizes = [store.num_nodes for store in data.node_stores]
        for store, size in zip(data.node_stores, self._sizes):
            if size is None:
                raise InvalidArgument(f"{_name(store)}: the number of nodes is not known; set its num_nodes")
        starts = np.cumsum([0, *self._sizes], dtype=np.int64)
        #: first node and number of nodes of each type, by its key
        self._nodes = {store._key: (starts[k], self._sizes[k]) for k, store in enumerate(data.node_stores)}
        self._edge_stores = [store for store in data.edge_stores if store.get("edge_index") is not None]
        self._edges = [self._checked(store) for store in self._edge_stores]
        face = data.node_stores[0].get("face") if len(self._sizes) == 1 else None
        self._face = None if face is None else tensors.node_numbers(face, "data.face", self._sizes[0])
        self.points = self._points()

    def _columns(self, store: Any) -> NDArray[np.int64]:
        """Returns two rows, one for each end of a store's edges: the first node of its type and the number of nodes."""
        for key in _ends(store):
            if key not in self._nodes:
                raise InvalidArgument(f"data: the nodes {key!r} are missing; set data[{key!r}].num_nodes")
        return np.array([self._nodes[key] for key in _ends(store)], dtype=np.int64)

    def _checked(self, store: Any) -> NDArray[np.int64]:
        """Returns the two ends of a store's edges among the nodes of all types."""
        start, count = np.hsplit(self._columns(store), 2)
        shape = tuple(store.edge_index.shape)
        if len(shape) != 2 or shape[0] != 2:
            raise InvalidArgument(f"{_name(store, 'edge_index')}: expected the shape (2, E), not {shape}")
        return tensors.node_numbers(store.edge_index, _name(store, "edge_index"), count) + start

    def _points(self) -> NDArray[Any] | None:
        found = [store.get("pos") for store in self.given.node_stores]
        shapes = [tuple(getattr(pos, "shape", ())) for pos in found]
        if len({shape[1:] for shape in shapes}) != 1 or any(len(shape) != 2 or not 1 <= shape[1] <= 3 for shape in shapes):
            return None
        return np.concatenate([tensors.to_numpy(pos) for pos in found])

    def _pairs(self) -> NDArray[np.int64]:
        """Returns the two ends of all edges."""
        pairs = list(self._edges)
        for store in self.given.edge_stores:
            for key, matrix in store.items("adj", "adj_t"):
                if tensors.is_sparse(matrix):  # other matrices are refused when they are to be moved
                    ends, (start, count) = tensors.to_numpy(tensors.entries(matrix.detach()).indices()), self._columns(store).T
                    shape = tuple(matrix.shape[::-1] if key == "adj_t" else matrix.shape)
                    if shape != tuple(count):
                        raise InvalidArgument(f"{_name(store, key)}: expected {count[0]} × {count[1]} nodes, not {shape}")
                    pairs.append((ends[::-1] if key == "adj_t" else ends) + start[:, np.newaxis])
        if not pairs and self._face is not None:
            pairs = [np.stack([self._face.ravel(), np.roll(self._face, 1, axis=0).ravel()])]
        return np.concatenate([np.zeros((2, 0), dtype=np.int64), *pairs], axis=1)

    def graph(self, mirror: bool) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        return compressed(self._pairs(), sum(self._sizes), mirror)

    def mesh(self) -> Mesh:
        if self.points is None:
            raise InvalidArgument("mesh: data without pos has no coordinates; order, reorder and quality take it as a graph")
        return super().mesh()

    @property
    def cells(self) -> Any:
        if self._face is not None:
            return {"triangle": np.ascontiguousarray(self._face.T)}
        pairs = np.sort(self._pairs(), axis=0)
        return {"line": np.ascontiguousarray(np.unique(pairs[:, pairs[0] != pairs[1]], axis=1).T)}

    def order(self, vertices: str, elements: str, options: dict[str, Any]) -> MeshOrder:
        groups = self._groups(options.get("groups"))
        found = order_graph(self.graph(False)[:2], vertices, self.points, None, {**options, "groups": groups})
        places = [
            start + np.argsort(found.old_to_new[start : start + size], kind="stable")
            for start, size in self._nodes.values()
        ]
        nodes = Permutation(new_to_old=np.concatenate([np.zeros(0, dtype=np.int64), *places]))
        return MeshOrder(dataclasses.replace(found, permutation=nodes), self._order_of_cells(nodes.old_to_new, elements))

    def _order_of_cells(self, new: NDArray[np.int32], elements: str) -> Order:
        whole = tensors.order_of_edges(new[:0], new[:0], elements)
        blocks: list[NDArray[Any]] = [
            tensors.order_of_edges(new[ends[0]], new[ends[1]], elements).new_to_old for ends in self._edges
        ]
        if self._face is not None:
            count, corners = self._face.shape[1], np.sort(new[self._face], axis=0)
            blocks.append(np.arange(count) if elements == "original" else np.lexsort(corners))
            if whole.reason:
                whole = dataclasses.replace(whole, reason=f"{whole.reason}; faces by their largest corners")
        starts = np.cumsum([0, *map(len, blocks)])
        places = [np.zeros(0, dtype=np.int64), *(block + start for block, start in zip(blocks, starts))]
        return dataclasses.replace(whole, permutation=Permutation(new_to_old=np.concatenate(places)))

    def _groups(self, given: Any) -> NDArray[Any] | None:
        """Returns groups that keep the graphs of a batch apart, and keep the given groups apart within each graph."""
        batches = [store.get("batch") for store in self.given.node_stores]
        whole = bool(batches) and all(batch is not None for batch in batches)
        found = [np.concatenate([tensors.to_numpy(batch) for batch in batches])] if whole else []
        found += [] if given is None else [integers(given, "groups")]
        if len(found) == 2 and len(found[0]) == len(found[1]):
            return np.unique(np.stack(found), axis=1, return_inverse=True)[1].reshape(-1)
        return found[-1] if found else None

    def grouped_order(self, request: Request) -> MeshOrder:
        found = [store.get(request.group_by) for store in self.given.node_stores]
        if [tuple(getattr(part, "shape", ())) for part in found] != [(size,) for size in self._sizes]:
            raise InvalidArgument(f"group_by: '{request.group_by}' is not a tensor with a number for each node")
        groups = np.concatenate([tensors.to_numpy(part) for part in found])
        return self.order(request.vertices, request.elements, {**request.options, "groups": groups})

    def moved(self, order: MeshOrder, inplace: bool) -> Any:
        nodes = dict(zip(self._nodes, parts(order.vertices.permutation, self._sizes)))
        sizes = [ends.shape[1] for ends in self._edges] + ([] if self._face is None else [self._face.shape[1]])
        cells = parts(order.cells.permutation, sizes)
        edges = {store._key: part for store, part in zip(self._edge_stores, cells)}
        moved, doubts = [], list[str]()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for place, store in enumerate(self.given.stores):
                if hasattr(store, "is_edge_attr"):  # the store for the HeteroData as a whole lacks it
                    of = {"nodes": nodes.get(store._key), "edges": edges.get(store._key), "faces": cells[-1] if sizes else None}
                    ends = [nodes[key] for key in _ends(store)]
                    moved += [(place, key, self._value(store, key, value, ends, of, doubts)) for key, value in store.items()]
        for doubt in doubts:
            warnings.warn(doubt, UserWarning, stacklevel=4)
        data = self.given if inplace else copy.copy(self.given)
        for place, key, value in moved:
            data.stores[place][key] = value
        return data

    def _value(
        self, store: Any, key: str, value: Any, ends: list[Permutation], of: dict[str, Permutation | None], doubts: list[str]
    ) -> Any:
        """Returns a value of a store with its rows moved and its node numbers replaced."""
        if type(value).__name__ == "SparseTensor":
            raise InvalidArgument(f"{_name(store, key)} is a SparseTensor of torch_sparse; pass its edge_index instead")
        count, axis = self._rows(store, key, value)
        if tensors.is_sparse(value) and "adj" in key:
            return tensors.moved_matrix(value, *(ends[::-1] if key.endswith("_t") else ends))
        owner = self._owner(store, key, count)
        places = of[owner] if owner else None
        if owner and places is None:
            raise InvalidArgument(f"{_name(store, key)} belongs to the entries of a sparse matrix; pass an edge_index instead")
        if tensors.is_sparse(value):
            return value if places is None else tensors.moved_matrix(value, places, Permutation.identity(value.shape[1]))
        moved = value if places is None else places.move(value, axis)
        if not hasattr(value, "shape"):
            return moved
        if owner == "nodes" and "adj" in key and value.shape[1:2] == (count,):
            return ends[0].move(moved, 1)
        if not self._holds_nodes(store, key, value):
            doubts += self._doubts(store, key, value, owner, count)
            return moved
        if store._key is None:
            return ends[0].renumber(moved)
        both = [end.renumber(row) for end, row in zip(ends, moved)]
        return tensors.stacked(both)

    def _owner(self, store: Any, key: str, rows: int) -> str | None:
        """Returns the items for which a value has a row each: "nodes", "edges" or "faces"; None for other values."""
        if rows < 0 or key.endswith("ptr"):
            return None
        if self._face is not None and "face" in key and rows == self._face.shape[1]:
            return "faces"
        return "nodes" if store.is_node_attr(key) else "edges" if store.is_edge_attr(key) else None

    def _rows(self, store: Any, key: str, value: Any) -> tuple[int, int]:
        """Returns the number of rows of a value and the axis along which they lie; −1 rows for values without rows."""
        if isinstance(value, (list, tuple)):
            return len(value), 0
        axis = self.given.__cat_dim__(key, value, store) if getattr(value, "shape", ()) else None
        return (int(value.shape[axis]), axis) if isinstance(axis, int) else (-1, 0)

    def _holds_nodes(self, store: Any, key: str, value: Any) -> bool:
        """Returns whether PyG's batches would add numbers of nodes to a tensor, which shows that it holds node numbers.

        Raises:
            InvalidArgument: they would add other numbers.
        """
        step = 0 if "batch" in key or key.endswith("ptr") else self.given.__inc__(key, value, store)
        step = np.asarray(step).ravel()
        sizes = [self._nodes[end][1] for end in _ends(store)]
        if step.any() and step.tolist() != sizes[: 1 if store._key is None else 2]:
            raise InvalidArgument(f"{_name(store, key)} holds numbers that are not of nodes; such data cannot move")
        return bool(step.any())

    def _doubts(self, store: Any, key: str, value: Any, owner: str | None, rows: int) -> list[str]:
        """Returns a warning if name and shape do not show whether a value belongs to moved items."""
        name = _name(store, key)
        if owner == "nodes" and value.shape[1:2] == (rows,) and rows > 1 and key not in _OF_NODES:
            return [f"{name} has a row and a column for each node: only its rows were moved; 'adj' in its name moves both"]
        if owner == "nodes" and store._key is None and rows == store.num_edges:
            sure = key in _OF_NODES or key.endswith("mask") or "node" in key
            return [] if sure else [f"{name} has a row for each node, or edge: it was moved with the nodes"]
        if owner is not None or key.endswith("ptr") or rows in (-1, 1, getattr(self.given, "num_graphs", 1)):
            return []
        of_faces = self._face is not None and rows == self._face.shape[1]
        of_nodes = rows > 0 and "int" in str(value.dtype) and 0 <= int(value.min()) and int(value.max()) < sum(self._sizes)
        words = f"{name} was kept: 'face' in its name would move it with the faces, 'index' renumber the nodes in it"
        return [words] if of_faces or of_nodes else []


def _ends(store: Any) -> list[Any]:
    """Returns the keys of the nodes at both ends of a store's edges."""
    return [store._key[0], store._key[-1]] if isinstance(store._key, tuple) else [store._key] * 2


def _name(store: Any, key: str = "") -> str:
    owner = "data" if store._key is None else f"data[{store._key!r}]"
    return f"{owner}.{key}" if key else owner


def host(data: Any) -> Host:
    """Returns the host of a Data or HeteroData."""
    if not isinstance(data, type) and tensors.is_tensor(data):
        return tensors.TorchGraph(data)
    from torch_geometric.data import Data, HeteroData

    if not isinstance(data, (Data, HeteroData)):
        name = data.__name__ if isinstance(data, type) else type(data).__name__
        raise InvalidArgument(f"data: expected a Data or HeteroData of torch_geometric, not its {name}")
    return PygGraph(data)
