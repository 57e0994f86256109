// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/mesh_study.hpp"

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "mesh/stored_matrix.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/cost_model.hpp"
#include "payoff/machine.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

namespace meshorder {
namespace {

constexpr Offset kMostExact = 1'000'000;
/// Approximate share of the time for orders and simulated caches, if kernels are timed, too.
constexpr double kUntilTiming = 0.5;

/// Returns the seconds that `call` takes on the arena's threads: the best of three calls; a call of a second
/// or more is the last. `prepare` runs before each call, and its time does not count.
template <class Prepare, class Call>
double best_seconds(tbb::task_arena& threads, Prepare prepare, Call call) {
  constexpr double kLong = 1.0;
  constexpr int kTries = 3;
  double best = kLong;
  for (int i = 0; i < kTries; ++i) {
    prepare();
    const Stopwatch stopwatch;
    threads.execute(call);
    const double seconds = stopwatch.seconds();
    if (seconds >= kLong) return i == 0 ? seconds : best;
    best = std::min(best, seconds);
  }
  return best;
}

Mesh points_and_cells(const Mesh& mesh) {
  Mesh result;
  result.points = mesh.points;
  result.cells = mesh.cells;
  if (stored_matrix(mesh) != nullptr) result.format_metadata = mesh.format_metadata;
  return result;
}

class MeshStudy {
 public:
  MeshStudy(const Mesh& mesh, const MeshStudyOptions& options)
      : options_(options),
        mesh_(points_and_cells(mesh)),
        threads_(options.threads > 0 ? options.threads : tbb::task_arena::automatic),
        graph_seconds_(best_seconds(
            threads_, [] {}, [&] { graph_ = vertex_graph(mesh_); })),
        input_(mesh_, graph_) {
    MeshRecord& record = result_.record;
    record.vertices = mesh_.vertex_count();
    record.tetrahedra = input_.simplices().size();
    record.edges = graph_.edge_count();
    record.span_bin = span_bin_width(record.vertices);
    record.hierarchies = options.hierarchies.empty() ? hierarchies_of_studies() : options.hierarchies;
  }

  void add(const OrderingSpec& ordering) {
    MeshOrder order;
    MeshOrderRecord& record = result_.record.orders.emplace_back();
    record.ordering = ordering.name;
    record.seconds = compute(ordering, order);
    record.vertex_method = order.vertices.method.name;
    record.element_method = order.cells.method.name;
    record.span = edge_span(graph_, order.vertices.permutation);
    record.span_histogram = span_histogram(graph_, order.vertices.permutation, result_.record.span_bin);
    simulate_caches(order, record);
    result_.orders.push_back(std::move(order));
  }

  void time_kernels() {
    const Timings timings = time_orders(
        index_size(result_.orders),
        [&](Index i) { return prepare_kernels(KernelSet::plain, input_.moved(result_.orders[i])); },
        options_.timing);
    result_.steadiness = timings.steadiness;
    for (std::size_t i = 0; i < timings.orders.size(); ++i) {
      for (std::size_t k = 0; k < kKernels.size(); ++k)
        result_.record.orders[i].kernels[k].measured_ms = timings.orders[i][kKernels[k]].best_ms;
    }
  }

  OrderedMesh result() && { return std::move(result_); }

 private:
  /// Computes the order and returns its cost (s).
  double compute(const OrderingSpec& ordering, MeshOrder& order) {
    Mesh moved;
    const double seconds = best_seconds(
        threads_, [&] { moved = mesh_; },
        [&] {
          order = compute_order_in_file(
              mesh_, graph_, {.methods = {ordering.vertices, ordering.elements}, .order = options_.ordering});
          apply_reordering(moved, order);
        });
    const bool moves_nothing =
        order.vertices.method.name == "original" && order.cells.method.name == "original";
    return moves_nothing ? 0.0 : graph_seconds_ + seconds;
  }

  void simulate_caches(const MeshOrder& order, MeshOrderRecord& record) const {
    const std::vector<NamedCaches>& hierarchies = result_.record.hierarchies;
    const int halvings = result_.record.tetrahedra > kMostExact ? halvings_for(result_.record.tetrahedra) : 0;
    const KernelReuse reuse = reuse_of_kernels(input_.moved(order), halvings);
    const KernelMilliseconds predicted = predicted_ms(reuse, hierarchies.front().caches);
    for (std::size_t k = 0; k < kernels_of(mesh_).size(); ++k) {
      KernelRecord& kernel = record.kernels[k];
      kernel.predicted_ms = predicted[k];
      kernel.accesses = reuse[k].all.accesses();
      for (const NamedCaches& hierarchy : hierarchies)
        kernel.misses.push_back(misses(reuse[k].all, hierarchy.caches));
    }
  }

  MeshStudyOptions options_;
  Mesh mesh_;
  CsrGraph graph_;
  tbb::task_arena threads_;
  double graph_seconds_;
  KernelInput input_;
  OrderedMesh result_;
};

}  // namespace

std::vector<NamedCaches> hierarchies_of_studies() {
  return {{"this machine", caches_of_this_machine()}, {"the paper's Xeon E5-1620 v4", caches_of_the_paper()}};
}

Index span_bin_width(Index vertices) {
  constexpr Index kPaper = 50;
  constexpr Index kMostBins = 4000;
  return kPaper * std::max<Index>(1, chunk_count(vertices, kMostBins * kPaper));
}

OrderedMesh study_mesh(const Mesh& mesh, const std::vector<OrderingSpec>& orderings,
                       const MeshStudyOptions& options) {
  const auto tell = [&](std::string_view what, double fraction) {
    if (options.progress) options.progress(what, fraction);
  };
  tell("reading the mesh's graph", 0);
  MeshStudy study(mesh, options);
  const double share = (options.measure ? kUntilTiming : 1.0) /
                       static_cast<double>(std::max<std::size_t>(1, orderings.size()));
  for (std::size_t i = 0; i < orderings.size(); ++i) {
    tell("ordering by " + orderings[i].name, share * static_cast<double>(i));
    study.add(orderings[i]);
  }
  if (options.measure) {
    tell("running kernels", kUntilTiming);
    study.time_kernels();
  }
  return std::move(study).result();
}

}  // namespace meshorder
