// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/calibration_store.hpp"

#include "base/checksum.hpp"
#include "base/host.hpp"
#include "base/input_file.hpp"
#include "io/stream/output_file.hpp"
#include "payoff/machine.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cctype>
#include <cmath>
#include <system_error>
#include <utility>

namespace meshorder {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "meshorder calibration 7";

std::string sizes_text(const Caches& caches) { return caches.level_bytes.empty() ? "" : to_string(caches); }

/// Returns the caches of the sizes in an array. Throws InvalidArgument unless the sizes ascend and each is a
/// multiple of the cache line size.
Caches caches_from(const Json& sizes) {
  Caches caches;
  for (const Json& size : sizes) {
    const auto bytes = size.get<Offset>();
    const Offset before = caches.level_bytes.empty() ? 0 : caches.level_bytes.back();
    if (bytes <= before || bytes % kLineBytes != 0)
      throw InvalidArgument("has sizes that are not cache sizes");
    caches.level_bytes.push_back(bytes);
  }
  return caches;
}

/// Returns a number; throws InvalidArgument if it is negative or not finite.
double number_from(const Json& json) {
  const auto number = json.get<double>();
  if (!(number >= 0) || !std::isfinite(number)) throw InvalidArgument("has a negative or infinite number");
  return number;
}

/// Returns the number; null if it is infinite, since JSON cannot hold that.
Json finite_json(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

double condition_from(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::infinity() : number_from(json);
}

Json to_json(const KernelCosts& costs) {
  return {{"access", costs.access}, {"miss", costs.miss}, {"jump", costs.jump}, {"turn", costs.turn}};
}

KernelCosts costs_from(const Json& json) {
  KernelCosts costs;
  double sum = costs.access = number_from(json.at("access"));
  for (std::size_t i = 0; i < costs.miss.size(); ++i) {
    sum += costs.miss[i] = number_from(json.at("miss").at(i));
    sum += costs.jump[i] = number_from(json.at("jump").at(i));
  }
  sum += costs.turn = number_from(json.at("turn"));
  if (!(sum > 0)) throw InvalidArgument("has a kernel that costs nothing");
  return costs;
}

/// Returns the costs of kernel k on a number of threads, and the quality of their fit.
Json kernel_json(const CostModel& model, const FitQuality& quality, std::size_t k) {
  return {{"solid", to_json(model.solid[k])},
          {"flat", to_json(model.flat[k])},
          {"condition", finite_json(quality.condition[k])},
          {"error", quality.error[k]},
          {"floor", quality.floor[k]}};
}

void kernel_from(const Json& json, std::size_t k, CostModel& model, FitQuality& quality) {
  model.solid[k] = costs_from(json.at("solid"));
  model.flat[k] = costs_from(json.at("flat"));
  quality.condition[k] = condition_from(json.at("condition"));
  quality.error[k] = number_from(json.at("error"));
  quality.floor[k] = number_from(json.at("floor"));
}

}  // namespace

CalibrationKey key_of_this_machine() {
  return {processor_of_this_machine(), sizes_text(reported_caches()), build_of_this_program()};
}

CalibrationKey key_of(const Calibration& calibration) {
  return {calibration.processor, sizes_text(calibration.reported), calibration.build};
}

fs::path calibration_file(const CalibrationKey& key) {
  const fs::path folder = user_cache_folder();
  if (folder.empty()) return {};
  std::string name;
  for (const char c : key.processor.substr(0, 60)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (plain || (!name.empty() && name.back() != '-')) name += plain ? c : '-';
  }
  Checksum checksum;
  for (const std::string* const part : {&key.processor, &key.caches, &key.build}) checksum.add_all(*part);
  return folder / "calibrations" / fmt::format("{}-{:016x}.json", name, checksum.value());
}

std::string to_json_text(const Calibration& calibration) {
  Json kernels;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    Json& kernel = kernels[std::string(to_string(kKernels[k]))];
    kernel = kernel_json(calibration.model, calibration.quality, k);
    kernel["all_threads"] = kernel_json(calibration.all_threads, calibration.all_threads_quality, k);
  }
  auto found = Json::array();
  for (const FoundCache& level : calibration.found.levels) {
    found.push_back({{"bytes", level.bytes}, {"nanoseconds", level.nanoseconds}});
  }
  const Steadiness& steadiness = calibration.steadiness;
  const Json json{
      {"schema", kSchema},
      {"processor", calibration.processor},
      {"build", calibration.build},
      {"date", calibration.date},
      {"machine", calibration.model.machine},
      {"caches",
       {{"reported", calibration.reported.level_bytes},
        {"found", found},
        {"used", calibration.model.caches.level_bytes}}},
      {"memory_nanoseconds", calibration.found.memory_nanoseconds},
      {"threads", calibration.threads},
      {"read_bandwidth",
       {{"one_thread", calibration.read_bandwidth}, {"all", calibration.read_bandwidth_all}}},
      {"kernels", kernels},
      {"steadiness",
       {{"waiting", steadiness.waiting}, {"pace", steadiness.pace}, {"repeat", steadiness.repeat}}},
      {"seconds", calibration.seconds}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Calibration parse_calibration(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw InvalidArgument("is not JSON");
  const bool has_schema = json.is_object() && json.contains("schema") && json.at("schema") == kSchema;
  if (!has_schema) throw InvalidArgument("is not a calibration");
  try {
    Calibration calibration;
    calibration.processor = json.at("processor").get<std::string>();
    calibration.build = json.at("build").get<std::string>();
    calibration.date = json.at("date").get<std::string>();
    calibration.model.machine = json.at("machine").get<std::string>();
    calibration.reported = caches_from(json.at("caches").at("reported"));
    calibration.model.caches = caches_from(json.at("caches").at("used"));
    if (calibration.model.caches.level_bytes.empty()) throw InvalidArgument("has no caches");
    for (const Json& level : json.at("caches").at("found")) {
      calibration.found.levels.push_back(
          {level.at("bytes").get<Offset>(), number_from(level.at("nanoseconds"))});
    }
    calibration.found.memory_nanoseconds = number_from(json.at("memory_nanoseconds"));
    calibration.threads = json.at("threads").get<int>();
    if (calibration.threads < 1) throw InvalidArgument("has no threads");
    calibration.all_threads.machine = calibration.model.machine;
    calibration.all_threads.caches = calibration.model.caches;
    calibration.all_threads.threads = calibration.threads;
    calibration.read_bandwidth = number_from(json.at("read_bandwidth").at("one_thread"));
    calibration.read_bandwidth_all = number_from(json.at("read_bandwidth").at("all"));
    for (std::size_t k = 0; k < kKernels.size(); ++k) {
      const Json& kernel = json.at("kernels").at(std::string(to_string(kKernels[k])));
      kernel_from(kernel, k, calibration.model, calibration.quality);
      kernel_from(kernel.at("all_threads"), k, calibration.all_threads, calibration.all_threads_quality);
    }
    const Json& steadiness = json.at("steadiness");
    calibration.steadiness = {number_from(steadiness.at("waiting")), number_from(steadiness.at("pace")),
                              number_from(steadiness.at("repeat"))};
    calibration.seconds = number_from(json.at("seconds"));
    return calibration;
  } catch (const Json::exception& error) {
    throw InvalidArgument(std::string("is damaged: ") + error.what());
  }
}

StoredCalibration load_calibration(const CalibrationKey& key) {
  const fs::path file = calibration_file(key);
  std::error_code code;
  if (file.empty() || !fs::exists(file, code)) return {};
  const auto refused = [&](const std::string& why) {
    return StoredCalibration{{}, "the calibration in " + file.string() + " is not used: it " + why};
  };
  constexpr std::size_t kMost = 1 << 20;
  try {
    const std::string text = InputFile(file, std::array{user_cache_folder()}).text(kMost);
    if (text.empty()) return refused("is empty");
    Calibration calibration = parse_calibration(text);
    if (key_of(calibration) != key) return refused("is of another machine or build");
    return {std::move(calibration), {}};
  } catch (const InvalidArgument& error) {
    return refused(error.what());
  } catch (const InputError& error) {
    return StoredCalibration{{}, std::string("the calibration is not used: ") + error.what()};
  }
}

fs::path save_calibration(const Calibration& calibration) {
  fs::path file = calibration_file(key_of(calibration));
  constexpr const char* kRemedy = "set MESHORDER_CACHE to a folder that can be written";
  if (file.empty()) {
    throw Error(Code::io,
                std::string("calibration: neither HOME nor XDG_CACHE_HOME is set, so there is no folder "
                            "to keep it in; ") +
                    kRemedy);
  }
  std::error_code ignored;  // if this fails, opening the output reports the error
  fs::create_directories(file.parent_path(), ignored);
  try {
    OutputFile out(FilePath::in(user_cache_folder(), file));
    out.write(to_json_text(calibration));
    out.commit();
  } catch (const InputError& error) {
    throw Error(Code::io, fmt::format("calibration: {}; or {}", error.what(), kRemedy));
  }
  return file;
}

}  // namespace meshorder
