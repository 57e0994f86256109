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

namespace meshorder {

AccessStream::AccessStream(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices)
    : kernel_(kernel), graph_(graph), simplices_(simplices) {
  const Offset n = graph.size();
  const Offset entries = n + static_cast<Offset>(graph.neighbours.size());
  const bool has_matrix = kernel == Kernel::spmv || kernel == Kernel::assembly;
  if (has_matrix) {
    starts_ = place(kStartBytes * (n + 1));
    columns_ = place(kColumnBytes * entries);
    values_ = place(kEntryBytes * entries);
  }
  if (kernel == Kernel::spmv) {
    x_ = place(kEntryBytes * n);
    y_ = place(kEntryBytes * n);
  } else {
    positions_ = place(kPointBytes * n);
  }
  if (!has_matrix) forces_ = place(kPointBytes * n);
  if (kernel == Kernel::element || kernel == Kernel::assembly)
    elements_ = place(kColumnBytes * static_cast<Offset>(simplices.vertices.size()));
  if (kernel == Kernel::springs) {
    ends_ = place(2 * kColumnBytes * graph.edge_count());
    lengths_ = place(kEntryBytes * graph.edge_count());
  }
  check_lines();
}

AccessStream::AccessStream(const EntryPattern& pattern)
    : kernel_(Kernel::spmv), graph_(pattern.starts, pattern.columns), adds_diagonal_(false) {
  const Offset n = pattern.rows();
  starts_ = place(kStartBytes * (n + 1));
  columns_ = place(kColumnBytes * pattern.entries());
  values_ = place(kEntryBytes * pattern.entries());
  x_ = place(kEntryBytes * n);
  y_ = place(kEntryBytes * n);
  check_lines();
}

void AccessStream::check_lines() const {
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

namespace {

/// A mesh with this many halvings or more is large: a smaller part of its assembly is followed.
constexpr int kLargeFrom = 4;

/// Predicts the lengths of loops and counts the wrong predictions. Models a processor that remembers some
/// thousands of sequences of eight lengths, and for each sequence the length that followed it.
class LoopLengths {
 public:
  void add(Index length) {
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < last_.size(); ++i) {
      before = (before ^ static_cast<std::uint32_t>(last_[(count_ + i) % last_.size()])) * 0x9E3779B1U;
      before ^= before >> 15U;
    }
    Index& foreseen = followed_[before >> kShift];
    turns_ += foreseen != length ? 1 : 0;
    foreseen = length;
    last_[count_++ % last_.size()] = length;
  }

  [[nodiscard]] Offset turns() const noexcept { return turns_; }

 private:
  static constexpr unsigned kShift = 19;

  std::array<Index, 8> last_{};
  std::vector<Index> followed_ = std::vector<Index>(std::size_t{1} << (32 - kShift), -1);
  std::size_t count_ = 0;
  Offset turns_ = 0;
};

/// Returns RunReuse::turns of a product with these rows. The diagonal entries are not counted: a constant
/// added to all lengths changes nothing.
Offset turns_of_product(GraphRef rows) {
  LoopLengths lengths;
  for (Index v = 0; v < rows.size(); ++v) lengths.add(rows.degree(v));
  return lengths.turns();
}

/// Returns RunReuse::turns of a kernel. Large meshes are sampled: of every eight ranges of elements, one is
/// counted.
Offset turns_of(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int halvings) {
  if (kernel == Kernel::spmv) return turns_of_product(graph);
  LoopLengths lengths;
  if (kernel != Kernel::assembly || simplices.dimension == 0) return 0;
  constexpr Offset kStretch = 4096;
  constexpr Offset kAhead = 12;  // simplices between a prefetch and its use
  const Offset stride = halvings < kLargeFrom ? kStretch : 8 * kStretch;
  const auto later = [&](Offset s) { return simplices[std::min(s, simplices.size() - 1)]; };
  Offset counted = 0;
  for (Offset begin = 0; begin < simplices.size(); begin += stride) {
    poll();
    const Offset end = std::min(begin + kStretch, simplices.size());
    counted += end - begin;
    for (Offset s = begin; s < end; ++s) {
      prefetch_offsets(graph.offsets, later(s + 2 * kAhead));
      prefetch_rows(graph.offsets, graph.neighbours, later(s + kAhead));
      const std::span<const Index> element = simplices[s];
      for (const Index a : element) {
        for (const Index b : element) lengths.add(entries_below(graph[a], b) + (b > a ? 1 : 0));
      }
    }
  }
  return std::llround(static_cast<double>(lengths.turns()) * static_cast<double>(simplices.size()) /
                      static_cast<double>(std::max<Offset>(1, counted)));
}

/// Passes accesses to a sample, and calls `poll`.
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

/// Returns the halvings of a kernel's sample. A product gathers from few lines, so its sample is larger.
/// Assembly gathers from many lines, so its sample of a large mesh is smaller.
int halvings_of(Kernel kernel, int halvings) {
  const bool is_large = halvings >= kLargeFrom;
  if (kernel == Kernel::spmv) return std::max(0, halvings - (is_large ? 1 : 2));
  return kernel == Kernel::assembly && is_large ? halvings + 1 : halvings;
}

Reuse followed(const AccessStream& stream, Kernel kernel, int halvings) {
  ReuseSample reuse(stream.line_count(), halvings_of(kernel, halvings));
  PolledSample visitor{reuse};
  stream.visit_some(visitor);
  return std::move(reuse).repeated();
}

}  // namespace

RunReuse reuse_of(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int halvings) {
  Reuse reuse;
  Offset turns = 0;
  take_turns(2, [&](Index turn) {
    if (turn == 0) {
      reuse = followed(AccessStream(kernel, graph, simplices), kernel, halvings);
    } else {
      turns = turns_of(kernel, graph, simplices, halvings);
    }
  });
  return {std::move(reuse), kernel, simplices.dimension, turns};
}

RunReuse reuse_of_product(const EntryPattern& pattern, int halvings) {
  constexpr int kOfLines = 1;
  return {followed(AccessStream(pattern), Kernel::spmv, halvings), Kernel::spmv, kOfLines,
          turns_of_product({pattern.starts, pattern.columns})};
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

KernelReuse reuse_of_kernels(const EntryPattern& pattern, int halvings) {
  KernelReuse result;
  result[static_cast<std::size_t>(Kernel::spmv)] = reuse_of_product(pattern, halvings);
  return result;
}

}  // namespace meshorder
