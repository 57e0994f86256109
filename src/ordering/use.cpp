// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/use.hpp"

#include "base/error.hpp"

#include <string>

namespace meshorder {

std::string_view name(Use use) {
  switch (use) {
    case Use::all:
      return "all";
    case Use::element:
      return "element";
    case Use::spmv:
      return "spmv";
    case Use::assembly:
      return "assembly";
    case Use::springs:
      return "springs";
  }
  return "";
}

Use use_of(std::string_view wanted) {
  std::string known;
  for (const Use use : kUses) {
    if (name(use) == wanted) return use;
    known += (known.empty() ? "" : ", ") + std::string(name(use));
  }
  throw InvalidArgument("unknown use '" + std::string(wanted) + "'; known are " + known);
}

}  // namespace meshorder
