// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/page.hpp"

#include "support/files.hpp"
#include "unpacked.hpp"
#include <meshorder/error.hpp>

#include <fstream>

namespace meshorder {
namespace {

using test::script_content;
using test::TemporaryFolder;
using test::unpacked;

/// A tetrahedron in two orders that also moves.
Page sample_page() {
  Page page;
  page.title = "What <b>my</b> \"mesh\" & I found";
  page.findings = {"Nothing & less"};
  page.results.orderings = {{"original", "Original", "original", "original"},
                            {"fiedler", "Fiedler</script><b>", "fiedler", "original"}};
  MeshRecord record;
  record.name = "drop";
  record.vertices = 70'001;
  page.results.meshes = {record};
  ScenarioRecord scenario;
  scenario.name = "falling";
  scenario.title = "Falls";
  scenario.mesh = "drop";
  page.results.scenarios = {scenario};
  const SurfaceView surface{{3, 5, 7, 70'000}, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  PageMesh mesh{"drop", surface, points, {}};
  mesh.orders.push_back({"original", {3, 5, 7, 70'000}, {2, {1, 0, 0, 1}}});
  mesh.orders.push_back({"fiedler", {9, 8, 70'000, 0}, {2, {1, 2, 2, 300}}});
  page.meshes = {mesh};
  std::vector<Point> moved = points;
  for (Point& point : moved) point[1] -= 0.5;
  page.motions = {{"falling", surface, {0, 5}, {points, moved}, {}, {}}};
  page.figures = {{"spans-drop", "spans", "Spans", "Edges by < span", "<svg/>"}};
  return page;
}

nlohmann::ordered_json manifest_of(const std::string& html) {
  return nlohmann::ordered_json::parse(script_content(html, "manifest"));
}

TEST(Page, CarriesItsDataExactly) {
  const std::string html = fill_page("{{data}}", sample_page());
  const auto manifest = manifest_of(html);
  EXPECT_EQ(manifest["orderings"][0].dump(), R"({"name":"original","title":"Original"})");
  const auto& mesh = manifest["meshes"][0];
  EXPECT_EQ(mesh["name"], "drop");
  EXPECT_EQ(mesh["vertices"], 70'001);
  EXPECT_EQ(unpacked(html, mesh["ranks"]["fiedler"]), (std::vector<std::uint32_t>{9, 8, 70'000, 0}));
  EXPECT_EQ(unpacked(html, mesh["ranks"]["original"]), (std::vector<std::uint32_t>{3, 5, 7, 70'000}));
  EXPECT_EQ(unpacked(html, mesh["sparsity"]["fiedler"]), (std::vector<std::uint32_t>{1, 2, 2, 300}));
  EXPECT_EQ(mesh["sparsity"]["fiedler"]["shape"].dump(), "[2,2]");
  EXPECT_EQ(unpacked(html, mesh["triangles"]),
            (std::vector<std::uint32_t>{0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0}));
  EXPECT_NEAR(test::unpacked_places(html, mesh["positions"])[1][0], 1, 1e-5);
  const auto& motion = manifest["motions"][0];
  EXPECT_EQ(motion["title"], "Falls");
  EXPECT_EQ(motion["mesh"], "drop");
  EXPECT_EQ(motion["steps"].dump(), "[0,5]");
  EXPECT_NEAR(test::unpacked_places(html, motion["frames"])[4 + 2][1], 0.5, 1e-4);
  EXPECT_TRUE(motion["obstacle"].is_null());
}

TEST(Page, CarriesTheObstacle) {
  Page page = sample_page();
  page.motions[0].obstacle = {{0, 1, 2}, {{0, 1, 2}}};
  page.motions[0].obstacle_points = {{0, -1, 0}, {1, -1, 0}, {0, -1, 1}};
  const std::string html = fill_page("{{data}}", page);
  const auto obstacle = manifest_of(html)["motions"][0]["obstacle"];
  EXPECT_EQ(unpacked(html, obstacle["triangles"]), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_NEAR(test::unpacked_places(html, obstacle["positions"])[2][2], 1, 1e-5);
}

TEST(Page, CarriesTheSurfacesOfAFluid) {
  Page page = sample_page();
  PageMotion& motion = page.motions[0];
  motion.surface = {};
  motion.frames = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  motion.surfaces = {{{4, 5, 6}, {{0, 1, 2}}}, {{1, 2, 3, 9}, {{0, 1, 2}, {1, 3, 2}}}};
  const std::string html = fill_page("{{data}}", page);
  const auto shown = manifest_of(html)["motions"][0];
  EXPECT_FALSE(shown.contains("frames"));
  EXPECT_EQ(unpacked(html, shown["surfaces"][0]["triangles"]), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(unpacked(html, shown["surfaces"][1]["triangles"]),
            (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
  EXPECT_NEAR(test::unpacked_places(html, shown["surfaces"][1]["positions"])[1][0], 2, 1e-4);
}

TEST(Page, CannotBeBrokenByNames) {
  const std::string html = fill_page("{{title}}|{{findings}}|{{figures spans}}|{{data}}", sample_page());
  EXPECT_TRUE(html.starts_with(
      "What &lt;b&gt;my&lt;/b&gt; &quot;mesh&quot; &amp; I found|<p>Nothing &amp; less</p>"));
  EXPECT_EQ(html.find("</script><b>"), std::string::npos);
  EXPECT_EQ(manifest_of(html)["orderings"][1]["title"], "Fiedler</script><b>");
  EXPECT_NE(html.find("alt=\"Edges by &lt; span\""), std::string::npos);
}

TEST(Page, ShowsCommandsInFindingsAsCode) {
  Page page;
  page.findings = {"`a < b` and `c`, but a lone ` stays"};
  EXPECT_EQ(fill_page("{{findings}}", page),
            "<p><code>a &lt; b</code> and <code>c</code>, but a lone ` stays</p>\n");
}

TEST(Page, ShowsFiguresInTheirSections) {
  const Page page = sample_page();
  EXPECT_EQ(fill_page("{{figures caches}}", page), "");
  const std::string html = fill_page("{{figures spans}}", page);
  EXPECT_TRUE(html.starts_with("<figure id=\"figure-spans-drop\">"));
  EXPECT_NE(html.find("src=\"data:image/svg+xml;base64,PHN2Zy8+\""), std::string::npos);
}

TEST(Page, SaysWhatThereIs) {
  Page page = sample_page();
  EXPECT_EQ(fill_page("{{has}}", page), "meshes scenarios motions");
  page.motions.clear();
  page.results.scenarios.clear();
  EXPECT_EQ(fill_page("{{has}}", page), "meshes");
}

TEST(Page, FillsEachPlaceholderOnce) {
  Page page;
  page.title = "{{has}}";
  EXPECT_EQ(fill_page("x{{title}}y {d} {{has}}.", page), "x{{has}}y {d} .");
}

TEST(Page, KnowsItsPlaceholders) {
  EXPECT_THROW((void)fill_page("x {{title", sample_page()), InvalidArgument);
  EXPECT_THROW((void)fill_page("{{tables}}", sample_page()), InvalidArgument);
  EXPECT_EQ(fill_page("{{table no-such-table}}", sample_page()), "");
}

TEST(Page, HoldsTheViewerAndThreeWithItsLicence) {
  const std::string html = to_html(sample_page());
  EXPECT_EQ(html.find("{{title}}"), std::string::npos);
  EXPECT_NE(html.find(viewer_sources().style), std::string::npos);
  EXPECT_NE(html.find(viewer_sources().scripts), std::string::npos);
  EXPECT_NE(html.find("Permission is hereby granted, free of charge"), std::string::npos);
  EXPECT_NE(html.find("REVISION=\"111\""), std::string::npos);
  // no source ends the element that contains it
  for (const std::string_view source : {viewer_sources().scripts, viewer_sources().three})
    EXPECT_EQ(source.find("</script"), std::string_view::npos);
  EXPECT_EQ(viewer_sources().style.find("</style"), std::string_view::npos);
}

TEST(ViewerSources, AreTheFilesToTheByte) {
  const std::string page = test::content_of(MESHORDER_VIEWER "/page.html");
  EXPECT_EQ(viewer_sources().page, page);
  EXPECT_EQ(viewer_sources().comparison, test::content_of(MESHORDER_VIEWER "/comparison.html"));
  const std::string three = test::content_of(MESHORDER_THREE_JS);
  EXPECT_TRUE(viewer_sources().three.ends_with(three));
}

TEST(Page, IsWrittenWholeOrNotAtAll) {
  const TemporaryFolder folder;
  write_page(sample_page(), folder.path() / "a.html");
  EXPECT_EQ(test::content_of(folder.path() / "a.html"), to_html(sample_page()));
  EXPECT_THROW(write_page(sample_page(), folder.path() / "missing" / "a.html"), InputError);
}

/// A mesh whose products take 3 ms as it is and 2 ms in another order; springs take longer in the other
/// order.
StudyResults timed() {
  StudyResults results;
  results.orderings = {{"original", "As it is", "original", "original"},
                       {"meshorder", "meshorder order", "auto", "auto"}};
  MeshRecord mesh;
  mesh.name = "a <mesh>";
  mesh.gain = 1.5;
  mesh.verdict = "`meshorder order` pays";
  for (const OrderingSpec& ordering : results.orderings) mesh.orders.emplace_back().ordering = ordering.name;
  mesh.orders[0].kernels[0].measured_ms = 3;
  mesh.orders[1].kernels[0].measured_ms = 2;
  mesh.orders[0].kernels[3].measured_ms = 1;
  mesh.orders[1].kernels[3].measured_ms = 4;
  mesh.orders[0].kernels[1].measured_ms = mesh.orders[1].kernels[1].measured_ms = 5;
  results.meshes = {mesh};
  return results;
}

TEST(Headlines, SayWhatIsGainedAndDrawEachKernelBeforeAndAfter) {
  const std::string html = headlines_of(timed());
  EXPECT_NE(html.find("<p class=\"answer\"><code>meshorder order</code> pays.</p>"), std::string::npos)
      << html;
  EXPECT_EQ(html.find("<h3>"), std::string::npos) << "the title names a single mesh";
  EXPECT_NE(html.find("<p class=\"gain\">1.5× "), std::string::npos) << html;
  EXPECT_NE(
      html.find(
          "<dt>SpMV</dt><dd><div class=\"before\"><span style=\"width:100.0%\"></span><b>3.00 ms</b> As it "
          "is</div><div class=\"after\"><span style=\"width:66.7%\"></span><b>2.00 ms</b> meshorder "
          "order</div></dd>"),
      std::string::npos)
      << html;
  EXPECT_NE(html.find("<dt>springs</dt><dd><div class=\"before\"><span style=\"width:25.0%\">"),
            std::string::npos);
  EXPECT_EQ(html.find("assembly"), std::string::npos) << "was not timed";
}

TEST(Headlines, HaveNoNumberThatIsInDoubtAndNoneOfStudies) {
  StudyResults results = timed();
  results.meshes[0].gain = 0;
  EXPECT_EQ(headlines_of(results).find("class=\"gain\""), std::string::npos);
  results.meshes[0].verdict.clear();
  EXPECT_EQ(headlines_of(results).find("class=\"answer\""), std::string::npos)
      << "no sentence of a full stop alone";
  results.scenarios.emplace_back();
  EXPECT_EQ(headlines_of(results), "");
  results = timed();
  results.meshes[0].orders.pop_back();
  results.meshes[0].verdict.clear();
  EXPECT_EQ(headlines_of(results), "") << "nothing to compare with";
  results.meshes = {timed().meshes[0], timed().meshes[0]};
  EXPECT_NE(headlines_of(results).find("<h3>a &lt;mesh&gt;</h3>"), std::string::npos);
}

}  // namespace
}  // namespace meshorder
