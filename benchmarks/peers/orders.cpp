// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// `peer-orders MESH FOLDER NAME…` orders the vertices of a mesh by methods of Boost (boost-rcm, boost-sloan),
// Scotch (scotch-nd), meshoptimizer (meshopt-spatial) and meshorder (all others). Writes FOLDER/NAME.npy, the
// old place of the vertex at each new place, and prints for each the seconds from a ready graph, the least of
// up to three runs.
#include "base/stopwatch.hpp"
#include "io/npy.hpp"
#include "mesh/graphs.hpp"
#include <meshorder/io.hpp>
#include <meshorder/order.hpp>

#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/cuthill_mckee_ordering.hpp>
#include <boost/graph/sloan_ordering.hpp>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

// scotch.h needs FILE
#include <scotch.h>

namespace mo = meshorder;

namespace {

using Order = std::vector<std::int32_t>;  ///< the old place of the vertex at each new place
using BoostGraph = boost::compressed_sparse_row_graph<boost::directedS>;
using BoostVertex = boost::graph_traits<BoostGraph>::vertex_descriptor;

struct Problem {
  mo::Mesh mesh;
  mo::CsrGraph graph;
  BoostGraph boost_graph;
};

BoostGraph boost_graph_of(const mo::CsrGraph& graph) {
  std::vector<std::pair<BoostVertex, BoostVertex>> edges;
  edges.reserve(graph.neighbours.size());
  for (mo::Index v = 0; v < graph.size(); ++v) {
    for (const mo::Index u : graph[v]) edges.emplace_back(v, u);
  }
  return {boost::edges_are_sorted, edges.begin(), edges.end(), static_cast<BoostVertex>(graph.size())};
}

/// Runs one of Boost's methods, which are all called alike.
template <class Run>
Order by_boost(const Problem& problem, Run run) {
  const BoostGraph& graph = problem.boost_graph;
  const auto places = get(boost::vertex_index, graph);
  std::vector<BoostVertex> order(num_vertices(graph));
  std::vector<boost::default_color_type> colors(order.size(), boost::white_color);
  std::vector<std::size_t> degrees;
  for (BoostVertex v = 0; v < order.size(); ++v) degrees.push_back(out_degree(v, graph));
  run(order, boost::make_iterator_property_map(colors.begin(), places),
      boost::make_iterator_property_map(degrees.begin(), places));
  return {order.begin(), order.end()};
}

Order by_scotch(const Problem& problem) {
  const auto& [mesh, graph, boost_graph] = problem;
  std::vector<SCOTCH_Num> offsets(graph.offsets.begin(), graph.offsets.end());
  std::vector<SCOTCH_Num> neighbours(graph.neighbours.begin(), graph.neighbours.end());
  std::vector<SCOTCH_Num> new_place(static_cast<std::size_t>(graph.size()));
  std::vector<SCOTCH_Num> old_place(new_place.size());
  SCOTCH_Graph scotch;
  SCOTCH_Strat strategy;
  SCOTCH_Num blocks = 0;
  std::vector<SCOTCH_Num> ranges(new_place.size() + 1);
  std::vector<SCOTCH_Num> tree(new_place.size());
  SCOTCH_graphInit(&scotch);
  SCOTCH_stratInit(&strategy);
  SCOTCH_graphBuild(&scotch, 0, graph.size(), offsets.data(), nullptr, nullptr, nullptr,
                    static_cast<SCOTCH_Num>(neighbours.size()), neighbours.data(), nullptr);
  SCOTCH_graphOrder(&scotch, &strategy, new_place.data(), old_place.data(), &blocks, ranges.data(),
                    tree.data());
  SCOTCH_stratExit(&strategy);
  SCOTCH_graphExit(&scotch);
  return {old_place.begin(), old_place.end()};
}

Order by_meshoptimizer(const Problem& problem) {
  std::vector<float> positions;
  for (const mo::Point& point : problem.mesh.points) {
    for (const double x : point) positions.push_back(static_cast<float>(x));
  }
  std::vector<unsigned int> new_place(problem.mesh.points.size());
  meshopt_spatialSortRemap(new_place.data(), positions.data(), new_place.size(), 3 * sizeof(float));
  Order order(new_place.size());
  for (std::size_t v = 0; v < order.size(); ++v) order[new_place[v]] = static_cast<std::int32_t>(v);
  return order;
}

Order ordered(const Problem& problem, const std::string& name) {
  if (name == "boost-rcm") {
    return by_boost(problem, [&](auto& order, auto colors, auto degrees) {
      boost::cuthill_mckee_ordering(problem.boost_graph, order.rbegin(), colors, degrees);
    });
  }
  if (name == "boost-sloan") {
    return by_boost(problem, [&](auto& order, auto colors, auto degrees) {
      std::vector<double> priorities(order.size());
      const auto places = get(boost::vertex_index, problem.boost_graph);
      boost::sloan_ordering(problem.boost_graph, order.begin(), colors, degrees,
                            boost::make_iterator_property_map(priorities.begin(), places));
    });
  }
  if (name == "scotch-nd") return by_scotch(problem);
  if (name == "meshopt-spatial") return by_meshoptimizer(problem);
  const mo::PointsView points{problem.mesh.points.front().data(), problem.mesh.points.size()};
  const mo::Order order =
      mo::order_vertices({.offsets = problem.graph.offsets, .neighbours = problem.graph.neighbours}, name,
                         {.run = {.threads = 1}}, points);
  return {order.permutation.new_to_old().begin(), order.permutation.new_to_old().end()};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    fmt::print(stderr, "usage: peer-orders MESH FOLDER NAME…\n");
    return 2;
  }
  Problem problem;
  problem.mesh = mo::read_mesh(argv[1]);
  problem.graph = mo::vertex_graph(problem.mesh);
  problem.boost_graph = boost_graph_of(problem.graph);
  for (const std::string& name : std::vector<std::string>(argv + 3, argv + argc)) {
    Order order;
    double best = 0;
    const mo::Stopwatch all;
    for (int run = 0; run < 3 && (run == 0 || all.seconds() < 3); ++run) {
      const mo::Stopwatch stopwatch;
      order = ordered(problem, name);
      best = run == 0 ? stopwatch.seconds() : std::min(best, stopwatch.seconds());
    }
    mo::write_npy(order, std::filesystem::path(argv[2]) / (name + ".npy"));
    fmt::print("{} {}\n", name, best);
    std::fflush(stdout);
  }
}
