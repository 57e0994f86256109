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

void plan_blocks(Writing& writing, bool is_own) {
  const CellDivision division = divide(writing.mesh);
  using Key = std::tuple<std::int64_t, Shape, int>;
  std::map<Key, const BlockRecord*> records;
  std::set<std::int64_t> ids;
  for (const BlockRecord& record : writing.metadata.blocks) {
    if (record.nodes > 0) records.emplace(Key{record.label, record.shape, record.nodes}, &record);
    ids.insert(record.id);
  }
  std::vector<BlockPlan> found;
  for (Index c = 0; c < writing.mesh.cell_count(); ++c) {
    const Index key = division.key_of_cell[c];
    if (c == 0 || key != division.key_of_cell[c - 1]) {
      BlockPlan plan{division.keys[key]};
      plan.cells.first = c;
      plan.cells.count = 0;
      const auto record = records.find(Key{plan.cells.label, plan.cells.shape, plan.cells.nodes});
      if (record != records.end()) {
        plan.record = record->second;
        plan.id = plan.record->id;
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
  // blocks of the file without elements stay before the next block that has elements
  std::size_t next = 0;
  for (const BlockRecord& record : writing.metadata.blocks) {
    const bool is_there = std::any_of(found.begin(), found.end(),
                                      [&](const BlockPlan& plan) { return plan.record == &record; });
    if (is_there) {
      while (next < found.size() && found[next].record != &record) writing.blocks.push_back(found[next++]);
      if (next < found.size()) writing.blocks.push_back(found[next++]);
    } else {
      const Index first = next < found.size() ? found[next].cells.first : writing.mesh.cell_count();
      BlockPlan empty{Block{.first = first, .label = record.label}, &record, record.id, record.name};
      writing.blocks.push_back(std::move(empty));
    }
  }
  while (next < found.size()) writing.blocks.push_back(found[next++]);
  if (division.by_labels || (is_own && find_array(writing.mesh, kLabel, Association::cells) == nullptr)) {
    writing.placed.insert(label_array(writing.mesh, Association::cells));
  }
}

std::vector<const EntitySet*> name_blocks(Writing& writing) {
  const auto& own_sets = writing.metadata.sets[kElementSets].sets;
  std::vector<const EntitySet*> others;
  for (const EntitySet& set : writing.mesh.sets) {
    if (set.association != Association::cells) continue;
    const bool is_element_set = std::any_of(own_sets.begin(), own_sets.end(), [&](const SetRecord& record) {
      return record.in_mesh == set.name;
    });
    const auto block = std::find_if(writing.blocks.begin(), writing.blocks.end(), [&](const BlockPlan& plan) {
      return !set.members.empty() && set.members.front() >= plan.cells.first &&
             set.members.front() < plan.cells.first + plan.cells.count;
    });
    const bool names_block = !is_element_set && !trimmed(set.name).empty() && block != writing.blocks.end() &&
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

Columns attributes_of(Writing& writing, const BlockPlan& block) {
  Columns columns;
  if (block.record != nullptr) {
    for (const auto& [name, array] : block.record->attributes) {
      if (const DataArray* const found = writing.take_column(array, Association::cells))
        columns.emplace_back(name, found);
    }
    return columns;
  }
  for (const DataArray& array : writing.mesh.data) {
    const bool named = array.association == Association::cells && array.name.starts_with(kAttribute) &&
                       array.components == 1 &&
                       !std::holds_alternative<std::vector<std::string>>(array.values);
    if (!named) continue;
    writing.placed.insert(&array);
    const std::vector<Index> table = rows_by_item(array, writing.mesh.cell_count());
    bool has_values = false;
    std::visit(
        [&](const auto& values) {
          for (Index c = block.cells.first; c < block.cells.first + block.cells.count && !has_values; ++c) {
            const Index row = table.empty() ? c : table[c];
            has_values = row >= 0 && !std::isnan(number_as<double>(values[row]));
          }
        },
        array.values);
    if (has_values) columns.emplace_back(array.name.substr(kAttribute.size()), &array);
  }
  return columns;
}

namespace {

/// Returns the numbers of the nodes of `count` elements of a block, from 1, in the order of the file.
std::vector<std::int32_t> connectivity(const Mesh& mesh, const Block& block, Index first, Index count) {
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

/// Returns the values of an attribute for the elements of a block, 0 for elements without a value.
std::vector<double> values_in(const Mesh& mesh, const Block& block, const DataArray& array) {
  return column<double>(array, 0, rows_by_item(array, mesh.cell_count()), block.first, block.count, 0);
}

void write_attributes(Writing& writing, const std::string& number, const BlockPlan& block,
                      const Columns& columns) {
  if (columns.empty()) return;
  NcOutput& file = writing.file;
  const std::string count = "num_att_in_blk" + number;
  file.dimension({count, columns.size()});
  const bool is_single = block.record != nullptr && block.record->attribute_type == kFloat &&
                         std::all_of(columns.begin(), columns.end(), [&](const auto& column) {
                           return can_hold(kFloat, values_in(writing.mesh, block.cells, *column.second));
                         });
  const NcType type = is_single ? kFloat : kDouble;
  const NcSink sink = writing.declare("attrib" + number, type, {"num_el_in_blk" + number, count});
  file.later([sink, columns, &writing, cells = block.cells] {
    const std::size_t width = columns.size();
    const auto rows = static_cast<std::size_t>(cells.count);
    std::vector<double> table(rows * width, 0);
    for (std::size_t k = 0; k < width; ++k) {
      const std::vector<double> values = values_in(writing.mesh, cells, *columns[k].second);
      for (std::size_t e = 0; e < rows; ++e) table[e * width + k] = values[e];
    }
    sink.part({0, 0}, {rows, width}, table);
  });
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
  std::string type(type_of(block.cells.shape, block.cells.nodes));
  if (block.record != nullptr && block.record->nodes > 0) type = block.record->type;
  const bool wide = block.record != nullptr && block.record->connect_type == kInt64;
  const NcSink sink = writing.declare("connect" + number, wide ? kInt64 : kInt, {elements, nodes},
                                      {text_attribute("elem_type", type)});
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
  const std::string count = "num_el_blk";
  const std::vector<std::string> names =
      write_plans(writing, "eb", count, writing.blocks, writing.metadata.block_properties,
                  [](const BlockPlan& block) { return block.cells.count > 0; });
  std::vector<std::int64_t> labels;
  for (const BlockPlan& block : writing.blocks) labels.push_back(block.cells.label);
  const bool ids_are_labels = std::all_of(writing.blocks.begin(), writing.blocks.end(),
                                          [](const auto& block) { return block.cells.label == block.id; });
  if (!ids_are_labels) {
    writing.write_integers(fmt::format("eb_prop{}", writing.metadata.block_properties.size() + 2), count,
                           labels, {text_attribute("name", std::string(kLabelProperty))});
  }
  const bool named =
      std::any_of(names.begin(), names.end(), [](const std::string& name) { return !name.empty(); });
  if (named || writing.metadata.names_blocks) writing.write_names("eb_names", count, names);
  for (std::size_t b = 0; b < writing.blocks.size(); ++b) {
    if (writing.blocks[b].cells.count == 0) continue;
    write_elements(writing, std::to_string(b + 1), writing.blocks[b]);
    write_attributes(writing, std::to_string(b + 1), writing.blocks[b], attributes[b]);
  }
}

}  // namespace meshorder::exodus
