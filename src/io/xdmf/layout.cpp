// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "io/named_parts.hpp"
#include "io/xdmf/xdmf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

// The layout of files for meshes from other formats. The paths in the HDF5 file and the names of Grids are
// those that DOLFINx's XDMFFile writes.

namespace meshorder::xdmf {
namespace {

/// Names of Grids, by the highest dimension of the mesh's cells minus the dimension of the Grid's cells.
constexpr std::array<std::string_view, 4> kGridNames{"mesh", "facet_tags", "ridge_tags", "peak_tags"};

std::vector<Index> cells_of_dimension(const Mesh& mesh, int wanted) {
  std::vector<Index> cells;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (dimension(mesh.cells.shapes[c]) == wanted) cells.push_back(c);
  }
  return cells;
}

/// Returns the cells by dimension, highest first; dimensions without cells are left out.
std::vector<std::vector<Index>> cells_by_dimension(const Mesh& mesh) {
  std::vector<std::vector<Index>> cells;
  for (int d = mesh.cells.highest_dimension(); d >= 0; --d) {
    std::vector<Index> of_dimension = cells_of_dimension(mesh, d);
    if (!of_dimension.empty()) cells.push_back(std::move(of_dimension));
  }
  return cells;
}

}  // namespace

int below_of(std::string_view grid) {
  const auto found = std::find(kGridNames.begin(), kGridNames.end(), grid);
  return found == kGridNames.end() ? 0 : static_cast<int>(found - kGridNames.begin());
}

XdmfLayout layout_of(const Mesh& mesh, const FilePath& path) {
  XdmfLayout layout;
  layout.is_made = true;
  layout.stem = path.path().stem().string();
  const std::string file = layout.stem + ".h5";
  layout.hdf5[file] = hdf5::File::in_memory({}, file).bytes();
  layout.xml = "<?xml version=\"1.0\"?><Xdmf Version=\"3.0\"><Domain>";
  const std::vector<std::vector<Index>> cells = cells_by_dimension(mesh);
  std::size_t item = 0;
  const auto add_item = [&](Field::Role role, const std::string& dataset, std::size_t alternative, int part) {
    DataPlace place{DataPlace::Format::hdf, item++, file, dataset, alternative};
    place.shape = {0};
    place.named_by = place.item;
    layout.fields.push_back({role, std::move(place), part});
    layout.xml += "<DataItem Dimensions=\"0\" Format=\"HDF\"/>";
  };
  constexpr std::size_t kDouble = 0;
  constexpr std::size_t kInt32 = 6;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto part = static_cast<int>(i);
    const int below = mesh.cells.highest_dimension() - dimension(mesh.cells.shapes[cells[i].front()]);
    const std::string name(kGridNames[below]);
    layout.parts.push_back({.name = name, .set = "", .below = below, .grid = i});
    layout.xml += fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\">", name);
    if (i > 0) layout.xml += fmt::format("<Information Name=\"{}\" Value=\"meshorder\"/>", kAdded);
    layout.xml += "<Topology TopologyType=\"\">";
    add_item(Field::Role::connectivity, fmt::format("/{}/{}/topology", i == 0 ? "Mesh" : "MeshTags", name),
             kInt32, part);
    layout.xml +=
        fmt::format("</Topology><Geometry GeometryType=\"{}\">", mesh.dimension == 2 ? "XY" : "XYZ");
    add_item(Field::Role::points, "/Mesh/mesh/geometry", kDouble, part);
    layout.xml += "</Geometry></Grid>";
  }
  layout.xml += "</Domain></Xdmf>";
  return layout;
}

std::vector<std::vector<Index>> cells_of_parts(const Mesh& mesh, const XdmfLayout& layout) {
  if (layout.is_made) return cells_by_dimension(mesh);
  std::vector<std::vector<Index>> cells(layout.parts.size());
  std::vector<bool> taken(mesh.cells.shapes.size(), false);
  const NamedParts parts(mesh);
  for (std::size_t p = 1; p < layout.parts.size(); ++p) {
    if (const int below = layout.parts[p].below; below > 0) {
      cells[p] = cells_of_dimension(mesh, mesh.cells.highest_dimension() - below);
    } else if (const EntitySet* const set = parts.set(layout.parts[p].set, Association::cells)) {
      cells[p] = set->members;
    } else {
      continue;
    }
    if (layout.parts[p].is_ascending) std::sort(cells[p].begin(), cells[p].end());
    if (!layout.parts[p].has_own_cells) continue;
    for (const Index c : cells[p]) taken[c] = true;
  }
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (!taken[c]) cells.front().push_back(c);
  }
  return cells;
}

Permutation places(const Mesh& mesh, std::vector<Index>& blocks) {
  std::vector<Index> new_to_old;
  new_to_old.reserve(mesh.cells.shapes.size());
  blocks.clear();
  for (const std::vector<Index>& cells : cells_by_dimension(mesh)) {
    blocks.push_back(index_size(new_to_old));
    new_to_old.insert(new_to_old.end(), cells.begin(), cells.end());
  }
  return Permutation::from_new_to_old(std::move(new_to_old));
}

}  // namespace meshorder::xdmf
