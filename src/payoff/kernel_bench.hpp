// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "kernels/assembly.hpp"
#include "kernels/springs.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/payoff.hpp>

#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

template <>
struct EnumNames<Kernel> {
  static constexpr std::string_view kind = "kernel";
  static constexpr std::array names{std::pair{Kernel::spmv, "spmv"}, std::pair{Kernel::element, "element"},
                                    std::pair{Kernel::assembly, "assembly"},
                                    std::pair{Kernel::springs, "springs"}};
};

/// What tables and figures call the kernels, as kKernels lists them.
inline constexpr std::array<std::string_view, kKernels.size()> kKernelTitles{"SpMV", "element force",
                                                                             "assembly", "springs"};

/// A mesh in one order, prepared to run its kernels repeatedly: the stiffness matrix on the vertex graph, the
/// elements cut into simplices, a spring on every edge, and vertices displaced by a smooth function of their
/// rest position. All orders of a mesh therefore compute the same physics, and no force, strain or matrix
/// entry is trivial.
class KernelBench {
 public:
  /// `graph` is the mesh's vertex graph. Several `threads` share the work by ranges of vertices (see
  /// owned_batches), with the same results, bit for bit. O(size of the mesh · log degree). Throws
  /// InvalidArgument if the graph is of another mesh.
  KernelBench(const Mesh& mesh, const CsrGraph& graph, int threads = 1);
  explicit KernelBench(const Mesh& mesh, int threads = 1);

  /// Shares the work of all runs from now on among so many threads, ≥ 2, in place of one.
  void share(int threads);

  /// Runs a kernel once; clears its results first.
  void run(Kernel kernel);

  /// Returns the result of the kernel's last run: 3 doubles a vertex for spmv, 4 for forces (see
  /// padded_positions), 9 a block for assembly. Elements and springs share the array of forces.
  [[nodiscard]] std::span<const double> result(Kernel kernel) const;

  [[nodiscard]] const BlockCsr& matrix() const noexcept { return matrix_; }

  /// Returns the bytes that one run moves if every array passes through the processor once. Divided by the
  /// memory's bandwidth, this is a lower bound on the time for a mesh much larger than the caches.
  [[nodiscard]] double streamed_bytes(Kernel kernel) const;

  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

  /// Returns the share of elements that are computed in addition, because threads overlap: 0 on one thread,
  /// 0.02 if every fiftieth batch is computed twice.
  [[nodiscard]] double redundancy() const;

 private:
  /// The work of one thread.
  struct Share {
    OwnedBatches elements;
    OwnedBlocks blocks;
    OwnedBatches springs;
  };

  void run_shared(Kernel kernel);

  BlockCsr matrix_;
  RestShapes rest_;
  AssemblyMap map_;
  Springs springs_;
  AlignedVector<double> positions_;
  AlignedVector<double> forces_;
  AlignedVector<double> x_;
  AlignedVector<double> y_;
  std::vector<Share> shares_;  ///< empty for one thread
};

}  // namespace meshorder
