// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/motion/integrator.hpp"
#include "lab/scenario/motion_metrics.hpp"
#include "lab/support/machine.hpp"
#include "metrics/cache.hpp"
#include "metrics/edge_span.hpp"
#include "payoff/kernel_bench.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// An order of vertices and elements in a study, such as "vf-fiedler".
struct OrderingSpec {
  std::string name;      ///< unique in a study, of letters, digits and '-'
  std::string title;     ///< for tables and figures, as in the paper
  std::string vertices;  ///< methods, see `meshorder methods`
  std::string elements;

  bool operator==(const OrderingSpec&) const = default;
};

/// One kernel on a mesh in one order.
struct KernelRecord {
  double predicted_ms = 0;  ///< for the model's machine: only ratios between orders matter
  double measured_ms = 0;   ///< best of interleaved rounds on one thread; 0: not measured
  Offset accesses = 0;      ///< to cache lines, in one run
  /// Simulated misses of a repeated run: entry [h][l] is for level l of MeshRecord::hierarchies[h].
  std::vector<std::vector<Offset>> misses;

  bool operator==(const KernelRecord&) const = default;
};

/// A mesh in one of a study's orders.
struct MeshOrderRecord {
  std::string ordering;
  std::string vertex_method;  ///< the method that `auto` chose, if `auto` was requested
  std::string element_method;
  double seconds = 0;  ///< cost of the order: the vertex graph, both orders, moving the mesh
  EdgeSpan span;
  std::vector<Offset>
      span_histogram;  ///< entry k: number of edges with spans k·w … (k + 1)·w − 1, w = MeshRecord::span_bin
  std::array<KernelRecord, kKernels.size()> kernels;

  bool operator==(const MeshOrderRecord&) const = default;
};

struct NamedCaches {
  std::string name;  ///< "this machine", "the paper's Xeon E5-1620 v4"
  Caches caches;

  bool operator==(const NamedCaches&) const = default;
};

/// Measurements and predictions on a mesh in the study's orders.
struct MeshRecord {
  std::string name;  ///< unique in a study: name of a model, a fluid, or a file without extension
  std::string file;  ///< relative to the study's folder
  Index vertices = 0;
  Offset tetrahedra = 0;
  Offset edges = 0;     ///< of the vertex graph
  Index span_bin = 50;  ///< bin width of span histograms, see `span_bin_width`
  std::vector<NamedCaches> hierarchies;
  std::vector<MeshOrderRecord> orders;  ///< the computed orders, in the sequence of StudyResults::orderings
  std::string verdict;                  ///< sentence on what reordering is worth; may be empty
  /// Speedup, as a factor, of the kernel that gains most in the order that the verdict names; 0 if nothing is
  /// gained or if the gain is in doubt.
  double gain = 0;

  bool operator==(const MeshRecord&) const = default;
};

/// One run of a scenario in one order. `step_seconds` does not include set-up.
struct RunRecord {
  std::string began;                 ///< "2026-11-20T17:30:00Z"
  std::vector<double> step_seconds;  ///< one for each step
  StepReport::Seconds seconds;       ///< sums over the steps
  Offset cg_iterations = 0;
  Offset admm_iterations = 0;
  Offset contact_iterations = 0;
  double setup_seconds = 0;
  Offset bytes = 0;                  ///< memory of the body
  double other_seconds = 0;          ///< processor seconds that other programs used during the steps
  std::vector<double> pace_seconds;  ///< of a fixed piece of arithmetic before each turn; grows by throttling
  std::vector<std::string> warnings;

  bool operator==(const RunRecord&) const = default;
};

/// Seconds of all steps of a scenario in one order, summarised over the runs.
struct TimeSummary {
  double mean = 0;
  double deviation = 0;    ///< standard deviation of the runs' sums, with divisor n − 1; 0 for one run
  double undisturbed = 0;  ///< sum, over the steps, of the step's fastest time in any run

  bool operator==(const TimeSummary&) const = default;
};

/// Savings of an order over the reference, from turns that were measured side by side.
struct Speedup {
  double saved_seconds = 0;              ///< the reference's mean minus this order's
  double percent = 0;                    ///< saved share of the reference's mean, as in the paper's Table 4
  double low = 0, high = 0;              ///< 95 % confidence interval of `percent`
  bool beyond_noise = false;             ///< the interval does not contain 0
  double undisturbed_percent = 0;        ///< like `percent`, from the undisturbed times
  std::optional<Index> break_even_step;  ///< first step after which the order's cost is saved; empty: never

  bool operator==(const Speedup&) const = default;
};

struct ScenarioOrderRecord {
  std::string ordering;
  std::vector<RunRecord> runs;
  TimeSummary time;
  Speedup speedup;  ///< all 0 for the reference
  MotionDifference motion;

  bool operator==(const ScenarioOrderRecord&) const = default;
};

struct ScenarioRecord {
  std::string name;
  std::string title;        ///< may be empty
  std::string method;       ///< "backward-euler", "admm" or "particle-fem"
  std::string material;     ///< "corotational", "springs"
  std::string precision;    ///< "double" or "single"; empty in results of earlier versions
  std::string mesh;         ///< MeshRecord::name
  std::string fingerprint;  ///< of the mesh, and of the parameters in the first order
  Index steps = 0;
  Index turn = 0;                  ///< steps that were timed in one order before the next order's turn
  bool interleaved = true;         ///< false: one order after another, since memory cannot hold all
  bool fixed_addresses = false;    ///< the processes had no address space randomisation
  std::vector<int> processors;     ///< that the threads were bound to; empty: not bound
  std::vector<Index> frame_steps;  ///< steps after which a frame was kept; the first is 0
  std::vector<ScenarioOrderRecord> orders;

  bool operator==(const ScenarioRecord&) const = default;
};

/// The results of a study, as results.json holds them (docs/results.schema.json).
struct StudyResults {
  std::string began;           ///< "2026-11-20T17:30:00Z"
  std::string size = "paper";  ///< "paper", "300k", "2m"
  int runs = 3;
  int threads = 1;
  std::string reference;  ///< name of the ordering that speedups refer to
  std::vector<OrderingSpec> orderings;
  MachineRecord machine;
  std::vector<MeshRecord> meshes;
  std::vector<ScenarioRecord> scenarios;

  bool operator==(const StudyResults&) const = default;
};

/// Returns the record of that name in a list; nullptr if there is none.
template <class Records>
auto find_named(Records& records, std::string_view name) -> decltype(records.data()) {
  for (auto& record : records) {
    if (record.name == name) return &record;
  }
  return nullptr;
}

/// Returns the entry for an order in a mesh's or scenario's record; nullptr if there is no such entry, or if
/// the entry has no runs.
template <class Record>
auto find_order(const Record& record, std::string_view ordering) -> decltype(record.orders.data()) {
  for (auto& order : record.orders) {
    if (order.ordering != ordering) continue;
    if constexpr (requires { order.runs; }) {
      if (order.runs.empty()) return nullptr;
    }
    return &order;
  }
  return nullptr;
}

}  // namespace meshorder
