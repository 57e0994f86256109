// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/moved_part.hpp"

#include "distributed/cell_places.hpp"
#include "distributed/halo.hpp"
#include "distributed/mold.hpp"
#include "distributed/number_order.hpp"
#include "distributed/number_types.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

namespace meshorder::distributed {
namespace {

// number types, as the alternatives of Values
constexpr std::size_t kReal = 0;
constexpr std::size_t kByte = 3;
constexpr std::size_t kNarrow = 6;
constexpr std::size_t kWide = 8;

/// How an array is held.
struct ArrayForm {
  std::size_t type = 0;
  Index components = 0;
};

/// Returns the type that an array has whose rows on two ranks have these: readers make 32-bit integers of
/// labels and numbers where all that they read fit.
std::size_t common_type(std::size_t a, std::size_t b) {
  if (a == b) return a;
  const bool are_integers = (a == kNarrow || a == kWide) && (b == kNarrow || b == kWide);
  return are_integers ? kWide : kReal;
}

/// Returns what stands where an array has no value.
template <class Number>
Number nothing() {
  if constexpr (std::is_floating_point_v<Number>) return std::numeric_limits<Number>::quiet_NaN();
  return Number{};
}

/// Gives an array a type, and rows of so many components, at least as many as they have.
void give_form(DataArray& array, const ArrayForm& form) {
  if (array.values.index() == form.type && array.components == form.components) return;
  Values result = vtk::values_of_type(form.type);
  std::visit(
      [&](const auto& old, auto& values) {
        using Old = typename std::decay_t<decltype(old)>::value_type;
        using Number = typename std::decay_t<decltype(values)>::value_type;
        if constexpr (std::is_arithmetic_v<Number> && std::is_arithmetic_v<Old>) {
          const auto width = static_cast<std::size_t>(array.components);
          const auto new_width = static_cast<std::size_t>(form.components);
          const std::size_t rows = width == 0 ? 0 : old.size() / width;
          values.assign(rows * new_width, nothing<Number>());
          for (std::size_t k = 0; k < rows * width; ++k)
            values[k / width * new_width + k % width] = static_cast<Number>(old[k]);
        }
      },
      array.values, result);
  array.values = std::move(result);
  array.components = form.components;
}

/// Gives an array without rows one of nothing, so that it stands for some rows and not for all.
void add_row_of_nothing(DataArray& array) {
  array.indices = {0};
  std::visit(
      [&](auto& values) {
        using Number = typename std::decay_t<decltype(values)>::value_type;
        if constexpr (std::is_arithmetic_v<Number>)
          values.assign(static_cast<std::size_t>(array.components), nothing<Number>());
      },
      array.values);
}

Rows rows_of_cells(const Cells& cells) {
  return {cells.offsets, {cells.vertices.begin(), cells.vertices.end()}};
}

/// Returns the bytes of an array that has a row for each vertex or cell.
std::vector<std::byte> bytes_of_rows(const DataArray& array) {
  return std::visit(
      [](const auto& values) {
        std::vector<std::byte> result;
        if constexpr (std::is_arithmetic_v<typename std::decay_t<decltype(values)>::value_type>) {
          const auto bytes = std::as_bytes(std::span(values));
          result.assign(bytes.begin(), bytes.end());
        }
        return result;
      },
      array.values);
}

}  // namespace

MovedPart::MovedPart(const Communicator& communicator, MeshPart part, const DistributedOrder& order,
                     Notes& notes)
    : communicator_(communicator), part_(std::move(part)) {
  const auto layout = [&](MeshRange own) {
    return Layout::of_sizes(communicator.gathered(GlobalIndex{own.size()}));
  };
  vertices_.layout = layout(part_.ranges.vertices);
  cells_.layout = layout(part_.ranges.cells);
  note_repeated(notes);
  unify_arrays();
  vertices_.places = order.new_vertices;
  cells_.places = places_by_dimension(communicator, unmoved(), order.cells);
  for (Entities* const all : {&vertices_, &cells_})
    all->mover.emplace(communicator, all->layout, all->places);
  settle_ids(vertices_, part_.mesh.vertex_ids, part_.vertex_ids, notes);
  settle_ids(cells_, part_.mesh.cell_ids, part_.cell_ids, notes);
  for (std::size_t s = 0; s < part_.mesh.sets.size(); ++s) set_ranks_.push_back(ranks_in_set(s));
  list_arrays();
  types_ = communicator.together([&] { return vtk::cell_types(part_.mesh); });
}

const std::vector<std::int64_t>* MovedPart::ids(Association association) const {
  if (!entities(association).has_ids) return nullptr;
  return association == Association::vertices ? &part_.mesh.vertex_ids : &part_.mesh.cell_ids;
}

/// Returns the part's shapes with who has which vertices and cells.
MeshSlice MovedPart::unmoved() const {
  MeshSlice slice;
  slice.vertices = vertices_.layout;
  slice.cells = cells_.layout;
  slice.shapes = communicator_.together([&] { return part_.mesh.cells.shapes; });
  return slice;
}

void MovedPart::note_repeated(Notes& notes) const {
  for (const MeshPart::List& list : part_.lists) {
    const GlobalIndex kept = communicator_.sum(GlobalIndex{list.kept});
    if (kept < list.size && communicator_.is_root())
      notes.push_back(note_of_repeated(list.set, static_cast<std::size_t>(list.size - kept)));
  }
}

/// Gives each array the type and the components that it has on any rank.
void MovedPart::unify_arrays() {
  std::vector<DataArray>& arrays = part_.mesh.data;
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    ArrayForm common{arrays[k].values.index(), 0};
    for (const ArrayForm& form :
         communicator_.gathered(ArrayForm{arrays[k].values.index(), arrays[k].components})) {
      common = {common_type(common.type, form.type), std::max(common.components, form.components)};
    }
    communicator_.together([&] {
      give_form(arrays[k], common);
      const Entities& owner = entities(arrays[k].association);
      const bool has_rows = owner.layout.size(communicator_.rank()) > 0;
      if (part_.is_partial[k] != 0 && arrays[k].indices.empty() && has_rows) add_row_of_nothing(arrays[k]);
    });
  }
}

/// Finds out whether there are ids besides the places, and where they go: the vertices, and the cells of each
/// dimension, get them ascending. An order that moves nothing leaves them where they are.
void MovedPart::settle_ids(Entities& owner, std::vector<std::int64_t>& ids, const std::string& name,
                           Notes& notes) {
  if (name.empty() || are_places(communicator_, owner.layout, ids)) return ids.clear();
  const NumberOrder order = order_of_numbers(communicator_, owner.layout, ids);
  if (order.twice) {
    if (communicator_.is_root()) notes.push_back(note_of_number_twice(name, *order.twice));
    return ids.clear();
  }
  owner.has_ids = true;
  GlobalIndex next = owner.layout.begin(communicator_.rank());
  const bool stay = std::all_of(owner.places.begin(), owner.places.end(),
                                [&](GlobalIndex place) { return place == next++; });
  if (communicator_.sum(stay ? 0 : 1) == 0) return;
  owner.ids_mover.emplace(communicator_, owner.layout, places_of_ids(owner, order.sorted));
}

/// Returns where the id of each vertex or cell of the part goes.
std::vector<GlobalIndex> MovedPart::places_of_ids(const Entities& owner,
                                                  const std::vector<GlobalIndex>& sorted) const {
  if (&owner == &cells_) return places_by_dimension(communicator_, unmoved(), sorted);
  const GlobalIndex first =
      Layout::of_sizes(communicator_.gathered(std::ssize(sorted))).begin(communicator_.rank());
  const std::vector<GlobalIndex> places = communicator_.together([&] {
    std::vector<GlobalIndex> result(sorted.size());
    std::iota(result.begin(), result.end(), first);
    return result;
  });
  return delivered<GlobalIndex>(communicator_, owner.layout, sorted, places, GlobalIndex{-1});
}

/// Returns the place, from 1 on, that each member of the part has among all members of a set; nothing if the
/// members of the whole set ascend in the new order.
std::vector<std::int32_t> MovedPart::ranks_in_set(std::size_t set) const {
  constexpr GlobalIndex kNone = -1;
  const MeshPart::SetRows& rows = part_.sets[set];
  const EntitySet& members = part_.mesh.sets[set];
  const Layout list = Layout::even(rows.size, communicator_.size());
  const std::vector<GlobalIndex> entries(rows.entries.begin(), rows.entries.end());
  std::vector<GlobalIndex> places;
  places.reserve(members.members.size());
  for (const Index member : members.members)
    places.push_back(entities(members.association).places[static_cast<std::size_t>(member)]);
  std::vector<GlobalIndex> listed = delivered<GlobalIndex>(communicator_, list, entries, places, kNone);

  struct PlacesInList {
    GlobalIndex members = 0;
    GlobalIndex first = kNone;
    GlobalIndex last = kNone;
    bool ascends = true;
  };
  PlacesInList own;
  for (GlobalIndex& place : listed) {
    if (place == kNone) continue;  // named before
    if (own.members++ == 0) own.first = place;
    own.ascends = own.ascends && place > own.last;
    own.last = place;
  }
  GlobalIndex before = 0;
  GlobalIndex last = kNone;
  bool ascends = true;
  const std::vector<PlacesInList> all = communicator_.gathered(own);
  for (int rank = 0; rank < communicator_.size(); ++rank) {
    const PlacesInList& found = all[static_cast<std::size_t>(rank)];
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

/// Lists the arrays as a .vtu file has them.
void MovedPart::list_arrays() {
  using Source = Array::Source;
  const Mesh& mesh = part_.mesh;
  for (const Association association : {Association::vertices, Association::cells}) {
    for (std::size_t k = 0; k < mesh.data.size(); ++k) {
      if (mesh.data[k].association == association)
        arrays_.push_back(
            {Source::data, k, association, mesh.data[k].values.index(), mesh.data[k].components});
    }
    for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
      if (mesh.sets[s].association != association) continue;
      const bool has_ranks = communicator_.sum(set_ranks_[s].empty() ? 0 : 1) > 0;
      arrays_.push_back({Source::set, s, association, has_ranks ? kNarrow : kByte, 1});
    }
    if (const std::vector<std::int64_t>* const numbers = ids(association)) {
      const bool fit = std::all_of(numbers->begin(), numbers->end(),
                                   [](std::int64_t number) { return std::in_range<std::int32_t>(number); });
      arrays_.push_back(
          {Source::ids, 0, association, communicator_.sum(fit ? 0 : 1) == 0 ? kNarrow : kWide, 1});
    }
  }
}

std::vector<std::byte> MovedPart::bytes(const Array& array) const {
  const auto rows = static_cast<std::size_t>(entities(array.association).layout.size(communicator_.rank()));
  if (array.source == Array::Source::data) {
    const DataArray& data = part_.mesh.data[array.number];
    return bytes_of_rows(data.is_dense() ? data : vtk::full_array(data, static_cast<Index>(rows)));
  }
  if (array.source == Array::Source::ids) return bytes_of(*ids(array.association), array.type);
  const std::vector<std::int32_t>& ranks = set_ranks_[array.number];
  const std::vector<Index>& members = part_.mesh.sets[array.number].members;
  std::vector<std::int32_t> marks(rows, 0);
  for (std::size_t k = 0; k < members.size(); ++k)
    marks[static_cast<std::size_t>(members[k])] = ranks.empty() ? 1 : ranks[k];
  return bytes_of(marks, array.type);
}

std::vector<std::byte> MovedPart::rows(std::size_t k) const {
  if (k < arrays_.size()) {
    const Array& array = arrays_[k];
    const std::vector<std::byte> own = communicator_.together([&] { return bytes(array); });
    const Entities& owner = entities(array.association);
    const Offset width = size_of_type(array.type) * array.components;
    if (array.source != Array::Source::ids) return owner.mover->moved(own, width);
    return owner.ids_mover ? owner.ids_mover->moved(own, width) : own;
  }
  if (k > arrays_.size())  // behind points and two of cells
    return cells_.mover->moved(std::as_bytes(std::span(types_)), 1);
  return vertices_.mover->moved(std::as_bytes(std::span(part_.mesh.points)), sizeof(Point));
}

/// Returns cells of this rank's places, with the new numbers of their vertices.
Rows MovedPart::moved_cells(Rows cells) const {
  {
    const Halo halo(communicator_, vertices_.layout, cells.entries);
    const std::vector<GlobalIndex> new_numbers = halo.fetch(vertices_.places);
    for (GlobalIndex& vertex : cells.entries) vertex = new_numbers[halo.position(vertex)];
  }
  return cells_.mover->moved(std::move(cells));
}

MeshSlice MovedPart::slice() const {
  MeshSlice slice;
  slice.vertices = vertices_.layout;
  slice.cells = cells_.layout;
  const std::vector<std::byte> points =
      vertices_.mover->moved(std::as_bytes(std::span(part_.mesh.points)), sizeof(Point));
  const std::vector<std::byte> shapes =
      cells_.mover->moved(std::as_bytes(std::span(part_.mesh.cells.shapes)), sizeof(Shape));
  slice.cell_vertices = moved_cells(communicator_.together([&] { return rows_of_cells(part_.mesh.cells); }));
  communicator_.together([&] {
    slice.points.resize(points.size() / sizeof(Point));
    slice.shapes.resize(shapes.size() / sizeof(Shape));
    std::copy(points.begin(), points.end(), std::as_writable_bytes(std::span(slice.points)).begin());
    std::copy(shapes.begin(), shapes.end(), std::as_writable_bytes(std::span(slice.shapes)).begin());
  });
  return slice;
}

/// Returns a file of one point and one cell that has all arrays, under the names that they get there.
std::string MovedPart::xml(Notes& notes) const {
  Mesh sketch;
  sketch.points.resize(1);
  sketch.cells.push_back(Shape::vertex, std::array<Index, 1>{0});
  sketch.format_metadata = part_.mesh.format_metadata;
  for (std::size_t k = 0; k < part_.mesh.data.size(); ++k) {
    const DataArray& array = part_.mesh.data[k];
    DataArray& row = sketch.data.emplace_back(DataArray{array.name,
                                                        array.association,
                                                        array.components,
                                                        vtk::values_of_type(array.values.index()),
                                                        {},
                                                        array.component_names});
    std::visit([&](auto& values) { values.resize(static_cast<std::size_t>(array.components)); }, row.values);
    if (part_.is_partial[k] != 0) row.indices = {0};
  }
  for (const EntitySet& set : part_.mesh.sets) sketch.sets.push_back({set.name, set.association, {}});
  if (vertices_.has_ids) sketch.vertex_ids = {0};
  if (cells_.has_ids) sketch.cell_ids = {0};

  vtk::WriteContext context(sketch, notes, vtk::NamePlace::xml);
  std::vector<DataArray> rows;
  for (const Association association : {Association::vertices, Association::cells}) {
    for (const DataArray* const array : context.arrays) {
      if (array->association != association) continue;
      const Array& form = arrays_[rows.size()];
      DataArray& row = rows.emplace_back(DataArray{array->name,
                                                   association,
                                                   form.components,
                                                   vtk::values_of_type(form.type),
                                                   {},
                                                   array->component_names});
      std::visit([&](auto& values) { values.resize(static_cast<std::size_t>(form.components)); }, row.values);
    }
  }
  return mold_of(std::move(rows), context.metadata, false, notes);
}

GridRows MovedPart::grid(Notes& notes) {
  GridRows grid;
  grid.vertices = vertices_.layout;
  grid.cells = cells_.layout;
  grid.rows = [this](std::size_t k) { return rows(k); };
  communicator_.at_root([&] {
    grid.xml = xml(notes);
    grid.fields = fields_of(grid.xml);
  });
  grid.cell_vertices = moved_cells(communicator_.together([&] {
    Mesh bare;
    bare.cells = std::move(part_.mesh.cells);
    Notes ignored;
    vtk::WriteContext context(bare, ignored, vtk::NamePlace::xml);
    return rows_of_cells(context.cells());
  }));
  return grid;
}

}  // namespace meshorder::distributed
