// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/use.hpp"

#include "base/error.hpp"

#include <string>

namespace meshorder {

std::string_view name(Workload use) {
  switch (use) {
    case Workload::all:
      return "all";
    case Workload::element:
      return "element";
    case Workload::spmv:
      return "spmv";
    case Workload::assembly:
      return "assembly";
    case Workload::springs:
      return "springs";
  }
  return "";
}

Workload parse_workload(std::string_view wanted) {
  std::string known;
  for (const Workload use : kWorkloads) {
    if (name(use) == wanted) return use;
    known += (known.empty() ? "" : ", ") + std::string(name(use));
  }
  throw InvalidArgument("unknown use '" + std::string(wanted) + "'; known are " + known);
}

}  // namespace meshorder
