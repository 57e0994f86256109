// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "../../benchmarks/plain_programs.hpp"
#include "kernels/plain.hpp"
#include "mesh/graphs.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace meshorder::plain {
namespace {

/// A distorted bar, and the matrix on its vertex graph.
class PlainKernels : public testing::Test {
 protected:
  PlainKernels() {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> shift(-0.05, 0.05);
    for (const Point& point : mesh_.points) {
      for (const double x : point) positions_.push_back(x + shift(random));
    }
    const CsrGraph graph = vertex_graph(mesh_);
    starts_.push_back(0);
    for (Index v = 0; v < graph.size(); ++v) {
      std::vector<Index> row(graph[v].begin(), graph[v].end());
      row.push_back(v);
      std::sort(row.begin(), row.end());
      for (const Index u : row) {
        if (u < v) ends_.insert(ends_.end(), {u, v});
      }
      columns_.insert(columns_.end(), row.begin(), row.end());
      starts_.push_back(static_cast<Index>(columns_.size()));
    }
    values_.resize(columns_.size());
  }

  [[nodiscard]] std::size_t size() const { return starts_.size() - 1; }
  Matrix<double, Index> matrix() { return {starts_, columns_, values_}; }
  std::vector<double> random_vector(std::size_t n) {
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<double> result(n);
    for (double& x : result) x = number(random_);
    return result;
  }
  /// The product with the full matrix.
  std::vector<double> dense_product(const std::vector<double>& x) {
    std::vector<double> full(size() * size());
    for (std::size_t row = 0; row < size(); ++row) {
      for (Index k = starts_[row]; k < starts_[row + 1]; ++k)
        full[row * size() + std::size_t(columns_[k])] = values_[k];
    }
    std::vector<double> y(size());
    for (std::size_t row = 0; row < size(); ++row) {
      for (std::size_t column = 0; column < size(); ++column)
        y[row] += full[row * size() + column] * x[column];
    }
    return y;
  }

  Mesh mesh_ = test::tetrahedral_bar(4);
  std::mt19937_64 random_{7};
  std::vector<double> positions_;
  std::vector<Index> starts_;
  std::vector<Index> columns_;
  std::vector<double> values_;
  std::vector<Index> ends_;
};

TEST_F(PlainKernels, MultiplyAsTheFullMatrix) {
  values_ = random_vector(columns_.size());
  const std::vector<double> x = random_vector(size());
  const std::vector<double> expected = dense_product(x);
  std::vector<double> y(size());
  multiply(matrix(), std::span<const double>(x), std::span(y));
  std::vector<std::int64_t> wide_starts(starts_.begin(), starts_.end());
  std::vector<std::int64_t> wide_columns(columns_.begin(), columns_.end());
  std::vector<float> narrow(values_.begin(), values_.end());
  std::vector<float> narrow_x(x.begin(), x.end());
  std::vector<float> narrow_y(size());
  multiply(Matrix<float, std::int64_t>{wide_starts, wide_columns, narrow}, std::span<const float>(narrow_x),
           std::span(narrow_y));
  for (std::size_t v = 0; v < size(); ++v) {
    EXPECT_NEAR(y[v], expected[v], 1e-13);
    EXPECT_NEAR(narrow_y[v], expected[v], 1e-5);
  }
}

TEST_F(PlainKernels, MultiplyBlocksAsScalars) {
  // blocks of a multiple of the unit matrix act on each coordinate alone; a cyclic shift moves them
  values_ = random_vector(columns_.size());
  std::vector<double> blocks(9 * columns_.size());
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) blocks[9 * k + 3 * i + (i + 1) % 3] = values_[k];
  }
  const std::vector<double> x = random_vector(3 * size());
  std::vector<double> y(3 * size());
  multiply_blocks(Matrix<double, Index>{starts_, columns_, blocks}, x, y);
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> shifted(size());
    for (std::size_t v = 0; v < size(); ++v) shifted[v] = x[3 * v + (i + 1) % 3];
    const std::vector<double> expected = dense_product(shifted);
    for (std::size_t v = 0; v < size(); ++v) EXPECT_NEAR(y[3 * v + i], expected[v], 1e-13);
  }
}

TEST_F(PlainKernels, AssembleTheLaplacian) {
  assemble<4>(mesh_.cells.vertices, positions_, matrix());
  // xᵀ A x is the integral of the squared gradient: of 2 x − 3 y + z it is 14 times the volume
  double volume = 0;
  for (std::size_t e = 0; e < mesh_.cells.vertices.size(); e += 4)
    volume += std::abs(gradients<4>(mesh_.cells.vertices.data() + e, positions_).volume);
  std::vector<double> linear(size());
  for (std::size_t v = 0; v < size(); ++v)
    linear[v] = 2 * positions_[3 * v] - 3 * positions_[3 * v + 1] + positions_[3 * v + 2];
  const std::vector<double> product = dense_product(linear);
  double energy = 0;
  for (std::size_t v = 0; v < size(); ++v) energy += linear[v] * product[v];
  EXPECT_NEAR(energy, 14 * volume, 1e-10 * volume);
  for (const double row_sum : dense_product(std::vector<double>(size(), 1.0))) EXPECT_NEAR(row_sum, 0, 1e-12);

  // Gauss–Seidel converges after an addition to the diagonal
  for (std::size_t row = 0; row < size(); ++row) {
    for (Index k = starts_[row]; k < starts_[row + 1]; ++k) {
      if (std::size_t(columns_[k]) == row) values_[k] += 1;
    }
  }
  const std::vector<double> solution = random_vector(size());
  const std::vector<double> b = dense_product(solution);
  std::vector<double> x(size());
  for (int sweep = 0; sweep < 300; ++sweep) relax(matrix(), std::span<const double>(b), std::span(x));
  for (std::size_t v = 0; v < size(); ++v) EXPECT_NEAR(x[v], solution[v], 1e-9);
}

TEST_F(PlainKernels, PressByTheGradientOfTheVolume) {
  std::vector<double> forces(3 * size());
  press<4>(mesh_.cells.vertices, positions_, forces);
  const auto volumes = [&] {
    double sum = 0;
    for (std::size_t e = 0; e < mesh_.cells.vertices.size(); e += 4)
      sum += gradients<4>(mesh_.cells.vertices.data() + e, positions_).volume;
    return sum;
  };
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const double before = std::exchange(positions_[k], positions_[k] + 1e-5);
    const double above = volumes();
    positions_[k] = before - 1e-5;
    const double below = volumes();
    positions_[k] = before;
    EXPECT_NEAR(forces[k], (above - below) / 2e-5, 1e-8);
  }
}

/// Compares the forces of `press` with finite differences of the total size.
template <int Corners>
void expect_gradients_of_size(const std::vector<Index>& simplices, std::vector<double> positions) {
  const auto total = [&] {
    double sum = 0;
    for (std::size_t e = 0; e < simplices.size(); e += Corners)
      sum += gradients<Corners>(simplices.data() + e, positions).volume;
    return sum;
  };
  std::vector<double> forces(positions.size());
  press<Corners>(simplices, positions, forces);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const double before = std::exchange(positions[k], positions[k] + 1e-5);
    const double above = total();
    positions[k] = before - 1e-5;
    const double below = total();
    positions[k] = before;
    EXPECT_NEAR(forces[k], (above - below) / 2e-5, 1e-8);
  }
}

TEST_F(PlainKernels, PressTrianglesAndLinesByTheGradientOfTheirSize) {
  const std::vector<double> corners = random_vector(12);
  expect_gradients_of_size<3>({0, 1, 2, 2, 3, 0}, corners);
  expect_gradients_of_size<2>({0, 1, 1, 2, 3, 0}, corners);
  // half of the product of two sides at a right angle; a line's own length
  EXPECT_DOUBLE_EQ(
      gradients<3>(std::vector<Index>{0, 1, 2}.data(), std::vector<double>{0, 0, 1, 3, 0, 1, 0, 4, 1}).volume,
      6);
  EXPECT_DOUBLE_EQ(
      gradients<2>(std::vector<Index>{0, 1}.data(), std::vector<double>{0, 0, 1, 3, 4, 1}).volume, 5);
}

TEST_F(PlainKernels, PullByTheGradientOfTheSprings) {
  const std::vector<double> lengths(ends_.size() / 2, 0.3);
  std::vector<double> forces(3 * size());
  springs(ends_, std::span<const double>(lengths), std::span<const double>(positions_), std::span(forces));
  const auto energy = [&] {
    double sum = 0;
    for (std::size_t s = 0; s < lengths.size(); ++s) {
      double square = 0;
      for (std::size_t c = 0; c < 3; ++c)
        square += std::pow(
            positions_[3 * std::size_t(ends_[2 * s]) + c] - positions_[3 * std::size_t(ends_[2 * s + 1]) + c],
            2);
      sum += std::pow(std::sqrt(square) - lengths[s], 2) / 2;
    }
    return sum;
  };
  for (std::size_t k = 0; k < forces.size(); k += 7) {
    const double before = std::exchange(positions_[k], positions_[k] + 1e-5);
    const double above = energy();
    positions_[k] = before - 1e-5;
    const double below = energy();
    positions_[k] = before;
    EXPECT_NEAR(forces[k], -(above - below) / 2e-5, 1e-8);
  }
}

TEST_F(PlainKernels, ExchangeWhatTheOtherVertexGets) {
  const std::vector<double> areas = random_vector(ends_.size() / 2);
  const std::vector<double> state(5 * size(), 2.0);
  std::vector<double> residual(5 * size());
  exchange(ends_, areas, state, residual);
  double sum = 0;
  for (const double r : residual) sum += r;
  EXPECT_NEAR(sum, 0, 1e-12);
  double of_first = 0;
  for (std::size_t face = 0; face < areas.size(); ++face) {
    if (ends_[2 * face] == 0) of_first += 2 * areas[face];
    if (ends_[2 * face + 1] == 0) of_first -= 2 * areas[face];
  }
  for (std::size_t u = 0; u < 5; ++u) EXPECT_NEAR(residual[u], of_first, 1e-12);
}

TEST_F(PlainKernels, GatherMessagesAsAProductWithOnes) {
  values_.assign(columns_.size(), 1.0);
  const std::vector<double> feature = random_vector(size());
  const std::vector<double> expected = dense_product(feature);
  constexpr int kWidth = 3;
  std::vector<float> in(kWidth * size());
  for (std::size_t v = 0; v < size(); ++v) in[kWidth * v + 1] = static_cast<float>(feature[v]);
  std::vector<float> out(in.size());
  gather_messages(Matrix<float, Index>{starts_, columns_, {}}, kWidth, std::span<const float>(in),
                  std::span(out));
  for (std::size_t v = 0; v < size(); ++v) {
    EXPECT_EQ(out[kWidth * v], 0);
    EXPECT_NEAR(out[kWidth * v + 1], expected[v], 1e-5);
  }
}

}  // namespace
}  // namespace meshorder::plain
