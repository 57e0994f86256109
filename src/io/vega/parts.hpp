// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include <meshorder/mesh.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Declarations shared by the reader and the writer of Vega files.
namespace meshorder::vega {

inline constexpr std::string_view kAllElements = "allElements";
inline constexpr std::string_view kAttributes = "attributes";

enum class Kind : std::uint8_t { vertices, elements, material, set, region, other };

/// A section of the file and the comments before it.
struct VegaSection {
  Kind kind = Kind::other;
  std::string comments;            ///< whole lines
  std::string title;               ///< name of a material, or first line of an unknown section
  std::vector<std::string> lines;  ///< lines of a material or an unknown section
  std::size_t set = 0;             ///< index of the set in Mesh::sets
  std::string region_set;
  std::string region_material;
};

struct VegaMetadata : FormatMetadata {
  std::vector<VegaSection> sections;
  std::string closing_comments;
  std::string element_word = "TET";
  int vertex_base = 1;
  int element_base = 1;
  int vertex_attributes = 0;  ///< TetGen's columns after the coordinates, which Vega allows
  bool vertex_markers = false;
  int element_attributes = 0;
  std::vector<std::string> included;

  [[nodiscard]] std::vector<std::string> contents() const override {
    std::vector<std::string> result;
    for (const VegaSection& section : sections) {
      if (section.kind == Kind::material) result.push_back("the material '" + section.title + "'");
      if (section.kind == Kind::region) {
        result.push_back("the region of '" + section.region_set + "' and '" + section.region_material + "'");
      }
      if (section.kind == Kind::other) result.push_back("the section " + section.title);
    }
    return result;
  }
};

/// Returns, for each cell, the number (from 1) of the last region that contains it; 0 if no region does.
/// Empty if there are no regions.
std::vector<std::int32_t> region_numbers(const VegaMetadata& metadata, const Mesh& mesh);

Mesh read(const FilePath& path, Notes& notes);

}  // namespace meshorder::vega
