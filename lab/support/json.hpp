// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/point.hpp"
#include "base/text.hpp"

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

/// Where errors about scenarios point.
inline constexpr std::string_view kScenarioGuide = "docs/simulate.md";

/// The JSON text of a file. Throws Error with the line of what is no JSON, of a key that an object has twice
/// and of a number that no double holds. `guide` is the documentation that errors point at.
nlohmann::json parse_json(std::string_view text, const std::string& file,
                          std::string_view guide = kScenarioGuide);

/// Numbers that are allowed; the ends are, too, unless they are `open`.
struct NumberRange {
  double least = std::numeric_limits<double>::lowest();
  double most = std::numeric_limits<double>::max();
  bool least_open = false;
  bool most_open = false;
};

/// A value in a JSON file that knows its place there: every Error names the file and the path, as in
/// `FILE: forces[0].newtons: what; remedy`. The value, and the text of `guide`, must outlive it.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& value, std::string file, std::string_view guide = kScenarioGuide)
      : value_(&value), file_(std::move(file)), guide_(guide) {}

  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  /// "forces[0].newtons"; "the file" for the outermost value.
  [[nodiscard]] std::string path() const { return path_.empty() ? "the file" : path_; }
  [[nodiscard]] Error error(const std::string& what, const std::string& remedy) const {
    return {file_, path() + ": " + what, remedy};
  }

  // ---- objects
  /// Throws unless it is an object of no other keys than these.
  void expect_keys(std::initializer_list<std::string_view> known) const;
  void expect_keys(std::span<const std::string_view> known) const;
  [[nodiscard]] bool has(std::string_view key) const { return value_->contains(key); }
  /// A value that must be there.
  [[nodiscard]] JsonValue operator[](std::string_view key) const;
  /// A value that may be there.
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;

  // ---- arrays
  /// The values of an array of `least` to `most` values.
  [[nodiscard]] std::vector<JsonValue> items(
      std::size_t least = 0, std::size_t most = std::numeric_limits<std::size_t>::max()) const;

  // ---- plain values
  [[nodiscard]] bool is_null() const noexcept { return value_->is_null(); }
  [[nodiscard]] bool is_text() const noexcept { return value_->is_string(); }
  /// A text that is not empty.
  [[nodiscard]] std::string text() const;
  /// A text that may be empty.
  [[nodiscard]] std::string any_text() const;
  [[nodiscard]] double number(const NumberRange& range = {}) const;
  [[nodiscard]] std::int64_t whole(std::int64_t least, std::int64_t most) const;
  /// true or false.
  [[nodiscard]] bool truth() const;
  /// Three numbers.
  [[nodiscard]] Point vector() const;
  /// The value that a text names, of pairs (value, name). Throws Error that lists the names.
  template <class Value, std::size_t N>
  [[nodiscard]] Value one_of(const std::array<std::pair<Value, const char*>, N>& names) const {
    const std::string given = text();
    for (const auto& [value, name] : names) {
      if (given == name) return value;
    }
    throw error("'" + given + "' is unknown",
                "known are " + join(names, [](const auto& pair) { return std::string_view(pair.second); }));
  }
  template <NamedEnum Enum>
  [[nodiscard]] Enum one_of() const {
    return one_of(EnumNames<Enum>::names);
  }

 private:
  /// What stands at `path` in this one's file.
  [[nodiscard]] JsonValue at(const nlohmann::json& value, std::string path) const;
  [[nodiscard]] std::string kind() const;

  const nlohmann::json* value_;
  std::string file_;
  std::string_view guide_;
  std::string path_;
};

/// JSON for people and for version control: what is short, and every list of numbers, stands in one line;
/// the rest is indented. Doubles read back to the same bits. Ends with a line break. O(size · depth).
std::string json_text(const nlohmann::ordered_json& json);

/// Writes that to a file, whole or not at all. Throws Error when it cannot be written.
void write_json(const nlohmann::ordered_json& json, const std::filesystem::path& path);

}  // namespace meshorder
