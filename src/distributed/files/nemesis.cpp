// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/nemesis.hpp"

#include "base/index.hpp"
#include "base/text.hpp"
#include "distributed/files/mesh_parts.hpp"
#include "distributed/files/part_borders.hpp"
#include "distributed/files/piece_contents.hpp"
#include "distributed/files/text_store.hpp"
#include "io/exodus/exodus.hpp"
#include "io/exodus/writing.hpp"
#include "io/format.hpp"
#include "io/named_parts.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

namespace meshorder::distributed {

std::string nemesis_name(const std::string& name, Index parts, Index part) {
  return fmt::format("{}.{}.{:0{}}", name, parts, part, std::to_string(parts).size());
}

#ifdef MESHORDER_HAS_NETCDF
namespace {

using exodus::BlockRecord;
using exodus::ExodusMetadata;
using exodus::SetRecord;

/// Attribute by which a later run recognises the files.
constexpr std::string_view kMark = "pieces_written_by";
constexpr std::string_view kMaker = "meshorder";

const ExodusMetadata* exodus_metadata(const Mesh& mesh) {
  return dynamic_cast<const ExodusMetadata*>(mesh.format_metadata.get());
}

// ---- the whole mesh as an Exodus II file

/// Returns whether the metadata name all sets of the mesh, and the mesh has all sets and arrays that they
/// name.
bool knows_all(const Mesh& mesh, const ExodusMetadata& metadata) {
  const NamedParts parts(mesh);
  const auto has_set = [&](const SetRecord& record, Association association) {
    return parts.set(record.in_mesh, association) != nullptr;
  };
  const auto has_array = [&](const std::string& name) {
    return parts.array(name, Association::cells) != nullptr;
  };
  std::size_t known = 0;  // sets, and blocks with a name
  for (const BlockRecord& block : metadata.blocks) known += block.in_mesh.empty() ? 0 : 1;
  for (std::size_t kind = 0; kind < metadata.sets.size(); ++kind) {
    const Association association = exodus::kSetKinds[kind].association;
    for (const SetRecord& record : metadata.sets[kind].sets) {
      const bool is_there = kind != exodus::kSideSets ? has_set(record, association)
                                                      : record.in_mesh.empty() || has_array(record.in_mesh);
      if (!is_there) return false;
      known += kind != exodus::kSideSets ? 1 : 0;
    }
  }
  return known == mesh.sets.size() &&
         std::all_of(metadata.elements.begin(), metadata.elements.end(), [&](const exodus::Series& series) {
           return std::all_of(series.arrays.begin(), series.arrays.end(), has_array);
         });
}

// ---- data that only pieces have

/// Returns the bytes of numbers converted to a type.
template <class Number>
std::string bytes_of_numbers(const std::vector<std::int64_t>& values) {
  std::string bytes;
  for (const std::int64_t value : values) {
    const auto number = static_cast<Number>(value);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }
  return bytes;
}

/// Adds a dimension unless its length is 0: netCDF would make that an unlimited dimension.
void add_dimension(ExodusMetadata& metadata, std::string_view name, std::size_t length) {
  if (length > 0) metadata.dimensions.push_back({std::string(name), length});
}

/// Adds integers along a dimension, or one integer if `dimension` is empty; nothing without values.
void add_integers(ExodusMetadata& metadata, std::string_view name, std::string_view dimension,
                  const std::vector<std::int64_t>& values) {
  if (values.empty()) return;
  std::vector<exodus::Dimension> dimensions;
  if (!dimension.empty()) dimensions.push_back({std::string(dimension), values.size()});
  // as in the Exodus library: 64 bits only if the numbers need them
  const bool fit = fit_32_bits(values);
  metadata.plain.push_back(
      {std::string(name),
       fit ? exodus::kInt : exodus::kInt64,
       std::move(dimensions),
       {},
       fit ? bytes_of_numbers<std::int32_t>(values) : bytes_of_numbers<std::int64_t>(values)});
}

constexpr std::string_view kFiles = "num_procs_file";

std::vector<std::int64_t> status_of(std::size_t count) { return {count > 0 ? 1 : 0}; }

/// Names of the variables and dimensions that list the nodes, or the elements, inside a part and at its
/// border.
struct Names {
  std::string_view internal_status;
  std::string_view border_status;
  std::string_view internal;
  std::string_view internal_count;
  std::string_view border;
  std::string_view border_count;
};

/// Names of variables and dimensions of communication maps.
struct MapNames {
  std::string kind;  ///< "n" or "e", the first letter of the other variables' names
  std::string_view maps;
  std::string_view entries;
  std::string_view numbers;
};

/// Adds communication maps, one for each other part. A map's id is the number of that part.
void add_maps(ExodusMetadata& metadata, const MapNames& names,
              const std::map<Index, std::vector<std::int64_t>>& maps) {
  std::vector<std::int64_t> ids;
  std::vector<std::int64_t> ends;
  std::vector<std::int64_t> numbers;
  std::vector<std::int64_t> parts;
  for (const auto& [other, entries] : maps) {
    ids.push_back(other);
    numbers.insert(numbers.end(), entries.begin(), entries.end());
    parts.resize(numbers.size(), other);
    ends.push_back(std::ssize(numbers));
  }
  add_integers(metadata, names.kind + "_comm_ids", names.maps, ids);
  add_integers(metadata, names.kind + "_comm_stat", names.maps, std::vector<std::int64_t>(ids.size(), 1));
  add_integers(metadata, names.kind + "_comm_data_idx", names.maps, ends);
  add_integers(metadata, names.numbers, names.entries, numbers);
  add_integers(metadata, names.kind + "_comm_proc", names.entries, parts);
}

/// Returns the number of distribution factors of a set of nodes.
std::int64_t factors_of_nodes(const Mesh& mesh, const SetRecord& record) {
  const DataArray* const factors = find_array(
      mesh,
      exodus::title(exodus::kSetKinds[exodus::kNodeSets], record.in_mesh) + std::string(exodus::kFactors),
      Association::vertices);
  return factors == nullptr ? 0 : row_count(*factors);
}

/// Numbers of sides and of distribution factors of a set of sides.
struct SideCounts {
  std::int64_t sides = 0;
  std::int64_t factors = 0;
};

SideCounts counts_of_sides(const Mesh& mesh, const SetRecord& record, const exodus::SideNodes& nodes) {
  SideCounts counts;
  const DataArray* const array =
      record.in_mesh.empty() ? nullptr : find_array(mesh, record.in_mesh, Association::cells);
  if (array == nullptr) return counts;
  const bool has_factors =
      find_array(mesh, record.in_mesh + std::string(exodus::kFactors), Association::cells) != nullptr;
  const std::vector<std::int64_t> masks = exodus::whole_values(array->values);
  for (Index row = 0; row < index_size(masks); ++row) {
    const Index cell = array->is_dense() ? row : array->indices[row];
    for (int side = 1; side <= exodus::kMostSides; ++side) {
      if ((masks[row] >> (side - 1) & 1) == 0) continue;
      ++counts.sides;
      if (has_factors)
        counts.factors += record.factors_by_nodes ? nodes.count(cell, side) : record.factor_width;
    }
  }
  return counts;
}

/// Returns the counts of members and of distribution factors of each set of nodes, then those of each set of
/// sides.
std::vector<std::int64_t> counts_of_sets(const Mesh& mesh, const ExodusMetadata& metadata) {
  std::vector<std::int64_t> counts;
  const exodus::SideNodes nodes(mesh, metadata);
  const NamedParts parts(mesh);
  for (const SetRecord& record : metadata.sets[exodus::kNodeSets].sets) {
    counts.push_back(std::ssize(parts.set(record.in_mesh, Association::vertices)->members));
    counts.push_back(factors_of_nodes(mesh, record));
  }
  for (const SetRecord& record : metadata.sets[exodus::kSideSets].sets) {
    const SideCounts of_set = counts_of_sides(mesh, record, nodes);
    counts.push_back(of_set.sides);
    counts.push_back(of_set.factors);
  }
  return counts;
}

/// Returns the Exodus II side number of a facet of an element.
///
/// @param facet  place in `facets(shape, …)`
/// @param type   of its block
int side_of_facet(Shape shape, int facet, int coordinates, std::string_view type) {
  constexpr std::array<int, 5> kPyramid{5, 1, 2, 3, 4};
  constexpr std::array<int, 5> kWedge{4, 5, 1, 2, 3};
  constexpr std::array<int, 6> kHexahedron{4, 2, 1, 3, 5, 6};
  const auto k = static_cast<std::size_t>(facet);
  switch (shape) {
    case Shape::pyramid:
      return kPyramid[k];
    case Shape::wedge:
      return kWedge[k];
    case Shape::hexahedron:
      return kHexahedron[k];
    default:
      return exodus::faces_of(shape, type, coordinates) + facet + 1;
  }
}

/// The blocks of a mesh that have cells, in the order of the cells.
struct Blocks {
  std::vector<const BlockRecord*> records;
  std::vector<GlobalIndex> ends;  ///< number of the first cell after each
};

/// Returns the blocks of a whole mesh; no blocks if the cells are not in blocks of the metadata or not in the
/// order of these blocks.
Blocks blocks_of(const Mesh& mesh, const ExodusMetadata& metadata) {
  Blocks blocks;
  const CellDivision division = exodus::divide(mesh);
  const BlockRecord* next = metadata.blocks.data();
  const BlockRecord* const end = next + metadata.blocks.size();
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const Index key = division.key_of_cell[c];
    if (c > 0 && key == division.key_of_cell[c - 1]) {
      ++blocks.ends.back();
      continue;
    }
    const CellPart& cells = division.keys[key];
    next = std::find_if(next, end, [&](const BlockRecord& block) {
      return std::tuple(block.label, block.shape, block.nodes) ==
             std::tuple(cells.label, cells.shape, cells.nodes);
    });
    if (next == end) return {};
    blocks.records.push_back(next++);
    blocks.ends.push_back(c + 1);
  }
  return blocks;
}

/// Returns the blocks of a file that have cells.
Blocks blocks_of(const ExodusMetadata& metadata, const std::vector<GlobalIndex>& ends) {
  Blocks blocks;
  for (std::size_t b = 0; b < metadata.blocks.size(); ++b) {
    if (ends[b + 1] == ends[b]) continue;
    blocks.records.push_back(&metadata.blocks[b]);
    blocks.ends.push_back(ends[b + 1]);
  }
  return blocks;
}

/// A rank's share of an Exodus II mesh in its new order.
struct OrderedMesh {
  const Mesh& mesh;  ///< has Exodus II metadata
  const ShareNumbers& numbers;
  const std::vector<GlobalIndex>& element_numbers;  ///< of the cells in the whole mesh's file, from 0 on
  Blocks blocks;                                    ///< of the whole mesh
  std::vector<std::int64_t> set_counts;             ///< of the whole mesh
  bool has_vertex_ids;
  bool has_cell_ids;
};

/// The parts of a mesh that a rank has, the borders between them and the data that all files have in common.
class NemesisPieces {
 public:
  /// Finds the parts and their borders. Every rank has to call it.
  ///
  /// @param source       its referents must outlive this object
  /// @param part_starts  as in `part_of`
  NemesisPieces(const Communicator& communicator, OrderedMesh source,
                const std::vector<GlobalIndex>& part_starts);

  /// Writes the files of this rank's parts. Every rank has to call it. O(size of the parts · log).
  ///
  /// @return number of vertices of all pieces minus that of the mesh
  /// @throws SharedError if a file cannot be written
  GlobalIndex write(const std::vector<std::string>& paths, const std::vector<std::string>& names);

 private:
  void count_whole();
  void write_piece(Index part, const exodus::UnfinishedFile& file);
  [[nodiscard]] exodus::ExodusMetadata metadata_of(const Mesh& piece) const;
  void add_numbers(Index part, Mesh& piece) const;
  void add_load_balance(Index part, exodus::ExodusMetadata& metadata) const;
  void add_node_maps(Index part, exodus::ExodusMetadata& metadata) const;
  void add_element_maps(Index part, exodus::ExodusMetadata& metadata) const;

  const Communicator& communicator_;
  OrderedMesh source_;
  const exodus::ExodusMetadata& metadata_;
  MeshParts parts_;
  std::vector<std::vector<BorderFacet>> borders_;
  PartCutter cutter_;
  exodus::ExodusMetadata whole_;  ///< data on the whole mesh, the same in all pieces
};

NemesisPieces::NemesisPieces(const Communicator& communicator, OrderedMesh source,
                             const std::vector<GlobalIndex>& part_starts)
    : communicator_(communicator),
      source_(std::move(source)),
      metadata_(*exodus_metadata(source_.mesh)),
      parts_(communicator, source_.mesh, source_.numbers, part_starts),
      borders_(facets_between(communicator, source_.mesh, source_.numbers, parts_)),
      cutter_(source_.mesh, parts_) {
  count_whole();
}

/// Fills in `whole_`.
void NemesisPieces::count_whole() {
  whole_.dimensions = {{"num_processors", static_cast<std::size_t>(parts_.size())}, {"num_procs_file", 1}};
  const Blocks& blocks = source_.blocks;
  add_dimension(whole_, "num_nodes_global", static_cast<std::size_t>(source_.numbers.layout.size()));
  add_dimension(whole_, "num_elems_global", static_cast<std::size_t>(blocks.ends.back()));
  add_integers(whole_, "nem_ftype", "", {0});  // 'p', parallel
  std::vector<std::int64_t> ids;
  std::vector<std::int64_t> counts;
  for (const BlockRecord& block : metadata_.blocks) {
    const auto found = std::find(blocks.records.begin(), blocks.records.end(), &block);
    const auto b = static_cast<std::size_t>(found - blocks.records.begin());
    ids.push_back(block.id);
    counts.push_back(found == blocks.records.end() ? 0 : blocks.ends[b] - (b == 0 ? 0 : blocks.ends[b - 1]));
  }
  add_integers(whole_, "el_blk_ids_global", "num_el_blk_global", ids);
  add_integers(whole_, "el_blk_cnt_global", "num_el_blk_global", counts);
  auto count = source_.set_counts.begin();
  const auto add_sets = [&](std::size_t kind, const std::string& prefix, const std::string& members) {
    std::vector<std::int64_t> factors;
    ids.clear();
    counts.clear();
    for (const SetRecord& record : metadata_.sets[kind].sets) {
      ids.push_back(record.id);
      counts.push_back(*count++);
      factors.push_back(*count++);
    }
    const std::string dimension = "num_" + prefix + "_global";
    add_integers(whole_, prefix + "_ids_global", dimension, ids);
    add_integers(whole_, prefix + "_" + members + "_cnt_global", dimension, counts);
    add_integers(whole_, prefix + "_df_cnt_global", dimension, factors);
  };
  add_sets(exodus::kNodeSets, "ns", "node");
  add_sets(exodus::kSideSets, "ss", "side");
}

GlobalIndex NemesisPieces::write(const std::vector<std::string>& paths,
                                 const std::vector<std::string>& names) {
  const Layout ranks = ranks_of_parts(parts_.size(), communicator_.size());
  const int rank = communicator_.rank();
  const GlobalIndex vertices = communicator_.together([&] {
    GlobalIndex count = 0;
    for (GlobalIndex p = ranks.begin(rank); p < ranks.end(rank); ++p) {
      const auto place = static_cast<std::size_t>(p);
      write_piece(static_cast<Index>(p), {paths[place], names[place]});
      count += std::ssize(parts_.vertices(static_cast<Index>(p)));
    }
    return count;
  });
  return communicator_.sum(vertices) - source_.numbers.layout.size();
}

void NemesisPieces::write_piece(Index part, const exodus::UnfinishedFile& file) {
  Mesh piece = cutter_.cut(part);
  // drop the sets of blocks without cells in this part: they would become element sets
  const auto& element_sets = metadata_.sets[exodus::kElementSets].sets;
  std::erase_if(piece.sets, [&](const EntitySet& set) {
    return set.association == Association::cells && set.members.empty() &&
           std::none_of(element_sets.begin(), element_sets.end(),
                        [&](const SetRecord& record) { return record.in_mesh == set.name; });
  });
  if (piece.cell_count() == 0) {
    // drop the block labels of a part without cells: they would become a variable
    std::erase_if(piece.data, [](const DataArray& array) {
      return array.association == Association::cells && array.name == kLabel;
    });
  }
  add_numbers(part, piece);
  ExodusMetadata metadata = metadata_of(piece);
  add_load_balance(part, metadata);
  add_node_maps(part, metadata);
  add_element_maps(part, metadata);
  piece.format_metadata = std::make_shared<const ExodusMetadata>(std::move(metadata));
  Notes ignored;  // they repeat the notes on the whole mesh
  exodus::write(piece, file, ignored);
}

/// Sets the ids of nodes and elements to their numbers in the whole mesh. If the mesh has ids, keeps these as
/// a map.
void NemesisPieces::add_numbers(Index part, Mesh& piece) const {
  const auto number = [&](Association association, bool has_ids, std::vector<std::int64_t>& ids,
                          std::span<const Index> own, const std::vector<GlobalIndex>& numbers) {
    if (has_ids) {
      piece.data.push_back({.name = std::string(exodus::kMap) + "ids of the whole",
                            .association = association,
                            .values = std::exchange(ids, {})});
    }
    for (const Index k : own) ids.push_back(numbers[static_cast<std::size_t>(k)] + 1);
  };
  number(Association::vertices, source_.has_vertex_ids, piece.vertex_ids, parts_.vertices(part),
         source_.numbers.vertices);
  number(Association::cells, source_.has_cell_ids, piece.cell_ids, parts_.cells(part),
         source_.element_numbers);
}

/// Returns the metadata of a piece: those of the whole mesh, without the arrays that have no rows in it.
ExodusMetadata NemesisPieces::metadata_of(const Mesh& piece) const {
  ExodusMetadata metadata = metadata_;
  const auto has = [&](const std::string& array) {
    return find_array(piece, array, Association::cells) != nullptr;
  };
  for (exodus::Series& series : metadata.elements) {
    if (series.arrays.empty() || std::any_of(series.arrays.begin(), series.arrays.end(), has)) continue;
    series.arrays.clear();  // the name stays
    series.present.assign(series.present.size(), false);
  }
  for (SetRecord& record : metadata.sets[exodus::kSideSets].sets) {
    if (!record.in_mesh.empty() && !has(record.in_mesh)) record.in_mesh.clear();
  }
  metadata.attributes.push_back(exodus::number_attribute("nemesis_file_version", exodus::kFloat, 2.6F));
  metadata.attributes.push_back(exodus::number_attribute("nemesis_api_version", exodus::kFloat, 7.14F));
  metadata.attributes.push_back(exodus::text_attribute(std::string(kMark), std::string(kMaker)));
  metadata.dimensions.insert(metadata.dimensions.end(), whole_.dimensions.begin(), whole_.dimensions.end());
  metadata.plain.insert(metadata.plain.end(), whole_.plain.begin(), whole_.plain.end());
  return metadata;
}

/// Adds the lists of nodes and elements inside the part and at its border.
void NemesisPieces::add_load_balance(Index part, ExodusMetadata& metadata) const {
  const auto add = [&](std::size_t count, const auto& is_at_border, const Names& names) {
    std::vector<std::int64_t> internal;
    std::vector<std::int64_t> border;
    for (std::size_t k = 0; k < count; ++k)
      (is_at_border(k) ? border : internal).push_back(static_cast<std::int64_t>(k) + 1);
    add_integers(metadata, names.internal_status, kFiles, status_of(internal.size()));
    add_integers(metadata, names.border_status, kFiles, status_of(border.size()));
    add_integers(metadata, names.internal, names.internal_count, internal);
    add_integers(metadata, names.border, names.border_count, border);
  };
  const auto vertices = parts_.vertices(part);
  add(vertices.size(), [&](std::size_t k) { return parts_.parts_with(vertices[k]).size() > 1; },
      {"int_n_stat", "bor_n_stat", "node_mapi", "num_int_node", "node_mapb", "num_bor_node"});
  add_integers(metadata, "ext_n_stat", kFiles, status_of(0));
  const auto cells = parts_.cells(part);
  std::set<Index> at_border;
  for (const BorderFacet& facet : borders_[part]) at_border.insert(facet.cell);
  add(cells.size(), [&](std::size_t k) { return at_border.contains(cells[k]); },
      {"int_e_stat", "bor_e_stat", "elem_mapi", "num_int_elem", "elem_mapb", "num_bor_elem"});
}

/// Adds the communication maps of nodes, one for each part that shares nodes with this one. A map lists
/// places of nodes in the piece, sorted by the nodes' numbers in the whole mesh, so that the maps of both
/// parts match.
void NemesisPieces::add_node_maps(Index part, ExodusMetadata& metadata) const {
  const auto vertices = parts_.vertices(part);
  std::vector<Index> ascending = index_range(0, index_size(vertices));
  std::sort(ascending.begin(), ascending.end(), [&](Index a, Index b) { return vertices[a] < vertices[b]; });
  std::map<Index, std::vector<std::int64_t>> maps;
  for (const Index k : ascending) {
    for (const Index other : parts_.parts_with(vertices[k])) {
      if (other != part) maps[other].push_back(std::int64_t{k} + 1);
    }
  }
  add_maps(metadata, {"n", "num_n_cmaps", "ncnt_cmap", "n_comm_nids"}, maps);
}

/// Adds the communication maps of elements, one for each part that shares a side with elements of this one.
void NemesisPieces::add_element_maps(Index part, ExodusMetadata& metadata) const {
  const auto cells = parts_.cells(part);
  std::map<Index, std::vector<std::int64_t>> maps;
  std::vector<std::int64_t> sides;
  for (const BorderFacet& facet : borders_[part]) {
    const auto place = std::lower_bound(cells.begin(), cells.end(), facet.cell) - cells.begin();
    maps[facet.part].push_back(place + 1);
    const Blocks& blocks = source_.blocks;
    const GlobalIndex number = source_.numbers.cells[static_cast<std::size_t>(facet.cell)];
    const auto block = std::upper_bound(blocks.ends.begin(), blocks.ends.end(), number);
    const BlockRecord& record = *blocks.records[static_cast<std::size_t>(block - blocks.ends.begin())];
    sides.push_back(side_of_facet(record.shape, facet.facet, metadata_.coordinates, record.type));
  }
  add_maps(metadata, {"e", "num_e_cmaps", "ecnt_cmap", "e_comm_eids"}, maps);
  add_integers(metadata, "e_comm_sids", "ecnt_cmap", sides);
}

/// A mesh in the form of an Exodus II file, and the places of its cells in the given mesh.
struct Held {
  Mesh mesh;
  std::vector<GlobalIndex> given_cells;
};

/// Writes a mesh to memory, and reads it from there.
Held held(const Mesh& mesh, Notes& notes) {
  TextStore store;
  std::vector<GlobalIndex> given_cells;
  {
    Mesh arranged = mesh;
    arranged.format.clear();  // its cells may be in the order of another file
    const Permutation places = arrange_cells(arranged, format_named("exodus"))
                                   .value_or(Permutation::identity(arranged.cell_count()));
    given_cells.assign(places.new_to_old().begin(), places.new_to_old().end());
    exodus::write(arranged, FilePath("the pieces", store), notes);
  }
  Notes ignored;
  return {exodus::read(FilePath("the pieces", store), ignored), std::move(given_cells)};
}

/// Writes the pieces of a mesh in the form of an Exodus II file.
///
/// @param element_numbers  of its cells in the whole mesh's file
GlobalIndex write_held(const Mesh& mesh, const ShareNumbers& numbers,
                       const std::vector<GlobalIndex>& element_numbers,
                       const std::vector<GlobalIndex>& part_starts, const std::vector<std::string>& paths,
                       const std::vector<std::string>& names) {
  const ExodusMetadata& metadata = *exodus_metadata(mesh);
  Blocks blocks = blocks_of(mesh, metadata);
  if (blocks.records.empty())
    throw TooLarge("pieces of Exodus II have up to 10,000 blocks of elements; give a folder for .vtu pieces");
  const Communicator alone(MPI_COMM_SELF);
  NemesisPieces pieces(alone,
                       {mesh, numbers, element_numbers, std::move(blocks), counts_of_sets(mesh, metadata),
                        !mesh.vertex_ids.empty(), !mesh.cell_ids.empty()},
                       part_starts);
  return pieces.write(paths, names);
}

}  // namespace

GlobalIndex write_nemesis_pieces(const Mesh& mesh, const std::vector<GlobalIndex>& part_starts,
                                 const std::vector<std::string>& paths, const std::vector<std::string>& names,
                                 Notes& notes) {
  const ShareNumbers numbers = ShareNumbers::of_whole(mesh);
  const ExodusMetadata* const own = exodus_metadata(mesh);
  if (own != nullptr && !blocks_of(mesh, *own).records.empty() && knows_all(mesh, *own))
    return write_held(mesh, numbers, numbers.cells, part_starts, paths, names);
  const Held as_held = held(mesh, notes);
  return write_held(as_held.mesh, numbers, as_held.given_cells, part_starts, paths, names);
}

NemesisShare nemesis_share(const Communicator& communicator, const MovedPart& moved,
                           const std::vector<GlobalIndex>& block_ends,
                           const std::vector<GlobalIndex>& part_starts) {
  const Mesh& part = moved.part().mesh;
  std::vector<std::int64_t> counts =
      communicator.together([&] { return counts_of_sets(part, *exodus_metadata(part)); });
  return {share_of(communicator, moved, part_starts), block_ends, communicator.sums(std::move(counts))};
}

GlobalIndex write_nemesis_pieces(const Communicator& communicator, const NemesisShare& share,
                                 const std::vector<GlobalIndex>& part_starts,
                                 const std::vector<std::string>& paths,
                                 const std::vector<std::string>& names) {
  const auto& [mesh, numbers, has_vertex_ids, has_cell_ids] = share.share;
  NemesisPieces pieces(communicator,
                       {mesh, numbers, numbers.cells, blocks_of(*exodus_metadata(mesh), share.block_ends),
                        share.set_counts, has_vertex_ids, has_cell_ids},
                       part_starts);
  return pieces.write(paths, names);
}

bool is_own_nemesis_piece(const std::filesystem::path& path) {
  try {
    const exodus::NcInput file(path);
    std::vector<std::string> lost;
    const std::vector<exodus::Attribute> attributes = file.attributes(nullptr, lost);
    return file.find("nem_ftype") != nullptr &&
           std::any_of(attributes.begin(), attributes.end(), [](const exodus::Attribute& attribute) {
             return attribute.name == kMark && attribute.bytes == kMaker;
           });
  } catch (const Error&) {
    return false;
  }
}

#else
GlobalIndex write_nemesis_pieces(const Mesh& /*mesh*/, const std::vector<GlobalIndex>& /*part_starts*/,
                                 const std::vector<std::string>& /*paths*/,
                                 const std::vector<std::string>& /*names*/, Notes& /*notes*/) {
  throw Unavailable("pieces of Exodus II need netCDF, which this build of meshorder lacks");
}

NemesisShare nemesis_share(const Communicator& /*communicator*/, const MovedPart& /*moved*/,
                           const std::vector<GlobalIndex>& /*block_ends*/,
                           const std::vector<GlobalIndex>& /*part_starts*/) {
  return {};
}

GlobalIndex write_nemesis_pieces(const Communicator& /*communicator*/, const NemesisShare& /*share*/,
                                 const std::vector<GlobalIndex>& /*part_starts*/,
                                 const std::vector<std::string>& /*paths*/,
                                 const std::vector<std::string>& /*names*/) {
  throw Unavailable("pieces of Exodus II need netCDF, which this build of meshorder lacks");
}

bool is_own_nemesis_piece(const std::filesystem::path& /*path*/) { return false; }
#endif

}  // namespace meshorder::distributed
