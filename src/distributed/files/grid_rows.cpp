// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/grid_rows.hpp"

#include "distributed/comm/number_types.hpp"
#include "distributed/files/mold.hpp"
#include "io/vtk/vtk.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <variant>

namespace meshorder::distributed {
namespace {

/// The whole mesh in the form of a .vtu file.
class WholeGrid {
 public:
  WholeGrid(const Mesh& mesh, Notes& notes)
      : context_(mesh, notes, vtk::NamePlace::xml), cells_(context_.cells()) {
    // in the order of the file that `xml` returns
    for (const Association association : {Association::vertices, Association::cells}) {
      for (const DataArray* const array : context_.arrays) {
        if (array->association == association) arrays_.push_back(array);
      }
    }
    for (const DataArray* const array : arrays_) {
      if (const auto* const texts = std::get_if<std::vector<std::string>>(&array->values)) {
        for (const std::string& text : *texts) places_.emplace(text.substr(0, text.find('\0')), 0);
      }
    }
    std::int32_t place = 0;
    for (auto& [text, number] : places_) number = place++;
  }

  /// Returns a .vtu file of one point and one cell that has one row of each array.
  [[nodiscard]] std::string xml() const {
    std::vector<DataArray> rows;
    for (const DataArray* const array : arrays_) {
      rows.push_back(blank_row(array->name, array->association, array->values.index(), array->components,
                               array->component_names));
    }
    vtk::VtkMetadata metadata = context_.metadata;
    metadata.float_points = context_.points_are_floats();
    return mold_of(std::move(rows), std::move(metadata),
                   std::any_of(context_.types.begin(), context_.types.end(), vtk::is_higher_order_hexahedron),
                   context_.notes);
  }

  [[nodiscard]] std::vector<std::string> texts() const {
    std::vector<std::string> result;
    for (const auto& [text, place] : places_) result.push_back(text);
    return result;
  }

  /// Returns the bytes of the k-th array of the file.
  [[nodiscard]] std::vector<std::byte> bytes(std::size_t k) const {
    if (k < arrays_.size()) {
      const auto* const texts = std::get_if<std::vector<std::string>>(&arrays_[k]->values);
      if (texts == nullptr) return bytes_of_values(arrays_[k]->values);
      std::vector<std::int32_t> places;
      places.reserve(texts->size());
      for (const std::string& text : *texts) places.push_back(places_.at(text.substr(0, text.find('\0'))));
      return raw_bytes<std::int32_t>(places);
    }
    if (k > arrays_.size()) return raw_bytes<std::uint8_t>(context_.types);  // the file's last array
    const std::vector<Point>& points = context_.mesh.points;
    const std::span<const double> numbers(points.front().data(), 3 * points.size());
    if (!context_.points_are_floats()) return raw_bytes(numbers);
    return raw_bytes<float>(std::vector<float>(numbers.begin(), numbers.end()));
  }

  /// Returns whether the k-th array of the file is on vertices.
  [[nodiscard]] bool is_on_vertices(std::size_t k) const {
    return k < arrays_.size() ? arrays_[k]->association == Association::vertices : k == arrays_.size();
  }

  [[nodiscard]] const Cells& cells() const noexcept { return cells_; }

 private:
  vtk::WriteContext context_;
  const Cells& cells_;
  std::vector<const DataArray*> arrays_;
  std::map<std::string, std::int32_t> places_;  ///< position of each text in `texts()`
};

}  // namespace

GridRows scattered_grid(const Communicator& communicator, const Mesh& mesh, Notes& notes) {
  GridRows grid;
  const auto whole = communicator.together([&] {
    std::shared_ptr<WholeGrid> result;
    if (!communicator.is_root()) return result;
    result = std::make_shared<WholeGrid>(mesh, notes);
    grid.xml = result->xml();
    grid.texts = result->texts();
    return result;
  });
  const std::vector<GlobalIndex> counts = communicator.broadcast(
      whole ? std::vector<GlobalIndex>{mesh.vertex_count(), mesh.cell_count()} : std::vector<GlobalIndex>{});
  grid.vertices = Layout::even(counts[0], communicator.size());
  grid.cells = Layout::even(counts[1], communicator.size());

  Rows rows;
  std::vector<Dispatch> dispatches;
  communicator.at_root([&] {
    const Cells& cells = whole->cells();
    rows.offsets = cells.offsets;
    rows.entries.assign(cells.vertices.begin(), cells.vertices.end());
    for (Offset c = 0; c < rows.size(); ++c) dispatches.push_back({grid.cells.owner(c), c});
  });
  grid.cell_vertices = send_rows(communicator, rows, dispatches);
  grid.rows = [&communicator, whole, vertices = grid.vertices, cells = grid.cells](std::size_t k) {
    std::vector<std::byte> bytes;
    std::vector<Offset> starts(static_cast<std::size_t>(communicator.size()) + 1, 0);
    communicator.at_root([&] {
      bytes = whole->bytes(k);
      const Layout& layout = whole->is_on_vertices(k) ? vertices : cells;
      const Offset width = std::ssize(bytes) / layout.size();
      for (int rank = 0; rank < communicator.size(); ++rank)
        starts[static_cast<std::size_t>(rank) + 1] = layout.end(rank) * width;
    });
    return communicator.exchange(std::span<const std::byte>(bytes), starts).values;
  };
  return grid;
}

}  // namespace meshorder::distributed
