// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/multigrid/rigid_modes.hpp"

#include "base/parallel.hpp"

#include <Eigen/Dense>

#include <algorithm>

namespace meshorder {
namespace {

using Modes = Eigen::Matrix<double, Eigen::Dynamic, kRigidModes>;
using Square = Eigen::Matrix<double, kRigidModes, kRigidModes, Eigen::RowMajor>;

/// Makes the columns orthonormal, in their order. Returns the upper triangular matrix that maps the new
/// columns to the old ones. Columns that depend on earlier columns become 0.
Square orthonormalise(Modes& columns) {
  constexpr int kTranslations = 3;
  // least norm of a translation relative to its norm before, of a rotation to the largest rotation's norm; a
  // smaller mode (rotation about a line) becomes 0
  constexpr double kMin = 1e-4;
  Square upper = Square::Zero();
  const auto project_out = [&](int from, int j) {
    for (int pass = 0; pass < 2; ++pass) {  // two passes are enough (Kahan)
      for (int i = from; i < j && i < (from < kTranslations ? kTranslations : j); ++i) {
        const double share = columns.col(i).dot(columns.col(j));
        upper(i, j) += share;
        columns.col(j) -= share * columns.col(i);
      }
    }
  };
  const auto normalise = [&](int j, double min_norm) {
    const double norm = columns.col(j).norm();
    if (norm > min_norm) {
      upper(j, j) = norm;
      columns.col(j) /= norm;
    } else {
      columns.col(j).setZero();
    }
  };

  for (int j = 0; j < kTranslations; ++j) {
    const double before = columns.col(j).norm();
    project_out(0, j);
    normalise(j, kMin * before);
  }
  double widest = 0;
  for (int j = kTranslations; j < kRigidModes; ++j) {
    const double before = columns.col(j).norm();
    project_out(0, j);
    const double after = columns.col(j).norm();
    if (after <= 1e-10 * before) columns.col(j).setZero();  // only rounding errors are left
    widest = std::max(widest, columns.col(j).norm());
  }
  for (int j = kTranslations; j < kRigidModes; ++j) {
    project_out(kTranslations, j);
    normalise(j, kMin * widest);
  }
  return upper;
}

}  // namespace

std::vector<double> rigid_modes(std::span<const Point> points) {
  Point mean{};
  for (const Point& p : points) {
    for (int c = 0; c < 3; ++c) mean[c] += p[c] / static_cast<double>(points.size());
  }
  std::vector<double> modes(3 * kRigidModes * points.size(), 0.0);
  double* place = modes.data();
  for (const Point& p : points) {
    const double x = p[0] - mean[0], y = p[1] - mean[1], z = p[2] - mean[2];
    const double of_point[3 * kRigidModes] = {1, 0, 0, 0, z, -y, 0, 1, 0, -z, 0, x, 0, 0, 1, y, -x, 0};
    place = std::copy(std::begin(of_point), std::end(of_point), place);
  }
  return modes;
}

template <int R>
RigidProlongation<R> rigid_prolongation(const Aggregates& aggregates, Index fine_count,
                                        std::span<const double> modes) {
  constexpr int kBlock = R * kRigidModes;
  constexpr int kRoom = Prolongation<R>::kRoom;
  RigidProlongation<R> result;
  Prolongation<R>& p = result.prolongation;
  p.columns_count = aggregates.count();
  std::vector<Index> aggregate_of(fine_count, -1);
  for (Index a = 0; a < aggregates.count(); ++a) {
    for (Index m = aggregates.starts[a]; m < aggregates.starts[a + 1]; ++m) {
      aggregate_of[aggregates.members[m]] = a;
    }
  }
  p.offsets.reserve(Offset{fine_count} + 1);
  for (const Index a : aggregate_of) {
    if (a >= 0) p.columns.push_back(a);
    p.offsets.push_back(static_cast<Offset>(p.columns.size()));
  }
  p.values.resize(kBlock * p.columns.size() + kRoom);
  result.coarse_modes.resize(std::size_t{kRigidModes} * kRigidModes * aggregates.count());

  constexpr Index kAggregates = 256;
  for_each_chunk(aggregates.count(), kAggregates, [&](Index, Index begin, Index end) {
    Modes columns;
    for (Index a = begin; a < end; ++a) {
      const Index size = aggregates.starts[a + 1] - aggregates.starts[a];
      const Index* const members = aggregates.members.data() + aggregates.starts[a];
      columns.resize(Eigen::Index{R} * size, kRigidModes);
      using Block = Eigen::Matrix<double, R, kRigidModes, Eigen::RowMajor>;
      for (Index m = 0; m < size; ++m) {
        columns.template middleRows<R>(Eigen::Index{R} * m) =
            Eigen::Map<const Block>(modes.data() + Offset{kBlock} * members[m]);
      }
      const Square upper = orthonormalise(columns);
      std::copy_n(upper.data(), upper.size(),
                  result.coarse_modes.begin() + Offset{kRigidModes * kRigidModes} * a);
      for (Index m = 0; m < size; ++m) {
        Eigen::Map<Eigen::Matrix<float, R, kRigidModes, Eigen::RowMajor>>(p.block(p.offsets[members[m]])) =
            columns.template middleRows<R>(Eigen::Index{R} * m).template cast<float>();
      }
    }
  });
  return result;
}

template RigidProlongation<3> rigid_prolongation<3>(const Aggregates&, Index, std::span<const double>);
template RigidProlongation<6> rigid_prolongation<6>(const Aggregates&, Index, std::span<const double>);

}  // namespace meshorder
