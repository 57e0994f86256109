// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/vtu_offsets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

constexpr std::string_view kOffset = "offset";
constexpr std::size_t kMostDigits = std::numeric_limits<Offset>::digits10 + 1;

/// Returns the place and the size of the value of an attribute in a tag, which must have it.
std::pair<std::size_t, std::size_t> value_in_tag(std::string_view text, std::size_t tag,
                                                 std::string_view attribute) {
  std::size_t at = text.find_first_of(vtk::kXmlBlanks, tag);
  while (true) {
    at = text.find_first_not_of(vtk::kXmlBlanks, at);
    const std::string_view name = text.substr(at, text.find_first_of("= \t\r\n", at) - at);
    const std::size_t quote = text.find_first_of("\"'", at);
    const std::size_t end = text.find(text[quote], quote + 1);
    if (name == attribute) return {quote + 1, end - quote - 1};
    at = end + 1;
  }
}

}  // namespace

Offset whole_number(const vtk::VtuDocument& file, const vtk::VtuElement& element, std::string_view name,
                    Offset otherwise) {
  if (otherwise >= 0 && element.attribute(name) == nullptr) return otherwise;
  const std::string& text = file.required(element, name);
  Offset value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size() || value < 0) {
    throw file.error(element, fmt::format("{} is '{}'", name, text.substr(0, 40)),
                     "a whole number from 0 on is needed");
  }
  return value;
}

VtuXml::VtuXml(std::string text, const vtk::VtuDocument& file) : text_(std::move(text)) {
  add_places(file, file.root());
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.at < b.at; });
}

void VtuXml::add_places(const vtk::VtuDocument& file, const vtk::VtuElement& element) {
  const std::string* const format = element.attribute("format");
  if (format != nullptr && *format == "appended") {
    const Offset offset = whole_number(file, element, kOffset);
    const auto [at, size] = value_in_tag(text_, element.at, kOffset);
    places_.push_back({at, size, offset});
  }
  for (const vtk::VtuElement& child : element.children) add_places(file, child);
}

std::vector<Offset> VtuXml::offsets() const {
  std::vector<Offset> result;
  for (const Place& place : places_) result.push_back(place.offset);
  return result;
}

Offset VtuXml::most_bytes() const {
  std::size_t bytes = text_.find_last_not_of(vtk::kXmlBlanks, text_.size() - 2) + 2;
  for (const Place& place : places_) bytes += kMostDigits - std::min(place.size, kMostDigits);
  return static_cast<Offset>(std::max(bytes, text_.size()));
}

std::string VtuXml::with_offsets(const std::function<Offset(Offset)>& moved, Offset bytes) const {
  std::string result;
  std::size_t at = 0;
  for (const Place& place : places_) {
    result += std::string_view(text_).substr(at, place.at - at);
    result += std::to_string(moved(place.offset));
    at = place.at + place.size;
  }
  result += std::string_view(text_).substr(at, text_.size() - 1 - at);
  result.resize(static_cast<std::size_t>(bytes) - 1, ' ');  // pads, or cuts blanks that an earlier call added
  return result + '_';
}

}  // namespace meshorder::distributed
