// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include <meshorder/mesh.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// Declarations shared by the reader and the writer of OBJ files.
namespace meshorder::obj {

/// A kind of statement, such as usemtl, and its array on cells. A statement applies until the next of its
/// kind. The array has the number of each cell's statement, 0 if there is none; the metadata has the names by
/// number. Smoothing groups keep the file's numbers.
struct State {
  std::string_view keyword;
  std::string_view array;
};
inline constexpr std::array<State, 9> kStates{{{"o", "object"},
                                               {"usemtl", kLabel},
                                               {"s", "smoothing"},
                                               {"mg", "obj:mg"},
                                               {"lod", "obj:lod"},
                                               {"bevel", "obj:bevel"},
                                               {"c_interp", "obj:c_interp"},
                                               {"d_interp", "obj:d_interp"},
                                               {"usemap", "obj:usemap"}}};
inline constexpr std::size_t kMaterial = 1;
inline constexpr std::size_t kSmoothing = 2;

/// Name of the array of homogeneous coordinates, if vertices have them.
inline constexpr std::string_view kWeight = "obj:weight";

/// Returns the name of an array on cells with `corners` corners. The array has, for each corner, the
/// position, from 0, of its entry in the list of texture coordinates (or normals). Reordering leaves these
/// lists unchanged.
inline std::string corner_array(std::string_view what, Index corners) {
  return "obj:" + std::string(what) + std::to_string(corners);
}

struct ObjMetadata : FormatMetadata {
  std::string comments;   ///< all comments of the file, as whole lines
  std::string libraries;  ///< whole lines: mtllib, maplib, shadow_obj, trace_obj
  std::string texture;    ///< the lines vt
  std::string normals;    ///< the lines vn
  std::array<std::map<std::int32_t, std::string>, kStates.size()> names;
  /// For statements g whose names are not in alphabetical order: the names as in the file, by the sorted
  /// names. Spaces separate the names.
  std::map<std::string, std::string> group_statements;

  [[nodiscard]] std::vector<std::string> contents() const override {
    std::vector<std::string> result;
    if (!libraries.empty()) result.emplace_back("the names of material libraries");
    if (!texture.empty()) result.emplace_back("texture coordinates of corners");
    if (!normals.empty()) result.emplace_back("normals of corners");
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (const auto& [number, name] : names[i]) {
        result.push_back(std::string(kStates[i].keyword) + " " + name + ", which is " +
                         std::to_string(number) + " in the array '" + std::string(kStates[i].array) + "'");
      }
    }
    return result;
  }
};

Mesh read(const FilePath& path, Notes& notes);

}  // namespace meshorder::obj
