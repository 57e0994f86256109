// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/coarsening.hpp"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <numeric>

namespace meshorder {
namespace {

constexpr double kSmoothing = 2.0 / 3.0;  // 4/3 divided by 2, the bound of the spectral radius of D⁻¹L

/// Adds up the entries of a row that have the same column. The object is used for one row after another.
class RowSum {
 public:
  explicit RowSum(Index columns)
      : sum_(columns, 0.0), last_row_(columns, -1), columns_(std::size_t{1} + columns) {}

  void add(Index column, double value) {
    // branch-free: the test is unpredictable
    columns_[used_] = column;
    used_ += last_row_[column] == row_ ? 0 : 1;
    last_row_[column] = row_;
    sum_[column] += value;
  }

  /// Calls `take(column, sum)` for every column, in the order of their first entries, and clears the row.
  template <class Take>
  void take(Take take) {
    for (std::size_t k = 0; k < used_; ++k) {
      const Index column = columns_[k];
      take(column, sum_[column]);
      sum_[column] = 0;
    }
    used_ = 0;
    ++row_;
  }

 private:
  std::vector<double> sum_;
  std::vector<Index> last_row_;  ///< the last row that had an entry in each column
  std::vector<Index> columns_;   ///< the columns of this row, and room for one more
  std::size_t used_ = 0;
  Index row_ = 0;
};

/// Some rows of a Laplacian.
struct LaplacianRows {
  std::vector<Offset> ends;
  std::vector<Index> neighbours;
  std::vector<double> weights;
  std::vector<double> diagonal;

  void end_row(double sum) {
    ends.push_back(static_cast<Offset>(neighbours.size()));
    diagonal.push_back(sum);
  }
};

/// Joins the rows of all parts, one part after the other.
Laplacian joined(std::vector<LaplacianRows> parts) {
  Laplacian result;
  Offset rows = 0;
  Offset entries = 0;
  std::vector<Offset> first_row, first_entry;
  for (const LaplacianRows& part : parts) {
    first_row.push_back(rows);
    first_entry.push_back(entries);
    rows += static_cast<Offset>(part.diagonal.size());
    entries += static_cast<Offset>(part.neighbours.size());
  }
  result.offsets.resize(rows + 1);
  result.diagonal.resize(rows);
  result.neighbours.resize(entries);
  result.weights.resize(entries);
  for_each_chunk(index_size(parts), 1, [&](Index p, Index, Index) {
    const LaplacianRows& part = parts[p];
    std::transform(part.ends.begin(), part.ends.end(), result.offsets.begin() + first_row[p] + 1,
                   [&](Offset end) { return first_entry[p] + end; });
    std::copy(part.diagonal.begin(), part.diagonal.end(), result.diagonal.begin() + first_row[p]);
    std::copy(part.neighbours.begin(), part.neighbours.end(), result.neighbours.begin() + first_entry[p]);
    std::copy(part.weights.begin(), part.weights.end(), result.weights.begin() + first_entry[p]);
  });
  return result;
}

}  // namespace

SparseRows transposed(const SparseRows& a) {
  SparseRows result;
  result.columns_count = a.rows();
  result.offsets.assign(Offset{a.columns_count} + 1, 0);
  for (const Index column : a.columns) ++result.offsets[column + 1];
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.columns.resize(a.columns.size());
  result.values.resize(a.values.size());
  std::vector<Offset> next(result.offsets.begin(), result.offsets.end() - 1);
  for (Index row = 0; row < a.rows(); ++row) {
    for (Offset k = a.offsets[row]; k < a.offsets[row + 1]; ++k) {
      const Offset place = next[a.columns[k]]++;
      result.columns[place] = row;
      result.values[place] = a.values[k];
    }
  }
  return result;
}

Laplacian collapsed(const Laplacian& fine, const RowChunks& chunks, const Aggregation& aggregation) {
  return collapsed(fine, chunks, aggregation, aggregation.count());
}

Laplacian collapsed(const Laplacian& fine, const RowChunks& chunks, const Aggregation& aggregation,
                    Index columns) {
  const Members members = members_of(aggregation, fine.size());
  std::vector<LaplacianRows> parts(chunks.count());
  chunks.for_each([&](Index chunk, Index, Index) {
    LaplacianRows& rows = parts[chunk];
    RowSum row(columns);
    for (Index a = aggregation.first_of_chunk[chunk]; a < aggregation.first_of_chunk[chunk + 1]; ++a) {
      poll_in_loop(a);
      for (Index m = members.starts[a]; m < members.starts[a + 1]; ++m) {
        const Index v = members.members[m];
        for (Offset k = fine.offsets[v]; k < fine.offsets[v + 1]; ++k) {
          row.add(aggregation.aggregate_of[fine.neighbours[k]], fine.weight(k));
        }
      }
      double sum = 0;
      row.take([&](Index b, double weight) {
        if (b == a) return;
        rows.neighbours.push_back(b);
        rows.weights.push_back(weight);
        sum += weight;
      });
      rows.end_row(sum);
    }
  });
  return joined(std::move(parts));
}

SparseRows smoothed_prolongation(const Laplacian& fine, const Aggregation& aggregation) {
  SparseRows result;
  result.columns_count = aggregation.count();
  result.offsets.reserve(Offset{fine.size()} + 1);
  RowSum row(aggregation.count());
  for (Index v = 0; v < fine.size(); ++v) {
    poll_in_loop(v);
    row.add(aggregation.aggregate_of[v], 1 - kSmoothing);
    const double share = kSmoothing / fine.diagonal[v];
    for (Offset k = fine.offsets[v]; k < fine.offsets[v + 1]; ++k) {
      row.add(aggregation.aggregate_of[fine.neighbours[k]], share * fine.weight(k));
    }
    row.take([&](Index column, double value) {
      result.columns.push_back(column);
      result.values.push_back(value);
    });
    result.offsets.push_back(static_cast<Offset>(result.columns.size()));
  }
  return result;
}

std::optional<Laplacian> galerkin_product(const Laplacian& fine, const SparseRows& prolongation,
                                          Offset most) {
  const SparseRows restriction = transposed(prolongation);
  constexpr Index kRows = 256;
  const Index coarse_size = prolongation.columns_count;
  std::vector<LaplacianRows> parts(chunk_count(coarse_size, kRows));
  std::atomic<Offset> entries = 0;
  for_each_chunk(coarse_size, kRows, [&](Index chunk, Index begin, Index end) {
    if (entries > most) return;
    LaplacianRows& rows = parts[chunk];
    RowSum through(fine.size());  // a row of Pᵀ L
    RowSum row(coarse_size);
    for (Index a = begin; a < end && entries <= most; ++a) {
      poll_in_loop(a);
      const Offset before = std::ssize(rows.neighbours);
      for (Offset i = restriction.offsets[a]; i < restriction.offsets[a + 1]; ++i) {
        const Index v = restriction.columns[i];
        through.add(v, restriction.values[i] * fine.diagonal[v]);
        for (Offset k = fine.offsets[v]; k < fine.offsets[v + 1]; ++k) {
          through.add(fine.neighbours[k], -restriction.values[i] * fine.weight(k));
        }
      }
      through.take([&](Index v, double value) {
        for (Offset k = prolongation.offsets[v]; k < prolongation.offsets[v + 1]; ++k) {
          row.add(prolongation.columns[k], value * prolongation.values[k]);
        }
      });
      // the diagonal is chosen so that constants are in the null space
      double sum = 0;
      row.take([&](Index b, double value) {
        if (b == a) return;
        rows.neighbours.push_back(b);
        rows.weights.push_back(-value);
        sum -= value;
      });
      rows.end_row(sum);
      entries += std::ssize(rows.neighbours) - before;
    }
  });
  if (entries > most) return std::nullopt;
  return joined(std::move(parts));
}

}  // namespace meshorder
