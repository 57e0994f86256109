// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/json_text.hpp"

#include "io/stream/output_file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace meshorder {
namespace {

constexpr std::size_t kShort = 100;

bool is_list_of_plain_values(const nlohmann::ordered_json& json) {
  return json.is_array() && std::all_of(json.begin(), json.end(), [](const auto& item) {
           return item.is_number() || item.is_boolean() || item.is_null();
         });
}

void append(const nlohmann::ordered_json& json, std::size_t indentation, std::string& text) {
  std::string in_one_line = json.dump();
  if (!json.is_structured() || in_one_line.size() <= kShort || is_list_of_plain_values(json)) {
    text += in_one_line;
    return;
  }
  const bool object = json.is_object();
  text += object ? '{' : '[';
  bool first = true;
  for (const auto& [key, value] : json.items()) {
    text += first ? "\n" : ",\n";
    text.append(indentation + 1, ' ');
    if (object) text += nlohmann::ordered_json(key).dump() + ": ";
    append(value, indentation + 1, text);
    first = false;
  }
  text += '\n';
  text.append(indentation, ' ');
  text += object ? '}' : ']';
}

}  // namespace

std::string json_text(const nlohmann::ordered_json& json) {
  std::string text;
  append(json, 0, text);
  return text + "\n";
}

void write_json(const nlohmann::ordered_json& json, const std::filesystem::path& path) {
  OutputFile file(path);
  file.write(json_text(json));
  file.commit();
}

}  // namespace meshorder
