// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// The arrays of a page, packed as viewer/README.md describes: little endian, compressed by zlib, as base64.
/// Each array is in a script element; equal arrays share an element. `add…` returns the array's description
/// for the page's manifest.
class PackedArrays {
 public:
  /// Adds non-negative integers in the smallest type that holds them. Throws InvalidArgument if their number
  /// does not match the shape.
  nlohmann::ordered_json add(std::span<const std::uint32_t> numbers, std::vector<std::size_t> shape);
  nlohmann::ordered_json add(std::span<const Index> numbers);
  nlohmann::ordered_json add(std::span<const std::array<Index, 3>> triangles);

  /// Adds points, quantised to 65,536 steps along each side of their bounding box.
  nlohmann::ordered_json add_places(std::span<const Point> places);

  /// Adds the positions of vertices in each frame, as differences from the frame before. Positions are
  /// quantised to 1/4096 of the first frame's longest side, or coarser if the frames would not fit in 65,536
  /// steps. Throws InvalidArgument if frames differ in size.
  nlohmann::ordered_json add_frames(const std::vector<std::vector<Point>>& frames);

  /// Returns `<script type="text/plain" id="blob-1">…</script>` for each array.
  [[nodiscard]] const std::string& script_elements() const noexcept { return elements_; }

 private:
  nlohmann::ordered_json add_bytes(const std::vector<char>& bytes, std::string_view type,
                                   const std::vector<std::size_t>& shape, bool delta = false);

  std::string elements_;
  std::map<std::string, std::string> ids_;  ///< by the type, encoding and content of the elements
};

}  // namespace meshorder
