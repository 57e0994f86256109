// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"

#include "base/text.hpp"
#include "io/all_formats.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

namespace meshorder {
namespace {

const std::array kFormats{
    tetgen_format(), vega_format(),   gmsh_format(),          medit_format(),       vtu_format(),
    vtk_format(),    off_format(),    obj_format(),           ply_format(),         stl_format(),
    su2_format(),    abaqus_format(), matrix_market_format(), metis_graph_format(),
};

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Returns whether the size is that of a binary STL file of as many triangles as its header says.
bool has_size_of_stl(std::string_view bytes) {
  constexpr std::size_t kHeader = 80;
  if (bytes.size() < kHeader + 4) return false;
  std::uint64_t triangles = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    triangles |= std::uint64_t{static_cast<unsigned char>(bytes[kHeader + k])} << (8 * k);
  }
  return bytes.size() == kHeader + 4 + 50 * triangles;
}

/// Returns whether a line that begins with this word, before `rest`, begins SU2's files.
bool is_su2_keyword(std::string_view word, std::string_view rest) {
  constexpr std::array<std::string_view, 5> kKeywords{"NDIME", "NZONE", "IZONE", "NELEM", "NPOIN"};
  const std::size_t equals = word.find('=');
  if (equals == std::string_view::npos && !trimmed(rest).starts_with('=')) return false;
  return std::any_of(kKeywords.begin(), kKeywords.end(), [&](std::string_view keyword) {
    return same_but_for_case(keyword, word.substr(0, equals));
  });
}

/// Returns whether a file is a deck of Abaqus, whose first word, before the lines `rest`, has an asterisk as
/// in Vega's files. Both have *MATERIAL and *INCLUDE.
bool is_deck(std::string_view word, std::string_view rest) {
  constexpr std::array<std::string_view, 4> kOfVega{"*VERTICES", "*ELEMENTS", "*SET", "*REGION"};
  constexpr std::array<std::string_view, 4> kOfBoth{"*MATERIAL", "*INCLUDE", "*MATERIAL,", "*INCLUDE,"};
  const auto is_one_of = [&](const auto& keywords) {
    return std::any_of(keywords.begin(), keywords.end(),
                       [&](std::string_view keyword) { return same_but_for_case(keyword, word); });
  };
  while (is_one_of(kOfBoth)) {
    if (word.ends_with(',')) return true;
    while (!rest.empty() && !trimmed(rest).starts_with('*')) {
      rest.remove_prefix(std::min(rest.find_first_of("\r\n"), rest.size() - 1) + 1);
    }
    if (rest.empty()) return false;
    word = next_word(rest, " \t\r\n");
  }
  return !is_one_of(kOfVega);
}

/// Returns the name of the format whose files begin like this, or an empty text. Comments and empty lines
/// before the first word are passed over.
std::string_view format_that_begins(std::string_view bytes) {
  while (!bytes.empty()) {
    std::string_view line = bytes.substr(0, bytes.find_first_of("\r\n"));
    bytes.remove_prefix(std::min(line.size() + 1, bytes.size()));
    if (line.starts_with("# vtk DataFile")) return "VTK";
    if (line.starts_with("%%MatrixMarket")) return "MatrixMarket";
    const std::string_view word = next_word(line);
    if (word.empty() || word.front() == '#' || word.front() == '%') continue;
    if (word.starts_with("$")) return "Gmsh";
    if (word.starts_with("MeshVersion")) return "Medit";
    if (word.starts_with("<")) return "VTU";
    if (word.starts_with("*")) return is_deck(word, bytes) ? "Abaqus" : "Vega";
    if (word.ends_with("OFF")) return "OFF";
    if (word == "ply") return "PLY";
    if (same_but_for_case(word, "solid")) return "STL";
    if (is_su2_keyword(word, line)) return "SU2";
    constexpr std::array<std::string_view, 9> kObjWords{"v", "vn", "vt",     "f",     "o",
                                                        "g", "s",  "mtllib", "usemtl"};
    return std::find(kObjWords.begin(), kObjWords.end(), word) != kObjWords.end() ? "OBJ" : "";
  }
  return {};
}

}  // namespace

std::string Format::key() const { return lower_case(std::string(name)); }

std::span<const Format> all_formats() { return kFormats; }

const Format& format_of(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (std::error_code code; extension.empty() && std::filesystem::is_directory(path, code)) {
    throw InputError(path.string(), "is a folder", "give a mesh file");
  }
  std::string known;
  for (const Format& format : kFormats) {
    for (const std::string_view candidate : format.extensions) {
      if (candidate == extension) return format;
      known += (known.empty() ? "" : " ") + std::string(candidate);
    }
  }
  throw InputError(path.string(),
                   extension.empty() ? "has no extension" : "unknown extension '" + extension + "'",
                   "known are " + known + "; the Python package and its command also take meshio's formats");
}

const Format& format_named(std::string_view name) {
  const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                  [&](const Format& format) { return same_but_for_case(format.name, name); });
  if (found != kFormats.end()) return *found;
  throw InvalidArgument("unknown format '" + std::string(name) + "'; known are " +
                        join(kFormats, [](const Format& format) { return format.key(); }));
}

const Format* format_of_bytes(std::string_view bytes) {
  if (has_size_of_stl(bytes)) return &format_named("STL");
  const std::string_view name = format_that_begins(bytes);
  return name.empty() ? nullptr : &format_named(name);
}

inline namespace v0_2 {

std::vector<FormatInfo> formats() {
  std::vector<FormatInfo> result;
  result.reserve(kFormats.size());
  for (const Format& format : kFormats) {
    result.push_back({.name = format.key(),
                      .extensions = {format.extensions.begin(), format.extensions.end()},
                      .single_file = format.name != "TetGen",
                      .groups_cells_by_type = format.groups_cells_by_type});
  }
  return result;
}

}  // namespace v0_2
}  // namespace meshorder
