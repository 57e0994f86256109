// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "reuse_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sstream>

namespace meshorder::command {
namespace {

constexpr int kLogWidth = 8;
constexpr int kMissesWidth = 7;

/// Returns a count with three digits: "954k", "1.09M".
std::string short_count(Offset count) {
  const auto number = static_cast<double>(count);
  if (number < 1e3) return std::to_string(count);
  if (number < 999.5e3) return fmt::format("{:.3g}k", number * 1e-3);
  if (number < 999.5e6) return fmt::format("{:.3g}M", number * 1e-6);
  return fmt::format("{:.3g}G", number * 1e-9);
}

std::string count_cell(Offset count) { return fmt::format("{:>{}}", short_count(count), kMissesWidth); }

}  // namespace

nlohmann::ordered_json to_json(const KernelReuse& reuse, const Caches& caches,
                               std::span<const Kernel> kernels) {
  nlohmann::ordered_json result;
  for (std::size_t k = 0; k < kernels.size(); ++k) {
    result[std::string(to_string(kKernels[k]))] = {{"accesses", reuse[k].all.accesses()},
                                                   {"misses", misses(reuse[k].all, caches)},
                                                   {"jumps", misses(reuse[k].jumps, caches)},
                                                   {"mean_log2", reuse[k].all.mean_log2()}};
  }
  return result;
}

std::string reuse_header(const Caches& caches) {
  std::string header = fmt::format("{:>{}}", "log2", kLogWidth);
  std::istringstream sizes(to_string(caches));
  for (std::string size; std::getline(sizes, size, ',');) header += fmt::format("{:>{}}", size, kMissesWidth);
  return header + fmt::format("{:>{}}", "jumps", kMissesWidth);
}

std::string reuse_cells(const Reuse& of_kernel, const Caches& caches) {
  std::string cells = fmt::format("{:>{}.2f}", of_kernel.all.mean_log2(), kLogWidth);
  for (const Offset count : misses(of_kernel.all, caches)) cells += count_cell(count);
  return cells + count_cell(misses(of_kernel.jumps, caches).back());
}

}  // namespace meshorder::command
