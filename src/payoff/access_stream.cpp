// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/access_stream.hpp"

#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "metrics/reuse_sample.hpp"
#include <meshorder/error.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {

AccessStream::AccessStream(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices)
    : kernel_(kernel), graph_(graph), simplices_(simplices) {
  const Offset n = graph.size();
  const Offset blocks = n + static_cast<Offset>(graph.neighbours.size());
  const Offset corners = simplices.dimension + 1;
  const Offset elements = corners == 1 ? 0 : simplices.size();
  const Offset batches = (elements + kBatch - 1) / kBatch;
  if (kernel == Kernel::spmv || kernel == Kernel::assembly) values_ = place(kBlockBytes * blocks);
  if (kernel == Kernel::spmv) {
    offsets_ = place(static_cast<Offset>(sizeof(Offset)) * (n + 1));
    columns_ = place(static_cast<Offset>(sizeof(Index)) * blocks);
    x_ = place(kVectorBytes * n);
    y_ = place(kVectorBytes * n);
  } else {
    positions_ = place(kPaddedBytes * n);
  }
  if (kernel == Kernel::element || kernel == Kernel::springs) forces_ = place(kPaddedBytes * n);
  if (kernel == Kernel::element || kernel == Kernel::assembly) {
    const int d = simplices.dimension;
    vertices_of_batch_ = static_cast<Offset>(sizeof(Index)) * kBatch * corners;
    geometry_of_batch_ = static_cast<Offset>(sizeof(double)) * kBatch * (d * (d + 1) / 2 + 1);
    vertices_ = place(batches * vertices_of_batch_);
    geometry_ = place(batches * geometry_of_batch_);
  }
  if (kernel == Kernel::assembly) {
    map_ = place(static_cast<Offset>(sizeof(Index)) * elements * corners * corners);
  }
  if (kernel == Kernel::springs) {
    const Offset springs = (graph.edge_count() + kBatch - 1) / kBatch * kBatch;
    ends_ = place(static_cast<Offset>(2 * sizeof(Index)) * springs);
    rest_lengths_ = place(static_cast<Offset>(sizeof(double)) * springs);
  }
  if (lines_ > kMaxIndex) {
    throw InvalidArgument("access stream: " + std::to_string(lines_) +
                          " cache lines; at most 2,147,483,647 can be numbered");
  }
}

AccessStream::Array AccessStream::place(Offset bytes) {
  const Array array{lines_, bytes};
  lines_ += (bytes + kLineBytes - 1) / kLineBytes;
  return array;
}

Offset AccessStream::gather_count() const {
  const auto lines_in = [](Offset byte, Offset count) {
    return (byte + count - 1) / kLineBytes - byte / kLineBytes + 1;
  };
  const Offset corners = simplices_.dimension + 1;
  const Offset elements = corners == 1 ? 0 : simplices_.size();
  const auto in_batches = [](Offset count) { return (count + kBatch - 1) / kBatch * kBatch; };
  switch (kernel_) {
    case Kernel::spmv: {
      Offset count = 0;
      for (Index v = 0; v < graph_.size(); ++v)
        count += (index_size(graph_[v]) + 1) * lines_in(kVectorBytes * v, kVectorBytes);
      return count;
    }
    case Kernel::element:
      return 2 * corners * in_batches(elements);
    case Kernel::assembly:
      // nine doubles lie in two lines, wherever they begin
      return corners * in_batches(elements) + 2 * corners * corners * elements;
    case Kernel::springs:
      return 4 * in_batches(graph_.edge_count());
  }
  return 0;
}

namespace {

/// See RunReuse::repeats.
Offset repeated_additions(SimplicesRef simplices) {
  // the halves of a register hold lanes 0 … 3 and 4 … 7, and the first of both are added first
  constexpr std::array<Index, kBatch> kLanes{0, 4, 1, 5, 2, 6, 3, 7};
  const Index corners = simplices.dimension + 1;
  if (corners == 1) return 0;
  Offset repeats = 0;
  Index last = -1;
  Index last_but_one = -1;
  for (Offset first = 0; first < simplices.size(); first += kBatch) {
    for (Index a = 0; a < corners; ++a) {
      for (const Index lane : kLanes) {
        const Offset simplex = std::min(first + lane, simplices.size() - 1);
        const Index v = simplices.vertices[corners * simplex + a];
        repeats += v == last || v == last_but_one ? 1 : 0;
        last_but_one = last;
        last = v;
      }
    }
  }
  return repeats;
}

/// Counts the sixteens that RunReuse::stalls tells of.
class StallCount {
 public:
  explicit StallCount(const AccessStream& product)
      : product_(product),
        first_line_(product.vector_lines().first),
        streamed_before_(static_cast<std::size_t>(product.vector_lines().count), -kLeft) {}

  /// Follows the product of these rows. Their stalls count if `counts`.
  void visit(Index first, Index end, bool counts) {
    product_.visit_rows(first, end, [&](Index line, Access how) {
      if (how == Access::streamed) {
        ++streamed_;
        return;
      }
      Offset& before = streamed_before_[line - first_line_];
      stalled_ |= streamed_ - before >= kLeft;
      before = streamed_;
      if (++gathered_ % kTogether == 0) {
        stalls_ += stalled_ && counts ? 1 : 0;
        stalled_ = false;
        if (gathered_ % 0x10000 == 0) poll();
      }
    });
  }

  [[nodiscard]] Offset stalls() const noexcept { return stalls_; }

 private:
  static constexpr Offset kTogether = 16;
  static constexpr Offset kLeft = 512;

  const AccessStream& product_;
  Index first_line_;
  std::vector<Offset> streamed_before_;  ///< the last access to each line of the vector
  Offset streamed_ = 0;
  Offset gathered_ = 0;
  Offset stalls_ = 0;
  bool stalled_ = false;
};

/// Returns RunReuse::stalls. Where at most a 16th of the lines is followed, it is estimated from every eighth
/// stretch of rows, whose first rows are followed but not counted: they read more than a first level keeps.
Offset stalled_gathers(const AccessStream& product, Index rows, int halvings) {
  constexpr int kSampledFrom = 4;
  constexpr Index kStretch = 1024;
  constexpr Index kBefore = 128;
  constexpr Index kStride = 8 * kStretch;
  StallCount count(product);
  if (halvings < kSampledFrom || rows < kStride) {
    count.visit(0, rows, true);
    return count.stalls();
  }
  Offset counted = 0;
  for (Offset first = 0; first + kStretch <= rows; first += kStride) {
    const auto begin = static_cast<Index>(first);
    count.visit(begin, begin + kBefore, false);
    count.visit(begin + kBefore, begin + kStretch, true);
    counted += kStretch - kBefore;
  }
  return std::llround(static_cast<double>(count.stalls()) * rows / static_cast<double>(counted));
}

/// Polls while a sample is told of accesses.
struct PolledSample {
  ReuseSample& reuse;
  std::uint32_t visits = 0;

  void gather(Index line) {
    poll_at_times();
    reuse.access(line, Access::gathered);
  }
  void stream(Index first, Index end) {
    poll_at_times();
    reuse.stream(first, end);
  }
  [[nodiscard]] bool samples(Index first, Index last) const { return reuse.samples(first, last); }

  void poll_at_times() {
    if (++visits % 0x4000 == 0) poll();
  }
};

}  // namespace

RunReuse reuse_of(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int halvings) {
  const AccessStream stream(kernel, graph, simplices);
  ReuseSample reuse(stream.line_count(), halvings);
  PolledSample visitor{reuse};
  stream.visit_some(visitor);
  return {std::move(reuse).repeated(),
          kernel,
          simplices.dimension,
          stream.gather_count(),
          kernel == Kernel::element ? repeated_additions(simplices) : 0,
          kernel == Kernel::spmv ? stalled_gathers(stream, graph.size(), halvings) : 0};
}

int halvings_for(Offset simplices) {
  if (simplices < 200'000) return 0;
  if (simplices < 1'000'000) return 3;
  return simplices < 8'000'000 ? 4 : 5;
}

KernelReuse reuse_of_kernels(const CsrGraph& graph, SimplicesRef simplices, int halvings) {
  KernelReuse result;
  take_turns(index_size(kKernels), [&](Index turn) {
    const std::size_t k = kLongestFirst[turn];
    result[k] = reuse_of(kKernels[k], graph, simplices, halvings);
  });
  return result;
}

KernelReuse reuse_of_kernels(const Mesh& mesh, const CsrGraph& graph, const Permutation& vertices,
                             const Permutation& cells, int halvings) {
  return reuse_of_kernels(renumbered(graph, vertices.old_to_new()),
                          CellSimplices(mesh).moved(vertices, cells), halvings);
}

}  // namespace meshorder
