// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Types of elements and the order of their nodes: Abaqus Analysis User's Guide, "Elements"; G. Dhondt,
// CalculiX CrunchiX User's Manual, "Element Types".
#include "io/abaqus/elements.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>

namespace meshorder::abaqus {
namespace {

/// Meaning of the digits in a type's name: the number of nodes or, for beams, the interpolation.
enum class Family : std::uint8_t { solid, surface, line, beam };

/// The part of a type's name before the digits.
struct Prefix {
  std::string_view name;
  Family family;
};

constexpr std::array kPrefixes{
    Prefix{"C3D", Family::solid},     Prefix{"DC3D", Family::solid},    Prefix{"DCC3D", Family::solid},
    Prefix{"AC3D", Family::solid},    Prefix{"F3D", Family::solid},     Prefix{"FC3D", Family::solid},
    Prefix{"EC3D", Family::solid},    Prefix{"EMC3D", Family::solid},   Prefix{"Q3D", Family::solid},
    Prefix{"COH3D", Family::solid},   Prefix{"SC", Family::solid},      Prefix{"CSS", Family::solid},
    Prefix{"S", Family::surface},     Prefix{"DS", Family::surface},    Prefix{"STRI", Family::surface},
    Prefix{"M3D", Family::surface},   Prefix{"SFM3D", Family::surface}, Prefix{"R3D", Family::surface},
    Prefix{"CPS", Family::surface},   Prefix{"CPE", Family::surface},   Prefix{"CPEG", Family::surface},
    Prefix{"CAX", Family::surface},   Prefix{"CGAX", Family::surface},  Prefix{"DC2D", Family::surface},
    Prefix{"DCC2D", Family::surface}, Prefix{"DCAX", Family::surface},  Prefix{"DCCAX", Family::surface},
    Prefix{"AC2D", Family::surface},  Prefix{"ACAX", Family::surface},  Prefix{"COH2D", Family::surface},
    Prefix{"COHAX", Family::surface}, Prefix{"T2D", Family::line},      Prefix{"T3D", Family::line},
    Prefix{"DC1D", Family::line},     Prefix{"DCC1D", Family::line},    Prefix{"AC1D", Family::line},
    Prefix{"SAX", Family::beam},      Prefix{"DSAX", Family::beam},     Prefix{"MAX", Family::beam},
    Prefix{"R2D", Family::line},      Prefix{"RAX", Family::line},      Prefix{"RB2D", Family::line},
    Prefix{"RB3D", Family::line},     Prefix{"B", Family::beam},        Prefix{"PIPE", Family::beam},
    Prefix{"ELBOW", Family::beam},
};

/// Types whose names follow no rule.
constexpr std::array kOthers{
    std::pair{std::string_view{"STRI65"}, ElementKind{Shape::triangle, 6}},
    std::pair{std::string_view{"SPRINGA"}, ElementKind{Shape::line, 2}},
    std::pair{std::string_view{"SPRING2"}, ElementKind{Shape::line, 2}},
    std::pair{std::string_view{"DASHPOTA"}, ElementKind{Shape::line, 2}},
    std::pair{std::string_view{"DASHPOT2"}, ElementKind{Shape::line, 2}},
    std::pair{std::string_view{"GAPUNI"}, ElementKind{Shape::line, 2}},
    std::pair{std::string_view{"SPRING1"}, ElementKind{Shape::vertex, 1}},
    std::pair{std::string_view{"DASHPOT1"}, ElementKind{Shape::vertex, 1}},
    std::pair{std::string_view{"MASS"}, ElementKind{Shape::vertex, 1}},
    std::pair{std::string_view{"ROTARYI"}, ElementKind{Shape::vertex, 1}},
    std::pair{std::string_view{"HEATCAP"}, ElementKind{Shape::vertex, 1}},
    std::pair{std::string_view{"DCOUP3D"}, ElementKind{Shape::vertex, 1}},
};

constexpr std::array kSolids{
    ElementKind{Shape::tetrahedron, 4}, ElementKind{Shape::pyramid, 5},      ElementKind{Shape::wedge, 6},
    ElementKind{Shape::hexahedron, 8},  ElementKind{Shape::tetrahedron, 10}, ElementKind{Shape::pyramid, 13},
    ElementKind{Shape::wedge, 15},      ElementKind{Shape::hexahedron, 20},
};
constexpr std::array kSurfaces{
    ElementKind{Shape::triangle, 3}, ElementKind{Shape::quad, 4}, ElementKind{Shape::triangle, 6},
    ElementKind{Shape::quad, 8},     ElementKind{Shape::quad, 9},
};
constexpr std::array kLines{ElementKind{Shape::line, 2}, ElementKind{Shape::line, 3}};

template <class Kinds>
std::optional<ElementKind> with_nodes(const Kinds& kinds, int nodes) {
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](ElementKind kind) { return kind.nodes == nodes; });
  return found == kinds.end() ? std::nullopt : std::optional(*found);
}

/// Returns the number of nodes of a beam whose name has these digits. The last digit is the order of
/// interpolation: beams of order 1 and 3 (cubic) have two nodes, beams of order 2 have three.
int nodes_of_beam(int digits) { return digits % 10 == 2 ? 3 : 2; }

std::optional<ElementKind> kind_in_family(Family family, int digits) {
  switch (family) {
    case Family::solid:
      return with_nodes(kSolids, digits);
    case Family::surface:
      return with_nodes(kSurfaces, digits);
    case Family::line:
      return with_nodes(kLines, digits);
    case Family::beam:
      return with_nodes(kLines, nodes_of_beam(digits));
  }
  return {};
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Returns the digits at the front as a number; nullopt if the text does not begin with a digit.
std::optional<int> leading_number(std::string_view rest) {
  int number = 0;
  const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  const bool is_number = code == std::errc{} && is_digit(rest.front());
  return is_number ? std::optional(number) : std::nullopt;
}

}  // namespace

std::optional<ElementKind> kind_of(std::string_view type) {
  for (const auto& [name, kind] : kOthers) {
    if (name == type) return kind;
  }
  for (const Prefix& prefix : kPrefixes) {
    if (!type.starts_with(prefix.name)) continue;
    const std::string_view rest = type.substr(prefix.name.size());
    if (const auto number = leading_number(rest)) return kind_in_family(prefix.family, *number);
  }
  return {};
}

std::string_view type_of(ElementKind kind, bool flat) {
  struct Choice {
    ElementKind kind;
    std::string_view in_space;
    std::string_view in_plane;
  };
  constexpr std::array kChoices{
      Choice{{Shape::line, 2}, "T3D2", "T2D2"},
      Choice{{Shape::line, 3}, "T3D3", "T2D3"},
      Choice{{Shape::triangle, 3}, "S3", "CPS3"},
      Choice{{Shape::triangle, 6}, "STRI65", "CPS6"},
      Choice{{Shape::quad, 4}, "S4", "CPS4"},
      Choice{{Shape::quad, 8}, "S8R", "CPS8"},
      Choice{{Shape::quad, 9}, "S9R5", "S9R5"},
      Choice{{Shape::tetrahedron, 4}, "C3D4", "C3D4"},
      Choice{{Shape::tetrahedron, 10}, "C3D10", "C3D10"},
      Choice{{Shape::pyramid, 5}, "C3D5", "C3D5"},
      Choice{{Shape::wedge, 6}, "C3D6", "C3D6"},
      Choice{{Shape::wedge, 15}, "C3D15", "C3D15"},
      Choice{{Shape::hexahedron, 8}, "C3D8", "C3D8"},
      Choice{{Shape::hexahedron, 20}, "C3D20", "C3D20"},
  };
  for (const Choice& choice : kChoices) {
    if (choice.kind == kind) return flat ? choice.in_plane : choice.in_space;
  }
  return {};
}

}  // namespace meshorder::abaqus
