// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/scenario.hpp"

#include "lab/scenario/vertex_choice.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace meshorder {
namespace {

using By = VertexChoice::By;

const std::string kSmallest = R"({
  "name": "small", "mesh": "grid-2",
  "material": {"model": "stvk", "young": 1e5, "poisson": 0.3, "density": 900},
  "integrator": {"time_step": 0.02},
  "steps": 7
})";

/// The smallest scenario with `members` in front.
std::string with(const std::string& members) { return "{" + members + "," + kSmallest.substr(1); }

/// The smallest scenario with `from` replaced.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = kSmallest;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string error_of(const std::string& text) {
  try {
    (void)parse_scenario(text, "my.json");
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "read without an error: " << text;
  return "";
}

TEST(Scenario, HasTheDocumentedDefaults) {
  const Scenario s = parse_scenario(kSmallest, "my.json");
  EXPECT_EQ(s.name, "small");
  EXPECT_EQ(s.mesh, "grid-2");
  EXPECT_EQ(s.steps, 7);
  EXPECT_EQ(s.longest_side, 0);
  EXPECT_EQ(s.vertex_order, "original");
  EXPECT_EQ(s.element_order, "original");
  EXPECT_EQ(s.model, MaterialModel::stvk);
  EXPECT_EQ(s.tangent, Tangent::exact);
  EXPECT_EQ(s.material.young, 1e5);
  EXPECT_EQ(s.material.poisson, 0.3);
  EXPECT_EQ(s.material.density, 900);
  EXPECT_EQ(s.implicit().time_step, 0.02);
  EXPECT_EQ(s.implicit().mass, Mass::lumped);
  EXPECT_EQ(s.implicit().mass_damping, 0);
  EXPECT_EQ(s.implicit().newton_iterations, 1);
  EXPECT_EQ(s.implicit().preconditioner, PreconditionerKind::jacobi);
  EXPECT_EQ(s.implicit().precision, MatrixPrecision::double_);
  EXPECT_EQ(s.implicit().solve.tolerance, 1e-6);
  EXPECT_EQ(s.implicit().solve.max_iterations, 10'000);
  EXPECT_TRUE(s.forces.empty());
  EXPECT_TRUE(s.motions.empty());
}

TEST(Scenario, ReadsEveryValue) {
  const Scenario s = parse_scenario(R"({
    "$schema": "scenario.schema.json", "name": "full", "title": "All of it", "mesh": "meshes/a.msh",
    "scale": {"longest_side": 2.5}, "order": {"vertices": "fiedler", "elements": "lexmax"},
    "material": {"model": "corotational", "tangent": "approximate", "young": 2e6, "poisson": -0.2, "density": 1,
      "regions": {"by": "label", "groups": [{"group": 3, "young": 5}, {"group": "bone", "density": 7}]}},
    "integrator": {"method": "backward-euler", "time_step": 0.5, "mass": "consistent",
      "rayleigh": {"alpha": 0.25, "beta": 0.125}, "gravity": [1, -2, 3],
      "newton": {"iterations": 4, "tolerance": 1e-3}},
    "solver": {"preconditioner": "multigrid", "tolerance": 1e-9, "max_iterations": 12, "precision": "single"},
    "forces": [{"on": "all", "newtons": [1, 2, 3]},
               {"on": {"set": "tip"}, "newtons": [0, 0, 1], "steps": [2, 5]}],
    "fixed": [{"on": {"label": -4}}, {"on": {"label": 1, "array": "cells:part"}, "steps": [3, 3]}],
    "prescribed": [{"on": {"box": [[0, 0, 0], [1, 0.5, 1]]}, "velocity": [0, 1, 0]},
                   {"on": {"nearest": [0.5, 1, 0]}, "velocity": [1, 0, 0], "steps": [1, 9]}],
    "steps": 10, "paper": ["steps", "material.model"], "notes": ["A note"]
  })",
                                    "folder/my.json");
  EXPECT_EQ(s.title, "All of it");
  EXPECT_EQ(s.mesh, "folder/meshes/a.msh");
  EXPECT_EQ(s.longest_side, 2.5);
  EXPECT_EQ(s.vertex_order, "fiedler");
  EXPECT_EQ(s.element_order, "lexmax");
  EXPECT_EQ(s.model, MaterialModel::corotational);
  EXPECT_EQ(s.tangent, Tangent::approximate);
  EXPECT_EQ(s.regions_by, "label");
  ASSERT_EQ(s.regions.size(), 2U);
  EXPECT_EQ(s.regions[0].region, "3");
  EXPECT_EQ(s.regions[0].material.young, 5);
  EXPECT_EQ(s.regions[0].material.density, 1);  // the material's own
  EXPECT_EQ(s.regions[1].region, "bone");
  EXPECT_EQ(s.regions[1].material.density, 7);
  EXPECT_EQ(s.implicit().mass, Mass::consistent);
  EXPECT_EQ(s.implicit().mass_damping, 0.25);
  EXPECT_EQ(s.implicit().stiffness_damping, 0.125);
  EXPECT_EQ(s.implicit().gravity, (Point{1, -2, 3}));
  EXPECT_EQ(s.implicit().newton_iterations, 4);
  EXPECT_EQ(s.implicit().newton_tolerance, 1e-3);
  EXPECT_EQ(s.implicit().preconditioner, PreconditionerKind::multigrid);
  EXPECT_EQ(s.implicit().solve.tolerance, 1e-9);
  EXPECT_EQ(s.implicit().solve.max_iterations, 12);
  EXPECT_EQ(s.implicit().precision, MatrixPrecision::single);
  ASSERT_EQ(s.forces.size(), 2U);
  EXPECT_EQ(s.forces[0].on.by, By::all);
  EXPECT_EQ(s.forces[0].steps.first, 1);
  EXPECT_EQ(s.forces[0].steps.last, kMaxIndex);
  EXPECT_EQ(s.forces[1].on.by, By::set);
  EXPECT_EQ(s.forces[1].on.name, "tip");
  EXPECT_EQ(s.forces[1].on.source_path, "forces[1].on");
  EXPECT_EQ(s.forces[1].steps.first, 2);
  EXPECT_EQ(s.forces[1].steps.last, 5);
  EXPECT_EQ(s.forces[1].newtons, (Point{0, 0, 1}));
  ASSERT_EQ(s.motions.size(), 4U);
  EXPECT_EQ(s.motions[0].on.label, -4);
  EXPECT_EQ(s.motions[0].on.name, "");
  EXPECT_EQ(s.motions[0].velocity, Point{});
  EXPECT_EQ(s.motions[1].on.name, "cells:part");
  EXPECT_EQ(s.motions[2].on.by, By::box);
  EXPECT_EQ(s.motions[2].on.high, (Point{1, 0.5, 1}));
  EXPECT_EQ(s.motions[3].on.by, By::nearest);
  EXPECT_EQ(s.motions[3].on.low, (Point{0.5, 1, 0}));
  EXPECT_EQ(s.motions[3].velocity, (Point{1, 0, 0}));
  EXPECT_EQ(s.paper, (std::vector<std::string>{"steps", "material.model"}));
}

/// A scenario of ADMM with `from` replaced.
std::string projective(const std::string& from = "", const std::string& to = "") {
  std::string text = R"({
    "name": "soft", "mesh": "grid-2", "scale": {"height": 0.5}, "place": {"bottom": [1, 2, 3]},
    "material": {"model": "strain", "stiffness": 300, "density": 900,
                 "regions": {"by": "label", "groups": [{"group": 3, "stiffness": 5}]}},
    "integrator": {"method": "admm", "time_step": 0.02, "gravity": [0, -1, 0], "iterations": 7,
                   "tolerance": 1e-3, "duals": "reset"},
    "solver": {"precision": "single"},
    "contact": {"obstacles": [{"half_space": {"point": [0, 1, 0], "normal": [0, 2, 0]}, "friction": 0.5},
                              {"sphere": {"center": [1, 2, 3], "radius": 4}},
                              {"bowl": {"center": [3, 2, 1], "axis": [0, 0, 1], "radius": 2, "thickness": 0.1, "opening": 60}},
                              {"surface": "floor.stl"}],
                "with_itself": true, "friction": 0.25, "solver": "uzawa", "tolerance": 1e-5,
                "max_iterations": 50},
    "start": [{"on": "all", "velocity": [1, 0, 0]}, {"on": {"nearest": [0, 0, 0]}, "at": [0.5, 0, 1]}],
    "steps": 7
  })";
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Scenario, ReadsEveryValueOfAdmm) {
  const Scenario s = parse_scenario(projective(), "folder/my.json");
  ASSERT_FALSE(s.is_implicit());
  EXPECT_EQ(s.height, 0.5);
  EXPECT_EQ(s.bottom, (Point{1, 2, 3}));
  const ProjectiveScenario& options = s.projective();
  EXPECT_EQ(options.model, LocalModel::strain);
  EXPECT_EQ(s.material.young, 300);
  EXPECT_EQ(s.material.poisson, 0);
  EXPECT_EQ(s.regions.at(0).material.young, 5);
  EXPECT_EQ(s.motion().time_step, 0.02);
  EXPECT_EQ(s.motion().gravity, (Point{0, -1, 0}));
  EXPECT_EQ(options.iterations, 7);
  EXPECT_EQ(options.tolerance, 1e-3);
  EXPECT_FALSE(options.keep_duals);
  EXPECT_EQ(options.precision, MatrixPrecision::single);
  ASSERT_EQ(options.obstacles.size(), 4U);
  EXPECT_EQ(options.obstacles[0].kind, ScenarioObstacle::Kind::half_space);
  EXPECT_EQ(options.obstacles[0].place, (Point{0, 1, 0}));
  EXPECT_EQ(options.obstacles[0].direction, (Point{0, 2, 0}));
  EXPECT_EQ(options.obstacles[0].friction, 0.5);
  EXPECT_EQ(options.obstacles[1].kind, ScenarioObstacle::Kind::sphere);
  EXPECT_EQ(options.obstacles[1].radius, 4);
  EXPECT_EQ(options.obstacles[1].friction, 0);
  EXPECT_EQ(options.obstacles[2].kind, ScenarioObstacle::Kind::bowl);
  EXPECT_EQ(options.obstacles[2].place, (Point{3, 2, 1}));
  EXPECT_EQ(options.obstacles[2].thickness, 0.1);
  EXPECT_EQ(options.obstacles[2].opening, 60);
  EXPECT_EQ(options.obstacles[3].kind, ScenarioObstacle::Kind::surface);
  EXPECT_EQ(options.obstacles[3].file, "folder/floor.stl");
  EXPECT_TRUE(options.contact.with_itself);
  EXPECT_EQ(options.contact.friction_with_itself, 0.25);
  EXPECT_EQ(options.contact_solver.tolerance, 1e-5);
  EXPECT_EQ(options.contact_solver.max_iterations, 50);
  ASSERT_EQ(s.start.size(), 2U);
  EXPECT_EQ(s.start[0].velocity, (Point{1, 0, 0}));
  EXPECT_FALSE(s.start[0].at);
  EXPECT_EQ(s.start[1].on.by, By::nearest);
  EXPECT_EQ(s.start[1].at, (Point{0.5, 0, 1}));
  EXPECT_FALSE(s.start[1].velocity);
}

TEST(Scenario, ErrorsOfAdmmNameThePlace) {
  struct Broken {
    const char *from, *to, *expected;
  };
  for (const Broken& broken : {
           Broken{R"("strain")", R"("corotational")",
                  "material.model: 'corotational' is unknown; known: springs"},
           Broken{R"("strain")", R"("springs")", "material: the key 'regions' is unknown"},
           Broken{R"("strain")", R"("stvk")", "material: the key 'stiffness' is unknown"},
           Broken{R"("stiffness": 300, )", "", "material: 'stiffness' is missing"},
           Broken{R"("group": 3, "stiffness")", R"("group": 3, "young")", "groups[0]: the key 'young'"},
           Broken{R"("admm")", R"("pbd")", "integrator.method: 'pbd'"},
           Broken{R"("iterations": 7)", R"("iterations": 0)", "integrator.iterations: is the number 0"},
           Broken{R"("tolerance": 1e-3)", R"("tolerance": 1)", "integrator.tolerance: is 1"},
           Broken{R"("reset")", R"("lost")", "integrator.duals: 'lost'"},
           Broken{R"("reset")", R"("reset", "acceleration": 5)", "the key 'acceleration' is unknown"},
           Broken{R"("single")", R"("half")", "solver.precision: 'half'"},
           Broken{R"("normal": [0, 2, 0])", R"("normal": [0, 0, 0])",
                  "obstacles[0].half_space.normal: has no direction"},
           Broken{R"("friction": 0.5)", R"("friction": -0.5)", "contact.obstacles[0].friction: is -0.5"},
           Broken{R"("surface": "floor.stl")", R"("friction": 1)",
                  "contact.obstacles[3]: does not say which"},
           Broken{R"("thickness": 0.1)", R"("thickness": 5)", "obstacles[2].bowl.thickness: is 5"},
           Broken{R"("thickness": 0.1)", R"("thickness": 4)", "obstacles[2].bowl.thickness: is 4"},
           Broken{R"("opening": 60)", R"("opening": 180)", "obstacles[2].bowl.opening: is 180"},
           Broken{R"("with_itself": true)", R"("with_itself": 1)",
                  "contact.with_itself: is the number 1; true or"},
           Broken{R"("uzawa")", R"("gauss-seidel")", "contact.solver: 'gauss-seidel'"},
           Broken{R"("max_iterations": 50)", R"("over_relaxation": 1.5)",
                  "the key 'over_relaxation' is unknown"},
           Broken{R"("height": 0.5)", R"("height": 0.5, "longest_side": 1)",
                  "scale: does not say which side to scale"},
           Broken{R"(, "at": [0.5, 0, 1])", "", "start[1]: has neither velocity nor at"},
       }) {
    const std::string message = error_of(projective(broken.from, broken.to));
    EXPECT_NE(message.find(broken.expected), std::string::npos) << message << "\n  lacks " << broken.expected;
  }
  EXPECT_NE(error_of(with(R"("contact": {})")).find("contact: is unknown to backward-euler"),
            std::string::npos);
}

TEST(Scenario, BuiltInOnesAreThePapers) {
  ASSERT_EQ(built_in_scenarios().size(), 9U);
  for (const BuiltInScenario& built_in : built_in_scenarios()) {
    const Scenario scenario = find_scenario(std::string(built_in.name));
    EXPECT_EQ(scenario.name, built_in.name);
    if (scenario.is_fluid()) continue;
    EXPECT_EQ(scenario.steps, 240);
    EXPECT_EQ(scenario.is_implicit(), scenario.mesh == "dragon" && scenario.name != "stretch");
  }
  EXPECT_EQ(find_scenario("stretch").projective().iterations, 20);
  EXPECT_EQ(find_scenario("unsquash").projective().iterations, 100);
  EXPECT_EQ(find_scenario("bowl").height, 0.07);
  EXPECT_EQ(find_scenario("bounce").mesh, "bunny");
  const Scenario falling = find_scenario("falling");
  EXPECT_EQ(falling.name, "falling");
  EXPECT_EQ(falling.mesh, "dragon");
  EXPECT_EQ(falling.steps, 240);
  EXPECT_EQ(falling.model, MaterialModel::corotational);
  EXPECT_EQ(falling.implicit().gravity, Point{});
  ASSERT_EQ(falling.forces.size(), 1U);
  EXPECT_EQ(falling.forces[0].newtons, (Point{-50, -50, -50}));
  EXPECT_EQ(falling.forces[0].on.by, By::all);
  EXPECT_EQ(falling.forces[0].steps.last, 1);
  EXPECT_TRUE(falling.motions.empty());
  const Scenario constrained = find_scenario("constrained");
  EXPECT_EQ(constrained.mesh, "dragon");
  EXPECT_EQ(constrained.steps, 240);
  EXPECT_EQ(constrained.model, MaterialModel::stvk);
  ASSERT_EQ(constrained.forces.size(), 1U);
  EXPECT_EQ(constrained.forces[0].newtons, (Point{0, -9.8, 0}));
  EXPECT_EQ(constrained.forces[0].steps.last, kMaxIndex);
  ASSERT_EQ(constrained.motions.size(), 1U);
  EXPECT_EQ(constrained.motions[0].on.by, By::nearest);
}

TEST(Scenario, FilesAreFoundByTheirPathsAndWhatIsNoneListsTheNames) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(find_scenario(folder.file("mine.json", kSmallest).string()).name, "small");
  try {
    (void)find_scenario((folder.path() / "absent.json").string());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("falling, constrained"), std::string::npos);
  }
}

TEST(Scenario, ErrorsNameTheFileThePlaceAndWhatWouldBeRight) {
  struct Broken {
    std::string text;
    std::vector<std::string> expected;
  };
  const std::vector<Broken> cases{
      {"{\n\"name\": \"a\",\n}", {"my.json:3:", "not JSON"}},
      {"[1, 2", {"my.json:1:", "not JSON"}},
      {"", {"my.json:1:", "not JSON"}},
      {kSmallest + "x", {"my.json:", "not JSON"}},
      {changed("0.02", "NaN"), {"my.json:4:", "not JSON"}},
      {changed("0.02", "1e999"), {"my.json: ", "not JSON", "1e999"}},
      {with(R"("steps": 8)"), {"my.json: ", "'steps' twice"}},
      {"[]", {"my.json: the file: is a list of 0", "object"}},
      {with(R"("speed": 1)"), {"my.json: the file: the key 'speed' is unknown", "scale"}},
      {changed(R"("steps": 7)", R"("notes": [])"), {"the file: 'steps' is missing"}},
      {changed("7", "0"), {"steps: is the number 0", "from 1 to"}},
      {changed("7", "2.5"), {"steps: is the number 2.5", "whole"}},
      {changed("7", "18446744073709551615"), {"steps: ", "whole number from 1"}},
      {changed("7", "\"many\""), {"steps: is the text 'many'"}},
      {changed("\"small\"", "\"\""), {"name: is an empty text"}},
      {changed("\"small\"", "\"a/b\""), {"name: 'a/b' contains a slash"}},
      {changed("0.02", "-0.02"), {"integrator.time_step: is -0.02", "above 0"}},
      {changed("0.3", "0.5"), {"material.poisson: is 0.5", "above -1 and below 0.5"}},
      {changed("1e5", "0"), {"material.young: is 0", "above 0"}},
      {changed("900", "[900]"), {"material.density: is a list of 1", "number"}},
      {changed("\"stvk\"", "\"rubber\""), {"material.model: 'rubber' is unknown", "neo-hookean"}},
      {changed("\"young\"", "\"tangent\": \"approximate\", \"young\""), {"material.tangent: 'approximate'"}},
      {changed("\"density\": 900", "\"regions\": {}"), {"material: 'density' is missing"}},
      {changed("900", R"(900, "regions": {"by": "x", "groups": []})"), {"material.regions.groups: has 0"}},
      {changed("900", R"(900, "regions": {"by": "x", "groups": [{"group": 1}, {"group": 1}]})"),
       {"material.regions.groups[1].group: already has an entry"}},
      {changed("900", R"(900, "regions": {"by": "x", "groups": [{"group": 1, "young": -1}]})"),
       {"material.regions.groups[0].young: is -1"}},
      {changed("0.02", R"(0.02, "gravity": [0, 1])"), {"integrator.gravity: has 2 entries", "give 3"}},
      {changed("0.02", R"(0.02, "gravity": [0, 1, "g"])"), {"integrator.gravity[2]: is the text 'g'"}},
      {changed("0.02", R"(0.02, "rayleigh": {"gamma": 1})"), {"integrator.rayleigh: the key 'gamma'"}},
      {with(R"("solver": {"tolerance": 1})"), {"solver.tolerance: is 1", "below 1"}},
      {with(R"("solver": {"preconditioner": "ilu"})"), {"solver.preconditioner: 'ilu'", "jacobi"}},
      {with(R"("scale": {"longest_side": 0})"), {"scale.longest_side: is 0"}},
      {with(R"("forces": [{"on": "some", "newtons": [1, 2, 3]}])"), {"forces[0].on: 'some' is unknown"}},
      {with(R"("forces": [{"newtons": [1, 2, 3]}])"), {"forces[0]: 'on' is missing"}},
      {with(R"("forces": [{"on": {}, "newtons": [1, 2, 3]}])"), {"forces[0].on: does not say"}},
      {with(R"("fixed": [{"on": {"set": "a", "label": 1}}])"), {"fixed[0].on: does not say"}},
      {with(R"("fixed": [{"on": {"set": "a", "array": "b"}}])"), {"fixed[0].on: has an array"}},
      {with(R"("fixed": [{"on": {"box": [[0, 0, 1], [1, 1, 0]]}}])"), {"fixed[0].on.box[1]: lies below"}},
      {with(R"("fixed": [{"on": {"nearest": [0, 1]}}])"), {"fixed[0].on.nearest: has 2 entries"}},
      {with(R"("fixed": [{"on": "all", "steps": [5, 4]}])"), {"fixed[0].steps[1]: is the number 4"}},
      {with(R"("fixed": [{"on": "all", "steps": [0, 4]}])"), {"fixed[0].steps[0]: is the number 0"}},
      {with(R"("prescribed": [{"on": "all"}])"), {"prescribed[0]: 'velocity' is missing"}},
      {with(R"("paper": ["material.colour"])"), {"paper[0]: 'material.colour' is not in the file"}},
  };
  for (const Broken& broken : cases) {
    const std::string message = error_of(broken.text);
    EXPECT_EQ(message.rfind("my.json:", 0), 0U) << message;
    for (const std::string& part : broken.expected) {
      EXPECT_NE(message.find(part), std::string::npos) << message << "\n  lacks " << part;
    }
  }
}

TEST(Scenario, NoCutOfAFileIsRead) {
  for (std::size_t size = 0; size < kSmallest.size(); ++size) {
    EXPECT_THROW((void)parse_scenario(kSmallest.substr(0, size), "my.json"), InputError) << size;
  }
}

// ---- choices of vertices

std::vector<Index> all_vertices(const Mesh& mesh) {
  std::vector<Index> all(mesh.points.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// The positions of the chosen vertices, sorted independently of their numbers.
std::multiset<Point> places(const Mesh& mesh, const VertexChoice& choice) {
  const std::vector<Index> chosen = choose_vertices(mesh, all_vertices(mesh), choice, "my.json");
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  std::multiset<Point> result;
  for (const Index v : chosen) result.insert(mesh.points[v]);
  return result;
}

VertexChoice choice_of(By by, std::string name = "", std::int64_t label = 0, Point low = {},
                       Point high = {}) {
  return {by, std::move(name), label, low, high, "fixed[0].on"};
}

TEST(VertexChoice, MeansTheSameVerticesHoweverTheyAreNumbered) {
  Mesh mesh = test::tetrahedral_bar(5);
  mesh.sets.push_back({"end", Association::cells, {0, 3}});
  Mesh other = mesh;
  apply_reordering(other, test::shuffled(mesh.vertex_count(), 3), test::shuffled_cells(mesh, 4));
  const std::int64_t label =
      std::get<std::vector<std::int32_t>>(find_array(mesh, kLabel, Association::vertices)->values)[2];
  for (const VertexChoice& choice :
       {choice_of(By::all), choice_of(By::set, "fixed"), choice_of(By::set, "end"),
        choice_of(By::label, "vertices:label", label), choice_of(By::box, "", 0, {0, 0, 0}, {0.5, 1, 1}),
        choice_of(By::nearest, "", 0, {0.3, 1, 0.5})}) {
    EXPECT_FALSE(places(mesh, choice).empty());
    EXPECT_EQ(places(mesh, choice), places(other, choice));
  }
}

TEST(VertexChoice, SetsLabelsBoxesAndNearestAreWhatBruteForceFinds) {
  Mesh mesh = test::tetrahedral_bar(4);
  const auto find = [&](const VertexChoice& choice) {
    return choose_vertices(mesh, all_vertices(mesh), choice, "my.json");
  };
  mesh.sets = {{"some", Association::vertices, {7, 2, 5}}, {"cells", Association::cells, {1}}};
  EXPECT_EQ(find(choice_of(By::set, "some")), (std::vector<Index>{2, 5, 7}));
  std::vector<Index> corners(mesh.cells[1].begin(), mesh.cells[1].end());
  std::sort(corners.begin(), corners.end());
  EXPECT_EQ(find(choice_of(By::set, "cells")), corners);

  mesh.data = {
      {"label", Association::cells, 1, std::vector<std::int32_t>(mesh.cells.shapes.size(), 6), {}, {}}};
  std::get<std::vector<std::int32_t>>(mesh.data[0].values)[1] = 9;
  EXPECT_EQ(find(choice_of(By::label, "label", 9)), corners);
  EXPECT_EQ(find(choice_of(By::label, "", 9)), corners);
  // labels of vertices take precedence over those of cells
  mesh.data.push_back(mesh.data[0]);
  mesh.data[1].association = Association::vertices;
  mesh.data[1].values = std::vector<std::int32_t>(mesh.points.size(), 3);
  std::get<std::vector<std::int32_t>>(mesh.data[1].values)[4] = 6;
  EXPECT_EQ(find(choice_of(By::label, "", 6)), std::vector<Index>{4});
  EXPECT_EQ(find(choice_of(By::label, "", 9)), corners);
  EXPECT_EQ(find(choice_of(By::label, "cells:label", 9)), corners);

  const BoundingBox box = bounding_box(mesh.points, all_vertices(mesh));
  std::vector<Index> expected;
  double least = 1e30;
  Index nearest = -1;
  for (const Index v : all_vertices(mesh)) {
    double square = 0;
    bool inside = true;
    for (int a = 0; a < 3; ++a) {
      const double at = (mesh.points[v][a] - box.low[a]) / (box.high[a] - box.low[a]);
      inside = inside && at >= 0.2 && at <= 0.9;
      square += std::pow((at - 0.1 * a) * (box.high[a] - box.low[a]), 2);
    }
    if (inside) expected.push_back(v);
    if (square < least) {
      least = square;
      nearest = v;
    }
  }
  if (!expected.empty()) {
    EXPECT_EQ(find(choice_of(By::box, "", 0, {0.2, 0.2, 0.2}, {0.9, 0.9, 0.9})), expected);
  }
  EXPECT_EQ(find(choice_of(By::nearest, "", 0, {0.0, 0.1, 0.2})), std::vector<Index>{nearest});
}

TEST(VertexChoice, OfEquallyNearOnesTakesTheSmallestCoordinates) {
  Mesh mesh;
  mesh.points = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(choose_vertices(mesh, all_vertices(mesh), choice_of(By::nearest, "", 0, {0.5, 0.5, 0}), "f"),
            (std::vector<Index>{2, 4}));
  const std::vector<Index> candidates{0, 1, 3};  // others cannot be chosen
  EXPECT_EQ(choose_vertices(mesh, candidates, choice_of(By::nearest, "", 0, {0.5, 0.5, 0}), "f"),
            std::vector<Index>{1});
}

TEST(VertexChoice, ErrorsListWhatTheMeshHas) {
  Mesh mesh = test::tetrahedral_bar(2);
  const auto message_of = [&](const VertexChoice& choice) -> std::string {
    try {
      (void)choose_vertices(mesh, all_vertices(mesh), choice, "my.json");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string no_set = message_of(choice_of(By::set, "tip"));
  EXPECT_NE(no_set.find("my.json: fixed[0].on: the mesh has no set 'tip'"), std::string::npos) << no_set;
  EXPECT_NE(no_set.find("fixed, part"), std::string::npos) << no_set;
  const std::string no_label = message_of(choice_of(By::label, "label", 12345));
  EXPECT_NE(no_label.find("fixed[0].on: nothing has the label 12345; labels of cells are"), std::string::npos)
      << no_label;
  const std::string no_array = message_of(choice_of(By::label, "colour", 1));
  EXPECT_NE(no_array.find("no array 'colour'"), std::string::npos) << no_array;
  const std::string empty = message_of(choice_of(By::box, "", 0, {2, 2, 2}, {3, 3, 3}));
  EXPECT_NE(empty.find("fixed[0].on: no vertex"), std::string::npos) << empty;
}

std::string water(std::string_view from = "", std::string_view to = "") {
  std::string text = R"({
    "name": "pool", "water": {"basin": [2, 3, 1], "column": [1, 1, 1], "spacing": 0.25, "wave": 0.1},
    "order": {"vertices": "auto", "elements": "lexmax", "every": 7},
    "material": {"model": "fluid", "density": 900, "viscosity": 1e-3},
    "integrator": {"method": "particle-fem", "time_step": 0.02, "gravity": [0, -9.81, 0], "courant": 0.4},
    "solver": {"tolerance": 1e-6, "max_iterations": 99}, "steps": 5})";
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(Scenario, ReadsWater) {
  const Scenario s = parse_scenario(water(), "pool.json");
  ASSERT_TRUE(s.is_fluid());
  EXPECT_FALSE(s.is_implicit());
  EXPECT_EQ(s.mesh, "");
  EXPECT_EQ(s.vertex_order, "auto");
  const FluidScenario& options = s.fluid();
  EXPECT_EQ(options.basin, (Point{2, 3, 1}));
  EXPECT_EQ(options.column, (Point{1, 1, 1}));
  EXPECT_EQ(options.spacing, 0.25);
  EXPECT_EQ(options.wave, 0.1);
  EXPECT_EQ(options.density, 900);
  EXPECT_EQ(options.viscosity, 1e-3);
  EXPECT_EQ(options.time_step, 0.02);
  EXPECT_EQ(options.gravity[1], -9.81);
  EXPECT_EQ(options.courant, 0.4);
  EXPECT_EQ(options.solve.tolerance, 1e-6);
  EXPECT_EQ(options.solve.max_iterations, 99);
  EXPECT_EQ(options.order_every, 7);
  EXPECT_EQ(s.motion().time_step, 0.02);
}

TEST(Scenario, ReportsFaultsOfWater) {
  struct Broken {
    const char* from;
    const char* to;
    const char* expected;
  };
  for (const Broken& broken :
       {Broken{R"("spacing": 0.25)", R"("spacing": 1e-9)", "water: a spacing of 1e-09 makes"},
        Broken{R"("column": [1, 1, 1])", R"("column": [3, 1, 1])", "water: the column is 3"},
        Broken{R"("courant": 0.4)", R"("courant": 4)", "water: the courant number is 4"},
        Broken{R"("wave": 0.1)", R"("depth": 1)", "water"},
        Broken{R"("model": "fluid")", R"("model": "stvk")", "material.model: 'stvk' is unknown"},
        Broken{R"("method": "particle-fem")", R"("method": "admm")", "belong together"},
        Broken{R"("steps": 5)", R"("steps": 5, "mesh": "dragon")", "mesh: is unknown to water"},
        Broken{R"("steps": 5)", R"("steps": 5, "forces": [])", "forces: is unknown to water"},
        Broken{R"("steps": 5)", R"("steps": 5, "contact": {})", "contact: is unknown to particle-fem"}}) {
    const std::string message = error_of(water(broken.from, broken.to));
    EXPECT_NE(message.find(broken.expected), std::string::npos) << message << "\n  lacks " << broken.expected;
  }
  EXPECT_NE(error_of(with(R"("order": {"every": 2})")).find("order.every: is for water"), std::string::npos);
}

}  // namespace
}  // namespace meshorder
