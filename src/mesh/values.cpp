// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/values.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <iterator>

namespace meshorder {

std::vector<double> as_reals(const Values& values) {
  return std::visit(
      [](const auto& all) -> std::vector<double> {
        using Number = typename std::decay_t<decltype(all)>::value_type;
        if constexpr (std::is_arithmetic_v<Number>) {
          return {all.begin(), all.end()};
        } else {
          return {};
        }
      },
      values);
}

void append_values(Values& values, Values more) {
  std::visit(
      [&](auto& all) {
        auto& added = std::get<std::decay_t<decltype(all)>>(more);
        all.insert(all.end(), std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()));
      },
      values);
}

Values rows_of_values(const Values& values, Index components, std::span<const Index> rows) {
  return std::visit(
      [&](const auto& all) {
        std::decay_t<decltype(all)> chosen;
        chosen.reserve(rows.size() * static_cast<std::size_t>(components));
        for (const Index row : rows) {
          if (row < 0) {
            using Value = typename std::decay_t<decltype(all)>::value_type;
            chosen.insert(chosen.end(), static_cast<std::size_t>(components), missing_value<Value>());
            continue;
          }
          const auto first = all.begin() + static_cast<std::ptrdiff_t>(row) * components;
          chosen.insert(chosen.end(), first, first + components);
        }
        return Values(std::move(chosen));
      },
      values);
}

std::vector<Index> rows_by_item(const DataArray& array, Index count) {
  std::vector<Index> rows;
  if (array.is_dense()) return rows;
  rows.assign(static_cast<std::size_t>(count), -1);
  for (Index row = 0; row < index_size(array.indices); ++row)
    rows[static_cast<std::size_t>(array.indices[static_cast<std::size_t>(row)])] = row;
  return rows;
}

void make_dense(DataArray& array, Index count) {
  if (array.is_dense() || index_size(array.indices) != count) return;
  // the indices are distinct: if they ascend, all rows are in place
  if (!std::is_sorted(array.indices.begin(), array.indices.end()))
    array.values = rows_of_values(array.values, array.components, rows_by_item(array, count));
  array.indices.clear();
}

}  // namespace meshorder
