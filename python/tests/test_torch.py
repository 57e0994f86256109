# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""PyTorch's tensors and PyTorch Geometric's graphs, checked by computations of these two libraries."""

import pathlib
import re
import subprocess
import sys
import typing
import warnings

import meshorder
import numpy as np
import pytest
import scipy.sparse as sp
from conftest import lattice
from meshorder import InvalidArgument

torch = pytest.importorskip("torch")

pytestmark = pytest.mark.filterwarnings("ignore:Sparse CSR tensor support is in beta:UserWarning")


def pairs(seed=3):
    """A directed edge_index of 200 nodes, with repeated edges and loops."""
    return torch.tensor(np.random.default_rng(seed).integers(200, size=(2, 900)))


def undirected(*sizes):
    """The edge_index of a lattice whose nodes are shuffled."""
    graph = lattice(*sizes).tocoo()
    return torch.tensor(np.stack([graph.row, graph.col]).astype(np.int64))


def passed(x, edge_index, weight):
    """One step of message passing: the weighted sums over the edges to each node."""
    return torch.zeros_like(x).index_add_(0, edge_index[1], weight[:, None] * x[edge_index[0]])


def edge_set(edge_index, *values):
    return sorted(zip(*edge_index.tolist(), *(value.tolist() for value in values)))


@pytest.mark.parametrize("dtype", [torch.int32, torch.int64])
def test_edge_index_is_renumbered_and_sorted_by_target(dtype):
    given = pairs().to(dtype)
    before = given.clone()
    moved, order = meshorder.reorder(given, vertices="rcm")
    assert torch.equal(given, before) and moved.dtype == dtype and moved.shape == given.shape
    by_hand = order.vertices.old_to_new[given.numpy()][:, order.cells.new_to_old]
    np.testing.assert_array_equal(moved.numpy(), by_hand)
    keys = moved[1].long() * 200 + moved[0]
    assert (keys.diff() >= 0).all() and order.cells.reason == "edges by their new target, then source"
    kept, order = meshorder.reorder(given, vertices="rcm", elements="original")
    np.testing.assert_array_equal(kept.numpy(), order.vertices.old_to_new[given.numpy()])


def test_edge_index_is_the_graph_of_its_matrix():
    given = undirected(12, 9)
    matrix = sp.csr_array((np.ones(given.shape[1]), given.numpy()))
    order = meshorder.order(given, "rcm")
    assert order.permutation == meshorder.order(matrix, "rcm").permutation
    assert meshorder.quality(given, order) == meshorder.quality(matrix, order)
    assert meshorder.fiedler(given).lambda2 == pytest.approx(meshorder.fiedler(matrix).lambda2)
    assert meshorder.advise(given, machine="zen3").as_is == meshorder.advise(matrix, machine="zen3").as_is
    points = torch.rand(108, 3, requires_grad=True)
    by_points = meshorder.order(given, "hilbert", points=points)
    assert by_points.permutation == meshorder.order(matrix, "hilbert", points=points.detach().numpy()).permutation


def test_weights_follow_the_edges_of_edge_index():
    given = undirected(9, 7)
    given = given[:, np.random.default_rng(4).permutation(given.shape[1])]
    weights = 1 + (given.sum(0) % 5).double()
    matrix = sp.coo_array((weights.numpy(), given.numpy())).tocsr()
    matrix.sort_indices()
    found = meshorder.fiedler(given, weights=weights.requires_grad_())
    assert found.lambda2 == pytest.approx(meshorder.fiedler(matrix, weights=matrix.data).lambda2)
    with pytest.raises(InvalidArgument, match="weights: expected"):
        meshorder.order(given, weights=weights[1:])


def test_directed_edges_count_in_both_directions():
    given = pairs()
    both = torch.cat([given, given.flip(0)], 1)
    order = meshorder.order(given, "rcm")
    assert order.permutation == meshorder.order(both, "rcm").permutation
    assert meshorder.quality(given, order) == meshorder.quality(both, order)
    with pytest.raises(InvalidArgument, match="neighbour"):
        meshorder.order(given, "rcm", symmetric=True)


@pytest.mark.parametrize("form", ["coo", "csr"])
def test_sparse_matrices_move_rows_columns_and_gradients(form):
    edges = pairs()
    values = torch.randn(edges.shape[1], dtype=torch.float64)
    matrix = torch.sparse_coo_tensor(edges, values, (200, 200))
    matrix = matrix if form == "coo" else matrix.coalesce().to_sparse_csr()
    moved, order = meshorder.reorder(matrix, vertices="rcm")
    p = torch.tensor(order.vertices.new_to_old).long()
    assert moved.layout == matrix.layout and moved.dtype == matrix.dtype
    assert torch.equal(moved.to_dense(), matrix.to_dense()[p][:, p])
    assert torch.equal(order.vertices.permutation.move(matrix).to_dense(), moved.to_dense())
    places = order.cells.new_to_old
    rows = order.vertices.old_to_new[matrix.to_dense().to_sparse().indices()[0].numpy()]
    assert (np.diff(rows[places]) >= 0).all()
    scipys = sp.csr_array(matrix.to_dense().numpy())
    assert order.vertices.permutation == meshorder.order(scipys, "rcm").permutation


def test_gradients_flow_through_moves():
    order = meshorder.order(pairs(), "rcm").permutation
    x = torch.randn(200, 3, requires_grad=True)
    factors = torch.randn(200, 3)
    (order.move(x) * factors).sum().backward()
    assert torch.equal(order.move(x.grad), factors)
    values = torch.randn(900, requires_grad=True)
    matrix = torch.sparse_coo_tensor(pairs(), values, (200, 200))
    torch.sparse.sum(meshorder.reorder(matrix)[0] * 2).backward()
    assert torch.equal(values.grad, torch.full((900,), 2.0))


def test_permutations_move_tensors_along_axes_and_renumber_them():
    order = meshorder.Permutation(new_to_old=[2, 0, 1])
    rows = torch.arange(6, dtype=torch.float16).reshape(2, 3)
    moved = order.move(rows, axis=1)
    assert moved.dtype == torch.float16 and moved.tolist() == [[2, 0, 1], [5, 3, 4]]
    assert order.renumber(torch.tensor([[0, 2]], dtype=torch.int32)).tolist() == [[1, 0]]
    for wrong in (
        lambda: order.move(rows),
        lambda: order.move(rows, axis=1, out=np.zeros((2, 3))),
        lambda: order.renumber(torch.tensor([3])),
        lambda: order.renumber(torch.tensor([0]), out=np.zeros(1)),
        lambda: order.move(torch.eye(4).to_sparse()),
    ):
        with pytest.raises(InvalidArgument):
            wrong()


@pytest.mark.parametrize(
    "graph, words",
    [
        (torch.zeros(2, 4), "torch.int64 or torch.int32, not torch.float32"),
        (torch.zeros(4, 2, dtype=torch.int64), "shape \\(2, E\\).*transpose"),
        (torch.zeros(3, 3, dtype=torch.int64), "shape \\(2, E\\)"),
        (torch.tensor(1), "shape \\(2, E\\)"),
        (torch.tensor([[0, -1], [1, 0]]), "there is no node -1"),
        (torch.ones(2, 3).to_sparse(), "square"),
        (lambda: torch.ones(4, 4).to_sparse_bsr((2, 2)), "BSR form; expected a matrix in COO or CSR form"),
        (lambda: torch.ones(4, 4).to_sparse_csc(), "CSC form"),
        (torch.ones(2, 2, 2).to_sparse(), "3-D tensor in COO form"),
        (torch.nn.Linear(2, 2), "expected an edge_index or a sparse tensor of PyTorch, not a Linear"),
    ],
)
@pytest.mark.filterwarnings("ignore:Sparse BSR tensor support is in beta:UserWarning")
def test_refusals_are_one_line(graph, words):
    graph = graph() if words[:3] in ("BSR", "CSC") else graph
    for function in (meshorder.order, meshorder.reorder, meshorder.quality):
        with pytest.raises(InvalidArgument, match=words) as caught:
            function(graph)
        assert "\n" not in str(caught.value)


def test_tensors_are_no_meshes_and_not_changed():
    for wrong in (
        lambda: meshorder.reorder(pairs(), inplace=True),
        lambda: meshorder.reorder(pairs(), group_by="x"),
        lambda: meshorder.reorder(pairs(), elements="lexmax"),
        lambda: meshorder.reorder(torch.eye(3).to_sparse(), elements="original"),
    ):
        with pytest.raises(InvalidArgument):
            wrong()
    with pytest.raises(meshorder.TooLarge):
        meshorder.order(torch.tensor([[0], [2**40]]))
    assert len(meshorder.reorder(torch.zeros(2, 0, dtype=torch.int64))[1].vertices.permutation) == 0


def test_torch_is_imported_only_with_its_tensors():
    program = "import sys, numpy, meshorder; meshorder.order(([0, 1, 2], [1, 0])); print('torch' in sys.modules)"
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert ended.stdout == "False\n", ended.stderr


# PyTorch Geometric


@pytest.fixture(scope="module")
def geometric():
    return pytest.importorskip("torch_geometric")


def some_data(geometric):
    edges = pairs()
    return geometric.data.Data(
        x=torch.randn(210, 4, dtype=torch.float64, requires_grad=True),
        edge_index=edges,
        edge_attr=torch.randn(900, 2),
        edge_weight=torch.randn(900, dtype=torch.float64),
        pos=torch.rand(210, 3),
        y=torch.arange(210),
        train_mask=torch.rand(210) < 0.5,
        edge_label_index=torch.randint(210, (2, 40)),
        edge_label=torch.rand(40),
        names=[f"node {k}" for k in range(210)],
        rows=np.arange(210),
        start_index=np.array([3, 5]),
        title="all",
    )


@pytest.mark.parametrize("inplace", [False, True])
def test_data_moves_as_a_whole(geometric, inplace):
    data = some_data(geometric)
    old = data.clone()
    moved, order = meshorder.reorder(data, vertices="rcm", inplace=inplace)
    assert (moved is data) == inplace and type(moved) is type(data) and moved.keys() == old.keys()
    p, edges = torch.tensor(order.vertices.new_to_old).long(), torch.tensor(order.cells.new_to_old).long()
    for key in ("x", "pos", "y", "train_mask"):
        assert torch.equal(moved[key], old[key][p]), key
    for key in ("edge_attr", "edge_weight"):
        assert torch.equal(moved[key], old[key][edges]), key
    assert moved.names == [f"node {k}" for k in order.vertices.new_to_old] and moved.title == "all"
    np.testing.assert_array_equal(moved.start_index, order.vertices.old_to_new[[3, 5]])
    np.testing.assert_array_equal(moved.rows, order.vertices.new_to_old)
    assert torch.equal(p[moved.edge_label_index], old.edge_label_index)
    assert torch.equal(moved.edge_label, old.edge_label)
    assert edge_set(p[moved.edge_index], moved.edge_weight) == edge_set(old.edge_index, old.edge_weight)
    assert moved.is_sorted(sort_by_row=False) and moved.x.requires_grad
    if not inplace:
        assert torch.equal(data.edge_index, old.edge_index) and torch.equal(data.y, old.y)


def test_message_passing_gives_the_same_sums(geometric):
    utils = geometric.utils
    data = some_data(geometric)
    moved, order = meshorder.reorder(data)
    p = torch.tensor(order.vertices.new_to_old).long()
    before, after = (passed(one.x, one.edge_index, one.edge_weight) for one in (data, moved))
    torch.testing.assert_close(after, before[p])
    layer = geometric.nn.GCNConv(4, 8).double()
    weight = data.edge_weight.abs(), moved.edge_weight.abs()
    torch.testing.assert_close(layer(moved.x, moved.edge_index, weight[1]), layer(data.x, data.edge_index, weight[0])[p])
    for end in (0, 1):
        assert torch.equal(utils.degree(moved.edge_index[end], 210), utils.degree(data.edge_index[end], 210)[p])
    assert utils.contains_self_loops(moved.edge_index) == utils.contains_self_loops(data.edge_index)
    before, after = (
        utils.to_dense_adj(one.edge_index, edge_attr=one.edge_weight, max_num_nodes=210)[0] for one in (data, moved)
    )
    torch.testing.assert_close(after, before[p][:, p])


def test_functions_take_data(geometric):
    edges = undirected(8, 6)
    data = geometric.data.Data(edge_index=edges, num_nodes=48)
    order = meshorder.order(data, "rcm")
    assert order.permutation == meshorder.order(edges, "rcm").permutation
    assert meshorder.quality(data, order) == meshorder.quality(edges, order)
    assert meshorder.fiedler(data).lambda2 == pytest.approx(meshorder.fiedler(edges).lambda2)
    with pytest.raises(InvalidArgument, match="without pos"):
        meshorder.advise(data)
    data.pos = torch.rand(48, 2)
    assert len(meshorder.compare(data, ["rcm"])) == 2 and "order" in meshorder.advise(data).verdict
    data.part = torch.arange(48) % 3
    grouped, _ = meshorder.reorder(data, group_by="part")
    assert (grouped.part.diff() >= 0).all()
    with pytest.raises(InvalidArgument, match="'edges' is not a tensor"):
        meshorder.reorder(data, group_by="edges")


def test_meshes_keep_their_faces(geometric, mesh):
    points, cells = mesh
    triangles = np.unique(cells[:, :3], axis=0)
    data = geometric.data.Data(pos=torch.tensor(points), face=torch.tensor(triangles.T.astype(np.int64)))
    data.face_normal = torch.arange(len(triangles))
    moved, order = meshorder.reorder(data, vertices="rcm")
    corners = torch.tensor(points)[data.face[:, moved.face_normal]]
    assert torch.equal(moved.pos[moved.face], corners)
    largest = moved.face.max(0).values
    assert (largest.diff() >= 0).all() and "faces by their largest corners" in order.cells.reason
    with_edges = geometric.transforms.FaceToEdge(remove_faces=False)(data.clone())
    again, order = meshorder.reorder(with_edges, vertices="rcm")
    assert torch.equal(again.pos[again.face], torch.tensor(points)[data.face[:, again.face_normal]])
    assert len(order.cells.permutation) == with_edges.num_edges + len(triangles)
    assert meshorder.advise(data).verdict


def test_graphs_of_a_batch_stay_apart(geometric):
    graphs = []
    for seed in range(5):
        edges = pairs(seed)[:, : 100 + seed]
        data = geometric.data.Data(x=torch.randn(200 + seed, 2), edge_index=edges, edge_attr=torch.arange(100 + seed), y=seed)
        graphs.append(data)
    batch = geometric.data.Batch.from_data_list(graphs)
    moved, order = meshorder.reorder(batch, vertices="rcm")
    assert type(moved) is type(batch) and torch.equal(moved.batch, batch.batch) and torch.equal(moved.ptr, batch.ptr)
    assert torch.equal(moved.y, batch.y)
    p, begin = order.vertices.new_to_old, 0
    for graph, found in zip(graphs, moved.to_data_list()):
        local = torch.tensor(p[begin : begin + graph.num_nodes] - begin).long()
        assert torch.equal(found.x, graph.x[local])
        assert edge_set(local[found.edge_index], found.edge_attr) == edge_set(graph.edge_index, graph.edge_attr)
        begin += graph.num_nodes
    halves = torch.arange(len(p)) % 2
    p = meshorder.order(batch, "rcm", groups=halves).new_to_old.copy()
    at = batch.batch[p] * 2 + halves[p]
    assert (at.diff() >= 0).all()


def hetero(geometric):
    data = geometric.data.HeteroData()
    data["paper"].x = torch.randn(200, 3, dtype=torch.float64)
    data["paper"].y = torch.arange(200)
    data["author"].x = torch.randn(120, 3, dtype=torch.float64)
    data["venue"].num_nodes = 4
    data["paper", "cites", "paper"].edge_index = pairs()
    data["paper", "cites", "paper"].edge_weight = torch.rand(900, dtype=torch.float64)
    random = np.random.default_rng(5)
    ends = np.stack([random.integers(120, size=500), random.integers(200, size=500)])
    data["author", "writes", "paper"].edge_index = torch.tensor(ends)
    data["author", "writes", "paper"].time = torch.arange(500)
    data["author", "writes", "paper"].edge_label_index = torch.tensor(ends[:, :30])
    data.title = torch.arange(200)
    return data


def test_types_of_nodes_and_edges_keep_their_own(geometric):
    data = hetero(geometric)
    moved, order = meshorder.reorder(data, vertices="rcm")
    papers, authors = order.vertices.new_to_old[:200], order.vertices.new_to_old[200:320] - 200
    assert torch.equal(moved["paper"].y, torch.tensor(papers).long()) and moved["venue"].num_nodes == 4
    assert torch.equal(moved["author"].x, data["author"].x[authors.copy()])
    assert torch.equal(moved.title, data.title)
    p = torch.tensor(papers).long()
    cites = [one["paper", "cites", "paper"] for one in (data, moved)]
    before, after = (passed(one["paper"].x, s.edge_index, s.edge_weight) for one, s in zip((data, moved), cites))
    torch.testing.assert_close(after, before[p])
    old, new = (one["author", "writes", "paper"] for one in (data, moved))
    a = torch.tensor(authors).long()
    for name in ("edge_index", "edge_label_index"):
        back = torch.stack([a[new[name][0]], p[new[name][1]]])
        assert edge_set(back) == edge_set(old[name])
    assert torch.equal(torch.stack([a[new.edge_index[0]], p[new.edge_index[1]]]), old.edge_index[:, new.time])
    assert (new.edge_index[1].diff() >= 0).all()
    # papers that share an author are nearer than before
    assert meshorder.quality(moved).mean_log2_span < meshorder.quality(data).mean_log2_span
    nameless = geometric.data.HeteroData()
    nameless["a", "to", "b"].edge_index = torch.tensor([[0], [0]])
    with pytest.raises(InvalidArgument, match="num_nodes"):
        meshorder.reorder(nameless)


def test_batches_of_types(geometric):
    graphs = [hetero(geometric) for _ in range(3)]
    for graph in graphs:
        graph["venue"].x = torch.rand(4, 1)  # without it PyTorch Geometric cannot split the batch
    batch = geometric.data.Batch.from_data_list(graphs)
    moved, order = meshorder.reorder(batch, vertices="rcm")
    for graph, found in zip(graphs, moved.to_data_list()):
        p = found["paper"].y
        torch.testing.assert_close(found["paper"].x, graph["paper"].x[p])
        cites = [one["paper", "cites", "paper"] for one in (graph, found)]
        assert edge_set(p[cites[1].edge_index], cites[1].edge_weight) == edge_set(cites[0].edge_index, cites[0].edge_weight)


def test_adjacency_in_sparse_form(geometric):
    data = some_data(geometric)
    matrix = torch.sparse_coo_tensor(data.edge_index.flip(0), data.edge_weight, (210, 210)).coalesce()
    given = geometric.data.Data(x=data.x, adj_t=matrix.to_sparse_csr())
    moved, order = meshorder.reorder(given, vertices="rcm")
    p = torch.tensor(order.vertices.new_to_old).long()
    assert torch.equal(moved.adj_t.to_dense(), matrix.to_dense()[p][:, p])
    assert order.vertices.permutation == meshorder.order(data, "rcm").permutation
    given.adj = matrix.to_dense()
    assert torch.equal(meshorder.reorder(given, vertices="rcm")[0].adj, given.adj[p][:, p])
    given.edge_attr = torch.rand(matrix._nnz())
    with pytest.raises(InvalidArgument, match="edge_attr belongs to the entries of a sparse matrix"):
        meshorder.reorder(given)
    with pytest.raises(InvalidArgument, match="expected 3 × 3 nodes"):
        meshorder.reorder(geometric.data.Data(x=torch.rand(3, 1), adj_t=matrix))


def test_what_may_not_move_is_said(geometric):
    data = geometric.data.Data(edge_index=torch.arange(50).repeat(2, 1), x=torch.rand(50), strength=torch.rand(50))
    data.face = torch.randint(50, (3, 20))
    data.colour = torch.rand(20)
    data.train_idx = torch.arange(10)
    data.distance = torch.rand(50, 50)
    with pytest.warns(UserWarning) as said:
        moved, order = meshorder.reorder(data, vertices="scrambled")
    words = sorted(str(one.message) for one in said)
    assert len(words) == 4, words
    assert "colour was kept: 'face' in its name would move it" in words[0]
    assert "distance has a row and a column for each node: only its rows" in words[1]
    assert "strength has a row for each node, or edge" in words[2]
    assert "train_idx was kept" in words[3]
    assert all(one.filename == __file__ for one in said)
    assert torch.equal(moved.colour, data.colour) and torch.equal(moved.train_idx, data.train_idx)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        meshorder.reorder(some_data(geometric))
        meshorder.reorder(geometric.data.Data(edge_index=pairs()))
        meshorder.reorder(hetero(geometric))


def test_refused_graphs_stay_as_they_are(geometric):
    def step(self, key, value, *args):
        return 7 if key == "other_index" else geometric.data.Data.__inc__(self, key, value, *args)

    data = type("Pair", (geometric.data.Data,), {"__inc__": step})(edge_index=pairs(), other_index=torch.zeros(3, dtype=torch.int64))
    before = data.edge_index.clone()
    with pytest.raises(InvalidArgument, match="data.other_index holds numbers that are not of nodes"):
        meshorder.reorder(data, inplace=True)
    assert torch.equal(data.edge_index, before)
    with pytest.raises(InvalidArgument, match="data.edge_index: there is no node"):
        meshorder.reorder(geometric.data.Data(x=torch.rand(100), edge_index=pairs()))
    with pytest.raises(InvalidArgument, match="expected a Data or HeteroData"):
        meshorder.reorder(geometric.data.TemporalData(src=torch.tensor([0]), dst=torch.tensor([1]), t=torch.tensor([0])))


def test_the_manuals_example_runs(geometric):
    page = pathlib.Path(__file__).resolve().parents[2] / "docs" / "python.md"
    if not page.exists():
        pytest.skip("the manual is not here")
    (example,) = re.findall(r"```py\n(.*?)```", page.read_text(), re.DOTALL)
    made: dict[str, typing.Any] = {}
    exec(example, made)
    expected = made["layer"](made["data"].x, made["data"].edge_index)
    torch.testing.assert_close(made["scores"], expected)


def test_the_example_of_the_page_on_gpus_runs():
    page = pathlib.Path(__file__).resolve().parents[2] / "docs" / "gpu.md"
    if not page.exists():
        pytest.skip("the manual is not here")
    (example,) = re.findall(r"```py\n(.*?)```", page.read_text(), re.DOTALL)
    points, cells = np.eye(4, 3), np.array([[0, 1, 2, 3]])
    made: dict[str, typing.Any] = {"nodes": meshorder.Permutation.identity(4), "points": points, "ordered": cells}
    exec(example, made)
    assert made["by_torch"].tolist() == pytest.approx([1 / 24] * 4)


def test_adjacency_between_two_types(geometric):
    data = geometric.data.HeteroData()
    data["a"].x, data["b"].x = torch.rand(30, 1), torch.rand(20, 1)
    dense = (torch.rand(20, 30) < 0.2).double()
    data["a", "to", "b"].adj_t = dense.to_sparse_csr()
    moved, order = meshorder.reorder(data, vertices="scrambled")
    p = torch.tensor(order.vertices.new_to_old).long()
    assert torch.equal(moved["a", "to", "b"].adj_t.to_dense(), dense[p[30:] - 30][:, p[:30]])
