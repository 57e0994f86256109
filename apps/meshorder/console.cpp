// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "console.hpp"

#include "wording.hpp"

#include <nlohmann/json.hpp>

namespace meshorder::command {

void Console::warn(const std::string& sentence) {
  if (!quiet_) write_stderr("meshorder: warning: " + visible(sentence) + "\n");
  notes_.push_back(sentence);
}

void Console::warn_of(const Notes& notes) {
  for (const std::string& note : grouped_by_name(notes)) warn(note);
}

void Console::print_json(nlohmann::ordered_json result) const {
  if (!json_) return;
  result["version"] = MESHORDER_VERSION;
  result["notes"] = notes_;
  // `visible` escapes further characters of names, in JSON's form: \u202e
  write_stdout(visible(result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace), "\n") +
               "\n");
}

}  // namespace meshorder::command
