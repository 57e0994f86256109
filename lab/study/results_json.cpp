// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/results_json.hpp"

#include "base/error.hpp"
#include "io/stream/scanner.hpp"
#include "lab/study/results_check.hpp"
#include "lab/study/results_fields.hpp"
#include "lab/support/json_text.hpp"
#include "lab/support/json_value.hpp"

#include <cmath>
#include <concepts>
#include <limits>
#include <optional>

namespace meshorder {
namespace {

constexpr std::string_view kFormat = "meshorder-study";
constexpr int kVersion = 1;
constexpr std::string_view kGuide = "docs/results.schema.json";

using Json = nlohmann::ordered_json;

/// Records as JSON.
class Writer {
 public:
  template <Described Record>
  Json of(const Record& record) {
    Json json = Json::object();
    std::apply([&](const auto&... field) { (put(json, field, record), ...); }, kFields<Record>);
    return json;
  }

 private:
  template <class Record, class Value>
  void put(Json& json, const Field<Record, Value>& field, const Record& record) {
    key_ = field.key;
    json[std::string(field.key)] = of(record.*field.member);
  }

  [[nodiscard]] Json of(double number) const {
    // JSON has no NaN: it would come back as null
    if (!std::isfinite(number)) throw InvalidArgument("results: " + std::string(key_) + " is not finite");
    return number;
  }
  static Json of(bool truth) { return truth; }
  template <std::integral Whole>
  static Json of(Whole number) {
    return number;
  }
  static Json of(const std::string& text) { return text; }
  static Json of(const Caches& caches) { return caches.level_bytes; }
  template <class Value>
  Json of(const std::vector<Value>& values) {
    Json json = Json::array();
    for (const Value& value : values) json.push_back(of(value));
    return json;
  }
  static Json of(const std::optional<Index>& number) { return number ? Json(*number) : Json(); }
  Json of(const std::array<KernelRecord, kKernels.size()>& kernels) {
    Json json = Json::object();
    for (const Kernel kernel : kKernels)
      json[std::string(name(kernel))] = of(kernels[static_cast<std::size_t>(kernel)]);
    return json;
  }

  std::string_view key_;
};

/// Records from JSON.
class Reader {
 public:
  /// Reads an object of the record's keys and, where the caller read them already, `also`.
  template <Described Record>
  static void read(const JsonValue& value, Record& record, bool /*free*/ = false,
                   std::vector<std::string_view> also = {}) {
    const auto known = [&](const auto&... field) { (also.push_back(field.key), ...); };
    std::apply(known, kFields<Record>);
    value.expect_keys(also);
    const auto take = [&](const auto&... field) {
      (read(value[field.key], record.*field.member, field.free), ...);
    };
    std::apply(take, kFields<Record>);
    check_record(record, value);
  }

 private:
  static void read(const JsonValue& value, double& number, bool free) {
    number = free ? value.number() : value.number({.least = 0});
  }
  static void read(const JsonValue& value, bool& truth, bool /*free*/) { truth = value.truth(); }
  template <std::integral Whole>
  static void read(const JsonValue& value, Whole& number, bool /*free*/) {
    using Limits = std::numeric_limits<std::conditional_t<std::unsigned_integral<Whole>, Offset, Whole>>;
    number = static_cast<Whole>(value.whole(0, Limits::max()));
  }
  static void read(const JsonValue& value, std::string& text, bool free) {
    text = free ? value.any_text() : value.text();
  }
  static void read(const JsonValue& value, Caches& caches, bool free) {
    read(value, caches.level_bytes, free);
    check_record(caches, value);
  }
  template <class Value>
  static void read(const JsonValue& value, std::vector<Value>& values, bool free) {
    for (const JsonValue& item : value.items()) read(item, values.emplace_back(), free);
  }
  /// Of a step, which are counted from 1.
  static void read(const JsonValue& value, std::optional<Index>& step, bool /*free*/) {
    if (!value.is_null()) step = static_cast<Index>(value.whole(1, kMaxIndex));
  }
  static void read(const JsonValue& value, std::array<KernelRecord, kKernels.size()>& kernels, bool free) {
    std::vector<std::string_view> names;
    names.reserve(kKernels.size());
    for (const Kernel kernel : kKernels) names.push_back(name(kernel));
    value.expect_keys(names);
    for (const Kernel kernel : kKernels)
      read(value[name(kernel)], kernels[static_cast<std::size_t>(kernel)], free);
  }
};

}  // namespace

nlohmann::ordered_json to_json(const StudyResults& results) {
  Json json{{"format", kFormat}, {"version", kVersion}};
  json.update(Writer().of(results));
  return json;
}

void write_results(const StudyResults& results, const std::filesystem::path& path) {
  write_json(to_json(results), path);
}

StudyResults read_results(const std::filesystem::path& path) {
  const Scanner text(path);
  const std::string& file = text.file();
  const nlohmann::json json = parse_json(text.all(), file, kGuide);
  const JsonValue root(json, file, kGuide);
  if (!root.has("format") || root["format"].any_text() != kFormat)
    throw root.error("is no study of meshorder",
                     "give a results.json whose \"format\" is \"" + std::string(kFormat) + "\"");
  if (root["version"].whole(1, kMaxIndex) != kVersion)
    throw root["version"].error("was written by a later meshorder", "use that, or measure anew");
  StudyResults results;
  Reader::read(root, results, false, {"format", "version"});
  return results;
}

}  // namespace meshorder
