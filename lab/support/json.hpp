// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "base/text.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/error.hpp>

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

/// Documentation that errors in scenarios refer to.
inline constexpr std::string_view kScenarioGuide = "docs/simulate.md";

/// Parses the JSON text of a file. Throws Error with the line for text that is not JSON, for a key that
/// occurs twice in an object and for a number outside the range of double. `guide` is the documentation that
/// errors refer to.
nlohmann::json parse_json(std::string_view text, const std::string& file,
                          std::string_view guide = kScenarioGuide);

/// Most bytes of the name of a scenario or mesh, which becomes part of file names.
inline constexpr std::size_t kLongestNameInFiles = 100;

/// A range of numbers; it includes its ends unless they are `open`.
struct NumberRange {
  double min = std::numeric_limits<double>::lowest();
  double max = std::numeric_limits<double>::max();
  bool min_open = false;
  bool max_open = false;
};

/// A value in a JSON file with its path there: every Error names file and path, as in `FILE:
/// forces[0].newtons: what; remedy`. The nlohmann::json value and the text of `guide` must outlive the
/// object.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& value, std::string file, std::string_view guide = kScenarioGuide)
      : value_(&value), file_(std::move(file)), guide_(guide) {}

  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  /// Returns "forces[0].newtons"; "the file" for the outermost value.
  [[nodiscard]] std::string path() const { return path_.empty() ? "the file" : path_; }
  [[nodiscard]] InputError error(const std::string& what, const std::string& remedy) const {
    return {file_, path() + ": " + what, remedy};
  }

  // ---- objects
  /// Throws unless this is an object and all its keys are in `known`.
  void expect_keys(std::initializer_list<std::string_view> known) const;
  void expect_keys(std::span<const std::string_view> known) const;
  [[nodiscard]] bool has(std::string_view key) const { return value_->contains(key); }
  /// Returns the value of a key. Throws if the object lacks it.
  [[nodiscard]] JsonValue operator[](std::string_view key) const;
  /// Returns the value of a key, if the object has it.
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;

  // ---- arrays
  /// Returns the values of an array. Throws unless it has `min` to `max` values.
  [[nodiscard]] std::vector<JsonValue> items(std::size_t min = 0,
                                             std::size_t max = std::numeric_limits<std::size_t>::max()) const;

  // ---- plain values
  [[nodiscard]] bool is_null() const noexcept { return value_->is_null(); }
  [[nodiscard]] bool is_text() const noexcept { return value_->is_string(); }
  /// Returns a text. Throws for another value or an empty text.
  [[nodiscard]] std::string text() const;
  /// Returns a text, which may be empty.
  [[nodiscard]] std::string any_text() const;
  /// Returns a text that may become part of a file's name: without slashes and control characters, of at most
  /// `kLongestNameInFiles` bytes.
  [[nodiscard]] std::string name_in_files() const;
  [[nodiscard]] double number(const NumberRange& range = {}) const;
  [[nodiscard]] std::int64_t whole(std::int64_t min, std::int64_t max) const;
  [[nodiscard]] bool truth() const;
  /// Returns a point of three numbers.
  [[nodiscard]] Point vector() const;
  /// Returns the value that a text names, from pairs (value, name). Throws Error that lists the names.
  template <class Value, std::size_t N>
  [[nodiscard]] Value one_of(const std::array<std::pair<Value, const char*>, N>& names) const {
    const std::string given = text();
    for (const auto& [value, name] : names) {
      if (given == name) return value;
    }
    throw error("'" + given + "' is unknown",
                "known: " + join(names, [](const auto& pair) { return std::string_view(pair.second); }));
  }
  template <NamedEnum Enum>
  [[nodiscard]] Enum one_of() const {
    return one_of(EnumNames<Enum>::names);
  }

 private:
  /// Returns a value at another path in this file.
  [[nodiscard]] JsonValue at(const nlohmann::json& value, std::string path) const;
  [[nodiscard]] std::string kind() const;

  const nlohmann::json* value_;
  std::string file_;
  std::string_view guide_;
  std::string path_;
};

/// Returns JSON for people and version control: short values and lists of numbers take one line, other values
/// are indented. Doubles read back to the same bits; bytes that are not UTF-8 become U+FFFD. The text ends
/// with a line break. O(size · depth).
std::string json_text(const nlohmann::ordered_json& json);

/// Writes json_text to a file, completely or not at all. Throws Error if the file cannot be written.
void write_json(const nlohmann::ordered_json& json, const FilePath& path);

}  // namespace meshorder
