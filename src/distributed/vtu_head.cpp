// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/vtu_head.hpp"

#include "distributed/vtu_numbers.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/output_set.hpp"
#include "io/stream/read_limits.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <fstream>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

constexpr std::size_t kLongestHead = std::size_t{1} << 26;
constexpr Offset kMostComponents = Offset{1} << 24;
constexpr std::string_view kAppended = "<AppendedData";

/// The XML of a file without its arrays, for the parser.
class HeadOnly : public FileStore {
 public:
  explicit HeadOnly(std::string text) : text_(std::move(text)) {}
  [[nodiscard]] bool has(const std::filesystem::path& /*path*/) const override { return true; }
  [[nodiscard]] std::string read(const std::filesystem::path& /*path*/) const override { return text_; }
  void write(const std::filesystem::path& /*path*/, std::string bytes) override { text_ = std::move(bytes); }

 private:
  std::string text_;
};

/// Returns the file up to the underscore before its appended data; nothing if it has none.
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

/// Returns a count in an attribute; `otherwise`, unless it is negative, without the attribute.
Offset whole_number(const vtk::VtuDocument& file, const vtk::VtuElement& element, std::string_view name,
                    Offset otherwise = -1) {
  if (otherwise >= 0 && element.attribute(name) == nullptr) return otherwise;
  const std::string& text = file.required(element, name);
  Offset value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size() || value < 0) {
    throw file.error(element, fmt::format("{} is '{}'", name, text.substr(0, 40)),
                     "a whole number from 0 on is needed");
  }
  return value;
}

using Role = VtuArray::Role;

class HeadReader {
 public:
  explicit HeadReader(const std::string& path) : path_(path) {}

  std::optional<VtuHead> read() {
    finish_interrupted(path_);
    const std::string text = head_of(path_);
    if (text.empty()) return std::nullopt;
    first_byte_ = static_cast<Offset>(text.size());
    HeadOnly store(text + "</AppendedData></VTKFile>");
    const FilePath path(path_, store);
    const ReadScope scope(path);
    const vtk::VtuDocument file(path);
    bytes_.open(path_, std::ios::binary | std::ios::ate);
    head_.sizes.bytes = static_cast<Offset>(bytes_.tellg());
    const VtuEncoding& encoding = file.encoding();
    const vtk::VtuElement* const grid = file.root().child("UnstructuredGrid");
    if (encoding.compressor != VtuEncoding::Compressor::none || encoding.order != std::endian::native ||
        grid == nullptr || count_of(*grid, "Piece") != 1) {
      return std::nullopt;
    }
    if (!read_piece(file, *grid->child("Piece")) || !are_apart()) return std::nullopt;
    return std::move(head_);
  }

 private:
  static Offset count_of(const vtk::VtuElement& element, std::string_view name) {
    return std::count_if(element.children.begin(), element.children.end(),
                         [&](const vtk::VtuElement& child) { return child.name == name; });
  }

  bool read_piece(const vtk::VtuDocument& file, const vtk::VtuElement& piece) {
    head_.sizes.vertices = whole_number(file, piece, "NumberOfPoints");
    head_.sizes.cells = whole_number(file, piece, "NumberOfCells");
    for (const vtk::VtuElement& section : piece.children) {
      for (const vtk::VtuElement& element : section.children) {
        if (!read_array(file, section.name, element)) return false;
      }
    }
    if (head_.sizes.vertices == 0 || head_.sizes.cells == 0) return false;
    constexpr std::array kNeeded{Role::points, Role::types, Role::offsets, Role::connectivity};
    return std::all_of(kNeeded.begin(), kNeeded.end(), [&](Role role) {
      return std::count_if(head_.arrays.begin(), head_.arrays.end(),
                           [&](const VtuArray& array) { return array.role == role; }) == 1;
    });
  }

  /// Returns whether an element is an array that can be read by slices, and keeps it.
  bool read_array(const vtk::VtuDocument& file, std::string_view section, const vtk::VtuElement& element) {
    const std::string* const type = element.attribute("type");
    const std::string* const name = element.attribute("Name");
    const auto* const known = type == nullptr
                                  ? vtk::kXmlTypeNames.end()
                                  : std::find(vtk::kXmlTypeNames.begin(), vtk::kXmlTypeNames.end(), *type);
    VtuArray array{};
    if (section == "Points") {
      array.role = Role::points;
    } else if (section == "Cells") {
      constexpr std::array<std::pair<std::string_view, Role>, 3> kNames{
          {{"types", Role::types}, {"offsets", Role::offsets}, {"connectivity", Role::connectivity}}};
      const auto* const own = std::find_if(kNames.begin(), kNames.end(), [&](const auto& one) {
        return name != nullptr && one.first == *name;
      });
      if (own == kNames.end()) return false;
      array.role = own->second;
    } else {
      array.role = Role::data;
    }
    const bool on_vertices = section == "Points" || section == "PointData";
    if (element.name != "DataArray" || known == vtk::kXmlTypeNames.end() ||
        element.attribute("TimeStep") != nullptr ||
        (!on_vertices && section != "Cells" && section != "CellData") ||
        file.mode(element) != VtuEncoding::Mode::appended_raw) {
      return false;
    }
    array.association = on_vertices ? Association::vertices : Association::cells;
    array.type = static_cast<std::uint8_t>(known - vtk::kXmlTypeNames.begin());
    const Offset number = size_of_type(array.type);
    const Offset components = whole_number(file, element, "NumberOfComponents", 1);
    const bool is_whole = array.type > 1;
    const bool fits = array.role == Role::points ? components == 3 && !is_whole
                      : array.role == Role::data ? components > 0 && components < kMostComponents
                                                 : components == 1 && is_whole;
    if (number == 0 || !fits) return false;
    array.row = number * components;
    place(file, element, array);
    head_.arrays.push_back(array);
    return true;
  }

  /// Finds the bytes of an array by its offset and the word before them.
  void place(const vtk::VtuDocument& file, const vtk::VtuElement& element, VtuArray& array) {
    const Offset word = file.encoding().wide_headers ? 8 : 4;
    const Offset offset = whole_number(file, element, "offset");
    const std::string* const name = element.attribute("Name");
    const std::string what = fmt::format("the array '{}'", name == nullptr ? "" : name->substr(0, 40));
    if (offset > head_.sizes.bytes - first_byte_ - word)
      throw file.error(element, what + " lies beyond the end of the file", "the file may be cut short");
    array.at = first_byte_ + offset + word;
    std::uint64_t size = 0;
    bytes_.seekg(first_byte_ + offset);
    bytes_.read(reinterpret_cast<char*>(&size), word);
    const Offset rows = array.association == Association::vertices ? head_.sizes.vertices : head_.sizes.cells;
    const bool is_free = array.role == Role::connectivity;
    if (!bytes_ || size > static_cast<std::uint64_t>(head_.sizes.bytes - array.at)) {
      throw file.error(element,
                       fmt::format("{} has {} bytes, but the file ends after {}", what, size,
                                   head_.sizes.bytes - array.at),
                       "the file may be cut short");
    }
    array.size = static_cast<Offset>(size);
    if (is_free ? array.size % array.row != 0
                : array.size / array.row != rows || array.size % array.row != 0) {
      throw file.error(element, fmt::format("{} has {} bytes for {} rows of {}", what, size, rows, array.row),
                       "the file may be damaged");
    }
    if (is_free) head_.sizes.entries = array.size / array.row;
  }

  /// Returns whether no two arrays share bytes.
  bool are_apart() {
    std::vector<std::pair<Offset, Offset>> ranges;
    for (const VtuArray& array : head_.arrays) ranges.emplace_back(array.at, array.at + array.size);
    std::sort(ranges.begin(), ranges.end());
    for (std::size_t k = 1; k < ranges.size(); ++k) {
      if (ranges[k].first < ranges[k - 1].second) return false;
    }
    return true;
  }

  const std::string& path_;
  VtuHead head_;
  Offset first_byte_ = 0;  ///< of the appended data
  std::ifstream bytes_;
};

}  // namespace

std::optional<VtuHead> read_vtu_head(const std::string& path) { return HeadReader(path).read(); }

}  // namespace meshorder::distributed
