// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/obstacles/obstacle.hpp"
#include "lab/scenario/scenario.hpp"
#include <meshorder/mesh.hpp>

#include <memory>
#include <span>

namespace meshorder {

/// Makes the obstacle that a scenario describes. Throws Error, which names the file, for a surface that
/// cannot be read, does not consist of triangles, or is not closed and oriented.
std::shared_ptr<const Obstacle> obstacle_of(const ScenarioObstacle& obstacle);

/// Returns the surfaces of obstacles as triangles for viewing; the cell array `obstacle` is the index of each
/// triangle's obstacle. A half-space is shown as a disc of radius `extent` about its point.
Mesh surfaces_of(std::span<const ScenarioObstacle> obstacles, double extent);

}  // namespace meshorder
