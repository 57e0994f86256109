// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/obstacles/obstacle.hpp"
#include "lab/scenario/scenario.hpp"
#include "mesh/mesh.hpp"

#include <memory>
#include <span>

namespace meshorder {

/// The obstacle that a scenario means. Throws Error, which names its file, for a surface that cannot be read,
/// is none, or is not closed and oriented.
std::shared_ptr<const Obstacle> obstacle_of(const ScenarioObstacle& obstacle);

/// The surfaces of obstacles, to be looked at: triangles, and `obstacle` on the cells numbers which of them
/// each belongs to. A half-space shows a round part of its plane, `extent` wide to either side of its point.
Mesh surfaces_of(std::span<const ScenarioObstacle> obstacles, double extent);

}  // namespace meshorder
