// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/vtu_head.hpp"

#include "base/input_file.hpp"
#include "base/memory.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/text_store.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/read_limits.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_compressor.hpp"
#include "io/vtk/vtu_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

constexpr std::size_t kLongestHead = std::size_t{1} << 26;
constexpr Offset kMostComponents = Offset{1} << 24;
constexpr const char* kCutShort = "the file may be cut short";
constexpr std::string_view kAppended = "<AppendedData";

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

using Role = FileArray::Role;

class HeadReader {
 public:
  HeadReader(const std::string& path, int ranks) : path_(path), ranks_(ranks) {}

  std::optional<FileHead> read() {
    std::string text = head_of(path_);
    if (text.empty()) return std::nullopt;
    head_.facts.first_byte = static_cast<Offset>(text.size());
    TextStore store(text + "</AppendedData></VTKFile>");
    const FilePath path(path_, store);
    const ReadScope scope(path);
    file_.emplace(path_);
    head_.facts.bytes = static_cast<Offset>(file_->size());
    count_file(path, static_cast<std::uint64_t>(head_.facts.bytes));
    const vtk::VtuDocument file(path);
    const VtuEncoding& encoding = head_.facts.encoding = file.encoding();
    const vtk::VtuElement* const grid = file.root().child("UnstructuredGrid");
    if (!vtk::VtuCompressor::available(encoding.compressor) || encoding.order != std::endian::native ||
        grid == nullptr || count_of(*grid, "Piece") != 1 || has_compressed_text(file, *grid)) {
      return std::nullopt;
    }
    word_ = encoding.wide_headers ? 8 : 4;
    if (!read_piece(file, *grid->child("Piece"))) return std::nullopt;
    head_.xml = VtuXml(std::move(text), file);
    if (!are_apart()) return std::nullopt;
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

  bool read_piece(const vtk::VtuDocument& file, const vtk::VtuElement& piece) {
    head_.facts.vertices = whole_number(file, piece, "NumberOfPoints");
    head_.facts.cells = whole_number(file, piece, "NumberOfCells");
    for (const vtk::VtuElement& section : piece.children) {
      for (const vtk::VtuElement& element : section.children) {
        if (!read_array(file, section.name, element)) return false;
      }
    }
    if (head_.facts.vertices == 0 || head_.facts.cells == 0) return false;
    constexpr std::array kNeeded{Role::points, Role::types, Role::offsets, Role::connectivity};
    return std::all_of(kNeeded.begin(), kNeeded.end(), [&](Role role) {
      return std::count_if(head_.arrays.begin(), head_.arrays.end(),
                           [&](const FileArray& array) { return array.role == role; }) == 1;
    });
  }

  /// Adds the array of an element; returns false if it cannot be read by slices.
  bool read_array(const vtk::VtuDocument& file, std::string_view section, const vtk::VtuElement& element) {
    const std::string* const type = element.attribute("type");
    const std::string* const name = element.attribute("Name");
    const auto* const known = type == nullptr
                                  ? vtk::kXmlTypeNames.end()
                                  : std::find(vtk::kXmlTypeNames.begin(), vtk::kXmlTypeNames.end(), *type);
    FileArray array{};
    array.element = head_.arrays.size();
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
    if (name != nullptr) copy_start(*name, array.name);
    std::vector<Offset> blocks = place(file, element, array);
    const auto behind = std::upper_bound(head_.arrays.begin(), head_.arrays.end(), array,
                                         [](const FileArray& a, const FileArray& b) { return a.at < b.at; });
    head_.blocks.insert(head_.blocks.begin() + (behind - head_.arrays.begin()), std::move(blocks));
    head_.arrays.insert(behind, array);
    return true;
  }

  /// Copies the first 40 bytes of a name, with '?' for control characters.
  static void copy_start(std::string_view name, std::array<char, 41>& target) {
    std::replace_copy_if(
        name.begin(), name.begin() + std::min<std::ptrdiff_t>(std::ssize(name), 40), target.begin(),
        [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  }

  /// Finds the bytes of an array by its offset and the words before them; returns the bounds of its blocks.
  std::vector<Offset> place(const vtk::VtuDocument& file, const vtk::VtuElement& element, FileArray& array) {
    const std::string what = fmt::format("the array '{}'", array.name.data());
    const Offset offset = whole_number(file, element, "offset");
    if (offset > head_.facts.bytes - head_.facts.first_byte)
      throw file.error(element, what + " lies beyond the end of the file", kCutShort);
    array.at = head_.facts.first_byte + offset;
    std::vector<Offset> blocks;
    const std::uint64_t size = head_.facts.encoding.compressor == VtuEncoding::Compressor::none
                                   ? place_bytes(file, element, what, array)
                                   : place_blocks(file, element, what, array, blocks);
    const Offset rows = array.association == Association::vertices ? head_.facts.vertices : head_.facts.cells;
    const bool is_free = array.role == Role::connectivity;
    array.size = static_cast<Offset>(size);
    if (is_free ? array.size % array.row != 0
                : array.size / array.row != rows || array.size % array.row != 0) {
      throw file.error(element, fmt::format("{} has {} bytes for {} rows of {}", what, size, rows, array.row),
                       "the file may be damaged");
    }
    if (is_free) head_.facts.entries = array.size / array.row;
    return blocks;
  }

  /// Returns the next `count` words of the file.
  std::vector<std::uint64_t> words(const vtk::VtuDocument& file, const vtk::VtuElement& element,
                                   const std::string& what, std::uint64_t count) {
    const auto left = static_cast<std::uint64_t>(head_.facts.bytes - at_);
    if (count > left / word_) throw file.error(element, what + " ends early", kCutShort);
    file.claim(element, bytes_for(count, 2 * sizeof(std::uint64_t)));
    std::vector<char> bytes(count * word_);
    const std::size_t got = file_->read_at(static_cast<std::uint64_t>(at_), bytes);
    at_ += std::ssize(bytes);
    if (got < bytes.size())
      throw InputError(path_, "cannot be read", "it may have changed while it was read");
    std::vector<std::uint64_t> result;
    for (std::size_t at = 0; at < bytes.size(); at += word_) {
      std::uint64_t wide = 0;
      std::uint32_t narrow = 0;
      std::memcpy(word_ == 8 ? static_cast<void*>(&wide) : &narrow, bytes.data() + at, word_);
      result.push_back(word_ == 8 ? wide : narrow);
    }
    return result;
  }

  /// Finds the bytes of an uncompressed array by the word before them; returns their number.
  std::uint64_t place_bytes(const vtk::VtuDocument& file, const vtk::VtuElement& element,
                            const std::string& what, FileArray& array) {
    at_ = array.at;
    const std::uint64_t size = words(file, element, what, 1).front();
    const auto left = static_cast<std::uint64_t>(head_.facts.bytes - at_);
    if (size > left)
      throw file.error(element, fmt::format("{} has {} bytes, but the file ends after {}", what, size, left),
                       kCutShort);
    array.stored = static_cast<Offset>(word_ + size);
    return size;
  }

  /// Finds the blocks of a compressed array by the words before them: the number of blocks, the bytes of
  /// each, those of the last if they differ, and the compressed bytes of each. Returns the uncompressed size.
  std::uint64_t place_blocks(const vtk::VtuDocument& file, const vtk::VtuElement& element,
                             const std::string& what, FileArray& array, std::vector<Offset>& blocks) {
    at_ = array.at;
    const std::vector<std::uint64_t> head = words(file, element, what, 3);
    const std::vector<std::uint64_t> compressed = words(file, element, what, head[0]);
    if (head[0] > 1 && head[1] == 0)
      throw file.error(element, what + " has empty blocks", "the array is damaged");
    const std::uint64_t ratio = vtk::VtuCompressor::greatest_ratio(head_.facts.encoding.compressor);
    std::uint64_t size = 0;
    blocks.push_back(at_);
    for (std::size_t b = 0; b < compressed.size(); ++b) {
      if (compressed[b] > static_cast<std::uint64_t>(head_.facts.bytes - blocks.back()))
        throw file.error(element, what + " ends early", kCutShort);
      const std::uint64_t bytes = b + 1 == compressed.size() && head[2] > 0 ? head[2] : head[1];
      if (bytes > compressed[b] * ratio + 1024) {
        throw file.error(element,
                         fmt::format("{}: a block of {} bytes cannot hold {}", what, compressed[b], bytes),
                         "the array is damaged");
      }
      size += bytes;
      blocks.push_back(blocks.back() + static_cast<Offset>(compressed[b]));
    }
    // claim what a rank holds of the array: its share, and a block of which it needs a part
    file.claim(element, size / static_cast<std::uint64_t>(ranks_) + std::min(head[1], size));
    array.stored = blocks.back() - array.at;
    array.blocks = std::ssize(compressed);
    array.block = static_cast<Offset>(compressed.size() == 1 ? size : head[1]);
    return size;
  }

  /// Returns whether no two arrays share bytes, and none begins within another.
  [[nodiscard]] bool are_apart() const {
    const std::vector<FileArray>& arrays = head_.arrays;
    for (std::size_t k = 1; k < arrays.size(); ++k) {
      if (arrays[k].at < arrays[k - 1].at + arrays[k - 1].stored) return false;
    }
    const std::vector<Offset> offsets = head_.xml.offsets();
    return std::none_of(offsets.begin(), offsets.end(), [&](Offset offset) {
      if (offset > head_.facts.bytes) return false;  // an error of its own when the array is read
      const Offset at = head_.facts.first_byte + offset;
      return std::any_of(arrays.begin(), arrays.end(), [&](const FileArray& array) {
        return array.at < at && at < array.at + array.stored;
      });
    });
  }

  const std::string& path_;
  int ranks_;
  FileHead head_;
  std::size_t word_ = 8;  ///< bytes of a word before an array
  std::optional<InputFile> file_;
  Offset at_ = 0;  ///< of the next byte to read
};

}  // namespace

std::optional<FileHead> read_vtu_head(const std::string& path, int ranks) {
  return HeadReader(path, ranks).read();
}

}  // namespace meshorder::distributed
