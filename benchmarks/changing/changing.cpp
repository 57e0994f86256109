// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Measures what it costs to keep the order of a changing mesh fresh, and how close this order stays to a
// fresh one:
//
//   changing [--traces stir,churn,refine,cut,dam] [--methods hilbert,hilbert-fronts,rcm,fiedler]
//            [--points 50000] [--steps 120] [--threads 1] [--check none|fast|full]
//
// For each trace (see traces.hpp), scrambled at first, and each method: `fresh` orders all vertices in each
// step, `kept` is a Reorderer, `carried` a Reorderer that never orders anew after the first step. Prints:
// - by how much mean log2 spans exceed those of fresh orders: the mean of the steps, and the worst step; for
//   kept orders also from cells;
// - the costs of orders relative to those of fresh orders: from the graph; and from cells, where fresh orders
//   include building the graph;
// - for methods of points alone, the cost of sorting the points anew in each step;
// - for each kind of repair, the number and the median cost, relative to a fresh order.
//
// Costs are processor time of the calls; with several threads, wall-clock time. Needs meshorder-delaunay
// beside this program.
#include "base/random.hpp"
#include "base/stopwatch.hpp"
#include "benchmarks/changing/traces.hpp"
#include "benchmarks/measuring.hpp"
#include <meshorder/changing.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace meshorder;

int threads = 1;
Check level = Check::none;  // of the check of graphs and cells

/// Makes the call and adds the seconds that it took.
template <class Call>
auto timed(double& seconds, const Call& call) {
  const Stopwatch wall;
  const std::clock_t processor = std::clock();
  auto result = call();
  seconds += threads > 1
                 ? wall.seconds()
                 : static_cast<double>(std::clock() - processor) / static_cast<double>(CLOCKS_PER_SEC);
  return result;
}

OrderOptions options() { return {.check = level, .run = {.threads = threads}}; }

/// A step of a trace in a program's arrays, which have an order of their own.
struct Arrays {
  std::vector<Point> points;
  std::vector<Index> corners;
  std::vector<Index> previous;

  [[nodiscard]] CellsView cells() const { return CellsView::uniform(Shape::tetrahedron, 4, corners); }
};

/// For each position in a program's arrays, the number of the trace's point that is stored there.
class Places {
 public:
  /// Returns the arrays of a step, before it is ordered.
  Arrays arrange(const TraceStep& step) {
    const std::vector<Index> old_places = inverse(at_);
    const std::vector<Index> before = std::exchange(at_, arranged(step));
    Arrays result;
    for (const Index v : at_) {
      result.points.push_back(step.points[static_cast<std::size_t>(v)]);
      if (step.previous.empty()) continue;
      const Index was = step.previous[static_cast<std::size_t>(v)];
      result.previous.push_back(was < 0 ? -1 : old_places[static_cast<std::size_t>(was)]);
    }
    const std::vector<Index> place = inverse(at_);
    for (const Index v : step.corners) result.corners.push_back(place[static_cast<std::size_t>(v)]);
    return result;
  }

  void move(const Permutation& permutation) { permutation.move_in_place(at_); }

 private:
  [[nodiscard]] std::vector<Index> arranged(const TraceStep& step) const {
    std::vector<Index> result;
    if (at_.empty()) {
      result.resize(step.points.size());
      std::iota(result.begin(), result.end(), Index{0});
      Random random(2);
      for (std::size_t k = result.size(); k > 1; --k) std::swap(result[k - 1], result[random.below(k)]);
      return result;
    }
    if (step.successors.empty()) return at_;
    std::vector<bool> has_place(step.points.size());
    for (const Index v : at_) {
      const Index successor = step.successors[static_cast<std::size_t>(v)];
      if (successor < 0) continue;
      result.push_back(successor);
      has_place[static_cast<std::size_t>(successor)] = true;
    }
    for (Index v = 0; v < index_size(step.points); ++v) {
      if (!has_place[static_cast<std::size_t>(v)]) result.push_back(v);
    }
    return result;
  }

  /// Returns the position of each point.
  static std::vector<Index> inverse(const std::vector<Index>& at) {
    return Permutation::from_new_to_old(at).old_to_new();
  }

  std::vector<Index> at_;
};

/// A program that orders its arrays in each step by one strategy.
class Strategy {
 public:
  enum class Kind { fresh, kept, carried, kept_cells, points };

  Strategy(const std::string& method, Kind kind)
      : kind_(kind),
        method_(method),
        reorderer_({.method = method,
                    .budget_seconds = kind == Kind::carried ? 0 : std::numeric_limits<double>::infinity(),
                    .order = options()}) {}

  void step(const TraceStep& step) {
    const Arrays arrays = places_.arrange(step);
    const MeshView mesh{.points = arrays.points, .cells = arrays.cells()};
    const Graph graph = timed(graph_seconds, [&] {
      return vertex_graph(arrays.cells(), arrays.points.size(), {.threads = threads});
    });
    const Permutation order = permutation(graph, mesh, arrays.previous);
    spans.push_back(quality(graph, order).mean_log2_span);
    places_.move(order);
  }

  double seconds = 0;
  double graph_seconds = 0;
  std::vector<double> spans;
  std::map<Repair, std::vector<double>> repairs;  ///< seconds of each repair

 private:
  Permutation permutation(const Graph& graph, const MeshView& mesh, const std::vector<Index>& previous) {
    if (kind_ == Kind::fresh) {
      return timed(seconds, [&] { return order_vertices(graph, method_, options(), mesh.points); })
          .permutation;
    }
    double taken = 0;
    Update update = timed(taken, [&] {
      if (kind_ == Kind::points)
        return Reorderer({.method = method_, .order = options()}).update(mesh.points);
      return kind_ == Kind::kept_cells ? reorderer_.update(mesh, previous)
                                       : reorderer_.update(graph, mesh.points, previous);
    });
    seconds += taken;
    repairs[update.repair].push_back(taken);
    return std::move(update.permutation);
  }

  Kind kind_;
  std::string method_;
  Places places_;
  Reorderer reorderer_;
};

/// Returns "+0.7 %, +3.5 %": by how much spans exceed the fresh ones in the mean, and in the worst step.
std::string above(const Strategy& strategy, const Strategy& fresh) {
  double sum = 0;
  double worst = -1;
  for (std::size_t k = 0; k < fresh.spans.size(); ++k) {
    const double share = strategy.spans[k] / fresh.spans[k] - 1;
    sum += share;
    worst = std::max(worst, share);
  }
  return fmt::format("{:+.1f} %, {:+.1f} %", 100 * sum / static_cast<double>(fresh.spans.size()),
                     100 * worst);
}

void run(const std::string& name, const std::vector<std::string>& methods, Index count, Index steps) {
  using Kind = Strategy::Kind;
  const std::unique_ptr<Trace> trace = make_trace(name, count, steps);
  std::vector<std::vector<std::unique_ptr<Strategy>>> strategies;
  for (const std::string& method : methods) {
    auto& row = strategies.emplace_back();
    for (const Kind kind : {Kind::fresh, Kind::kept, Kind::carried, Kind::kept_cells})
      row.push_back(std::make_unique<Strategy>(method, kind));
    if (method == "hilbert" || method == "morton")
      row.push_back(std::make_unique<Strategy>(method, Kind::points));
  }
  for (Index k = 0; k < steps; ++k) {
    const TraceStep step = trace->next();
    for (const auto& row : strategies) {
      for (const auto& strategy : row) strategy->step(step);
    }
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const Strategy& fresh = *strategies[m][0];
    const Strategy& kept = *strategies[m][1];
    const Strategy& carried = *strategies[m][2];
    const Strategy& cells = *strategies[m][3];
    std::string repairs;
    for (const auto& [repair, taken] : kept.repairs) {
      repairs += fmt::format("{}{} {} at {:.1f} %", repairs.empty() ? "" : ", ", taken.size(),
                             to_string(repair), 100 * median(taken) * steps / fresh.seconds);
    }
    const std::string points =
        strategies[m].size() < 5 ? "" : fmt::format("{:.1f} ms", 1e3 * strategies[m][4]->seconds / steps);
    fmt::print(
        "| {} | {} | {:.2f} | {} | {} | {} | {:.1f} ms | {:.0f} % | {:.0f} % | {:.1f} ms | {:.0f} % | {} | "
        "{} |\n",
        name, methods[m], fresh.spans.back(), above(kept, fresh), above(cells, fresh), above(carried, fresh),
        1e3 * fresh.seconds / steps, 100 * kept.seconds / fresh.seconds,
        100 * carried.seconds / fresh.seconds, 1e3 * (fresh.seconds + fresh.graph_seconds) / steps,
        100 * cells.seconds / (fresh.seconds + fresh.graph_seconds), points, repairs);
    (void)std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What it costs to keep the order of a changing mesh fresh");
  std::string traces = "stir,churn,refine,cut,dam";
  std::string methods = "hilbert,hilbert-fronts,rcm,fiedler";
  Index count = 50000;
  Index steps = 120;
  app.add_option("--traces", traces);
  app.add_option("--methods", methods);
  app.add_option("--points", count)->check(CLI::Range(1000, 10000000));
  app.add_option("--steps", steps)->check(CLI::Range(1, 100000));
  app.add_option("--threads", threads)->check(CLI::Range(1, 1024));
  app.add_option("--check", level)
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Check>{{"none", Check::none}, {"fast", Check::fast}, {"full", Check::full}}));
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "| trace | method | log2 span | kept | from cells | carried | fresh | kept | carried | fresh from "
      "cells | "
      "kept | points alone | repairs |\n"
      "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n");
  for (const std::string& trace : split(traces)) run(trace, split(methods), count, steps);
}
