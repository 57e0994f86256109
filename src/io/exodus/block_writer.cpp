// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/exodus/writing.hpp"
#include "io/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

// Writes the blocks of elements, with the names and attributes of each.

namespace meshorder::exodus {
namespace {

/// Returns the division of a mesh into blocks; sets divide only meshes that were read from another format.
CellDivision divide(const Mesh& mesh) {
  const ExodusMetadata* const own = own_metadata(mesh);
  if (own == nullptr) return divide_cells(mesh, {.sets = true});
  // a file that had 64-bit ids is of a kind of netCDF that can hold them
  const bool has_wide_labels =
      std::any_of(own->blocks.begin(), own->blocks.end(),
                  [](const BlockRecord& block) { return !std::in_range<std::int32_t>(block.label); });
  return divide_cells(mesh, {.wide_labels = has_wide_labels});
}

}  // namespace

Permutation places(const Mesh& mesh, std::vector<Index>& blocks) {
  return places_by_division(divide(mesh), blocks);
}

std::string_view BlockPlan::type() const {
  return record != nullptr && record->nodes > 0 ? record->type : type_of(cells.shape, cells.nodes);
}

BlockPlan& Planning::block_of(Index cell) {
  const auto behind =
      std::upper_bound(blocks.begin(), blocks.end(), cell,
                       [](Index wanted, const BlockPlan& block) { return wanted < block.cells.first; });
  return *(behind - 1);
}

void plan_blocks(Planning& planning, bool is_own) {
  const CellDivision division = divide(planning.mesh);
  using Key = std::tuple<std::int64_t, Shape, int>;
  std::map<Key, const BlockRecord*> records;
  std::set<const BlockRecord*> with_elements;
  std::set<std::int64_t> ids;
  for (const BlockRecord& record : planning.metadata.blocks) {
    if (record.nodes > 0) records.emplace(Key{record.label, record.shape, record.nodes}, &record);
    ids.insert(record.id);
  }
  std::vector<BlockPlan> found;
  for (Index c = 0; c < planning.mesh.cell_count(); ++c) {
    const Index key = division.key_of_cell[c];
    if (c == 0 || key != division.key_of_cell[c - 1]) {
      BlockPlan plan{division.keys[key]};
      plan.cells.first = c;
      plan.cells.count = 0;
      const auto record = records.find(Key{plan.cells.label, plan.cells.shape, plan.cells.nodes});
      if (record != records.end()) {
        plan.record = record->second;
        plan.id = plan.record->id;
        with_elements.insert(plan.record);
        records.erase(record);
      } else {
        const bool is_free =
            division.by_labels && plan.cells.label > 0 && ids.insert(plan.cells.label).second;
        plan.id = is_free ? plan.cells.label : -1;
      }
      found.push_back(std::move(plan));
    }
    ++found.back().cells.count;
  }
  for (BlockPlan& plan : found) {
    if (plan.id >= 0 || plan.record != nullptr) continue;
    plan.id = ids.empty() ? 1 : std::max<std::int64_t>(1, *ids.rbegin() + 1);
    if (!std::in_range<std::int32_t>(plan.id)) {  // files with 32-bit ids hold no larger id
      for (plan.id = 1; ids.contains(plan.id);) ++plan.id;
    }
    ids.insert(plan.id);
    if (division.by_sets) plan.cells.label = plan.id;  // a division by sets has no labels to keep
  }
  // a block without elements stays before the block with elements that followed it in the file
  std::size_t next = 0;
  for (const BlockRecord& record : planning.metadata.blocks) {
    if (with_elements.contains(&record)) {
      while (next < found.size() && found[next].record != &record) planning.blocks.push_back(found[next++]);
      if (next < found.size()) planning.blocks.push_back(found[next++]);
    } else {
      const Index first = next < found.size() ? found[next].cells.first : planning.mesh.cell_count();
      BlockPlan empty{CellPart{.first = first, .label = record.label}, &record, record.id, record.name};
      planning.blocks.push_back(std::move(empty));
    }
  }
  while (next < found.size()) planning.blocks.push_back(found[next++]);
  if (division.by_labels || (is_own && find_array(planning.mesh, kLabel, Association::cells) == nullptr))
    planning.placed.insert(label_array(planning.mesh, Association::cells));
}

std::vector<const EntitySet*> name_blocks(Planning& planning) {
  const auto& own_sets = planning.metadata.sets[kElementSets].sets;
  std::vector<const EntitySet*> others;
  for (const EntitySet& set : planning.mesh.sets) {
    if (set.association != Association::cells) continue;
    const bool is_element_set = std::any_of(own_sets.begin(), own_sets.end(), [&](const SetRecord& record) {
      return record.in_mesh == set.name;
    });
    BlockPlan* const block = set.members.empty() ? nullptr : &planning.block_of(set.members.front());
    const bool names_block = !is_element_set && !trimmed(set.name).empty() && block != nullptr &&
                             block->name.empty() && index_size(set.members) == block->cells.count &&
                             std::all_of(set.members.begin(), set.members.end(), [&](Index c) {
                               return c >= block->cells.first && c < block->cells.first + block->cells.count;
                             });
    if (names_block) {
      const bool is_old = block->record != nullptr && block->record->in_mesh == set.name;
      block->name = is_old ? block->record->name : set.name;
    } else {
      others.push_back(&set);
    }
  }
  return others;
}

namespace {

/// Returns the values of an attribute for the elements of a block; `missing` for elements without a value.
std::vector<double> values_in(const Mesh& mesh, const CellPart& block, const DataArray& array,
                              double missing) {
  return column(array, 0, rows_by_item(array, mesh.cell_count()), block.first, block.count, missing);
}

}  // namespace

Columns attributes_of(Planning& planning, const BlockPlan& block) {
  Columns columns;
  if (block.record != nullptr) {
    for (const auto& [name, array] : block.record->attributes) {
      if (const DataArray* const found = planning.take_column(array, Association::cells))
        columns.push_back({name, found});
    }
    return columns;
  }
  for (const DataArray& array : planning.mesh.data) {
    const bool named = array.association == Association::cells && array.name.starts_with(kAttribute) &&
                       array.components == 1 && !are_texts(array.values);
    if (!named) continue;
    planning.placed.insert(&array);
    const std::vector<double> values = values_in(planning.mesh, block.cells, array, std::nan(""));
    if (std::any_of(values.begin(), values.end(), [](double value) { return !std::isnan(value); }))
      columns.push_back({array.name.substr(kAttribute.size()), &array});
  }
  return columns;
}

namespace {

/// Returns the node numbers, from 1, of elements `first` … `first + count − 1` of a block, each in the file's
/// node order.
std::vector<std::int32_t> connectivity(const Mesh& mesh, const CellPart& block, Index first, Index count) {
  const auto nodes = static_cast<std::size_t>(block.nodes);
  std::vector<std::int32_t> result(static_cast<std::size_t>(count) * nodes);
  const std::span<const int> order = file_order(block.shape, block.nodes);
  const Index* from =
      mesh.cells.vertices.data() +
      mesh.cells.offsets[static_cast<std::size_t>(block.first) + static_cast<std::size_t>(first)];
  if (order.empty()) {
    std::transform(from, from + result.size(), result.begin(), [](Index v) { return v + 1; });
    return result;
  }
  for (std::size_t row = 0; row < result.size(); row += nodes, from += nodes) {
    for (std::size_t k = 0; k < nodes; ++k) result[row + static_cast<std::size_t>(order[k])] = from[k] + 1;
  }
  return result;
}

void write_attributes(Writing& writing, const std::string& number, const BlockPlan& block,
                      const Columns& columns) {
  if (columns.empty()) return;
  const std::string count = "num_att_in_blk" + number;
  const bool is_single = block.record != nullptr && block.record->attribute_type == kFloat &&
                         std::all_of(columns.begin(), columns.end(), [&](const Column& column) {
                           return can_hold(kFloat, values_in(writing.mesh, block.cells, *column.array, 0));
                         });
  write_columns(writing, "attrib" + number, is_single ? kFloat : kDouble, {"num_el_in_blk" + number, count},
                columns, block.cells.first, block.cells.count);
  if (block.record == nullptr || block.record->names_attributes)
    writing.write_names("attrib_name" + number, count, names_of(columns));
}

void write_elements(Writing& writing, const std::string& number, const BlockPlan& block) {
  const Mesh& mesh = writing.mesh;
  NcOutput& file = writing.file;
  const std::string elements = "num_el_in_blk" + number;
  const std::string nodes = "num_nod_per_el" + number;
  file.dimension({elements, static_cast<std::size_t>(block.cells.count)});
  file.dimension({nodes, static_cast<std::size_t>(block.cells.nodes)});
  const bool wide = block.record != nullptr && block.record->connect_type == kInt64;
  const NcSink sink = writing.declare("connect" + number, wide ? kInt64 : kInt, {elements, nodes},
                                      {text_attribute("elem_type", std::string(block.type()))});
  file.later([sink, &mesh, cells = block.cells] {
    in_parts(cells.count, [&](Index first, Index count) {
      sink.part({static_cast<std::size_t>(first), 0},
                {static_cast<std::size_t>(count), static_cast<std::size_t>(cells.nodes)},
                connectivity(mesh, cells, first, count));
    });
  });
}

}  // namespace

void write_blocks(Writing& writing, const std::vector<Columns>& attributes) {
  std::vector<std::int64_t> labels;
  for (const BlockPlan& block : writing.blocks) labels.push_back(block.cells.label);
  if (std::all_of(writing.blocks.begin(), writing.blocks.end(),
                  [](const BlockPlan& block) { return block.cells.label == block.id; }))
    labels.clear();
  write_plans(writing, "eb", "num_el_blk", writing.blocks, writing.metadata.block_properties,
              writing.metadata.names_blocks, labels);
  for (std::size_t b = 0; b < writing.blocks.size(); ++b) {
    if (writing.blocks[b].cells.count == 0) continue;
    write_elements(writing, std::to_string(b + 1), writing.blocks[b]);
    write_attributes(writing, std::to_string(b + 1), writing.blocks[b], attributes[b]);
  }
}

}  // namespace meshorder::exodus
