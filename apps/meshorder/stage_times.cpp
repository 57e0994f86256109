// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "stage_times.hpp"

#include "io/stream/file_path.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

namespace meshorder::command {

void StageTimes::end(std::string stage) {
  const double now = since_start_.seconds();
  const auto known = std::ranges::find(stages_, stage, &Stage::name);
  if (known == stages_.end()) {
    stages_.push_back({std::move(stage), now - ended_});
  } else {
    known->seconds += now - ended_;
  }
  ended_ = now;
}

void StageTimes::set_bytes(const std::string& stage, std::uint64_t bytes) {
  for (Stage& s : stages_) {
    if (s.name == stage) s.bytes = bytes;
  }
}

double StageTimes::seconds(const std::string& stage) const {
  const auto known = std::ranges::find(stages_, stage, &Stage::name);
  return known == stages_.end() ? 0 : known->seconds;
}

void StageTimes::print(const Console& console) const {
  const char* of = "time";
  for (const Stage& stage : stages_) {
    const double megabytes = 1e-6 * static_cast<double>(stage.bytes.value_or(0));
    const std::string rate =
        megabytes > 0 && stage.seconds > 0 ? fmt::format("{:8.0f} MB/s", megabytes / stage.seconds) : "";
    console.print("{:<10} {:<8} {:9.3f} s{}", std::exchange(of, ""), stage.name, stage.seconds, rate);
  }
  console.print("{:<10} {:<8} {:9.3f} s", "", "all", ended_);
}

nlohmann::ordered_json StageTimes::to_json() const {
  nlohmann::ordered_json stages = nlohmann::ordered_json::array();
  for (const Stage& stage : stages_) {
    nlohmann::ordered_json bytes;
    if (stage.bytes) bytes = *stage.bytes;
    stages.push_back({{"stage", stage.name}, {"seconds", stage.seconds}, {"bytes", bytes}});
  }
  return stages;
}

std::uint64_t bytes_on_disk(const std::string& mesh) {
  const FilePath path(mesh);
  std::vector<std::filesystem::path> files{path.path()};
  const auto add_companions = [&](const std::vector<std::string>& extensions) {
    for (const std::string& extension : extensions) files.push_back(path.companion(extension).path());
  };
  if (mesh.ends_with(".node") || mesh.ends_with(".ele")) add_companions({".node", ".ele", ".face", ".edge"});
  if (mesh.ends_with(".xdmf") || mesh.ends_with(".xmf")) add_companions({".h5"});
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  std::uint64_t sum = 0;
  for (const std::filesystem::path& file : files) {
    std::error_code absent;
    const std::uint64_t bytes = std::filesystem::file_size(file, absent);
    sum += absent ? 0 : bytes;
  }
  return sum;
}

}  // namespace meshorder::command
