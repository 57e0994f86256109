// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/motion_file.hpp"

#include "io/npy.hpp"
#include "io/stream/scanner.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>

namespace meshorder {
namespace {

/// Returns the header. Its length does not depend on the number of frames, so that `commit` can replace it.
std::string header_of(Index frames, Index vertices) {
  return npy_header("<f4", std::array<std::int64_t, 3>{frames, vertices, 3});
}

/// Returns a message without all characters of numbers; messages that differ only in numbers become equal.
std::string without_numbers(std::string_view message) {
  constexpr std::string_view kOfNumbers = "0123456789.,+-einfa";
  std::string result;
  std::copy_if(message.begin(), message.end(), std::back_inserter(result),
               [&](char c) { return kOfNumbers.find(c) == std::string_view::npos; });
  return result;
}

constexpr std::int64_t kRow = 4 * sizeof(std::int32_t);

/// Returns the header. Its length does not depend on the number of rows, so that `commit` can replace it.
std::string surface_header(Offset rows) { return npy_header("<i4", std::array<std::int64_t, 2>{rows, 4}); }

}  // namespace

MotionFile::MotionFile(std::filesystem::path path, Index vertices)
    : file_(std::move(path)), vertices_(vertices) {
  file_.write(header_of(0, vertices));
}

void MotionFile::add(std::span<const Point> positions) {
  if (positions.size() != static_cast<std::size_t>(vertices_)) {
    throw InvalidArgument(
        fmt::format("a frame of {} vertices in a motion of {}", positions.size(), vertices_));
  }
  for (const Point& position : positions) {
    for (const double x : position) file_.binary(static_cast<float>(x), std::endian::little);
  }
  ++frames_;
}

void MotionFile::commit() {
  file_.write_over_start(header_of(frames_, vertices_));
  file_.commit();
}

Motion read_motion(const FilePath& path) {
  Scanner file(path);
  const NpyHeader header = read_npy_header(file);
  const auto& shape = header.shape;
  if (header.type != "<f4" || header.columns_first || shape.size() != 3 || shape[2] != 3) {
    file.fail_at_byte("is not a motion",
                      "it should hold frames × vertices × 3 numbers of type <f4 in C order");
  }
  const std::int64_t frames = shape[0];
  const std::int64_t vertices = shape[1];
  constexpr std::int64_t kBytes = 3 * sizeof(float);
  if (frames < 0 || vertices < 0 || vertices > kMaxIndex || (vertices == 0 && frames > 0) ||
      (frames > 0 && vertices > file.bytes_left() / kBytes / frames)) {
    file.fail_at_byte(fmt::format("should have {} frames of {} vertices, but only {} bytes follow", frames,
                                  vertices, file.bytes_left()),
                      "it may be cut short");
  }
  Motion motion{static_cast<Index>(vertices), {}};
  motion.frames.resize(frames);
  for (auto& frame : motion.frames) {
    frame.resize(motion.vertices);
    for (auto& position : frame) {
      for (float& x : position) {
        x = file.binary<float>("a coordinate", std::endian::little);
        if (!std::isfinite(x))
          file.fail_at_byte("has a position that is not finite", "the simulation diverged");
      }
    }
  }
  return motion;
}

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

bool add_warning(const std::string& warning, Index step, std::vector<WarningRecord>& warnings) {
  const auto known = std::find_if(warnings.begin(), warnings.end(), [&](const WarningRecord& w) {
    return without_numbers(w.first) == without_numbers(warning);
  });
  if (known != warnings.end()) {
    ++known->count;
    return false;
  }
  warnings.push_back({warning, step, 1});
  return true;
}

void add(StepReport report, double shape_distance, const Balance& balance, MotionRecord& record) {
  const std::vector<std::string> warnings = std::exchange(report.warnings, {});
  record.steps.push_back({std::move(report), shape_distance});
  record.balances.push_back(balance);
  for (const std::string& warning : warnings) add_warning(warning, index_size(record.steps), record.warnings);
}

}  // namespace meshorder
