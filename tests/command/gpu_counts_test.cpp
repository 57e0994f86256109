// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "gpu_counts.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace meshorder::command {
namespace {

/// A kernel of which the time was measured on an NVIDIA H100.
struct Measured {
  std::string order;
  Offset sectors;
  Offset bytes;
  Offset floor;  ///< of the bytes
  double microseconds;
};

/// Element forces of the lattice of docs/gpu.md: 2,109,613 vertices, 12,223,304 tetrahedra. The counts are
/// those of `gpu_cost`, for a random order of our own; times are medians of five batches.
TEST(GpuCard, times_are_near_those_that_were_measured) {
  const GpuCard* const card = gpu_card("h100");
  ASSERT_NE(card, nullptr);
  for (const Measured& kernel : {
           Measured{"original packed", 67'086'171, 347'951'680, 246'203'584, 968.8},
           Measured{"original apart", 34'669'989, 348'016'256, 246'203'648, 594.6},
           Measured{"original padded", 27'633'269, 398'169'472, 263'080'512, 505.6},
           Measured{"random packed", 146'677'758, 1'652'113'984, 246'203'584, 3285.3},
           Measured{"random apart", 146'672'073, 2'911'182'272, 246'203'648, 5801.5},
           Measured{"random padded", 48'892'860, 2'028'520'192, 263'080'512, 2760.9},
           Measured{"hilbert and lexmax packed", 128'320'495, 248'700'416, 246'203'584, 2083.1},
           Measured{"hilbert and lexmax apart", 97'588'437, 249'515'648, 246'203'648, 1573.6},
           Measured{"rcm and lexmax padded", 46'254'324, 265'131'776, 263'080'512, 687.9},
       }) {
    const GpuCost cost{.sectors = kernel.sectors, .dram_bytes = kernel.bytes, .dram_floor = kernel.floor};
    EXPECT_NEAR(card->time(cost) / kernel.microseconds, 1, 0.15) << kernel.order;
  }
}

/// Random orders of the dragon, 161,222 tetrahedra, and of the body, 1,299,557: the cache holds their
/// vertices.
TEST(GpuCard, times_without_repeated_reads_are_those_of_the_sectors) {
  const GpuCard* const card = gpu_card("h100");
  ASSERT_NE(card, nullptr);
  for (const auto& [sectors, microseconds] :
       {std::pair(1'932'145, 33.3), std::pair(1'928'691, 38.2), std::pair(644'205, 15.1),
        std::pair(15'591'673, 240.2), std::pair(15'587'253, 300.3), std::pair(5'197'450, 110.4)})
    EXPECT_NEAR(card->time({.sectors = sectors}) / microseconds, 1, 0.25);
}

}  // namespace
}  // namespace meshorder::command
