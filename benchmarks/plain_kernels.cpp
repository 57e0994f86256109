// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// plain_kernels MESH [METHOD,METHOD… [rounds]]: times kernels as simple programs write them, without
// prefetches (src/kernels/plain.hpp, plain_programs.hpp), on a tetrahedral mesh in several orders. Elements
// and edges are sorted by their largest vertex; for `springs*` edges are sorted by their smaller end.
// NAME=@FILE.npy takes the order of the vertices from a file: the old place of the vertex at each new place.
// If the mesh is grid-N and no such file exists, it is a lattice in random order.
//
// All orders use the same memory, and so the same pages: the data are moved there before an order's turn.
// Each round has another sequence of orders. A kernel runs alternately in the order and, in separate memory,
// in the first order, because the speed of a shared machine changes from minute to minute. Prints medians of
// the ratios of these two times, multiplied by the median time in the first order, in ms of the thread's
// processor time.
#include "io/npy.hpp"
#include "measuring.hpp"
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"
#include "plain_programs.hpp"
#include <meshorder/io.hpp>
#include <meshorder/order.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace mo = meshorder;

namespace {

using Columns = std::int32_t;
constexpr int kFeatures = 64;

/// The mesh in one order.
struct Ordered {
  std::string name;
  double jumps = 0;
  double span = 0;
  std::vector<mo::Index> tetrahedra;
  std::vector<mo::Index> ends;  // sorted by the larger end
  std::vector<mo::Index> by_smaller_end;
  std::vector<Columns> starts;
  std::vector<Columns> columns;  // with the diagonal
  std::vector<double> positions;
};

/// The memory in which all orders run.
struct Workspace : Ordered {
  std::vector<double> values;
  std::vector<float> narrow_values;
  std::vector<std::int64_t> wide_starts;
  std::vector<std::int64_t> wide_columns;
  std::vector<double> blocks;
  std::vector<double> x;  // 5 numbers a vertex; most kernels need fewer
  std::vector<double> y;
  std::vector<float> narrow_x;
  std::vector<float> narrow_y;
  std::vector<double> lengths;
  std::vector<float> narrow;  // features
  std::vector<float> sums;
};

double seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Moves the vertices to the order in a file.
void move_vertices(mo::Mesh& mesh, const std::string& file) {
  std::vector<mo::Index> new_to_old;
  for (const std::int64_t old : mo::read_npy(file)) new_to_old.push_back(static_cast<mo::Index>(old));
  mo::apply_reordering(mesh, mo::Permutation::from_new_to_old(std::move(new_to_old)),
                       mo::Permutation::identity(mesh.cell_count()));
}

Ordered in_order_of(mo::Mesh mesh, const std::string& order) {
  Ordered result;
  const std::size_t mark = order.find("=@");
  result.name = order.substr(0, mark);
  const bool is_file = mark != std::string::npos;
  if (is_file) move_vertices(mesh, order.substr(mark + 2));
  const std::string method = is_file ? "original" : order;
  mo::reorder(mesh, {.methods = {method, order == "original" ? "original" : "lexmax"}});
  const mo::CsrGraph graph = mo::vertex_graph(mesh);
  const mo::Permutation as_is = mo::Permutation::identity(graph.size());
  result.jumps = mo::jump_share(graph, as_is);
  result.span = mo::edge_span(graph, as_is).mean;
  for (mo::Index c = 0; c < mesh.cell_count(); ++c) {
    const auto cell = mesh.cells[c];
    if (mesh.cells.shapes[c] == mo::Shape::tetrahedron)
      result.tetrahedra.insert(result.tetrahedra.end(), cell.begin(), cell.begin() + 4);
  }
  result.starts.push_back(0);
  for (mo::Index v = 0; v < graph.size(); ++v) {
    for (const double x : mesh.points[v]) result.positions.push_back(x);
    bool has_own = false;
    for (const mo::Index u : graph[v]) {
      if (u > v && !has_own) {
        result.columns.push_back(v);
        has_own = true;
      }
      result.columns.push_back(u);
      auto& list = u < v ? result.ends : result.by_smaller_end;
      list.insert(list.end(), {std::min(u, v), std::max(u, v)});
    }
    if (!has_own) result.columns.push_back(v);
    result.starts.push_back(static_cast<Columns>(result.columns.size()));
  }
  return result;
}

template <class T>
void fill(std::vector<T>& to, const std::vector<T>& from) {
  to.assign(from.begin(), from.end());
}

struct Kernel {
  const char* name;
  std::function<void(Workspace&)> run;
};

mo::plain::Matrix<double, Columns> matrix(Workspace& w) { return {w.starts, w.columns, w.values}; }

std::vector<Kernel> kernels() {
  return {
      {"product",
       [](Workspace& w) {
         const auto n = w.starts.size() - 1;
         mo::plain::multiply(matrix(w), std::span<const double>(w.x).first(n), std::span(w.y).first(n));
       }},
      {"64-bit",
       [](Workspace& w) {
         const auto n = w.starts.size() - 1;
         const mo::plain::Matrix<double, std::int64_t> a{w.wide_starts, w.wide_columns, w.values};
         mo::plain::multiply(a, std::span<const double>(w.x).first(n), std::span(w.y).first(n));
       }},
      {"float",
       [](Workspace& w) {
         const mo::plain::Matrix<float, Columns> a{w.starts, w.columns, w.narrow_values};
         mo::plain::multiply(a, std::span<const float>(w.narrow_x), std::span(w.narrow_y));
       }},
      {"3×3",
       [](Workspace& w) {
         const mo::plain::Matrix<double, Columns> a{w.starts, w.columns, w.blocks};
         mo::plain::multiply_blocks(a, w.x, w.y);
       }},
      {"relax",
       [](Workspace& w) {
         const auto n = w.starts.size() - 1;
         mo::plain::relax(matrix(w), std::span<const double>(w.x).first(n), std::span(w.y).first(n));
       }},
      {"elements", [](Workspace& w) { mo::plain::press<4>(w.tetrahedra, w.positions, w.y); }},
      {"assembly", [](Workspace& w) { mo::plain::assemble<4>(w.tetrahedra, w.positions, matrix(w)); }},
      {"springs",
       [](Workspace& w) {
         mo::plain::springs(w.ends, std::span<const double>(w.lengths), std::span<const double>(w.positions),
                            std::span(w.y));
       }},
      {"springs*",
       [](Workspace& w) {
         mo::plain::springs(w.by_smaller_end, std::span<const double>(w.lengths),
                            std::span<const double>(w.positions), std::span(w.y));
       }},
      {"volumes", [](Workspace& w) { mo::plain::exchange(w.ends, w.lengths, w.x, w.y); }},
      {"messages",
       [](Workspace& w) {
         const mo::plain::Matrix<float, Columns> graph{w.starts, w.columns, {}};
         mo::plain::gather_messages(graph, kFeatures, w.narrow, w.sums);
       }},
  };
}

void put(Workspace& w, const Ordered& order) {
  const std::size_t n = order.starts.size() - 1;
  fill(w.tetrahedra, order.tetrahedra);
  fill(w.ends, order.ends);
  fill(w.by_smaller_end, order.by_smaller_end);
  fill(w.starts, order.starts);
  fill(w.columns, order.columns);
  fill(w.positions, order.positions);
  w.wide_starts.assign(order.starts.begin(), order.starts.end());
  w.wide_columns.assign(order.columns.begin(), order.columns.end());
  w.values.assign(order.columns.size(), 1e-3);
  w.narrow_values.assign(order.columns.size(), 1e-3F);
  w.blocks.assign(9 * order.columns.size(), 1e-3);
  w.x.assign(5 * n, 1.0);
  w.y.assign(5 * n, 0.0);
  w.narrow_x.assign(n, 1.0F);
  w.narrow_y.assign(n, 0.0F);
  w.lengths.assign(order.ends.size() / 2, 1e-6);
  w.narrow.assign(kFeatures * n, 1.0F);
  w.sums.assign(kFeatures * n, 0.0F);
}

/// Runs the kernel twice; returns the time of the second run.
double milliseconds(const Kernel& kernel, Workspace& w) {
  kernel.run(w);
  const double begin = seconds();
  kernel.run(w);
  return 1e3 * (seconds() - begin);
}

mo::Mesh mesh_named(const std::string& name) {
  if (std::filesystem::exists(name) || !name.starts_with("grid-")) return mo::read_mesh(name);
  mo::Mesh mesh = mo::make_grid({.size = std::atoi(name.c_str() + 5)});
  mo::reorder(mesh, {.methods = {"scrambled", "scrambled"}});
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const mo::Mesh mesh = mesh_named(argv[1]);
  const auto methods =
      split(argc > 2 ? argv[2] : "original,hilbert,hilbert-fronts,spectral,spectral-fronts,bfs,rcm");
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 11;
  std::vector<Ordered> orders;
  for (const std::string& method : methods) orders.push_back(in_order_of(mesh, method));

  const std::vector<Kernel> all = kernels();
  Workspace w;
  Workspace reference;
  put(reference, orders.front());
  std::vector<std::vector<std::vector<double>>> ratios(orders.size(),
                                                       std::vector<std::vector<double>>(all.size()));
  std::vector<std::vector<double>> in_first(all.size());
  std::vector<std::size_t> turns(orders.size());
  std::iota(turns.begin(), turns.end(), std::size_t{0});
  std::mt19937 random(1);
  for (int round = 0; round < rounds; ++round) {
    std::shuffle(turns.begin(), turns.end(), random);
    for (const std::size_t o : turns) {
      put(w, orders[o]);
      for (std::size_t k = 0; k < all.size(); ++k) {
        for (int again = 0; again < 2; ++again) {
          const double first = milliseconds(all[k], reference);
          ratios[o][k].push_back(milliseconds(all[k], w) / first);
          in_first[k].push_back(first);
        }
      }
    }
  }

  fmt::print("{} vertices, {} tetrahedra, {} rounds\n{:<16}{:>7}{:>8}", mesh.vertex_count(),
             mesh.cell_count(), rounds, "order", "jumps", "span");
  for (const Kernel& kernel : all) fmt::print("{:>10}", kernel.name);
  fmt::print("\n");
  for (std::size_t o = 0; o < orders.size(); ++o) {
    fmt::print("{:<16}{:>7.3f}{:>8.0f}", orders[o].name, orders[o].jumps, orders[o].span);
    for (std::size_t k = 0; k < all.size(); ++k)
      fmt::print("{:>10.3f}", median(ratios[o][k]) * median(in_first[k]));
    fmt::print("\n");
  }
}
