// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/comparison/comparison.hpp"

#include "support/files.hpp"
#include "support/sample_results.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace meshorder {
namespace {

using test::sample_results;

/// Two studies of the same scenarios, on two machines.
struct BothStudies {
  ComparedStudy a{"a/results.json", sample_results()};
  ComparedStudy b{"b/results.json", sample_results()};
};

Speedup speedup(double percent, double low, double high) {
  Speedup made;
  made.percent = percent;
  made.low = low;
  made.high = high;
  made.beyond_noise = low > 0 || high < 0;
  return made;
}

/// The error of a comparison after a change of the second study.
std::string complaint(const std::function<void(StudyResults&)>& change) {
  BothStudies both;
  change(both.b.results);
  try {
    check_comparable(both.a, both.b);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

const std::string kRemedy = "; compare studies of the same meshes, scenarios and precisions";

TEST(Comparison, AddsTheSquaresOfBothIntervals) {
  const auto difference = difference_of(speedup(10, 7, 13), speedup(20, 16, 24));
  ASSERT_TRUE(difference);
  EXPECT_EQ(*difference, (SavingDifference{10, 5, 15, true}));  // 3² + 4² = 5²
  EXPECT_FALSE(difference_of(speedup(10, 7, 13), speedup(14, 10, 18))->beyond_noise);
  EXPECT_TRUE(difference_of(speedup(10, 7, 13), speedup(4, 0, 8))->beyond_noise);
  // asymmetric intervals: the halves that face each other give the low end, the other halves the high end
  const auto uneven = difference_of(speedup(0, -5, 3), speedup(10, 6, 22));
  EXPECT_DOUBLE_EQ(uneven->low, 5);
  EXPECT_DOUBLE_EQ(uneven->high, 23);
}

TEST(Comparison, DistinguishesNothingWithoutIntervals) {
  EXPECT_FALSE(difference_of(speedup(10, 10, 10), speedup(20, 19, 21)));
  EXPECT_FALSE(difference_of(speedup(10, 9, 11), speedup(20, 20, 20)));
}

TEST(Comparison, TakesStudiesThatDifferInMachineProgramStepsAndOrders) {
  EXPECT_EQ(complaint([](StudyResults&) {}), "none");
  EXPECT_EQ(complaint([](StudyResults& results) {
              results.machine.processor = "Another 1";
              results.machine.program = "9.9.9";
              results.machine.revision = "5eed";
              results.threads = 2;
              results.runs = 1;
              results.scenarios[0].steps = 8;
              results.scenarios[1].precision.clear();
              results.orderings.push_back({"hilbert-lexmax", "Hilbert", "hilbert", "lexmax"});
            }),
            "none");
}

TEST(Comparison, RefusesOtherMeshesScenariosAndPrecisions) {
  EXPECT_EQ(
      complaint([](StudyResults& results) { results.meshes[0].vertices = 301; }),
      "b/results.json: has a mesh dragon of 301 vertices and 900 tetrahedra, where a/results.json has 300 "
      "vertices and 900 tetrahedra" +
          kRemedy);
  EXPECT_EQ(complaint([](StudyResults& results) {
              results.meshes[0].name = "bunny";
              for (ScenarioRecord& scenario : results.scenarios) scenario.mesh = "bunny";
            }),
            "b/results.json: has no mesh dragon, which a/results.json has" + kRemedy);
  EXPECT_EQ(complaint([](StudyResults& results) { results.size = "300k"; }),
            "b/results.json: has meshes of size 300k, where a/results.json has paper" + kRemedy);
  EXPECT_EQ(complaint([](StudyResults& results) { results.scenarios.pop_back(); }),
            "b/results.json: has no scenario stretch, which a/results.json has" + kRemedy);
  EXPECT_EQ(complaint([](StudyResults& results) {
              results.scenarios.push_back(results.scenarios[0]);
              results.scenarios.back().name = "bowl";
            }),
            "b/results.json: has the scenario bowl, which a/results.json lacks" + kRemedy);
  EXPECT_EQ(complaint([](StudyResults& results) {
              results.scenarios[0].precision = "single";
              results.scenarios[0].fingerprint = "0123456789abcdef5eed5eed5eed5eed";
            }),
            "b/results.json: has falling in the precision single, where a/results.json has double" + kRemedy);
  EXPECT_EQ(complaint([](StudyResults& results) { results.scenarios[1].material = "strain"; }),
            "b/results.json: has stretch of the material strain, where a/results.json has springs" + kRemedy);
  EXPECT_EQ(complaint([](StudyResults& results) { results.reference = "original"; }),
            "b/results.json: has the reference original, where a/results.json has scrambled" + kRemedy);
  EXPECT_EQ(complaint([](StudyResults& results) { results.scenarios.clear(); }),
            "b/results.json: has no scenario that was run; compare studies that `meshorder reproduce` made");
}

TEST(Comparison, ComparesFingerprintsOfMeshAndParameters) {
  BothStudies both;
  both.a.results.scenarios[0].fingerprint = "0123456789abcdef5eed5eed5eed5eed";
  const auto said = [&](const char* fingerprint) -> std::string {
    both.b.results.scenarios[0].fingerprint = fingerprint;
    try {
      check_comparable(both.a, both.b);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(said("0123456789abcdef5eed5eed5eed5eed"), "none");
  EXPECT_NE(said("0123456789abcdff5eed5eed5eed5eed").find("has falling on another mesh of the name dragon"),
            std::string::npos);
  EXPECT_NE(said("0123456789abcdef5eed5eed5eed5eee").find("has another falling (other parameters"),
            std::string::npos);
}

TEST(Comparison, ShowsBothStudiesSideBySide) {
  BothStudies both;
  both.b.results.machine.processor = "Another 1";
  // falling, Fiedler: +25 ± 1 in A
  Speedup& fiedler = both.b.results.scenarios[0].orders[1].speedup;
  fiedler = speedup(20, 18, 22);
  both.b.results.scenarios[0].orders[3].time.mean = 50;
  both.b.results.scenarios[1].steps = 8;
  const auto tables = comparison_tables(both.a, both.b);
  ASSERT_EQ(tables.size(), 4);
  EXPECT_EQ(tables[0].id, "comparison");
  ASSERT_EQ(tables[0].rows.size(), 8);
  const auto& row = tables[0].rows[1];
  EXPECT_EQ(row[0].text, "falling, Fiedler");
  EXPECT_EQ(row[1].interval, "+24.0 … +26.0");
  EXPECT_EQ(row[1].certainty, Certainty::saves);
  EXPECT_EQ(row[2].text, "+20.0");
  EXPECT_EQ(row[3].text, "−5.0");
  EXPECT_EQ(row[3].interval, "−7.2 … −2.8");  // √5 = 2.24
  EXPECT_EQ(row[4].text, "A saves more");
  EXPECT_EQ(row[5].text, "+26.7");
  EXPECT_EQ(tables[0].rows[0][4].text, "not told apart");
  EXPECT_TRUE(tables[0].rows[0][4].weak);

  EXPECT_EQ(tables[1].id, "comparison-machines");
  for (const auto& line : tables[1].rows) {
    if (line[0].text == "Processor") {
      EXPECT_EQ(line[1].text + "|" + line[2].text + "|" + line[3].text, "Made-up 9000|Another 1|differs");
    }
    if (line[0].text == "Compiler") {
      EXPECT_EQ(line[3].text, "same");
    }
  }
  EXPECT_EQ(tables[2].rows[0][5].text, "2.00");  // 100 s over 50 s
  EXPECT_EQ(tables[2].rows[1][5].text, "–");     // the numbers of steps differ
  EXPECT_EQ(tables[3].rows.size(), 16);

  const auto findings = comparison_findings(both.a, both.b);
  EXPECT_EQ(findings.front(),
            "Of 8 savings that both studies measured, 1 differ beyond the noise; by chance alone about "
            "one of twenty would.");
  EXPECT_EQ(
      findings.back(),
      "Different numbers of steps: stretch (4 steps in A, 8 in B). Later steps may gain more or less than "
      "the first "
      "ones.");
}

TEST(Comparison, NamesWhatSavesHereAndCostsThere) {
  BothStudies both;
  both.b.results.scenarios[0].orders[1].speedup = speedup(-20, -22, -18);
  const auto findings = comparison_findings(both.a, both.b);
  ASSERT_EQ(findings.size(), 2);
  EXPECT_EQ(
      findings[1],
      "These save time for certain in one study and cost time for certain in the other: Fiedler in falling.");
}

TEST(Comparison, IsWrittenWholeOrNotAtAll) {
  const test::TemporaryFolder folder;
  BothStudies both;
  const WrittenComparison written = write_comparison(both.a, both.b, folder.path() / "two.html");
  ASSERT_EQ(written.files.size(), 3);
  EXPECT_EQ(written.files.back(), folder.path() / "two.html");
  const std::string markdown = test::content_of(folder.path() / "two.md");
  EXPECT_TRUE(
      markdown.starts_with("# What orders save: Made-up 9000 (A) and Made-up 9000 (B)\n\n## What the orders "
                           "save in both studies\n"));
  EXPECT_NE(markdown.find("| falling, Fiedler | +25.0 (+24.0 … +26.0), saves | +25.0"), std::string::npos);
  EXPECT_LT(markdown.find("| falling, Fiedler |"), markdown.find("Of 8 savings"));
  EXPECT_EQ(test::content_of(folder.path() / "two.csv"), to_csv(written.tables));
  const std::string html = test::content_of(folder.path() / "two.html");
  EXPECT_EQ(html.find("{{"), std::string::npos);
  EXPECT_NE(html.find("<table id=\"comparison\">"), std::string::npos);

  std::filesystem::create_directory(folder.path() / "taken.html");
  EXPECT_THROW((void)write_comparison(both.a, both.b, folder.path() / "taken.html"), InputError);
  both.b.results.size = "2m";
  EXPECT_THROW((void)write_comparison(both.a, both.b, folder.path() / "other.html"), InputError);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"taken.html", "two.csv", "two.html", "two.md"}));
}

}  // namespace
}  // namespace meshorder
