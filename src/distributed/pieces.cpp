// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/pieces.hpp"

#include "distributed/halo.hpp"
#include "distributed/number_types.hpp"
#include "distributed/parts.hpp"
#include "distributed/piece_contents.hpp"
#include <meshorder/error.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <span>

namespace meshorder::distributed {
namespace {

using Source = PieceArray::Source;

/// Takes the rows of some numbers out of those of a halo.
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

/// Replaces places among texts by these, each with a zero behind it.
std::vector<std::byte> spelt_out(const std::vector<std::byte>& places,
                                 const std::vector<std::string>& texts) {
  std::vector<std::byte> result;
  for (std::size_t at = 0; at < places.size(); at += sizeof(std::int32_t)) {
    std::int32_t place = 0;
    std::memcpy(&place, places.data() + at, sizeof(place));
    const std::string& text = texts[static_cast<std::size_t>(place)];
    const auto bytes = std::as_bytes(std::span(text.c_str(), text.size() + 1));
    result.insert(result.end(), bytes.begin(), bytes.end());
  }
  return result;
}

/// The values of an array that a piece has and its mesh does not.
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
    if (is_taken) rows = halo.fetch_rows(grid_.rows(array.number), array.row);
    communicator_.together([&] {
      for (std::size_t p = 0; p < pieces_.size(); ++p) {
        const PieceContents& piece = pieces_[p];
        if (!is_taken) {
          take(p, own_values(array, piece, part_starts_));
          continue;
        }
        std::vector<std::byte> values =
            rows_of(rows, array.row, halo, array.is_on_vertices() ? piece.vertices : piece.cells);
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
        result[p].push_back(std::ssize(numbers) * array.row);
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

/// Appends bytes to a file that exists.
void append(const std::string& path, const std::string& name, std::string_view text,
            std::span<const std::byte> bytes = {}) {
  std::ofstream file(path, std::ios::binary | std::ios::in | std::ios::out | std::ios::ate);
  file.write(text.data(), std::ssize(text));
  file.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  file.close();
  if (!file) throw InputError(name, "cannot be written", "the disk may be full");
}

/// The word before the values of an array.
std::string size_word(Offset size, Offset word, const std::string& name) {
  if (word == 4 && size > Offset{std::numeric_limits<std::uint32_t>::max()}) {
    throw TooLarge(name +
                   ": an array of more than 4 GiB, which sizes of 32 bits cannot tell; give more --parts");
  }
  std::string text(static_cast<std::size_t>(word), '\0');
  const auto wide = static_cast<std::uint64_t>(size);
  const auto narrow = static_cast<std::uint32_t>(wide);
  std::memcpy(text.data(), word == 8 ? static_cast<const void*>(&wide) : &narrow, text.size());
  return text;
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
  PiecesReport report;
  communicator.together([&] {
    for (std::size_t p = 0; p < own.pieces().size(); ++p) {
      append(paths[part(p)], names[part(p)], PieceSchema::kEnd);
      report.ghost_vertices += own.pieces()[p].ghost_vertices();
      report.ghost_cells += own.pieces()[p].ghost_cells();
    }
  });
  report.ghost_vertices = communicator.sum(report.ghost_vertices);
  report.ghost_cells = communicator.sum(report.ghost_cells);
  return report;
}

}  // namespace meshorder::distributed
