// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/findings/prediction_error.hpp"
#include "lab/report/tables/detail_tables.hpp"

#include <fmt/format.h>

#include <string>

namespace meshorder {

Table prediction_table(const StudyResults& results) {
  Table table{
      "prediction-error",
      "How far the predictions are off",
      fmt::format(
          "Error of a predicted speedup over “{}”: predicted divided by measured, less 1, without its sign; "
          "over all meshes and orders. Told right: pairs of orders of a mesh that are measured more than 10 "
          "% "
          "apart and of which the faster one is predicted to be the faster one.",
          title_of(results, results.reference)),
      {"Kernel", "Speedups", "Median error, %", "90 % within, %", "Largest, %", "Told right", "Of pairs"},
      {}};
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    const PredictionError error = prediction_error(results, k);
    if (error.speedups == 0) continue;
    table.rows.push_back({text_cell(std::string(kKernelTitles[k])), count_cell(error.speedups),
                          number_cell(100 * error.median, 2), number_cell(100 * error.of_nine_tenths, 2),
                          number_cell(100 * error.largest, 2), count_cell(error.pairs_told_right),
                          count_cell(error.pairs)});
  }
  return table;
}

}  // namespace meshorder
