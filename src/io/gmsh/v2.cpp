// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/gmsh/gmsh.hpp"
#include "io/stream/regular_text.hpp"

#include <fmt/format.h>

#include <algorithm>

// Versions 1 to 2.2: one list of nodes and one list of elements. Each element has its own tags: the physical
// group, then the entity, then partitions. In version 1, which is always text, an element has the first two
// tags, then the number of its nodes.

namespace meshorder::gmsh {
namespace {

/// The tags of all elements. Elements may have different numbers of tags.
struct Tags {
  std::vector<Offset> offsets{0};
  std::vector<std::int32_t> values;

  [[nodiscard]] Index size() const { return static_cast<Index>(offsets.size()) - 1; }
  [[nodiscard]] std::span<const std::int32_t> operator[](Index c) const {
    return {values.data() + offsets[c], values.data() + offsets[c + 1]};
  }
};

/// The head of one element.
struct Element {
  std::int64_t id;
  const ElementType* type;
  Index tag_count;
};

/// Returns whether tags follow the partitions: such tags are numbers of elements, the parents and domains of
/// cut elements.
bool has_element_tags(double version, std::span<const std::int32_t> tags) {
  return tags.size() >
         (version < 2.15 || tags.size() < 4 ? 3 : 3 + static_cast<std::size_t>(std::max(0, tags[2])));
}

/// Reads the number of nodes of an element of version 1; fails unless its type has the same number.
void check_node_count(NumberReader& source, const Element& element) {
  const std::int32_t count = source.int32("an element's number of nodes");
  if (count != element.type->nodes) {
    source.fail(fmt::format("element {} has {} nodes", element.id, count),
                fmt::format("elements of type {} have {}", element.type->number, element.type->nodes));
  }
}

void read_element_body(ReadContext& reading, const Element& element, Tags& tags, std::vector<Index>& nodes) {
  NumberReader& source = reading.source;
  for (Index t = 0; t < element.tag_count; ++t) tags.values.push_back(source.int32("a tag"));
  if (reading.metadata.is_version_1()) check_node_count(source, element);
  tags.offsets.push_back(static_cast<Offset>(tags.values.size()));
  if (has_element_tags(reading.metadata.version, tags[tags.size() - 1])) {
    source.fail("an element has more tags than its partitions explain",
                "elements cut from a parent cannot be reordered; save the mesh without them");
  }
  nodes.clear();
  for (int k = 0; k < element.type->nodes; ++k) {
    nodes.push_back(place_of_node(reading, source.int32("a node of an element"), "element", element.id));
  }
  add_cell(reading.mesh, *element.type, nodes);
}

/// Reads at most `most` elements of a text on all threads, up to the first element with a fault or with
/// another type or number of tags than `last`. Adds them to `tags`, `ids` and the mesh; returns their number.
Index read_alike(ReadContext& reading, const Element& last, Index most, Tags& tags,
                 std::vector<std::int64_t>& ids) {
  const auto tag_count = static_cast<std::size_t>(last.tag_count);
  const auto node_count = static_cast<std::size_t>(last.type->nodes);
  const std::size_t first = ids.size();
  const std::size_t first_tag = tags.values.size();
  ids.resize(first + most);
  tags.values.resize(first_tag + most * tag_count);
  std::vector<Index> nodes(most * node_count);
  const auto tags_of = [&](Index e) {
    return std::span(tags.values).subspan(first_tag + e * tag_count, tag_count);
  };
  const auto nodes_of = [&](Index e) { return std::span(nodes).subspan(e * node_count, node_count); };
  const Index read = read_regular_records(reading.source.scanner, most, [&](Scanner& in, Index e) {
    std::int32_t id = 0;
    std::int32_t type = 0;
    std::int32_t own_tags = 0;
    if (!in.take_number(id) || !in.take_number(type) || type != last.type->number ||
        !in.take_number(own_tags) || own_tags != last.tag_count)
      return false;
    ids[first + e] = id;
    for (std::int32_t& tag : tags_of(e)) {
      if (!in.take_number(tag)) return false;
    }
    if (has_element_tags(reading.metadata.version, tags_of(e))) return false;
    for (Index& place : nodes_of(e)) {
      std::int32_t node = 0;
      if (!in.take_number(node)) return false;
      place = reading.nodes.find(node);
      if (place < 0) return false;
    }
    return true;
  });
  ids.resize(first + read);
  tags.values.resize(first_tag + read * tag_count);
  for (Index e = 0; e < read; ++e) {
    tags.offsets.push_back(tags.offsets.back() + last.tag_count);
    add_cell(reading.mesh, *last.type, nodes_of(e));
  }
  return read;
}

/// Decides when to call `read_alike`, and for how many elements. After a success, it tries more; after each
/// failure, it waits for more elements to be read one by one. Mixed elements then cost little.
class Alikes {
 public:
  /// Calls `read_alike` or does nothing; returns the number of elements read.
  Index read(ReadContext& reading, const Element& last, Index left, Tags& tags,
             std::vector<std::int64_t>& ids) {
    if (pause_ > 0) {
      --pause_;
      return 0;
    }
    // each number takes two bytes at least: a wrong count cannot cause a huge allocation
    const std::int64_t numbers = 3 + last.tag_count + last.type->nodes;
    const std::int64_t room = reading.source.scanner.bytes_left() / (2 * numbers);
    const auto most = static_cast<Index>(std::min<std::int64_t>(std::min(left, at_once_), room));
    const Index found = read_alike(reading, last, most, tags, ids);
    at_once_ = found == most ? std::min(4 * at_once_, kMost) : kFewest;
    in_vain_ = found > 0 ? 0 : std::min(2 * in_vain_ + 1, kMost);
    pause_ = in_vain_;
    return found;
  }

 private:
  static constexpr Index kFewest = 1 << 10;
  static constexpr Index kMost = 1 << 20;
  Index at_once_ = kFewest;
  Index in_vain_ = 0;
  Index pause_ = 0;
};

Index read_tag_count(NumberReader& source) {
  return source.checked_count(source.int32("the number of tags"), "the number of tags",
                              source.binary ? 4 : 2);
}

/// Adds the tags `first`, `first` + 1, … of all cells as an array of `components`; missing tags are 0.
void keep_tags_as(Mesh& mesh, std::string_view name, const Tags& tags, std::size_t first,
                  std::size_t components) {
  std::vector<std::int32_t> values(tags.size() * components, 0);
  for (Index c = 0; c < tags.size(); ++c) {
    const auto of_cell = tags[c];
    for (std::size_t k = 0; k < components && first + k < of_cell.size(); ++k) {
      values[c * components + k] = of_cell[first + k];
    }
  }
  keep_array(mesh, name, Association::cells, static_cast<Index>(components), std::move(values));
}

void keep_tags(const NumberReader& source, Mesh& mesh, const Tags& tags) {
  std::size_t most = 0;
  bool even = true;
  for (Index c = 0; c < tags.size(); ++c) {
    most = std::max(most, tags[c].size());
    even = even && tags[c].size() == tags[0].size();
  }
  // all rows are as wide as the longest; refuse absurd widths of damaged files
  if (most * static_cast<std::size_t>(tags.size()) > 64 * tags.values.size() + 4096) {
    source.fail("an element has " + std::to_string(most) + " tags, far more than the others",
                "the file may be damaged");
  }
  if (most > 0) keep_tags_as(mesh, kLabel, tags, 0, 1);
  if (most > 1) keep_tags_as(mesh, kCellEntity, tags, 1, 1);
  if (most > 2) keep_tags_as(mesh, kCellPartitions, tags, 2, most - 2);
  if (!even) {
    std::vector<std::int32_t> counts(tags.size());
    for (Index c = 0; c < tags.size(); ++c) counts[c] = static_cast<std::int32_t>(tags[c].size());
    keep_array(mesh, kCellTagCount, Association::cells, 1, std::move(counts));
  }
}

/// Returns how many parametric coordinates a node in $ParametricNodes has on an entity of that dimension.
int parameters_2(std::int32_t dimension) { return dimension == 1 || dimension == 2 ? dimension : 0; }

/// The tags of the cells of a mesh, from its arrays.
class TagsOfMesh {
 public:
  explicit TagsOfMesh(const Mesh& mesh, bool labels_are_tags)
      : labels_(labels_are_tags ? integers_of(mesh, kLabel, Association::cells)
                                : std::vector<std::int32_t>{}),
        entities_(integers_of(mesh, kCellEntity, Association::cells)),
        partitions_(integers_of(mesh, kCellPartitions, Association::cells, kAnyComponents)),
        counts_(integers_of(mesh, kCellTagCount, Association::cells)),
        width_(partitions_.empty() ? 0 : partitions_.size() / mesh.cells.shapes.size()) {}

  [[nodiscard]] std::size_t count(Index c) const {
    if (!counts_.empty()) return static_cast<std::size_t>(std::max(0, counts_[c]));
    if (!partitions_.empty()) return 2 + width_;
    if (!entities_.empty()) return 2;
    return labels_.empty() ? 0 : 1;
  }
  [[nodiscard]] std::int32_t tag(Index c, std::size_t k) const {
    if (k == 0) return labels_.empty() ? 0 : labels_[c];
    if (k == 1) return entities_.empty() ? 0 : entities_[c];
    return k - 2 < width_ ? partitions_[c * width_ + k - 2] : 0;
  }

 private:
  std::vector<std::int32_t> labels_, entities_, partitions_, counts_;
  std::size_t width_;
};

}  // namespace

void read_nodes_2(ReadContext& reading, std::string_view section) {
  NumberReader& source = reading.source;
  const bool parametric = section == "ParametricNodes";
  const Index count = source.checked_count(source.text_integer("the number of nodes"), "the number of nodes",
                                           source.binary ? 28 : 8);
  source.begin_binary();
  std::vector<std::int64_t> ids(count);
  std::vector<std::int32_t> entities;
  std::vector<double> parameters;
  std::vector<Point>& points = reading.mesh.points;
  points.resize(count);
  Index regular = 0;
  if (!source.binary && !parametric) {
    regular = read_regular_records(source.scanner, count, [&](Scanner& in, Index v) {
      std::int32_t id = 0;
      if (!in.take_number(id)) return false;
      ids[v] = id;
      return std::ranges::all_of(points[v], [&](double& x) { return in.take_finite(x); });
    });
  }
  for (Index v = regular; v < count; ++v) {
    ids[v] = source.int32("the number of a node");
    for (double& x : points[v]) x = source.finite("a coordinate");
    if (!parametric) continue;
    const std::int32_t dimension = source.int32("the dimension of a node's entity");
    entities.insert(entities.end(), {dimension, source.int32("the tag of a node's entity")});
    parameters.push_back(1);
    for (int k = 0; k < 3; ++k) {
      parameters.push_back(k < parameters_2(dimension) ? source.real("a parametric coordinate") : 0.0);
    }
  }
  expect_end(reading, section);
  reading.nodes = number_ids(source, ids, "node");
  reading.mesh.vertex_ids = std::move(ids);
  if (!parametric) return;
  keep_array(reading.mesh, kNodeEntity, Association::vertices, 2, std::move(entities));
  keep_parameters(reading.mesh, std::move(parameters));
}

void read_elements_2(ReadContext& reading, std::string_view section) {
  NumberReader& source = reading.source;
  const Index count =
      source.checked_count(source.text_integer("the number of elements"), "the number of elements", 8);
  source.begin_binary();
  std::vector<std::int64_t> ids;
  std::vector<std::int32_t> types;
  std::vector<Index> nodes;
  Tags tags;
  Alikes alikes;
  ids.reserve(count);
  types.reserve(count);
  while (index_size(ids) < count) {
    // text files give the type and number of tags of each element, binary files once for a run of elements
    Index run = 1;
    Element element{};
    if (!source.binary) element.id = source.int32("the number of an element");
    element.type = &known_type(source, source.int32("an element's type"));
    if (source.binary)
      run = source.checked_count(source.int32("the length of a run"), "the length of a run", 8);
    element.tag_count = reading.metadata.is_version_1() ? 2 : read_tag_count(source);
    if (run > count - index_size(ids)) {
      source.fail(fmt::format("${} has more elements than the {} in its header", section, count),
                  "the count is wrong or the file is damaged");
    }
    for (Index i = 0; i < run; ++i) {
      if (source.binary) element.id = source.int32("the number of an element");
      read_element_body(reading, element, tags, nodes);
      ids.push_back(element.id);
      types.push_back(element.type->number);
    }
    if (source.binary || reading.metadata.is_version_1()) continue;
    const Index alike = alikes.read(reading, element, count - index_size(ids), tags, ids);
    types.insert(types.end(), static_cast<std::size_t>(alike), element.type->number);
  }
  expect_end(reading, section);
  reading.elements = number_ids(source, ids, "element");
  reading.mesh.cell_ids = std::move(ids);
  keep_tags(source, reading.mesh, tags);
  keep_unusual_types(reading.mesh, types);
}

void write_nodes_2(NumberWriter& sink, const WriteContext& output) {
  const Mesh& mesh = output.mesh;
  const std::vector<double>* parameters = parameters_of(mesh);
  sink.text_line(mesh.vertex_count());
  write_rows(sink, mesh.vertex_count(), [&](RowWriter& to, Index v) {
    to.int32(output.node_id(v));
    to.all(mesh.points[v]);
    if (output.node_entities.empty()) return;
    const std::size_t at = 2 * static_cast<std::size_t>(v);
    to.int32(output.node_entities[at]);
    to.int32(output.node_entities[at + 1]);
    for (int k = 0; k < parameters_2(output.node_entities[at]); ++k) to.real((*parameters)[2 * at + 1 + k]);
  });
}

void write_elements_2(NumberWriter& sink, const WriteContext& output) {
  const Mesh& mesh = output.mesh;
  const DataArray* labels = find_array(mesh, kLabel, Association::cells);
  const TagsOfMesh tags(mesh,
                        std::find(output.placed.begin(), output.placed.end(), labels) != output.placed.end());
  const bool version_1 = output.layout.is_version_1();
  sink.text_line(mesh.cell_count());
  const auto tag_count = [&](Index c) { return version_1 ? 2 : tags.count(c); };
  const auto write_row = [&](RowWriter& to, Index c) {
    const std::size_t count = tag_count(c);
    to.int32(output.cell_id(c));
    if (!to.binary) {
      to.int32(output.types[c]->number);
      if (!version_1) to.int32(static_cast<std::int64_t>(count));
    }
    for (std::size_t k = 0; k < count; ++k) to.int32(tags.tag(c, k));
    if (version_1) to.int32(output.types[c]->nodes);
    write_cell_nodes(to, output, c, false);
  };
  if (!sink.binary) return write_rows(sink, mesh.cell_count(), write_row);
  Index end = 0;
  for (Index begin = 0; begin < mesh.cell_count(); begin = end) {
    const auto is_alike = [&](Index c) {
      return output.types[c] == output.types[begin] && tag_count(c) == tag_count(begin);
    };
    while (end < mesh.cell_count() && is_alike(end)) ++end;
    sink.int32(output.types[begin]->number);
    sink.int32(end - begin);
    sink.int32(static_cast<std::int64_t>(tag_count(begin)));
    write_rows(sink, end - begin, [&](RowWriter& to, Index i) { write_row(to, begin + i); });
  }
}

}  // namespace meshorder::gmsh
