// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "graph/csr_graph.hpp"
#include <meshorder/layouts.hpp>
#include <meshorder/mesh.hpp>

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Costs of kernels on a graphics processor, counted for a mesh in its order and in others.

namespace meshorder::command {

/// Returns the points and cells of a mesh, reordered. O(cells).
Mesh in_order(const Mesh& mesh, const MeshOrder& order);

/// Returns whether a mesh has elements and all have the same number of vertices, few enough for patches.
/// O(cells).
bool counts_additions(const Mesh& mesh);

/// Returns the cost of adding values of elements to their vertices, in the mesh's order; nothing if
/// `counts_additions` returns false.
std::optional<GpuCost> cost_of_additions(const Mesh& mesh, GpuLayout layout);

/// Returns the factor by which a kernel touches fewer sectors in the new order.
double sector_ratio(const GpuCost& as_is, const GpuCost& ordered);

/// A graphics processor with known times of element forces of tetrahedra in single precision, for the layouts
/// packed, apart and padded (benchmarks/gpu_card.py).
struct GpuCard {
  std::string_view name;   ///< value of --card
  std::string_view title;  ///< in a sentence
  double launch_us;
  double us_per_sector;
  double us_per_byte;  ///< for each byte that is read from memory more than once

  /// Returns the time of a kernel in µs. The times of sectors and of bytes are added as the sides of a right
  /// angle, since they overlap in part.
  [[nodiscard]] double time(const GpuCost& cost) const;
};

std::vector<std::string> gpu_card_names();

/// Returns the card of this name; null for an empty or unknown name.
const GpuCard* gpu_card(std::string_view name);

/// Costs of a kernel in the file's order and in the order for graphics processors.
struct CountedKernel {
  std::string_view key;    ///< in JSON
  std::string_view title;  ///< in a table
  GpuCost as_is;
  GpuCost ordered;
  std::optional<double> as_is_us = {};  ///< time on a card, if known
  std::optional<double> ordered_us = {};
};

/// The effect of `order --for gpu` on a mesh.
struct GpuReport {
  MeshOrder order;
  std::vector<CountedKernel> additions;  ///< one for each layout; empty unless `counts_additions`
  std::vector<CountedKernel> products;   ///< with one and with eight threads a row; empty without edges
  const GpuCard* card = nullptr;
  std::vector<std::string> notes = {};  ///< what was not counted, and why

  /// Returns whether `order --for gpu` leaves the mesh as it is.
  [[nodiscard]] bool keeps() const;
};

/// Orders a mesh for graphics processors, and counts kernels in its own order and in the new one.
///
/// @param graph  vertex graph of the mesh
/// @param card   card to compute times for, if the mesh has 100,000 linear tetrahedra or more; null: no times
GpuReport gpu_report(const Mesh& mesh, const CsrGraph& graph, const GpuCard* card);

/// Returns in a sentence whether the mesh is in a good order for a graphics processor.
std::string to_string(const GpuReport& report);

/// Prints the command that makes the new order, or the reasons to keep the old order.
void print_next(const Console& console, const GpuReport& report, const std::string& mesh);

void print_counts(const Console& console, const GpuReport& report);

/// Returns the keys that docs/json.md lists.
nlohmann::ordered_json to_json(const GpuCost& cost);
nlohmann::ordered_json to_json(const GpuReport& report);

}  // namespace meshorder::command
