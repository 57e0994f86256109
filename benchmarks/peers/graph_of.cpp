// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// `peer-graph_of MESH FOLDER` writes the largest component of a mesh's vertex graph as offsets.npy and
// neighbours.npy, so that every peer starts from the same ready graph.
#include "graph/traversal.hpp"
#include "io/format.hpp"
#include "io/npy.hpp"
#include "mesh/graphs.hpp"

#include <fmt/format.h>

#include <cstdio>

int main(int argc, char** argv) {
  using namespace meshorder;
  if (argc != 3) {
    fmt::print(stderr, "usage: peer-graph_of MESH FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[2];
  const CsrGraph whole = vertex_graph(read_mesh(argv[1]));
  const CsrGraph graph = induced_subgraph(whole, connected_components(whole).front());
  const std::vector<std::int64_t> offsets(graph.offsets.begin(), graph.offsets.end());
  const std::vector<std::int32_t> neighbours(graph.neighbours.begin(), graph.neighbours.end());
  std::filesystem::create_directories(folder);
  write_npy(offsets, folder / "offsets.npy");
  write_npy(neighbours, folder / "neighbours.npy");
}
