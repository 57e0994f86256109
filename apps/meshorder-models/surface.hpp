// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace meshorder::models {

/// Exception: an input cannot be used; the message names the file, the fault and what would be right.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A set of triangles that may intersect, leave holes or be degenerate.
struct Surface {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `points`
};

/// Reads an ASCII OFF file of triangles. Skips `#` comments, and colours after vertices and faces.
///
/// The result has at least one triangle, finite coordinates and indices in range. Throws `InputError`, with
/// the line of a fault in the text. Linear in the size of the file.
Surface read_off(const std::filesystem::path& file);

/// Throws `InputError` if `file` is a folder or its folder does not exist: `write_off` would fail.
void check_writable_place(const std::filesystem::path& file);

/// Writes an ASCII OFF file whose coordinates read back to the same bits.
///
/// Writes beside `file` and renames, so that `file` is never incomplete.
/// Throws `std::runtime_error` if the file cannot be written.
void write_off(const std::filesystem::path& file, const Surface& surface);

/// Lengths of a wrap. Each is given by a ratio: the diagonal of the surface's bounding box divided by the
/// length. Larger ratios give finer wraps.
struct WrapOptions {
  double alpha_ratio = 200;    ///< diagonal / alpha; alpha bounds the size of the wrap's triangles
  double offset_ratio = 2500;  ///< diagonal / offset; the wrap is about one offset outside the surface
};

/// Returns a closed, oriented, manifold surface without self-intersections around the given triangles,
/// which may intersect each other and leave holes smaller than alpha.
///
/// The same input gives the same output in every run. Throws `InputError` if all triangles are degenerate, or
/// if the diagonal of the box is not in 1e-100 … 1e100; `std::runtime_error` if the wrap is empty. CGAL's
/// alpha wrap: Portaneri et al., "Alpha wrapping with an offset", ACM TOG 41(4), 2022. Time and memory grow
/// with the square of `alpha_ratio`.
Surface wrap(const Surface& surface, const WrapOptions& options);

}  // namespace meshorder::models
