// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/halo.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/grid_rows.hpp"
#include "distributed/files/mold.hpp"
#include "distributed/files/moved_part.hpp"
#include "io/vtk/vtk.hpp"
#include "mesh/values.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

namespace meshorder::distributed {
namespace {

// number types: indices of alternatives of Values
constexpr std::size_t kMemberMark = 3;  // a byte that marks members of a set
constexpr std::size_t kNumber = 6;
constexpr std::size_t kWideNumber = 8;

/// A moved mesh in the form of a .vtu file.
class PartGrid {
 public:
  PartGrid(const Communicator& communicator, MovedPart& moved) : communicator_(communicator), moved_(moved) {
    for (std::size_t s = 0; s < moved.part().mesh.sets.size(); ++s) set_ranks_.push_back(ranks_in_set(s));
    list_arrays();
    types_ = communicator.together([&] { return vtk::cell_types(moved.part().mesh); });
  }

  /// Returns the rows of the k-th array of the file that move to this rank's places.
  [[nodiscard]] std::vector<std::byte> rows_of_array(std::size_t k) const {
    if (k > arrays_.size())  // types, the last array
      return moved_.moved(Association::cells, std::as_bytes(std::span(types_)), 1);
    if (k == arrays_.size()) {
      return moved_.moved(Association::vertices, std::as_bytes(std::span(moved_.part().mesh.points)),
                          sizeof(Point));
    }
    const Array& array = arrays_[k];
    if (array.source == Array::Source::data) return moved_.moved_array(array.number);
    if (array.source == Array::Source::ids) return moved_.moved_ids(array.association, array.type);
    const std::vector<std::byte> own = communicator_.together([&] { return marks_of_set(array); });
    return moved_.moved(array.association, own, size_of_type(array.type));
  }

  /// Returns a .vtu file of one point and one cell that has all arrays, with their names in .vtu files.
  [[nodiscard]] std::string xml(Notes& notes) const {
    Mesh sketch;
    sketch.points.resize(1);
    sketch.cells.push_back(Shape::vertex, std::array<Index, 1>{0});
    sketch.format_metadata = moved_.part().mesh.format_metadata;
    for (std::size_t k = 0; k < moved_.part().mesh.data.size(); ++k) {
      const DataArray& array = moved_.part().mesh.data[k];
      sketch.data.push_back(blank_row(array.name, array.association, array.values.index(), array.components,
                                      array.component_names));
      if (moved_.part().arrays[k].is_partial) sketch.data.back().indices = {0};
    }
    for (const EntitySet& set : moved_.part().mesh.sets)
      sketch.sets.push_back({set.name, set.association, {}});
    if (moved_.ids(Association::vertices) != nullptr) sketch.vertex_ids = {0};
    if (moved_.ids(Association::cells) != nullptr) sketch.cell_ids = {0};

    vtk::WriteContext context(sketch, notes, vtk::NamePlace::xml);
    std::vector<DataArray> rows;
    for (const Association association : {Association::vertices, Association::cells}) {
      for (const DataArray* const array : context.arrays) {
        if (array->association != association) continue;
        const Array& form = arrays_[rows.size()];
        rows.push_back(
            blank_row(array->name, association, form.type, form.components, array->component_names));
      }
    }
    return mold_of(std::move(rows), context.metadata, false, notes);
  }

 private:
  /// An array of the .vtu file.
  struct Array {
    enum class Source : std::uint8_t { data, set, ids };
    Source source;
    std::size_t number;  ///< index among the mesh's arrays or sets
    Association association;
    std::size_t type;  ///< number type: index of an alternative of Values
    Index components;
  };

  /// Returns the position, counted from 1, that each of the part's members has in the whole set; empty if the
  /// members of the whole set ascend in the new order.
  [[nodiscard]] std::vector<std::int32_t> ranks_in_set(std::size_t set) const {
    constexpr GlobalIndex kNone = -1;
    const MeshPart::SetRows& rows = moved_.part().sets[set];
    const EntitySet& members = moved_.part().mesh.sets[set];
    const Layout list = Layout::even(rows.size, communicator_.size());
    const std::vector<GlobalIndex> entries(rows.entries.begin(), rows.entries.end());
    std::vector<GlobalIndex> places;
    places.reserve(members.members.size());
    for (const Index member : members.members)
      places.push_back(moved_.new_places(members.association)[member]);
    std::vector<GlobalIndex> listed = delivered<GlobalIndex>(communicator_, list, entries, places, kNone);

    struct PlacesInList {
      GlobalIndex members = 0;
      GlobalIndex first = kNone;
      GlobalIndex last = kNone;
      bool ascends = true;
    };
    PlacesInList own;
    for (GlobalIndex& place : listed) {
      if (place == kNone) continue;  // the member occurs earlier in the list
      if (own.members++ == 0) own.first = place;
      own.ascends = own.ascends && place > own.last;
      own.last = place;
    }
    GlobalIndex before = 0;
    GlobalIndex last = kNone;
    bool ascends = true;
    const std::vector<PlacesInList> all = communicator_.gathered(own);
    for (int rank = 0; rank < communicator_.size(); ++rank) {
      const PlacesInList& found = all[rank];
      if (rank < communicator_.rank()) before += found.members;
      ascends = ascends && found.ascends && (found.members == 0 || found.first > last);
      if (found.members > 0) last = found.last;
    }
    if (ascends) return {};
    for (GlobalIndex& place : listed) {
      if (place != kNone) place = ++before;
    }
    const Halo halo(communicator_, list, entries);
    const std::vector<GlobalIndex> found = halo.fetch(listed);
    std::vector<std::int32_t> ranks;
    ranks.reserve(entries.size());
    for (const GlobalIndex entry : entries)
      ranks.push_back(static_cast<std::int32_t>(found[halo.position(entry)]));
    return ranks;
  }

  /// Lists the arrays in the sequence in which a .vtu file has them.
  void list_arrays() {
    using Source = Array::Source;
    const Mesh& mesh = moved_.part().mesh;
    for (const Association association : {Association::vertices, Association::cells}) {
      for (std::size_t k = 0; k < mesh.data.size(); ++k) {
        if (mesh.data[k].association == association)
          arrays_.push_back(
              {Source::data, k, association, mesh.data[k].values.index(), mesh.data[k].components});
      }
      for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
        if (mesh.sets[s].association != association) continue;
        const bool has_ranks = communicator_.sum(set_ranks_[s].empty() ? 0 : 1) > 0;
        arrays_.push_back({Source::set, s, association, has_ranks ? kNumber : kMemberMark, 1});
      }
      if (const std::vector<std::int64_t>* const numbers = moved_.ids(association)) {
        const bool fit = communicator_.sum(fit_32_bits(*numbers) ? 0 : 1) == 0;
        arrays_.push_back({Source::ids, 0, association, fit ? kNumber : kWideNumber, 1});
      }
    }
  }

  /// Returns the mark of each vertex or cell of the part for a set: 0 for a non-member, else the position in
  /// the set, or 1 if the set ascends.
  [[nodiscard]] std::vector<std::byte> marks_of_set(const Array& array) const {
    const std::vector<std::int32_t>& ranks = set_ranks_[array.number];
    const std::vector<Index>& members = moved_.part().mesh.sets[array.number].members;
    const GlobalIndex count = moved_.layout(array.association).size(communicator_.rank());
    std::vector<std::int32_t> marks(static_cast<std::size_t>(count), 0);
    for (std::size_t k = 0; k < members.size(); ++k) marks[members[k]] = ranks.empty() ? 1 : ranks[k];
    return bytes_of(marks, array.type);
  }

  const Communicator& communicator_;
  MovedPart& moved_;
  std::vector<std::vector<std::int32_t>> set_ranks_;  ///< by set: position of each member; empty: all 1
  std::vector<Array> arrays_;
  std::vector<std::uint8_t> types_;  ///< VTK cell types
};

}  // namespace

GridRows moved_grid(const Communicator& communicator, MovedPart& moved, Notes& notes) {
  const auto part = std::make_shared<const PartGrid>(communicator, moved);
  GridRows grid;
  grid.vertices = moved.layout(Association::vertices);
  grid.cells = moved.layout(Association::cells);
  grid.rows = [part](std::size_t k) { return part->rows_of_array(k); };
  communicator.at_root([&] { grid.xml = part->xml(notes); });
  grid.cell_vertices = moved.moved_cells(communicator.together([&] {
    Mesh bare;
    bare.cells = moved.take_cells();
    Notes ignored;
    vtk::WriteContext context(bare, ignored, vtk::NamePlace::xml);
    const Cells& cells = context.cells();
    return Rows{cells.offsets, {cells.vertices.begin(), cells.vertices.end()}};
  }));
  return grid;
}

}  // namespace meshorder::distributed
