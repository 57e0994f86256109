// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/memory.hpp"
#include "io/gmsh/gmsh.hpp"
#include "io/stream/regular_text.hpp"
#include "mesh/cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>
#include <span>

// Versions 4.0 and 4.1: nodes and elements are in blocks. A block belongs to an entity of the geometry, which
// may have several blocks; entities have physical groups. In 4.0 an entity's tag precedes its dimension, a
// node's number precedes its coordinates, and numbers of nodes and elements in binary files have 32 bits.

namespace meshorder::gmsh {
namespace {

/// Reads a count and that many ints.
std::vector<std::int32_t> read_ints(NumberReader& source, std::string_view what) {
  std::vector<std::int32_t> result(source.count(what, 2, 4));
  for (std::int32_t& value : result) value = source.int32(what);
  return result;
}

std::int32_t read_dimension(NumberReader& source) {
  const std::int32_t dimension = source.int32("an entity's dimension");
  if (dimension < 0 || dimension > 3) {
    source.fail("an entity's dimension is " + std::to_string(dimension), "0, 1, 2 and 3 are possible");
  }
  return dimension;
}

/// Reads the dimension and tag of a block's entity.
Entity read_entity(ReadContext& reading) {
  NumberReader& source = reading.source;
  if (!reading.metadata.is_version_40()) {
    const std::int32_t dimension = read_dimension(source);
    return {dimension, source.int32("an entity's tag")};
  }
  const std::int32_t tag = source.int32("an entity's tag");
  return {read_dimension(source), tag};
}

/// Returns how many parametric coordinates a node has in a parametric block of that dimension.
int parameters_4(const GmshMetadata& metadata, std::int32_t dimension) {
  return metadata.is_version_40() && dimension == 3 ? 0 : dimension;
}

/// Reads records like `read_regular_records` if the file is text; returns 0 for a binary file.
template <class Read>
Index read_regular(NumberReader& source, Index count, const Read& read) {
  return source.binary ? 0 : read_regular_records(source.scanner, count, read);
}

/// Reads one block of nodes after its head. Appends to `parameters` four numbers for each parametric node.
void read_node_block(ReadContext& reading, const EmptyBlock& head, Index count,
                     std::vector<std::int64_t>& ids, std::vector<double>& parameters) {
  NumberReader& source = reading.source;
  const bool parametric = head[2] == 1;
  const int given = parameters_4(reading.metadata, head[0]);
  const bool number_with_point = reading.metadata.is_version_40();
  if (!number_with_point) {
    ids.resize(ids.size() + count);
    const std::span block = std::span(ids).last(count);
    const Index regular =
        read_regular(source, count, [&](Scanner& in, Index i) { return in.take_number(block[i]); });
    for (std::int64_t& id : block.subspan(regular)) id = source.int64("the number of a node");
  }
  std::vector<Point>& points = reading.mesh.points;
  const std::size_t first = points.size();
  points.resize(first + count);
  const std::span block = std::span(points).last(count);
  Index regular = 0;
  if (!parametric && !number_with_point) {
    regular = read_regular(source, count, [&](Scanner& in, Index i) {
      return std::ranges::all_of(block[i], [&](double& x) { return in.take_finite(x); });
    });
  }
  for (Index i = regular; i < count; ++i) {
    if (number_with_point) ids.push_back(read_number(reading, "the number of a node"));
    for (double& x : block[i]) x = source.finite("a coordinate");
    if (!parametric) continue;
    parameters.resize(4 * (first + i), 0.0);  // zeros for earlier nodes without parameters
    parameters.push_back(1);
    for (int k = 0; k < 3; ++k) {
      parameters.push_back(k < given ? source.real("a parametric coordinate") : 0.0);
    }
  }
}

/// Appends the elements of one block after its head.
void read_element_block(ReadContext& reading, const ElementType& type, Index count,
                        std::vector<std::int64_t>& ids) {
  NumberReader& source = reading.source;
  const auto number = [&source, wide = reading.metadata.has_wide_numbers()](std::string_view what) {
    return wide ? source.int64(what) : source.int32(what);
  };
  Cells& cells = reading.mesh.cells;
  const std::span<const int> order = vtk_order(type.shape, type.nodes);
  const Index first = cells.size();
  append_cells(cells, type.shape, type.nodes, count);
  ids.resize(ids.size() + static_cast<std::size_t>(count));
  const std::span block = std::span(ids).last(static_cast<std::size_t>(count));
  const auto sort = [&](std::span<Index> cell) {  // only cells of second order
    std::array<Index, 27> of_file{};
    std::ranges::copy(cell.first(order.size()), of_file.begin());
    for (std::size_t k = 0; k < order.size(); ++k) cell[k] = of_file[static_cast<std::size_t>(order[k])];
  };
  const Index regular = read_regular(source, count, [&](Scanner& in, Index c) {
    if (!in.take_number(block[c])) return false;
    const std::span<Index> cell = cells[first + c];
    for (Index& v : cell) {
      std::int64_t node = 0;
      if (!in.take_number(node)) return false;
      v = reading.nodes.find(node);
      if (v < 0) return false;
    }
    if (!order.empty()) sort(cell);
    return true;
  });
  for (Index c = regular; c < count; ++c) {
    block[c] = number("the number of an element");
    const std::span<Index> cell = cells[first + c];
    for (Index& v : cell) v = place_of_node(reading, number("a node of an element"), "element", block[c]);
    if (!order.empty()) sort(cell);
  }
}

/// Reads the head of a section of blocks; returns the numbers of blocks and of all nodes or elements.
std::pair<Index, Index> read_head(ReadContext& reading, std::string_view what, std::int64_t text_bytes,
                                  std::int64_t binary_bytes) {
  NumberReader& source = reading.source;
  const Index blocks = source.count("the number of blocks", 8, 20);
  const Index all = source.count(fmt::format("the number of {}", what), text_bytes, binary_bytes);
  if (reading.metadata.is_version_40()) return {blocks, all};
  // skip the smallest and largest number, which Gmsh itself does not use
  (void)source.int64(fmt::format("the smallest number of {}", what));
  (void)source.int64(fmt::format("the largest number of {}", what));
  return {blocks, all};
}

[[noreturn]] void fail_count(const NumberReader& source, std::string_view section, std::int64_t blocks,
                             std::int64_t promised) {
  source.fail(fmt::format("the blocks of ${} have {}{} instead of {}", section, blocks,
                          blocks > promised ? " or more" : "", promised),
              "the counts must agree");
}

/// Returns the smallest and largest number; both are 0 if there are no numbers.
std::pair<std::int64_t, std::int64_t> range_of(const std::vector<std::int64_t>& ids, Index count) {
  if (count == 0) return {0, 0};
  if (ids.empty()) return {1, count};
  const auto [least, greatest] = std::minmax_element(ids.begin(), ids.end());
  return {*least, *greatest};
}

void write_head(NumberWriter& sink, const WriteContext& output, std::size_t blocks, Index count,
                const std::vector<std::int64_t>& ids) {
  sink.size(static_cast<std::int64_t>(blocks));
  sink.size(count);
  if (!output.layout.is_version_40()) {
    const auto [least, greatest] = range_of(ids, count);
    sink.size(least);
    sink.size(greatest);
  }
  sink.end_line();
}

void write_block_head(NumberWriter& sink, const WriteContext& output, const EmptyBlock& head, Index count) {
  const bool tag_first = output.layout.is_version_40();
  sink.int32(head[tag_first ? 1 : 0]);
  sink.int32(head[tag_first ? 0 : 1]);
  sink.int32(head[2]);
  sink.size(count);
  sink.end_line();
}

/// Returns the starts of runs of equal heads, then `count`. A run also ends before i if `breaks(i)`.
template <class Head, class Breaks>
std::vector<Index> runs(Index count, const Head& head, const Breaks& breaks) {
  std::vector<Index> starts;
  for (Index i = 0; i < count; ++i) {
    if (i == 0 || breaks(i) || head(i) != head(i - 1)) starts.push_back(i);
  }
  starts.push_back(count);
  return starts;
}

}  // namespace

void read_entities_4(ReadContext& reading, bool partitioned) {
  NumberReader& source = reading.source;
  const bool version_40 = reading.metadata.is_version_40();
  if (partitioned) {
    (void)read_number(reading, "the number of partitions");
    const Index ghosts = read_count(reading, "the number of ghost entities", 4, 8);
    for (Index i = 0; i < ghosts; ++i) {
      (void)source.int32("the tag of a ghost entity");
      (void)source.int32("the partition of a ghost entity");
    }
  }
  std::array<Index, 4> counts{};
  for (Index& count : counts) count = source.count("a number of entities", 8, 20);
  for (std::int32_t dimension = 0; dimension < 4; ++dimension) {
    for (Index i = 0; i < counts[dimension]; ++i) {
      const std::int32_t tag = source.int32("an entity's tag");
      if (partitioned) {
        (void)source.int32("the dimension of a parent entity");
        (void)source.int32("the tag of a parent entity");
        const Index partitions = read_count(reading, "an entity's partitions", 2, 4);
        for (Index k = 0; k < partitions; ++k) (void)source.int32("an entity's partition");
      }
      const int reals = dimension == 0 && !version_40 ? 3 : 6;
      for (int k = 0; k < reals; ++k) (void)source.real("an entity's extent");
      auto physicals = read_ints(source, "an entity's physical groups");
      if (dimension > 0) (void)read_ints(source, "an entity's boundary");
      // the sign of a physical group is an orientation
      for (std::int32_t& physical : physicals) {
        if (physical < 0 && physical > std::numeric_limits<std::int32_t>::min()) physical = -physical;
      }
      if (!physicals.empty()) reading.metadata.physicals[{dimension, tag}] = std::move(physicals);
    }
  }
}

void read_nodes_4(ReadContext& reading) {
  NumberReader& source = reading.source;
  Mesh& mesh = reading.mesh;
  const std::int64_t bytes = reading.metadata.has_wide_numbers() ? 32 : 28;
  const auto [blocks, all] = read_head(reading, "nodes", 8, bytes);
  std::vector<std::int64_t> ids;
  std::vector<std::int32_t> entities;
  std::vector<double> parameters;
  reserve_large(ids, static_cast<std::size_t>(all));
  reserve_large(mesh.points, static_cast<std::size_t>(all));
  reserve_large(entities, 2 * static_cast<std::size_t>(all));
  for (Index b = 0; b < blocks; ++b) {
    const auto [dimension, tag] = read_entity(reading);
    const EmptyBlock block{dimension, tag, source.int32("whether nodes have parametric coordinates")};
    if (block[2] != 0 && block[2] != 1) {
      source.fail("'parametric' is " + std::to_string(block[2]), "0 and 1 are possible");
    }
    const Index count = source.count("the number of nodes in a block", 8, bytes);
    if (count > all - index_size(ids)) {
      fail_count(source, "Nodes", Offset{count} + index_size(ids), all);
    }
    if (count == 0) reading.metadata.empty_node_blocks.push_back(block);
    for (Index i = 0; i < count; ++i) entities.insert(entities.end(), {block[0], block[1]});
    read_node_block(reading, block, count, ids, parameters);
  }
  if (index_size(ids) != all) fail_count(source, "Nodes", index_size(ids), all);
  expect_end(reading, "Nodes");
  reading.nodes = number_ids(source, ids, "node");
  mesh.vertex_ids = std::move(ids);
  keep_array(mesh, kNodeEntity, Association::vertices, 2, std::move(entities));
  if (!parameters.empty()) keep_parameters(mesh, std::move(parameters));
}

void read_elements_4(ReadContext& reading) {
  NumberReader& source = reading.source;
  Mesh& mesh = reading.mesh;
  const std::int64_t bytes = reading.metadata.has_wide_numbers() ? 8 : 4;  // size of a number
  const auto [blocks, all] = read_head(reading, "elements", 4, 2 * bytes);
  std::vector<std::int64_t> ids;
  std::vector<std::int32_t> tags;
  std::vector<std::int32_t> dimensions;
  std::vector<std::int32_t> types;
  std::vector<Index> starts;
  std::set<EmptyBlock> kinds;
  std::optional<EmptyBlock> last;
  bool repeated = false;
  reserve_large(ids, static_cast<std::size_t>(all));
  for (Index b = 0; b < blocks; ++b) {
    const auto [dimension, tag] = read_entity(reading);
    const ElementType& type = known_type(source, source.int32("a block's element type"));
    const Index count =
        source.count("the number of elements in a block", 2 + 2 * type.nodes, bytes * (1 + type.nodes));
    if (count > all - index_size(ids)) {
      fail_count(source, "Elements", Offset{count} + index_size(ids), all);
    }
    if (count == 0) {
      reading.metadata.empty_element_blocks.push_back({dimension, tag, type.number});
      continue;
    }
    // successive blocks of the same kind become one block
    const EmptyBlock kind{dimension, tag, type.number};
    if (kind != last) {
      starts.push_back(index_size(ids));
      repeated = !kinds.insert(kind).second || repeated;
      last = kind;
    }
    read_element_block(reading, type, count, ids);
    tags.insert(tags.end(), count, tag);
    dimensions.insert(dimensions.end(), count, dimension);
    types.insert(types.end(), count, type.number);
  }
  if (index_size(ids) != all) fail_count(source, "Elements", index_size(ids), all);
  expect_end(reading, "Elements");
  reading.elements = number_ids(source, ids, "element");
  mesh.cell_ids = std::move(ids);

  // if a kind has several blocks, as in a converted mesh, do not bind cells to blocks: the order of the cells
  // matters more
  if (!repeated && starts.size() > 1) mesh.cell_blocks = std::move(starts);
  bool own = true;
  for (Index c = 0; c < mesh.cell_count(); ++c) own = own && dimensions[c] == dimension(mesh.cells.shapes[c]);
  keep_array(mesh, kCellEntity, Association::cells, 1, std::move(tags));
  if (!own) keep_array(mesh, kCellDimension, Association::cells, 1, std::move(dimensions));
  keep_unusual_types(mesh, types);
}

void write_nodes_4(NumberWriter& sink, const WriteContext& output) {
  const Mesh& mesh = output.mesh;
  const std::vector<double>* parameters = parameters_of(mesh);
  const auto head = [&](Index v) -> EmptyBlock {
    const std::size_t at = 2 * static_cast<std::size_t>(v);
    return {output.node_entities[at], output.node_entities[at + 1],
            parameters && (*parameters)[2 * at] != 0 ? 1 : 0};
  };

  const auto write_point = [&](RowWriter& to, const EmptyBlock& block, Index v) {
    to.all(mesh.points[v]);
    const int given = block[2] == 1 ? parameters_4(output.layout, block[0]) : 0;
    for (int k = 0; k < given; ++k) to.real((*parameters)[4 * static_cast<std::size_t>(v) + 1 + k]);
  };
  // successive nodes of one entity form a block: this keeps the order of the mesh
  const std::vector<Index> starts = runs(mesh.vertex_count(), head, [](Index) { return false; });
  const auto& empty = output.layout.empty_node_blocks;
  write_head(sink, output, starts.size() - 1 + empty.size(), mesh.vertex_count(), output.node_ids);
  for (const EmptyBlock& block : empty) write_block_head(sink, output, block, 0);
  for (std::size_t b = 0; b + 1 < starts.size(); ++b) {
    const EmptyBlock block = head(starts[b]);
    const Index first = starts[b];
    const Index count = starts[b + 1] - first;
    write_block_head(sink, output, block, count);
    if (output.layout.is_version_40()) {
      write_rows(sink, count, [&](RowWriter& to, Index i) {
        to.number(output.node_id(first + i), output.layout.has_wide_numbers());
        write_point(to, block, first + i);
      });
      continue;
    }
    write_rows(sink, count, [&](RowWriter& to, Index i) { to.size(output.node_id(first + i)); });
    write_rows(sink, count, [&](RowWriter& to, Index i) { write_point(to, block, first + i); });
  }
}

void write_elements_4(NumberWriter& sink, const WriteContext& output) {
  const Mesh& mesh = output.mesh;
  const auto head = [&](Index c) -> EmptyBlock {
    return {output.cell_dimensions[c], output.cell_tags[c], output.types[c]->number};
  };
  const auto begins_block = [&](Index c) {
    return std::binary_search(mesh.cell_blocks.begin(), mesh.cell_blocks.end(), c);
  };
  const std::vector<Index> starts = runs(mesh.cell_count(), head, begins_block);
  const auto& empty = output.layout.empty_element_blocks;
  const bool wide = output.layout.has_wide_numbers();
  write_head(sink, output, starts.size() - 1 + empty.size(), mesh.cell_count(), output.cell_ids);
  for (const EmptyBlock& block : empty) write_block_head(sink, output, block, 0);
  for (std::size_t b = 0; b + 1 < starts.size(); ++b) {
    write_block_head(sink, output, head(starts[b]), starts[b + 1] - starts[b]);
    write_rows(sink, starts[b + 1] - starts[b], [&](RowWriter& to, Index i) {
      const Index c = starts[b] + i;
      to.number(output.cell_id(c), wide);
      write_cell_nodes(to, output, c, wide);
    });
  }
}

}  // namespace meshorder::gmsh
