// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/packed_arrays.hpp"

#include "io/stream/base64.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace meshorder {
namespace {

constexpr double kSteps = 65535;       // the largest number of 16 bits
constexpr double kStepsOfBody = 4096;  // along the longest side of a body that moves
constexpr double kNoExtent = 1;        // a flat extent may have any step

std::string compressed(const std::vector<char>& bytes) {
  std::string result(compressBound(bytes.size()), '\0');
  uLongf size = result.size();
  if (compress2(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                bytes.size(), Z_BEST_COMPRESSION) != Z_OK) {
    throw std::runtime_error("the page's data could not be compressed");
  }
  result.resize(size);
  return result;
}

/// Appends the `width` lowest bytes of a number, the lowest first.
void append(std::vector<char>& bytes, std::uint32_t number, int width) {
  for (int i = 0; i < width; ++i) bytes.push_back(static_cast<char>((number >> (8 * i)) & 0xFFU));
}

/// How whole numbers encode coordinates: x = offset + scale · number.
struct Quantisation {
  Point offset{};
  Point scale{};

  [[nodiscard]] std::uint32_t number(const Point& point, std::size_t axis) const {
    return static_cast<std::uint32_t>(
        std::clamp(std::round((point[axis] - offset[axis]) / scale[axis]), 0.0, kSteps));
  }
};

struct Extent {
  Point low{};
  Point side{};
};

Extent extent_of(std::span<const Point> places) {
  Point low;
  Point high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(std::numeric_limits<double>::lowest());
  for (const Point& place : places) {
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], place[c]);
      high[c] = std::max(high[c], place[c]);
    }
  }
  if (places.empty()) low = high = {};
  return {low, {high[0] - low[0], high[1] - low[1], high[2] - low[2]}};
}

void describe(nlohmann::ordered_json& array, const Quantisation& quantisation) {
  array["scale"] = quantisation.scale;
  array["offset"] = quantisation.offset;
}

}  // namespace

nlohmann::ordered_json PackedArrays::add_bytes(const std::vector<char>& bytes, std::string_view type,
                                               const std::vector<std::size_t>& shape, bool delta) {
  const std::string text = to_base64(compressed(bytes));
  // arrays that share an element must have the same type and encoding
  const auto [known, is_new] = ids_.try_emplace(fmt::format("{} {} {}", type, delta ? "delta" : "", text),
                                                fmt::format("blob-{}", ids_.size() + 1));
  const std::string& id = known->second;
  if (is_new) elements_ += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, text);
  nlohmann::ordered_json array{{"blob", id}, {"type", type}, {"shape", shape}};
  if (delta) array["delta"] = true;
  return array;
}

nlohmann::ordered_json PackedArrays::add(std::span<const std::uint32_t> numbers,
                                         std::vector<std::size_t> shape) {
  const std::size_t promised =
      std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  if (promised != numbers.size())
    throw InvalidArgument(fmt::format("{} numbers for a shape of {}", numbers.size(), promised));
  const std::uint32_t largest = numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end());
  const int width = largest <= 0xFFU ? 1 : largest <= 0xFFFFU ? 2 : 4;
  std::vector<char> bytes;
  bytes.reserve(numbers.size() * width);
  for (const std::uint32_t number : numbers) append(bytes, number, width);
  return add_bytes(bytes, fmt::format("uint{}", 8 * width), shape);
}

nlohmann::ordered_json PackedArrays::add(std::span<const Index> numbers) {
  const std::vector<std::uint32_t> unsigned_numbers(numbers.begin(), numbers.end());
  return add(unsigned_numbers, {numbers.size()});
}

nlohmann::ordered_json PackedArrays::add(std::span<const std::array<Index, 3>> triangles) {
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  return add(corners, {triangles.size(), 3});
}

nlohmann::ordered_json PackedArrays::add_places(std::span<const Point> places) {
  const Extent extent = extent_of(places);
  Quantisation quantisation{.offset = extent.low};
  for (std::size_t c = 0; c < 3; ++c)
    quantisation.scale[c] = (extent.side[c] > 0 ? extent.side[c] : kNoExtent) / kSteps;
  std::vector<char> bytes;
  bytes.reserve(6 * places.size());
  for (const Point& place : places) {
    for (std::size_t c = 0; c < 3; ++c) append(bytes, quantisation.number(place, c), 2);
  }
  nlohmann::ordered_json array = add_bytes(bytes, "uint16", {places.size(), 3});
  describe(array, quantisation);
  return array;
}

nlohmann::ordered_json PackedArrays::add_frames(const std::vector<std::vector<Point>>& frames) {
  const std::size_t vertices = frames.empty() ? 0 : frames.front().size();
  std::vector<Point> all;
  for (const auto& frame : frames) {
    if (frame.size() != vertices)
      throw InvalidArgument(fmt::format("a frame of {} vertices after one of {}", frame.size(), vertices));
    all.insert(all.end(), frame.begin(), frame.end());
  }
  const auto longest = [](const Extent& extent) {
    return std::max({extent.side[0], extent.side[1], extent.side[2]});
  };
  const Extent extent = extent_of(all);
  const Extent of_body = extent_of(frames.empty() ? all : frames.front());
  double step = std::max(longest(of_body) / kStepsOfBody, longest(extent) / kSteps);
  if (!(step > 0)) step = kNoExtent;
  const Quantisation quantisation{.offset = extent.low, .scale = {step, step, step}};

  std::vector<char> bytes;
  bytes.reserve(6 * all.size());
  std::vector<std::uint32_t> before(3 * vertices, 0);
  for (const auto& frame : frames) {
    for (std::size_t v = 0; v < vertices; ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t number = quantisation.number(frame[v], c);
        append(bytes, number - before[3 * v + c], 2);
        before[3 * v + c] = number;
      }
    }
  }
  nlohmann::ordered_json array = add_bytes(bytes, "uint16", {frames.size(), vertices, 3}, true);
  describe(array, quantisation);
  return array;
}

}  // namespace meshorder
