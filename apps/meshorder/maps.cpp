// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "maps.hpp"

#include "base/checksum.hpp"
#include "base/index.hpp"
#include "io/kept_cells.hpp"
#include "io/npy.hpp"
#include "mesh/stored_matrix.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace {

std::string identity_path(const std::string& prefix) { return prefix + ".maps.json"; }
std::string kept_path(const std::string& prefix) { return prefix + ".cells.kept.npy"; }

/// Writes numbers as a file of the set. If `numbers` is empty, the set instead removes the file that an
/// earlier run may have left.
template <class Number>
void write_or_remove(const std::vector<Number>& numbers, const std::string& path, OutputSet& files,
                     std::vector<std::string>& written) {
  if (numbers.empty()) {
    files.remove(FilePath::derived(path));
  } else {
    write_npy(numbers, {FilePath::derived(written.emplace_back(path)), files});
  }
}

void write_map(const Permutation& map, const std::vector<std::int64_t>& ids, const std::string& prefix,
               const std::string& what, OutputSet& files, std::vector<std::string>& written) {
  const MapPaths paths = map_paths(prefix, what);
  write_npy(map.old_to_new(), {FilePath::derived(written.emplace_back(paths.old_to_new)), files});
  write_npy(map.new_to_old(), {FilePath::derived(written.emplace_back(paths.new_to_old)), files});
  write_or_remove(ids, paths.ids, files, written);
}

std::vector<std::int64_t> read_ids(const std::string& path, Index count) {
  if (!std::filesystem::exists(path)) return {};
  std::vector<std::int64_t> ids = read_npy(FilePath::derived(path));
  if (index_size(ids) != count) {
    throw InputError(path, "has " + std::to_string(ids.size()) + " numbers for " + std::to_string(count),
                     "give the maps that were written with this mesh");
  }
  return ids;
}

Maps read_permutations(const std::string& prefix, const Mesh& mesh) {
  const MapPaths vertices = map_paths(prefix, "vertices");
  const MapPaths cells = map_paths(prefix, "cells");
  Maps maps;
  maps.vertices = read_permutation(FilePath::derived(vertices.old_to_new), mesh.vertex_count(), "vertices");
  maps.cells = read_permutation(FilePath::derived(cells.old_to_new), mesh.cell_count(), "cells");
  maps.vertex_ids = read_ids(vertices.ids, mesh.vertex_count());
  maps.cell_ids = read_ids(cells.ids, mesh.cell_count());
  return maps;
}

/// Throws Error if a file of the maps is named instead of their prefix.
void require_prefix(const std::string& prefix) {
  for (const char* const what : {".vertices.", ".cells.", ".maps.json"}) {
    const std::size_t at = prefix.rfind(what);
    const bool is_file =
        at != std::string::npos && (prefix.ends_with(".npy") || prefix.ends_with(".maps.json"));
    if (is_file)
      throw InputError(prefix, "is one file of the maps", "give their prefix, " + prefix.substr(0, at));
  }
}

std::string digits_of(std::uint64_t checksum) { return fmt::format("{:016x}", checksum); }

nlohmann::ordered_json checksums_json(const MeshChecksums& checksums) {
  return {{"points", digits_of(checksums.points)}, {"cells", digits_of(checksums.cells)}};
}

std::uint64_t checksum_from(const nlohmann::json& json) {
  const std::string digits = json.get<std::string>();
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc() || end != digits.data() + digits.size()) throw std::invalid_argument(digits);
  return value;
}

std::uint64_t checksum_of(const auto& numbers) {
  Checksum checksum;
  checksum.add_all(numbers);
  return checksum.value();
}

MapChecksums checksums_of_maps(const Maps& maps) {
  return {checksum_of(maps.vertices.old_to_new()), checksum_of(maps.cells.old_to_new()),
          checksum_of(maps.vertex_ids), checksum_of(maps.cell_ids), checksum_of(maps.kept)};
}

/// The names of the maps' checksums in PREFIX.maps.json.
constexpr std::array<std::pair<const char*, std::uint64_t MapChecksums::*>, 5> kOfMaps{
    {{"vertices", &MapChecksums::vertices},
     {"cells", &MapChecksums::cells},
     {"vertex_ids", &MapChecksums::vertex_ids},
     {"cell_ids", &MapChecksums::cell_ids},
     {"kept", &MapChecksums::kept}}};

/// Content of PREFIX.maps.json: checksums of the mesh in both orders, and of the maps. A checksum may be
/// missing if another program wrote the file.
struct Identity {
  std::optional<MeshChecksums> before;
  std::optional<MeshChecksums> after;
  std::vector<std::pair<std::uint64_t MapChecksums::*, std::uint64_t>> maps;
};

std::optional<MeshChecksums> checksums_from(const nlohmann::json& json) {
  if (json.is_null()) return std::nullopt;
  return MeshChecksums{checksum_from(json.at("points")), checksum_from(json.at("cells"))};
}

Identity read_identity(const std::string& path) {
  constexpr std::size_t kMost = 1 << 16;
  const std::string text = FilePath::derived(path).open().text(kMost);
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    Identity identity{checksums_from(json.at("before")), checksums_from(json.at("after")), {}};
    if (const auto maps = json.find("maps"); maps != json.end()) {
      for (const auto& [name, checksum] : kOfMaps) {
        if (maps->contains(name)) identity.maps.emplace_back(checksum, checksum_from(maps->at(name)));
      }
    }
    return identity;
  } catch (const std::exception&) {
    throw InputError(path, "was not written by `order --maps`",
                     "order again, or remove it: without it, maps are applied unchecked");
  }
}

/// Throws Error if the mesh is not in the order that the maps start from. If the maps move nothing, both
/// orders are the same.
void require_order(const Identity& identity, const Maps& maps, const Mesh& mesh, const std::string& mesh_path,
                   const std::string& path, bool inverse) {
  const std::optional<MeshChecksums>& start = inverse ? identity.after : identity.before;
  const std::optional<MeshChecksums>& goal = inverse ? identity.before : identity.after;
  const MeshChecksums found = checksums_of(mesh);
  const auto has_cells_of = [&](const std::optional<MeshChecksums>& side) {
    return side && side->cells == found.cells;
  };
  // points may have been moved after the ordering, or rounded by a format
  if (found == start || (has_cells_of(start) && found != goal)) return;
  if (has_cells_of(goal) && maps.vertices.is_identity() && maps.cells.is_identity()) return;
  if (has_cells_of(goal) && inverse)
    throw InputError(mesh_path, "is already in its old order, according to " + path,
                     "leave out --inverse to reorder it");
  if (has_cells_of(goal))
    throw InputError(mesh_path, "is already in the new order, according to " + path,
                     "give --inverse to restore the old order");
  if (!start) return;
  throw InputError(
      mesh_path,
      goal ? "is not the mesh that the maps were written for, according to " + path
           : "is not in the order that the maps start from, according to " + path,
      stored_matrix(mesh) == nullptr
          ? "give the maps that were written with this mesh"
          : "give the maps that were written with this file; the same entries in another sequence "
            "count as another matrix");
}

}  // namespace

MeshChecksums checksums_of(const Mesh& mesh) {
  Checksum points;
  points.add_all(mesh.points);
  Checksum cells;
  cells.add_all(mesh.cells.offsets);
  cells.add_all(mesh.cells.vertices);
  return {points.value(), cells.value()};
}

MapPaths map_paths(const std::string& prefix, const std::string& what) {
  const std::string stem = prefix + "." + what;
  return {stem + ".old_to_new.npy", stem + ".new_to_old.npy", stem + ".ids.npy", stem + ".parts.npy"};
}

void check_can_write_maps(const std::string& prefix) {
  (void)OutputFile(FilePath::derived(identity_path(prefix)));
}

std::vector<std::string> write_maps(const Maps& maps, const MeshChecksums& before, const MeshChecksums& after,
                                    const std::string& prefix, OutputSet& files) {
  std::vector<std::string> written;
  write_map(maps.vertices, maps.vertex_ids, prefix, "vertices", files, written);
  write_map(maps.cells, maps.cell_ids, prefix, "cells", files, written);
  write_or_remove(maps.kept, kept_path(prefix), files, written);
  write_or_remove(maps.vertex_parts, map_paths(prefix, "vertices").parts, files, written);
  write_or_remove(maps.cell_parts, map_paths(prefix, "cells").parts, files, written);
  written.push_back(write_identity(before, after, checksums_of_maps(maps), prefix, files));
  return written;
}

std::string write_identity(const MeshChecksums& before, const MeshChecksums& after,
                           const MapChecksums& of_maps, const std::string& prefix, OutputSet& files) {
  nlohmann::ordered_json identity{
      {"version", MESHORDER_VERSION}, {"before", checksums_json(before)}, {"after", checksums_json(after)}};
  for (const auto& [name, checksum] : kOfMaps) identity["maps"][name] = digits_of(of_maps.*checksum);
  std::string path = identity_path(prefix);
  OutputFile file({FilePath::derived(path), files});
  file.write(identity.dump(2) + "\n");
  file.commit();
  return path;
}

void remove_other_maps(const std::string& prefix, OutputSet& files) {
  for (const char* const what : {"vertices", "cells"})
    files.remove(FilePath::derived(map_paths(prefix, what).ids));
  files.remove(FilePath::derived(kept_path(prefix)));
}

void leave_out_unmapped_cells(const std::string& prefix, Mesh& mesh, Notes& notes) {
  const std::string path = kept_path(prefix);
  if (!std::filesystem::exists(path)) return;
  const std::vector<std::int64_t> positions = read_npy(FilePath::derived(path));
  if (index_size(positions) == mesh.cell_count()) return;
  const bool ascending =
      std::adjacent_find(positions.begin(), positions.end(), std::greater_equal<>()) == positions.end();
  if (positions.empty() || !ascending || positions.front() < 0 || positions.back() >= mesh.cell_count()) {
    throw InputError(path, "does not list cells of this mesh, which has " + std::to_string(mesh.cell_count()),
                     "give the maps that were written with this mesh");
  }
  notes.push_back(std::to_string(mesh.cell_count() - index_size(positions)) +
                  " cells are left out, as before the mesh was ordered");
  keep_cells_at(mesh, {positions.begin(), positions.end()}, notes);
}

Maps read_maps(const std::string& prefix, const Mesh& mesh, const std::string& mesh_path, bool inverse) {
  require_prefix(prefix);
  Maps maps = read_permutations(prefix, mesh);
  const std::string path = identity_path(prefix);
  if (!std::filesystem::exists(path)) return maps;
  const Identity identity = read_identity(path);
  require_order(identity, maps, mesh, mesh_path, path, inverse);
  MapChecksums found = checksums_of_maps(maps);
  if (std::filesystem::exists(kept_path(prefix))) found.kept = checksum_of(read_npy(kept_path(prefix)));
  const bool fits = std::all_of(identity.maps.begin(), identity.maps.end(),
                                [&](const auto& known) { return found.*known.first == known.second; });
  if (!fits)
    throw InputError(path, "was not written together with these maps",
                     "give all files of one run of `order`");
  return maps;
}

}  // namespace meshorder::command
