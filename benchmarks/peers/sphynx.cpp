// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Sphynx, the spectral partitioner of Trilinos' Zoltan2: `mpirun -n N peer-sphynx GRAPH PARTS OUT
// [PRECONDITIONER]` for a folder that `peer-graph_of` wrote. PRECONDITIONER: muelu, jacobi or polynomial.
#include "parts.hpp"

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsGraph.hpp>
#include <Zoltan2_SphynxProblem.hpp>
#include <Zoltan2_XpetraCrsGraphAdapter.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using Graph = Tpetra::CrsGraph<>;
using Number = Graph::global_ordinal_type;
using Adapter = Zoltan2::XpetraCrsGraphAdapter<Graph>;

/// Reads this rank's rows, and adds the diagonal that Sphynx needs.
Teuchos::RCP<Graph> read_graph(const std::string& folder) {
  const std::vector<std::int64_t> offsets = peer::read_numbers(folder + "/offsets.npy");
  const std::vector<std::int64_t> neighbours = peer::read_numbers(folder + "/neighbours.npy");
  const auto size = static_cast<std::int64_t>(offsets.size()) - 1;
  const peer::Range own = peer::own_range(size);
  std::int64_t most = 0;
  for (std::size_t v = 0; v + 1 < offsets.size(); ++v) most = std::max(most, offsets[v + 1] - offsets[v]);
  const auto map = Teuchos::rcp(new Graph::map_type(static_cast<Tpetra::global_size_t>(size),
                                                    static_cast<std::size_t>(own.end - own.begin), 0,
                                                    Tpetra::getDefaultComm()));
  auto graph = Teuchos::rcp(new Graph(map, static_cast<std::size_t>(most) + 1));
  for (std::int64_t v = own.begin; v < own.end; ++v) {
    std::vector<Number> row(neighbours.begin() + offsets[static_cast<std::size_t>(v)],
                            neighbours.begin() + offsets[static_cast<std::size_t>(v) + 1]);
    row.push_back(v);
    graph->insertGlobalIndices(v, Teuchos::ArrayView<const Number>(row.data(), static_cast<int>(row.size())));
  }
  graph->fillComplete();
  return graph;
}

}  // namespace

int main(int argc, char** argv) {
  const Tpetra::ScopeGuard scope(&argc, &argv);
  if (argc < 4) {
    std::fputs("usage: peer-sphynx GRAPH PARTS OUT [PRECONDITIONER]\n", stderr);
    return 2;
  }
  peer::run_on_ranks([&] {
    const auto adapter = Teuchos::rcp(new Adapter(read_graph(argv[1]), 0));
    const auto parameters = Teuchos::rcp(new Teuchos::ParameterList());
    parameters->set("num_global_parts", std::atoi(argv[2]));
    parameters->set("sphynx_skip_preprocessing", true);  // the only value that Sphynx implements
    parameters->set("sphynx_verbosity", 0);  // with more, version 13.2 mixes up its ranks' messages
    if (argc > 4) parameters->set("sphynx_preconditioner_type", std::string(argv[4]));
    peer::measure_parts(argv[3], [&] {
      Zoltan2::SphynxProblem<Adapter> problem(adapter, parameters);
      problem.solve();
      const int* parts = problem.getSolution().getPartListView();
      return std::vector<int>(parts, parts + adapter->getLocalNumIDs());
    });
  });
}
