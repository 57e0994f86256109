// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/point.hpp"
#include "base/text.hpp"
#include "kernels/material.hpp"
#include "kernels/regions.hpp"
#include "lab/admm/projective_dynamics.hpp"
#include "lab/implicit/backward_euler.hpp"

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

/// Some vertices of a mesh, named so that it does not matter how they are numbered.
struct VertexChoice {
  enum class By : std::uint8_t {
    all,
    set,      ///< members of the set `name`, or the vertices of its cells
    label,    ///< those with the value `label` in the array `name`, or the vertices of cells with it; without
              ///< a name those that have this label, or where there are none the vertices of cells with it
    box,      ///< those from `low` to `high`
    nearest,  ///< the one nearest to `low`
  };
  By by = By::all;
  std::string name;
  std::int64_t label = 0;
  Point low{}, high{};  ///< relative to the bounding box: 0 … 1 along each axis
  std::string where;    ///< its place in the scenario's file
};

/// Steps are counted from 1; both ends count.
struct StepRange {
  Index first = 1;
  Index last = kMaxIndex;
};

struct ScenarioForce {
  VertexChoice on;
  StepRange steps;
  Point newtons{};  ///< on each vertex
};

struct ScenarioMotion {
  VertexChoice on;
  StepRange steps;
  Point velocity{};  ///< m/s
};

/// Where vertices are when the motion starts, and how fast; what is not given stays.
struct ScenarioStart {
  VertexChoice on;
  std::optional<Point> velocity;  ///< m/s
  std::optional<Point> at;        ///< all at one place, relative to the bounding box
};

/// What the body must stay outside of, in metres where the body is.
struct ScenarioObstacle {
  enum class Kind : std::uint8_t { half_space, sphere, bowl, surface };
  Kind kind = Kind::half_space;
  Point place{};           ///< a point of the plane; the centre
  Point direction{};       ///< the plane's normal; the bowl's axis
  double radius = 0.0;     ///< of the sphere, of the bowl's middle
  double thickness = 0.0;  ///< of the bowl
  double opening = 0.0;    ///< the bowl's, half of it, degrees
  std::string file;        ///< of a closed surface
  double friction = 0.0;   ///< Coulomb's coefficient
};

/// ADMM projective dynamics, its options without obstacles, which are bound to the mesh.
struct ProjectiveScenario : ProjectiveOptions {
  LocalModel model = LocalModel::strain;
  MatrixPrecision precision = MatrixPrecision::exact;
  std::vector<ScenarioObstacle> obstacles;
};

/// What is simulated: a mesh, what it is made of, what happens to it and how that is computed. Nothing in it
/// depends on the order of vertices or elements. docs/simulate.md describes its file.
struct Scenario {
  std::string file;  ///< where it comes from
  std::string name;
  std::string title;
  std::string mesh;             ///< a model's name, or the path of a file
  double longest_side = 0;      ///< of the bounding box that the mesh is scaled to, m; 0: as it is
  double height = 0;            ///< or the box's side along y
  std::optional<Point> bottom;  ///< where the middle of the box's bottom is put, m
  std::string vertex_order = "original";
  std::string element_order = "original";

  MaterialModel model = MaterialModel::corotational;  ///< of the implicit method, as the tangent
  Tangent tangent = Tangent::exact;
  /// Springs and strain have their stiffness (N/m, Pa) in the place of Young's modulus.
  Material material;
  std::string regions_by;  ///< the array whose groups the regions are (see `grouping_by`); else empty
  std::vector<RegionMaterial> regions;

  /// Forces and prescribed motions in it are empty: they are these.
  std::variant<ImplicitOptions, ProjectiveScenario> integrator;
  std::vector<ScenarioStart> start;  ///< of two for one vertex the later counts
  std::vector<ScenarioForce> forces;
  std::vector<ScenarioMotion> motions;  ///< fixed vertices have the velocity 0
  Index steps = 240;

  std::vector<std::string> paper;  ///< paths in the file of what is the paper's
  std::vector<std::string> notes;

  [[nodiscard]] bool is_implicit() const noexcept {
    return std::holds_alternative<ImplicitOptions>(integrator);
  }
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

// Names in scenario files and on the command line.
template <>
struct EnumNames<PreconditionerKind> {
  static constexpr std::string_view kind = "preconditioner";
  static constexpr std::array names{std::pair{PreconditionerKind::jacobi, "jacobi"},
                                    std::pair{PreconditionerKind::block_jacobi, "block-jacobi"},
                                    std::pair{PreconditionerKind::incomplete_cholesky, "incomplete-cholesky"},
                                    std::pair{PreconditionerKind::multigrid, "multigrid"}};
};

template <>
struct EnumNames<MatrixPrecision> {
  static constexpr std::string_view kind = "precision";
  static constexpr std::array names{std::pair{MatrixPrecision::exact, "double"},
                                    std::pair{MatrixPrecision::single, "single"}};
};

template <>
struct EnumNames<MaterialModel> {
  static constexpr std::string_view kind = "material model";
  static constexpr std::array names{std::pair{MaterialModel::corotational, "corotational"},
                                    std::pair{MaterialModel::stvk, "stvk"},
                                    std::pair{MaterialModel::neo_hookean, "neo-hookean"}};
};

template <>
struct EnumNames<LocalModel> {
  static constexpr std::string_view kind = "material model";
  static constexpr std::array names{
      std::pair{LocalModel::springs, "springs"}, std::pair{LocalModel::strain, "strain"},
      std::pair{LocalModel::stvk, "stvk"}, std::pair{LocalModel::neo_hookean, "neo-hookean"},
      std::pair{LocalModel::log_neo_hookean, "log-neo-hookean"}};
};

template <>
struct EnumNames<ContactSolverKind> {
  static constexpr std::string_view kind = "contact solver";
  static constexpr std::array names{std::pair{ContactSolverKind::uzawa, "uzawa"},
                                    std::pair{ContactSolverKind::gauss_seidel, "gauss-seidel"}};
};

template <>
struct EnumNames<Tangent> {
  static constexpr std::string_view kind = "tangent";
  static constexpr std::array names{std::pair{Tangent::exact, "exact"},
                                    std::pair{Tangent::approximate, "approximate"},
                                    std::pair{Tangent::projected, "projected"}};
};

template <>
struct EnumNames<Mass> {
  static constexpr std::string_view kind = "mass";
  static constexpr std::array names{std::pair{Mass::lumped, "lumped"},
                                    std::pair{Mass::consistent, "consistent"}};
};

/// Whether a scenario's mesh, or what a user gives in its place, names a model rather than a file: it has no
/// extension.
bool names_a_model(std::string_view mesh);

/// The scenario of a file's text. `file` is named in errors, and a mesh file's path is relative to its
/// folder. Throws Error, which names the path in the file, for whatever is unknown, missing, of the wrong
/// type or out of range. The mesh is not looked at.
Scenario parse_scenario(std::string_view text, const std::string& file);

/// Reads a scenario's file. Throws Error like `parse_scenario`, and when there is no such file.
Scenario read_scenario(const std::filesystem::path& path);

/// A scenario that is part of the program, from `scenarios/` of its sources.
struct BuiltInScenario {
  std::string_view name;
  std::string_view text;
};
std::span<const BuiltInScenario> built_in_scenarios();

/// The scenario of that name, or else of that file. Throws Error that lists the names when it is neither.
Scenario find_scenario(const std::string& name_or_file);

}  // namespace meshorder
