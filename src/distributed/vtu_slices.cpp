// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/vtu_slices.hpp"

#include "cells/cell_arrays.hpp"
#include "distributed/halo.hpp"
#include "distributed/number_types.hpp"
#include "distributed/shared_file.hpp"
#include "distributed/text_store.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/output_set.hpp"
#include "io/stream/read_limits.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_document.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

namespace meshorder::distributed {
namespace {

constexpr Offset kChunk = Offset{1} << 24;  // bytes that are copied at a time
constexpr std::size_t kLongestHead = std::size_t{1} << 26;
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

}  // namespace

/// What the root reads of a file before the others know of it.
class VtuSlices::Head {
 public:
  explicit Head(const std::string& path) : path_(path) {}

  /// Returns whether the file can be read by slices; its arrays are known then.
  bool read() {
    finish_interrupted(path_);
    const std::string head = head_of(path_);
    if (head.empty()) return false;
    first_byte_ = static_cast<Offset>(head.size());
    slices.head_ = head;
    TextStore store(head + "</AppendedData></VTKFile>");
    const FilePath path(path_, store);
    const ReadScope scope(path);
    const vtk::VtuDocument file(path);
    bytes_.open(path_, std::ios::binary | std::ios::ate);
    slices.bytes_ = static_cast<Offset>(bytes_.tellg());
    const VtuEncoding& encoding = file.encoding();
    const vtk::VtuElement* const grid = file.root().child("UnstructuredGrid");
    if (encoding.compressor != VtuEncoding::Compressor::none || encoding.order != std::endian::native ||
        grid == nullptr || count_of(*grid, "Piece") != 1) {
      return false;
    }
    return read_piece(file, *grid->child("Piece")) && are_apart();
  }

  VtuSlices slices;

 private:
  static Offset count_of(const vtk::VtuElement& element, std::string_view name) {
    return std::count_if(element.children.begin(), element.children.end(),
                         [&](const vtk::VtuElement& child) { return child.name == name; });
  }

  bool read_piece(const vtk::VtuDocument& file, const vtk::VtuElement& piece) {
    slices.vertices_ = whole_number(file, piece, "NumberOfPoints");
    slices.cells_ = whole_number(file, piece, "NumberOfCells");
    for (const vtk::VtuElement& section : piece.children) {
      for (const vtk::VtuElement& element : section.children) {
        if (!read_array(file, section.name, element)) return false;
      }
    }
    if (slices.vertices_ == 0 || slices.cells_ == 0) return false;
    constexpr std::array kNeeded{Role::points, Role::types, Role::offsets, Role::connectivity};
    return std::all_of(kNeeded.begin(), kNeeded.end(), [&](Role role) {
      return std::count_if(slices.arrays_.begin(), slices.arrays_.end(),
                           [&](const Array& array) { return array.role == role; }) == 1;
    });
  }

  /// Returns whether an element is an array that can be read by slices, and keeps it.
  bool read_array(const vtk::VtuDocument& file, std::string_view section, const vtk::VtuElement& element) {
    const std::string* const type = element.attribute("type");
    const std::string* const name = element.attribute("Name");
    const auto* const known = type == nullptr
                                  ? vtk::kXmlTypeNames.end()
                                  : std::find(vtk::kXmlTypeNames.begin(), vtk::kXmlTypeNames.end(), *type);
    Array array{};
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
                      : array.role == Role::data ? components > 0 && components < kChunk
                                                 : components == 1 && is_whole;
    if (number == 0 || !fits) return false;
    array.row = number * components;
    place(file, element, array);
    slices.arrays_.push_back(array);
    return true;
  }

  /// Finds the bytes of an array by its offset and the word before them.
  void place(const vtk::VtuDocument& file, const vtk::VtuElement& element, Array& array) {
    const Offset word = file.encoding().wide_headers ? 8 : 4;
    const Offset offset = whole_number(file, element, "offset");
    const std::string* const name = element.attribute("Name");
    const std::string what = fmt::format("the array '{}'", name == nullptr ? "" : name->substr(0, 40));
    if (offset > slices.bytes_ - first_byte_ - word)
      throw file.error(element, what + " lies beyond the end of the file", "the file may be cut short");
    array.at = first_byte_ + offset + word;
    std::uint64_t size = 0;
    bytes_.seekg(first_byte_ + offset);
    bytes_.read(reinterpret_cast<char*>(&size), word);
    const Offset rows = array.association == Association::vertices ? slices.vertices_ : slices.cells_;
    const bool is_free = array.role == Role::connectivity;
    if (!bytes_ || size > static_cast<std::uint64_t>(slices.bytes_ - array.at)) {
      throw file.error(
          element,
          fmt::format("{} has {} bytes, but the file ends after {}", what, size, slices.bytes_ - array.at),
          "the file may be cut short");
    }
    array.size = static_cast<Offset>(size);
    if (is_free ? array.size % array.row != 0
                : array.size / array.row != rows || array.size % array.row != 0) {
      throw file.error(element, fmt::format("{} has {} bytes for {} rows of {}", what, size, rows, array.row),
                       "the file may be damaged");
    }
    if (is_free) slices.entries_ = array.size / array.row;
  }

  /// Returns whether no two arrays share bytes.
  bool are_apart() {
    std::vector<std::pair<Offset, Offset>> ranges;
    for (const Array& array : slices.arrays_) ranges.emplace_back(array.at, array.at + array.size);
    std::sort(ranges.begin(), ranges.end());
    for (std::size_t k = 1; k < ranges.size(); ++k) {
      if (ranges[k].first < ranges[k - 1].second) return false;
    }
    return true;
  }

  const std::string& path_;
  Offset first_byte_ = 0;  ///< of the appended data
  std::ifstream bytes_;
};

std::optional<VtuSlices> VtuSlices::open(const Communicator& communicator, const std::string& path) {
  Head head(path);
  const bool is_sliced = communicator.at_root([&] { return head.read(); });
  const std::vector<GlobalIndex> numbers = communicator.broadcast(
      std::vector<GlobalIndex>{is_sliced ? 1 : 0, head.slices.vertices_, head.slices.cells_,
                               head.slices.entries_, head.slices.bytes_});
  if (numbers[0] == 0) return std::nullopt;
  VtuSlices slices;
  slices.path_ = path;
  slices.vertices_ = numbers[1];
  slices.cells_ = numbers[2];
  slices.entries_ = numbers[3];
  slices.bytes_ = numbers[4];
  slices.head_ = std::move(head.slices.head_);
  slices.arrays_ = communicator.broadcast(std::move(head.slices.arrays_));
  return slices;
}

const VtuSlices::Array& VtuSlices::array(Role role) const {
  return *std::find_if(arrays_.begin(), arrays_.end(), [&](const Array& one) { return one.role == role; });
}

MeshSlice VtuSlices::empty_slice(const Communicator& communicator) const {
  MeshSlice slice;
  slice.vertices = Layout::even(vertices_, communicator.size());
  slice.cells = Layout::even(cells_, communicator.size());
  return slice;
}

MeshSlice VtuSlices::read(const Communicator& communicator) const {
  MeshSlice slice = empty_slice(communicator);
  const SharedFile file(communicator, path_, path_, SharedFile::Use::read);
  read_points(communicator, file, slice);
  read_cells(communicator, file, slice);
  return slice;
}

/// Returns the bytes of rows begin … end − 1 of an array.
std::vector<std::byte> VtuSlices::rows(const Communicator& communicator, const SharedFile& file, Role role,
                                       GlobalIndex begin, GlobalIndex end) const {
  const Array& array = this->array(role);
  std::vector<std::byte> bytes = communicator.together(
      [&] { return std::vector<std::byte>(static_cast<std::size_t>((end - begin) * array.row)); });
  file.read(array.at + begin * array.row, bytes);
  return bytes;
}

void VtuSlices::read_points(const Communicator& communicator, const SharedFile& file,
                            MeshSlice& slice) const {
  const int rank = communicator.rank();
  const GlobalIndex first_vertex = slice.vertices.begin(rank);
  const std::vector<std::byte> points =
      rows(communicator, file, Role::points, first_vertex, slice.vertices.end(rank));
  communicator.together([&] {
    const std::vector<double> coordinates = numbers_of<double>(points, array(Role::points).type);
    slice.points.resize(coordinates.size() / 3);
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      if (!std::isfinite(coordinates[k])) {
        throw InputError(path_,
                         fmt::format("point {} (counted from 0) has a coordinate that is not finite",
                                     first_vertex + static_cast<GlobalIndex>(k / 3)),
                         "finite numbers are needed");
      }
      slice.points[k / 3][k % 3] = coordinates[k];
    }
  });
}

void VtuSlices::read_cells(const Communicator& communicator, const SharedFile& file, MeshSlice& slice) const {
  const int rank = communicator.rank();
  const GlobalIndex first_cell = slice.cells.begin(rank);
  const GlobalIndex end_cell = slice.cells.end(rank);
  const std::vector<std::byte> types = rows(communicator, file, Role::types, first_cell, end_cell);
  // where the cell before ends is where the first one begins
  const GlobalIndex before = std::max<GlobalIndex>(first_cell - 1, 0);
  const std::vector<std::byte> ends =
      rows(communicator, file, Role::offsets, end_cell > first_cell ? before : end_cell, end_cell);
  Offset first_entry = 0;
  communicator.together([&] {
    std::vector<GlobalIndex> offsets = numbers_of<GlobalIndex>(ends, array(Role::offsets).type);
    if (first_cell == 0) offsets.insert(offsets.begin(), 0);
    if (end_cell == first_cell) offsets = {0};
    first_entry = offsets.front();
    for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
      if (offsets[c + 1] > offsets[c] && offsets[c] >= 0 && offsets[c + 1] <= entries_) continue;
      throw InputError(
          path_,
          fmt::format("cell {} (counted from 0) has the entries {} to {} of {}",
                      first_cell + static_cast<GlobalIndex>(c), offsets[c], offsets[c + 1], entries_),
          "offsets must ascend to the number of entries");
    }
    if (end_cell == cells_ && end_cell > first_cell && offsets.back() != entries_) {
      throw InputError(path_, fmt::format("the cells have {} entries of {}", offsets.back(), entries_),
                       "offsets must ascend to the number of entries");
    }
    slice.cell_vertices.offsets.clear();
    for (const GlobalIndex offset : offsets) slice.cell_vertices.offsets.push_back(offset - first_entry);
    const std::vector<int> numbers = numbers_of<int>(types, array(Role::types).type);
    for (std::size_t c = 0; c < numbers.size(); ++c) {
      const std::optional<Shape> shape = shape_of_vtk_type(numbers[c]);
      const auto vertices = static_cast<int>(offsets[c + 1] - offsets[c]);
      if (!shape || *shape == Shape::polyhedron || vertices < corners(*shape, 1)) {
        throw InputError(path_,
                         fmt::format("cell {} (counted from 0) is of VTK's type {} and has {} points",
                                     first_cell + static_cast<GlobalIndex>(c), numbers[c], vertices),
                         "the type is not understood, or has more points");
      }
      slice.shapes.push_back(*shape);
    }
  });
  const std::vector<std::byte> connectivity = rows(communicator, file, Role::connectivity, first_entry,
                                                   first_entry + slice.cell_vertices.offsets.back());
  communicator.together([&] {
    slice.cell_vertices.entries = numbers_of<GlobalIndex>(connectivity, array(Role::connectivity).type);
    for (const GlobalIndex vertex : slice.cell_vertices.entries) {
      if (vertex >= 0 && vertex < vertices_) continue;
      throw InputError(path_, fmt::format("a cell names the point {}", vertex),
                       fmt::format("the file has points 0 to {}", vertices_ - 1));
    }
  });
}

/// Copies all that is no row of an array, and gives the new file its size.
void VtuSlices::copy_rest(const std::string& path, const std::string& name) const {
  std::vector<std::pair<Offset, Offset>> rows;
  for (const Array& array : arrays_) rows.emplace_back(array.at, array.at + array.size);
  rows.emplace_back(bytes_, bytes_);
  std::sort(rows.begin(), rows.end());
  std::ifstream from(path_, std::ios::binary);
  std::ofstream to(path, std::ios::binary | std::ios::in | std::ios::out);
  std::vector<char> buffer(static_cast<std::size_t>(kChunk));
  Offset at = 0;
  for (const auto& [begin, end] : rows) {
    for (; at < begin; at += kChunk) {
      const Offset count = std::min(kChunk, begin - at);
      from.seekg(at);
      from.read(buffer.data(), count);
      to.seekp(at);
      to.write(buffer.data(), count);
    }
    at = end;
  }
  if (!from) throw InputError(path_, "cannot be read", "it may have changed while it was read");
  to.close();
  if (!to) throw InputError(name, "cannot be written", "the disk may be full");
}

void VtuSlices::write(const Communicator& communicator, const std::string& path, const std::string& name,
                      const DistributedOrder& order) const {
  communicator.at_root([&] { copy_rest(path, name); });
  const int rank = communicator.rank();
  GridRows grid = in_new_order(communicator, order);
  SharedFile out(communicator, path, name, SharedFile::Use::write);
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    const Array& array = arrays_[k];
    if (array.role == Role::offsets || array.role == Role::connectivity) continue;
    const Layout& layout = array.association == Association::vertices ? grid.vertices : grid.cells;
    out.write(array.at + layout.begin(rank) * array.row, grid.rows(k));
  }

  const Rows moved = std::move(grid.cell_vertices);
  const GlobalIndex first_cell = grid.cells.begin(rank);
  GlobalIndex first_entry = 0;
  const std::vector<GlobalIndex> sizes =
      communicator.gathered(static_cast<GlobalIndex>(moved.entries.size()));
  for (int r = 0; r < rank; ++r) first_entry += sizes[static_cast<std::size_t>(r)];
  const Array& entries = array(Role::connectivity);
  out.write(entries.at + first_entry * entries.row,
            communicator.together([&] { return bytes_of(moved.entries, entries.type); }));
  const Array& ends = array(Role::offsets);
  out.write(ends.at + first_cell * ends.row, communicator.together([&] {
    std::vector<GlobalIndex> numbers(moved.offsets.begin() + 1, moved.offsets.end());
    for (GlobalIndex& number : numbers) number += first_entry;
    return bytes_of(numbers, ends.type);
  }));
  out.close();
}

std::vector<GlobalIndex> places_by_dimension(const Communicator& communicator, const MeshSlice& slice,
                                             const std::vector<GlobalIndex>& in_order) {
  constexpr int kDimensions = 4;
  const int rank = communicator.rank();
  const GlobalIndex first_cell = slice.cells.begin(rank);
  const std::vector<int> own = communicator.together([&] {
    std::vector<int> dimensions;
    for (const Shape shape : slice.shapes) dimensions.push_back(dimension(shape));
    return dimensions;
  });
  const Halo listed(communicator, slice.cells, in_order);
  const std::vector<int> dimensions = listed.fetch(own);
  std::vector<GlobalIndex> places(in_order.size());
  for (int d = 0; d < kDimensions; ++d) {
    const std::vector<GlobalIndex> slots = communicator.together([&] {
      std::vector<GlobalIndex> result;
      for (std::size_t c = 0; c < own.size(); ++c) {
        if (own[c] == d) result.push_back(first_cell + static_cast<GlobalIndex>(c));
      }
      return result;
    });
    const std::vector<std::size_t> cells = communicator.together([&] {
      std::vector<std::size_t> result;
      for (std::size_t k = 0; k < in_order.size(); ++k) {
        if (dimensions[listed.position(in_order[k])] == d) result.push_back(k);
      }
      return result;
    });
    const auto starts = [&](std::size_t size) {
      std::vector<GlobalIndex> result(1, 0);
      for (const GlobalIndex count : communicator.gathered(static_cast<GlobalIndex>(size)))
        result.push_back(result.back() + count);
      return result;
    };
    const GlobalIndex first = starts(cells.size())[static_cast<std::size_t>(rank)];
    const Layout slot_layout(starts(slots.size()));
    std::vector<GlobalIndex> wanted(cells.size());
    std::iota(wanted.begin(), wanted.end(), first);
    const Halo halo(communicator, slot_layout, wanted);
    const std::vector<GlobalIndex> found = halo.fetch(slots);
    for (std::size_t k = 0; k < cells.size(); ++k) places[cells[k]] = found[halo.position(wanted[k])];
  }
  return delivered<GlobalIndex>(communicator, slice.cells, in_order, places, GlobalIndex{-1});
}

}  // namespace meshorder::distributed
