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
  AccessStream(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices);

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
    ToEveryLine<Touch> visitor{touch};
    visit_some(visitor);
  }

  /// As visit, of rows first … end − 1 of a product with the matrix.
  template <class Touch>
  void visit_rows(Index first, Index end, Touch touch) const {
    ToEveryLine<Touch> visitor{touch};
    multiply_rows(first, end, visitor,
                  [&](Index column) { x_.gather(kVectorBytes * column, kVectorBytes, visitor); });
  }

  /// As visit, by `visitor.gather(line)` and, for lines that are streamed one after another,
  /// `visitor.stream(first, end)`. May leave out gathered accesses to lines first … last of which
  /// `visitor.samples(first, last)` says that none counts, and then does not look for their places.
  template <class Visitor>
  void visit_some(Visitor& visitor) const {
    switch (kernel_) {
      case Kernel::spmv:
        return visit_spmv(visitor);
      case Kernel::element:
      case Kernel::assembly:
        return visit_elements(visitor);
      case Kernel::springs:
        return visit_springs(visitor);
    }
  }

 private:
  /// An array in memory.
  struct Array {
    Offset first_line = 0;
    Offset bytes = 0;

    template <class Visitor>
    void gather(Offset byte, Offset count, Visitor& visitor) const {
      for (Offset line = byte / kLineBytes; kLineBytes * line < byte + count; ++line) {
        visitor.gather(static_cast<Index>(first_line + line));
      }
    }

    template <class Visitor>
    void clear(Visitor& visitor) const {
      Reader(*this).read(bytes, visitor);
    }

    /// Whether one of the lines of these bytes, at least one, counts.
    template <class Visitor>
    [[nodiscard]] bool is_sampled(Offset byte, Offset count, const Visitor& visitor) const {
      const auto line_of = [&](Offset of) { return static_cast<Index>(first_line + of / kLineBytes); };
      return visitor.samples(line_of(byte), line_of(byte + count - 1));
    }
  };

  /// Reads an array from front to back: each line is touched when its first byte is reached.
  class Reader {
   public:
    /// From a byte on whose line has been touched, unless it is the first of one.
    explicit Reader(const Array& array, Offset byte = 0)
        : next_line_(array.first_line + (byte + kLineBytes - 1) / kLineBytes),
          left_((kLineBytes - byte % kLineBytes) % kLineBytes) {}

    template <class Visitor>
    void read(Offset count, Visitor& visitor) {
      left_ -= count;
      if (left_ >= 0) return;
      const Offset lines = (kLineBytes - 1 - left_) / kLineBytes;
      visitor.stream(static_cast<Index>(next_line_), static_cast<Index>(next_line_ + lines));
      next_line_ += lines;
      left_ += kLineBytes * lines;
    }

   private:
    Offset next_line_;
    Offset left_;  ///< bytes of the last touched line that are not read yet
  };

  /// Gathers vertices from an array, and leaves out those that lie in no line that counts.
  class VertexGatherer {
   public:
    template <class Visitor>
    VertexGatherer(const Array& array, Offset vertex_bytes, Index vertices, const Visitor& visitor)
        : array_(array), vertex_bytes_(vertex_bytes), sampled_(static_cast<std::size_t>(vertices)) {
      for (Index v = 0; v < vertices; ++v) {
        sampled_[v] = array.is_sampled(vertex_bytes * v, vertex_bytes, visitor);
      }
    }

    template <class Visitor>
    void gather(Index v, Visitor& visitor) const {
      if (sampled_[v]) array_.gather(vertex_bytes_ * v, vertex_bytes_, visitor);
    }

    template <class Visitor>
    void gather(std::span<const Index> vertices, Visitor& visitor) const {
      for (const Index v : vertices) gather(v, visitor);
    }

   private:
    Array array_;
    Offset vertex_bytes_;
    std::vector<bool> sampled_;
  };

  /// A visitor that hands every line of a stream to `touch`.
  template <class Touch>
  struct ToEveryLine {
    Touch& touch;

    void gather(Index line) { touch(line, Access::gathered); }
    void stream(Index first, Index end) {
      for (Index line = first; line < end; ++line) touch(line, Access::streamed);
    }
    [[nodiscard]] static bool samples(Index /*first*/, Index /*last*/) { return true; }
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

  /// The column of the k-th block of row a.
  [[nodiscard]] Index column(Index a, Index k) const {
    const Index before_diagonal = entries_below(graph_[a], a);
    if (k == before_diagonal) return a;
    return graph_[a][k < before_diagonal ? k : k - 1];
  }

  /// The blocks of each row of the matrix from the first to the last that lie in a line that counts.
  class SampledBlocks {
   public:
    SampledBlocks() = default;

    template <class Visitor>
    SampledBlocks(const AccessStream& stream, const Visitor& visitor)
        : rows_(static_cast<std::size_t>(stream.graph_.size())), columns_(rows_.size()) {
      const auto count = [&](Offset first, Offset end) {
        return stream.values_.is_sampled(kBlockBytes * first, kBlockBytes * (end - first), visitor);
      };
      for (Index a = 0; a < stream.graph_.size(); ++a) {
        const Offset begin = stream.row_begin(a);
        Offset first = begin;
        Offset last = stream.row_begin(a + 1) - 1;
        rows_[a] = count(first, last + 1);
        if (!rows_[a]) continue;
        while (first < last && !count(first, first + 1)) ++first;
        while (first < last && !count(last, last + 1)) --last;
        columns_[a] = {stream.column(a, static_cast<Index>(first - begin)),
                       stream.column(a, static_cast<Index>(last - begin))};
      }
    }

    [[nodiscard]] bool has_row(Index a) const { return rows_[a]; }
    /// Whether the block in that column of a row that has some is among them.
    [[nodiscard]] bool has_column(Index a, Index b) const {
      return columns_[a].first <= b && b <= columns_[a].last;
    }

   private:
    struct Columns {
      Index first = 0;
      Index last = 0;
    };

    std::vector<bool> rows_;
    std::vector<Columns> columns_;
  };

  template <class Visitor>
  void visit_spmv(Visitor& visitor) const {
    const VertexGatherer x(x_, kVectorBytes, graph_.size(), visitor);
    multiply_rows(0, graph_.size(), visitor, [&](Index column) { x.gather(column, visitor); });
  }

  /// `gather(column)` gathers from the vector.
  template <class Visitor, class Gather>
  void multiply_rows(Index first, Index end, Visitor& visitor, Gather gather) const {
    Reader offsets(offsets_, first > 0 ? Offset{sizeof(Offset)} * (first + 1) : 0);
    Reader columns(columns_, Offset{sizeof(Index)} * row_begin(first));
    Reader values(values_, kBlockBytes * row_begin(first));
    Reader y(y_, kVectorBytes * first);
    const auto multiply = [&](Index column) {
      columns.read(sizeof(Index), visitor);
      values.read(kBlockBytes, visitor);
      gather(column);
    };
    if (first == 0) offsets.read(sizeof(Offset), visitor);
    for (Index v = first; v < end; ++v) {
      offsets.read(sizeof(Offset), visitor);
      const std::span<const Index> row = graph_[v];
      const auto after_diagonal = std::lower_bound(row.begin(), row.end(), v);
      std::for_each(row.begin(), after_diagonal, multiply);
      multiply(v);
      std::for_each(after_diagonal, row.end(), multiply);
      y.read(kVectorBytes, visitor);
    }
  }

  /// Element forces, or assembly.
  template <class Visitor>
  void visit_elements(Visitor& visitor) const {
    const int corners = simplices_.dimension + 1;
    if (corners == 1) return;
    const bool assembly = kernel_ == Kernel::assembly;
    const Index n = graph_.size();
    const VertexGatherer positions(positions_, kPaddedBytes, n, visitor);
    const VertexGatherer forces(forces_, kPaddedBytes, assembly ? 0 : n, visitor);
    const SampledBlocks blocks = assembly ? SampledBlocks(*this, visitor) : SampledBlocks();
    const Array& result = assembly ? values_ : forces_;
    result.clear(visitor);
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
      geometry.read(geometry_of_batch_, visitor);
      vertices.read(vertices_of_batch_, visitor);
      positions.gather(of_batch, visitor);
      if (!assembly) {
        forces.gather(of_batch, visitor);
        continue;
      }
      const auto lanes = static_cast<Index>(std::min<Offset>(kBatch, simplices_.size() - first));
      for (Index lane = 0; lane < lanes; ++lane) {
        prefetch_offsets(graph_.offsets, corners_of(first + lane + 3 * kBatch));
        for (const Index& v : corners_of(first + lane + 3 * kBatch / 2)) {
          if (blocks.has_row(v)) prefetch_rows(graph_.offsets, graph_.neighbours, {&v, 1});
        }
        map.read(Offset{corners} * corners * sizeof(Index), visitor);
        visit_blocks(batch.data() + lane, blocks, visitor);
      }
    }
  }

  /// The corners of a simplex, of the last one for those behind it.
  [[nodiscard]] std::span<const Index> corners_of(Offset simplex) const {
    const Offset corners = simplices_.dimension + 1;
    return simplices_.vertices.subspan(corners * std::min(simplex, simplices_.size() - 1), corners);
  }

  /// Visits the blocks of the element with corners v[0], v[kBatch] …, those of the sample.
  template <class Visitor>
  void visit_blocks(const Index* v, const SampledBlocks& blocks, Visitor& visitor) const {
    std::array<bool, 4> sampled{};
    bool is_any_sampled = false;
    for (int a = 0; a <= simplices_.dimension; ++a) {
      sampled[a] = blocks.has_row(v[a * kBatch]);
      is_any_sampled |= sampled[a];
    }
    if (!is_any_sampled) return;
    const auto visit_block = [&](int a, int b) {
      const Index i = v[a * kBatch], j = v[b * kBatch];
      if (sampled[a] && blocks.has_column(i, j)) {
        values_.gather(kBlockBytes * block(i, j), kBlockBytes, visitor);
      }
    };
    for (int a = 0; a <= simplices_.dimension; ++a) {
      for (int b = a; b <= simplices_.dimension; ++b) {
        visit_block(a, b);
        if (a != b) visit_block(b, a);
      }
    }
  }

  template <class Visitor>
  void visit_springs(Visitor& visitor) const {
    const VertexGatherer positions(positions_, kPaddedBytes, graph_.size(), visitor);
    const VertexGatherer forces(forces_, kPaddedBytes, graph_.size(), visitor);
    forces_.clear(visitor);
    Reader ends(ends_), rest_lengths(rest_lengths_);
    // the last batch is padded with springs from vertex 0 to itself
    std::array<Index, 2 * kBatch> batch{};
    Index lane = 0;
    const auto visit_batch = [&] {
      ends.read(sizeof(batch), visitor);
      positions.gather(batch, visitor);
      rest_lengths.read(kBatch * sizeof(double), visitor);
      forces.gather(batch, visitor);
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
  SimplicesRef simplices_;
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
/// the lines is estimated from 2^-halvings of them (see ReuseSample), which is faster; from four halvings on
/// the stalls are an estimate, too.
RunReuse reuse_of(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int halvings = 0);

/// The places in kKernels, what takes longest to follow first: assembly adds to 16 blocks an element.
inline constexpr std::array<std::size_t, kKernels.size()> kLongestFirst{2, 0, 1, 3};

/// Returns the halvings with which `reuse_of` follows a mesh of so many simplices: 0 below 200,000, and up to
/// 5 from eight million on, so that larger meshes take less time than in proportion (docs/prediction.md says
/// how far off that is).
int halvings_for(Offset simplices);

/// By kernel, as kKernels lists them.
using KernelReuse = std::array<RunReuse, kKernels.size()>;

/// Returns the reuse of all kernels, each computed on its own thread.
KernelReuse reuse_of_kernels(const CsrGraph& graph, SimplicesRef simplices, int halvings = 0);

/// Returns the reuse of all kernels on a mesh, whose vertex graph is `graph`, after move_mesh with these
/// permutations.
KernelReuse reuse_of_kernels(const Mesh& mesh, const CsrGraph& graph, const Permutation& vertices,
                             const Permutation& cells, int halvings = 0);

}  // namespace meshorder
