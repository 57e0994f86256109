// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/study_plan.hpp"

#include <meshorder/error.hpp>

#include <gtest/gtest.h>

namespace meshorder {
namespace {

TEST(StudyPlan, HasThePapersFiveOrderings) {
  const std::vector<OrderingSpec> orderings = paper_orderings();
  ASSERT_EQ(orderings.size(), 5U);
  EXPECT_EQ(orderings[2].name, "vf-fiedler");
  EXPECT_EQ(orderings[2].elements, "fiedler");  // of the dual graph, section 4.1
  EXPECT_EQ(orderings[3].elements, "original");
  for (const OrderingSpec& ordering : orderings)
    EXPECT_EQ(study_ordering(ordering.name).title, ordering.title);
}

TEST(StudyPlan, TakesAnyMethodsAsAnOrdering) {
  const OrderingSpec ordering = study_ordering("hilbert/lexmax");
  EXPECT_EQ(ordering.name, "hilbert-lexmax");
  EXPECT_EQ(ordering.vertices, "hilbert");
  EXPECT_EQ(ordering.elements, "lexmax");
  EXPECT_THROW(study_ordering("hilbert/nonsense"), InvalidArgument);
  EXPECT_THROW(study_ordering("hilbert"), InvalidArgument);
  EXPECT_THROW(study_ordering(""), InvalidArgument);
}

TEST(StudyPlan, GrowsTheMeshesAndLeavesOutWhatDoesNotFit) {
  EXPECT_EQ(mesh_of_size("paper", "dragon"), "dragon");
  EXPECT_EQ(mesh_of_size("300k", "dragon"), "armadillo-300k");
  EXPECT_THROW(mesh_of_size("huge", "dragon"), InvalidArgument);
  EXPECT_TRUE(fits_in_memory("2m", find_scenario("falling")));
  EXPECT_FALSE(fits_in_memory("2m", find_scenario("unsquash")));
  EXPECT_TRUE(fits_in_memory("300k", find_scenario("unsquash")));
}

}  // namespace
}  // namespace meshorder
