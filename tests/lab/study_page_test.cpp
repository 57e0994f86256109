// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/study_page.hpp"

#include "io/npy.hpp"
#include "lab/study/results_json.hpp"
#include "mesh/procedural.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include "support/sample_results.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace meshorder {
namespace {

using test::TemporaryFolder;

/// A study's folder with a ball that falls past a triangle for 20 steps, in two orders.
class StudyPage : public testing::Test {
 protected:
  StudyPage() {
    std::filesystem::create_directories(folder.root() / "data");
    results.began = "2026-11-20T17:30:00Z";
    results.reference = "scrambled";
    results.machine = test::sample_results().machine;
    results.orderings = {{"original", "Original", "original", "original"},
                         {"scrambled", "Scrambled", "scrambled", "original"}};
    MeshRecord record;
    record.name = "ball";
    record.file = "data/ball.vtu";
    record.vertices = ball.vertex_count();
    results.meshes = {record};
    ScenarioRecord scenario;
    scenario.name = "falling";
    scenario.title = "A ball falls";
    scenario.method = "backward-euler";
    scenario.material = "corotational";
    scenario.mesh = "ball";
    scenario.fingerprint = "5eed";
    scenario.steps = 20;
    scenario.turn = 5;
    scenario.frame_steps = {0, 5, 10, 15, 20};
    results.scenarios = {scenario};

    write_mesh(ball, folder.mesh("ball"));
    write_npy(Permutation::identity(ball.vertex_count()).old_to_new(),
              folder.vertex_order("ball", "original"));
    write_npy(order.old_to_new(), folder.vertex_order("ball", "scrambled"));
    MotionFile motion(folder.motion("falling"), ball.vertex_count());
    for (int frame = 0; frame < 5; ++frame) {
      std::vector<Point> places = ball.points;
      for (Point& place : places) place[1] -= frame;
      motion.add(places);
    }
    motion.commit();
    Mesh triangle;
    triangle.points = {{0, -9, 0}, {1, -9, 0}, {0, -9, 1}};
    triangle.cells.push_back(Shape::triangle, std::vector<Index>{0, 1, 2});
    write_mesh(triangle, folder.obstacles("falling"));
  }

  Page page(const PageDetail& detail = {}) { return page_of(folder, results, notes, {}, detail); }

  /// The message of the Error from making the page.
  std::string error() {
    try {
      (void)page();
    } catch (const InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return "";
  }

  [[nodiscard]] bool noted(const std::string& text) const {
    return std::any_of(notes.begin(), notes.end(),
                       [&](const std::string& note) { return note.find(text) != std::string::npos; });
  }

  TemporaryFolder temporary;
  StudyFolder folder{temporary.path()};
  Mesh ball = make_ball({.size = 6});
  Permutation order = test::shuffled(ball.vertex_count(), 3);
  StudyResults results;
  Notes notes;
};

TEST_F(StudyPage, ShowsTheMeshInItsOrders) {
  const Page made = page();
  ASSERT_EQ(made.meshes.size(), 1U);
  const PageMesh& mesh = made.meshes[0];
  EXPECT_EQ(mesh.surface.triangles.size(), 6 * 36 * 2U);
  ASSERT_EQ(mesh.orders.size(), 2U);
  EXPECT_EQ(mesh.orders[0].ranks, mesh.surface.vertices);
  EXPECT_EQ(mesh.orders[1].ordering, "scrambled");
  for (std::size_t i = 0; i < mesh.surface.vertices.size(); ++i) {
    const Index v = mesh.surface.vertices[i];
    EXPECT_EQ(mesh.orders[1].ranks[i], order.old_to_new()[v]);
    EXPECT_EQ(mesh.points[i], ball.points[v]);
  }
  EXPECT_EQ(mesh.orders[1].sparsity.side, 192);
}

TEST_F(StudyPage, PlaysTheMotionWithItsObstacle) {
  const Page made = page({.motion_triangles = 200});
  ASSERT_EQ(made.motions.size(), 1U);
  const PageMotion& motion = made.motions[0];
  EXPECT_LE(motion.surface.triangles.size(), 200U);
  EXPECT_EQ(motion.steps, (std::vector<Index>{0, 5, 10, 15, 20}));
  ASSERT_EQ(motion.frames.size(), 5U);
  const Point& rest = ball.points[motion.surface.vertices[7]];
  EXPECT_NEAR(motion.frames[4][7][0], rest[0], 1e-6);
  EXPECT_NEAR(motion.frames[4][7][1], rest[1] - 4, 1e-6);
  EXPECT_EQ(motion.obstacle.triangles.size(), 1U);
  EXPECT_EQ(motion.obstacle_points[0][1], -9);
}

TEST_F(StudyPage, ThinsOutFramesButKeepsTheEnds) {
  EXPECT_EQ(page({.frames = 3}).motions[0].steps, (std::vector<Index>{0, 10, 20}));
  EXPECT_EQ(page({.frames = 2}).motions[0].steps, (std::vector<Index>{0, 20}));
}

TEST_F(StudyPage, LeavesOutWhatIsMissingAndSaysSo) {
  std::filesystem::remove(folder.obstacles("falling"));
  EXPECT_TRUE(page().motions[0].obstacle.triangles.empty());
  std::filesystem::remove(folder.vertex_order("ball", "original"));
  EXPECT_EQ(page().meshes[0].orders.size(), 1U);
  EXPECT_TRUE(noted("ball-original.vertices.npy"));
  std::filesystem::remove(folder.motion("falling"));
  EXPECT_TRUE(page().motions.empty());
  EXPECT_TRUE(noted("falling-motion.npy"));
  std::filesystem::remove(folder.mesh("ball"));
  EXPECT_TRUE(page().meshes.empty());
  EXPECT_TRUE(noted("ball.vtu"));
}

TEST_F(StudyPage, NamesTheFileThatIsBroken) {
  const auto original = folder.vertex_order("ball", "original");
  for (const std::vector<std::int32_t>& broken :
       {std::vector<std::int32_t>{0, 1}, std::vector<std::int32_t>(ball.vertex_count(), 0)}) {
    write_npy(broken, original);
    EXPECT_NE(error().find("ball-original.vertices.npy"), std::string::npos);
  }
  std::filesystem::remove(original);
  MotionFile(folder.motion("falling"), 3).commit();
  EXPECT_NE(error().find("falling-motion.npy: a motion of 3 vertices"), std::string::npos);
  MotionFile(folder.motion("falling"), ball.vertex_count()).commit();
  EXPECT_NE(error().find("falling-motion.npy: a motion of 0 frames where 5 were kept"), std::string::npos);
  std::ofstream(folder.motion("falling")) << "no array";
  EXPECT_NE(error().find("falling-motion.npy"), std::string::npos);
  std::ofstream(folder.mesh("ball")) << "no mesh";
  EXPECT_NE(error().find("ball.vtu"), std::string::npos);
}

TEST_F(StudyPage, SaysHowFarItIs) {
  std::vector<double> fractions;
  (void)page_of(folder, results, notes,
                [&](std::string_view, double fraction) { fractions.push_back(fraction); });
  EXPECT_EQ(fractions.size(), 3U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_LT(fractions.back(), 1);
}

TEST_F(StudyPage, IsWrittenWithItsTables) {
  write_results(results, folder.results());
  const WrittenReport report = write_report(folder);
  ASSERT_GE(report.files.size(), 3U);
  EXPECT_EQ(report.files.back(), folder.page());
  for (const auto& file : report.files) EXPECT_TRUE(std::filesystem::is_regular_file(file)) << file;
  const Page made = page_of(folder, read_results(folder.results()), notes);
  EXPECT_EQ(test::content_of(folder.page()), to_html(made));
  EXPECT_EQ(test::content_of(folder.tables(".csv")), to_csv(made.tables));
  EXPECT_TRUE(test::content_of(folder.tables(".md")).starts_with("# What the order of a mesh is worth"));
}

TEST_F(StudyPage, BeginsWithTheTableOfWhatOrdersSave) {
  for (const char* const name : {"original", "scrambled"}) {
    ScenarioOrderRecord record;
    record.ordering = name;
    RunRecord run;
    run.began = "2026-11-20T17:30:00Z";
    run.step_seconds.assign(20, 1);
    record.runs = {run};
    results.scenarios[0].orders.push_back(record);
  }
  write_results(results, folder.results());
  (void)write_report(folder);
  const std::string tables = test::content_of(folder.tables(".md"));
  const std::size_t title = tables.find("\n\n");
  EXPECT_EQ(tables.substr(title, 25), "\n\n## What the orders save");
  const std::size_t sentence = tables.find("This study is shorter");
  EXPECT_GT(sentence, tables.find("| falling |"));
  EXPECT_LT(sentence, tables.find("## Table 2"));
  const std::string html = test::content_of(folder.page());
  EXPECT_LT(html.find("<table id=\"summary\">"), html.find("This study is shorter"));
}

TEST_F(StudyPage, IsWrittenWholeOrNotAtAll) {
  write_results(results, folder.results());
  std::filesystem::create_directory(folder.page());
  EXPECT_THROW((void)write_report(folder), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder.tables(".md")));
  EXPECT_FALSE(std::filesystem::exists(folder.tables(".csv")));
}

}  // namespace
}  // namespace meshorder
