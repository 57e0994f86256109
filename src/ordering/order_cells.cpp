// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/order_cells.hpp"

#include "cells/facets.hpp"
#include "ordering/grouped.hpp"
#include "ordering/method.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>

namespace meshorder {
namespace {

bool is_one_class(std::span<const Index> classes) {
  return std::all_of(classes.begin(), classes.end(), [&](Index k) { return k == classes.front(); });
}

}  // namespace

bool has_one_slot_class(const CellArrays& cells) {
  if (cells.block_starts.size() > 1) return false;
  std::array<int, kShapes> dimensions{};
  for (int shape = 0; shape < kShapes; ++shape) dimensions[shape] = dimension(static_cast<Shape>(shape));
  return std::all_of(cells.shapes.begin(), cells.shapes.end(), [&](Shape shape) {
    return dimensions[static_cast<std::size_t>(shape)] ==
           dimensions[static_cast<std::size_t>(cells.shapes.front())];
  });
}

std::vector<Index> slot_classes(const CellArrays& cells) {
  std::vector<Index> classes(static_cast<std::size_t>(cells.size()));
  const std::vector<Index>& starts = cells.block_starts;
  Index block = 0;
  for (Index c = 0; c < cells.size(); ++c) {
    while (block + 1 < index_size(starts) && starts[block + 1] <= c) ++block;
    classes[c] = 4 * block + cells.dimension_of(c);
  }
  return classes;
}

Permutation permutation_within_classes(std::span<const Index> classes, std::vector<Index>&& cells_in_order) {
  if (cells_in_order.size() != classes.size()) {
    throw InvalidArgument("cells: an order of " + std::to_string(cells_in_order.size()) + " for " +
                          std::to_string(classes.size()) + " cells");
  }
  if (is_one_class(classes)) return Permutation::from_new_to_old(std::move(cells_in_order));

  // places of each class, ascending, one class after another
  const Index count = *std::max_element(classes.begin(), classes.end()) + 1;
  std::vector<Index> start(static_cast<std::size_t>(count) + 1, 0);
  for (const Index k : classes) ++start[k + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<Index> places(classes.size());
  std::vector<Index> next(start.begin(), start.end() - 1);
  for (Index c = 0; c < index_size(classes); ++c) places[next[classes[c]]++] = c;

  // give each class's places to its cells
  std::copy(start.begin(), start.end() - 1, next.begin());
  std::vector<Index> old_to_new(classes.size(), -1);
  for (const Index c : cells_in_order) old_to_new[c] = places[next[classes[c]]++];
  return Permutation::from_old_to_new(std::move(old_to_new));
}

Order order_cells(std::string_view method, const CellArrays& cells, const Permutation& vertices,
                  const PointsView& points, const IndexView& groups, const OrderOptions& options) {
  const CellSelection elements = CellSelection::elements(cells);
  const auto facet_graph = [&] { return joined_by_facet(cells, elements); };
  const ElementInput input{elements.incidence(), vertices, points, facet_graph};
  MethodChoice choice{std::string(method), {}};
  // in groups the old order is no alternative, so `auto` need not compare with it
  if (method == "auto" && !(groups.empty() && options.groups.empty()))
    choice = choose_element_method(input, options.workload);
  Order result = order_incidence(choice.name, input, options);
  if (!choice.reason.empty()) result.method = std::move(choice);

  if (groups.empty() && has_one_slot_class(cells)) return result;

  std::vector<Index> sequence;
  sequence.reserve(static_cast<std::size_t>(cells.size()));
  for (const Index e : result.permutation.new_to_old()) sequence.push_back(elements.cell(e));
  const CellSelection lower = CellSelection::lower_dimensional(cells);
  const std::string_view lower_method = result.method.name == "original" ? "original" : "lexmax";
  const Order of_lower =
      order_incidence(lower_method, {lower.incidence(), vertices, points, facet_graph}, options);
  for (const Index e : of_lower.permutation.new_to_old()) sequence.push_back(lower.cell(e));
  if (!groups.empty()) {
    Index count = 0;
    const std::vector<Index> group_of = dense_groups(groups, cells.size(), "cells", count);
    std::stable_sort(sequence.begin(), sequence.end(),
                     [&](Index a, Index b) { return group_of[a] < group_of[b]; });
  }
  result.permutation = permutation_within_classes(slot_classes(cells), std::move(sequence));
  return result;
}

}  // namespace meshorder
