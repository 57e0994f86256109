// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cells/polyhedron.hpp"

#include <algorithm>
#include <utility>

namespace meshorder {
namespace {

constexpr std::size_t kMostFaces = 6;
constexpr std::size_t kMostCorners = 4;
constexpr std::size_t kNoTwin = kMostFaces * kMostCorners;

/// An edge of a face, directed as the face lists its corners.
struct FaceEdge {
  Index from;
  Index to;
  std::size_t face;
  std::size_t twin = kNoTwin;  ///< index in `edges_` of the same edge in another face
};

/// A standard shape, described by its faces.
struct FacePattern {
  std::size_t triangles;
  std::size_t quads;
  Shape shape;
  std::size_t base;  ///< number of corners of the cell's first face
  int size;
};
constexpr std::array kPatterns{FacePattern{4, 0, Shape::tetrahedron, 3, 4},
                               FacePattern{4, 1, Shape::pyramid, 4, 5}, FacePattern{2, 3, Shape::wedge, 3, 6},
                               FacePattern{0, 6, Shape::hexahedron, 4, 8}};

bool holds_corner(std::span<const Index> corners, Index corner) {
  return std::find(corners.begin(), corners.end(), corner) != corners.end();
}

/// A polyhedron with few enough faces to be a standard shape.
class FewFaces {
 public:
  explicit FewFaces(std::span<const PolyhedronFace> faces) : faces_(faces) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const std::span<const Index> corners = faces[f].corners;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        edges_[edge_count_++] = {corners[k], corners[(k + 1) % corners.size()], f};
      }
    }
  }

  CellOfFaces cell() {
    CellOfFaces result;
    if (!match_edges()) {
      result.kind = CellOfFaces::Kind::open;
      return result;
    }
    if (!orient()) return result;
    const auto triangles = static_cast<std::size_t>(std::count_if(
        faces_.begin(), faces_.end(), [](const PolyhedronFace& face) { return face.corners.size() == 3; }));
    const auto* const pattern = std::find_if(kPatterns.begin(), kPatterns.end(), [&](const FacePattern& one) {
      return one.triangles == triangles && one.quads == faces_.size() - triangles;
    });
    if (pattern == kPatterns.end() || !build(*pattern, result)) return result;
    result.kind = CellOfFaces::Kind::standard;
    result.shape = pattern->shape;
    result.size = pattern->size;
    result.signs_agree = true;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      result.signs_agree = result.signs_agree && is_turned_[f] == faces_[f].is_inward;
    }
    return result;
  }

 private:
  /// Finds the twin of each edge; returns false unless each edge belongs to exactly two faces.
  bool match_edges() {
    for (std::size_t i = 0; i < edge_count_; ++i) {
      FaceEdge& edge = edges_[i];
      for (std::size_t j = i + 1; j < edge_count_; ++j) {
        FaceEdge& other = edges_[j];
        const bool is_same = (edge.from == other.from && edge.to == other.to) ||
                             (edge.from == other.to && edge.to == other.from);
        if (!is_same) continue;
        if (edge.twin != kNoTwin || other.twin != kNoTwin || other.face == edge.face) return false;
        edge.twin = j;
        other.twin = i;
      }
      if (edge.twin == kNoTwin) return false;
    }
    return true;
  }

  /// Orients all faces like the first one; returns false if they are not connected or not orientable.
  bool orient() {
    std::array<bool, kMostFaces> is_known{};
    is_known[0] = true;
    is_turned_[0] = faces_[0].is_inward;
    for (std::size_t round = 1; round < faces_.size(); ++round) {
      for (std::size_t i = 0; i < edge_count_; ++i) {
        const FaceEdge& edge = edges_[i];
        const FaceEdge& other = edges_[edge.twin];
        if (!is_known[edge.face] || is_known[other.face]) continue;
        is_known[other.face] = true;
        is_turned_[other.face] = is_turned_[edge.face] == (edge.from != other.from);
      }
    }
    for (std::size_t i = 0; i < edge_count_; ++i) {
      const FaceEdge& edge = edges_[i];
      const FaceEdge& other = edges_[edge.twin];
      if (!is_known[edge.face]) return false;
      if ((is_turned_[edge.face] == is_turned_[other.face]) == (edge.from == other.from)) return false;
    }
    return true;
  }

  /// Returns the corner outside `base` that an edge joins with `corner`; −1 unless there is exactly one.
  [[nodiscard]] Index corner_above(Index corner, std::span<const Index> base) const {
    Index above = -1;
    for (std::size_t i = 0; i < edge_count_; ++i) {
      if (edges_[i].from != corner && edges_[i].to != corner) continue;
      const Index end = edges_[i].from == corner ? edges_[i].to : edges_[i].from;
      if (holds_corner(base, end)) continue;
      if (above >= 0 && end != above) return -1;
      above = end;
    }
    return above;
  }

  /// Fills in the corners of a cell; returns false if the faces are not connected like the faces of the
  /// shape.
  bool build(const FacePattern& pattern, CellOfFaces& cell) const {
    const auto first = static_cast<std::size_t>(
        std::find_if(faces_.begin(), faces_.end(),
                     [&](const PolyhedronFace& face) { return face.corners.size() == pattern.base; }) -
        faces_.begin());
    const std::size_t n = pattern.base;
    const std::span<const Index> base = faces_[first].corners;
    // the normal of the first face of a cell points into the cell
    for (std::size_t k = 0; k < n; ++k) cell.corners[k] = base[is_turned_[first] ? k : (n - k) % n];
    const bool has_apex = static_cast<std::size_t>(pattern.size) == n + 1;
    std::array<Index, kMostCorners> above{};
    for (std::size_t k = 0; k < n; ++k) {
      above[k] = corner_above(cell.corners[k], base);
      if (above[k] < 0 || (has_apex ? above[k] != above[0] : holds_corner({above.data(), k}, above[k]))) {
        return false;
      }
      if (!has_apex || k == 0) cell.corners[n + k] = above[k];
    }
    // each side has an edge of the first face and the corners above the ends of that edge
    for (std::size_t k = 0; k < n; ++k) {
      const Index from = cell.corners[k];
      const Index to = cell.corners[(k + 1) % n];
      const auto is_side = [&](const PolyhedronFace& face) {
        return face.corners.size() == (has_apex ? 3U : 4U) && holds_corner(face.corners, from) &&
               holds_corner(face.corners, to) && holds_corner(face.corners, above[k]) &&
               holds_corner(face.corners, above[(k + 1) % n]);
      };
      if (std::count_if(faces_.begin(), faces_.end(), is_side) != 1) return false;
    }
    return true;
  }

  std::span<const PolyhedronFace> faces_;
  std::array<FaceEdge, kMostFaces * kMostCorners> edges_{};
  std::size_t edge_count_ = 0;
  std::array<bool, kMostFaces> is_turned_{};  ///< for each face, the `is_inward` that fits the first face's
};

}  // namespace

CellOfFaces cell_of_faces(std::span<const PolyhedronFace> faces) {
  CellOfFaces result;
  constexpr std::size_t kFewest = 4;
  if (faces.size() < kFewest) {
    result.kind = CellOfFaces::Kind::open;
    return result;
  }
  const bool may_be_standard =
      faces.size() <= kMostFaces && std::all_of(faces.begin(), faces.end(), [](const PolyhedronFace& face) {
        return face.corners.size() >= 3 && face.corners.size() <= kMostCorners;
      });
  return may_be_standard ? FewFaces(faces).cell() : result;
}

void turn_inside_out(Shape shape, std::span<Index> corners) {
  switch (shape) {
    case Shape::tetrahedron:
      return std::swap(corners[1], corners[2]);
    case Shape::pyramid:
      return std::swap(corners[1], corners[3]);
    case Shape::wedge:
      std::swap(corners[1], corners[2]);
      return std::swap(corners[4], corners[5]);
    case Shape::hexahedron:
      std::swap(corners[1], corners[3]);
      return std::swap(corners[5], corners[7]);
    default:
      return;
  }
}

}  // namespace meshorder
