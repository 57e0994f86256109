// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

/// @file
/// What reordering a mesh is worth, before it is done. Experimental: may change in any version below 1.0.

#include <meshorder/export.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/options.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>
#include <meshorder/view.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// The hot loops of simulators that are predicted and measured.
enum class Kernel : std::uint8_t {
  spmv,      ///< product of a sparse matrix, which has an entry for each edge, with a vector
  element,   ///< forces of the elements
  assembly,  ///< assembly of the matrix
  springs,   ///< forces of springs along the edges
};

/// How these loops are written. What an order is worth depends on it.
enum class KernelSet : std::uint8_t {
  /// As most programs have them: one loop, no prefetching, no blocking. One unknown a vertex in the matrix,
  /// linear elements, edges by their smaller end.
  plain,
  /// As the simulators of this project have them: elastic elements, with 3×3 blocks in the matrix. The loops
  /// prefetch, and take eight elements or edges at a time. Their times are about equal in all good orders.
  tuned,
};

/// All values of `Kernel`. Arrays by kernel have this order.
inline constexpr std::array kKernels{Kernel::spmv, Kernel::element, Kernel::assembly, Kernel::springs};

/// Returns "spmv", "element", "assembly" or "springs". Valid for the life of the program.
MESHORDER_API std::string_view to_string(Kernel kernel);

/// Returns "plain" or "tuned"; the one of that name. The latter throws InvalidArgument for other names.
MESHORDER_API std::string_view to_string(KernelSet kernels);
MESHORDER_API KernelSet parse_kernels(std::string_view name);

/// Milliseconds of one run of each kernel, when it is repeated.
using KernelMilliseconds = std::array<double, kKernels.size()>;

/// Times of the kernels in one order.
struct OrderCosts {
  /// By reuse distances and a cost model (docs/prediction.md). Compare them with each other only: they are
  /// those of `Advice::machine`.
  std::optional<KernelMilliseconds> predicted = {};
  std::optional<KernelMilliseconds> measured = {};  ///< the best of interleaved rounds

  /// Returns the measured times, else the predicted ones; one of them must be set.
  [[nodiscard]] const KernelMilliseconds& best_known() const { return measured ? *measured : *predicted; }
};

/// Tiles along each side of `Candidate::pattern`; one for each vertex where there are fewer.
inline constexpr int kPatternSide = 64;

/// An order of the mesh, and what the kernels take in it.
struct Candidate {
  MethodChoice vertices = {};
  MethodChoice elements = {};
  Workload workload = Workload::all;  ///< what `auto` chose the methods for
  Quality spans = {};                 ///< of the vertex graph in this order
  SparsityPattern pattern = {};       ///< likewise, `kPatternSide` tiles along each side
  OrderCosts costs = {};
  double order_seconds = 0;  ///< cost of the order: graph, both methods, moving the mesh; 0 for "original"
};

/// The best candidate for one kernel.
struct KernelAdvice {
  std::size_t candidate = 0;  ///< place in `Advice::candidates` of the one in which the kernel is fastest
  double factor = 1;       ///< time as the mesh is / time in that candidate; 1 where there is nothing to gain
  double runs_to_pay = 0;  ///< runs that save as much time as the order cost; 0 where nothing is gained
};

/// What reordering a mesh would be worth.
struct Advice {
  Candidate as_is = {};                    ///< the order that the mesh has
  std::vector<Candidate> candidates = {};  ///< the first is what `reorder` does without options
  std::array<KernelAdvice, kKernels.size()> kernels = {};
  /// Why the measured times cannot be trusted, a sentence: the machine was busy or throttled. Empty if they
  /// can be trusted, or if nothing was measured.
  std::string doubt = {};
  /// What the predicted times are those of: "this machine, calibrated 2026-11-22", a machine's name, or "this
  /// machine's caches at the costs of zen3"; empty where nothing was predicted.
  std::string machine = {};
  /// For each kernel, the share by which two timings of the same problem differ on that machine. A smaller
  /// difference does not count. 0 if it is not known.
  std::array<double, kKernels.size()> floor = {};
  int threads = 1;                          ///< that shared each run
  KernelSet kernel_set = KernelSet::plain;  ///< whose times these are
  /// Whether the mesh is a matrix or graph as its file has it: then spmv is the product with its own entries,
  /// the times of the other kernels are 0, and one product counts in place of a time step.
  bool is_matrix = false;
};

/// Returns the verdict in one English sentence: which kernel loses most in the present order, which order
/// makes it faster, and after how many runs that order has saved its own cost; or that there is nothing to
/// gain.
[[nodiscard]] MESHORDER_API std::string to_string(const Advice& advice);

/// Options of `advise` and `compare`.
struct PayoffOptions {
  /// The candidates; empty: what `auto` takes for all kernels, and for springs where that differs.
  std::vector<MeshMethods> methods = {};
  bool predict = true;  ///< gives the same times on every run
  /// What to predict for: a machine whose costs ship with the library ("zen3"), or "this": the stored
  /// calibration of this machine or, if there is none, its caches with the costs of "zen3". Empty: the value
  /// of the environment variable MESHORDER_MACHINE, or "this" if it is not set.
  std::string machine = {};
  bool measure = false;                  ///< runs the kernels here
  KernelSet kernels = KernelSet::plain;  ///< predictions are of the plain ones alone
  /// Judge the kernels on all threads, which share each run, not on one thread. Prediction then needs a
  /// calibration of this machine on the same number of threads; the shipped costs are for one thread.
  bool all_threads = false;
  /// Seconds after the call, ≥ 0: a round of measurements begins only if it would end before this, but at
  /// least two rounds are run.
  double budget_seconds = 10;
  OrderOptions order = {};  ///< `groups` has n entries or none, `cell_groups` m or none
};

/// Returns what other orders of a mesh gain. The mesh is not changed.
///
/// @param mesh     n vertices with points, m cells with types, at least one of them a line, surface or volume
/// @param options  see `PayoffOptions`
/// @return the kernels' times as the mesh is and in every candidate, and the best candidate for each kernel.
///         Times that differ by less than 5 % (measured), 10 % (predicted) or 25 % (predicted products), or
///         less than `Advice::floor`, count as equal
/// @throws as `order_mesh`, and InvalidArgument for a mesh without such cells, for unknown types and
///         machines; if neither `predict` nor `measure` is true; for `predict` with tuned kernels; and for
///         `predict` with `all_threads` if those costs are not known
/// @note Time: that of the orders; to predict, about a second for each candidate and million tetrahedra; to
///       measure, the budget. Each candidate holds a copy of points, cells and graph, about 0.8 KB a vertex
///       of a tetrahedral mesh, and while it is measured 2.5 KB a vertex more. Stages of progress: those of
///       `order_mesh`, "predict" and "measure".
[[nodiscard]] MESHORDER_API Advice advise(const MeshView& mesh, const PayoffOptions& options = {});

/// Returns what other orders of a square matrix's rows and columns gain for its product with a vector, which
/// is the only kernel (see `Advice::is_matrix`). The pattern need not be symmetric. Methods that need points
/// are not for a matrix. Exceptions and cost as of a mesh; InvalidArgument for a matrix without entries off
/// the diagonal and for tuned kernels; TooLarge for more than 2,147,483,647 entries.
[[nodiscard]] MESHORDER_API Advice advise(const GraphView& matrix, const PayoffOptions& options = {});

/// The same of a mesh as its reader made it, which is a matrix if its file holds one.
[[nodiscard]] MESHORDER_API Advice advise(const Mesh& mesh, const PayoffOptions& options = {});

/// Compares orders of a mesh or matrix: the one that it has, then `options.methods`. Parameters, exceptions
/// and cost as of `advise`.
[[nodiscard]] MESHORDER_API std::vector<Candidate> compare(const MeshView& mesh,
                                                           const PayoffOptions& options = {});
[[nodiscard]] MESHORDER_API std::vector<Candidate> compare(const GraphView& matrix,
                                                           const PayoffOptions& options = {});
[[nodiscard]] MESHORDER_API std::vector<Candidate> compare(const Mesh& mesh,
                                                           const PayoffOptions& options = {});

/// How `calibrate` measures.
struct CalibrationOptions {
  /// > 0: a measurement begins only if it would end before this, but each is made at least once.
  double seconds = 16;
  bool keep = true;  ///< store it, so that `advise` predicts for this machine from now on
  Run run = {};
};

/// What `calibrate` found.
struct CalibrationReport {
  std::string machine = {};  ///< what `Advice::machine` calls it
  std::string json = {};     ///< all that was measured, see docs/json.md
  std::string file = {};     ///< where it is stored; empty if it is not kept
  /// Why the calibration cannot be trusted, a sentence: the machine was busy or throttled. Empty if it can be
  /// trusted.
  std::string doubt = {};
};

/// Measures this machine: what a thread gets of the caches, latencies, bandwidths, and what misses cost each
/// kernel on one thread and on all, on lattices made for that. Stored in the user's cache folder
/// ($MESHORDER_CACHE, else $XDG_CACHE_HOME/meshorder, else ~/.cache/meshorder) for this processor and this
/// build of the library.
///
/// @param options  see `CalibrationOptions`
/// @throws InvalidArgument for a time that is not above 0; Error with Code::io if it cannot be stored;
/// Stopped
/// @note Runs for `options.seconds`, or longer on a slow machine, in about 1 GB of memory. Other work on the
/// machine makes the result wrong. Stages of progress: "caches", "bandwidths", "lattices".
MESHORDER_API CalibrationReport calibrate(const CalibrationOptions& options = {});

}  // namespace v0_3
}  // namespace meshorder
