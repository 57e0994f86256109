// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/study_plan.hpp"

#include "base/text.hpp"
#include <meshorder/error.hpp>

#include <cmath>

namespace meshorder {

std::vector<OrderingSpec> paper_orderings() {
  return {{"original", "Original", "original", "original"},
          {"fiedler", "Fiedler", "fiedler", "original"},
          {"vf-fiedler", "VF Fiedler", "fiedler", "fiedler"},
          {"scrambled", "Scrambled", "scrambled", "original"},
          {"vf-scrambled", "VF scrambled", "scrambled", "scrambled"}};
}

std::vector<OrderingSpec> study_orderings() {
  std::vector<OrderingSpec> orderings = paper_orderings();
  orderings.push_back({"meshorder", "meshorder order", "auto", "auto"});
  return orderings;
}

OrderingSpec study_ordering(std::string_view name) {
  for (const OrderingSpec& ordering : study_orderings()) {
    if (ordering.name == name) return ordering;
  }
  const auto slash = name.find('/');
  const std::string vertices(name.substr(0, slash));
  const std::string elements(slash == std::string_view::npos ? "" : name.substr(slash + 1));
  if (!method_named(vertex_methods(), vertices) || !method_named(element_methods(), elements)) {
    throw InvalidArgument("unknown ordering '" + std::string(name) + "'; known: " +
                          join(study_orderings(), [](const auto& ordering) { return ordering.name; }) +
                          ", and VERTICES/ELEMENTS, see meshorder methods");
  }
  return {vertices + "-" + elements, vertices + "/" + elements, vertices, elements};
}

std::string mesh_of_size(std::string_view size, const std::string& mesh) {
  if (size == "paper") return mesh;
  if (size == "300k") return "armadillo-300k";
  if (size == "2m") return "grid-122";
  throw InvalidArgument("unknown size '" + std::string(size) + "'; known: paper, 300k and 2m");
}

std::vector<std::string> study_scenarios() {
  return {"falling", "constrained", "stretch", "unsquash", "bowl", "bounce", "splash"};
}

double spacing_of_size(std::string_view size, const FluidOptions& options) {
  if (size == "paper") return options.spacing;
  const double particles = mesh_of_size(size, "") == "grid-122" ? 2e6 : 3e5;
  const Point& column = options.column;
  return std::cbrt(column[0] * column[1] * column[2] / particles);
}

bool fits_in_memory(std::string_view size, const Scenario& scenario) {
  return size != "2m" || !scenario.is_projective();
}

}  // namespace meshorder
