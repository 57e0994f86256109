// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Predicts and measures the gain of reordering a mesh. Experimental: may change in any version below 1.0.

#include <meshorder/export.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/options.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>
#include <meshorder/view.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// The hot loops of simulators; their times are predicted and measured.
enum class Kernel : std::uint8_t {
  spmv,      ///< product of a sparse matrix, which has an entry for each edge, with a vector
  element,   ///< forces of the elements
  assembly,  ///< assembly of the matrix
  springs,   ///< forces of springs along the edges
};

/// How the kernels are written. The gain of an order depends on this.
enum class KernelSet : std::uint8_t {
  /// As in most programs: one loop, no prefetching, no blocking. The matrix has one unknown for each vertex,
  /// elements are linear, and edges are sorted by their smaller end.
  plain,
  /// As in the simulators of this project: elastic elements, 3×3 blocks in the matrix. The loops prefetch and
  /// handle eight elements or edges at a time. Their times are about equal in all good orders.
  tuned,
};

/// All values of `Kernel`. Arrays by kernel have this order.
inline constexpr std::array kKernels{Kernel::spmv, Kernel::element, Kernel::assembly, Kernel::springs};

/// Returns "spmv", "element", "assembly" or "springs". Valid for the life of the program.
MESHORDER_API std::string_view to_string(Kernel kernel);

/// Converts a kernel set to its name, "plain" or "tuned", and back. `parse_kernels` throws InvalidArgument
/// for other names.
MESHORDER_API std::string_view to_string(KernelSet kernels);
MESHORDER_API KernelSet parse_kernels(std::string_view name);

/// Milliseconds of one run of each kernel, in a series of runs.
using KernelMilliseconds = std::array<double, kKernels.size()>;

/// A time in the present order divided by the time in another, with the interval that holds the true ratio in
/// 95 of 100 measurements. Predicted ratios have the error of predictions instead.
struct TimeRatio {
  double ratio = 1;
  double low = 0;
  double high = std::numeric_limits<double>::infinity();
};

/// Largest `high / low` of a ratio that is stated.
inline constexpr double kWidestStated = 1.6;

/// Returns whether a ratio may be stated: the interval is narrow and does not hold 1. Otherwise the two times
/// are "not told apart". Commands, sentences, tables and pages all state ratios by this rule.
[[nodiscard]] constexpr bool is_told_apart(const TimeRatio& ratio) {
  return (ratio.low > 1 || ratio.high < 1) && ratio.high <= kWidestStated * ratio.low;
}

/// Times of the kernels in one order.
struct OrderCosts {
  /// From reuse distances and a cost model (docs/prediction.md). Compare predicted times only with each
  /// other: they are times on `Advice::machine`.
  std::optional<KernelMilliseconds> predicted = {};
  std::optional<KernelMilliseconds> measured = {};  ///< the best of interleaved rounds
  /// Set with `measured`: how many times faster each kernel ran than in the present order, round by round.
  std::optional<std::array<TimeRatio, kKernels.size()>> gains = {};
};

/// Tiles along each side of `Candidate::pattern`; fewer if there are fewer vertices.
inline constexpr int kPatternSide = 64;

/// An order of the mesh, and the times of the kernels in that order.
struct Candidate {
  MethodChoice vertices = {};
  MethodChoice elements = {};
  Workload workload = Workload::all;  ///< what `auto` optimised
  Quality spans = {};                 ///< spans of the vertex graph's edges in this order
  SparsityPattern pattern = {};       ///< the graph's pattern, `kPatternSide` tiles along each side
  OrderCosts costs = {};
  double order_seconds = 0;  ///< cost of the order: graph, both methods, moving the mesh; 0 for "original"
};

/// The best candidate for one kernel.
struct KernelAdvice {
  std::size_t candidate = 0;  ///< index in `Advice::candidates` of the kernel's fastest candidate
  /// Present time / time in that candidate's order; {1, 1, 1} if no candidate is told apart as faster.
  TimeRatio gain = {1, 1, 1};
  double runs_to_pay = 0;  ///< runs after which the saved time equals `order_seconds`; 0 if nothing is gained
};

/// The gain that reordering a mesh would bring.
struct Advice {
  Candidate as_is = {};                    ///< the order that the mesh has
  std::vector<Candidate> candidates = {};  ///< as `PayoffOptions::methods` lists them
  std::array<KernelAdvice, kKernels.size()> kernels = {};
  /// Why not to trust the measured times: "this machine is too busy to time kernels: 75 % used by others".
  /// Then the advice rests on predictions or, without them, names no gain. Empty if the times are reliable,
  /// or if nothing was measured.
  std::string doubt = {};
  /// The machine of the predicted times: "this machine, calibrated 2026-11-22", a machine's name, or
  /// "this machine's caches at the costs of zen3"; empty if nothing was predicted.
  std::string machine = {};
  /// For each kernel, the share by which two timings of the same problem differ on `machine`. Smaller
  /// differences do not count. 0 if unknown.
  std::array<double, kKernels.size()> floor = {};
  int threads = 1;                          ///< threads that shared each run
  KernelSet kernel_set = KernelSet::plain;  ///< the kernels that were timed
  /// Whether the input is a matrix or graph, or a mesh whose file holds one. Then spmv is the product with
  /// that matrix, the times of the other kernels are 0, and one product counts in place of a time step.
  bool is_matrix = false;
};

/// Returns the verdict in one English sentence: which kernel loses most in the present order, which order
/// makes it faster, and after how many runs of the kernel that order has saved its own cost; or that nothing
/// is gained, or that the gain is not known.
[[nodiscard]] MESHORDER_API std::string to_string(const Advice& advice);

/// Options of `advise` and `compare`.
struct PayoffOptions {
  /// The candidates; empty: the choice of `auto` for all kernels and, if it differs, the choice of `auto` for
  /// springs.
  std::vector<MeshMethods> methods = {};
  bool predict = true;  ///< predict times; every run gives the same
  /// The machine to predict for: one whose costs are part of the library ("zen3"), or "this": the stored
  /// calibration of this machine or, if there is none, this machine's caches with the costs of "zen3". Empty:
  /// the value of the environment variable MESHORDER_MACHINE, or "this" if that is not set.
  std::string machine = {};
  bool measure = false;                  ///< time the kernels on this machine
  KernelSet kernels = KernelSet::plain;  ///< only plain kernels can be predicted
  /// Time the kernels on all threads, which share each run, instead of one thread. Prediction then needs a
  /// calibration of this machine on the same number of threads; the shipped costs are for one thread.
  bool all_threads = false;
  /// Seconds for measurements, ≥ 0, from the start of the call: a round begins only if it would end in time,
  /// but at least two rounds are run.
  double budget_seconds = 10;
  OrderOptions order = {};  ///< `groups` has n entries or none, `cell_groups` m or none
};

/// Returns the gain of other orders of a mesh. The mesh is not changed.
///
/// @param mesh     n vertices with points, m cells with types, at least one of them a line, surface or volume
/// @param options  see `PayoffOptions`
/// @return the kernels' times in the present order and in every candidate, and the best candidate for each
///         kernel, if it is told apart (`is_told_apart`)
/// @throws as `order_mesh`; InvalidArgument also for a mesh without such cells, unknown types and machines, a
///         negative budget, `Workload::gpu`, neither `predict` nor `measure`, `predict` with tuned kernels,
///         and `predict` with `all_threads` if the machine's costs on that number of threads are not known
/// @note Time: that of the orders; to predict, about a second for each candidate and million tetrahedra; to
///       measure, the budget. Each candidate holds a copy of points, cells and graph, about 0.8 KB a vertex
///       of a tetrahedral mesh, and 2.5 KB a vertex more while it is measured. Stages of progress: those of
///       `order_mesh`, "predict" and "measure".
[[nodiscard]] MESHORDER_API Advice advise(const MeshView& mesh, const PayoffOptions& options = {});

/// Returns the gain of reordering a square matrix, rows and columns alike, for the only kernel: its product
/// with a vector (see `Advice::is_matrix`). The pattern need not be symmetric. Methods that need points
/// cannot order a matrix. Exceptions and cost as for a mesh; InvalidArgument for a matrix without entries off
/// the diagonal and for tuned kernels; TooLarge for more than 2,147,483,647 entries.
[[nodiscard]] MESHORDER_API Advice advise(const GraphView& matrix, const PayoffOptions& options = {});

/// The same for a mesh from a reader; a mesh whose file holds a matrix or graph is treated as that matrix.
[[nodiscard]] MESHORDER_API Advice advise(const Mesh& mesh, const PayoffOptions& options = {});

/// Returns the present order of a mesh or matrix, then the candidates of `advise`. Parameters, exceptions and
/// cost are those of `advise`.
[[nodiscard]] MESHORDER_API std::vector<Candidate> compare(const MeshView& mesh,
                                                           const PayoffOptions& options = {});
[[nodiscard]] MESHORDER_API std::vector<Candidate> compare(const GraphView& matrix,
                                                           const PayoffOptions& options = {});
[[nodiscard]] MESHORDER_API std::vector<Candidate> compare(const Mesh& mesh,
                                                           const PayoffOptions& options = {});

/// Options of `calibrate`.
struct CalibrationOptions {
  /// Time limit, > 0: a measurement begins only if it would end in time, but each measurement is made at
  /// least once.
  double seconds = 16;
  bool keep = true;  ///< store the calibration, so that `advise` uses it from now on
  Run run = {};
};

/// Result of `calibrate`.
struct CalibrationReport {
  std::string machine = {};  ///< the value of `Advice::machine` for this calibration
  std::string json = {};     ///< all that was measured, see docs/json.md
  std::string file = {};     ///< the file that stores the calibration; empty if it is not kept
  /// A sentence: why not to trust the calibration (the machine was busy or throttled). Empty if it is
  /// reliable.
  std::string doubt = {};
};

/// Measures this machine on test lattices: a thread's share of the caches, latencies, bandwidths, and the
/// cost of misses to each kernel, on one thread and on all. The result is stored in the user's cache folder
/// ($MESHORDER_CACHE, else $XDG_CACHE_HOME/meshorder, else ~/.cache/meshorder) for this processor and this
/// build of the library.
///
/// @param options  see `CalibrationOptions`
/// @throws InvalidArgument for a time that is not above 0; Error with Code::io if the result cannot be
///                         stored; Stopped
/// @note Runs for `options.seconds`, or longer on a slow machine, in about 1 GB of memory. Other work on the
/// machine makes the result wrong. Stages of progress: "caches", "bandwidths", "lattices".
MESHORDER_API CalibrationReport calibrate(const CalibrationOptions& options = {});

}  // namespace v0_3
}  // namespace meshorder
