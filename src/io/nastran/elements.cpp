// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Elements and the order of their nodes: MSC Nastran Quick Reference Guide, "Bulk Data Entries".
#include "io/nastran/elements.hpp"

#include <algorithm>
#include <array>

namespace meshorder::nastran {
namespace {

constexpr std::array kTypes{
    ElementType{"CTETRA", Shape::tetrahedron, 4, 10},
    ElementType{"CHEXA", Shape::hexahedron, 8, 20},
    ElementType{"CPENTA", Shape::wedge, 6, 15},
    ElementType{"CPYRAM", Shape::pyramid, 5, 13},
    ElementType{"CPYRA", Shape::pyramid, 5, 13},
    ElementType{"CTRIA3", Shape::triangle, 3, 3},
    ElementType{"CTRIAR", Shape::triangle, 3, 3},
    ElementType{"CTRIA6", Shape::triangle, 3, 6},
    ElementType{"CQUAD4", Shape::quad, 4, 4},
    ElementType{"CQUADR", Shape::quad, 4, 4},
    ElementType{"CQUAD8", Shape::quad, 4, 8},
    ElementType{"CQUAD", Shape::quad, 4, 9},
    ElementType{"CSHEAR", Shape::quad, 4, 4},
    ElementType{"CROD", Shape::line, 2, 2},
    ElementType{"CTUBE", Shape::line, 2, 2},
    ElementType{"CONROD", Shape::line, 2, 2, false},
    ElementType{"CBAR", Shape::line, 2, 2, true, Extra::orientation},
    ElementType{"CBEAM", Shape::line, 2, 2, true, Extra::warping},
    ElementType{"CBUSH", Shape::line, 2, 2, true, Extra::orientation},
};

}  // namespace

const ElementType* element_type(std::string_view name) {
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const ElementType& type) { return type.name == name; });
  return found == kTypes.end() ? nullptr : found;
}

bool has_size(const ElementType& type, int nodes) {
  const bool without_middle = type.shape == Shape::quad && type.most == 9 && nodes == 8;
  return nodes == type.corners || nodes == type.most || without_middle;
}

std::string_view card_of(Shape shape, int nodes) {
  struct Choice {
    Shape shape;
    int nodes;
    std::string_view card;
  };
  constexpr std::array kChoices{
      Choice{Shape::line, 2, "CROD"},           Choice{Shape::triangle, 3, "CTRIA3"},
      Choice{Shape::triangle, 6, "CTRIA6"},     Choice{Shape::quad, 4, "CQUAD4"},
      Choice{Shape::quad, 8, "CQUAD8"},         Choice{Shape::tetrahedron, 4, "CTETRA"},
      Choice{Shape::tetrahedron, 10, "CTETRA"}, Choice{Shape::pyramid, 5, "CPYRAM"},
      Choice{Shape::pyramid, 13, "CPYRAM"},     Choice{Shape::wedge, 6, "CPENTA"},
      Choice{Shape::wedge, 15, "CPENTA"},       Choice{Shape::hexahedron, 8, "CHEXA"},
      Choice{Shape::hexahedron, 20, "CHEXA"},
  };
  for (const Choice& choice : kChoices) {
    if (choice.shape == shape && choice.nodes == nodes) return choice.card;
  }
  return {};
}

std::size_t node_place(Shape shape, int nodes, std::size_t k) {
  const bool is_bent = (shape == Shape::hexahedron && nodes == 20) || (shape == Shape::wedge && nodes == 15);
  if (!is_bent) return k;
  const std::size_t edges = shape == Shape::hexahedron ? 4 : 3;  // number of edges of the bottom face
  const std::size_t top = 3 * edges;                             // VTK's edges of the top begin here
  if (k < top) return k;
  return k < top + edges ? k + edges : k - edges;
}

}  // namespace meshorder::nastran
