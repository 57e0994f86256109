// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Orders are the same on any number of threads, from any compiler and at any level of optimisation: this
// program compares their hashes with those in order_hashes.txt. Coordinates of the samples are sums and
// products of whole numbers, and do not depend on a mathematical library.
#include "mesh/procedural.hpp"
#include "support/files.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/order.hpp>
#include <meshorder/registry.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace meshorder {
namespace {

/// FNV-1a over the bytes of the numbers, the lowest first.
std::uint64_t hash_of(const Permutation& order) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const Index v : order.new_to_old()) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      hash = (hash ^ ((static_cast<std::uint32_t>(v) >> shift) & 0xffU)) * 0x100000001b3U;
    }
  }
  return hash;
}

struct Sample {
  std::string name;
  Mesh mesh;
};

/// The mesh with its vertices in random order.
Mesh scattered(Mesh mesh) {
  const Graph graph = vertex_graph(view(mesh).cells, mesh.points.size());
  const Permutation vertices = order_vertices(graph, "scrambled", {.seed = 3}).permutation;
  apply_reordering(mesh, vertices, Permutation::identity(mesh.cell_count()));
  return mesh;
}

/// Two surfaces of triangles beside a few vertices without cells.
Mesh surfaces() {
  Mesh mesh;
  for (const Index side : {23, 31}) {
    const Index first = mesh.vertex_count();
    for (Index v = 0; v < side * side + 3; ++v) {
      const Index height = v * v % 17;
      mesh.points.push_back({0.25 * (v % side), 0.5 * (v / side), 0.125 * height});
    }
    for (Index y = 0; y + 1 < side; ++y) {
      for (Index x = 0; x + 1 < side; ++x) {
        const Index v = first + y * side + x;
        mesh.cells.push_back(Shape::triangle, std::vector<Index>{v, v + 1, v + side});
        mesh.cells.push_back(Shape::triangle, std::vector<Index>{v + 1, v + side + 1, v + side});
      }
    }
  }
  return mesh;
}

Mesh mixed() {
  Mesh mesh = test::mixed_mesh();
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    mesh.points[v] = {0.5 * (v * 37 % 101), 0.25 * (v * 53 % 97), 0.125 * (v * 71 % 89)};
  }
  mesh.cell_blocks.clear();
  return mesh;
}

Mesh lattice(Index size) { return scattered(make_grid({.size = size, .jitter = 0.15, .seed = 1})); }

std::vector<Sample> samples() {
  return {{"lattice", lattice(11)}, {"surfaces", scattered(surfaces())}, {"mixed", mixed()}};
}

struct Setting {
  std::string name;
  OrderOptions options;
};

/// `groups` and `cell_groups` must outlive the result.
std::vector<Setting> settings(const std::vector<Index>& groups, const std::vector<Index>& cell_groups) {
  return {{"default", {}},
          {"seed 7", {.seed = 7}},
          {"tolerance 1e-6", {.tolerance = 1e-6}},
          {"groups", {.groups = groups, .cell_groups = cell_groups}}};
}

std::vector<Index> groups_of(Index n) {
  std::vector<Index> groups(n);
  for (Index i = 0; i < n; ++i) groups[i] = i % 5 * 10;
  return groups;
}

/// Calls `check(what, permutation)` for each method of vertices, and for each method of elements after
/// reverse Cuthill–McKee.
template <class Check>
void with_all_methods(const Mesh& mesh, const OrderOptions& options, const Check& check) {
  const MeshView given = view(mesh);
  const Graph graph = vertex_graph(given.cells, mesh.points.size(), options.run);
  for (const MethodInfo& method : vertex_methods()) {
    check("vertices " + method.name, order_vertices(graph, method.name, options, given.points).permutation);
  }
  const Permutation vertices = order_vertices(graph, "rcm").permutation;
  for (const MethodInfo& method : element_methods()) {
    check("elements " + method.name,
          order_elements(given.cells, vertices, method.name, options, given.points).permutation);
  }
}

/// The committed hashes by the beginnings of their lines, for comparison with this run's hashes.
class Hashes {
 public:
  Hashes() {
    std::istringstream text(test::content_of(MESHORDER_ORDER_HASHES));
    for (std::string line; std::getline(text, line);) {
      if (!line.starts_with('#'))
        committed_[line.substr(0, line.rfind(": "))] = line.substr(line.rfind(": ") + 2);
    }
  }
  /// Appends this run's hashes to the file that MESHORDER_WRITE_ORDER_HASHES names, if set.
  ~Hashes() {
    const char* path =
        std::getenv("MESHORDER_WRITE_ORDER_HASHES");  // NOLINT(concurrency-mt-unsafe): one thread
    if (path == nullptr) return;
    std::ofstream file(path, std::ios::app);
    for (const auto& [what, hash] : found_) file << what << ": " << hash << '\n';
  }
  Hashes(const Hashes&) = delete;
  Hashes(Hashes&&) = delete;
  Hashes& operator=(const Hashes&) = delete;
  Hashes& operator=(Hashes&&) = delete;

  void expect(const std::string& what, const Permutation& order) {
    std::ostringstream hash;
    hash << std::hex << std::setw(16) << std::setfill('0') << hash_of(order);
    found_[what] = hash.str();
    EXPECT_EQ(hash.str(), committed_[what]) << what;
  }

  [[nodiscard]] std::size_t found() const { return found_.size(); }

 private:
  std::map<std::string, std::string> committed_;
  std::map<std::string, std::string> found_;
};

TEST(OrderHashes, AreTheCommittedOnesForAllMethodsAndOptions) {
  Hashes hashes;
  for (const auto& [name, mesh] : samples()) {
    const std::vector<Index> groups = groups_of(mesh.vertex_count());
    const std::vector<Index> cell_groups = groups_of(mesh.cell_count());
    for (const auto& [setting, options] : settings(groups, cell_groups)) {
      with_all_methods(
          mesh, options,
          [&, &name = name, &setting = setting](const std::string& what, const Permutation& order) {
            hashes.expect(name + ", " + setting + ", " + what, order);
          });
    }
    for (const Workload workload : kWorkloads) {
      const MeshOrder order = order_mesh(view(mesh), {}, {.workload = workload});
      hashes.expect(name + ", for " + std::string(to_string(workload)) + ", vertices auto",
                    order.vertices.permutation);
    }
  }
  EXPECT_GE(hashes.found(), 200U);
}

TEST(OrderHashes, AreTheCommittedOnesOnOneToEightThreads) {
  Hashes hashes;
  const Mesh mesh = lattice(26);
  const std::vector<int> counts =
      test::kSanitized ? std::vector{1, 3, 8} : std::vector{1, 2, 3, 4, 5, 6, 7, 8};
  for (const int threads : counts) {
    SCOPED_TRACE(std::to_string(threads) + " threads");
    with_all_methods(mesh, {.run = {.threads = threads}},
                     [&](const std::string& what, const Permutation& order) {
                       hashes.expect("large lattice, default, " + what, order);
                     });
  }
}

}  // namespace
}  // namespace meshorder
