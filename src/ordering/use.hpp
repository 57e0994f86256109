// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace meshorder {

/// What a mesh is ordered for: the hot loop that shall run fast, or all of them alike.
enum class Workload : std::uint8_t {
  all,
  element,   ///< element forces: gather from and scatter to the vertices of each element
  spmv,      ///< products with the stiffness matrix, which iterative solvers repeat
  assembly,  ///< assembly of the stiffness matrix
  springs,   ///< a force along every edge
};

inline constexpr std::array kWorkloads{Workload::all, Workload::element, Workload::spmv, Workload::assembly,
                                       Workload::springs};

/// "all", "element", "spmv", "assembly", "springs".
std::string_view name(Workload use);

/// The use of that name. Throws InvalidArgument, which lists the known ones.
Workload parse_workload(std::string_view wanted);

}  // namespace meshorder
