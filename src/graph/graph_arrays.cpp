// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/graph_arrays.hpp"

#include "base/index.hpp"
#include "base/parallel.hpp"
#include <meshorder/error.hpp>

#include <cstdint>
#include <limits>
#include <utility>

namespace meshorder {
namespace {

/// These two functions return number − base and number + base. They use unsigned arithmetic, because a faulty
/// offset can be the smallest or largest int64.
Offset less_base(std::int64_t number, int base) {
  return static_cast<Offset>(static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(base));
}
Offset plus_base(std::int64_t number, int base) {
  return static_cast<Offset>(static_cast<std::uint64_t>(number) + static_cast<std::uint64_t>(base));
}

/// Makes `arrays` refer to the offsets if they have 64 bits and base 0, else to a converted copy.
void take_offsets(const GraphView& graph, GraphArrays& arrays) {
  const IndexView& offsets = graph.offsets;
  if (offsets.empty()) {
    arrays.own_offsets = {0};
  } else if (offsets.bytes() == 8 && graph.base == 0) {
    arrays.offsets = {static_cast<const Offset*>(offsets.data()), offsets.size()};
    return;
  } else {
    arrays.own_offsets.resize(offsets.size());
    with_type(offsets, [&](auto entries) {
      for (std::size_t v = 0; v < entries.size(); ++v) {
        arrays.own_offsets[v] = less_base(static_cast<std::int64_t>(entries[v]), graph.base);
      }
    });
    arrays.notes.emplace_back(offsets.bytes() == 4 ? "offsets widened" : "offsets copied to count from 0");
  }
  arrays.offsets = arrays.own_offsets;
}

/// Makes `arrays` refer to the neighbours if they have 32 bits and base 0, else to a converted copy.
void take_neighbours(const GraphView& graph, GraphArrays& arrays) {
  constexpr Offset kEntries = 262144;  // entries that a thread converts at a time
  const IndexView& neighbours = graph.neighbours;
  if (neighbours.bytes() == 4 && graph.base == 0) {
    arrays.neighbours = {static_cast<const Index*>(neighbours.data()), neighbours.size()};
    return;
  }
  arrays.own_neighbours.resize(neighbours.size());
  const auto n = static_cast<std::uint64_t>(arrays.size());
  const auto base = static_cast<std::uint64_t>(graph.base);
  Index* const narrowed = arrays.own_neighbours.data();
  with_type(neighbours, [&](auto entries) {
    for_each_range(static_cast<Offset>(entries.size()), kEntries, [&](Offset begin, Offset end) {
      for (Offset k = begin; k < end; ++k) {
        const std::uint64_t u = static_cast<std::uint64_t>(entries[k]) - base;  // wraps around below the base
        narrowed[k] = u < n ? static_cast<Index>(u) : Index{-1};
      }
    });
  });
  arrays.neighbours = arrays.own_neighbours;
  arrays.notes.emplace_back(neighbours.bytes() == 8 ? "indices narrowed" : "indices copied to count from 0");
}

void take_weights(const RealView& weights, GraphArrays& arrays) {
  if (weights.bytes() == 8) {
    arrays.weights = {static_cast<const double*>(weights.data()), weights.size()};
    return;
  }
  const auto* const narrow = static_cast<const float*>(weights.data());
  arrays.own_weights.assign(narrow, narrow + weights.size());
  arrays.weights = arrays.own_weights;
}

void check_offsets(const GraphView& graph, std::span<const Offset> offsets) {
  const auto given = [&](std::size_t v) { return std::to_string(plus_base(offsets[v], graph.base)); };
  if (offsets.front() != 0) {
    throw InvalidArgument("graph: the first offset is " + given(0) + ", must be the base " +
                          std::to_string(graph.base));
  }
  for (std::size_t v = 0; v + 1 < offsets.size(); ++v) {
    if (offsets[v] > offsets[v + 1]) {
      throw InvalidArgument("graph: the offset of row " +
                            std::to_string(static_cast<Offset>(v) + graph.base) + " is " + given(v) +
                            ", that of the next row only " + given(v + 1));
    }
  }
}

}  // namespace

GraphArrays graph_arrays(const GraphView& graph, bool trusted) {
  if (graph.base != 0 && graph.base != 1) {
    throw InvalidArgument("graph: the base is " + std::to_string(graph.base) + ", must be 0 or 1");
  }
  if (graph.offsets.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max()) + 1) {
    throw TooLarge("graph: " + std::to_string(graph.offsets.size() - 1) +
                   " vertices; at most 2,147,483,647 are possible");
  }
  GraphArrays arrays;
  take_offsets(graph, arrays);
  if (!trusted) check_offsets(graph, arrays.offsets);
  if (std::cmp_not_equal(arrays.offsets.back(), graph.neighbours.size())) {
    throw InvalidArgument("graph: the offsets end at " +
                          std::to_string(plus_base(arrays.offsets.back(), graph.base)) +
                          ", which does not fit " + std::to_string(graph.neighbours.size()) + " neighbours");
  }
  if (!graph.weights.empty() && graph.weights.size() != graph.neighbours.size()) {
    throw InvalidArgument("graph: " + std::to_string(graph.weights.size()) + " weights for " +
                          std::to_string(graph.neighbours.size()) + " neighbours");
  }
  take_neighbours(graph, arrays);
  take_weights(graph.weights, arrays);
  return arrays;
}

}  // namespace meshorder
