// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

/// @file
/// What reordering a mesh is worth, before it is done. Experimental: may change in any version below 1.0.

#include <meshorder/export.hpp>
#include <meshorder/options.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>
#include <meshorder/view.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {
inline namespace v0_2 {

/// The hot loops of simulators that are predicted and measured.
enum class Kernel : std::uint8_t {
  spmv,      ///< product of the stiffness matrix (3×3 blocks) with a vector
  element,   ///< elastic forces of the elements
  assembly,  ///< assembly of the stiffness matrix
  springs,   ///< forces of springs on the edges
};

/// All values of `Kernel`. Arrays by kernel have this order.
inline constexpr std::array kKernels{Kernel::spmv, Kernel::element, Kernel::assembly, Kernel::springs};

/// Returns "spmv", "element", "assembly" or "springs". Valid for the life of the program.
MESHORDER_API std::string_view to_string(Kernel kernel);

/// Milliseconds of one run of each kernel, when it is repeated; NaN where unknown.
using KernelMilliseconds = std::array<double, kKernels.size()>;

/// An order that the mesh could be given, and what the kernels take in it.
struct Candidate {
  MeshMethods methods = {};           ///< never "auto"
  Workload workload = Workload::all;  ///< what `auto` took these methods for, if it did
  Quality spans = {};                 ///< of the vertex graph in this order
  KernelMilliseconds milliseconds{};  ///< best of interleaved rounds where `measured`, else predicted
  bool measured = false;
  double order_seconds = 0;  ///< cost of the order: graph, both methods, moving the mesh; 0 for "original"
};

/// What the best candidate is worth for one kernel.
struct KernelAdvice {
  std::size_t candidate = 0;  ///< the one in which it runs fastest
  double factor = 1;  ///< time as the mesh is / time in that candidate; 1 where there is nothing to gain
  double runs_to_pay =
      0;  ///< runs after which the order has paid for itself; 0 where there is nothing to gain
};

/// What reordering a mesh would be worth.
struct Advice {
  Candidate as_is = {};                    ///< the order that the mesh has
  std::vector<Candidate> candidates = {};  ///< the first is what `reorder` with default methods does
  std::array<KernelAdvice, kKernels.size()> kernels{};
};

/// Returns the verdict in a few lines of English, as `meshorder info` prints it.
[[nodiscard]] MESHORDER_API std::string to_string(const Advice& advice);

/// Options of `advise` and `compare`.
struct PayoffOptions {
  std::vector<MeshMethods> methods = {};  ///< candidates; empty: those that `auto` takes
  bool predict = true;   ///< by reuse distances and a cost model (docs/prediction.md); the same on every run
  bool measure = false;  ///< by running the kernels here, on one thread
  double budget_seconds =
      10;  ///< no round of measurements begins that would end later; two are run at least; > 0
  OrderOptions order = {};
};

/// Tells what the orders that `auto` takes, or those asked for, are worth. The mesh is not changed.
///
/// @param mesh     n vertices with points, cells of types that have a kernel
/// @param options  see `PayoffOptions`
/// @return costs as the mesh is and in every candidate, and the verdict for each kernel. Differences below 5
/// % of
///         measured, 10 % of predicted times and 25 % of predicted products are no gain
/// @throws as `order_mesh`, and InvalidArgument where neither prediction nor measurement is asked for
/// @note About the time of `order_mesh` for each candidate, and the budget. Measuring holds two copies of
/// mesh and
///       matrix, about 3 KB a vertex of a tetrahedral mesh. Predictions do not depend on the machine's load.
[[nodiscard]] MESHORDER_API Advice advise(const MeshView& mesh, const PayoffOptions& options = {});

/// Compares orders of a mesh, "original" first. Parameters, exceptions and cost as of `advise`.
[[nodiscard]] MESHORDER_API std::vector<Candidate> compare(const MeshView& mesh,
                                                           const PayoffOptions& options = {});

}  // namespace v0_2
}  // namespace meshorder
