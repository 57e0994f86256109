// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/coarsening.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <set>

namespace meshorder {
namespace {

SparseRows random_rows(Index rows, Index columns, Index entries_per_row, unsigned seed) {
  std::mt19937 random(seed);
  SparseRows result;
  result.columns_count = columns;
  for (Index row = 0; row < rows; ++row) {
    std::set<Index> used;
    for (Index k = 0; k < static_cast<Index>(random() % (entries_per_row + 1U)); ++k) {
      const auto column = static_cast<Index>(random() % static_cast<unsigned>(columns));
      if (!used.insert(column).second) continue;
      result.columns.push_back(column);
      result.values.push_back(static_cast<double>(random() % 19U) - 9);
    }
    result.offsets.push_back(static_cast<Offset>(result.columns.size()));
  }
  return result;
}

/// The matrix in dense form; EXPECTs that no entry occurs twice.
Eigen::MatrixXd dense(const SparseRows& a) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(a.rows(), a.columns_count);
  for (Index row = 0; row < a.rows(); ++row) {
    std::set<Index> used;
    for (Offset k = a.offsets[row]; k < a.offsets[row + 1]; ++k) {
      EXPECT_TRUE(used.insert(a.columns[k]).second)
          << "row " << row << " has column " << a.columns[k] << " twice";
      matrix(row, a.columns[k]) += a.values[k];
    }
  }
  return matrix;
}

// whole numbers: every result is exact

TEST(SparseRows, TransposedSwapsRowsAndColumns) {
  for (const auto& [rows, columns] :
       {std::pair(40, 25), std::pair(7, 60), std::pair(0, 5), std::pair(5, 1)}) {
    const SparseRows a = random_rows(rows, columns, 6, 1);
    const SparseRows t = transposed(a);
    EXPECT_EQ(t.rows(), columns);
    EXPECT_EQ(t.columns_count, rows);
    EXPECT_EQ(dense(t), dense(a).transpose());
  }
}

TEST(Collapsed, HasTheSameRowsWhereItSeesOnlySomeOfAGraph) {
  // a ring of 8 vertices in aggregates of two; only rows 0 … 3 are known; their columns 4 and 5 are the
  // vertices 4 and 7
  Laplacian ring;
  Laplacian half;
  for (Index v = 0; v < 8; ++v) {
    for (const Index u : {(v + 7) % 8, (v + 1) % 8}) {
      ring.neighbours.push_back(u);
      if (v < 4) half.neighbours.push_back(u == 7 ? 5 : u);
    }
    ring.offsets.push_back(2 * (v + 1));
    ring.diagonal.push_back(2);
    if (v >= 4) continue;
    half.offsets.push_back(2 * (v + 1));
    half.diagonal.push_back(2);
  }
  const Laplacian whole = collapsed(ring, RowChunks::whole(8),
                                    {.aggregate_of = {0, 0, 1, 1, 2, 2, 3, 3}, .first_of_chunk = {0, 4}});
  const Laplacian some =
      collapsed(half, RowChunks::whole(4), {.aggregate_of = {0, 0, 1, 1, 2, 3}, .first_of_chunk = {0, 2}}, 4);
  ASSERT_EQ(some.size(), 2);
  EXPECT_TRUE(std::equal(some.neighbours.begin(), some.neighbours.end(), whole.neighbours.begin()));
  EXPECT_TRUE(std::equal(some.weights.begin(), some.weights.end(), whole.weights.begin()));
  EXPECT_TRUE(std::equal(some.diagonal.begin(), some.diagonal.end(), whole.diagonal.begin()));
  EXPECT_TRUE(std::equal(some.offsets.begin(), some.offsets.end(), whole.offsets.begin()));
}

TEST(GalerkinProduct, IsThatOfDenseMatricesAndNoneWhereItHasTooManyEntries) {
  // a hub, 0, and a rim of 600 vertices around it: the hub's row has entries of many aggregates of three
  // vertices
  constexpr Index kRim = 600;
  Laplacian wheel;
  const auto end_row = [&] {
    wheel.diagonal.push_back(static_cast<double>(std::ssize(wheel.neighbours) - wheel.offsets.back()));
    wheel.offsets.push_back(std::ssize(wheel.neighbours));
  };
  Aggregation aggregation{.aggregate_of = {0}, .first_of_chunk = {0, kRim / 3}};
  for (Index v = 1; v <= kRim; ++v) wheel.neighbours.push_back(v);
  end_row();
  for (Index v = 1; v <= kRim; ++v) {
    wheel.neighbours.insert(wheel.neighbours.end(), {0, v == 1 ? kRim : v - 1, v == kRim ? 1 : v + 1});
    end_row();
    aggregation.aggregate_of.push_back((v - 1) / 3);
  }
  const SparseRows p = smoothed_prolongation(wheel, aggregation);
  const std::optional<Laplacian> product = galerkin_product(wheel, p, kRim * kRim);
  ASSERT_TRUE(product);
  Eigen::MatrixXd fine = Eigen::MatrixXd::Zero(kRim + 1, kRim + 1);
  for (Index v = 0; v <= kRim; ++v) {
    fine(v, v) = wheel.diagonal[v];
    for (Offset k = wheel.offsets[v]; k < wheel.offsets[v + 1]; ++k) fine(v, wheel.neighbours[k]) = -1;
  }
  const Eigen::MatrixXd expected = dense(p).transpose() * fine * dense(p);
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(product->size(), product->size());
  for (Index a = 0; a < product->size(); ++a) {
    found(a, a) = product->diagonal[a];
    for (Offset k = product->offsets[a]; k < product->offsets[a + 1]; ++k)
      found(a, product->neighbours[k]) = -product->weights[k];
  }
  EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
  const auto entries = std::ssize(product->neighbours);
  EXPECT_GT(entries, 2 * std::ssize(wheel.neighbours));
  EXPECT_TRUE(galerkin_product(wheel, p, entries));
  EXPECT_FALSE(galerkin_product(wheel, p, entries - 1));
  EXPECT_FALSE(galerkin_product(wheel, p, 2 * std::ssize(wheel.neighbours)));
}

}  // namespace
}  // namespace meshorder
