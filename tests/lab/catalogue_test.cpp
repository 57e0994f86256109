// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/models/catalogue.hpp"

#include "io/format.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

namespace meshorder {
namespace {
namespace fs = std::filesystem;

/// Sets an environment variable for the lifetime of the object.
class Variable {
 public:
  Variable(std::string name, const std::string& value) : name_(std::move(name)) {
    if (const char* const before = std::getenv(name_.c_str())) before_ = before;
    ::setenv(name_.c_str(), value.c_str(), 1);
  }
  ~Variable() {
    if (before_) {
      ::setenv(name_.c_str(), before_->c_str(), 1);
    } else {
      ::unsetenv(name_.c_str());
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  Variable(Variable&&) = delete;
  Variable& operator=(Variable&&) = delete;

 private:
  std::string name_;
  std::optional<std::string> before_;
};

/// An empty cache, and a PATH with only the programs that a test puts there.
class Catalogue : public testing::Test {
 protected:
  /// Installs a shell script, which can use only the shell's own commands.
  void install(const std::string& name, const std::string& script) const {
    fs::permissions(programs_.file(name, "#!/bin/sh\n" + script + "\n"), fs::perms::owner_all);
  }

  void keep_surface(const std::string& name) const {
    fs::create_directories(cache_.path() / "surfaces");
    (void)cache_.file("surfaces/" + name, "OFF\n");
  }

  /// The files in the models' folder, without locks.
  [[nodiscard]] std::vector<std::string> kept() const {
    std::vector<std::string> result;
    if (!fs::exists(models_folder())) return result;
    for (const auto& entry : fs::directory_iterator(models_folder())) {
      if (entry.path().extension() != ".lock") result.push_back(entry.path().filename().string());
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  [[nodiscard]] fs::path cache() const { return cache_.path(); }
  [[nodiscard]] fs::path programs() const { return programs_.path(); }

 private:
  test::TemporaryFolder cache_;
  test::TemporaryFolder programs_;
  Variable cache_variable_{"MESHORDER_CACHE", cache_.path().string()};
  Variable path_variable_{"PATH", programs_.path().string()};
};

constexpr const char* kWritesOneTetrahedron = R"(
echo "run" >> "${0%/*}/runs"
name=${2%.off}
printf '4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n' > "$name.1.node"
printf '1 4 0\n0 0 1 2 3\n' > "$name.1.ele"
)";

Model named(const std::string& name) {
  for (const Model& model : list_models()) {
    if (model.name == name) return model;
  }
  ADD_FAILURE() << name << " is not listed";
  return {};
}

template <class Exception>
std::string error_of(const std::string& model, const MakeOptions& options = {}) {
  try {
    (void)make_model(model, options);
  } catch (const Exception& error) {
    return error.what();
  }
  ADD_FAILURE() << model << " was made without an error";
  return "";
}

TEST_F(Catalogue, ListsModelsThatAreNotMadeWithoutPathAndCounts) {
  for (const std::string name : {"dragon", "armadillo", "bunny", "armadillo-300k", "grid", "ball", "torus"}) {
    const Model model = named(name);
    EXPECT_TRUE(model.path.empty()) << name;
    EXPECT_EQ(model.vertices, 0) << name;
    EXPECT_FALSE(model.description.empty()) << name;
  }
  EXPECT_TRUE(kept().empty());
}

TEST_F(Catalogue, MakesProceduralModelsInTheirSizeAndListsThem) {
  const Model grid = make_model("grid", {.size = 3});
  EXPECT_EQ(grid.name, "grid-3");
  EXPECT_TRUE(grid.procedural);
  EXPECT_EQ(grid.vertices, 4 * 4 * 4);
  EXPECT_EQ(grid.elements, 6 * 3 * 3 * 3);
  const Mesh mesh = read_mesh(grid.path);
  EXPECT_EQ(mesh.vertex_count(), grid.vertices);
  EXPECT_EQ(mesh.cell_count(), grid.elements);

  EXPECT_EQ(make_model("torus-2").elements, 6 * 16 * 2 * 2);
  EXPECT_EQ(make_model("ball-12").name, "ball-12");
  EXPECT_EQ(make_model("ball-2").name, "ball-2");
  std::vector<std::string> names;
  for (const Model& model : list_models()) {
    if (model.procedural) names.push_back(model.name);
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"grid", "grid-3", "ball", "ball-2", "ball-12", "torus", "torus-2"}));
  EXPECT_EQ(named("grid-3").vertices, grid.vertices);
  EXPECT_EQ(named("grid-3").path, grid.path);
}

TEST_F(Catalogue, LeavesWhatIsMadeUnlessForced) {
  std::vector<std::string> steps;
  MakeOptions options{.size = 2,
                      .progress = [&](std::string_view step, double) { steps.emplace_back(step); }};
  const fs::path path = make_model("grid", options).path;
  EXPECT_FALSE(steps.empty());
  EXPECT_EQ(steps.back(), "Done");
  const std::string content = test::content_of(path);

  steps.clear();
  fs::remove(models_folder() / ".grid-2.lock");
  EXPECT_EQ(make_model("grid", options).vertices, 27);
  EXPECT_TRUE(steps.empty());
  EXPECT_FALSE(fs::exists(models_folder() / ".grid-2.lock"));  // a read-only cache suffices

  fs::resize_file(path, 10);  // its first line is still whole
  EXPECT_EQ(make_model("grid", options).vertices, 27);
  EXPECT_NE(test::content_of(path), content);
  options.force = true;
  (void)make_model("grid", options);
  EXPECT_EQ(test::content_of(path), content);
}

TEST_F(Catalogue, RefusesUnknownNamesAndListsTheKnownOnes) {
  for (const std::string name :
       {"dragoon", "", "grid-", "grid-x", "grid-3x", "grid-0", "grid-03", "dragon-3"}) {
    const std::string message = error_of<InvalidArgument>(name);
    EXPECT_NE(message.find("'" + name + "'"), std::string::npos) << message;
    EXPECT_NE(message.find("armadillo-300k, grid"), std::string::npos) << message;
  }
  EXPECT_NE(error_of<InvalidArgument>("grid", {.size = 0}).find("at least 1"), std::string::npos);
  for (const std::string name : {"dragon", "grid-3"})
    EXPECT_NE(error_of<InvalidArgument>(name, {.size = 4}).find("leave out --size"), std::string::npos);
  EXPECT_TRUE(kept().empty());
}

TEST_F(Catalogue, NamesThePackageOfAMissingProgram) {
  EXPECT_EQ(error_of<InputError>("armadillo-300k"),
            "model armadillo-300k: tetgen is not installed; apt-get install tetgen");
  install("tetgen", "exit 1");
  const std::string message = error_of<InputError>("armadillo-300k");
  EXPECT_NE(message.find("apt-get is not installed"), std::string::npos) << message;
  EXPECT_NE(message.find((cache() / "surfaces").string()), std::string::npos) << message;
  EXPECT_TRUE(kept().empty());
}

TEST_F(Catalogue, ShowsTheLastLineOfAProgramThatFails) {
  keep_surface("armadillo.off");
  install("tetgen", "echo first\necho 'Two facets exactly intersect.' >&2\necho\nexit 3");
  EXPECT_EQ(error_of<InputError>("armadillo-300k"),
            "model armadillo-300k: tetgen failed with status 3: Two facets exactly intersect.; "
            "are memory and disk space left?");
  install("tetgen", "kill -9 $$");
  EXPECT_NE(error_of<InputError>("armadillo-300k").find("status 137: it printed nothing"), std::string::npos);
  install("tetgen", "exit 0");
  EXPECT_NE(error_of<InputError>("armadillo-300k").find("wrote no mesh"), std::string::npos);
  EXPECT_TRUE(kept().empty());
}

TEST_F(Catalogue, FailedDownloadLeavesNothing) {
  install("tetgen", "exit 1");
  install("dpkg-deb", "exit 1");
  install("tar", "exit 1");
  install("apt-get", "echo half > libcgal-demo_1_all.deb\necho 'E: no network'\nexit 100");
  const std::string message = error_of<InputError>("armadillo-300k");
  EXPECT_NE(message.find("apt-get failed with status 100: E: no network"), std::string::npos) << message;
  EXPECT_TRUE(kept().empty());
  EXPECT_FALSE(fs::exists(cache() / "surfaces/.surfaces.making"));
}

TEST_F(Catalogue, FillsASurfaceAndKeepsTheMesh) {
  keep_surface("armadillo.off");
  install("tetgen", kWritesOneTetrahedron);
  const Model model = make_model("armadillo-300k");
  EXPECT_FALSE(model.procedural);
  EXPECT_EQ(model.vertices, 4);
  EXPECT_EQ(model.elements, 1);
  EXPECT_EQ(read_mesh(model.path).cell_count(), 1);
  EXPECT_EQ(kept(), (std::vector<std::string>{"armadillo-300k.ele", "armadillo-300k.node"}));
}

TEST_F(Catalogue, ClearsWhatAnInterruptedRunLeft) {
  keep_surface("armadillo.off");
  install("tetgen", kWritesOneTetrahedron);
  fs::create_directories(models_folder() / ".armadillo-300k.making");
  (void)std::ofstream(models_folder() / ".armadillo-300k.making/armadillo-300k.off");
  EXPECT_EQ(make_model("armadillo-300k").vertices, 4);
  EXPECT_EQ(kept(), (std::vector<std::string>{"armadillo-300k.ele", "armadillo-300k.node"}));
}

TEST_F(Catalogue, OfTwoAtOnceOneMakesTheModel) {
  keep_surface("armadillo.off");
  install("tetgen", kWritesOneTetrahedron + std::string("while [ ${#i} -lt 2000 ]; do i=$i.; done"));
  {
    std::vector<std::jthread> makers;
    for (int i = 0; i < 4; ++i) {
      makers.emplace_back([] { EXPECT_EQ(make_model("armadillo-300k").vertices, 4); });
    }
  }
  EXPECT_EQ(test::content_of(programs() / "runs"), "run\n");
}

TEST_F(Catalogue, SaysWhenTheCacheCannotBeWritten) {
  const Variable file_as_cache("MESHORDER_CACHE", cache().string() + "/file");
  (void)std::ofstream(cache() / "file");
  const std::string message = error_of<InputError>("grid");
  EXPECT_NE(message.find("set MESHORDER_CACHE"), std::string::npos) << message;
}

TEST_F(Catalogue, FollowsTheUsualVariables) {
  const Variable none("MESHORDER_CACHE", "");
  const Variable home("HOME", "/home/someone");
  {
    const Variable xdg("XDG_CACHE_HOME", "/somewhere");
    EXPECT_EQ(models_folder(), "/somewhere/meshorder/models");
  }
  const Variable relative("XDG_CACHE_HOME", "not/absolute");
  EXPECT_EQ(models_folder(), "/home/someone/.cache/meshorder/models");
}

}  // namespace
}  // namespace meshorder
