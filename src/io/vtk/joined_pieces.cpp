// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/vtk/vtk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace meshorder::vtk {
namespace {

constexpr std::string_view kGhostType = "vtkGhostType";
/// Bit in an entry of vtkGhostType: another piece owns the point or cell.
constexpr std::int64_t kOfAnotherPiece = 1;

class PieceJoiner {
 public:
  PieceJoiner(const Pieces& pieces, const ErrorAt& error, Notes& notes)
      : pieces_(pieces), error_(error), notes_(notes) {}

  void join() {
    const std::vector<Index> cells = cells_kept();
    const std::vector<Index> points = points_kept(cells);
    take_cells_of(cells);
    const std::vector<Point> all = std::move(pieces_.points);
    pieces_.points.clear();
    for (const Index row : points) pieces_.points.push_back(all[row]);
    take_rows(Association::vertices, points);
    take_rows(Association::cells, cells);
    for (const Association association : {Association::vertices, Association::cells}) {
      forget_other_pieces(association);
      if (const std::string ids = name_of_ids(association); tells_places(association, ids))
        erase(association, ids);
    }
  }

 private:
  [[nodiscard]] Index count(Association association) const {
    return association == Association::vertices ? index_size(pieces_.points)
                                                : index_size(pieces_.cells.types);
  }

  [[nodiscard]] const DataArray* find(Association association, std::string_view name) const {
    const auto found = std::find_if(
        pieces_.arrays.begin(), pieces_.arrays.end(),
        [&](const DataArray& array) { return array.association == association && array.name == name; });
    return found == pieces_.arrays.end() ? nullptr : &*found;
  }

  void erase(Association association, const std::string& name) {
    std::erase_if(pieces_.arrays, [&](const DataArray& array) {
      return array.association == association && array.name == name;
    });
    std::erase_if(pieces_.roles, [&](const ArrayRole& role) {
      return role.association == association && role.array == name;
    });
  }

  /// Clears kOfAnotherPiece in vtkGhostType for the rows that stayed; removes the array if only zeros
  /// are left.
  void forget_other_pieces(Association association) {
    bool says_more = false;
    for (DataArray& array : pieces_.arrays) {
      if (array.association != association || array.name != kGhostType) continue;
      says_more = !with_integers(array.values, []<class Number>(std::vector<Number>& values) {
        for (Number& value : values)
          value = static_cast<Number>(value & ~static_cast<Number>(kOfAnotherPiece));
        return std::all_of(values.begin(), values.end(), [](Number value) { return value == 0; });
      });
    }
    if (!says_more) erase(association, std::string(kGhostType));
  }

  /// Returns the numbers of an array with one integer for each row; empty if there is no such array.
  [[nodiscard]] std::vector<std::int64_t> integers(Association association, std::string_view name) const {
    const DataArray* const array = find(association, name);
    if (array == nullptr || array->components != 1) return {};
    return integers_of<std::int64_t>(array->values);
  }

  [[nodiscard]] std::string name_of_ids(Association association) const {
    for (const ArrayRole& role : pieces_.roles) {
      if (role.role == Role::global_ids && role.association == association) return role.array;
    }
    return association == Association::vertices ? "GlobalPointIds" : "GlobalCellIds";
  }

  /// Returns the global ids of all rows; an empty list if there are none.
  [[nodiscard]] std::vector<std::int64_t> ids_of(Association association) const {
    std::vector<std::int64_t> ids = integers(association, name_of_ids(association));
    const auto negative = std::find_if(ids.begin(), ids.end(), [](std::int64_t id) { return id < 0; });
    if (negative != ids.end()) {
      const char* const kind = association == Association::vertices ? "point" : "cell";
      throw error_(fmt::format("a {} has the global id {}", kind, *negative),
                   "ids are whole numbers from 0 on");
    }
    return ids;
  }

  [[nodiscard]] bool tells_places(Association association, std::string_view name) const {
    const std::vector<std::int64_t> ids = integers(association, name);
    for (std::size_t place = 0; place < ids.size(); ++place) {
      if (!std::cmp_equal(ids[place], place)) return false;
    }
    return !ids.empty();
  }

  /// Returns which rows another piece owns.
  [[nodiscard]] std::vector<bool> ghosts(Association association) const {
    std::vector<bool> result(static_cast<std::size_t>(count(association)), false);
    const std::vector<std::int64_t> types = integers(association, kGhostType);
    for (std::size_t row = 0; row < types.size(); ++row) result[row] = (types[row] & kOfAnotherPiece) != 0;
    return result;
  }

  [[nodiscard]] std::vector<Index> cells_kept() const {
    const std::vector<bool> is_ghost = ghosts(Association::cells);
    std::vector<Index> rows;
    for (Index row = 0; row < count(Association::cells); ++row) {
      if (!is_ghost[static_cast<std::size_t>(row)]) rows.push_back(row);
    }
    const std::vector<std::int64_t> ids = ids_of(Association::cells);
    if (ids.empty()) return rows;
    std::stable_sort(rows.begin(), rows.end(), [&](Index a, Index b) { return ids[a] < ids[b]; });
    const auto twice =
        std::adjacent_find(rows.begin(), rows.end(), [&](Index a, Index b) { return ids[a] == ids[b]; });
    if (twice != rows.end()) {
      throw error_(fmt::format("two cells have the global id {}", ids[*twice]),
                   "pieces of one mesh give each cell its own id, and mark copies in vtkGhostType");
    }
    return rows;
  }

  /// Returns the points to keep, sorted by global id if they have ids; renumbers the vertices of all cells.
  [[nodiscard]] std::vector<Index> points_kept(const std::vector<Index>& cells) {
    const std::vector<bool> is_ghost = ghosts(Association::vertices);
    std::vector<bool> is_used(is_ghost.size(), false);
    const FileCells& all = pieces_.cells;
    for (const Index cell : cells) {
      for (Offset entry = all.offsets[cell]; entry < all.offsets[cell + 1]; ++entry)
        is_used[static_cast<std::size_t>(all.vertices[entry])] = true;
    }
    std::vector<Index> rows;
    for (Index row = 0; row < count(Association::vertices); ++row) {
      const auto place = static_cast<std::size_t>(row);
      if (!is_ghost[place] || is_used[place]) rows.push_back(row);
    }
    new_points_.assign(is_ghost.size(), -1);
    const std::vector<std::int64_t> ids = ids_of(Association::vertices);
    if (ids.empty()) {
      notes_.emplace_back(
          "the points have no global ids: points on borders of pieces are repeated in each piece");
    } else {
      std::stable_sort(rows.begin(), rows.end(), [&](Index a, Index b) {
        return ids[a] != ids[b] ? ids[a] < ids[b] : !is_ghost[a] && is_ghost[b];
      });
    }
    std::vector<Index> kept;
    for (const Index row : rows) {
      if (!ids.empty() && !kept.empty() && ids[kept.back()] == ids[row]) {
        if (pieces_.points[kept.back()] != pieces_.points[row]) {
          throw error_(
              fmt::format("the point with the global id {} has two positions", ids[row]),
              "the pieces are of different meshes or runs, or the ids are not those of the whole mesh");
        }
      } else {
        kept.push_back(row);
      }
      new_points_[static_cast<std::size_t>(row)] = index_size(kept) - 1;
    }
    for (Index& vertex : pieces_.cells.vertices) vertex = new_points_[static_cast<std::size_t>(vertex)];
    return kept;
  }

  /// Keeps only the cells with these indices, in this order.
  void take_cells_of(const std::vector<Index>& rows) {
    const FileCells all = std::move(pieces_.cells);
    FileCells& cells = pieces_.cells = {};
    std::vector<Index> new_cells(all.types.size(), -1);
    for (std::size_t k = 0; k < rows.size(); ++k)
      new_cells[static_cast<std::size_t>(rows[k])] = static_cast<Index>(k);
    cells.polyhedra = all.polyhedra.moved(new_points_, new_cells);
    cells.types.reserve(rows.size());
    for (const Index row : rows) {
      cells.types.push_back(all.types[row]);
      cells.vertices.insert(cells.vertices.end(), all.vertices.begin() + all.offsets[row],
                            all.vertices.begin() + all.offsets[row + 1]);
      cells.offsets.push_back(static_cast<Offset>(cells.vertices.size()));
    }
  }

  /// Keeps only these rows, in this order, in all arrays on points, or in all arrays on cells.
  void take_rows(Association association, const std::vector<Index>& rows) {
    for (DataArray& array : pieces_.arrays) {
      if (array.association == association)
        array.values = rows_of_values(array.values, array.components, rows);
    }
  }

  const Pieces& pieces_;
  const ErrorAt& error_;
  Notes& notes_;
  std::vector<Index> new_points_;  // new position of each point; −1: left out
};

}  // namespace

void join_pieces(const Pieces& pieces, const ErrorAt& error, Notes& notes) {
  PieceJoiner(pieces, error, notes).join();
}

}  // namespace meshorder::vtk
