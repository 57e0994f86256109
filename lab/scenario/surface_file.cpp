// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/surface_file.hpp"

#include "io/npy.hpp"
#include "io/stream/scanner.hpp"

#include <fmt/format.h>

#include <bit>
#include <utility>

namespace meshorder {
namespace {

constexpr std::int64_t kRow = 4 * sizeof(std::int32_t);

/// Returns the header, whose length does not depend on the number of rows: it is written again at the end.
std::string surface_header(Offset rows) { return npy_header("<i4", std::array<std::int64_t, 2>{rows, 4}); }

}  // namespace

SurfaceFile::SurfaceFile(std::filesystem::path path) : file_(std::move(path)) {
  file_.write(surface_header(0));
}

void SurfaceFile::add(std::span<const std::array<Index, 3>> triangles) {
  for (const std::array<Index, 3>& triangle : triangles) {
    file_.binary(frames_, std::endian::little);
    for (const Index v : triangle) file_.binary(v, std::endian::little);
  }
  ++frames_;
  rows_ += static_cast<Offset>(triangles.size());
}

void SurfaceFile::commit() {
  file_.write_over_start(surface_header(rows_));
  file_.commit();
}

std::vector<std::vector<std::array<Index, 3>>> read_surfaces(const FilePath& path, std::size_t frames,
                                                             Index vertices) {
  Scanner file(path);
  const NpyHeader header = read_npy_header(file);
  if (header.type != "<i4" || header.columns_first || header.shape.size() != 2 || header.shape[1] != 4)
    file.fail_at_byte("is not a surface in motion", "it should hold rows × 4 numbers of type <i4 in C order");
  if (header.shape[0] < 0 || header.shape[0] > file.bytes_left() / kRow)
    file.fail_at_byte(
        fmt::format("should have {} rows, but only {} bytes follow", header.shape[0], file.bytes_left()),
        "it may be cut short");
  std::vector<std::vector<std::array<Index, 3>>> surfaces(frames);
  const auto number = [&](Index end) {
    const auto value = file.binary<std::int32_t>("a number", std::endian::little);
    if (value < 0 || value >= end)
      file.fail_at_byte(fmt::format("has the number {}, not one of 0 to {}", value, end - 1),
                        "it is of another motion");
    return value;
  };
  for (std::int64_t row = 0; row < header.shape[0]; ++row) {
    std::array<Index, 3>& triangle = surfaces[number(index_size(surfaces))].emplace_back();
    for (Index& v : triangle) v = number(vertices);
  }
  return surfaces;
}

}  // namespace meshorder
