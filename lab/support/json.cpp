// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/json.hpp"

#include "io/stream/output_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace meshorder {
namespace {

/// Returns the parser's message without its error number and position.
std::string reason(std::string what) {
  for (const std::string_view mark : {"syntax error ", "] "}) {
    const std::size_t found = what.find(mark);
    if (found == std::string::npos) continue;
    what.erase(0, found + mark.size());
    break;
  }
  return what;
}

/// Parser callback that refuses a key that an object has twice; the parser would keep the last value.
class UniqueKeys {
 public:
  explicit UniqueKeys(std::string file) : file_(std::move(file)) {}

  bool operator()(int /*depth*/, nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
    using Event = nlohmann::json::parse_event_t;
    if (event == Event::object_start) keys_.emplace_back();
    if (event == Event::object_end) keys_.pop_back();
    if (event == Event::key && !keys_.back().insert(parsed.get<std::string>()).second)
      throw InputError(file_, "an object has the key '" + parsed.get<std::string>() + "' twice",
                       "keep one of them");
    return true;
  }

 private:
  std::string file_;
  std::vector<std::set<std::string>> keys_;
};

/// Objects and lists of at most this many characters are written in one line.
constexpr std::size_t kShort = 100;

bool is_list_of_plain_values(const nlohmann::ordered_json& json) {
  return json.is_array() && std::all_of(json.begin(), json.end(), [](const auto& item) {
           return item.is_number() || item.is_boolean() || item.is_null();
         });
}

/// Returns a value as JSON in one line; bytes that are not UTF-8 become U+FFFD.
std::string dumped(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void append(const nlohmann::ordered_json& json, std::size_t indentation, std::string& text) {
  std::string in_one_line = dumped(json);
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
    if (object) text += dumped(key) + ": ";
    append(value, indentation + 1, text);
    first = false;
  }
  text += '\n';
  text.append(indentation, ' ');
  text += object ? '}' : ']';
}

}  // namespace

nlohmann::json parse_json(std::string_view text, const std::string& file, std::string_view guide) {
  const std::string remedy = std::string(guide) + " has examples";
  try {
    return nlohmann::json::parse(text, UniqueKeys(file));
  } catch (const nlohmann::json::parse_error& error) {
    const std::string_view before = text.substr(0, std::min(error.byte, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    throw InputError(Location{file, line, -1}, "not JSON: " + reason(error.what()), remedy);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, "not JSON: " + reason(error.what()), remedy);
  }
}

std::string JsonValue::kind() const {
  if (value_->is_null()) return "null";
  if (value_->is_boolean()) return value_->get<bool>() ? "true" : "false";
  if (value_->is_string()) return "the text '" + value_->get<std::string>() + "'";
  if (value_->is_number()) return "the number " + value_->dump();
  return value_->is_array() ? fmt::format("a list of {}", value_->size()) : "an object";
}

JsonValue JsonValue::at(const nlohmann::json& value, std::string path) const {
  JsonValue result(value, file_, guide_);
  result.path_ = std::move(path);
  return result;
}

void JsonValue::expect_keys(std::initializer_list<std::string_view> known) const {
  expect_keys(std::span<const std::string_view>(known.begin(), known.size()));
}

void JsonValue::expect_keys(std::span<const std::string_view> known) const {
  if (!value_->is_object()) throw error("is " + kind(), "give an object {…} of " + join(known));
  for (const auto& [key, value] : value_->items()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw error("the key '" + key + "' is unknown", "known: " + join(known));
  }
}

JsonValue JsonValue::operator[](std::string_view key) const {
  std::optional<JsonValue> found = find(key);
  if (!found) throw error("'" + std::string(key) + "' is missing", "give it; see " + std::string(guide_));
  return *std::move(found);
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return at(*found, (path_.empty() ? "" : path_ + ".") + std::string(key));
}

std::vector<JsonValue> JsonValue::items(std::size_t min, std::size_t max) const {
  if (!value_->is_array()) throw error("is " + kind(), "a list […] is needed");
  if (value_->size() < min || value_->size() > max) {
    const std::string wanted = min == max ? fmt::format("{}", min) : fmt::format("at least {}", min);
    throw error(fmt::format("has {} entries", value_->size()), "give " + wanted);
  }
  std::vector<JsonValue> result;
  for (const auto& item : *value_) result.push_back(at(item, fmt::format("{}[{}]", path_, result.size())));
  return result;
}

std::string JsonValue::any_text() const {
  if (!value_->is_string()) throw error("is " + kind(), "a text in quotes is needed");
  return value_->get<std::string>();
}

std::string JsonValue::text() const {
  std::string result = any_text();
  if (result.empty()) throw error("is an empty text", "give one");
  return result;
}

std::string JsonValue::name_in_files() const {
  std::string name = text();
  if (name.find('/') != std::string::npos)
    throw error("'" + name + "' contains a slash", "leave it out: the name becomes part of file names");
  if (name.size() > kLongestNameInFiles || visible(name) != name)
    throw error(fmt::format("'{}' cannot become part of file names", name.substr(0, kLongestNameInFiles)),
                fmt::format("give one of at most {} bytes, without control characters", kLongestNameInFiles));
  return name;
}

double JsonValue::number(const NumberRange& range) const {
  if (!value_->is_number()) throw error("is " + kind(), "a number is needed");
  const auto result = value_->get<double>();
  const bool above = range.min_open ? result > range.min : result >= range.min;
  const bool below = range.max_open ? result < range.max : result <= range.max;
  if (!std::isfinite(result) || !above || !below) {
    std::string wanted;
    if (range.min > std::numeric_limits<double>::lowest())
      wanted = fmt::format("{} {}", range.min_open ? "above" : "at least", range.min);
    if (range.max < std::numeric_limits<double>::max())
      wanted += fmt::format("{}{} {}", wanted.empty() ? "" : " and ", range.max_open ? "below" : "at most",
                            range.max);
    throw error("is " + value_->dump(), "it must be " + (wanted.empty() ? "finite" : wanted));
  }
  return result;
}

std::int64_t JsonValue::whole(std::int64_t min, std::int64_t max) const {
  const std::string wanted = fmt::format("a whole number from {} to {} is needed", min, max);
  if (!value_->is_number_integer()) throw error("is " + kind(), wanted);
  const bool fits =
      !value_->is_number_unsigned() || std::in_range<std::int64_t>(value_->get<std::uint64_t>());
  const auto result = value_->get<std::int64_t>();
  if (!fits || result < min || result > max) throw error("is " + kind(), wanted);
  return result;
}

bool JsonValue::truth() const {
  if (!value_->is_boolean()) throw error("is " + kind(), "true or false is needed");
  return value_->get<bool>();
}

Point JsonValue::vector() const {
  const std::vector<JsonValue> numbers = items(3, 3);
  return {numbers[0].number(), numbers[1].number(), numbers[2].number()};
}

std::string json_text(const nlohmann::ordered_json& json) {
  std::string text;
  append(json, 0, text);
  return text + "\n";
}

void write_json(const nlohmann::ordered_json& json, const FilePath& path) {
  OutputFile file(path);
  file.write(json_text(json));
  file.commit();
}

}  // namespace meshorder
