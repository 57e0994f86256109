// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/tables/tables.hpp"

#include "lab/report/tables/each_table.hpp"

#include <algorithm>
#include <iterator>

namespace meshorder {

std::vector<Table> tables_of(const StudyResults& results) {
  std::vector<Table> tables{summary_table(results), edge_span_table(results), seconds_table(results),
                            saved_table(results),   speedup_table(results),   break_even_table(results),
                            phases_table(results),  motions_table(results)};
  std::ranges::move(misses_tables(results), std::back_inserter(tables));
  tables.push_back(prediction_table(results));
  tables.push_back(kernels_table(results));
  tables.push_back(machine_table(results));
  tables.push_back(protocol_table(results));
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace meshorder
