// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/halo.hpp"
#include "distributed/moved_rows.hpp"
#include "distributed/text_store.hpp"
#include "distributed/vtu_slices.hpp"
#include "io/stream/base64.hpp"
#include "io/vtk/vtu_document.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <fstream>
#include <memory>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

constexpr std::string_view kEndOfHead = "</AppendedData></VTKFile>";

/// Returns the bytes of an appended array with the word before them, as base64.
std::string appended_as_text(std::ifstream& file, Offset first_byte, Offset word, const std::string& offset,
                             const std::string& path) {
  Offset at = 0;
  std::from_chars(offset.data(), offset.data() + offset.size(), at);
  std::uint64_t size = 0;
  file.seekg(first_byte + at);
  file.read(reinterpret_cast<char*>(&size), word);
  const Offset begin = first_byte + at + word;
  file.seekg(0, std::ios::end);
  if (!file || size > static_cast<std::uint64_t>(file.tellg() - std::streamoff{begin}))
    throw InputError(path, "a field lies beyond the end of the file", "it may be cut short");
  std::string bytes(static_cast<std::size_t>(word) + size, '\0');
  file.seekg(begin - word);
  file.read(bytes.data(), std::ssize(bytes));
  return to_base64(bytes);
}

/// Returns the fields of a file with their values in them.
std::string fields_with_values(const std::string& head, const std::string& path) {
  TextStore store(head + std::string(kEndOfHead));
  const vtk::VtuDocument file(FilePath(path, store));
  const vtk::VtuElement* const fields = file.root().child("UnstructuredGrid")->child("FieldData");
  if (fields == nullptr) return "";
  std::ifstream bytes(path, std::ios::binary);
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
    text += fmt::format("<{0}{1} format=\"binary\">{2}</{0}>", element.name, attributes,
                        appended_as_text(bytes, std::ssize(head), file.encoding().wide_headers ? 8 : 4,
                                         file.required(element, "offset"), path));
  }
  return text + "</FieldData>";
}

}  // namespace

GridRows VtuSlices::in_new_order(const Communicator& communicator, const DistributedOrder& order) const {
  const auto file = std::make_shared<SharedFile>(communicator, path_, path_, SharedFile::Use::read);
  MeshSlice slice = empty_slice(communicator);
  read_cells(communicator, *file, slice);
  const auto vertices = std::make_shared<RowMover>(communicator, slice.vertices, order.new_vertices);
  const auto cells = std::make_shared<RowMover>(communicator, slice.cells,
                                                places_by_dimension(communicator, slice, order.cells));
  {
    std::vector<GlobalIndex>& numbers = slice.cell_vertices.entries;
    const Halo halo(communicator, slice.vertices, numbers);
    const std::vector<GlobalIndex> new_numbers = halo.fetch(order.new_vertices);
    for (GlobalIndex& number : numbers) number = new_numbers[halo.position(number)];
  }
  GridRows grid;
  grid.vertices = slice.vertices;
  grid.cells = slice.cells;
  grid.cell_vertices = cells->moved(slice.cell_vertices);
  grid.rows = [this, &communicator, file, vertices, cells, of_vertices = slice.vertices,
               of_cells = slice.cells](std::size_t k) {
    const Array& array = arrays_[k];
    const bool on_vertices = array.association == Association::vertices;
    const Layout& layout = on_vertices ? of_vertices : of_cells;
    std::vector<std::byte> rows = communicator.together([&] {
      return std::vector<std::byte>(static_cast<std::size_t>(layout.size(communicator.rank()) * array.row));
    });
    file->read(array.at + layout.begin(communicator.rank()) * array.row, rows);
    return (on_vertices ? vertices : cells)->moved(rows, array.row);
  };
  communicator.at_root([&] {
    grid.xml = head_ + std::string(kEndOfHead);
    grid.fields = fields_with_values(head_, path_);
  });
  return grid;
}

}  // namespace meshorder::distributed
