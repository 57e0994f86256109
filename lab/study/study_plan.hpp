// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenario/scenario.hpp"
#include "lab/study/results.hpp"
#include "ordering/method.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Returns the paper's five orderings (section 5): original, Fiedler, VF Fiedler, scrambled, VF scrambled.
std::vector<OrderingSpec> paper_orderings();

/// Returns the paper's orderings and the ordering that `meshorder order` makes.
std::vector<OrderingSpec> study_orderings();

/// Returns the study's ordering of that name or, for a name VERTICES/ELEMENTS, the ordering by these two
/// methods. Throws InvalidArgument for any other name.
OrderingSpec study_ordering(std::string_view name);

/// Options of a study.
struct StudyPlan {
  std::vector<std::string> scenarios;  ///< names or files
  std::string mesh;                    ///< a model's name or a file; empty: the scenarios' own meshes
  std::string size = "paper";          ///< see mesh_of_size
  std::vector<OrderingSpec> orderings = study_orderings();
  std::string reference = "scrambled";  ///< name of one of the orderings
  int runs = 3;
  int threads = 1;
  std::optional<Index> steps;              ///< instead of the scenarios' own steps
  std::optional<double> scenario_seconds;  ///< limit for a run in all orders, s; at least 8 steps are run
  double kernel_seconds = 12;              ///< time for running kernels on each mesh, s
  bool pin = true;                         ///< bind threads to processors
  OrderOptions ordering = {};
};

/// Returns a scenario's mesh in a study of that size; "paper": the scenario's own, `mesh`; "300k": the
/// armadillo with 291,000 vertices; "2m": a lattice with 1.9 million vertices. Throws InvalidArgument for any
/// other size.
std::string mesh_of_size(std::string_view size, const std::string& mesh);

/// Returns the names of the built-in scenarios that a study runs: those of the paper's simulators, and the
/// fluid, which the paper names as future work.
std::vector<std::string> study_scenarios();

/// Returns the spacing (m) of a fluid's particles in a study of that size: the fluid's own for "paper", else
/// the spacing for about 300,000 or two million particles. Throws InvalidArgument for any other size.
double spacing_of_size(std::string_view size, const FluidOptions& options);

/// Returns whether a scenario fits in memory at that size. ADMM's factored matrix of a solid with two million
/// vertices does not fit in a workstation's memory.
bool fits_in_memory(std::string_view size, const Scenario& scenario);

}  // namespace meshorder
