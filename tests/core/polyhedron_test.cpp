// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cells/polyhedron.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

namespace meshorder {
namespace {

using Corners = std::vector<std::vector<Index>>;

struct Standard {
  Shape shape;
  int vertices;
};
constexpr std::array kStandards{Standard{Shape::tetrahedron, 4}, Standard{Shape::pyramid, 5},
                                Standard{Shape::wedge, 6}, Standard{Shape::hexahedron, 8}};

/// The faces of a cell with vertices 10, 11, …, with outward normals.
Corners outward_faces(Shape shape) {
  switch (shape) {
    case Shape::tetrahedron:
      return {{10, 12, 11}, {10, 11, 13}, {11, 12, 13}, {12, 10, 13}};
    case Shape::pyramid:
      return {{10, 13, 12, 11}, {10, 11, 14}, {11, 12, 14}, {12, 13, 14}, {13, 10, 14}};
    case Shape::wedge:
      return {{10, 12, 11}, {13, 14, 15}, {10, 11, 14, 13}, {11, 12, 15, 14}, {12, 10, 13, 15}};
    default:
      return {{10, 13, 12, 11}, {14, 15, 16, 17}, {10, 11, 15, 14},
              {11, 12, 16, 15}, {12, 13, 17, 16}, {13, 10, 14, 17}};
  }
}

/// The face, rotated to begin with its lowest corner.
std::vector<Index> from_lowest(std::vector<Index> face) {
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

std::set<std::vector<Index>> outward_faces_of(const CellOfFaces& cell) {
  std::set<std::vector<Index>> faces;
  for (std::vector<Index> face : outward_faces(cell.shape)) {
    for (Index& corner : face) corner = cell.corners[static_cast<std::size_t>(corner - 10)];
    faces.insert(from_lowest(std::move(face)));
  }
  return faces;
}

std::vector<PolyhedronFace> with_signs(const Corners& faces, const std::vector<bool>& inward) {
  std::vector<PolyhedronFace> result;
  for (std::size_t f = 0; f < faces.size(); ++f) result.push_back({faces[f], inward[f]});
  return result;
}

TEST(Polyhedron, FacesInAnyOrderAndDirectionGiveTheCell) {
  std::mt19937 chance(1);
  for (const Standard& standard : kStandards) {
    for (int trial = 0; trial < 200; ++trial) {
      Corners faces = outward_faces(standard.shape);
      std::set<std::vector<Index>> expected;
      for (const auto& face : faces) expected.insert(from_lowest(face));
      std::shuffle(faces.begin(), faces.end(), chance);
      std::vector<bool> inward;
      for (auto& face : faces) {
        std::rotate(face.begin(), face.begin() + static_cast<int>(chance() % face.size()), face.end());
        inward.push_back(chance() % 2 == 0);
        if (inward.back()) std::reverse(face.begin(), face.end());
      }
      const CellOfFaces cell = cell_of_faces(with_signs(faces, inward));
      ASSERT_EQ(cell.kind, CellOfFaces::Kind::standard);
      EXPECT_EQ(cell.shape, standard.shape);
      EXPECT_EQ(cell.size, standard.vertices);
      EXPECT_TRUE(cell.signs_agree);
      EXPECT_EQ(outward_faces_of(cell), expected);

      // a wrong sign is detected; at worst it turns the cell inside out
      inward[chance() % inward.size()].flip();
      CellOfFaces other = cell_of_faces(with_signs(faces, inward));
      ASSERT_EQ(other.kind, CellOfFaces::Kind::standard);
      EXPECT_FALSE(other.signs_agree);
      if (outward_faces_of(other) != expected) {
        turn_inside_out(other.shape, {other.corners.data(), static_cast<std::size_t>(other.size)});
      }
      EXPECT_EQ(outward_faces_of(other), expected);
    }
  }
}

TEST(Polyhedron, AMissingFaceLeavesItOpen) {
  for (const Standard& standard : kStandards) {
    Corners faces = outward_faces(standard.shape);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      Corners fewer = faces;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(f));
      EXPECT_EQ(cell_of_faces(with_signs(fewer, std::vector<bool>(fewer.size()))).kind,
                CellOfFaces::Kind::open);
      fewer.push_back(fewer.front());
      EXPECT_EQ(cell_of_faces(with_signs(fewer, std::vector<bool>(fewer.size()))).kind,
                CellOfFaces::Kind::open);
    }
  }
}

TEST(Polyhedron, OtherPatternsAreNoCells) {
  const auto kind_of = [](const Corners& faces) {
    return cell_of_faces(with_signs(faces, std::vector<bool>(faces.size()))).kind;
  };
  // two tetrahedra with a common face; a cube with a face cut in two; a cube with a corner cut off
  EXPECT_EQ(kind_of({{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}}),
            CellOfFaces::Kind::other);
  EXPECT_EQ(
      kind_of({{0, 3, 2, 1}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}),
      CellOfFaces::Kind::other);
  EXPECT_EQ(kind_of({{0, 1, 2, 3, 4}, {0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 0, 5}}),
            CellOfFaces::Kind::other);
  // slices of an orange: as many faces, edges and corners as a cube
  EXPECT_EQ(kind_of({{0, 2, 1, 3}, {0, 3, 1, 4}, {0, 4, 1, 5}, {0, 5, 1, 6}, {0, 6, 1, 7}, {0, 7, 1, 2}}),
            CellOfFaces::Kind::other);
  // two tetrahedra that share no corner
  EXPECT_NE(kind_of({{0, 2, 1}, {0, 1, 3}, {4, 6, 5}, {4, 5, 7}}), CellOfFaces::Kind::standard);
  EXPECT_EQ(kind_of({{0, 1, 2}, {0, 2, 1}}), CellOfFaces::Kind::open);
}

}  // namespace
}  // namespace meshorder
