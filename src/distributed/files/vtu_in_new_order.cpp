// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/input_file.hpp"
#include "distributed/comm/moved_rows.hpp"
#include "distributed/files/file_slices.hpp"
#include "distributed/files/mold.hpp"
#include "distributed/files/text_store.hpp"
#include "distributed/order/cell_order.hpp"
#include "io/stream/base64.hpp"
#include "io/stream/read_limits.hpp"
#include "io/vtk/vtu_compressor.hpp"
#include "io/vtk/vtu_document.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::distributed {
namespace {

constexpr std::string_view kEndOfHead = "</AppendedData></VTKFile>";

/// Reads the values of appended arrays at the root.
class AppendedValues {
 public:
  AppendedValues(const std::string& path, Offset first_byte, const vtk::VtuDocument& document)
      : path_(path),
        file_(path),
        first_byte_(first_byte),
        document_(document),
        encoding_(document.encoding()) {}

  /// Returns an array with the word of its size before it, as base64.
  std::string as_text(const vtk::VtuElement& element) {
    const Offset at = whole_number(document_, element, "offset");
    if (at > static_cast<Offset>(file_.size()) - first_byte_) fail_at_end();
    at_ = static_cast<std::uint64_t>(first_byte_ + at);
    const bool is_raw = encoding_.compressor == VtuEncoding::Compressor::none;
    const std::string values = is_raw ? bytes(word()) : from_blocks(element);
    const std::uint64_t size = values.size();
    return to_base64(std::string(reinterpret_cast<const char*>(&size), word_size()) + values);
  }

 private:
  [[nodiscard]] std::size_t word_size() const { return encoding_.wide_headers ? 8 : 4; }

  /// Reads the next word; throws InputError at the end of the file.
  std::uint64_t word() {
    std::uint64_t value = 0;
    take({reinterpret_cast<char*>(&value), word_size()});
    return value;
  }

  std::string bytes(std::uint64_t count) {
    if (count > file_.size() - std::min(at_, file_.size())) fail_at_end();
    std::string result(count, '\0');
    take(result);
    return result;
  }

  void take(std::span<char> into) {
    if (file_.read_at(at_, into) < into.size()) fail_at_end();
    at_ += into.size();
  }

  /// Reads the values of compressed blocks. Words before them are the number of blocks, the bytes of each,
  /// the bytes of the last one if it differs, and the compressed bytes of each.
  std::string from_blocks(const vtk::VtuElement& element) {
    const std::uint64_t count = word();
    const std::uint64_t each = word();
    const std::uint64_t last = word();
    std::vector<std::uint64_t> sizes;
    for (std::uint64_t b = 0; b < count; ++b) sizes.push_back(word());
    const vtk::VtuCompressor compressor(encoding_.compressor);
    std::string values;
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      const std::string compressed = bytes(sizes[b]);
      const std::uint64_t size = b + 1 == sizes.size() && last > 0 ? last : each;
      if (size > compressed.size() * vtk::VtuCompressor::greatest_ratio(encoding_.compressor) + 1024) fail();
      document_.claim(element, size);
      std::string block(size, '\0');
      if (!compressor.uncompress(compressed, block)) fail();
      values += block;
    }
    return values;
  }

  [[noreturn]] void fail_at_end() const {
    throw InputError(path_, "a field lies beyond the end of the file", "it may be cut short");
  }
  [[noreturn]] void fail() const {
    throw InputError(path_, "a block of a field does not hold what it should", "the file may be damaged");
  }

  const std::string& path_;
  InputFile file_;
  std::uint64_t at_ = 0;  ///< of the next byte to read
  Offset first_byte_;
  const vtk::VtuDocument& document_;
  VtuEncoding encoding_;
};

/// Returns the <FieldData> of a file with all values inline.
std::string fields_with_values(const std::string& head, const std::string& path) {
  TextStore store(head + std::string(kEndOfHead));
  const FilePath in_store(path, store);
  const ReadScope scope(in_store);
  count_file(in_store, std::filesystem::file_size(path));
  const vtk::VtuDocument file(in_store);
  const vtk::VtuElement* const fields = file.root().child("UnstructuredGrid")->child("FieldData");
  if (fields == nullptr) return "";
  AppendedValues values(path, std::ssize(head), file);
  std::string text = "<FieldData>";
  for (const vtk::VtuElement& element : fields->children) {
    if (element.attribute("format") == nullptr || *element.attribute("format") != "appended") {
      text += file.source(element);
      continue;
    }
    std::string attributes;
    for (const auto& [name, value] : element.attributes) {
      if (name != "format" && name != "offset")
        attributes += fmt::format(" {}=\"{}\"", name, xml_escaped(value));
    }
    text +=
        fmt::format("<{0}{1} format=\"binary\">{2}</{0}>", element.name, attributes, values.as_text(element));
  }
  return text + "</FieldData>";
}

}  // namespace

GridRows FileSlices::in_new_order(const Communicator& communicator, const DistributedOrder& order) const {
  const auto file = std::make_shared<SharedFile>(communicator, path_, path_, SharedFile::Use::read);
  MeshSlice slice = empty_slice(communicator);
  read_shapes(communicator, *file, slice);
  const auto vertices = std::make_shared<RowMover>(communicator, slice.vertices, order.new_vertices);
  const auto cells = std::make_shared<RowMover>(communicator, slice.cells,
                                                places_by_dimension(communicator, slice, order.cells));
  GridRows grid;
  grid.vertices = slice.vertices;
  grid.cells = slice.cells;
  grid.rows = [this, &communicator, file, vertices, cells](std::size_t k) {
    const FileArray& array = *std::find_if(head_.arrays.begin(), head_.arrays.end(),
                                           [&](const FileArray& one) { return one.element == k; });
    return moved_rows(communicator, *file, array, *vertices, *cells);
  };
  grid.cell_vertices = moved_cells(communicator, *file, std::move(slice), *cells, order.new_vertices);
  communicator.at_root([&] {
    if (head_.facts.kind == FileFacts::Kind::vtkhdf) {
      grid.xml = head_.mold;
      grid.fields = fields_of(head_.mold);
      return;
    }
    const std::string& head = head_.xml.text();
    grid.xml = head + std::string(kEndOfHead);
    grid.fields = fields_with_values(head, path_);
  });
  return grid;
}

}  // namespace meshorder::distributed
