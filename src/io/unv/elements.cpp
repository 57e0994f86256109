// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Types of elements: SDRC, I-deas Universal File Datasets, "2412 Elements".
#include "io/unv/elements.hpp"

#include <algorithm>
#include <array>

namespace meshorder::unv {
namespace {

/// A range of types whose cells have the same dimension; the number of nodes then gives the shape. The type
/// does not give the shape: documents and programs disagree on linear and parabolic membranes (71 to 75).
struct Family {
  int first;
  int last;
  int dimension;
};

constexpr std::array kFamilies{
    Family{11, 11, 1},    // rods
    Family{21, 25, 1},    // beams
    Family{31, 32, 1},    // pipes
    Family{41, 46, 2},    // plane stress
    Family{51, 56, 2},    // plane strain
    Family{61, 66, 2},    // plates
    Family{71, 76, 2},    // membranes
    Family{81, 86, 2},    // axisymmetric solids
    Family{91, 96, 2},    // thin shells
    Family{101, 106, 3},  // thick shells
    Family{111, 119, 3},  // solids
    Family{121, 121, 1},  // rigid bars
    Family{136, 137, 1},  // springs between nodes
    Family{138, 140, 0},  // springs to the ground
    Family{141, 141, 1},  // dampers between nodes
    Family{142, 142, 0},  // dampers to the ground
    Family{151, 151, 1},  // gaps between nodes
    Family{152, 152, 0},  // gaps to the ground
    Family{161, 161, 0},  // lumped masses
    Family{171, 172, 1},  // axisymmetric shells
};

struct Kind {
  ElementKind kind;
  int type;  ///< type that is written; 0: none
};

constexpr std::array kKinds{
    Kind{{Shape::vertex, 1}, 0},         Kind{{Shape::line, 2}, 21},
    Kind{{Shape::line, 3}, 24},          Kind{{Shape::triangle, 3}, 91},
    Kind{{Shape::triangle, 6}, 92},      Kind{{Shape::quad, 4}, 94},
    Kind{{Shape::quad, 8}, 95},          Kind{{Shape::tetrahedron, 4}, 111},
    Kind{{Shape::tetrahedron, 10}, 118}, Kind{{Shape::wedge, 6}, 112},
    Kind{{Shape::wedge, 15}, 113},       Kind{{Shape::hexahedron, 8}, 115},
    Kind{{Shape::hexahedron, 20}, 116},
};

constexpr std::array kLine3{0, 2, 1};
constexpr std::array kTriangle6{0, 3, 1, 4, 2, 5};
constexpr std::array kQuad8{0, 4, 1, 5, 2, 6, 3, 7};
// volumes: the nodes around the first face, then the middle nodes of edges that leave it, then all other
// nodes
constexpr std::array kTetrahedron10{0, 4, 1, 5, 2, 6, 7, 8, 9, 3};
constexpr std::array kWedge15{0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11};
constexpr std::array kHexahedron20{0, 8, 1, 9, 2, 10, 3, 11, 16, 17, 18, 19, 4, 12, 5, 13, 6, 14, 7, 15};

}  // namespace

std::optional<ElementKind> kind_of(std::int64_t type, std::int64_t nodes) {
  const auto family = std::find_if(kFamilies.begin(), kFamilies.end(),
                                   [&](const Family& of) { return type >= of.first && type <= of.last; });
  if (family == kFamilies.end()) return {};
  const auto found = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& kind) {
    return kind.kind.nodes == nodes && dimension(kind.kind.shape) == family->dimension;
  });
  return found == kKinds.end() ? std::nullopt : std::optional(found->kind);
}

int type_of(ElementKind kind) {
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& known) { return known.kind == kind; });
  return found == kKinds.end() ? 0 : found->type;
}

bool is_beam(std::int64_t type) { return type >= 21 && type <= 25; }

std::span<const int> file_order(ElementKind kind) {
  if (kind == ElementKind{Shape::line, 3}) return kLine3;
  if (kind == ElementKind{Shape::triangle, 6}) return kTriangle6;
  if (kind == ElementKind{Shape::quad, 8}) return kQuad8;
  if (kind == ElementKind{Shape::tetrahedron, 10}) return kTetrahedron10;
  if (kind == ElementKind{Shape::wedge, 15}) return kWedge15;
  if (kind == ElementKind{Shape::hexahedron, 20}) return kHexahedron20;
  return {};
}

}  // namespace meshorder::unv
