// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cell_division.hpp"

#include "base/index.hpp"
#include "io/labels.hpp"
#include "mesh/values.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace meshorder {
namespace {

/// Returns the cells' labels; empty if any label needs 64 bits and `with_wide_ones` is false.
std::vector<std::int64_t> usable_labels(const Mesh& mesh, bool with_wide_ones) {
  Labels labels = labels_of(mesh, Association::cells);
  const bool are_usable = with_wide_ones || fit_32_bits(labels.values);
  return are_usable ? std::move(labels.values) : std::vector<std::int64_t>();
}

/// Returns the number of each cell's set, from 1; 0 for cells without a set. Skips sets that share a cell
/// with an earlier set. Empty if there are no sets of cells.
std::vector<std::int64_t> sets_of_cells(const Mesh& mesh) {
  std::vector<std::int64_t> result;
  std::int64_t number = 0;
  for (const EntitySet& set : mesh.sets) {
    if (set.association == Association::vertices || set.members.empty()) continue;
    result.resize(mesh.cells.shapes.size(), 0);
    if (std::any_of(set.members.begin(), set.members.end(), [&](Index c) { return result[c] != 0; }))
      continue;
    ++number;
    for (const Index c : set.members) result[c] = number;
  }
  return result;
}

/// Divides the cells by type and by value (`values`, one per cell; if empty, by type only). Returns false if
/// the values give more than kMostBlocks blocks.
bool divide_by(const Mesh& mesh, const std::vector<std::int64_t>& values, CellDivision& division) {
  std::map<std::tuple<std::int64_t, Shape, int>, Index> known;
  std::tuple<std::int64_t, Shape, int> last;
  division.keys.clear();
  division.key_of_cell.resize(mesh.cells.shapes.size());
  Index key = -1;  // neighbouring cells mostly have the same key
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const std::tuple current{values.empty() ? 0 : values[c], mesh.cells.shapes[c],
                             mesh.cells.vertex_count(c)};
    if (key < 0 || current != last) {
      const auto [found, is_new] = known.try_emplace(current, index_size(division.keys));
      key = found->second;
      last = current;
      if (is_new) {
        if (!values.empty() && division.keys.size() == kMostBlocks) return false;
        division.keys.push_back({c, 0, std::get<1>(current), std::get<2>(current), std::get<0>(current)});
      }
    }
    ++division.keys[key].count;
    division.key_of_cell[c] = key;
  }
  return true;
}

}  // namespace

CellDivision divide_cells(const Mesh& mesh, DividedBy divided_by) {
  CellDivision division;
  std::vector<std::int64_t> values = usable_labels(mesh, divided_by.wide_labels);
  division.by_labels =
      std::any_of(values.begin(), values.end(), [](std::int64_t label) { return label != 0; });
  if (!division.by_labels) {
    values = divided_by.sets ? sets_of_cells(mesh) : std::vector<std::int64_t>();
    division.by_sets = !values.empty();
  }
  if (!divide_by(mesh, values, division)) {
    division.by_labels = division.by_sets = false;
    divide_by(mesh, {}, division);
  }
  return division;
}

Permutation places_by_division(const CellDivision& division, std::vector<Index>& blocks) {
  std::vector<Index> keys(division.keys.size());
  std::iota(keys.begin(), keys.end(), Index{0});
  std::stable_sort(keys.begin(), keys.end(), [&](Index a, Index b) {
    return dimension(division.keys[a].shape) > dimension(division.keys[b].shape);
  });
  std::vector<Index> next(keys.size());
  Index begin = 0;
  blocks.clear();
  for (const Index key : keys) {
    blocks.push_back(begin);
    next[key] = begin;
    begin += division.keys[key].count;
  }
  std::vector<Index> old_to_new;
  old_to_new.reserve(division.key_of_cell.size());
  for (const Index key : division.key_of_cell) old_to_new.push_back(next[key]++);
  return Permutation::from_old_to_new(std::move(old_to_new));
}

}  // namespace meshorder
