// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/error.hpp"

#include <utility>

namespace meshorder {
namespace {

std::string sentence(const Location& location, const std::string& what, const std::string& remedy) {
  std::string text = location.file;
  if (location.line > 0) text += ":" + std::to_string(location.line);
  text += ": ";
  if (location.line <= 0 && location.byte >= 0) text += "byte " + std::to_string(location.byte) + ": ";
  text += what;
  if (!remedy.empty()) text += "; " + remedy;
  return text;
}

}  // namespace

Error::Error(Location location, const std::string& what, const std::string& remedy)
    : std::runtime_error(sentence(location, what, remedy)), location_(std::move(location)) {}

}  // namespace meshorder
