// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/mesh.hpp"

#include <algorithm>

namespace meshorder {

std::string_view name(Association association) {
  return association == Association::vertices ? "vertices" : "cells";
}

Index row_count(const DataArray& array) {
  const auto entries = std::visit([](const auto& values) { return values.size(); }, array.values);
  return static_cast<Index>(entries / static_cast<std::size_t>(array.components));
}

const DataArray* find_array(const Mesh& mesh, std::string_view name, Association association) {
  const auto found = std::find_if(mesh.data.begin(), mesh.data.end(), [&](const DataArray& array) {
    return array.association == association && array.name == name;
  });
  return found == mesh.data.end() ? nullptr : &*found;
}

}  // namespace meshorder
