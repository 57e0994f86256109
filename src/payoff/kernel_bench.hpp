// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "base/text.hpp"
#include "payoff/kernel_input.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/payoff.hpp>

#include <array>
#include <cstddef>
#include <memory>
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

template <>
struct EnumNames<KernelSet> {
  static constexpr std::string_view kind = "kernels";
  static constexpr std::array names{std::pair{KernelSet::plain, "plain"},
                                    std::pair{KernelSet::tuned, "tuned"}};
};

/// The kernels' names in tables and figures, in the order of kKernels.
inline constexpr std::array<std::string_view, kKernels.size()> kKernelTitles{"SpMV", "element force",
                                                                             "assembly", "springs"};

/// The kernels that a matrix has.
inline constexpr std::array kProductsAlone{Kernel::spmv};

/// Returns the kernels that a mesh has, a prefix of kKernels: all of them, or only the product for a matrix
/// or graph (see StoredMatrix). Arrays by kernel have 0 for the other kernels.
std::span<const Kernel> kernels_of(const Mesh& mesh);

/// A mesh in one order, prepared to run its kernels repeatedly: a matrix on the vertex graph, the elements
/// cut into simplices, a spring on every edge, and vertices displaced by a smooth function of their rest
/// position. All orders of a mesh therefore compute the same physics, and no force, strain or matrix entry
/// is trivial.
class KernelBench {
 public:
  virtual ~KernelBench() = default;

  /// Returns a copy, in memory of its own.
  [[nodiscard]] virtual std::unique_ptr<KernelBench> copy() const = 0;
  /// Becomes a copy of a bench of the same type. Arrays stay where they are if they are large enough.
  virtual void take(const KernelBench& other) = 0;

  /// Returns the kernels that it runs, a prefix of kKernels.
  [[nodiscard]] virtual std::span<const Kernel> kernels() const { return kKernels; }

  /// Shares the work of all later runs among `threads` ≥ 1 threads, by ranges of vertices. Each thread
  /// computes the elements and springs that touch its range, and adds only to vertices of its range. The
  /// results have the same bits as on one thread.
  virtual void share(int threads) = 0;

  /// Runs a kernel once; clears its results first. A product multiplies with the matrix of the last assembly;
  /// if there was none, it assembles first.
  void run(Kernel kernel);

  /// Runs a part of a kernel from which the time of a whole run follows: it computes stretches of elements,
  /// spread evenly over the mesh, and clears the same share of the results. Returns the share of the elements
  /// that ran; 0, without a run, if the kernel has no elements or a part would not represent the mesh. The
  /// results are incomplete; a product with such a matrix takes the usual time.
  double run_stretches(Kernel kernel);

  /// Returns the result of the kernel's last run, row by row: for spmv a product for each vertex, for
  /// assembly the values of the matrix, for elements and springs a force for each vertex. Elements and
  /// springs share one array.
  [[nodiscard]] virtual std::span<const double> result(Kernel kernel) const = 0;

  /// Returns the bytes that one run moves if every array passes through the processor once. Divided by the
  /// memory's bandwidth, this is a lower bound on the time for a mesh much larger than the caches.
  [[nodiscard]] virtual double streamed_bytes(Kernel kernel) const = 0;

  /// Returns the memory held, in bytes.
  [[nodiscard]] virtual std::size_t bytes() const = 0;

  /// Returns the number of repeated computations of elements divided by the number of elements: 0 on one
  /// thread, 0.02 if two threads compute every fiftieth element.
  [[nodiscard]] virtual double redundancy() const = 0;

 protected:
  KernelBench() = default;
  KernelBench(const KernelBench&) = default;
  KernelBench(KernelBench&&) = default;
  KernelBench& operator=(const KernelBench&) = default;
  KernelBench& operator=(KernelBench&&) = default;

 private:
  virtual void compute(Kernel kernel) = 0;
  virtual double compute_stretches(Kernel /*kernel*/) { return 0; }

  bool assembled_ = false;
};

/// The base of benches of one type, which can be copied.
template <class Bench>
class CopiedBench : public KernelBench {
 public:
  [[nodiscard]] std::unique_ptr<KernelBench> copy() const final {
    return std::make_unique<Bench>(static_cast<const Bench&>(*this));
  }
  void take(const KernelBench& other) final { static_cast<Bench&>(*this) = static_cast<const Bench&>(other); }
};

/// Prepares the kernels of a mesh (see kernels_of); for a matrix, the product with exactly its entries. Keeps
/// no reference to the input. O(size of the mesh · log degree). Throws InvalidArgument for tuned kernels of a
/// matrix: they need 3×3 blocks or elements.
std::unique_ptr<KernelBench> prepare_kernels(KernelSet kernels, const KernelInput& input, int threads = 1);

/// Does the same for a mesh in its own order; throws also as KernelInput does.
inline std::unique_ptr<KernelBench> prepare_kernels(KernelSet kernels, const Mesh& mesh,
                                                    const CsrGraph& graph, int threads = 1) {
  return prepare_kernels(kernels, KernelInput(mesh, graph), threads);
}

/// Returns the mean number of threads that compute an element or edge of a kernel when `threads` threads
/// share a run. Each thread computes the elements or edges that touch a vertex that it owns (see
/// KernelBench). 1 for products with the matrix and on one thread; 1.02 if every fiftieth element has
/// vertices of two threads; more in scrambled orders, up to the number of threads or corners. `graph` is the
/// vertex graph of a mesh and `simplices` the result of `cut_into_simplices`, both in the order to be judged.
/// O(entries · log threads).
double times_computed(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int threads);

/// Returns the points, moved along every axis by waves of 2 % of the mesh's size and stretched by 3 %:
/// strains of up to about 0.2 for any mesh. O(n).
std::vector<Point> displaced(std::span<const Point> points);

/// Returns the bytes that a vector holds.
template <class Vector>
std::size_t bytes_of(const Vector& vector) {
  return vector.capacity() * sizeof(typename Vector::value_type);
}

}  // namespace meshorder
