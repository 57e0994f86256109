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
  /// Returns what two ranges have in common; an empty range, within this one, if nothing.
  [[nodiscard]] MeshRange common(MeshRange other) const {
    const Index begin = std::clamp(other.first, first, end);
    return {begin, std::clamp(other.end, begin, end)};
  }
};

/// A range of the vertices of a mesh and one of its cells.
struct MeshRanges {
  MeshRange vertices;
  MeshRange cells;
};

/// What such ranges have of a mesh, for readers that give a large mesh to several processes in parts.
struct MeshPart {
  /// Which members of a set of `mesh` these are.
  struct SetRows {
    Index size = 0;              ///< entries of the file's list, for all vertices or cells
    std::vector<Index> entries;  ///< place in that list of each member, ascending
  };
  /// A list of the file that may name a member twice.
  struct List {
    std::string set;  ///< that is made of it, in words
    Index size;       ///< entries, for all vertices or cells
    Index kept;       ///< those of this part, without repeated ones
  };

  /// Which rows of an array of `mesh` these are.
  struct ArrayRows {
    bool is_partial = false;  ///< rows for some vertices or cells only, perhaps for none of this part
    /// Place in the file's list of each row, ascending; none where rows ascend by vertex or cell.
    std::vector<Index> entries = {};
  };

  MeshRanges ranges;
  /// Cells name vertices by their numbers in the whole mesh. Rows of arrays and members of sets are counted
  /// from the first vertex or cell of the range on. Ids are those of the file, though they may be 1, 2, …
  Mesh mesh;
  std::vector<ArrayRows> arrays;  ///< of each array of the mesh
  std::vector<SetRows> sets;      ///< of each set of the mesh
  std::vector<List> lists;
  std::string vertex_ids;  ///< name that the file has for these numbers; empty where it has none
  std::string cell_ids;
};

/// Returns the note that numbers of vertices or cells, which the file calls `name`, are left out.
inline std::string note_of_number_twice(const std::string& name, std::int64_t number) {
  return name + " is left out: it gives the number " + std::to_string(number) + " twice";
}

/// Returns the note on members that a set names again.
inline std::string note_of_repeated(const std::string& set, std::size_t repeated) {
  return set + " names " + std::to_string(repeated) + " members twice, which are kept once";
}

}  // namespace meshorder
