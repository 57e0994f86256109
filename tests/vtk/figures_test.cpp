// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/figures.hpp"

#include "support/files.hpp"
#include "support/sample_results.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace meshorder;
using test::sample_results;
namespace fs = std::filesystem;

/// An environment variable for the running test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name), before_(std::getenv(name)) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { ::setenv(name_, before_.c_str(), 1); }
  Variable(const Variable&) = delete;
  Variable(Variable&&) = delete;
  Variable& operator=(const Variable&) = delete;
  Variable& operator=(Variable&&) = delete;

 private:
  const char* name_;
  std::string before_;
};

/// A picture, read by VTK's XML parser.
class Svg {
 public:
  explicit Svg(const std::string& text)
      : root_(
            vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromString(text.c_str()))) {
    if (root_ != nullptr) collect(root_);
  }

  [[nodiscard]] bool well_formed() const { return root_ != nullptr; }
  [[nodiscard]] std::string attribute(const char* name) const { return root_->GetAttribute(name); }
  /// The texts of the picture, without title and description.
  [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }
  [[nodiscard]] bool says(const std::string& text) const {
    return std::find(texts_.begin(), texts_.end(), text) != texts_.end();
  }
  [[nodiscard]] const std::multiset<std::string>& ids() const { return ids_; }
  /// Whether a horizontal line of that colour goes from left to right.
  [[nodiscard]] bool has_line(double left, double right, int colour) const {
    for (vtkXMLDataElement* const path : paths_) {
      const char* const painted = path->GetAttribute("stroke");
      if (painted == nullptr || colour_of(painted) != colour) continue;
      std::istringstream strokes(path->GetAttribute("d"));
      for (std::string from, to; strokes >> from >> to;) {
        Point a{};
        Point b{};
        if (std::sscanf(from.c_str(), "M%lf,%lf", a.data(), &a[1]) != 2) continue;
        if (std::sscanf(to.c_str(), "L%lf,%lf", b.data(), &b[1]) != 2) continue;
        if (a[1] == b[1] && std::abs(a[0] - left) < 0.1 && std::abs(b[0] - right) < 0.1) return true;
      }
    }
    return false;
  }
  /// The centres of marks of that point type and colour, 0xrrggbb.
  [[nodiscard]] std::vector<Point> marks(int type, int colour) const {
    std::vector<Point> centres;
    for (vtkXMLDataElement* const use : uses_) {
      const std::string mark = use->GetAttribute("xlink:href");
      const char* const painted = use->GetAttribute("color");
      if (!mark.ends_with("gpPt" + std::to_string(type - 1)) || painted == nullptr) continue;
      if (colour_of(painted) != colour) continue;
      Point centre{};
      EXPECT_EQ(std::sscanf(use->GetAttribute("transform"), "translate(%lf,%lf)", centre.data(), &centre[1]),
                2);
      centres.push_back(centre);
    }
    return centres;
  }

 private:
  /// 0xrrggbb of "rgb(  0, 114, 178)", -1 of a name
  static int colour_of(const char* painted) {
    std::array<int, 3> rgb{};
    if (std::sscanf(painted, "rgb(%d,%d,%d)", rgb.data(), &rgb[1], &rgb[2]) != 3) return -1;
    return 65536 * rgb[0] + 256 * rgb[1] + rgb[2];
  }

  void collect(vtkXMLDataElement* element) {
    const std::string name = element->GetName();
    if (name == "text") texts_.emplace_back(element->GetCharacterData());
    if (name == "use") uses_.push_back(element);
    if (name == "path") paths_.push_back(element);
    if (const char* const id = element->GetAttribute("id")) ids_.insert(id);
    for (int i = 0; i < element->GetNumberOfNestedElements(); ++i) collect(element->GetNestedElement(i));
  }

  vtkSmartPointer<vtkXMLDataElement> root_;
  std::vector<std::string> texts_;
  std::vector<vtkXMLDataElement*> uses_;
  std::vector<vtkXMLDataElement*> paths_;
  std::multiset<std::string> ids_;
};

class Figures : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_draw_figures()) GTEST_SKIP() << "gnuplot-nox is not installed";
  }

  static Svg drawn(const StudyResults& results, const std::string& name) {
    for (const Figure& figure : figures_of(results)) {
      if (figure.name == name) return Svg(figure.svg);
    }
    ADD_FAILURE() << "no figure " << name;
    return Svg("<svg/>");
  }
};

TEST_F(Figures, AreWellFormedScaleAndAreTheSameOnEveryRun) {
  const auto figures = figures_of(sample_results());
  const auto again = figures_of(sample_results());
  std::vector<std::string> names;
  std::vector<std::string> sections;
  std::multiset<std::string> ids;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const Figure& figure = figures[i];
    names.push_back(figure.name);
    sections.push_back(figure.section);
    EXPECT_EQ(figure.svg, again[i].svg);
    const Svg svg(figure.svg);
    ASSERT_TRUE(svg.well_formed()) << figure.name;
    EXPECT_EQ(svg.attribute("viewBox"), "0 0 520 " + svg.attribute("height"));
    EXPECT_TRUE(figure.svg.starts_with("<svg ")) << "can stand in a page";
    EXPECT_NE(figure.svg.find("<title>" + figure.title + "</title>"), std::string::npos);
    EXPECT_EQ(figure.svg.find("GNUPLOT"), std::string::npos) << "no program's version";
    EXPECT_FALSE(figure.caption.empty());
    ids.insert(svg.ids().begin(), svg.ids().end());
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"speedup", "spans-dragon", "misses-dragon", "phases", "prediction"}));
  EXPECT_EQ(sections, (std::vector<std::string>{"speedup", "spans", "caches", "phases", "prediction"}));
  EXPECT_FALSE(ids.empty());
  for (const std::string& id : ids) EXPECT_EQ(ids.count(id), 1) << id << " stands twice in one page";
}

TEST_F(Figures, OfSpeedupsHaveAMarkForEachOfOursAndThePapers) {
  const Svg svg = drawn(sample_results(), "speedup");
  // two scenarios and the key
  const auto original = svg.marks(5, 0xe69f00);
  const auto fiedler = svg.marks(7, 0x0072b2);
  const auto vf_fiedler = svg.marks(9, 0x009e73);
  EXPECT_EQ(original.size(), 3);
  ASSERT_EQ(fiedler.size(), 3);
  ASSERT_EQ(vf_fiedler.size(), 3);
  EXPECT_EQ(svg.marks(11, 0xcc79a7).size(), 3);
  EXPECT_EQ(svg.marks(13, 0xd55e00).size(), 0) << "the reference";
  const auto papers = svg.marks(6, 0x0072b2);
  ASSERT_EQ(papers.size(), 2);
  EXPECT_EQ(svg.marks(10, 0xcc79a7).size(), 0) << "the paper's text tells nothing of VF scrambled";

  // their positions: 25 and 12 % here, 26.7 and 12.1 % in the paper
  std::set<double> ours{fiedler[0][0], fiedler[1][0], fiedler[2][0]};
  const double pixels_of_percent = (papers[0][0] - papers[1][0]) / (26.7 - 12.1);
  EXPECT_GT(pixels_of_percent, 1);
  for (const double percent : {25.0, 12.0}) {
    const double expected = papers[0][0] + (percent - 26.7) * pixels_of_percent;
    EXPECT_TRUE(
        std::any_of(ours.begin(), ours.end(), [&](double x) { return std::abs(x - expected) < 0.1; }));
  }
  // the intervals: 24 to 26 % and 10 to 14 %
  for (const auto& [low, high] : {std::pair{24.0, 26.0}, {10.0, 14.0}}) {
    const double left = papers[0][0] + (low - 26.7) * pixels_of_percent;
    const double right = papers[0][0] + (high - 26.7) * pixels_of_percent;
    EXPECT_TRUE(svg.has_line(left, right, 0x0072b2)) << low << " to " << high;
  }
  for (const char* text : {"Original", "Fiedler", "VF Fiedler", "VF scrambled", "hollow: the paper",
                           "falling", "stretch", "Saved of the time of “Scrambled”, %"}) {
    EXPECT_TRUE(svg.says(text)) << text;
  }
}

TEST_F(Figures, OfSpansShareACurveWhereOrdersHaveTheSameSpans) {
  StudyResults results = sample_results();
  results.meshes[0].orders[4].span_histogram = results.meshes[0].orders[3].span_histogram;
  const Svg svg = drawn(results, "spans-dragon");
  EXPECT_TRUE(svg.says("Scrambled, VF scrambled"));
  EXPECT_EQ(svg.marks(11, 0xcc79a7).size(), 0);
  EXPECT_EQ(svg.marks(13, 0xd55e00).size(), 6 + 1) << "six bins and the key";
  EXPECT_EQ(svg.marks(7, 0x0072b2).size(), 2 + 1);
  EXPECT_TRUE(svg.says("Edges in a bin of 50"));
  EXPECT_TRUE(svg.says("Edge span, vertices"));
}

TEST_F(Figures, OfMissesAndPhasesNameWhatTheyShow) {
  const Svg misses = drawn(sample_results(), "misses-dragon");
  for (const char* text : {"this machine", "the paper's Xeon E5-1620 v4", "SpMV", "element force", "assembly",
                           "springs", "48 KB", "1 MB", "10 MB", "Scrambled", "VF Fiedler", "0 %"}) {
    EXPECT_TRUE(misses.says(text)) << text;
  }
  const Svg phases = drawn(sample_results(), "phases");
  EXPECT_EQ(std::count(phases.texts().begin(), phases.texts().end(), "VF Fiedler"), 2);
  for (const char* text :
       {"falling", "stretch", "by element", "system", "other", "Seconds, in % of those of “Scrambled”"}) {
    EXPECT_TRUE(phases.says(text)) << text;
  }
  EXPECT_FALSE(phases.says("collision")) << "there was none";
}

TEST_F(Figures, OfPredictionsHaveAMarkForEachOrderOfAMesh) {
  const Svg svg = drawn(sample_results(), "prediction");
  const auto spmv = svg.marks(7, 0x0072b2);
  ASSERT_EQ(spmv.size(), 4 + 1);
  // as predicted: on the diagonal of a square
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NEAR(spmv[i][0] - spmv[j][0], -(spmv[i][1] - spmv[j][1]), 0.1);
    }
  }
}

TEST_F(Figures, ShowHostileNamesAsTheyAre) {
  for (const std::string hostile : {"it's \"%d %%\" \\n <e> & x", "{/Bold f} $1 `ls` @h |_^",
                                    "id='x' xlink:href='#y'", "</text><script>", "]]>&amp;"}) {
    StudyResults results = sample_results();
    results.meshes[0].name = hostile;
    results.meshes[0].hierarchies[0].name = hostile;
    results.orderings[1].title = hostile;
    for (ScenarioRecord& scenario : results.scenarios) scenario.mesh = hostile;
    results.scenarios[0].name = hostile;
    for (const Figure& figure : figures_of(results)) {
      const Svg svg(figure.svg);
      ASSERT_TRUE(svg.well_formed()) << figure.name;
      if (figure.section != "prediction") {
        EXPECT_TRUE(svg.says(hostile)) << figure.name << " does not say " << hostile;
      }
      EXPECT_EQ(figure.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos);
    }
  }
}

TEST_F(Figures, ShortenLongNamesBetweenCharacters) {
  StudyResults results = sample_results();
  for (const auto& [name, expected] :
       {std::pair<std::string, std::string>{"scenario of forty-seven letters, all of them",
                                            "scenario of forty-seven…"},
        {"ééééééééééééééééééééééééééééé", "ééééééééééééééééééééééé…"},
        {"漢漢漢漢漢漢漢漢漢漢漢漢漢漢漢漢漢漢漢漢", "漢漢漢漢漢漢漢漢漢漢漢漢漢漢漢…"},
        {"%%%%%%%%%%%%%%%%%%%%%%%%%%%%%%", "%%%%%%%%%%%%%%%%…"}}) {
    results.scenarios[0].name = name;
    const Svg svg = drawn(results, "speedup");
    ASSERT_TRUE(svg.well_formed());
    EXPECT_TRUE(svg.says(expected)) << name << ": " << testing::PrintToString(svg.texts());
  }
}

TEST_F(Figures, HaveNamesOfTheirOwn) {
  StudyResults results = sample_results();
  results.meshes.push_back(results.meshes[0]);
  results.meshes.push_back(results.meshes[0]);
  results.meshes[0].name = "My mesh";
  results.meshes[1].name = "my-mesh";
  results.meshes[2].name = "my mesh 2";
  std::set<std::string> names;
  const auto figures = figures_of(results);
  for (const Figure& figure : figures) names.insert(figure.name);
  EXPECT_EQ(names.size(), figures.size());
  EXPECT_EQ(figures.size(), 9);
}

TEST_F(Figures, AreLeftOutWhereTheResultsHoldNothing) {
  EXPECT_TRUE(figures_of({}).empty());
  StudyResults results = sample_results();
  results.meshes.clear();
  results.scenarios[0].orders[3].runs.clear();
  results.scenarios[1].orders[3].runs.clear();
  const auto figures = figures_of(results);
  ASSERT_EQ(figures.size(), 1) << "without the reference";
  EXPECT_EQ(figures[0].name, "phases");
}

TEST_F(Figures, DoNotHeedTheUsersOwnSettings) {
  const test::TemporaryFolder home;
  (void)home.file(".gnuplot", "set title 'mine'\nset border 0\n");
  const auto expected = figures_of(sample_results());
  const Variable variable("HOME", home.path().string());
  EXPECT_EQ(figures_of(sample_results()).front().svg, expected.front().svg);
}

TEST(FiguresWithoutGnuplot, NameThePackage) {
  const test::TemporaryFolder folder;
  const Variable variable("PATH", folder.path().string());
  EXPECT_FALSE(can_draw_figures());
  try {
    (void)figures_of(sample_results());
    FAIL() << "drew without gnuplot";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("gnuplot-nox"), std::string::npos) << error.what();
  }
}

TEST(FiguresWithABrokenGnuplot, TellItsLastLine) {
  const test::TemporaryFolder folder;
  const fs::path program =
      folder.file("gnuplot", "#!/bin/sh\necho first\necho 'line 7: out of paper'\nexit 1\n");
  fs::permissions(program, fs::perms::owner_all);
  const Variable variable("PATH", folder.path().string());
  try {
    (void)figures_of(sample_results());
    FAIL() << "took a failure for a figure";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("line 7: out of paper"), std::string::npos) << error.what();
  }
  (void)folder.file("gnuplot", "#!/bin/sh\n: > figure.svg\n");
  EXPECT_THROW((void)figures_of(sample_results()), InputError) << "an empty picture";
}

}  // namespace
