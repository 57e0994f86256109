// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>
#include <meshorder/number_view.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>

namespace meshorder {
inline namespace v0_3 {

/// What to optimise. `auto` chooses its method by this; methods requested by name ignore it.
enum class Workload : std::uint8_t {
  all,        ///< the next four kernels, weighted equally
  element,    ///< element forces: gather from and scatter to the vertices of each element
  spmv,       ///< products of the stiffness matrix with a vector, as iterative solvers repeat them
  assembly,   ///< assembly of the stiffness matrix
  springs,    ///< a force along every edge
  bandwidth,  ///< the bandwidth of the matrix, for banded and skyline solvers
  fill,       ///< few non-zeros in the factors of the matrix, for sparse direct solvers
  gpu,        ///< graphics processors: products, one thread per row; atomic additions, one thread per cell
};

/// All values of `Workload`.
inline constexpr std::array kWorkloads{Workload::all,      Workload::element, Workload::spmv,
                                       Workload::assembly, Workload::springs, Workload::bandwidth,
                                       Workload::fill,     Workload::gpu};

/// Returns "all", "element", "spmv", "assembly", "springs", "bandwidth", "fill" or "gpu". Valid for the life
/// of the program.
MESHORDER_API std::string_view to_string(Workload workload);

/// Returns the workload of that name.
///
/// @throws InvalidArgument for another name; the message lists the known ones
MESHORDER_API Workload parse_workload(std::string_view name);

/// How much of the input is checked before work begins. At every level but `none`, offsets and numbers out of
/// range throw InvalidArgument.
enum class Check : std::uint8_t {
  /// Everything: sizes; ascending offsets; numbers in range; weights positive and finite; coordinates finite;
  /// pattern and weights symmetric. Symmetry is tested by a 64-bit hash sum over the entries, which misses a
  /// random fault with probability 2⁻⁶⁴.
  full,
  /// As `full`, except that an asymmetric graph is accepted and gets an unspecified, valid order.
  fast,
  /// Nothing. The graph must be what `full` accepts, with ascending rows, no loops and no repeats; anything
  /// else is undefined behaviour.
  none,
};

/// What to do with an asymmetric pattern.
enum class Symmetry : std::uint8_t {
  require,  ///< refuse the pattern with InvalidArgument if `Check` tests symmetry
  mirror,   ///< order A + Aᵀ, with the weights of (A + Aᵀ) / 2
};

/// State of a running call.
struct Progress {
  /// The present stage: "check", "graph", "coarsen", "eigenvector", "improve", "sort", "move", or "metis".
  /// While METIS runs, no callback comes and the call cannot be stopped. These words do not change; new ones
  /// may be added. Valid during the callback.
  std::string_view stage;
  double fraction = -1;  ///< share of the whole call that is done, 0 … 1, never decreasing; −1 if unknown
  double seconds = 0;    ///< time since the call began
};

/// How a call runs. Only `time_limit` can change a result; the other members leave every bit the same.
struct Run {
  /// Largest number of threads, ≥ 0; 0: as many as the caller's TBB arena has. The call runs in an arena of
  /// its own; with 1, no thread is started. A limit set by tbb::global_control holds as well.
  int threads = 0;

  /// Called now and then on the calling thread, never twice at once and with no lock held.
  /// If it returns false, the call ends with `Stopped`; if it throws, the exception passes through.
  std::function<bool(const Progress&)> progress = {};

  /// Seconds after which iterative methods return the best result so far, with `complete` = false. Methods
  /// that do not iterate ignore the limit.
  double time_limit = std::numeric_limits<double>::infinity();
};

/// Options of orders and of the Fiedler vector. All have defaults: name those that differ,
/// `{.seed = 7, .run = {.threads = 4}}`.
struct OrderOptions {
  std::uint64_t seed = 0;  ///< seed of `scrambled`, of METIS and of start vectors
  /// Tolerance of Fiedler vectors, > 0: ‖L x − λ x‖ ≤ tolerance · λ₂ ‖x‖. 0.1 suffices for orders.
  double tolerance = 0.1;
  int max_iterations = 500;           ///< limit for the eigensolver on the whole graph, ≥ 1
  Workload workload = Workload::all;  ///< what `auto` optimises
  RealView start = {};  ///< an estimate of the Fiedler vector: n numbers, such as `Order::vector`; or none
  IndexView groups =
      {};  ///< group (any integer) of each vertex; empty: no groups. Groups stay together, ascending
  IndexView cell_groups = {};  ///< group of each cell, or none; kept together within each block and dimension
  Check check = Check::full;
  Symmetry symmetry = Symmetry::require;
  Run run = {};
};

}  // namespace v0_3
}  // namespace meshorder
