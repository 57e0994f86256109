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
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

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

// ---- the whole mesh as an Exodus II file

/// Returns whether the metadata name all sets of the mesh, and the mesh has all sets and arrays that the
/// metadata name.
bool knows_all(const Mesh& mesh, const ExodusMetadata& metadata) {
  const NamedParts parts(mesh);
  const auto has_array = [&](const std::string& name) {
    return parts.array(name, Association::cells) != nullptr;
  };
  std::size_t known = 0;  // number of sets, and of blocks with a name
  for (const BlockRecord& block : metadata.blocks) known += block.in_mesh.empty() ? 0 : 1;
  for (std::size_t kind = 0; kind < metadata.sets.size(); ++kind) {
    for (const SetRecord& record : metadata.sets[kind].sets) {
      if (kind == exodus::kSideSets) {
        if (!record.in_mesh.empty() && !has_array(record.in_mesh)) return false;
      } else if (parts.set(record.in_mesh, exodus::kSetKinds[kind].association) == nullptr) {
        return false;
      } else {
        ++known;
      }
    }
  }
  return known == mesh.sets.size() &&
         std::all_of(metadata.elements.begin(), metadata.elements.end(), [&](const exodus::Series& series) {
           return std::all_of(series.arrays.begin(), series.arrays.end(), has_array);
         });
}

// ---- data that only pieces have

/// Adds a variable: integers along a dimension, or one integer if `dimension` is empty. Adds nothing if there
/// are no values.
void add_integers(ExodusMetadata& metadata, std::string_view name, std::string_view dimension,
                  const std::vector<std::int64_t>& values) {
  if (values.empty()) return;
  std::vector<exodus::Dimension> dimensions;
  if (!dimension.empty()) dimensions.push_back({std::string(dimension), values.size()});
  const auto add = [&](exodus::NcType type, const auto& numbers) {
    std::string bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers[0]));
    metadata.plain.push_back({std::string(name), type, std::move(dimensions), {}, std::move(bytes)});
  };
  // as in the Exodus library: 64 bits only if the numbers need them
  if (!fit_32_bits(values)) return add(exodus::kInt64, values);
  add(exodus::kInt, std::vector<std::int32_t>(values.begin(), values.end()));
}

constexpr std::string_view kFiles = "num_procs_file";

/// Adds communication maps of nodes ("n") or elements ("e"), one for each other part that shares nodes or
/// elements. A map's id is the other part's number.
void add_maps(ExodusMetadata& metadata, const std::string& of,
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
  const std::string count = "num_" + of + "_cmaps";
  const std::string entries = of + "cnt_cmap";
  add_integers(metadata, of + "_comm_ids", count, ids);
  add_integers(metadata, of + "_comm_stat", count, std::vector<std::int64_t>(ids.size(), 1));
  add_integers(metadata, of + "_comm_data_idx", count, ends);
  add_integers(metadata, of + "_comm_" + of + "ids", entries, numbers);
  add_integers(metadata, of + "_comm_proc", entries, parts);
}

/// Returns the counts of members and of distribution factors of each set of nodes, then those of each set of
/// sides.
std::vector<std::int64_t> counts_of_sets(const Mesh& mesh) {
  const ExodusMetadata& metadata = *exodus::own_metadata(mesh);
  Notes ignored;
  exodus::Planning planning{mesh, metadata, ignored};
  exodus::plan_blocks(planning, true);
  const std::vector<std::vector<exodus::SetPlan>> plans = exodus::plan_sets(planning, {});
  std::vector<std::int64_t> counts;
  for (const std::size_t kind : {exodus::kNodeSets, exodus::kSideSets}) {
    for (const SetRecord& record : metadata.sets[kind].sets) {
      const auto plan =
          std::find_if(plans[kind].begin(), plans[kind].end(),
                       [&](const exodus::SetPlan& candidate) { return candidate.record == &record; });
      const bool is_there = plan != plans[kind].end();  // an array without rows in this share is dropped
      counts.push_back(is_there ? std::ssize(plan->members) : 0);
      counts.push_back(is_there ? static_cast<std::int64_t>(plan->factor_count()) : 0);
    }
  }
  return counts;
}

/// Returns the Exodus II side number of a facet of an element.
///
/// @param facet  index in `facets(shape, …)`
/// @param type   element type of the element's block
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

/// The blocks of a mesh that have cells, in the order of the mesh's cells.
struct Blocks {
  std::vector<const BlockRecord*> records;
  std::vector<GlobalIndex> ends;  ///< number of the first cell after each block
};

/// Returns the blocks of a whole mesh; no blocks if the cells are not in blocks of the metadata or not in the
/// order of these blocks.
Blocks blocks_of(const Mesh& mesh) {
  Notes ignored;
  exodus::Planning planning{mesh, *exodus::own_metadata(mesh), ignored};
  exodus::plan_blocks(planning, true);
  Blocks blocks;
  for (const auto& [cells, record, id, name] : planning.blocks) {
    if (cells.count == 0) continue;
    if (record == nullptr || (!blocks.records.empty() && record < blocks.records.back())) return {};
    blocks.records.push_back(record);
    blocks.ends.push_back(cells.first + cells.count);
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
  const std::vector<GlobalIndex>& element_numbers;  ///< number of each cell in the whole file, from 0
  Blocks blocks;                                    ///< blocks of the whole mesh
  std::vector<std::int64_t> set_counts;             ///< sizes of the sets of the whole mesh
  bool has_vertex_ids;
  bool has_cell_ids;
};

/// The parts of a mesh that a rank has, the borders between them and the data that all files have in common.
class NemesisPieces {
 public:
  /// Finds the parts and their borders. Every rank has to call it.
  ///
  /// @param source       the objects to which it refers must outlive this object
  /// @param part_starts  as in `part_of`
  NemesisPieces(const Communicator& communicator, OrderedMesh source,
                const std::vector<GlobalIndex>& part_starts)
      : communicator_(communicator),
        source_(std::move(source)),
        metadata_(*exodus::own_metadata(source_.mesh)),
        parts_(communicator, source_.mesh, source_.numbers, part_starts),
        borders_(facets_between(communicator, source_.mesh, source_.numbers, parts_)),
        cutter_(source_.mesh, parts_) {
    count_whole();
  }

  /// Writes the files of this rank's parts. Every rank has to call it. O(size of the parts · log).
  ///
  /// @return number of vertices of all pieces minus that of the mesh
  /// @throws SharedError if a file cannot be written
  GlobalIndex write(const std::vector<std::string>& paths, const std::vector<std::string>& names) {
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

 private:
  /// Fills in `whole_`.
  void count_whole() {
    const Blocks& blocks = source_.blocks;
    whole_.dimensions = {{"num_processors", static_cast<std::size_t>(parts_.size())},
                         {"num_procs_file", 1},
                         {"num_nodes_global", static_cast<std::size_t>(source_.numbers.layout.size())},
                         {"num_elems_global", static_cast<std::size_t>(blocks.ends.back())}};
    add_integers(whole_, "nem_ftype", "", {0});  // 'p', parallel
    std::vector<std::int64_t> ids;
    std::vector<std::int64_t> counts;
    for (const BlockRecord& block : metadata_.blocks) {
      const auto found = std::find(blocks.records.begin(), blocks.records.end(), &block);
      const auto b = static_cast<std::size_t>(found - blocks.records.begin());
      ids.push_back(block.id);
      counts.push_back(found == blocks.records.end() ? 0
                                                     : blocks.ends[b] - (b == 0 ? 0 : blocks.ends[b - 1]));
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

  void write_piece(Index part, const exodus::UnfinishedFile& file) {
    Mesh piece = cutter_.cut(part);
    // drop the sets of blocks without cells in this part: they would become element sets
    const auto& element_sets = metadata_.sets[exodus::kElementSets].sets;
    std::erase_if(piece.sets, [&](const EntitySet& set) {
      return set.association == Association::cells && set.members.empty() &&
             std::none_of(element_sets.begin(), element_sets.end(),
                          [&](const SetRecord& record) { return record.in_mesh == set.name; });
    });
    if (piece.cell_count() == 0) {
      // drop the block labels of a part without cells: they would become an element variable
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
    Notes ignored;  // the notes on a piece repeat those on the whole mesh
    exodus::write(piece, file, ignored);
  }

  /// Sets the ids of nodes and elements to their numbers in the whole mesh. If the mesh has ids, keeps these
  /// as a map.
  void add_numbers(Index part, Mesh& piece) const {
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

  /// Returns the metadata of a piece: those of the whole mesh, without arrays that have no rows in the piece,
  /// and those that only pieces have.
  [[nodiscard]] ExodusMetadata metadata_of(const Mesh& piece) const {
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
  void add_load_balance(Index part, ExodusMetadata& metadata) const {
    const auto add = [&](const std::string& of, std::size_t count, const auto& is_at_border) {
      std::vector<std::int64_t> internal;
      std::vector<std::int64_t> border;
      for (std::size_t k = 0; k < count; ++k)
        (is_at_border(k) ? border : internal).push_back(static_cast<std::int64_t>(k) + 1);
      add_integers(metadata, fmt::format("int_{}_stat", of[0]), kFiles, {internal.empty() ? 0 : 1});
      add_integers(metadata, fmt::format("bor_{}_stat", of[0]), kFiles, {border.empty() ? 0 : 1});
      add_integers(metadata, of + "_mapi", "num_int_" + of, internal);
      add_integers(metadata, of + "_mapb", "num_bor_" + of, border);
    };
    const auto vertices = parts_.vertices(part);
    add("node", vertices.size(), [&](std::size_t k) { return parts_.parts_with(vertices[k]).size() > 1; });
    add_integers(metadata, "ext_n_stat", kFiles, {0});
    const auto cells = parts_.cells(part);
    std::set<Index> at_border;
    for (const BorderFacet& facet : borders_[part]) at_border.insert(facet.cell);
    add("elem", cells.size(), [&](std::size_t k) { return at_border.contains(cells[k]); });
  }

  /// Adds the communication maps of nodes, one for each part that shares nodes with this part. A map lists
  /// positions of nodes in the piece, sorted by the nodes' numbers in the whole mesh, so that the maps of
  /// both parts match.
  void add_node_maps(Index part, ExodusMetadata& metadata) const {
    const auto vertices = parts_.vertices(part);
    std::vector<Index> ascending = index_range(0, index_size(vertices));
    std::sort(ascending.begin(), ascending.end(),
              [&](Index a, Index b) { return vertices[a] < vertices[b]; });
    std::map<Index, std::vector<std::int64_t>> maps;
    for (const Index k : ascending) {
      for (const Index other : parts_.parts_with(vertices[k])) {
        if (other != part) maps[other].push_back(std::int64_t{k} + 1);
      }
    }
    add_maps(metadata, "n", maps);
  }

  /// Adds the communication maps of elements, one for each part that shares an element side with this part.
  void add_element_maps(Index part, ExodusMetadata& metadata) const {
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
    add_maps(metadata, "e", maps);
    add_integers(metadata, "e_comm_sids", "ecnt_cmap", sides);
  }

  const Communicator& communicator_;
  OrderedMesh source_;
  const exodus::ExodusMetadata& metadata_;
  MeshParts parts_;
  std::vector<std::vector<BorderFacet>> borders_;
  PartCutter cutter_;
  exodus::ExodusMetadata whole_;  ///< data on the whole mesh, the same in all pieces
};

/// A mesh in the form of an Exodus II file, and the indices of its cells in the given mesh.
struct Held {
  Mesh mesh;
  std::vector<GlobalIndex> given_cells;
};

/// Writes a mesh to memory as an Exodus II file, and reads this file.
Held held(const Mesh& mesh, Notes& notes) {
  TextStore store;
  std::vector<GlobalIndex> given_cells;
  {
    Mesh arranged = mesh;
    arranged.format.clear();  // its cells may be arranged for another format
    const Permutation places = arrange_cells(arranged, format_named("exodus"))
                                   .value_or(Permutation::identity(arranged.cell_count()));
    given_cells.assign(places.new_to_old().begin(), places.new_to_old().end());
    exodus::write(arranged, FilePath("the pieces", store), notes);
  }
  Notes ignored;
  return {exodus::read(FilePath("the pieces", store), ignored), std::move(given_cells)};
}

}  // namespace

GlobalIndex write_nemesis_pieces(const Mesh& mesh, const std::vector<GlobalIndex>& part_starts,
                                 const std::vector<std::string>& paths, const std::vector<std::string>& names,
                                 Notes& notes) {
  const ShareNumbers numbers = ShareNumbers::of_whole(mesh);
  const ExodusMetadata* const own = exodus::own_metadata(mesh);
  std::optional<Held> other;  // set if the mesh is not in the form of an Exodus II file
  if (own == nullptr || blocks_of(mesh).records.empty() || !knows_all(mesh, *own)) other = held(mesh, notes);
  const Mesh& source = other ? other->mesh : mesh;
  Blocks blocks = blocks_of(source);
  if (blocks.records.empty())
    throw TooLarge("pieces of Exodus II have up to 10,000 blocks of elements; give a folder for .vtu pieces");
  const Communicator alone(MPI_COMM_SELF);
  NemesisPieces pieces(alone,
                       {source, numbers, other ? other->given_cells : numbers.cells, std::move(blocks),
                        counts_of_sets(source), !source.vertex_ids.empty(), !source.cell_ids.empty()},
                       part_starts);
  return pieces.write(paths, names);
}

GlobalIndex write_nemesis_pieces(const Communicator& communicator, MovedPart moved,
                                 const std::vector<GlobalIndex>& block_ends,
                                 const std::vector<GlobalIndex>& part_starts,
                                 const std::vector<std::string>& paths,
                                 const std::vector<std::string>& names) {
  std::vector<std::int64_t> counts = communicator.together([&] { return counts_of_sets(moved.part().mesh); });
  const auto take_share = [&] {
    const MovedPart freed = std::move(moved);
    return share_of(communicator, freed, part_starts);
  };
  const auto& [mesh, numbers, has_vertex_ids, has_cell_ids] = take_share();
  NemesisPieces pieces(communicator,
                       {mesh, numbers, numbers.cells, blocks_of(*exodus::own_metadata(mesh), block_ends),
                        communicator.sums(std::move(counts)), has_vertex_ids, has_cell_ids},
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

GlobalIndex write_nemesis_pieces(const Communicator& /*communicator*/, MovedPart /*moved*/,
                                 const std::vector<GlobalIndex>& /*block_ends*/,
                                 const std::vector<GlobalIndex>& /*part_starts*/,
                                 const std::vector<std::string>& /*paths*/,
                                 const std::vector<std::string>& /*names*/) {
  throw Unavailable("pieces of Exodus II need netCDF, which this build of meshorder lacks");
}

bool is_own_nemesis_piece(const std::filesystem::path& /*path*/) { return false; }
#endif

}  // namespace meshorder::distributed
