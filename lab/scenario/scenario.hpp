// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "base/text.hpp"
#include "io/stream/file_path.hpp"
#include "kernels/material.hpp"
#include "kernels/regions.hpp"
#include "lab/admm/projective_dynamics.hpp"
#include "lab/fluid/particles.hpp"
#include "lab/implicit/backward_euler.hpp"
#include <meshorder/error.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder {

/// A choice of a mesh's vertices that does not depend on their numbering.
struct VertexChoice {
  enum class By : std::uint8_t {
    all,
    set,      ///< members of the set `name`, or the vertices of its cells
    label,    ///< vertices, or the vertices of cells, with the value `label` in the array `name`; an empty
              ///< name: in the label array of the vertices, else in that of the cells
    box,      ///< vertices in the box from `low` to `high`
    nearest,  ///< the vertex nearest to `low`
  };
  By by = By::all;
  std::string name;
  std::int64_t label = 0;
  Point low{}, high{};      ///< relative to the bounding box: 0 … 1 along each axis
  std::string source_path;  ///< the path of this choice in the scenario's file
};

/// A range of steps, both ends included, counted from 1.
struct StepRange {
  Index first = 1;
  Index last = kMaxIndex;
};

struct ScenarioForce {
  VertexChoice on;
  StepRange steps;
  Point newtons{};  ///< force on each vertex
};

struct ScenarioMotion {
  VertexChoice on;
  StepRange steps;
  Point velocity{};  ///< m/s
};

/// Initial positions and velocities of vertices. Without `at`, the vertices keep their positions in the mesh;
/// without `velocity`, they are at rest.
struct ScenarioStart {
  VertexChoice on;
  std::optional<Point> velocity;  ///< m/s
  std::optional<Point> at;        ///< one position for all, relative to the bounding box
};

/// An obstacle that the body must stay outside of, in the body's coordinates, m.
struct ScenarioObstacle {
  enum class Kind : std::uint8_t { half_space, sphere, bowl, surface };
  Kind kind = Kind::half_space;
  Point place{};                 ///< a point of the plane; the centre of a sphere or bowl
  Point direction{};             ///< the plane's normal; the bowl's axis
  double radius = 0.0;           ///< of the sphere, or of the middle of the bowl's wall
  double thickness = 0.0;        ///< of the bowl
  double opening = 0.0;          ///< half the opening angle of the bowl, degrees
  std::string file;              ///< path of a closed surface
  std::filesystem::path folder;  ///< the folder that `file` must lie in
  double friction = 0.0;         ///< Coulomb's coefficient
};

/// Options of ADMM projective dynamics, with descriptions of obstacles instead of obstacles.
struct ProjectiveScenario : ProjectiveOptions {
  LocalModel model = LocalModel::strain;
  MatrixPrecision precision = MatrixPrecision::double_;
  std::vector<ScenarioObstacle> obstacles;
};

/// Options of a fluid, and how often its particles are ordered.
struct FluidScenario : FluidOptions {
  Index order_every = 0;  ///< see FluidOrdering::every
};

/// A simulation: mesh, material, loads, integrator and solver. It does not depend on the order of vertices
/// and elements. A fluid makes its own mesh; it has no material and no loads except gravity. docs/simulate.md
/// describes the file.
struct Scenario {
  std::string file;  ///< the path it was read from
  std::string name;
  std::string title;  ///< may be empty
  std::string mesh;   ///< a model's name, or the path of a file; empty for a fluid
  /// The folder that the mesh must lie in; empty if the user named the mesh.
  std::optional<std::filesystem::path> mesh_folder;
  double longest_side = 0;      ///< of the scaled mesh's bounding box, m; 0: `height` counts
  double height = 0;            ///< side of that box along y, m; both 0: the mesh is not scaled
  std::optional<Point> bottom;  ///< position of the middle of the box's bottom, m
  std::string vertex_order = "original";
  std::string element_order = "original";

  MaterialModel model = MaterialModel::corotational;  ///< for backward Euler, like `tangent`
  Tangent tangent = Tangent::exact;
  /// For the models springs and strain, the stiffness (N/m, Pa) takes the place of Young's modulus.
  Material material;
  std::string regions_by;  ///< the array whose groups are the regions (see `grouping_by`); may be empty
  std::vector<RegionMaterial> regions;

  /// The options' forces and prescribed motions are empty; `forces` and `motions` below describe them.
  std::variant<ImplicitOptions, ProjectiveScenario, FluidScenario> integrator;
  std::vector<ScenarioStart> start;  ///< an entry overrides the entries before it
  std::vector<ScenarioForce> forces;
  std::vector<ScenarioMotion> motions;  ///< fixed vertices have the velocity 0
  Index steps = 240;

  std::vector<std::string> paper;  ///< paths, in the file, of the values that the paper gives
  std::vector<std::string> notes;

  /// Returns the file at `path`: `mesh` itself or, if `mesh` is a model's name, the model's path.
  [[nodiscard]] FilePath mesh_file(const std::string& path) const {
    return mesh_folder ? FilePath::in(*mesh_folder, path) : FilePath(path);
  }
  [[nodiscard]] bool is_implicit() const noexcept {
    return std::holds_alternative<ImplicitOptions>(integrator);
  }
  [[nodiscard]] bool is_projective() const noexcept {
    return std::holds_alternative<ProjectiveScenario>(integrator);
  }
  [[nodiscard]] bool is_fluid() const noexcept { return std::holds_alternative<FluidScenario>(integrator); }
  [[nodiscard]] const FluidScenario& fluid() const { return std::get<FluidScenario>(integrator); }
  [[nodiscard]] FluidScenario& fluid() { return std::get<FluidScenario>(integrator); }
  [[nodiscard]] const ImplicitOptions& implicit() const { return std::get<ImplicitOptions>(integrator); }
  [[nodiscard]] ImplicitOptions& implicit() { return std::get<ImplicitOptions>(integrator); }
  [[nodiscard]] const ProjectiveScenario& projective() const {
    return std::get<ProjectiveScenario>(integrator);
  }
  [[nodiscard]] ProjectiveScenario& projective() { return std::get<ProjectiveScenario>(integrator); }
  [[nodiscard]] const MotionOptions& motion() const {
    return std::visit([](const MotionOptions& options) -> const MotionOptions& { return options; },
                      integrator);
  }
};

/// Returns whether `mesh` is a model's name rather than a file's: with neither folder nor extension.
bool names_a_model(std::string_view mesh);

/// Returns the scenario that a file's text describes. `file` is its path: errors name it, and the mesh file
/// is relative to its folder. Throws Error, which names the value, for values that are unknown, missing, of
/// the wrong type or out of range. Does not read the mesh.
Scenario parse_scenario(std::string_view text, const std::string& file);

/// Reads a scenario's file. Throws Error like `parse_scenario`, or if there is no such file.
Scenario read_scenario(const std::filesystem::path& path);

/// A scenario that is built into the program, from `scenarios/`.
struct BuiltInScenario {
  std::string_view name;
  std::string_view text;
};
std::span<const BuiltInScenario> built_in_scenarios();

/// Returns the built-in scenario of that name, else reads that file. Throws Error like `read_scenario`; lists
/// the names if neither exists.
Scenario find_scenario(const std::string& name_or_file);

}  // namespace meshorder
