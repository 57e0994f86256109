// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/gmsh/gmsh.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <unordered_map>
#include <utility>

// Sections that refer to nodes and elements by number: $Periodic and $GhostElements.

namespace meshorder::gmsh {
namespace {

constexpr std::int64_t kAffine = -1;  // precedes the coefficients in binary files of 4.0

bool has_affine_line(const GmshMetadata& metadata) {
  return metadata.is_version_2() || metadata.is_version_40();
}

/// Reads the affine map into `link` and returns the number of pairs. In versions 2.2 and 4.0 an optional line
/// "Affine …" has the 16 coefficients; in 4.1 their number precedes them.
Index read_affine(ReadContext& reading, PeriodicLink& link) {
  NumberReader& source = reading.source;
  constexpr std::string_view kCount = "the number of periodic nodes";
  const auto read_coefficients = [&](Index count) {
    link.affine.resize(count);
    for (double& value : link.affine) value = source.real("an affine coefficient");
  };
  if (!has_affine_line(reading.metadata)) {
    read_coefficients(source.count("the number of affine coefficients", 2, 8));
  } else if (source.binary) {
    const std::int64_t count = source.int64(kCount);
    if (count != kAffine) return source.checked_count(count, kCount, 8);
    read_coefficients(16);
  } else if (source.scanner.peek_word() == "Affine") {
    (void)source.scanner.word("Affine");
    read_coefficients(16);
  }
  return source.count(kCount, 4, reading.metadata.has_wide_numbers() ? 16 : 8);
}

/// Numbers of pairs that are left out.
struct LeftOut {
  Index missing = 0;   ///< they name a node that the file does not have
  Index repeated = 0;  ///< kMostSets pairs of the entity name the same node before them
};

constexpr std::size_t kMostSets = 64;  // a hostile file could ask for one for each pair

/// Reads pairs of nodes as pairs of sets.
void read_pairs(ReadContext& reading, PeriodicLink& link, Index count, LeftOut& left_out) {
  const std::string name = "gmsh:periodic " + std::to_string(link.dimension) + " " + std::to_string(link.tag);
  std::vector<std::array<EntitySet, 2>> sets;
  const auto add_sets = [&] {
    const std::string further = sets.empty() ? name : name + " " + std::to_string(sets.size() + 1);
    link.pairs.push_back({further, further + " master"});
    sets.push_back({EntitySet{link.pairs.back().nodes, Association::vertices, {}},
                    EntitySet{link.pairs.back().masters, Association::vertices, {}}});
  };
  add_sets();
  std::unordered_map<Index, std::size_t> sets_of_node;  // number of the first sets that may have the node
  std::unordered_map<Index, std::size_t> sets_of_master;
  for (Index i = 0; i < count; ++i) {
    const Index node = reading.nodes.find(read_number(reading, "a periodic node"));
    const Index master = reading.nodes.find(read_number(reading, "a periodic node"));
    if (node < 0 || master < 0) {
      ++left_out.missing;
      continue;
    }
    const std::size_t place = std::max(sets_of_node[node], sets_of_master[master]);
    if (place == kMostSets) {
      ++left_out.repeated;
      continue;
    }
    if (place == sets.size()) add_sets();
    sets_of_node[node] = sets_of_master[master] = place + 1;
    sets[place][0].members.push_back(node);
    sets[place][1].members.push_back(master);
  }
  for (auto& [nodes, masters] : sets) {
    reading.mesh.sets.push_back(std::move(nodes));
    reading.mesh.sets.push_back(std::move(masters));
  }
}

/// Returns the pairs; none if their sets have been removed from the mesh.
std::vector<std::pair<Index, Index>> nodes_of(const NodePairs& pairs, const WriteContext& output) {
  const EntitySet* const nodes = output.parts.set(pairs.nodes, Association::vertices);
  const EntitySet* const masters = output.parts.set(pairs.masters, Association::vertices);
  std::vector<std::pair<Index, Index>> result;
  if (nodes == nullptr || masters == nullptr) return result;
  const std::size_t count = std::min(nodes->members.size(), masters->members.size());
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i) result.emplace_back(nodes->members[i], masters->members[i]);
  return result;
}

}  // namespace

void read_periodic(ReadContext& reading, std::string_view section) {
  NumberReader& source = reading.source;
  // in version 2.2 this section is text in binary files as well
  const bool binary = source.binary;
  if (reading.metadata.is_version_2()) source.binary = false;
  const Index links = read_count(reading, "the number of periodic entities", 8, 20);
  LeftOut left_out;
  std::set<Entity> entities;
  for (Index i = 0; i < links; ++i) {
    PeriodicLink link;
    link.dimension = source.int32("the dimension of a periodic entity");
    link.tag = source.int32("the tag of a periodic entity");
    link.master = source.int32("the tag of a master entity");
    if (!entities.emplace(link.dimension, link.tag).second) {
      source.fail(
          fmt::format("the periodic entity {} of dimension {} is given twice", link.tag, link.dimension),
          "each has one master");
    }
    const Index pairs = read_affine(reading, link);
    read_pairs(reading, link, pairs, left_out);
    reading.metadata.periodic.push_back(std::move(link));
  }
  expect_end(reading, section);
  source.binary = binary;
  if (left_out.missing > 0) {
    reading.notes.push_back(fmt::format(
        "{} pairs of $Periodic are ignored: they name nodes that the file does not have", left_out.missing));
  }
  if (left_out.repeated > 0) {
    reading.notes.push_back(
        fmt::format("{} pairs of $Periodic are ignored: {} earlier pairs of the entity name the same node",
                    left_out.repeated, kMostSets));
  }
}

void write_periodic(NumberWriter& sink, const WriteContext& output) {
  const bool affine_line = has_affine_line(output.layout);
  const bool wide = output.layout.has_wide_numbers();
  NumberWriter text(sink.out, sink.file);
  NumberWriter& to = output.layout.is_version_2() ? text : sink;
  to.number(index_size(output.layout.periodic), wide);
  to.end_line();
  for (const PeriodicLink& link : output.layout.periodic) {
    to.int32(link.dimension);
    to.int32(link.tag);
    to.int32(link.master);
    to.end_line();
    if (!affine_line) {
      to.size(index_size(link.affine));
    } else if (!link.affine.empty() && to.binary) {
      to.size(kAffine);
    } else if (!link.affine.empty()) {
      to.word("Affine");
    }
    for (const double value : link.affine) to.real(value);
    if (!affine_line || !link.affine.empty()) to.end_line();
    Index count = 0;
    for (const NodePairs& pairs : link.pairs) count += index_size(nodes_of(pairs, output));
    to.size(count);
    to.end_line();
    for (const NodePairs& pairs : link.pairs) {
      for (const auto& [node, master] : nodes_of(pairs, output)) {
        to.number(output.node_id(node), wide);
        to.number(output.node_id(master), wide);
        to.end_line();
      }
    }
  }
}

// ---- ghost elements

void read_ghosts(ReadContext& reading, std::string_view section) {
  NumberReader& source = reading.source;
  const Index count = read_count(reading, "the number of ghost elements", 6, 12);
  DataArray array;
  array.name = kCellGhosts;
  array.association = Association::cells;
  std::vector<std::int32_t> owners;
  std::vector<std::vector<std::int32_t>> ghosts;
  std::size_t most = 0;
  std::size_t total = 0;
  for (Index i = 0; i < count; ++i) {
    const std::int64_t id = read_number(reading, "the number of a ghost element");
    const Index place = reading.elements.find(id);
    if (place < 0) {
      source.fail("$GhostElements names element " + std::to_string(id) + ", which $Elements does not have",
                  "name elements that exist");
    }
    array.indices.push_back(place);
    owners.push_back(source.int32("a partition"));
    auto& partitions = ghosts.emplace_back(read_count(reading, "the number of ghost partitions", 2, 4));
    for (std::int32_t& partition : partitions) partition = source.int32("a ghost partition");
    most = std::max(most, partitions.size());
    total += partitions.size();
  }
  expect_end(reading, section);
  check_distinct(source, array.indices, section);
  if (count == 0) return;
  const std::size_t width = 2 + most;
  if (width * owners.size() > 64 * (total + owners.size()) + 4096) {
    source.fail("a ghost element has " + std::to_string(most) + " partitions, far more than the others",
                "the file may be damaged");
  }
  std::vector<std::int32_t> values(width * owners.size(), 0);
  for (std::size_t i = 0; i < owners.size(); ++i) {
    values[i * width] = owners[i];
    values[i * width + 1] = static_cast<std::int32_t>(ghosts[i].size());
    std::copy(ghosts[i].begin(), ghosts[i].end(), values.begin() + static_cast<Offset>(i * width + 2));
  }
  array.components = static_cast<Index>(width);
  array.values = std::move(values);
  reading.mesh.data.push_back(std::move(array));
}

const DataArray* ghosts_of(const Mesh& mesh) {
  const DataArray* array = find_array(mesh, kCellGhosts, Association::cells);
  const bool fits =
      array && array->components >= 2 && std::holds_alternative<std::vector<std::int32_t>>(array->values);
  return fits ? array : nullptr;
}

void write_ghosts(NumberWriter& sink, const WriteContext& output) {
  const DataArray* array = ghosts_of(output.mesh);
  const auto* values = array ? std::get_if<std::vector<std::int32_t>>(&array->values) : nullptr;
  const Index rows = values ? row_count(*array) : 0;
  const bool wide = output.layout.has_wide_numbers();
  sink.number(rows, wide);
  sink.end_line();
  for (Index row = 0; row < rows; ++row) {
    const auto width = static_cast<std::size_t>(array->components);
    const auto* of_row = values->data() + row * width;
    const auto count = std::clamp<std::int64_t>(of_row[1], 0, static_cast<std::int64_t>(width) - 2);
    sink.number(output.cell_id(array->is_dense() ? row : array->indices[row]), wide);
    sink.int32(of_row[0]);
    sink.number(count, wide);
    for (std::int64_t k = 0; k < count; ++k) sink.int32(of_row[2 + k]);
    sink.end_line();
  }
}

}  // namespace meshorder::gmsh
