// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/moved_part.hpp"

#include "distributed/comm/halo.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/file_rows.hpp"
#include "distributed/order/cell_order.hpp"
#include "distributed/order/number_order.hpp"
#include "io/vtk/vtk.hpp"
#include "mesh/values.hpp"

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <utility>
#include <variant>

namespace meshorder::distributed {
namespace {

// number types: indices of alternatives of Values
constexpr std::size_t kReal = 0;
constexpr std::size_t kNarrow = 6;
constexpr std::size_t kWide = 8;

/// The number type and the components of an array.
struct ArrayForm {
  std::size_t type = 0;
  Index components = 0;
};

/// Returns the common type of an array that has types a and b on two ranks. The types may differ: a reader
/// returns 32-bit integers if all labels or numbers that it reads fit.
std::size_t common_type(std::size_t a, std::size_t b) {
  if (a == b) return a;
  const bool are_integers = (a == kNarrow || a == kWide) && (b == kNarrow || b == kWide);
  return are_integers ? kWide : kReal;
}

/// Converts an array to a type and to at least as many components as now; new entries are missing values.
void give_form(DataArray& array, const ArrayForm& form) {
  if (array.values.index() == form.type && array.components == form.components) return;
  Values result = values_of_type(form.type);
  std::visit(
      [&](const auto& old, auto& values) {
        using Old = typename std::decay_t<decltype(old)>::value_type;
        using Number = typename std::decay_t<decltype(values)>::value_type;
        if constexpr (std::is_arithmetic_v<Number> && std::is_arithmetic_v<Old>) {
          const auto width = static_cast<std::size_t>(array.components);
          const auto new_width = static_cast<std::size_t>(form.components);
          const std::size_t rows = width == 0 ? 0 : old.size() / width;
          values.assign(rows * new_width, missing_value<Number>());
          for (std::size_t k = 0; k < rows * width; ++k)
            values[k / width * new_width + k % width] = static_cast<Number>(old[k]);
        }
      },
      array.values, result);
  array.values = std::move(result);
  array.components = form.components;
}

}  // namespace

MovedPart::MovedPart(const Communicator& communicator, MeshPart part, const DistributedOrder& order,
                     std::vector<GlobalIndex> block_ends, Notes& notes)
    : communicator_(communicator), part_(std::move(part)), block_ends_(std::move(block_ends)) {
  const auto layout = [&](MeshRange own) {
    return Layout::of_sizes(communicator.gathered(GlobalIndex{own.size()}));
  };
  vertices_.layout = layout(part_.ranges.vertices);
  cells_.layout = layout(part_.ranges.cells);
  note_repeated(notes);
  unify_arrays();
  vertices_.places = order.new_vertices;
  cells_.places = places_of_cells(order.cells);
  for (Entities* const all : {&vertices_, &cells_})
    all->mover.emplace(communicator, all->layout, all->places);
  settle_ids(vertices_, part_.mesh.vertex_ids, part_.vertex_ids, notes);
  settle_ids(cells_, part_.mesh.cell_ids, part_.cell_ids, notes);
}

const std::vector<std::int64_t>* MovedPart::ids(Association association) const {
  if (!entities(association).has_ids) return nullptr;
  return association == Association::vertices ? &part_.mesh.vertex_ids : &part_.mesh.cell_ids;
}

/// Returns the new place of each cell of the part, within the places of its block or dimension. `in_order` is
/// this rank's range of the list of all cells in their new order.
std::vector<GlobalIndex> MovedPart::places_of_cells(const std::vector<GlobalIndex>& in_order) const {
  if (!block_ends_.empty()) return places_by_block(communicator_, cells_.layout, block_ends_, in_order);
  MeshSlice slice;
  slice.cells = cells_.layout;
  slice.shapes = communicator_.together([&] { return part_.mesh.cells.shapes; });
  return places_by_dimension(communicator_, slice, in_order);
}

void MovedPart::note_repeated(Notes& notes) const {
  for (const MeshPart::List& list : part_.lists) {
    const GlobalIndex kept = communicator_.sum(GlobalIndex{list.kept});
    if (kept < list.size && communicator_.is_root())
      notes.push_back(note_of_repeated(list.set, static_cast<std::size_t>(list.size - kept)));
  }
}

/// Converts each array to a type and a number of components that suit all ranks.
void MovedPart::unify_arrays() {
  for (DataArray& array : part_.mesh.data) {
    ArrayForm common{array.values.index(), 0};
    for (const ArrayForm& form : communicator_.gathered(ArrayForm{array.values.index(), array.components}))
      common = {common_type(common.type, form.type), std::max(common.components, form.components)};
    communicator_.together([&] { give_form(array, common); });
  }
}

/// Drops ids that are 1, 2, … or not unique; else finds the new place of each id. In the new order, ids
/// ascend along the vertices and along the cells of each dimension or block. If the order moves nothing, ids
/// keep their places.
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

/// Returns the new place of the id of each vertex or cell of the part.
std::vector<GlobalIndex> MovedPart::places_of_ids(const Entities& owner,
                                                  const std::vector<GlobalIndex>& sorted) const {
  if (&owner == &cells_) return places_of_cells(sorted);
  const GlobalIndex first =
      Layout::of_sizes(communicator_.gathered(std::ssize(sorted))).begin(communicator_.rank());
  const std::vector<GlobalIndex> places = communicator_.together([&] {
    std::vector<GlobalIndex> result(sorted.size());
    std::iota(result.begin(), result.end(), first);
    return result;
  });
  return delivered<GlobalIndex>(communicator_, owner.layout, sorted, places, GlobalIndex{-1});
}

std::vector<std::byte> MovedPart::moved(Association association, std::span<const std::byte> rows,
                                        Offset width) const {
  return entities(association).mover->moved(rows, width);
}

std::vector<std::byte> MovedPart::moved_array(std::size_t k) const {
  const DataArray& array = part_.mesh.data[k];
  const GlobalIndex count = layout(array.association).size(communicator_.rank());
  const std::vector<std::byte> rows = communicator_.together([&] {
    return part_.arrays[k].is_partial
               ? bytes_of_values(vtk::full_array(array, static_cast<Index>(count)).values)
               : bytes_of_values(array.values);
  });
  return moved(array.association, rows, size_of_type(array.values.index()) * array.components);
}

std::vector<std::byte> MovedPart::moved_ids(Association association, std::size_t type) const {
  const Entities& owner = entities(association);
  std::vector<std::byte> own = communicator_.together([&] { return bytes_of(*ids(association), type); });
  return owner.ids_mover ? owner.ids_mover->moved(own, size_of_type(type)) : own;
}

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
  slice.points = moved_values(communicator_, *vertices_.mover, part_.mesh.points);
  slice.shapes = moved_values(communicator_, *cells_.mover, part_.mesh.cells.shapes);
  slice.cell_vertices = moved_cells(communicator_.together([&] {
    const Cells& cells = part_.mesh.cells;
    return Rows{cells.offsets, {cells.vertices.begin(), cells.vertices.end()}};
  }));
  return slice;
}

}  // namespace meshorder::distributed
