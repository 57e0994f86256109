// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/examine.hpp"

#include "base/parallel.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

namespace meshorder {
namespace {

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014, Fast splittable pseudorandom number generators): a
/// bijection.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// Returns a number that differs from run to run, so that nobody can make a file whose asymmetric entries
/// have hashes that add up to zero.
std::uint64_t secret() {
  static const auto number =
      static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
  return number;
}

/// Returns an odd number that looks random; the product of two odd numbers is not zero modulo 2⁶⁴.
std::uint64_t odd_number_of(std::uint32_t v, std::uint64_t seed) {
  const std::uint64_t x = (v + seed) * 0x9e3779b97f4a7c15U;
  return (x ^ (x >> 32U)) * 0xbf58476d1ce4e5b9U | 1U;
}

/// Returns the shortest decimal number that reads back as `value`, so that different numbers look different.
std::string text_of(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

bool is_valid_weight(double weight) { return weight > 0 && std::isfinite(weight); }

template <bool Symmetry, bool Weighted>
GraphFindings examine_rows(const GraphArrays& graph, Index begin, Index end) {
  GraphFindings found;
  const std::uint64_t seed = secret();
  const auto n = static_cast<std::uint32_t>(graph.size());
  for (Index row = begin; row < end; ++row) {
    const auto v = static_cast<std::uint32_t>(row);
    std::uint64_t of_row = 0;
    Index last = -1;
    for (Offset k = graph.offsets[row]; k < graph.offsets[row + 1]; ++k) {
      const auto u = static_cast<std::uint32_t>(graph.neighbours[k]);
      found.out_of_range += u >= n;
      found.loops += u == v;
      found.unordered += graph.neighbours[k] <= last;
      last = graph.neighbours[k];
      if constexpr (Weighted) found.bad_weights += !is_valid_weight(graph.weights[k]);
      if constexpr (Symmetry) {
        std::uint64_t hash = odd_number_of(u, seed);
        if constexpr (Weighted)
          hash = mixed(hash * odd_number_of(v, seed) ^ std::bit_cast<std::uint64_t>(graph.weights[k]));
        // without a branch: in shuffled graphs it is unpredictable which end is larger
        const std::uint64_t sign = std::uint64_t{v < u} - std::uint64_t{v > u};
        of_row += sign * hash;
      }
    }
    found.asymmetry += Weighted ? of_row : of_row * odd_number_of(v, seed);
  }
  return found;
}

template <bool Symmetry, bool Weighted>
GraphFindings examine_all(const GraphArrays& graph) {
  constexpr Index kRows = 8192;  // rows that a thread examines at a time
  return sum_over_chunks<GraphFindings>(graph.size(), kRows, [&](Index begin, Index end) {
    return examine_rows<Symmetry, Weighted>(graph, begin, end);
  });
}

}  // namespace

GraphFindings& GraphFindings::operator+=(const GraphFindings& other) noexcept {
  out_of_range += other.out_of_range;
  bad_weights += other.bad_weights;
  loops += other.loops;
  unordered += other.unordered;
  asymmetry += other.asymmetry;
  return *this;
}

GraphFindings examine(const GraphArrays& graph, bool symmetry) {
  if (graph.weights.empty())
    return symmetry ? examine_all<true, false>(graph) : examine_all<false, false>(graph);
  return symmetry ? examine_all<true, true>(graph) : examine_all<false, true>(graph);
}

void refuse_faults(const GraphView& view, const GraphArrays& graph, const GraphFindings& findings) {
  if (findings.out_of_range == 0 && findings.bad_weights == 0) return;
  const Index n = graph.size();
  for (Index row = 0; row < n; ++row) {
    for (Offset k = graph.offsets[row]; k < graph.offsets[row + 1]; ++k) {
      const std::string place =
          std::to_string(k - graph.offsets[row]) + " of row " + std::to_string(Offset{row} + view.base);
      if (graph.neighbours[k] < 0 || graph.neighbours[k] >= n) {
        throw InvalidArgument("graph: neighbour " + place + " is " + std::to_string(view.neighbours[k]) +
                              ", outside " + std::to_string(view.base) + " … " +
                              std::to_string(Offset{n} + view.base - 1));
      }
      if (!graph.weights.empty() && !is_valid_weight(graph.weights[k])) {
        throw InvalidArgument("graph: weight " + place + " is " + text_of(graph.weights[k]) +
                              ", must be positive and finite");
      }
    }
  }
}

void refuse_asymmetry(std::span<const Offset> offsets, std::span<const Index> neighbours,
                      std::span<const double> weights, int base) {
  const auto n = static_cast<Index>(offsets.size() - 1);
  const auto named = [base](Index v) { return std::to_string(Offset{v} + base); };
  const auto refuse = [&](Index row, Index missing) {
    throw InvalidArgument(
        "graph: row " + named(missing) + " has the neighbour " + named(row) + ", but row " + named(row) +
        " lacks " + named(missing) +
        "; a graph has each edge in the rows of both its ends (Symmetry::mirror adds them)");
  };
  // Rows are visited in ascending order, so the lower neighbours of each row are matched in ascending order
  // too.
  std::vector<Offset> cursor(offsets.begin(), offsets.end() - 1);
  for (Index v = 0; v < n; ++v) {
    // the row of a lower neighbour lacks v
    if (cursor[v] < offsets[v + 1] && neighbours[cursor[v]] < v) refuse(neighbours[cursor[v]], v);
    for (Offset k = cursor[v]; k < offsets[v + 1]; ++k) {
      const Index u = neighbours[k];
      const Offset mirrored = cursor[u];
      const bool at_end = mirrored == offsets[u + 1];
      if (at_end || neighbours[mirrored] > v) refuse(u, v);
      if (neighbours[mirrored] < v) refuse(neighbours[mirrored], u);
      if (!weights.empty() && weights[k] != weights[mirrored]) {
        throw InvalidArgument("graph: the weight from " + named(v) + " to " + named(u) + " is " +
                              text_of(weights[k]) + ", the weight back is " + text_of(weights[mirrored]));
      }
      ++cursor[u];
    }
  }
}

}  // namespace meshorder
