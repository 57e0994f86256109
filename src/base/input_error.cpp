// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include <meshorder/error.hpp>

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
  return visible(text);  // one line, though a file's names may have several
}

}  // namespace

InputError::InputError(Location location, const std::string& what, const std::string& remedy)
    : Error(Code::bad_input, format_message(location, what, remedy)),
      location_(std::make_shared<const Location>(std::move(location))) {}

}  // namespace meshorder
