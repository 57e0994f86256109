// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/results_json.hpp"

#include "lab/support/json.hpp"
#include "payoff/machine.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <limits>

namespace meshorder {
namespace {

using Json = nlohmann::ordered_json;

KernelRecord sample_kernel(double ms) {
  return {.predicted_ms = ms, .measured_ms = ms / 3, .accesses = 1000, .misses = {{70, 9}, {80, 20, 1}}};
}

MeshOrderRecord sample_order(const std::string& ordering) {
  return {.ordering = ordering,
          .vertex_method = ordering,
          .element_method = "lexmax",
          .seconds = 0.1 + 0.2,  // not 0.3: the last bit counts
          .span = {.mean = 10.0 / 3, .max = 812, .mean_log2 = 1.7},
          .span_histogram = {400, 30, 0, 1},
          .kernels = {sample_kernel(1), sample_kernel(2), sample_kernel(0.1), sample_kernel(1e-7)}};
}

RunRecord sample_run(double seconds) {
  return {.began = "2026-11-20T17:30:00Z",
          .step_seconds = {seconds, seconds / 3, 2 * seconds},
          .seconds =
              {.total = 4, .assembly = 1, .solve = 2, .local = 0.25, .global = 0.125, .collision = 1.0 / 7},
          .cg_iterations = 1860,
          .admm_iterations = 60,
          .contact_iterations = 12,
          .setup_seconds = 0.5,
          .bytes = Offset{5} << 30,
          .warnings = {"vertex 7 \"flies\""}};
}

ScenarioOrderRecord sample_runs(const std::string& ordering, double seconds) {
  return {.ordering = ordering,
          .runs = {sample_run(seconds), sample_run(1.01 * seconds)},
          .time = {.mean = 3.3, .deviation = 0.01, .undisturbed = 3.2},
          .speedup = {.saved_seconds = -0.1,
                      .percent = -3.0,
                      .low = -5,
                      .high = -1,
                      .beyond_noise = true,
                      .undisturbed_percent = -2.5,
                      .break_even_step = seconds < 1 ? std::optional<Index>(2) : std::nullopt},
          .motion = {.by_frame = {0, 1e-9}, .largest = 2e-9}};
}

/// Results in which no member has its default.
StudyResults sample() {
  StudyResults results;
  results.began = "2026-11-20T17:30:00Z";
  results.size = "300k";
  results.runs = 2;
  results.threads = 2;
  results.reference = "scrambled";
  results.orderings = {{"scrambled", "Scrambled", "scrambled", "original"},
                       {"vf-fiedler", "VF Fiedler", "fiedler", "fiedler"}};
  results.machine = {.processor = "A processor",
                     .cores = 2,
                     .system = "Linux 6.1.0 x86_64",
                     .caches = parse_caches("48K,1M,32M"),
                     .memory_bytes = std::uint64_t{8} << 30,
                     .read_bandwidth = 35.5,
                     .read_bandwidth_all = 52,
                     .program = "0.1.0",
                     .revision = "5eed5eed",
                     .compiler = "GNU 12.2.0",
                     .flags = "-O3",
                     .simd = "AVX3"};
  results.meshes = {
      {.name = "grid",
       .file = "data/grid.vtu",
       .vertices = 1000,
       .tetrahedra = 5000,
       .edges = 6000,
       .span_bin = 100,
       .hierarchies = {{"this machine", parse_caches("48K,1M")}, {"the paper's", caches_of_the_paper()}},
       .orders = {sample_order("scrambled"), sample_order("vf-fiedler")},
       .verdict = "Reordering pays.",
       .gain = 1.5}};
  results.scenarios = {{.name = "falling",
                        .title = "A grid falls",
                        .method = "backward-euler",
                        .material = "corotational",
                        .precision = "single",
                        .mesh = "grid",
                        .fingerprint = "5eed",
                        .steps = 3,
                        .turn = 2,
                        .interleaved = false,
                        .fixed_addresses = true,
                        .processors = {0, 1},
                        .frame_steps = {0, 3},
                        .orders = {sample_runs("scrambled", 1), sample_runs("vf-fiedler", 0.9)}}};
  return results;
}

/// The error from reading the sample after a change.
std::string complaint(const std::function<void(Json&)>& change) {
  const test::TemporaryFolder folder;
  Json json = to_json(sample());
  change(json);
  const auto path = folder.file("results.json", json.dump());
  try {
    read_results(path);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.starts_with(path.string() + ": ") ? what.substr(path.string().size() + 2)
                                                  : "elsewhere: " + what;
  }
  return "none";
}

TEST(ResultsJson, ReadsBackToTheLastBit) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "results.json";
  const StudyResults results = sample();
  write_results(results, path);
  EXPECT_EQ(read_results(path), results);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"results.json"});
}

TEST(ResultsJson, AStudyWithoutRunsIsOne) {
  const test::TemporaryFolder folder;
  StudyResults results = sample();
  results.scenarios.clear();
  results.meshes[0].orders[0].kernels[0].misses.clear();
  write_results(results, folder.path() / "results.json");
  EXPECT_EQ(read_results(folder.path() / "results.json"), results);
}

TEST(ResultsJson, NeedsNoTitleOfAScenario) {
  StudyResults results = sample();
  results.scenarios.front().title.clear();
  const test::TemporaryFolder folder;
  write_results(results, folder.path() / "results.json");
  EXPECT_EQ(read_results(folder.path() / "results.json"), results);
}

TEST(ResultsJson, ReadsResultsOfEarlierVersionsWithoutRevisionAndPrecision) {
  Json json = to_json(sample());
  json["machine"].erase("revision");
  json["scenarios"][0].erase("precision");
  const test::TemporaryFolder folder;
  StudyResults expected = sample();
  expected.machine.revision.clear();
  expected.scenarios.front().precision.clear();
  EXPECT_EQ(read_results(folder.file("results.json", json.dump())), expected);
}

TEST(ResultsJson, KeepsMeasurementsWhereANameIsNoUtf8) {
  StudyResults results = sample();
  results.scenarios.front().title =
      "Stra\xdf"
      "e";
  const test::TemporaryFolder folder;
  write_results(results, folder.path() / "results.json");
  results.scenarios.front().title = "Stra\ufffde";
  EXPECT_EQ(read_results(folder.path() / "results.json"), results);
}

TEST(ResultsJson, KeepsEveryListOfNumbersInOneLine) {
  const Json numbers(std::vector<int>(60, 1));
  const Json objects(std::vector<Json>(2, Json{{"name", std::string(60, 'a')}}));
  EXPECT_EQ(json_text({{"few", {1, 2}}, {"numbers", numbers}, {"objects", objects}}),
            "{\n \"few\": [1,2],\n \"numbers\": " + numbers.dump() + ",\n \"objects\": [\n  " +
                objects[0].dump() + ",\n  " + objects[1].dump() + "\n ]\n}\n");
}

TEST(ResultsJson, RefusesWhatIsMissingOrUnknown) {
  EXPECT_EQ(complaint([](Json& json) { json["machine"].erase("cores"); }),
            "machine: 'cores' is missing; give it; see docs/results.schema.json");
  EXPECT_EQ(complaint([](Json& json) { json["meshes"][0]["orders"][1]["kernels"]["spvm"] = 1; }),
            "meshes[0].orders[1].kernels: the key 'spvm' is unknown; known: spmv, element, assembly, "
            "springs");
  EXPECT_EQ(complaint([](Json& json) { json["colour"] = 1; }).substr(0, 38),
            "the file: the key 'colour' is unknown;");
  EXPECT_EQ(complaint([](Json& json) { json.erase("format"); }).substr(0, 37),
            "the file: is not a study of meshorder");
  EXPECT_EQ(complaint([](Json& json) { json["version"] = 2; }),
            "version: was written by a later meshorder; use that one, or measure again");
}

TEST(ResultsJson, RefusesNumbersOutOfRange) {
  EXPECT_EQ(complaint([](Json& json) { json["meshes"][0]["vertices"] = -1; }),
            "meshes[0].vertices: is the number -1; a whole number from 0 to 2147483647 is needed");
  EXPECT_EQ(complaint([](Json& json) { json["machine"]["read_bandwidth"] = std::nan(""); }),
            "machine.read_bandwidth: is null; a number is needed");
  EXPECT_EQ(
      complaint([](Json& json) { json["scenarios"][0]["orders"][0]["runs"][1]["step_seconds"][2] = -1; }),
      "scenarios[0].orders[0].runs[1].step_seconds[2]: is -1; it must be at least 0");
  EXPECT_EQ(complaint([](Json& json) { json["scenarios"][0]["turn"] = 0; }),
            "scenarios[0].turn: is 0; give 1 or more");
  EXPECT_EQ(complaint([](Json& json) { json["meshes"][0]["span_bin"] = 0; }),
            "meshes[0].span_bin: is 0; give 1 or more");
  EXPECT_EQ(
      complaint([](Json& json) {
        json["machine"]["cache_bytes"] = {65536, 32768};
      }),
      "machine.cache_bytes: 32768 is not a cache size after 65536; sizes are ascending multiples of 64");
  EXPECT_EQ(complaint([](Json& json) { json["machine"]["processor"] = ""; }),
            "machine.processor: is an empty text; give one");
  EXPECT_EQ(complaint([](Json& json) { json["scenarios"][0]["precision"] = "half"; }),
            "scenarios[0].precision: 'half' is unknown; known: double, single");
}

TEST(ResultsJson, RefusesListsThatDoNotFitEachOther) {
  EXPECT_EQ(complaint([](Json& json) { json["scenarios"][0]["orders"][1]["runs"][0]["step_seconds"] = {1}; }),
            "scenarios[0].orders[1].runs[0].step_seconds: has 1 entries; give 3, one for each step");
  EXPECT_EQ(complaint([](Json& json) { json["scenarios"][0]["orders"][1]["motion"]["by_frame"] = {1}; }),
            "scenarios[0].orders[1].motion.by_frame: has 1 entries; give 2, one for each of the frame_steps");
  EXPECT_EQ(
      complaint([](Json& json) { json["meshes"][0]["orders"][0]["kernels"]["element"]["misses"][1] = {1}; }),
      "meshes[0].orders[0].kernels.element.misses[1]: has 1 entries; give 3, one for each cache");
}

TEST(ResultsJson, RefusesNamesOfNothing) {
  EXPECT_EQ(complaint([](Json& json) { json["reference"] = "random"; }),
            "reference: 'random' is not one of the orderings; name one that is listed there");
  EXPECT_EQ(complaint([](Json& json) { json["meshes"][0]["orders"][1]["ordering"] = "rcm"; }),
            "meshes[0].orders[1].ordering: 'rcm' is not one of the orderings; name one that is listed there");
  EXPECT_EQ(
      complaint([](Json& json) { json["scenarios"][0]["orders"][1]["ordering"] = "rcm"; }),
      "scenarios[0].orders[1].ordering: 'rcm' is not one of the orderings; name one that is listed there");
  EXPECT_EQ(complaint([](Json& json) { json["scenarios"][0]["mesh"] = "dragon"; }),
            "scenarios[0].mesh: 'dragon' is not one of the meshes; name one that is listed there");
  EXPECT_EQ(complaint([](Json& json) { json["scenarios"][0]["orders"][1]["ordering"] = "scrambled"; }),
            "scenarios[0].orders[1].ordering: 'scrambled' occurs twice; keep one of them");
  EXPECT_EQ(complaint([](Json& json) { json["meshes"][1] = json["meshes"][0]; }),
            "meshes[1].name: 'grid' occurs twice; keep one of them");
}

TEST(ResultsJson, RefusesToWriteWhatIsNoNumber) {
  StudyResults results = sample();
  results.scenarios[0].orders[0].speedup.low = std::numeric_limits<double>::infinity();
  EXPECT_THROW(to_json(results), InvalidArgument);
}

/// Follows a reference within a schema.
const Json& resolved(const Json& schema, const Json& root) {
  if (!schema.contains("$ref")) return schema;
  return root[Json::json_pointer(schema["$ref"].get<std::string>().substr(1))];
}

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

void expect_described(const Json& value, const Json& reference, const Json& root, const std::string& path) {
  const Json& schema = resolved(reference, root);
  if (value.is_object()) {
    EXPECT_EQ(keys_of(schema["properties"]), keys_of(value)) << path;
    for (const auto& [key, member] : value.items())
      expect_described(member, schema["properties"][key], root, path + "." + key);
  } else if (value.is_array()) {
    for (const Json& item : value) expect_described(item, schema["items"], root, path + "[]");
  } else {
    EXPECT_TRUE(schema.contains("type") || schema.contains("const")) << path;
  }
}

TEST(ResultsJson, HasTheKeysOfItsSchema) {
  const Json schema = Json::parse(test::content_of(MESHORDER_DOCS "/results.schema.json"));
  expect_described(to_json(sample()), schema, schema, "results");
}

}  // namespace
}  // namespace meshorder
