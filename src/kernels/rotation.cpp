// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/rotation.hpp"

#include "kernels/rotation-inl.hpp"

namespace meshorder {

Matrix3 closest_rotation(const Matrix3& f) {
  double from[3][3];
  double to[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) from[i][j] = f[i][j];
  }
  HWY_NAMESPACE::closest_rotations<HWY_NAMESPACE::OneLane>(from, to);
  Matrix3 result{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result[i][j] = to[i][j];
  }
  return result;
}

}  // namespace meshorder
