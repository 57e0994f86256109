// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/appended_arrays.hpp"
#include "distributed/files/file_rows.hpp"
#include "distributed/files/file_slices.hpp"
#include "distributed/files/slice_reader.hpp"
#include "distributed/files/text_store.hpp"
#include "distributed/order/cell_order.hpp"
#include "io/stream/base64.hpp"
#include "io/stream/read_limits.hpp"
#include "io/vtk/vtu_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::distributed {
namespace {

constexpr std::string_view kEndOfHead = "</AppendedData></VTKFile>";

/// Returns an array of a file's appended data as base64, beginning with a word that gives its size.
std::string as_text(const std::string& path, const vtk::VtuDocument& document, Offset first_byte,
                    const vtk::VtuElement& element) {
  constexpr std::uint8_t kByte = 3;  // number type
  FilePart part{.type = kByte};
  std::vector<Offset> bounds;
  part.rows = AppendedArrays(path, document, first_byte, 1).place(element, part, bounds);
  const Communicator alone(MPI_COMM_SELF);
  const std::vector<std::byte> values =
      read_values(alone, SharedFile(alone, path, path, SharedFile::Use::read),
                  {path, std::string(element.text_of("Name"))}, document.encoding().compressor, part, bounds,
                  0, part.rows);
  return to_base64(vtk::vtu_words({values.size()}, document.encoding()) +
                   std::string(reinterpret_cast<const char*>(values.data()), values.size()));
}

/// Returns the <FieldData> of a file with all values inline.
std::string fields_with_values(const std::string& head, const std::string& path) {
  TextStore store(head + std::string(kEndOfHead));
  const FilePath in_store(path, store);
  const ReadScope scope(in_store);
  count_file(in_store, std::filesystem::file_size(path));
  const vtk::VtuDocument file(in_store);
  const vtk::VtuElement* const fields = file.root().child("UnstructuredGrid")->child("FieldData");
  if (fields == nullptr) return "";
  std::string text = "<FieldData>";
  for (const vtk::VtuElement& element : fields->children) {
    if (element.text_of("format") != "appended") {
      text += file.source(element);
      continue;
    }
    std::string attributes;
    for (const auto& [name, value] : element.attributes) {
      if (name != "format" && name != "offset")
        attributes += fmt::format(" {}=\"{}\"", name, xml_escaped(value));
    }
    text += fmt::format("<{0}{1} format=\"binary\">{2}</{0}>", element.name, attributes,
                        as_text(path, file, std::ssize(head), element));
  }
  return text + "</FieldData>";
}

}  // namespace

GridRows FileSlices::in_new_order(const Communicator& communicator, const DistributedOrder& order) const {
  const auto moved = std::make_shared<MovedFile>(communicator, path_, head_, order);
  const MeshSlice slice = moved->reader().empty_slice();
  GridRows grid;
  grid.vertices = slice.vertices;
  grid.cells = slice.cells;
  grid.rows = [this, moved](std::size_t k) {
    return moved->rows(*std::find_if(head_.parts.begin(), head_.parts.end(),
                                     [&](const FilePart& part) { return part.number == k; }));
  };
  grid.cell_vertices = std::move(moved->cells());
  communicator.at_root([&] {
    grid.xml = head_.mold;
    if (head_.facts.kind == FileFacts::Kind::vtkhdf) return;
    grid.xml = head_.xml.text() + std::string(kEndOfHead);
    grid.fields = fields_with_values(head_.xml.text(), path_);
  });
  return grid;
}

}  // namespace meshorder::distributed
