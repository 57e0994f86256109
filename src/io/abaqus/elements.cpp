// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Types of elements and the order of their nodes: Abaqus Analysis User's Guide, "Elements"; G. Dhondt,
// CalculiX CrunchiX User's Manual, "Element Types".
#include "io/abaqus/elements.hpp"

#include <array>
#include <charconv>
#include <system_error>

namespace meshorder::abaqus {
namespace {

/// The part of a type's name before the digits. These digits are the number of nodes. In names of beams, the
/// last digit is the order of interpolation: beams of order 1 and 3 (cubic) have two nodes, beams of order 2
/// have three.
struct Prefix {
  std::string_view name;
  int dimension;
  bool is_beam = false;
};

constexpr std::array kPrefixes{
    Prefix{"C3D", 3},        Prefix{"DC3D", 3},        Prefix{"DCC3D", 3},     Prefix{"AC3D", 3},
    Prefix{"F3D", 3},        Prefix{"FC3D", 3},        Prefix{"EC3D", 3},      Prefix{"EMC3D", 3},
    Prefix{"Q3D", 3},        Prefix{"COH3D", 3},       Prefix{"SC", 3},        Prefix{"CSS", 3},
    Prefix{"S", 2},          Prefix{"DS", 2},          Prefix{"STRI", 2},      Prefix{"M3D", 2},
    Prefix{"SFM3D", 2},      Prefix{"R3D", 2},         Prefix{"CPS", 2},       Prefix{"CPE", 2},
    Prefix{"CPEG", 2},       Prefix{"CAX", 2},         Prefix{"CGAX", 2},      Prefix{"DC2D", 2},
    Prefix{"DCC2D", 2},      Prefix{"DCAX", 2},        Prefix{"DCCAX", 2},     Prefix{"AC2D", 2},
    Prefix{"ACAX", 2},       Prefix{"COH2D", 2},       Prefix{"COHAX", 2},     Prefix{"T2D", 1},
    Prefix{"T3D", 1},        Prefix{"DC1D", 1},        Prefix{"DCC1D", 1},     Prefix{"AC1D", 1},
    Prefix{"SAX", 1, true},  Prefix{"DSAX", 1, true},  Prefix{"MAX", 1, true}, Prefix{"R2D", 1},
    Prefix{"RAX", 1},        Prefix{"RB2D", 1},        Prefix{"RB3D", 1},      Prefix{"B", 1, true},
    Prefix{"PIPE", 1, true}, Prefix{"ELBOW", 1, true},
};

struct NamedKind {
  std::string_view type;
  ElementKind kind;
};

/// Types whose names follow no rule.
constexpr std::array kOthers{
    NamedKind{"STRI65", {Shape::triangle, 6}}, NamedKind{"SPRINGA", {Shape::line, 2}},
    NamedKind{"SPRING2", {Shape::line, 2}},    NamedKind{"DASHPOTA", {Shape::line, 2}},
    NamedKind{"DASHPOT2", {Shape::line, 2}},   NamedKind{"GAPUNI", {Shape::line, 2}},
    NamedKind{"SPRING1", {Shape::vertex, 1}},  NamedKind{"DASHPOT1", {Shape::vertex, 1}},
    NamedKind{"MASS", {Shape::vertex, 1}},     NamedKind{"ROTARYI", {Shape::vertex, 1}},
    NamedKind{"HEATCAP", {Shape::vertex, 1}},  NamedKind{"DCOUP3D", {Shape::vertex, 1}},
};

/// The types that are written for cells.
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
    Choice{{Shape::pyramid, 13}, {}, {}},  // read only
    Choice{{Shape::wedge, 6}, "C3D6", "C3D6"},
    Choice{{Shape::wedge, 15}, "C3D15", "C3D15"},
    Choice{{Shape::hexahedron, 8}, "C3D8", "C3D8"},
    Choice{{Shape::hexahedron, 20}, "C3D20", "C3D20"},
};

/// Returns the digits at the front as a number; nullopt if the text does not begin with a digit.
std::optional<int> leading_number(std::string_view rest) {
  int number = 0;
  const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  const bool is_number = code == std::errc{} && rest.front() != '-';
  return is_number ? std::optional(number) : std::nullopt;
}

}  // namespace

std::optional<ElementKind> kind_of(std::string_view type) {
  for (const NamedKind& other : kOthers) {
    if (other.type == type) return other.kind;
  }
  for (const Prefix& prefix : kPrefixes) {
    if (!type.starts_with(prefix.name)) continue;
    const auto number = leading_number(type.substr(prefix.name.size()));
    if (!number) continue;
    const int nodes = !prefix.is_beam ? *number : *number % 10 == 2 ? 3 : 2;
    for (const Choice& choice : kChoices) {
      const bool fits = dimension(choice.kind.shape) == prefix.dimension && choice.kind.nodes == nodes;
      if (fits) return choice.kind;
    }
    return {};
  }
  return {};
}

std::string_view type_of(ElementKind kind, bool flat) {
  for (const Choice& choice : kChoices) {
    if (choice.kind == kind) return flat ? choice.in_plane : choice.in_space;
  }
  return {};
}

}  // namespace meshorder::abaqus
