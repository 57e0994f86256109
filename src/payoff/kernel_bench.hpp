// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "kernels/assembly.hpp"
#include "kernels/springs.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

/// The simulators' hot loops: the product of the stiffness matrix with a vector, the forces of elastic
/// elements, the assembly of the stiffness matrix, and the forces of springs along the edges.
enum class Kernel : std::uint8_t { spmv, element, assembly, springs };

inline constexpr std::array kKernels{Kernel::spmv, Kernel::element, Kernel::assembly, Kernel::springs};

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

/// A mesh in one order, prepared for its kernels to run again and again: the stiffness matrix on the vertex
/// graph, the elements cut into simplices, a spring on every edge, and vertices off their rest positions by a
/// smooth deformation that depends on where a vertex rests and on nothing else. Two orders of a mesh
/// therefore compute the same physics, and no force, strain or matrix entry is trivial.
class KernelBench {
 public:
  /// `graph` is the mesh's vertex graph. O(size of the mesh · log degree). Throws InvalidArgument when the
  /// graph belongs to another mesh. With several `threads` the kernels share their work among so many by
  /// ranges of vertices (see owned_batches): the same results, bit for bit.
  KernelBench(const Mesh& mesh, const CsrGraph& graph, int threads = 1);
  explicit KernelBench(const Mesh& mesh, int threads = 1);

  /// Runs a kernel once, from cleared to complete results.
  void run(Kernel kernel);

  /// What the last run of that kernel computed: 3 doubles a vertex for spmv, 4 for forces (see
  /// padded_positions), 9 a block for assembly. The forces of elements and springs share their place.
  [[nodiscard]] std::span<const double> result(Kernel kernel) const;

  [[nodiscard]] const BlockCsr& matrix() const noexcept { return matrix_; }

  /// The bytes that one run moves when every array passes through the processor once: divided by the memory's
  /// bandwidth, the least time of a mesh much larger than the caches.
  [[nodiscard]] double streamed_bytes(Kernel kernel) const;

  /// Memory held.
  [[nodiscard]] std::size_t bytes() const;

  /// By how much the threads together compute more elements than there are: 0 on one thread, 0.02 where every
  /// fiftieth batch is computed twice.
  [[nodiscard]] double redundancy() const;

 private:
  /// What one thread does.
  struct Share {
    OwnedBatches elements;
    OwnedBlocks blocks;
    OwnedBatches springs;
  };

  void share_out(int threads);
  void run_shared(Kernel kernel);

  BlockCsr matrix_;
  RestShapes rest_;
  AssemblyMap map_;
  Springs springs_;
  AlignedVector<double> positions_;
  AlignedVector<double> forces_;
  AlignedVector<double> x_;
  AlignedVector<double> y_;
  std::vector<Share> shares_;  ///< none on one thread
};

}  // namespace meshorder
