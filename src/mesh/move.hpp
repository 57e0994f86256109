// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

namespace meshorder {

/// As the public `apply_reordering`, for a mesh whose ids are there where `Ids::keep` wants to keep them.
void move_mesh(Mesh& mesh, const Permutation& vertices, const Permutation& cells, Ids ids);

}  // namespace meshorder
