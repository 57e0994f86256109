// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Shared by several benchmarks.
#include "lab/scenario/scenario.hpp"
#include "payoff/memory_probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

/// Returns the parts of "a,b,c".
inline std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

/// Returns the median, the upper one of two middle values.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Measures, prints and returns the rates at which one and two threads read memory, 10⁹ bytes a second.
inline std::vector<double> measure_bandwidths() {
  std::vector<double> bandwidths;
  for (int threads = 1; threads <= 2; ++threads) {
    bandwidths.push_back(meshorder::read_bandwidth(std::size_t{512} << 20, 8, threads));
    fmt::print("{} thread{} read{} {:.1f} GB/s\n", threads, threads == 1 ? "" : "s", threads == 1 ? "s" : "",
               bandwidths.back());
  }
  return bandwidths;
}

/// Returns the scenario with its vertices in that order, and its elements in the matching order.
inline meshorder::Scenario in_order(meshorder::Scenario scenario, const std::string& order) {
  scenario.vertex_order = order;
  scenario.element_order = order == "original" || order == "scrambled" ? order : "lexmax";
  return scenario;
}
