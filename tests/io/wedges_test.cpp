// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/wedges.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace meshorder {
namespace {

// a prism on the triangle 0 1 2, and a point above it
std::vector<Point> points_of_prism(double side) {
  return {{0, 0, 0}, {1, 0, 0}, {0, side, 0}, {0, 0, 1}, {1, 0, 1}, {0, side, 1}, {0, 0, 2}};
}
const std::vector<Index> kWedge{0, 1, 2, 3, 4, 5};
const std::vector<Index> kTurnedWedge{0, 2, 1, 3, 5, 4};
const std::vector<Index> kTetrahedron{3, 4, 5, 6};

TEST(WedgeVote, DecidesByTheVolumesOfTheWedgesWhereNothingElseDoes) {
  const std::vector<Point> points = points_of_prism(1);
  for (const bool turned : {false, true}) {
    WedgeVote vote(points);
    vote.add(Shape::wedge, turned ? kTurnedWedge : kWedge);
    EXPECT_EQ(vote.wedges_face_inward(), !turned);
  }
}

TEST(WedgeVote, GoesByTheOtherCellsInAMirroredMesh) {
  const std::vector<Point> mirrored = points_of_prism(-1);
  for (const bool turned : {false, true}) {
    WedgeVote vote(mirrored);
    vote.add(Shape::wedge, turned ? kTurnedWedge : kWedge);
    vote.add(Shape::tetrahedron, kTetrahedron);
    EXPECT_EQ(vote.wedges_face_inward(), !turned);
  }
}

TEST(WedgeVote, TakesMixedWedgesForThoseThatFaceOutward) {
  const std::vector<Point> points = points_of_prism(1);
  WedgeVote vote(points);
  vote.add(Shape::wedge, kWedge);
  vote.add(Shape::wedge, kTurnedWedge);
  EXPECT_FALSE(vote.wedges_face_inward());
}

}  // namespace
}  // namespace meshorder
