// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace meshorder {

/// Consecutive vertices or cells of a mesh: first … end − 1.
struct MeshRange {
  Index first = 0;
  Index end = 0;

  [[nodiscard]] Index size() const noexcept { return end - first; }
  [[nodiscard]] bool contains(Index number) const noexcept { return number >= first && number < end; }
  /// Returns the intersection of two ranges; if they do not overlap, an empty range within this one.
  [[nodiscard]] MeshRange common(MeshRange other) const {
    const Index begin = std::clamp(other.first, first, end);
    return {begin, std::clamp(other.end, begin, end)};
  }
};

/// A range of a mesh's vertices and a range of its cells.
struct MeshRanges {
  MeshRange vertices;
  MeshRange cells;
};

/// The vertices and cells of a mesh in two ranges, for readers that give each process a part of a large mesh.
struct MeshPart {
  /// Where the members of a set of `mesh` are in the file's list.
  struct SetRows {
    Index size = 0;              ///< length of the file's list, for the whole mesh
    std::vector<Index> entries;  ///< position of each member in that list, ascending
  };
  /// A list of the file that may name a member twice.
  struct List {
    std::string set;  ///< name, in messages, of the set made from the list
    Index size;       ///< length of the list, for the whole mesh
    Index kept;       ///< number of members in this part, each counted once
  };

  /// Where the rows of an array of `mesh` are in the file.
  struct ArrayRows {
    bool is_partial = false;  ///< whether only some vertices or cells have rows; this part may have none
    /// Position of each row in the file's list, ascending; empty if that list ascends by vertex or cell.
    std::vector<Index> entries = {};
  };

  MeshRanges ranges;
  /// Cells name vertices by the vertices' positions in the whole mesh. Rows of arrays and members of sets
  /// count from the first vertex or cell of the range. Ids are given even if they are 1, 2, …
  Mesh mesh;
  std::vector<ArrayRows> arrays;  ///< indexed like the arrays of `mesh`
  std::vector<SetRows> sets;      ///< indexed like the sets of `mesh`
  std::vector<List> lists;
  std::string vertex_ids;  ///< name of the vertex ids in the file; empty if the file has none
  std::string cell_ids;
};

/// Returns the note that the ids called `name` in the file are left out because they have `number` twice.
inline std::string note_of_number_twice(const std::string& name, std::int64_t number) {
  return name + " is left out: it gives the number " + std::to_string(number) + " twice";
}

/// Returns the note that a set names members more than once.
inline std::string note_of_repeated(const std::string& set, std::size_t repeated) {
  return set + " names " + std::to_string(repeated) + " members twice, which are kept once";
}

}  // namespace meshorder
