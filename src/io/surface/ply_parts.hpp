// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include <meshorder/mesh.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Declarations shared by the reader and the writer of PLY files.
namespace meshorder::ply {

enum class Encoding : std::uint8_t { ascii, little_endian, big_endian };

/// Types of numbers, in the order of Values.
enum class Type : std::uint8_t { float64, float32, int8, uint8, int16, uint16, int32, uint32 };

/// The words for each type in a header, the usual one first.
inline constexpr std::array<std::array<std::string_view, 2>, 8> kTypeWords{{{"double", "float64"},
                                                                            {"float", "float32"},
                                                                            {"char", "int8"},
                                                                            {"uchar", "uint8"},
                                                                            {"short", "int16"},
                                                                            {"ushort", "uint16"},
                                                                            {"int", "int32"},
                                                                            {"uint", "uint32"}}};

inline bool is_integer(Type type) { return type > Type::float32; }

/// Returns `work(zero)`, where `zero` is a 0 of the type.
template <class Work>
auto with_type(Type type, const Work& work) {
  switch (type) {
    case Type::float64:
      break;
    case Type::float32:
      return work(0.0F);
    case Type::int8:
      return work(std::int8_t{});
    case Type::uint8:
      return work(std::uint8_t{});
    case Type::int16:
      return work(std::int16_t{});
    case Type::uint16:
      return work(std::uint16_t{});
    case Type::int32:
      return work(std::int32_t{});
    case Type::uint32:
      return work(std::uint32_t{});
  }
  return work(0.0);
}

/// A number type as a header spells it: "uchar" or "uint8".
struct TypeWord {
  std::string word;
  Type type = Type::int32;
};

struct Property {
  std::string name;
  TypeWord type;
  bool is_list = false;
  TypeWord count_type;  ///< type of the length of a list
  std::string why_left_out =
      {};                     ///< of vertices and cells: why the property is read but not kept; else empty
  bool numbers_rows = false;  ///< in rows that go with faces: whether the values are 0, 1, 2 …
};

/// Meaning of an element: vertices, a kind of cells, strips of triangles, rows that go with the faces, or
/// other.
enum class Role : std::uint8_t { vertices, faces, edges, tetrahedra, strips, rows_of_faces, other };

struct Element {
  std::string name;
  Index count = 0;
  std::vector<Property> properties;
  Role role = Role::other;
  std::string content;            ///< lines or bytes of an element with Role::other, verbatim
  std::string why_left_out = {};  ///< why an element with Role::other is not written; else empty
};

inline bool holds_cells(const Element& element) {
  return element.role != Role::vertices && element.role < Role::rows_of_faces;
}

/// Returns the name of a property's array: "ELEMENT.NAME" for rows that go with the faces, else its name.
inline std::string array_name(const Element& element, const Property& property) {
  return element.role == Role::rows_of_faces ? element.name + "." + property.name : property.name;
}

struct PlyMetadata : FormatMetadata {
  Encoding encoding = Encoding::ascii;
  std::vector<std::string> comments;  ///< whole lines, obj_info as well
  std::vector<Element> elements;

  [[nodiscard]] std::vector<std::string> contents() const override {
    std::vector<std::string> result;
    for (const Element& element : elements) {
      if (element.role == Role::other) result.push_back("the element '" + element.name + "'");
      for (const Property& property : element.properties) {
        if (!property.why_left_out.empty())
          result.push_back("the property '" + property.name + "' of the element " + element.name);
      }
    }
    return result;
  }
};

/// Returns whether the property is the list of a cell's vertices.
inline bool is_corner_list(const Property& property) {
  return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Returns 0, 1, 2 for x, y, z; −1 for others.
inline int coordinate_of(const Property& property) {
  if (property.is_list || property.name.size() != 1) return -1;
  const auto place = std::string_view("xyz").find(property.name);
  return place == std::string_view::npos ? -1 : static_cast<int>(place);
}

/// Returns 0 or 1 for the ends of an edge; −1 for others.
inline int end_of(const Property& property) {
  if (property.is_list) return -1;
  return property.name == "vertex1" ? 0 : property.name == "vertex2" ? 1 : -1;
}

Mesh read(const FilePath& path, Notes& notes);

}  // namespace meshorder::ply
