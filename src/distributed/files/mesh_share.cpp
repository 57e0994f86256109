// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/mesh_share.hpp"

#include "base/index.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/comm/number_set.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/comm/rows.hpp"
#include "distributed/files/piece_contents.hpp"
#include "distributed/order/partition.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

namespace meshorder::distributed {
namespace {

// number types: indices of alternatives of Values
constexpr std::size_t kPlaceInList = 6;
constexpr std::size_t kId = 8;

/// Returns the numbers in `bytes`; `type` is their type.
Values values_of(const std::vector<std::byte>& bytes, std::size_t type) {
  return numbers_of_type(type, [&]<class Number>(std::vector<Number>& numbers) {
    numbers.resize(bytes.size() / sizeof(Number));
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
  });
}

/// Gathers a rank's share of the whole mesh.
class ShareMaker {
 public:
  ShareMaker(const Communicator& communicator, const MovedPart& moved,
             const std::vector<GlobalIndex>& part_starts)
      : communicator_(communicator), moved_(moved), part_starts_(part_starts) {}

  MeshShare make() {
    MeshSlice slice = moved_.slice();
    share_.numbers.layout = slice.vertices;
    const Rows cells = own_cells(std::move(slice.cell_vertices), slice.cells);
    number_vertices(cells);
    vertices_.emplace(communicator_, slice.vertices, share_.numbers.vertices);
    cells_.emplace(communicator_, slice.cells, share_.numbers.cells);
    share_.mesh.points = vertices_->fetch(slice.points);
    const std::vector<Shape> shapes = cells_->fetch(slice.shapes);
    const Mesh& part = moved_.part().mesh;
    communicator_.together([&] {
      share_.mesh.dimension = part.dimension;
      share_.mesh.format = part.format;
      share_.mesh.format_metadata = part.format_metadata;
      add_cells(cells, shapes);
    });
    for (std::size_t k = 0; k < part.data.size(); ++k) add_array(k);
    for (std::size_t s = 0; s < part.sets.size(); ++s) add_set(s);
    share_.has_vertex_ids = add_ids(Association::vertices, share_.mesh.vertex_ids);
    share_.has_cell_ids = add_ids(Association::cells, share_.mesh.cell_ids);
    return std::move(share_);
  }

 private:
  /// Finds the cells of this rank's parts and returns the vertices of each cell.
  ///
  /// @param vertices  vertices of the cells of the slice
  [[nodiscard]] Rows own_cells(Rows vertices, const Layout& layout) {
    const Layout ranks = ranks_of_parts(index_size(part_starts_) - 1, communicator_.size());
    Rows numbers;
    std::vector<Dispatch> dispatches;
    communicator_.together([&] {
      const GlobalIndex first = layout.begin(communicator_.rank());
      for (Offset c = 0; c < vertices.size(); ++c) {
        numbers.entries.push_back(first + c);
        numbers.end_row();
        dispatches.push_back({ranks.owner(part_of_cell(vertices[c], part_starts_)), c});
      }
    });
    share_.numbers.cells = send_rows(communicator_, std::move(numbers), dispatches).entries;
    return send_rows(communicator_, std::move(vertices), std::move(dispatches));
  }

  /// Finds the vertices of the cells, and the vertices of this rank's parts that no cell of any rank uses.
  void number_vertices(const Rows& cells) {
    const Layout& layout = share_.numbers.layout;
    const std::vector<GlobalIndex> used =
        communicator_.together([&] { return NumberSet(cells.entries).numbers(); });
    const Halo asked(communicator_, layout, used);
    const Layout ranks = ranks_of_parts(index_size(part_starts_) - 1, communicator_.size());
    const std::vector<GlobalIndex> unused = communicator_.together([&] {
      const GlobalIndex first = layout.begin(communicator_.rank());
      std::vector<char> is_used(static_cast<std::size_t>(layout.size(communicator_.rank())), 0);
      for (const GlobalIndex vertex : asked.asked_of_this_rank()) is_used[vertex - first] = 1;
      std::vector<GlobalIndex> found;
      for (std::size_t v = 0; v < is_used.size(); ++v) {
        if (is_used[v] == 0) found.push_back(first + static_cast<GlobalIndex>(v));
      }
      return found;
    });
    const std::vector<GlobalIndex> more = sent_to_ranks(communicator_, unused, [&](GlobalIndex vertex) {
      return ranks.owner(part_of(vertex, part_starts_));
    });
    communicator_.together([&] {
      share_.numbers.vertices.resize(used.size() + more.size());
      std::merge(used.begin(), used.end(), more.begin(), more.end(), share_.numbers.vertices.begin());
    });
  }

  void add_cells(const Rows& rows, const std::vector<Shape>& shapes) {
    std::vector<Index> vertices;
    for (Offset c = 0; c < rows.size(); ++c) {
      vertices.clear();
      for (const GlobalIndex vertex : rows[c])
        vertices.push_back(static_cast<Index>(vertices_->position(vertex)));
      share_.mesh.cells.push_back(shapes[c], vertices);
    }
  }

  /// Returns the value of each vertex or cell of the share; `numbers` has the value of each vertex or cell of
  /// the part that this rank has read.
  template <class Number>
  [[nodiscard]] std::vector<Number> fetched(Association of, const std::vector<Number>& numbers,
                                            std::size_t type) const {
    const std::vector<std::byte> moved =
        moved_.moved(of, std::as_bytes(std::span(numbers)), Offset{sizeof(Number)});
    const std::vector<std::byte> own = halo(of).fetch_rows(moved, Offset{sizeof(Number)});
    return communicator_.together([&] { return numbers_of<Number>(own, type); });
  }

  /// Returns the vertices or cells of the share that a list of the file names, in the order of the list.
  ///
  /// @param members  members of the list that are in the part
  /// @param entries  positions of these members in the list, ascending; empty if the sequence does not matter
  [[nodiscard]] std::vector<Index> listed(Association of, const std::vector<Index>& members,
                                          const std::vector<Index>& entries) const {
    const std::vector<std::int32_t> marks = communicator_.together([&] {
      std::vector<std::int32_t> result(static_cast<std::size_t>(moved_.layout(of).size(communicator_.rank())),
                                       0);
      for (std::size_t k = 0; k < members.size(); ++k)
        result[members[k]] = entries.empty() ? 1 : entries[k] + 1;
      return result;
    });
    const std::vector<std::int32_t> own = fetched(of, marks, kPlaceInList);
    return communicator_.together([&] {
      std::vector<Index> found;
      for (Index k = 0; k < index_size(own); ++k) {
        if (own[k] != 0) found.push_back(k);
      }
      std::stable_sort(found.begin(), found.end(), [&](Index a, Index b) { return own[a] < own[b]; });
      return found;
    });
  }

  void add_array(std::size_t k) {
    const DataArray& of_part = moved_.part().mesh.data[k];
    const MeshPart::ArrayRows& rows = moved_.part().arrays[k];
    const Offset width = size_of_type(of_part.values.index()) * of_part.components;
    std::vector<std::byte> bytes = halo(of_part.association).fetch_rows(moved_.moved_array(k), width);
    std::vector<Index> some;
    if (rows.is_partial) some = listed(of_part.association, of_part.indices, rows.entries);
    communicator_.together([&] {
      if (rows.is_partial) {
        std::vector<std::byte> chosen(some.size() * static_cast<std::size_t>(width));
        for (std::size_t row = 0; row < some.size(); ++row) {
          std::memcpy(chosen.data() + row * static_cast<std::size_t>(width), bytes.data() + some[row] * width,
                      static_cast<std::size_t>(width));
        }
        bytes = std::move(chosen);
        if (some.empty()) return;  // an array without indices would count as dense
      }
      share_.mesh.data.push_back({of_part.name, of_part.association, of_part.components,
                                  values_of(bytes, of_part.values.index()), std::move(some),
                                  of_part.component_names});
    });
  }

  void add_set(std::size_t s) {
    const EntitySet& of_part = moved_.part().mesh.sets[s];
    share_.mesh.sets.push_back({of_part.name, of_part.association,
                                listed(of_part.association, of_part.members, moved_.part().sets[s].entries)});
  }

  /// Adds the ids of the share; returns whether the mesh has ids.
  bool add_ids(Association of, std::vector<std::int64_t>& ids) {
    if (moved_.ids(of) == nullptr) return false;
    const std::vector<std::byte> own =
        halo(of).fetch_rows(moved_.moved_ids(of, kId), Offset{sizeof(std::int64_t)});
    ids = communicator_.together([&] { return numbers_of<std::int64_t>(own, kId); });
    return true;
  }

  [[nodiscard]] const Halo& halo(Association of) const {
    return of == Association::vertices ? *vertices_ : *cells_;
  }

  const Communicator& communicator_;
  const MovedPart& moved_;
  const std::vector<GlobalIndex>& part_starts_;
  MeshShare share_;
  std::optional<Halo> vertices_;
  std::optional<Halo> cells_;
};

}  // namespace

ShareNumbers ShareNumbers::of_whole(const Mesh& mesh) {
  ShareNumbers numbers{Layout::even(mesh.vertex_count(), 1), {}, {}};
  numbers.vertices.resize(mesh.points.size());
  numbers.cells.resize(mesh.cells.shapes.size());
  for (auto* const all : {&numbers.vertices, &numbers.cells})
    std::iota(all->begin(), all->end(), GlobalIndex{0});
  return numbers;
}

MeshShare share_of(const Communicator& communicator, const MovedPart& moved,
                   const std::vector<GlobalIndex>& part_starts) {
  return ShareMaker(communicator, moved, part_starts).make();
}

}  // namespace meshorder::distributed
