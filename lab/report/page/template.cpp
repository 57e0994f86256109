// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/template.hpp"

#include "base/error.hpp"

namespace meshorder {

std::string fill_template(std::string_view text,
                          const std::function<std::string(std::string_view)>& value_of) {
  std::string result;
  for (;;) {
    const auto begin = text.find("{{");
    result += text.substr(0, begin);
    if (begin == std::string_view::npos) return result;
    text.remove_prefix(begin + 2);
    const auto end = text.find("}}");
    if (end == std::string_view::npos)
      throw InvalidArgument("a placeholder has no end: {{" + std::string(text.substr(0, 40)));
    result += value_of(text.substr(0, end));
    text.remove_prefix(end + 2);
  }
}

}  // namespace meshorder
