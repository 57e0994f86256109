// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/contact_set.hpp"

#include "kernels/positions.hpp"
#include "lab/contact/solve/contact_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace meshorder {
namespace {

/// Two tetrahedra beside each other; vertex 4 is the corner of the second that is nearest to the first.
struct TwoTetrahedra {
  std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                            {2, 2, 2}, {4, 2, 2}, {2, 4, 2}, {2, 2, 4}};
  Simplices simplices{3, {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1}};

  /// The contacts of the body with itself, and with a floor at z = −1.
  [[nodiscard]] ContactSet contacts() const {
    ContactOptions options;
    options.with_itself = true;
    options.reach = 0.1;
    options.obstacles.push_back({half_space({0, 0, -1}, {0, 0, 1}), 0.0});
    return ContactSet(ContactFinder(simplices, points, options));
  }

  /// Positions with vertex 4 at (t, t, t), which is inside the first tetrahedron if t < 1/3.
  [[nodiscard]] AlignedVector<double> with_vertex_at(double t) const {
    std::vector<Point> moved = points;
    moved[4] = {t, t, t};
    return padded_positions(moved);
  }
};

TEST(ContactSet, AVertexThatEntersMustStayOutside) {
  const TwoTetrahedra body;
  ContactSet set = body.contacts();
  const AlignedVector<double> from = body.with_vertex_at(0.5);
  const AlignedVector<double> inside = body.with_vertex_at(0.3);
  set.begin(from);
  EXPECT_TRUE(set.update(inside, {}, 1e-6));
  ASSERT_EQ(set.contacts().size(), 1U);
  const Contact contact = set.contacts()[0];
  EXPECT_EQ(contact.vertices[0], 4);
  EXPECT_DOUBLE_EQ(contact.offset, 1e-7);  // a little outside the surface
  EXPECT_NEAR(depth<double>(contact, inside), 0.1 / std::sqrt(3.0) + 1e-7, 1e-12);
  EXPECT_LT(depth<double>(contact, from), 0.0);
}

TEST(ContactSet, AVertexThatWasInsideComesHalfOfTheWay) {
  const TwoTetrahedra body;
  ContactSet set = body.contacts();
  const AlignedVector<double> from = body.with_vertex_at(0.3);
  set.begin(from);
  (void)set.update(body.with_vertex_at(0.28), {}, 1e-6);
  ASSERT_EQ(set.contacts().size(), 1U);
  EXPECT_NEAR(depth<double>(set.contacts()[0], from), 0.05 / std::sqrt(3.0) + 1e-6, 1e-12);
  // a vertex near the surface comes all of the way
  const AlignedVector<double> almost = body.with_vertex_at(1.0 / 3 - 1e-7);
  set.begin(almost);
  (void)set.update(body.with_vertex_at(0.28), {}, 1e-6);
  ASSERT_EQ(set.contacts().size(), 1U);
  EXPECT_DOUBLE_EQ(set.contacts()[0].offset, 1e-7);
}

TEST(ContactSet, KeepsAContactOfTheBodyForAsLongAsItPushes) {
  const TwoTetrahedra body;
  ContactSet set = body.contacts();
  const AlignedVector<double> from = body.with_vertex_at(0.5);
  const AlignedVector<double> outside = body.with_vertex_at(0.34);
  set.begin(from);
  (void)set.update(body.with_vertex_at(0.3), {}, 1e-6);
  EXPECT_FALSE(set.update(outside, std::vector{2.0}, 1e-6));  // pushed out, and held there from now on
  ASSERT_EQ(set.contacts().size(), 1U);
  // its normal follows the triangle: the corner 3 comes nearer
  AlignedVector<double> turned = outside;
  turned[4 * 3 + 2] = 0.9;
  EXPECT_FALSE(set.update(turned, std::vector{1.0}, 1e-6));
  ASSERT_EQ(set.contacts().size(), 1U);
  const Point& normal = set.contacts()[0].normal;
  EXPECT_NEAR(normal[2] / normal[0], 1 / 0.9, 1e-12);
  EXPECT_NEAR(normal[1] / normal[0], 1.0, 1e-12);
  // a contact without force is removed
  EXPECT_FALSE(set.update(outside, std::vector{0.0}, 1e-6));
  EXPECT_TRUE(set.contacts().empty());
  // and so is a contact of an earlier step
  (void)set.update(body.with_vertex_at(0.3), {}, 1e-6);
  set.begin(from);
  EXPECT_FALSE(set.update(outside, std::vector{1.0}, 1e-6));
  EXPECT_TRUE(set.contacts().empty());
}

TEST(ContactSet, ListsThoseWithObstaclesAndTheBodyByVertex) {
  TwoTetrahedra body;
  ContactSet set = body.contacts();
  const AlignedVector<double> from = body.with_vertex_at(0.5);
  AlignedVector<double> positions = body.with_vertex_at(0.3);
  positions[4 * 2 + 2] = -1.05;  // vertex 2 below the floor
  positions[4 * 6 + 2] = -0.95;  // vertex 6 within reach of it
  set.begin(from);
  EXPECT_TRUE(set.update(positions, {}, 1e-6));
  EXPECT_EQ(set.contacts().front().vertices[0], 2);
  EXPECT_EQ(set.contacts().back().vertices[0], 6);
  EXPECT_NEAR(depth<double>(set.contacts().front(), positions), 0.05, 1e-12);
  EXPECT_NEAR(depth<double>(set.contacts().back(), positions), -0.05, 1e-12);
}

}  // namespace
}  // namespace meshorder
