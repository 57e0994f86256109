// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/results_json.hpp"

#include "io/stream/scanner.hpp"
#include "lab/implicit/backward_euler.hpp"
#include "lab/study/results_fields.hpp"
#include "lab/support/json.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <set>

namespace meshorder {
namespace {

constexpr std::string_view kFormat = "meshorder-study";
constexpr int kVersion = 1;
constexpr std::string_view kGuide = "docs/results.schema.json";

using Json = nlohmann::ordered_json;

/// Converts records to JSON.
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
      json[std::string(to_string(kernel))] = of(kernels[static_cast<std::size_t>(kernel)]);
    return json;
  }

  std::string_view key_;
};

// Checks of records that were read from JSON. They throw an Error that names the faulty place in `value`.

/// Throws unless the number at `key` is 1 or more.
void expect_positive(std::int64_t number, const JsonValue& value, std::string_view key) {
  if (number < 1) throw value[key].error("is 0", "give 1 or more");
}

/// Returns the names of a list's records. Throws if a name occurs twice or cannot be part of a file name.
template <class Record>
std::set<std::string> unique_names(const std::vector<Record>& records, std::string Record::*name,
                                   const JsonValue& value, std::string_view list, std::string_view key) {
  std::set<std::string> names;
  const std::vector<JsonValue> items = value[list].items();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const JsonValue of_name = items[i][key];
    if (!names.insert(of_name.name_in_files()).second)
      throw of_name.error("'" + records[i].*name + "' occurs twice", "keep one of them");
  }
  return names;
}

/// Throws unless `names` contains the text at `value`.
void expect_one_of(const std::set<std::string>& names, const JsonValue& value, std::string_view list) {
  if (!names.contains(value.text()))
    throw value.error("'" + value.text() + "' is not one of the " + std::string(list),
                      "name one that is listed there");
}

void expect_size(const JsonValue& value, std::size_t wanted, std::string_view why) {
  const std::size_t size = value.items().size();
  if (size != wanted)
    throw value.error(fmt::format("has {} entries", size), fmt::format("give {}, {}", wanted, why));
}

void expect_misses(const std::vector<NamedCaches>& hierarchies, const JsonValue& order) {
  for (const Kernel kernel : kKernels) {
    const JsonValue misses = order["kernels"][to_string(kernel)]["misses"];
    const std::vector<JsonValue> of_hierarchy = misses.items();
    if (of_hierarchy.empty()) continue;
    expect_size(misses, hierarchies.size(), "one list for each of the hierarchies");
    for (std::size_t i = 0; i < of_hierarchy.size(); ++i)
      expect_size(of_hierarchy[i], hierarchies[i].caches.level_bytes.size(), "one for each cache");
  }
}

/// Throws unless the sizes of the levels are ascending multiples of a cache line's size.
void check_record(const Caches& caches, const JsonValue& value) {
  Offset before = 0;
  for (const Offset bytes : caches.level_bytes) {
    if (bytes <= before || bytes % kLineBytes != 0)
      throw value.error(fmt::format("{} is not a cache size after {}", bytes, before),
                        fmt::format("sizes are ascending multiples of {}", kLineBytes));
    before = bytes;
  }
}

/// Throws unless `span_bin` is positive, no order occurs twice, and each kernel has misses for every
/// hierarchy and level, or for none.
void check_record(const MeshRecord& mesh, const JsonValue& value) {
  expect_positive(mesh.span_bin, value, "span_bin");
  unique_names(mesh.orders, &MeshOrderRecord::ordering, value, "orders", "ordering");
  for (const JsonValue& order : value["orders"].items()) expect_misses(mesh.hierarchies, order);
}

/// Throws unless `steps` and `turn` are positive, the precision is known or empty, no order occurs twice,
/// each run has all steps, and each order has motion differences for all frames or none.
void check_record(const ScenarioRecord& scenario, const JsonValue& value) {
  expect_positive(scenario.steps, value, "steps");
  expect_positive(scenario.turn, value, "turn");
  if (!scenario.precision.empty()) (void)value["precision"].one_of<MatrixPrecision>();
  unique_names(scenario.orders, &ScenarioOrderRecord::ordering, value, "orders", "ordering");
  for (const JsonValue& order : value["orders"].items()) {
    for (const JsonValue& run : order["runs"].items())
      expect_size(run["step_seconds"], static_cast<std::size_t>(scenario.steps), "one for each step");
    const JsonValue differences = order["motion"]["by_frame"];
    if (!differences.items().empty())
      expect_size(differences, scenario.frame_steps.size(), "one for each of the frame_steps");
  }
}

/// Throws unless `runs` and `threads` are positive, names are unique, and all references to names are valid.
void check_record(const StudyResults& results, const JsonValue& value) {
  expect_positive(results.runs, value, "runs");
  expect_positive(results.threads, value, "threads");
  const auto orderings = unique_names(results.orderings, &OrderingSpec::name, value, "orderings", "name");
  const auto meshes = unique_names(results.meshes, &MeshRecord::name, value, "meshes", "name");
  unique_names(results.scenarios, &ScenarioRecord::name, value, "scenarios", "name");
  expect_one_of(orderings, value["reference"], "orderings");
  for (const std::string_view list : {"meshes", "scenarios"}) {
    for (const JsonValue& record : value[list].items()) {
      for (const JsonValue& order : record["orders"].items())
        expect_one_of(orderings, order["ordering"], "orderings");
    }
  }
  for (const JsonValue& scenario : value["scenarios"].items())
    expect_one_of(meshes, scenario["mesh"], "meshes");
}

/// Checks nothing: other records need no check beyond the types of their fields.
template <class Record>
void check_record(const Record& /*record*/, const JsonValue& /*value*/) {}

/// Converts JSON to records.
class Reader {
 public:
  /// Reads an object with the record's keys. Keys in `also`, which the caller has read, are allowed.
  template <Described Record>
  static void read(const JsonValue& value, Record& record, bool /*free*/ = false,
                   std::vector<std::string_view> also = {}) {
    const auto known = [&](const auto&... field) { (also.push_back(field.key), ...); };
    std::apply(known, kFields<Record>);
    value.expect_keys(also);
    const auto take = [&](const auto&... field) { (read_field(value, field, record), ...); };
    std::apply(take, kFields<Record>);
    check_record(record, value);
  }

 private:
  template <class Record, class Value>
  static void read_field(const JsonValue& value, const Field<Record, Value>& field, Record& record) {
    if (!field.optional || value.has(field.key)) read(value[field.key], record.*field.member, field.free);
  }
  static void read(const JsonValue& value, double& number, bool free) {
    number = free ? value.number() : value.number({.min = 0});
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
  /// Reads the number of a step, counted from 1; leaves `step` as it is for null.
  static void read(const JsonValue& value, std::optional<Index>& step, bool /*free*/) {
    if (!value.is_null()) step = static_cast<Index>(value.whole(1, kMaxIndex));
  }
  static void read(const JsonValue& value, std::array<KernelRecord, kKernels.size()>& kernels, bool free) {
    std::vector<std::string_view> names;
    names.reserve(kKernels.size());
    for (const Kernel kernel : kKernels) names.push_back(to_string(kernel));
    value.expect_keys(names);
    for (const Kernel kernel : kKernels)
      read(value[to_string(kernel)], kernels[static_cast<std::size_t>(kernel)], free);
  }
};

}  // namespace

nlohmann::ordered_json to_json(const StudyResults& results) {
  Json json{{"format", kFormat}, {"version", kVersion}};
  json.update(Writer().of(results));
  return json;
}

void write_results(const StudyResults& results, const FilePath& path) { write_json(to_json(results), path); }

StudyResults read_results(const FilePath& path) {
  const Scanner text(path);
  const std::string& file = text.file();
  const nlohmann::json json = parse_json(text.all(), file, kGuide);
  const JsonValue root(json, file, kGuide);
  if (!root.has("format") || root["format"].any_text() != kFormat)
    throw root.error("is not a study of meshorder",
                     "give a results.json whose \"format\" is \"" + std::string(kFormat) + "\"");
  if (root["version"].whole(1, kMaxIndex) != kVersion)
    throw root["version"].error("was written by a later meshorder", "use that one, or measure again");
  StudyResults results;
  Reader::read(root, results, false, {"format", "version"});
  return results;
}

}  // namespace meshorder
