# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Message passing as in MeshGraphNets (T. Pfaff et al., ICLR 2021), forward, in PyTorch: mesh_graph_net.py MESH"""
import sys
import time

import meshio
import numpy
import torch

FEATURES, STEPS = 64, 1

torch.manual_seed(0)
torch.set_num_threads(1)
mesh = meshio.read(sys.argv[1])
tetrahedra = numpy.concatenate([block.data for block in mesh.cells if block.type == "tetra"])
ends = numpy.concatenate([tetrahedra[:, pair] for pair in ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))])
ends = numpy.unique(numpy.sort(ends, axis=1), axis=0).astype(numpy.int64)
points = torch.tensor(mesh.points, dtype=torch.float32)
edges = torch.tensor(numpy.concatenate([ends, ends[:, ::-1]]).T.copy())
edges = edges[:, torch.argsort(edges[1], stable=True)]


def network(inputs):
    return torch.nn.Sequential(torch.nn.Linear(inputs, FEATURES), torch.nn.ReLU(), torch.nn.Linear(FEATURES, FEATURES))


of_edges, of_nodes = network(3 * FEATURES), network(2 * FEATURES)
lift_node, lift_edge = torch.nn.Linear(3, FEATURES), torch.nn.Linear(3, FEATURES)


def forward():
    node = lift_node(points)
    edge = lift_edge(points[edges[0]] - points[edges[1]])
    for _ in range(STEPS):
        edge = edge + of_edges(torch.cat([node[edges[0]], node[edges[1]], edge], dim=1))
        message = torch.zeros_like(node).index_add_(0, edges[1], edge)
        node = node + of_nodes(torch.cat([node, message], dim=1))
    return node


with torch.no_grad():
    begin = time.process_time()
    node = forward()
print(f"compute: {time.process_time() - begin:.6f} s")
print("energy:", float(node.double().square().sum()))
