// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/pieces.hpp"

#include "distributed/comm/halo.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/file_rows.hpp"
#include "distributed/files/piece_contents.hpp"
#include "distributed/files/shared_file.hpp"
#include "distributed/files/text_store.hpp"
#include "distributed/order/partition.hpp"
#include "io/stream/descriptor.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_document.hpp"
#ifdef MESHORDER_HAS_HDF5
#include "io/vtkhdf/vtkhdf.hpp"
#endif
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace meshorder::distributed {
namespace {

using Source = PieceArray::Source;

/// Returns the rows of the given numbers; `rows` holds a row for each of the halo's numbers.
std::vector<std::byte> rows_of(const std::vector<std::byte>& rows, Offset width, const Halo& halo,
                               const std::vector<GlobalIndex>& numbers) {
  std::vector<std::byte> result(numbers.size() * static_cast<std::size_t>(width));
  std::byte* to = result.data();
  for (const GlobalIndex number : numbers) {
    std::memcpy(to, rows.data() + static_cast<Offset>(halo.position(number)) * width,
                static_cast<std::size_t>(width));
    to += width;
  }
  return result;
}

/// Returns the texts at these positions of the list, each followed by a zero byte.
std::vector<std::byte> spelt_out(const std::vector<std::byte>& places,
                                 const std::vector<std::string>& texts) {
  std::vector<std::byte> result;
  for (std::size_t at = 0; at < places.size(); at += sizeof(std::int32_t)) {
    std::int32_t place = 0;
    std::memcpy(&place, places.data() + at, sizeof(place));
    const std::string& text = texts[place];
    const auto bytes = std::as_bytes(std::span(text.c_str(), text.size() + 1));
    result.insert(result.end(), bytes.begin(), bytes.end());
  }
  return result;
}

/// Returns the values of an array that is made for a piece, not taken from the mesh.
std::vector<std::byte> own_values(const PieceArray& array, const PieceContents& piece,
                                  const std::vector<GlobalIndex>& part_starts) {
  const std::vector<GlobalIndex>& numbers = array.is_on_vertices() ? piece.vertices : piece.cells;
  switch (array.source) {
    case Source::global_ids:
      return bytes_of(numbers, array.type);
    case Source::ghost_type: {
      const auto own =
          static_cast<std::size_t>(array.is_on_vertices() ? piece.own_vertices : piece.own_cells);
      std::vector<int> marks(numbers.size(), 1);  // vtkDataSetAttributes::DUPLICATEPOINT, DUPLICATECELL
      std::fill_n(marks.begin(), own, 0);
      return bytes_of(marks, array.type);
    }
    case Source::part: {
      if (!array.is_on_vertices()) return bytes_of(piece.cell_parts, array.type);
      std::vector<Index> parts;
      for (const GlobalIndex vertex : piece.vertices) parts.push_back(part_of(vertex, part_starts));
      return bytes_of(parts, array.type);
    }
    case Source::connectivity:
      return bytes_of(piece.cell_vertices.entries, array.type);
    default:
      return bytes_of(
          std::vector<Offset>(piece.cell_vertices.offsets.begin() + 1, piece.cell_vertices.offsets.end()),
          array.type);
  }
}

/// The pieces of this rank, and the values of their arrays.
class RankPieces {
 public:
  RankPieces(const Communicator& communicator, const GridRows& grid, const PieceSchema& schema,
             const std::vector<GlobalIndex>& part_starts, bool with_ghosts)
      : communicator_(communicator),
        grid_(grid),
        schema_(schema),
        part_starts_(part_starts),
        texts_(communicator.broadcast(grid.texts)),
        pieces_(contents_of_pieces(communicator, grid.vertices.size(), grid.cells, grid.cell_vertices,
                                   part_starts, with_ghosts)),
        vertices_(communicator, grid.vertices, all_numbers(&PieceContents::vertices)),
        cells_(communicator, grid.cells, all_numbers(&PieceContents::cells)) {}

  [[nodiscard]] const std::vector<PieceContents>& pieces() const noexcept { return pieces_; }

  /// Calls `take(piece, bytes)` with the values of an array in each piece. Every rank has to call it.
  template <class Take>
  void for_values(const PieceArray& array, const Take& take) const {
    const bool is_taken = array.source == Source::rows || array.source == Source::texts;
    const Halo& halo = array.is_on_vertices() ? vertices_ : cells_;
    std::vector<std::byte> rows;
    if (is_taken) rows = halo.fetch_rows(grid_.rows(array.number), array.row_size());
    communicator_.together([&] {
      for (std::size_t p = 0; p < pieces_.size(); ++p) {
        const PieceContents& piece = pieces_[p];
        if (!is_taken) {
          take(p, own_values(array, piece, part_starts_));
          continue;
        }
        std::vector<std::byte> values =
            rows_of(rows, array.row_size(), halo, array.is_on_vertices() ? piece.vertices : piece.cells);
        if (array.source == Source::texts) values = spelt_out(values, texts_);
        take(p, values);
      }
    });
  }

  /// Returns the bytes of each array of a piece. Every rank has to call it.
  [[nodiscard]] std::vector<std::vector<Offset>> sizes() const {
    std::vector<std::vector<Offset>> result(pieces_.size());
    for (const PieceArray& array : schema_.arrays()) {
      if (array.source == Source::texts) {
        for_values(array, [&](std::size_t p, const std::vector<std::byte>& values) {
          result[p].push_back(std::ssize(values));
        });
        continue;
      }
      for (std::size_t p = 0; p < pieces_.size(); ++p) {
        const PieceContents& piece = pieces_[p];
        const auto& numbers = array.source == Source::connectivity ? piece.cell_vertices.entries
                              : array.is_on_vertices()             ? piece.vertices
                                                                   : piece.cells;
        result[p].push_back(std::ssize(numbers) * array.row_size());
      }
    }
    return result;
  }

 private:
  [[nodiscard]] std::vector<GlobalIndex> all_numbers(std::vector<GlobalIndex> PieceContents::*of) const {
    return communicator_.together([&] {
      std::vector<GlobalIndex> numbers;
      for (const PieceContents& piece : pieces_)
        numbers.insert(numbers.end(), (piece.*of).begin(), (piece.*of).end());
      return numbers;
    });
  }

  const Communicator& communicator_;
  const GridRows& grid_;
  const PieceSchema& schema_;
  const std::vector<GlobalIndex>& part_starts_;
  std::vector<std::string> texts_;
  std::vector<PieceContents> pieces_;
  Halo vertices_;
  Halo cells_;
};

/// Appends a text and then bytes to an existing file.
void append(const std::string& path, const std::string& name, std::string_view text,
            std::span<const std::byte> bytes = {}) {
  Descriptor file(path, O_WRONLY | O_APPEND);
  int fault = file.is_open() ? file.write(text) : errno;
  if (fault == 0) fault = file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (fault == 0) fault = file.close();
  if (fault != 0) throw_system_fault(name, "cannot be written", fault);
}

PiecesReport report_on(const Communicator& communicator, const std::vector<PieceContents>& own) {
  PiecesReport report;
  for (const PieceContents& piece : own) {
    report.ghost_vertices += piece.ghost_vertices();
    report.ghost_cells += piece.ghost_cells();
  }
  report.ghost_vertices = communicator.sum(report.ghost_vertices);
  report.ghost_cells = communicator.sum(report.ghost_cells);
  return report;
}

/// Returns the word before the values of an array: their size in bytes.
std::string size_word(Offset size, Offset word, const std::string& name) {
  if (word == 4 && size > Offset{std::numeric_limits<std::uint32_t>::max()}) {
    throw TooLarge(name +
                   ": an array of more than 4 GiB, which sizes of 32 bits cannot hold; give more --parts");
  }
  return vtk::vtu_words({static_cast<std::uint64_t>(size)}, {.wide_headers = word == 8});
}

}  // namespace

PieceSchema schema_of_pieces(const Communicator& communicator, const GridRows& grid, int ghosts) {
  const std::vector<std::string> texts = communicator.broadcast(std::vector{grid.xml, grid.fields});
  return communicator.together([&] { return PieceSchema(texts[0], texts[1], ghosts); });
}

PiecesReport write_pieces(const Communicator& communicator, const GridRows& grid, const PieceSchema& schema,
                          const std::vector<GlobalIndex>& part_starts, bool with_ghosts,
                          const std::vector<std::string>& paths, const std::vector<std::string>& names) {
  const RankPieces own(communicator, grid, schema, part_starts, with_ghosts);
  const auto part = [&](std::size_t p) { return static_cast<std::size_t>(own.pieces()[p].part); };
  const std::vector<std::vector<Offset>> sizes = own.sizes();
  communicator.together([&] {
    for (std::size_t p = 0; p < own.pieces().size(); ++p) {
      const PieceContents& piece = own.pieces()[p];
      append(paths[part(p)], names[part(p)],
             schema.head(std::ssize(piece.vertices), std::ssize(piece.cells), sizes[p]));
    }
  });
  for (const PieceArray& array : schema.arrays()) {
    own.for_values(array, [&](std::size_t p, const std::vector<std::byte>& values) {
      append(paths[part(p)], names[part(p)], size_word(std::ssize(values), schema.word(), names[part(p)]),
             values);
    });
  }
  communicator.together([&] {
    for (std::size_t p = 0; p < own.pieces().size(); ++p)
      append(paths[part(p)], names[part(p)], PieceSchema::kEnd);
  });
  return report_on(communicator, own.pieces());
}

Notes losses_in_vtkhdf(const PieceSchema& schema) {
  Notes notes;
  for (const PieceArray& array : schema.arrays()) {
    const std::string where =
        fmt::format("'{}' on {}", array.name, array.is_on_vertices() ? "vertices" : "cells");
    if (array.source == Source::texts) {
      notes.push_back(fmt::format("the array {} is not in the pieces: VTKHDF cannot hold it", where));
    } else if (array.attributes.find(" ComponentName") != std::string::npos || !array.inside.empty()) {
      notes.push_back(fmt::format(
          "the names of components and the information of the array {} are not in the pieces: VTKHDF "
          "cannot hold them",
          where));
    }
  }
  return notes;
}

#ifdef MESHORDER_HAS_HDF5
namespace {

/// Number type of connectivity and offsets, the same as in VTK's own writer.
constexpr std::uint8_t kInt64 = 8;

/// Returns the arrays of the pieces that VTKHDF can hold, with the sum of their rows over all partitions.
std::vector<PieceArray> arrays_in_vtkhdf(const PieceSchema& schema,
                                         const std::vector<vtkhdf::Partition>& partitions) {
  std::vector<PieceArray> arrays;
  for (PieceArray array : schema.arrays()) {
    if (array.source == Source::texts) continue;
    if (array.source == Source::connectivity || array.source == Source::offsets) array.type = kInt64;
    for (const vtkhdf::Partition& partition : partitions) {
      array.rows += array.is_on_vertices()                 ? partition.points
                    : array.source == Source::connectivity ? partition.entries
                    : array.source == Source::offsets      ? partition.cells + 1
                                                           : partition.cells;
    }
    arrays.push_back(std::move(array));
  }
  return arrays;
}

/// Throws SharedError for higher-order hexahedra with the node order of VTK before version 9.
void refuse_old_hexahedra(const Communicator& communicator, const GridRows& grid, const PieceSchema& schema,
                          const std::string& name) {
  if (schema.has_order_of_vtk_9()) return;
  for (const PieceArray& array : schema.arrays()) {
    if (array.role != FilePart::Role::types || array.source != Source::rows) continue;
    const std::vector<std::byte> own = grid.rows(array.number);
    communicator.together([&] {
      const std::vector<int> types = numbers_of<int>(own, array.type);
      if (std::none_of(types.begin(), types.end(), [](int type) {
            return type >= 0 && type < 256 &&
                   vtk::is_higher_order_hexahedron(static_cast<std::uint8_t>(type));
          })) {
        return;
      }
      throw InputError(name, "the mesh has hexahedra of higher order, numbered as before VTK 9",
                       "give a folder for pieces in .vtu files, or save the mesh by a later VTK first");
    });
  }
}

/// Returns the fields of the pieces.
std::vector<DataArray> field_arrays(const PieceSchema& schema) {
  TextStore store(schema.fields_alone());
  Notes ignored;
  const Mesh mesh = vtk::read_vtu(FilePath("the fields of the mesh", store), ignored);
  return dynamic_cast<const vtk::VtkMetadata&>(*mesh.format_metadata).fields;
}

}  // namespace

PiecesReport write_pieces_to_vtkhdf(const Communicator& communicator, const GridRows& grid,
                                    const PieceSchema& schema, const std::vector<GlobalIndex>& part_starts,
                                    bool with_ghosts, const std::string& path, const std::string& name) {
  refuse_old_hexahedra(communicator, grid, schema, name);
  const RankPieces own(communicator, grid, schema, part_starts, with_ghosts);
  std::vector<vtkhdf::Partition> partitions;
  for (const PieceContents& piece : own.pieces()) {
    partitions.push_back(
        {std::ssize(piece.vertices), std::ssize(piece.cells), std::ssize(piece.cell_vertices.entries)});
  }
  // rank order is the order of the parts, because ranks have ascending ranges of parts
  partitions = communicator.gathered_at_root(partitions);
  const std::vector<PieceArray> arrays = arrays_in_vtkhdf(schema, partitions);
  PiecesReport report = report_on(communicator, own.pieces());
  const std::vector<Offset> places = communicator.broadcast(communicator.at_root([&] {
    FileLayout layout;
    for (const PieceArray& array : arrays) {
      layout.parts.push_back(array);
      layout.parts.back().number = layout.names.size();
      layout.names.push_back(array.name);
    }
    vtk::VtkMetadata metadata;
    metadata.roles = schema.roles();
    metadata.fields = field_arrays(schema);
    vtkhdf::write_without_values(path, name, partitions, layout, metadata, report.notes);
    std::vector<Offset> found;
    for (const FilePart& part : layout.parts) found.push_back(part.at);
    return found;
  }));
  SharedFile file(communicator, path, name, SharedFile::Use::write);
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    std::vector<std::byte> rows;
    own.for_values(arrays[k], [&](std::size_t /*p*/, const std::vector<std::byte>& values) {
      // in VTKHDF a partition's offsets begin with 0
      if (arrays[k].source == Source::offsets) rows.insert(rows.end(), sizeof(std::int64_t), std::byte{0});
      rows.insert(rows.end(), values.begin(), values.end());
    });
    write_raw(communicator, file, places[k], rows);
  }
  file.close();
  return report;
}
#else
PiecesReport write_pieces_to_vtkhdf(const Communicator& /*communicator*/, const GridRows& /*grid*/,
                                    const PieceSchema& /*schema*/,
                                    const std::vector<GlobalIndex>& /*part_starts*/, bool /*with_ghosts*/,
                                    const std::string& /*path*/, const std::string& name) {
  throw Unavailable(name + ": VTKHDF needs HDF5, which this build of meshorder lacks");
}
#endif

}  // namespace meshorder::distributed
