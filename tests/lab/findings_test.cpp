// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/findings.hpp"

#include "support/sample_results.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace meshorder;
using test::sample_results;

/// The finding with this beginning; "" if there is none.
std::string finding(const StudyResults& results, const std::string& beginning) {
  for (const std::string& sentence : findings_of(results)) {
    if (sentence.starts_with(beginning)) return sentence;
  }
  return {};
}

TEST(Findings, DoNotRepeatTheTable) {
  for (const std::string& sentence : findings_of(sample_results())) {
    EXPECT_EQ(sentence.find("Against"), std::string::npos) << sentence;
    EXPECT_EQ(sentence.find("The paper reports"), std::string::npos) << sentence;
  }
}

TEST(Findings, TellWhenOrdersArePaid) {
  const std::string beginning = "Where an order saves time";
  EXPECT_EQ(finding(sample_results(), beginning),
            "Where an order saves time, computing it pays off after 2 (Fiedler in falling) to 3 steps (VF "
            "Fiedler in falling), but not within the measured steps for VF Fiedler in stretch.");
  StudyResults results = sample_results();
  for (ScenarioRecord& scenario : results.scenarios) {
    for (ScenarioOrderRecord& order : scenario.orders) order.speedup.break_even_step = 1;
  }
  EXPECT_EQ(finding(results, beginning), "Where an order saves time, computing it pays off after 1 step.");
  for (ScenarioRecord& scenario : results.scenarios) {
    for (ScenarioOrderRecord& order : scenario.orders) order.speedup.break_even_step.reset();
  }
  EXPECT_EQ(finding(results, beginning),
            "Where an order saves time, computing it does not pay off within the measured steps: Fiedler in "
            "falling, Fiedler in stretch, VF Fiedler in falling and VF Fiedler in stretch.");
  // an order within the noise, or one that costs time, never pays
  for (ScenarioRecord& scenario : results.scenarios) {
    for (ScenarioOrderRecord& order : scenario.orders) order.speedup.beyond_noise = order.speedup.percent < 0;
  }
  EXPECT_EQ(finding(results, beginning), "");
}

TEST(Findings, TellHowFarPredictionsAreOff) {
  StudyResults results = sample_results();
  const std::string beginning = "Predicted speedups";
  EXPECT_TRUE(finding(results, beginning)
                  .ends_with("36 pairs of orders that are more than 10 % apart, all are predicted "
                             "the right way round."))
      << finding(results, beginning);
  // the predicted time of SpMV is halved in all orders except the reference
  for (MeshOrderRecord& order : results.meshes[0].orders) {
    if (order.ordering != "scrambled") order.kernels[0].predicted_ms /= 2;
  }
  EXPECT_TRUE(
      finding(results, beginning)
          .starts_with("Predicted speedups of the kernels are off by 100 % for SpMV, 0 % for element force"));
  for (KernelRecord& kernel : results.meshes[0].orders[3].kernels) kernel.measured_ms = 0;
  EXPECT_EQ(finding(results, beginning), "");
}

TEST(Findings, CautionAgainstAShortStudy) {
  EXPECT_NE(finding(sample_results(),
                    "This study is shorter than the paper's of 240 steps and 3 runs: falling (4 steps)"),
            "");
  StudyResults results = sample_results();
  for (ScenarioRecord& scenario : results.scenarios) scenario.steps = 240;
  EXPECT_EQ(finding(results, "This study is shorter than the paper's"), "");
  results.runs = 1;
  EXPECT_NE(finding(results, "This study is shorter than the paper's"), "");
}

TEST(Findings, TellTheLoadAndTheThrottlingOfTheMachine) {
  StudyResults results = sample_results();
  EXPECT_EQ(finding(results, "Load:"), "") << "not recorded by earlier versions";
  results.machine.cores = 2;
  for (ScenarioRecord& scenario : results.scenarios) {
    for (ScenarioOrderRecord& order : scenario.orders) {
      for (RunRecord& run : order.runs) {
        run.step_seconds = {5, 5};
        run.other_seconds = 2;  // of 20 processor seconds
        run.pace_seconds = {0.001, 0.001};
      }
    }
  }
  RunRecord& busy = results.scenarios[1].orders[2].runs[0];
  busy.other_seconds = 10;
  busy.pace_seconds[1] = 0.0013;
  const std::string where = results.orderings[2].title + " in " + results.scenarios[1].name;
  EXPECT_EQ(finding(results, "Load:"),
            "Load: other programs used 11 % of the processors during the runs, at most 50 % (" + where +
                "); a fixed piece of arithmetic took up to 30 % longer than at best (" + where + ").");
}

TEST(Findings, CompareWithElementsScrambledToo) {
  StudyResults results = sample_results();
  const std::string before = finding(results, "If elements are scrambled too");
  for (ScenarioRecord& scenario : results.scenarios) {
    for (ScenarioOrderRecord& order : scenario.orders) {
      if (order.ordering != "vf-fiedler" && order.ordering != "vf-scrambled") continue;
      // two runs that differ only in the order: 2 s per step against 3 s
      const double seconds = order.ordering == "vf-fiedler" ? 2 : 3;
      for (RunRecord& run : order.runs) run.step_seconds.assign(run.step_seconds.size(), seconds);
    }
  }
  EXPECT_NE(finding(results, "If elements are scrambled too").find("33.3 %"), std::string::npos) << before;
  // noise: each of the two orders is faster in turn
  for (ScenarioOrderRecord& order : results.scenarios[1].orders) {
    for (std::size_t r = 0; r < order.runs.size(); ++r) {
      const bool slow = (order.ordering == "vf-fiedler") == (r % 2 == 0);
      order.runs[r].step_seconds.assign(order.runs[r].step_seconds.size(), slow ? 9 : 1);
    }
  }
  EXPECT_TRUE(finding(results, "If elements are scrambled too")
                  .ends_with("saves 33.3 % (falling) of the time of VF scrambled."));
  results.orderings.pop_back();
  for (ScenarioRecord& scenario : results.scenarios) scenario.orders.pop_back();
  EXPECT_EQ(finding(results, "If elements are scrambled too"), "");
}

TEST(Findings, TellWhetherTheMotionsAreTheSame) {
  EXPECT_NE(finding(sample_results(), "The motion is the same in every order: "), "");
  StudyResults results = sample_results();
  results.scenarios[1].orders[2].motion.largest = 0.2;
  EXPECT_NE(finding(results, "The motion is the same in every order of most scenarios: ")
                .find("The motions differ in stretch (by 20.0 % of the body's longest side)"),
            std::string::npos);
}

TEST(Findings, TellWhereOrdersTakeOtherNumbersOfIterations) {
  EXPECT_EQ(finding(sample_results(), "Where an order takes"), "");
  StudyResults results = sample_results();
  for (RunRecord& run : results.scenarios[0].orders[1].runs) run.cg_iterations = 72;
  EXPECT_EQ(
      finding(results, "Where an order takes"),
      "Where an order takes a different number of iterations, memory is not the only cause of a difference: "
      "falling, Fiedler (−10.0 %).");
}

TEST(Findings, TellWhereSimulatedCachesShowMore) {
  EXPECT_EQ(finding(sample_results(), "In simulation"),
            "In simulation, one run of each kernel on each mesh in “Scrambled” misses the last-level cache "
            "80 times "
            "on this machine (32 MB), 0.50 times as often in Original, 0.25 times as often in Fiedler, 0.20 "
            "times as often in VF Fiedler and 1.10 times as often in VF scrambled; 200 times on the paper's "
            "Xeon E5-1620 v4 (10 MB), 0.50 times as often in Original, 0.26 times as often in Fiedler, 0.20 "
            "times as often in VF Fiedler and 1.10 times as often in VF scrambled.");
  EXPECT_EQ(finding(sample_results(), "From “Scrambled”"),
            "From “Scrambled” to the best order, the mean edge span falls from 100 to 20.0 on dragon (VF "
            "Fiedler).");
}

TEST(Findings, OfMeshesAloneAreSpansAndMisses) {
  StudyResults results = sample_results();
  results.scenarios.clear();
  results.meshes[0].verdict = "as it is, SpMV runs twice as fast as I could";
  const auto findings = findings_of(results);
  ASSERT_EQ(findings.size(), 2) << "the headline has the verdict, and predictions have a part of their own";
  EXPECT_TRUE(findings[0].starts_with("From “Scrambled” to the best order"));
  EXPECT_TRUE(findings[1].starts_with("In simulation"));
  EXPECT_TRUE(findings_of({}).empty());
}

}  // namespace
