// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/row_access.hpp"
#include "kernels/positions.hpp"
#include "kernels/simplices.hpp"
#include "metrics/cache.hpp"
#include "payoff/kernel_bench.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace meshorder {

/// The sequence of cache lines that one run of a kernel accesses, derived from the mesh: no matrix, rest
/// shapes or maps are built. Every array of the kernel begins at a line; lines are numbered array by array
/// from 0. An access is
/// - the first touch of each line of an array that is read or cleared from front to back: matrix values and
/// columns,
///   rest shapes, maps, springs, results being cleared;
/// - each line of each vertex that is gathered or added to, and of each matrix block that an element adds to.
///
/// Not included: the stack, the code, and repeated touches within a few accesses, such as the last entry of a
/// block, which is added after the other eight.
class AccessStream {
 public:
  /// `graph` is the vertex graph of a mesh and `simplices` the result of `cut_into_simplices`, both in the
  /// order to be judged; both must outlive the stream. Throws InvalidArgument if the kernel needs 2^31 lines
  /// or more. O(1).
  AccessStream(Kernel kernel, const CsrGraph& graph, const Simplices& simplices);

  [[nodiscard]] Index line_count() const noexcept { return static_cast<Index>(lines_); }

  /// Lines first … first + count − 1.
  struct Lines {
    Index first = 0;
    Index count = 0;
  };

  /// The lines of the vector that a product gathers from.
  [[nodiscard]] Lines vector_lines() const noexcept {
    return {static_cast<Index>(x_.first_line), static_cast<Index>((x_.bytes + kLineBytes - 1) / kLineBytes)};
  }

  /// The accesses that are gathered, not streamed. O(vertices).
  [[nodiscard]] Offset gather_count() const;

  /// Calls `touch(line, how)` for every access, an Access being how the kernel comes to the line.
  /// O(accesses), for assembly times the logarithm of a row's length.
  template <class Touch>
  void visit(Touch touch) const {
    visit(touch, [](Index /*first*/, Index /*last*/) { return true; });
  }

  /// As above, but may leave out what `is_wanted(first, last)` says is wanted of none of the lines first …
  /// last. Assembly leaves out the blocks of rows whose lines are not wanted, and does not look for their
  /// places.
  template <class Touch, class Wanted>
  void visit(Touch touch, Wanted is_wanted) const {
    switch (kernel_) {
      case Kernel::spmv:
        return visit_spmv(touch);
      case Kernel::element:
        return visit_elements(touch, nullptr);
      case Kernel::assembly: {
        const std::vector<bool> rows = wanted_rows(is_wanted);
        return visit_elements(touch, &rows);
      }
      case Kernel::springs:
        return visit_springs(touch);
    }
  }

 private:
  /// An array in memory.
  struct Array {
    Offset first_line = 0;
    Offset bytes = 0;

    template <class Touch>
    void gather(Offset byte, Offset count, Touch& touch) const {
      for (Offset line = byte / kLineBytes; kLineBytes * line < byte + count; ++line) {
        touch(static_cast<Index>(first_line + line), Access::gathered);
      }
    }

    template <class Touch>
    void clear(Touch& touch) const {
      Reader(*this).read(bytes, touch);
    }
  };

  /// Reads an array from front to back: each line is touched when its first byte is reached.
  class Reader {
   public:
    explicit Reader(const Array& array) : next_line_(array.first_line) {}

    template <class Touch>
    void read(Offset count, Touch& touch) {
      left_ -= count;
      for (; left_ < 0; left_ += kLineBytes) touch(static_cast<Index>(next_line_++), Access::streamed);
    }

   private:
    Offset next_line_;
    Offset left_ = 0;  ///< bytes of the last touched line that are not read yet
  };

  static constexpr Offset kBlockBytes = 9 * sizeof(double);
  static constexpr Offset kVectorBytes = 3 * sizeof(double);  ///< of a vertex
  static constexpr Offset kPaddedBytes = kPaddedStride * sizeof(double);

  Array place(Offset bytes);

  /// The first block of row a of the matrix: each row has a block for each neighbour and one for the
  /// diagonal.
  [[nodiscard]] Offset row_begin(Index a) const { return graph_.offsets[a] + a; }

  /// Returns the index of the block in row a and column b of the matrix.
  [[nodiscard]] Offset block(Index a, Index b) const {
    return row_begin(a) + entries_below(graph_[a], b) + (b > a ? 1 : 0);
  }

  /// Whether some of the lines of each row of the matrix are wanted.
  template <class Wanted>
  [[nodiscard]] std::vector<bool> wanted_rows(Wanted is_wanted) const {
    const auto line_of = [&](Offset byte) {
      return static_cast<Index>(values_.first_line + byte / kLineBytes);
    };
    std::vector<bool> result(static_cast<std::size_t>(graph_.size()));
    for (Index a = 0; a < graph_.size(); ++a) {
      result[a] = is_wanted(line_of(kBlockBytes * row_begin(a)), line_of(kBlockBytes * row_begin(a + 1) - 1));
    }
    return result;
  }

  template <class Touch>
  void visit_vertices(const Array& array, std::span<const Index> vertices, Touch& touch) const {
    for (const Index v : vertices) array.gather(kPaddedBytes * v, kPaddedBytes, touch);
  }

  template <class Touch>
  void visit_spmv(Touch& touch) const {
    Reader offsets(offsets_), columns(columns_), values(values_), y(y_);
    const auto multiply = [&](Index column) {
      columns.read(sizeof(Index), touch);
      values.read(kBlockBytes, touch);
      x_.gather(kVectorBytes * column, kVectorBytes, touch);
    };
    offsets.read(sizeof(Offset), touch);
    for (Index v = 0; v < graph_.size(); ++v) {
      offsets.read(sizeof(Offset), touch);
      const std::span<const Index> row = graph_[v];
      const auto after_diagonal = std::lower_bound(row.begin(), row.end(), v);
      std::for_each(row.begin(), after_diagonal, multiply);
      multiply(v);
      std::for_each(after_diagonal, row.end(), multiply);
      y.read(kVectorBytes, touch);
    }
  }

  /// Element forces, or the assembly of such rows of the matrix.
  template <class Touch>
  void visit_elements(Touch& touch, const std::vector<bool>* rows) const {
    const int corners = simplices_.dimension + 1;
    if (corners == 1) return;
    const Array& result = rows != nullptr ? values_ : forces_;
    result.clear(touch);
    Reader vertices(vertices_), geometry(geometry_), map(map_);
    std::array<Index, Offset{4} * kBatch> batch;
    for (Offset first = 0; first < simplices_.size(); first += kBatch) {
      for (int a = 0; a < corners; ++a) {
        for (Offset lane = 0; lane < kBatch; ++lane) {
          const Offset simplex = std::min(first + lane, simplices_.size() - 1);
          batch[a * kBatch + lane] = simplices_.vertices[corners * simplex + a];
        }
      }
      const std::span<const Index> of_batch(batch.data(), Offset{corners} * kBatch);
      geometry.read(geometry_of_batch_, touch);
      vertices.read(vertices_of_batch_, touch);
      visit_vertices(positions_, of_batch, touch);
      if (rows == nullptr) {
        visit_vertices(forces_, of_batch, touch);
        continue;
      }
      const auto lanes = static_cast<Index>(std::min<Offset>(kBatch, simplices_.size() - first));
      for (Index lane = 0; lane < lanes; ++lane) {
        prefetch_offsets(graph_.offsets, corners_of(first + lane + 3 * kBatch));
        prefetch_rows(graph_.offsets, graph_.neighbours, corners_of(first + lane + 3 * kBatch / 2));
        map.read(Offset{corners} * corners * sizeof(Index), touch);
        visit_blocks(batch.data() + lane, *rows, touch);
      }
    }
  }

  /// The corners of a simplex, of the last one for those behind it.
  [[nodiscard]] std::span<const Index> corners_of(Offset simplex) const {
    const Offset corners = simplices_.dimension + 1;
    return std::span<const Index>(simplices_.vertices)
        .subspan(corners * std::min(simplex, simplices_.size() - 1), corners);
  }

  /// Visits the blocks of the element with corners v[0], v[kBatch] … in these rows.
  template <class Touch>
  void visit_blocks(const Index* v, const std::vector<bool>& rows, Touch& touch) const {
    const auto visit_block = [&](Index i, Index j) {
      if (rows[i]) values_.gather(kBlockBytes * block(i, j), kBlockBytes, touch);
    };
    for (int a = 0; a <= simplices_.dimension; ++a) {
      for (int b = a; b <= simplices_.dimension; ++b) {
        const Index i = v[a * kBatch], j = v[b * kBatch];
        visit_block(i, j);
        if (a != b) visit_block(j, i);
      }
    }
  }

  template <class Touch>
  void visit_springs(Touch& touch) const {
    forces_.clear(touch);
    Reader ends(ends_), rest_lengths(rest_lengths_);
    // the last batch is padded with springs from vertex 0 to itself
    std::array<Index, 2 * kBatch> batch{};
    Index lane = 0;
    const auto visit_batch = [&] {
      ends.read(sizeof(batch), touch);
      visit_vertices(positions_, batch, touch);
      rest_lengths.read(kBatch * sizeof(double), touch);
      visit_vertices(forces_, batch, touch);
      batch.fill(0);
      lane = 0;
    };
    for (Index b = 0; b < graph_.size(); ++b) {
      for (const Index a : graph_[b]) {
        if (a > b) break;
        batch[lane] = a;
        batch[kBatch + lane] = b;
        if (++lane == kBatch) visit_batch();
      }
    }
    if (lane > 0) visit_batch();
  }

  Kernel kernel_;
  const CsrGraph& graph_;
  const Simplices& simplices_;
  Offset lines_ = 0;
  Offset vertices_of_batch_ = 0;  ///< bytes
  Offset geometry_of_batch_ = 0;
  // the arrays of the kernel
  Array offsets_, columns_, values_, x_, y_;
  Array positions_, forces_, vertices_, geometry_, map_;
  Array ends_, rest_lengths_;
};

/// What a run of a kernel uses again: cache lines, and sums.
struct RunReuse : Reuse {
  Kernel kernel = Kernel::spmv;
  int dimension = 0;   ///< of the simplices: 3 for tetrahedra
  Offset gathers = 0;  ///< gathered accesses
  /// Additions of element forces to a vertex that one of the two before them went to: they wait until what
  /// that one stored can be loaded. In the order in which registers of eight doubles are added.
  Offset repeats = 0;
  /// Of a product with the matrix, the groups of 16 gathered accesses that have to wait for the second level:
  /// one or more of them come to a line since whose last use 512 others were read from front to back (an L1
  /// cache of 32 KB). Less of the matrix arrives from memory meanwhile (docs/prediction.md).
  Offset stalls = 0;

  bool operator==(const RunReuse&) const = default;
};

/// Returns the reuse of a repeated kernel: of every run but the first. O(accesses · log distance) time and
/// about 13 bytes of memory for each line, a fifth of the kernel's own memory. With `halvings` > 0 that of
/// the lines is estimated from 2^-halvings of them (see ReuseSample), which is faster.
RunReuse reuse_of(Kernel kernel, const CsrGraph& graph, const Simplices& simplices, int halvings = 0);

/// The places in kKernels, what takes longest to follow first: assembly adds to 16 blocks an element.
inline constexpr std::array<std::size_t, kKernels.size()> kLongestFirst{2, 0, 1, 3};

/// Returns the halvings with which `reuse_of` follows a mesh of so many simplices: 0 below 200,000, and up to
/// 5 from eight million on, so that larger meshes take less time than in proportion (docs/prediction.md says
/// how far off that is).
int halvings_for(Offset simplices);

/// By kernel, as kKernels lists them.
using KernelReuse = std::array<RunReuse, kKernels.size()>;

/// Returns the reuse of all kernels, each computed on its own thread.
KernelReuse reuse_of_kernels(const CsrGraph& graph, const Simplices& simplices, int halvings = 0);

/// Returns the reuse of all kernels on a mesh, whose vertex graph is `graph`, after apply_reordering with
/// these permutations.
KernelReuse reuse_of_kernels(const Mesh& mesh, const CsrGraph& graph, const Permutation& vertices,
                             const Permutation& cells, int halvings = 0);

}  // namespace meshorder
