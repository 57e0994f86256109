// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/judgement.hpp"

#include "cells/warp_sectors.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace meshorder {
namespace {

constexpr double kGain = 0.98;            // largest new figure, as a share of the old one, that is a gain
constexpr double kTolerated = 1.05;       // largest new figure, as a share of the old one, that is tolerated
constexpr Index kBeyondCaches = 100'000;  // vertices; on smaller meshes good orders differ by less than 3 %
constexpr double kNotable = 0.1;  // difference of jump shares that decides: 2 to 4 % of a product's time
constexpr double kGainOnGpu =
    0.9;  // as kGain, for numbers of sectors: repeats of a kernel differ by a few per cent
constexpr Index kWarpsToLookAt = 4096;  // warps in a sample; counting more changes results by less than 1 %

std::string with_digits(double number, int digits) {
  std::array<char, 32> text{};
  return {
      text.data(),
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed, digits).ptr};
}

std::string with_one_digit(double number) { return with_digits(number, 1); }

std::string sentence(const std::string& what, const std::string& old_figure, std::string_view method,
                     const std::string& new_figure) {
  return std::string(method) + " is no better: " + what + " is " + old_figure + " in the old order and " +
         new_figure + " in the new one";
}

/// Returns k if every k-th warp of `threads` threads is to be counted: 1 for few threads.
Index stride_of_warps(Index threads) { return std::max<Index>(1, threads / kWarp / kWarpsToLookAt); }

/// Returns whether a workload reads vectors along the rows or edges of the graph.
bool sweeps_over_rows(Workload workload) {
  return workload == Workload::all || workload == Workload::spmv || workload == Workload::springs;
}

}  // namespace

std::string reason_to_keep(GraphRef graph, const Permutation& order, std::string_view method,
                           Workload workload) {
  const Permutation as_is = Permutation::identity(graph.size());
  if (workload == Workload::fill) {
    const Offset before = factor_entries(graph, as_is);
    const Offset after = factor_entries(graph, order);
    if (after < before) return {};
    return sentence("the number of entries in the factor", std::to_string(before), method,
                    std::to_string(after));
  }
  if (workload == Workload::bandwidth) {
    const Index before = span_size(graph, {}).max;
    const Index after = span_size(graph, order.old_to_new()).max;
    if (after < before) return {};
    return sentence("the bandwidth", std::to_string(before), method, std::to_string(after));
  }
  if (workload == Workload::gpu) {
    const Index stride = stride_of_warps(graph.size());
    const Offset before = sectors_of_product(graph, as_is, stride);
    const Offset after = sectors_of_product(graph, order, stride);
    if (static_cast<double>(after) <= kGainOnGpu * static_cast<double>(before)) return {};
    return sentence("the number of sectors that a product reads on a graphics processor",
                    std::to_string(before * stride), method, std::to_string(after * stride));
  }
  const bool is_large = graph.size() >= kBeyondCaches;
  const double old_jumps = is_large ? sampled_jump_share(graph, as_is) : 0;
  const double new_jumps = is_large ? sampled_jump_share(graph, order) : 0;
  if (new_jumps > old_jumps + kNotable) {
    return sentence("the share of lines that a sweep first reads out of order", with_digits(old_jumps, 2),
                    method, with_digits(new_jumps, 2));
  }
  if (new_jumps < old_jumps - kNotable && sweeps_over_rows(workload)) return {};
  const EdgeSpan before = sampled_edge_span(graph, {});
  const EdgeSpan after = sampled_edge_span(graph, order.old_to_new());
  if (after.mean <= kGain * before.mean) return {};
  const bool gains_in_logs = after.mean_log2 <= before.mean_log2 + std::log2(kGain);
  if (after.mean <= kTolerated * before.mean && gains_in_logs) return {};
  return sentence("the mean edge span", with_one_digit(before.mean), method, with_one_digit(after.mean));
}

std::string reason_to_keep_elements(IncidenceRef elements, std::span<const Index> as_is,
                                    std::span<const Index> order, std::string_view method) {
  const auto before = working_sets(elements, as_is);
  const auto after = working_sets(elements, order);
  std::array<double, kElementsAtOnce.size()> ratios{};
  for (std::size_t k = 0; k < ratios.size(); ++k) ratios[k] = after[k] / std::max(before[k], 1.0);
  const auto [best, worst] = std::minmax_element(ratios.begin(), ratios.end());
  if (*best <= kGain && *worst <= kTolerated) return {};
  const auto telling = static_cast<std::size_t>((*worst > kTolerated ? worst : best) - ratios.begin());
  return sentence("the mean number of vertices that " + std::to_string(kElementsAtOnce[telling]) +
                      " consecutive elements use",
                  with_one_digit(before[telling]), method, with_one_digit(after[telling]));
}

std::string reason_to_keep_on_gpu(IncidenceRef elements, const Permutation& vertices,
                                  std::span<const Index> order, std::string_view method) {
  constexpr std::array kLayouts{GpuLayout::packed, GpuLayout::apart, GpuLayout::padded};
  const Index stride = stride_of_warps(elements.size());
  const ElementOrder as_is{.elements = elements, .vertex_old_to_new = vertices.old_to_new()};
  const ElementOrder moved{
      .elements = elements, .new_to_old = order, .vertex_old_to_new = vertices.old_to_new()};
  double before = 0;  // sums of logarithms
  double after = 0;
  for (const GpuLayout layout : kLayouts) {
    before += std::log(std::max<Offset>(1, sectors_of_additions(as_is, layout, stride) * stride));
    after += std::log(std::max<Offset>(1, sectors_of_additions(moved, layout, stride) * stride));
  }
  before = std::exp(before / kLayouts.size());
  after = std::exp(after / kLayouts.size());
  if (after <= kGainOnGpu * before) return {};
  return sentence("the number of sectors that atomic additions write on a graphics processor",
                  with_digits(before, 0), method, with_digits(after, 0));
}

}  // namespace meshorder
