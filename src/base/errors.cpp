// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include <meshorder/error.hpp>
#include <meshorder/view.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

namespace meshorder {
namespace {

std::string format_message(const Location& location, const std::string& what, const std::string& remedy) {
  std::string text = location.file;
  if (location.line > 0) text.append(":").append(std::to_string(location.line));
  text.append(": ");
  if (location.line <= 0 && location.byte >= 0) {
    text.append("byte ").append(std::to_string(location.byte)).append(": ");
  }
  text.append(what);
  if (!remedy.empty()) text.append("; ").append(remedy);
  return visible(text);  // one line, though names from a file may contain line ends
}

}  // namespace

InputError::InputError(Location location, const std::string& what, const std::string& remedy)
    : Error(Code::bad_input, format_message(location, what, remedy)),
      location_(std::make_shared<const Location>(std::move(location))) {}

void detail::refuse_null(std::size_t count) {
  throw InvalidArgument("an array of " + std::to_string(count) + " numbers is null");
}

void PointsView::check_dimension(int dimension) {
  if (dimension < 1 || dimension > 3) {
    throw InvalidArgument("points: the dimension is " + std::to_string(dimension) + ", must be 1, 2 or 3");
  }
}

std::size_t PointsView::point_count(std::size_t numbers, int dimension) {
  check_dimension(dimension);
  const auto axes = static_cast<std::size_t>(dimension);
  if (numbers % axes != 0) {
    throw InvalidArgument("points: " + std::to_string(numbers) + " numbers do not make points of " +
                          std::to_string(dimension) + " coordinates");
  }
  return numbers / axes;
}

}  // namespace meshorder
