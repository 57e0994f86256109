// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/appended_arrays.hpp"
#include "distributed/files/file_head.hpp"
#include "distributed/files/text_store.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/read_limits.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_compressor.hpp"
#include "io/vtk/vtu_document.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

constexpr std::size_t kLongestHead = std::size_t{1} << 25;
constexpr Offset kMost = std::numeric_limits<Offset>::max();
constexpr Offset kMostComponents = Offset{1} << 24;
constexpr std::string_view kAppended = "<AppendedData";

/// Returns the file up to and including the underscore before its appended data; empty if there are no
/// appended data, or if that text is longer than 32 MiB.
std::string head_of(const FilePath& path) {
  for (std::size_t most = std::size_t{1} << 16; most <= kLongestHead; most *= 8) {
    const std::string text = path.read_first(most);
    const std::size_t tag = text.find(kAppended);
    const std::size_t end = tag == std::string::npos ? tag : text.find('>', tag);
    const std::size_t begin = end == std::string::npos ? end : text.find('_', end);
    if (begin != std::string::npos) return text.substr(0, begin + 1);
    if (text.size() < most) break;
  }
  return {};
}

using Role = FilePart::Role;

class HeadReader {
 public:
  HeadReader(const std::string& path, int ranks) : path_(path), ranks_(ranks) {}

  std::optional<FileHead> read() {
    head_.path = path_;
    std::string text = head_of(path_);
    if (text.empty()) return std::nullopt;
    head_.facts.first_byte = static_cast<Offset>(text.size());
    TextStore store(text + "</AppendedData></VTKFile>");
    const FilePath path(path_, store);
    const ReadScope scope(path);
    head_.facts.bytes = static_cast<Offset>(std::filesystem::file_size(path_));
    count_file(path, static_cast<std::uint64_t>(head_.facts.bytes));
    const vtk::VtuDocument file(path);
    const VtuEncoding& encoding = head_.facts.encoding = file.encoding();
    const vtk::VtuElement* const grid = file.root().child("UnstructuredGrid");
    if (!vtk::VtuCompressor::available(encoding.compressor) || encoding.order != std::endian::native ||
        grid == nullptr || count_of(*grid, "Piece") != 1 || has_compressed_text(file, *grid)) {
      return std::nullopt;
    }
    AppendedArrays arrays(path_, file, head_.facts.first_byte, ranks_);
    if (!read_piece(file, *grid->child("Piece"), arrays)) return std::nullopt;
    head_.xml = VtuXml(std::move(text), file);
    if (!sort_by_bytes(head_.parts, head_.facts.bytes) || begins_within()) return std::nullopt;
    return std::move(head_);
  }

 private:
  static Offset count_of(const vtk::VtuElement& element, std::string_view name) {
    return std::count_if(element.children.begin(), element.children.end(),
                         [&](const vtk::VtuElement& child) { return child.name == name; });
  }

  /// Returns whether a field is compressed inside the XML; uncompressed pieces could not copy it.
  static bool has_compressed_text(const vtk::VtuDocument& file, const vtk::VtuElement& grid) {
    const vtk::VtuElement* const fields = grid.child("FieldData");
    return file.encoding().compressor != VtuEncoding::Compressor::none && fields != nullptr &&
           std::any_of(fields->children.begin(), fields->children.end(), [&](const vtk::VtuElement& element) {
             return file.mode(element) == VtuEncoding::Mode::base64;
           });
  }

  bool read_piece(const vtk::VtuDocument& file, const vtk::VtuElement& piece, AppendedArrays& arrays) {
    head_.facts.vertices = file.count(piece, "NumberOfPoints", kMost);
    head_.facts.cells = file.count(piece, "NumberOfCells", kMost);
    for (const vtk::VtuElement& section : piece.children) {
      for (const vtk::VtuElement& element : section.children) {
        if (!read_array(file, section.name, element, arrays)) return false;
      }
    }
    if (head_.facts.vertices == 0 || head_.facts.cells == 0) return false;
    constexpr std::array kNeeded{Role::points, Role::types, Role::offsets, Role::connectivity};
    return std::all_of(kNeeded.begin(), kNeeded.end(), [&](Role role) {
      return std::count_if(head_.parts.begin(), head_.parts.end(),
                           [&](const FilePart& part) { return part.role == role; }) == 1;
    });
  }

  /// Adds the array of an element to the parts; returns false if the array cannot be read by slices.
  bool read_array(const vtk::VtuDocument& file, std::string_view section, const vtk::VtuElement& element,
                  AppendedArrays& arrays) {
    const std::string_view name = element.text_of("Name");
    FilePart part;
    part.number = head_.names.size();
    if (section == "Points") {
      part.role = Role::points;
    } else if (section == "Cells") {
      constexpr std::array<std::pair<std::string_view, Role>, 3> kNames{
          {{"types", Role::types}, {"offsets", Role::offsets}, {"connectivity", Role::connectivity}}};
      const auto* const own =
          std::find_if(kNames.begin(), kNames.end(), [&](const auto& one) { return one.first == name; });
      if (own == kNames.end()) return false;
      part.role = own->second;
    }
    const bool on_vertices = section == "Points" || section == "PointData";
    if (element.name != "DataArray" || element.number_type() == vtk::kXmlTypeNames.size() ||
        element.attribute("TimeStep") != nullptr ||
        (!on_vertices && section != "Cells" && section != "CellData") ||
        file.mode(element) != VtuEncoding::Mode::appended_raw) {
      return false;
    }
    part.association = on_vertices ? Association::vertices : Association::cells;
    part.type = static_cast<std::uint8_t>(element.number_type());
    const Offset components = file.components(element);
    const bool is_whole = part.type > 1;
    const bool fits = part.role == Role::points ? components == 3 && !is_whole
                      : part.role == Role::data ? components > 0 && components < kMostComponents
                                                : components == 1 && is_whole;
    if (size_of_type(part.type) == 0 || !fits) return false;
    part.components = static_cast<Index>(components);
    head_.names.emplace_back(name);
    const Offset size = arrays.place(element, part, head_.blocks.emplace_back());
    const Offset width = part.row_size();
    const Offset needed = part.role == Role::connectivity ? size / width
                          : on_vertices                   ? head_.facts.vertices
                                                          : head_.facts.cells;
    part.rows = size / width;
    if (part.rows != needed || size % width != 0) {
      throw file.error(element,
                       fmt::format("the array '{}' has {} bytes for {} rows of {}",
                                   head_.names.back().substr(0, 40), size, needed, width),
                       "the file may be damaged");
    }
    if (part.role == Role::connectivity) head_.facts.entries = part.rows;
    head_.parts.push_back(part);
    return true;
  }

  /// Returns whether an array that is not in `head_.parts` begins inside one of these parts.
  [[nodiscard]] bool begins_within() const {
    const std::vector<Offset> offsets = head_.xml.offsets();
    return std::any_of(offsets.begin(), offsets.end(), [&](Offset offset) {
      if (offset > head_.facts.bytes) return false;  // reported when the array is read
      const Offset at = head_.facts.first_byte + offset;
      return std::any_of(head_.parts.begin(), head_.parts.end(),
                         [&](const FilePart& part) { return part.at < at && at < part.at + part.stored; });
    });
  }

  const std::string& path_;
  int ranks_;
  FileHead head_;
};

}  // namespace

std::optional<FileHead> read_vtu_head(const std::string& path, int ranks) {
  return HeadReader(path, ranks).read();
}

}  // namespace meshorder::distributed
