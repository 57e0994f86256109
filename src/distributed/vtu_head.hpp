// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/layout.hpp"
#include "io/format.hpp"
#include <meshorder/mesh.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// An array of a .vtu file: what it holds, and where its values are.
struct VtuArray {
  enum class Role : std::uint8_t { points, types, offsets, connectivity, data };

  Role role;
  Association association;
  std::uint8_t type;  ///< number type, as the alternatives of Values
  Offset at;          ///< first byte in the file
  Offset row;         ///< bytes of a row
  Offset size;        ///< bytes
};

/// What the XML of a .vtu file counts.
struct VtuSizes {
  GlobalIndex vertices = 0;
  GlobalIndex cells = 0;
  GlobalIndex entries = 0;  ///< of the connectivity
  Offset bytes = 0;         ///< of the file
};

/// What the XML of a .vtu file says, and the words before its arrays.
struct VtuHead {
  VtuSizes sizes;
  std::vector<VtuArray> arrays;
};

/// Reads the XML of a file. Returns nothing for a file that is no .vtu file of one piece with raw appended
/// data in this machine's order of bytes and without compression. O(size of the XML).
///
/// @throws InputError for a file of that kind that is damaged: XML, counts that differ, bytes beyond its end
[[nodiscard]] std::optional<VtuHead> read_vtu_head(const std::string& path);

}  // namespace meshorder::distributed
