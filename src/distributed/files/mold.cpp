// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/mold.hpp"

#include "distributed/files/text_store.hpp"
#include "io/vtk/vtu_document.hpp"
#include "io/vtu.hpp"
#include "mesh/values.hpp"

#include <bit>
#include <memory>
#include <string_view>
#include <utility>

namespace meshorder::distributed {

DataArray blank_row(std::string name, Association association, std::size_t type, Index components,
                    std::vector<std::string> component_names) {
  const auto blank = [&](auto& values) { values.resize(static_cast<std::size_t>(components)); };
  return {std::move(name),           association, components, values_of_type(type, blank), {},
          std::move(component_names)};
}

std::string mold_of(std::vector<DataArray> arrays, vtk::VtkMetadata metadata, bool in_order_of_vtk_9,
                    Notes& notes) {
  Mesh mold;
  mold.points.resize(1);
  mold.cells.push_back(Shape::vertex, std::vector<Index>{0});
  mold.data = std::move(arrays);
  metadata.vtu = VtuEncoding{.mode = VtuEncoding::Mode::base64,
                             .compressor = VtuEncoding::Compressor::none,
                             .order = std::endian::native,
                             .wide_headers = true};
  mold.format_metadata = std::make_shared<vtk::VtkMetadata>(std::move(metadata));
  TextStore store;
  vtk::write_vtu(mold, FilePath("mold.vtu", store), notes);
  std::string text = store.text();
  if (in_order_of_vtk_9) {
    // the writer sets this version for a mesh with higher-order hexahedra
    constexpr std::string_view kVersion = "version=\"1.0\"";
    text.replace(text.find(kVersion, text.find("<VTKFile")), kVersion.size(), "version=\"2.2\"");
  }
  return text;
}

}  // namespace meshorder::distributed
