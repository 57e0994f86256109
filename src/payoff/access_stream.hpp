// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/row_access.hpp"
#include "mesh/simplices.hpp"
#include "mesh/stored_matrix.hpp"
#include "metrics/cache.hpp"
#include "payoff/kernel_bench.hpp"
#include <meshorder/mesh.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace meshorder {

/// The sequence of cache lines that one run of a plain kernel accesses. It is derived from the mesh without a
/// matrix. Every array of the kernel begins at a line; lines are numbered array by array from 0. Accesses are
/// - the first touch of each line of an array that is read or cleared from front to back: values and columns
///   of a product, elements, edges, results being cleared;
/// - each touch of a vertex's line when the vertex is gathered or added to;
/// - each touch of a line of the matrix in which an element searches for an entry or adds to it.
///
/// Not included: the stack, the code, and repeated touches within a few accesses.
class AccessStream {
 public:
  /// `graph` is the vertex graph of a mesh and `simplices` the result of `cut_into_simplices`, both in the
  /// order to be judged; both must outlive the stream. Throws InvalidArgument if the kernel needs 2^31 lines
  /// or more. O(1).
  AccessStream(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices);
  /// The stream of a product with a matrix of exactly these entries; `pattern` must outlive it. O(1).
  explicit AccessStream(const EntryPattern& pattern);

  [[nodiscard]] Index line_count() const noexcept { return static_cast<Index>(lines_); }

  /// Calls `touch(line, how)` for every access; `how` is an Access, streamed or gathered. O(accesses) time;
  /// for assembly, O(accesses · log row length).
  template <class Touch>
  void visit(Touch touch) const {
    ToEveryLine<Touch> visitor{touch};
    visit_some(visitor);
  }

  /// As visit, but calls `visitor.gather(line)` for a gathered line and `visitor.stream(first, end)` for
  /// lines that are streamed one after another. May skip gathered accesses to the lines first … last if
  /// `visitor.samples(first, last)` is false; this saves the look-up of these lines.
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

    /// Returns whether the visitor samples a line of these bytes; `count` ≥ 1.
    template <class Visitor>
    [[nodiscard]] bool is_sampled(Offset byte, Offset count, const Visitor& visitor) const {
      const auto line_of = [&](Offset of) { return static_cast<Index>(first_line + of / kLineBytes); };
      return visitor.samples(line_of(byte), line_of(byte + count - 1));
    }
  };

  /// Reads an array from front to back, and touches each line when it reaches the line's first byte.
  class Reader {
   public:
    explicit Reader(const Array& array) : next_line_(array.first_line) {}

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
    Offset left_ = 0;  ///< bytes of the last touched line that are not read yet
  };

  /// Gathers vertices from an array; skips vertices without a sampled line.
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

  /// A visitor that calls `touch` for every line of a stream.
  template <class Touch>
  struct ToEveryLine {
    Touch& touch;

    void gather(Index line) { touch(line, Access::gathered); }
    void stream(Index first, Index end) {
      for (Index line = first; line < end; ++line) touch(line, Access::streamed);
    }
    [[nodiscard]] static bool samples(Index /*first*/, Index /*last*/) { return true; }
  };

  static constexpr Offset kEntryBytes = sizeof(double);
  static constexpr Offset kColumnBytes = sizeof(Index);
  static constexpr Offset kStartBytes = sizeof(Offset);
  static constexpr Offset kPointBytes = 3 * sizeof(double);

  Array place(Offset bytes);
  void check_lines() const;

  /// Returns the index of the first entry of row a. A row has an entry for each neighbour and the diagonal.
  [[nodiscard]] Offset row_begin(Index a) const { return graph_.offsets[a] + a; }

  /// Returns the index of the entry in row a and column b of the matrix.
  [[nodiscard]] Offset entry(Index a, Index b) const {
    return row_begin(a) + entries_below(graph_[a], b) + (b > a ? 1 : 0);
  }

  template <class Visitor>
  void visit_spmv(Visitor& visitor) const {
    const VertexGatherer x(x_, kEntryBytes, graph_.size(), visitor);
    Reader starts(starts_), columns(columns_), values(values_), y(y_);
    const auto multiply = [&](Index column) {
      columns.read(kColumnBytes, visitor);
      values.read(kEntryBytes, visitor);
      x.gather(column, visitor);
    };
    starts.read(kStartBytes, visitor);
    for (Index v = 0; v < graph_.size(); ++v) {
      starts.read(kStartBytes, visitor);
      const std::span<const Index> row = graph_[v];
      const auto after_diagonal = adds_diagonal_ ? std::lower_bound(row.begin(), row.end(), v) : row.begin();
      std::for_each(row.begin(), after_diagonal, multiply);
      if (adds_diagonal_) multiply(v);
      std::for_each(after_diagonal, row.end(), multiply);
      y.read(kEntryBytes, visitor);
    }
  }

  /// Visits the accesses of element forces or of assembly.
  template <class Visitor>
  void visit_elements(Visitor& visitor) const {
    const Offset corners = simplices_.dimension + 1;
    if (corners == 1) return;
    const bool assembly = kernel_ == Kernel::assembly;
    const Index n = graph_.size();
    const VertexGatherer positions(positions_, kPointBytes, n, visitor);
    const VertexGatherer forces(forces_, kPointBytes, assembly ? 0 : n, visitor);
    const VertexGatherer starts(starts_, kStartBytes, assembly ? n : 0, visitor);
    const std::vector<bool> rows = assembly ? sampled_rows(visitor) : std::vector<bool>();
    (assembly ? values_ : forces_).clear(visitor);
    Reader elements(elements_);
    for (Offset s = 0; s < simplices_.size(); ++s) {
      const std::span<const Index> element = simplices_[s];
      elements.read(corners * kColumnBytes, visitor);
      positions.gather(element, visitor);
      if (!assembly) {
        forces.gather(element, visitor);
        continue;
      }
      prefetch_offsets(graph_.offsets, later(s + 2 * kAhead));
      for (const Index& v : later(s + kAhead)) {
        if (rows[v]) prefetch_rows(graph_.offsets, graph_.neighbours, {&v, 1});
      }
      for (const Index a : element) {
        starts.gather(a, visitor);
        if (rows[a]) visit_row(a, element, visitor);
      }
    }
  }

  /// Visits, for each corner b of the element, the columns of row a up to b and the value in column b.
  template <class Visitor>
  void visit_row(Index a, std::span<const Index> element, Visitor& visitor) const {
    const Offset begin = row_begin(a);
    for (const Index b : element) {
      const Offset k = entry(a, b);
      columns_.gather(kColumnBytes * begin, kColumnBytes * (k + 1 - begin), visitor);
      values_.gather(kEntryBytes * k, kEntryBytes, visitor);
    }
  }

  /// Returns which rows of the matrix have a sampled line of columns or values.
  template <class Visitor>
  [[nodiscard]] std::vector<bool> sampled_rows(const Visitor& visitor) const {
    std::vector<bool> rows(static_cast<std::size_t>(graph_.size()));
    for (Index a = 0; a < graph_.size(); ++a) {
      const Offset begin = row_begin(a);
      const Offset count = row_begin(a + 1) - begin;
      rows[a] = columns_.is_sampled(kColumnBytes * begin, kColumnBytes * count, visitor) ||
                values_.is_sampled(kEntryBytes * begin, kEntryBytes * count, visitor);
    }
    return rows;
  }

  /// Returns the corners of a simplex; of the last simplex if the number is too large.
  [[nodiscard]] std::span<const Index> later(Offset simplex) const {
    return simplices_[std::min(simplex, simplices_.size() - 1)];
  }

  template <class Visitor>
  void visit_springs(Visitor& visitor) const {
    const VertexGatherer positions(positions_, kPointBytes, graph_.size(), visitor);
    const VertexGatherer forces(forces_, kPointBytes, graph_.size(), visitor);
    forces_.clear(visitor);
    Reader ends(ends_), lengths(lengths_);
    for (Index a = 0; a < graph_.size(); ++a) {
      const std::span<const Index> row = graph_[a];
      std::for_each(std::upper_bound(row.begin(), row.end(), a), row.end(), [&](Index b) {
        const std::array spring{a, b};
        ends.read(sizeof(spring), visitor);
        positions.gather(spring, visitor);
        lengths.read(kEntryBytes, visitor);
        forces.gather(spring, visitor);
      });
    }
  }

  static constexpr Offset kAhead = 12;  ///< elements between a prefetch by this simulation and its use

  Kernel kernel_;
  GraphRef graph_;  ///< for a product with a matrix: its rows; the pattern need not be symmetric
  bool adds_diagonal_ = true;
  SimplicesRef simplices_;
  Offset lines_ = 0;
  // the arrays of the kernel
  Array starts_, columns_, values_, x_, y_;
  Array positions_, forces_, elements_;
  Array ends_, lengths_;
};

/// The reuse of data in a run of a kernel.
struct RunReuse : Reuse {
  Kernel kernel = Kernel::spmv;
  int dimension = 0;  ///< dimension of the simplices: 3 for tetrahedra
  /// Number of loops whose end a processor mispredicts: rows of a product, or searches of assembly in a row.
  /// A loop is mispredicted if its length differs from the length that last followed the same eight
  /// lengths. 0 for other kernels.
  Offset turns = 0;

  bool operator==(const RunReuse&) const = default;
};

/// Returns the reuse in each run but the first of a kernel that runs repeatedly. O(accesses · log distance)
/// time; about 13 bytes of memory for each line, a fifth of the kernel's own memory. With `halvings` > 0 the
/// reuse is estimated from a share 2^-halvings of the lines (see ReuseSample), which is faster; products with
/// a matrix use two halvings fewer. From four halvings on, products use only one fewer, assembly uses one
/// more, and the turns of assembly are estimated, too. Two threads share the work.
RunReuse reuse_of(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int halvings = 0);

/// Returns the reuse of the product with a matrix that has these entries.
RunReuse reuse_of_product(const EntryPattern& pattern, int halvings = 0);

/// Places of the kernels in kKernels, sorted by how long they take to simulate, the slowest first: assembly
/// adds to 16 entries per element.
inline constexpr std::array<std::size_t, kKernels.size()> kLongestFirst{2, 0, 1, 3};

/// Returns the `halvings` to pass to `reuse_of` for that number of simplices: 0 below 200,000, and up to
/// 5 from eight million on, so that the time grows more slowly than the mesh (docs/prediction.md reports the
/// errors).
int halvings_for(Offset simplices);

/// The reuse of each kernel, in the order of kKernels.
using KernelReuse = std::array<RunReuse, kKernels.size()>;

/// Returns the reuse of all kernels. Each thread takes one kernel at a time.
KernelReuse reuse_of_kernels(const CsrGraph& graph, SimplicesRef simplices, int halvings = 0);

/// Returns the reuse of the product with a matrix; that of the other kernels is empty.
KernelReuse reuse_of_kernels(const EntryPattern& pattern, int halvings = 0);

/// Returns the reuse of all kernels of a mesh or matrix (see kernels_of).
inline KernelReuse reuse_of_kernels(const KernelInput& input, int halvings = 0) {
  return input.is_matrix() ? reuse_of_kernels(input.pattern(), halvings)
                           : reuse_of_kernels(input.graph(), input.simplices(), halvings);
}

}  // namespace meshorder
