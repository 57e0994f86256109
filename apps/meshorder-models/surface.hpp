// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace meshorder::models {

/// An input cannot be used; the message names the file, what is wrong and what would be right.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A set of triangles that may intersect, leave holes or be degenerate.
struct Surface {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `points`
};

/// Reads an ASCII OFF file of triangles. Colours after a vertex or a face and `#` comments are skipped.
///
/// The result has at least one triangle, finite coordinates and indices in range.
/// Throws `InputError` with the line of the first fault. Linear in the size of the file.
Surface read_off(const std::filesystem::path& file);

/// Throws `InputError` if `write_off` could not write `file`: it is a folder, or its folder does not
/// exist.
void check_writable_place(const std::filesystem::path& file);

/// Writes an ASCII OFF file whose coordinates read back to the same bits.
///
/// Writes beside `file` and renames, so that `file` is never incomplete.
/// Throws `std::runtime_error` if the file cannot be written.
void write_off(const std::filesystem::path& file, const Surface& surface);

}  // namespace meshorder::models
