// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/findings.hpp"

#include "support/sample_results.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace meshorder;
using test::sample_results;

/// The one finding that begins so; "" where there is none.
std::string finding(const StudyResults& results, const std::string& beginning) {
  for (const std::string& sentence : findings_of(results)) {
    if (sentence.starts_with(beginning)) return sentence;
  }
  return {};
}

TEST(Findings, TellGainsAndHowTheyCompareWithThePaper) {
  EXPECT_EQ(
      finding(sample_results(), "Against “Scrambled”, Fiedler"),
      "Against “Scrambled”, Fiedler saves time in both scenarios: 12.0 % (stretch) to 25.0 % (falling). "
      "The paper reports 12.1 to 26.7 % in these scenarios; this study finds less in falling, the same, "
      "within "
      "its interval, in stretch. Where it saves time, computing the order pays off after 2 steps.");
}

TEST(Findings, DoNotCallNoiseAGain) {
  EXPECT_EQ(
      finding(sample_results(), "Against “Scrambled”, Original"),
      "Against “Scrambled”, Original saves time in 1 of 2 scenarios: 10.0 % (falling); it differs by no "
      "more than the noise in stretch. The paper reports 4.66 to 14.8 % in these scenarios; this study finds "
      "less in all of them.");
  StudyResults results = sample_results();
  for (ScenarioRecord& scenario : results.scenarios) scenario.orders[1].speedup.beyond_noise = false;
  const std::string fiedler = finding(results, "Against “Scrambled”, Fiedler");
  EXPECT_TRUE(fiedler.starts_with(
      "Against “Scrambled”, Fiedler differs by no more than the noise in falling and stretch."));
  EXPECT_EQ(fiedler.find("saves time"), std::string::npos);
}

TEST(Findings, TellLossesAndCostsThatAreNeverPaid) {
  EXPECT_EQ(finding(sample_results(), "Against “Scrambled”, VF scrambled"),
            "Against “Scrambled”, VF scrambled loses time in both scenarios: 2.0 % (falling) to 6.0 % "
            "(stretch).");
  const std::string paid = finding(sample_results(), "Against “Scrambled”, VF Fiedler");
  EXPECT_TRUE(paid.ends_with("pays off after 3 steps, and does not pay off within the steps of stretch."))
      << paid;
}

TEST(Findings, CautionAgainstAShortStudy) {
  EXPECT_NE(finding(sample_results(), "This is a first look, of 4 steps and 3 runs"), "");
  StudyResults results = sample_results();
  for (ScenarioRecord& scenario : results.scenarios) scenario.steps = 240;
  EXPECT_EQ(finding(results, "This is a first look"), "");
  results.runs = 1;
  EXPECT_NE(finding(results, "This is a first look"), "");
}

TEST(Findings, BeginWithWhatThePapersOrdersSave) {
  StudyResults results = sample_results();
  const auto set = [&](std::size_t scenario, const std::string& ordering, double percent) {
    for (ScenarioOrderRecord& order : results.scenarios[scenario].orders) {
      if (order.ordering == ordering) order.speedup.percent = percent;
    }
  };
  set(0, "fiedler", 3.25);
  set(1, "fiedler", -2);
  set(0, "vf-fiedler", 10);
  set(1, "vf-fiedler", 20);
  const std::string first = findings_of(results).front();
  EXPECT_NE(first.find("saves -2.0 to 3.2 %, and ordering elements as well 10.0 to 20.0 %, of the time"),
            std::string::npos)
      << first;
  results.reference = "original";
  EXPECT_EQ(findings_of(results).front().find("Ordering vertices"), std::string::npos);
}

TEST(Findings, CompareWithElementsScrambledToo) {
  StudyResults results = sample_results();
  const std::string before = finding(results, "If elements are scrambled too");
  for (ScenarioRecord& scenario : results.scenarios) {
    for (ScenarioOrderRecord& order : scenario.orders) {
      if (order.ordering != "vf-fiedler" && order.ordering != "vf-scrambled") continue;
      // two runs that differ by nothing but the order: 2 s a step against 3 s
      const double seconds = order.ordering == "vf-fiedler" ? 2 : 3;
      for (RunRecord& run : order.runs) run.step_seconds.assign(run.step_seconds.size(), seconds);
    }
  }
  EXPECT_NE(finding(results, "If elements are scrambled too").find("33.3 %"), std::string::npos) << before;
  // noise: now the one is faster, now the other
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

TEST(Findings, OfMeshesAloneAreVerdictsAndKernels) {
  StudyResults results = sample_results();
  results.scenarios.clear();
  results.meshes[0].verdict = "as it is, SpMV runs twice as fast as I could";
  const auto findings = findings_of(results);
  ASSERT_EQ(findings.size(), 4);
  EXPECT_EQ(findings[0], "dragon: as it is, SpMV runs twice as fast as I could.");
  EXPECT_EQ(findings[1],
            "Measured kernels on dragon, compared with “Scrambled”: SpMV runs 5.00 times faster in VF "
            "Fiedler; SpMV runs 1.10 times slower in VF scrambled.");
  EXPECT_TRUE(findings_of({}).empty());
}

}  // namespace
