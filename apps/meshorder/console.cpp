// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "console.hpp"

#include "grouped_notes.hpp"

#include <nlohmann/json.hpp>

namespace meshorder::command {

void Console::warn(const std::string& sentence) {
  if (!quiet_) write_stderr("meshorder: warning: " + sentence + "\n");
  notes_.push_back(sentence);
}

void Console::warn_of(const Notes& notes) {
  for (const std::string& note : grouped_by_name(notes)) warn(note);
}

void Console::print_json(nlohmann::ordered_json result) const {
  if (!json_) return;
  result["version"] = MESHORDER_VERSION;
  result["notes"] = notes_;
  write_stdout(result.dump(2) + "\n");
}

}  // namespace meshorder::command
