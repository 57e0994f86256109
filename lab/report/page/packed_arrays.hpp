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

/// The numbers that a page carries, packed as viewer/README.md says: little endian, compressed by zlib, as
/// base64 in a script element each; equal arrays share one. What `add…` returns describes the array in the
/// page's manifest.
class PackedArrays {
 public:
  /// Whole numbers, none negative, in the smallest type that holds all. Throws InvalidArgument when they are
  /// not as many as the shape says.
  nlohmann::ordered_json add(std::span<const std::uint32_t> numbers, std::vector<std::size_t> shape);
  nlohmann::ordered_json add(std::span<const Index> numbers);
  nlohmann::ordered_json add(std::span<const std::array<Index, 3>> triangles);

  /// Coordinates in 65,536 steps along each side of their bounding box.
  nlohmann::ordered_json add_places(std::span<const Point> places);

  /// Places of the same vertices in each frame, as differences from the frame before. A step is one
  /// 4,096th of the first frame's longest side, which is not seen and leaves less to compress, or wider where
  /// the frames do not fit in 65,536 of them. Throws InvalidArgument when frames differ in size.
  nlohmann::ordered_json add_frames(const std::vector<std::vector<Point>>& frames);

  /// `<script type="text/plain" id="blob-1">…</script>` for each array.
  [[nodiscard]] const std::string& script_elements() const noexcept { return elements_; }

 private:
  nlohmann::ordered_json add_bytes(const std::vector<char>& bytes, std::string_view type,
                                   const std::vector<std::size_t>& shape, bool delta = false);

  std::string elements_;
  std::map<std::string, std::string> ids_;  ///< by what the elements hold
};

}  // namespace meshorder
