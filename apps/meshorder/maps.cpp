// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "maps.hpp"

#include "base/index.hpp"
#include "io/kept_cells.hpp"
#include "io/npy.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <filesystem>
#include <functional>

namespace meshorder::command {
namespace {

std::string old_to_new_path(const std::string& prefix, const std::string& what) {
  return prefix + "." + what + ".old_to_new.npy";
}
std::string new_to_old_path(const std::string& prefix, const std::string& what) {
  return prefix + "." + what + ".new_to_old.npy";
}
std::string ids_path(const std::string& prefix, const std::string& what) {
  return prefix + "." + what + ".ids.npy";
}
std::string kept_path(const std::string& prefix) { return prefix + ".elements.kept.npy"; }

void write_map(const Permutation& map, const std::vector<std::int64_t>& ids, const std::string& prefix,
               const std::string& what, std::vector<std::string>& written) {
  write_npy(map.old_to_new(), written.emplace_back(old_to_new_path(prefix, what)));
  write_npy(map.new_to_old(), written.emplace_back(new_to_old_path(prefix, what)));
  if (!ids.empty()) {
    write_npy(ids, written.emplace_back(ids_path(prefix, what)));
  } else {
    std::filesystem::remove(ids_path(prefix, what));  // an earlier run with this prefix may have left it
  }
}

std::vector<std::int64_t> read_ids(const std::string& path, Index count) {
  if (!std::filesystem::exists(path)) return {};
  std::vector<std::int64_t> ids = read_npy(path);
  if (index_size(ids) != count) {
    throw InputError(path, "has " + std::to_string(ids.size()) + " numbers for " + std::to_string(count),
                     "give the maps that were written with this mesh");
  }
  return ids;
}

}  // namespace

std::vector<std::string> write_maps(const Maps& maps, const std::string& prefix) {
  std::vector<std::string> written;
  write_map(maps.vertices, maps.vertex_ids, prefix, "vertices", written);
  write_map(maps.cells, maps.cell_ids, prefix, "elements", written);
  if (!maps.kept.empty()) {
    write_npy(maps.kept, written.emplace_back(kept_path(prefix)));
  } else {
    std::filesystem::remove(kept_path(prefix));
  }
  return written;
}

void leave_out_unmapped_cells(const std::string& prefix, Mesh& mesh, Notes& notes) {
  const std::string path = kept_path(prefix);
  if (!std::filesystem::exists(path)) return;
  const std::vector<std::int64_t> positions = read_npy(path);
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

Maps read_maps(const std::string& prefix, const Mesh& mesh) {
  return {read_permutation(old_to_new_path(prefix, "vertices"), mesh.vertex_count(), "vertices"),
          read_permutation(old_to_new_path(prefix, "elements"), mesh.cell_count(), "cells"),
          read_ids(ids_path(prefix, "vertices"), mesh.vertex_count()),
          read_ids(ids_path(prefix, "elements"), mesh.cell_count()),
          {}};
}

}  // namespace meshorder::command
