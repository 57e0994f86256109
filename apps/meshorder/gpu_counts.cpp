// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "gpu_counts.hpp"

#include "cells/cell_arrays.hpp"
#include "graph/incidence.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "mesh/stored_matrix.hpp"
#include "wording.hpp"
#include <meshorder/view.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <span>

namespace meshorder::command {
namespace {

constexpr std::array kCards{GpuCard{.name = "h100",
                                    .title = "an NVIDIA H100",
                                    .launch_us = 4.0,
                                    .us_per_sector = 15.9e-6,
                                    .us_per_byte = 1.65e-6}};

/// Fewest tetrahedra for which times are shown; the smallest mesh in the tests of times has 161,222.
constexpr Index kFewestTimed = 100'000;

constexpr std::array<std::string_view, kGpuLayouts.size()> kAdditions{
    "additions, packed", "additions, apart", "additions, padded", "additions, patches",
    "two passes, gathered"};
constexpr std::array kLanes{1, 8};
constexpr std::array<std::string_view, kLanes.size()> kProducts{"product, 1 thread a row",
                                                                "product, 8 threads a row"};
constexpr std::array<std::string_view, kLanes.size()> kProductKeys{"product_1", "product_8"};

/// Returns whether times of element forces are known for a layout.
bool has_times(GpuLayout layout) {
  return layout == GpuLayout::packed || layout == GpuLayout::apart || layout == GpuLayout::padded;
}

/// Returns whether times are known for the elements of a mesh.
bool are_timed(const Mesh& mesh) {
  const CellSelection elements = CellSelection::elements(cell_arrays(mesh));
  return elements.size() >= kFewestTimed && common_size(elements.incidence()) == 4 &&
         mesh.cells.highest_dimension() == 3 && std::ranges::all_of(mesh.cells.shapes, [](Shape shape) {
           return dimension(shape) < 3 || shape == Shape::tetrahedron;
         });
}

std::vector<CountedKernel> counted_additions(const Mesh& mesh, const MeshOrder& order, const GpuCard* card) {
  if (stored_matrix(mesh) != nullptr || mesh.cells.highest_dimension() < 1) return {};
  const Mesh ordered = in_order(mesh, order);
  const bool has_card = card != nullptr && are_timed(mesh);
  std::vector<CountedKernel> kernels;
  for (std::size_t k = 0; k < kGpuLayouts.size(); ++k) {
    const GpuLayout layout = kGpuLayouts[k];
    const std::optional<GpuCost> before = cost_of_additions(mesh, layout);
    const std::optional<GpuCost> after = cost_of_additions(ordered, layout);
    if (!before || !after) return {};
    CountedKernel kernel{
        .key = to_string(layout), .title = kAdditions[k], .as_is = *before, .ordered = *after};
    if (has_card && has_times(layout)) {
      kernel.as_is_us = card->time(*before);
      kernel.ordered_us = card->time(*after);
    }
    kernels.push_back(kernel);
  }
  return kernels;
}

std::vector<CountedKernel> counted_products(const CsrGraph& graph, const MeshOrder& order) {
  if (graph.neighbours.empty()) return {};
  const CsrGraph ordered = renumbered(graph, order.vertices.permutation.old_to_new());
  const auto cost = [](const CsrGraph& of, int lanes) {
    return gpu_product_cost({.offsets = of.offsets, .neighbours = of.neighbours}, lanes);
  };
  std::vector<CountedKernel> kernels;
  for (std::size_t k = 0; k < kLanes.size(); ++k) {
    kernels.push_back({.key = kProductKeys[k],
                       .title = kProducts[k],
                       .as_is = cost(graph, kLanes[k]),
                       .ordered = cost(ordered, kLanes[k])});
  }
  return kernels;
}

/// Returns the geometric mean of `sector_ratio` over the layouts that `reason_to_keep_on_gpu` uses.
double ratio_of_additions(std::span<const CountedKernel> additions) {
  double sum = 0;
  for (const CountedKernel& kernel : additions.first(3))
    sum += std::log(sector_ratio(kernel.as_is, kernel.ordered));
  return std::exp(sum / 3);
}

bool is_empty(const GpuReport& report) { return report.additions.empty() && report.products.empty(); }

/// Returns whether the first card takes longer to launch each kernel than to touch its sectors.
bool is_bound_by_launches(const GpuReport& report) {
  const GpuCard& card = kCards.front();
  const auto is_short = [&](const CountedKernel& kernel) {
    return card.time(kernel.as_is) < 2 * card.launch_us;
  };
  return std::ranges::all_of(report.additions, is_short) && std::ranges::all_of(report.products, is_short);
}

bool has_times(const GpuReport& report) {
  return !report.additions.empty() && report.additions.front().as_is_us.has_value();
}

std::string millions(Offset number) { return fmt::format("{:>9.3f}", 1e-6 * static_cast<double>(number)); }
std::string megabytes(Offset bytes) { return fmt::format("{:>9.1f}", 1e-6 * static_cast<double>(bytes)); }

}  // namespace

Mesh in_order(const Mesh& mesh, const MeshOrder& order) {
  Mesh moved;
  moved.points = mesh.points;
  moved.cells = mesh.cells;
  apply_reordering(moved, order);
  return moved;
}

namespace {

bool have_countable_size(const IncidenceRef& elements) {
  constexpr Offset kMostVertices = 255;  // of a cell; a patch holds 256
  const Offset width = common_size(elements);
  return elements.size() > 0 && width > 0 && width <= kMostVertices;
}

}  // namespace

bool counts_additions(const Mesh& mesh) {
  return have_countable_size(CellSelection::elements(cell_arrays(mesh)).incidence());
}

std::optional<GpuCost> cost_of_additions(const Mesh& mesh, GpuLayout layout) {
  const CellSelection selected = CellSelection::elements(cell_arrays(mesh));
  const IncidenceRef elements = selected.incidence();
  if (!have_countable_size(elements)) return std::nullopt;
  return gpu_cost(CellsView::mixed(elements.offsets, elements.vertices), mesh.points.size(), layout);
}

double sector_ratio(const GpuCost& as_is, const GpuCost& ordered) {
  return static_cast<double>(std::max<Offset>(as_is.sectors, 1)) /
         static_cast<double>(std::max<Offset>(ordered.sectors, 1));
}

double GpuCard::time(const GpuCost& cost) const {
  const Offset again = std::max<Offset>(cost.dram_bytes - cost.dram_floor, 0);
  return launch_us + std::hypot(us_per_sector * static_cast<double>(cost.sectors),
                                us_per_byte * static_cast<double>(again));
}

std::vector<std::string> gpu_card_names() {
  std::vector<std::string> names;
  names.reserve(kCards.size());
  for (const GpuCard& card : kCards) names.emplace_back(card.name);
  return names;
}

const GpuCard* gpu_card(std::string_view name) {
  const auto found = std::ranges::find(kCards, name, &GpuCard::name);
  return found == kCards.end() ? nullptr : &*found;
}

bool GpuReport::keeps() const {
  return order.vertices.permutation.is_identity() && order.cells.permutation.is_identity();
}

GpuReport gpu_report(const Mesh& mesh, const CsrGraph& graph, const GpuCard* card) {
  GpuReport report;
  report.order = compute_order_in_file(mesh, graph, {.order = {.workload = Workload::gpu}});
  report.additions = counted_additions(mesh, report.order, card);
  report.products = counted_products(graph, report.order);
  report.card = card;
  const bool has_elements = stored_matrix(mesh) == nullptr && !report.products.empty();
  if (has_elements && report.additions.empty()) {
    report.notes.emplace_back(
        "additions are not counted: not all elements have the same number of vertices, at most 255");
  }
  if (card != nullptr && !has_times(report)) {
    report.notes.push_back(
        fmt::format("--card: no times are shown; they are known for {} linear tetrahedra or more",
                    with_commas(kFewestTimed)));
  }
  return report;
}

std::string to_string(const GpuReport& report) {
  if (is_empty(report)) return "nothing to compute: it has no elements";
  if (report.keeps()) return "its order is good for a graphics processor";
  std::vector<std::string> changes;
  const auto add = [&](const char* of, double ratio) {
    const long percent = std::lround(100 * (1 / ratio - 1));
    if (percent == 0) return;
    const bool is_first = changes.empty();
    changes.push_back(fmt::format("{}{} {} % {}{}", of, is_first ? " touch" : "", std::abs(percent),
                                  percent < 0 ? "fewer" : "more", is_first ? " sectors of memory" : ""));
  };
  if (!report.additions.empty()) add("additions", ratio_of_additions(report.additions));
  if (!report.products.empty())
    add("products", sector_ratio(report.products.front().as_is, report.products.front().ordered));
  std::string sentence = "there is a better order for a graphics processor";
  if (!changes.empty()) sentence += ": " + join(changes);
  if (is_bound_by_launches(report))
    sentence += "; on so small a mesh, kernels gain little: an H100 takes longer to launch them";
  return sentence;
}

void print_next(const Console& console, const GpuReport& report, const std::string& mesh) {
  if (!report.keeps()) {
    console.print("to order it: meshorder order {} -o {} --for gpu", in_shell(mesh),
                  in_shell(ordered_name(mesh)));
    return;
  }
  for (const Order* const part : {&report.order.vertices, &report.order.cells}) {
    if (!part->method.reason.empty()) console.print("{}", part->method.reason);
  }
}

void print_counts(const Console& console, const GpuReport& report) {
  if (is_empty(report)) return;
  const bool is_new = !report.keeps();
  const bool has_card = has_times(report);
  const auto columns = [&](const std::string& as_is, const std::string& ordered, const std::string& floor) {
    return as_is + (is_new ? ordered : "") + floor;
  };
  const std::string heads = columns(fmt::format("{:>9}", "as it is"), fmt::format("{:>9}", "ordered"), "");
  const std::string times = has_card ? fmt::format("   {}", heads) : "";
  const int width = is_new ? 27 : 18;
  console.print("\n{:<24}{:>{}}   {:>{}}{}", "On a graphics processor", "million sectors", width,
                "MB read from memory", width, has_card ? fmt::format("   {:>{}}", "ms", width - 9) : "");
  console.print("{:<24}{}{:>9}   {}{:>9}{}", "", heads, "floor", heads, "floor", times);
  const auto print_row = [&](const CountedKernel& kernel) {
    const auto time = [&](const std::optional<double>& us) {
      return us ? fmt::format("{:>9.3f}", 1e-3 * *us) : fmt::format("{:>9}", "–");
    };
    const GpuCost& before = kernel.as_is;
    const GpuCost& after = kernel.ordered;
    console.print(
        "{:<24}{}   {}{}", kernel.title,
        columns(millions(before.sectors), millions(after.sectors), millions(after.floor)),
        columns(megabytes(before.dram_bytes), megabytes(after.dram_bytes), megabytes(after.dram_floor)),
        has_card ? "   " + columns(time(kernel.as_is_us), time(kernel.ordered_us), "") : "");
  };
  for (const CountedKernel& kernel : report.additions) print_row(kernel);
  for (const CountedKernel& kernel : report.products) print_row(kernel);
  if (has_card) {
    console.print("ms: element forces of tetrahedra in single precision on {}, computed from the counts",
                  report.card->title);
  }
}

nlohmann::ordered_json to_json(const GpuCost& cost) {
  return {{"requests", cost.requests},
          {"sectors", cost.sectors},
          {"floor", cost.floor},
          {"dram_bytes", cost.dram_bytes},
          {"dram_floor", cost.dram_floor}};
}

nlohmann::ordered_json to_json(const GpuReport& report) {
  nlohmann::ordered_json kernels = nlohmann::ordered_json::object();
  const auto costs = [&](const GpuCost& cost, const std::optional<double>& us) {
    nlohmann::ordered_json result = to_json(cost);
    if (us) result["milliseconds"] = 1e-3 * *us;
    return result;
  };
  for (const auto* const list : {&report.additions, &report.products}) {
    for (const CountedKernel& kernel : *list) {
      kernels[std::string(kernel.key)] = {{"as_it_is", costs(kernel.as_is, kernel.as_is_us)},
                                          {"ordered", costs(kernel.ordered, kernel.ordered_us)}};
    }
  }
  return {{"sentence", to_string(report)},
          {"kept", report.keeps()},
          {"vertices", to_json(report.order.vertices.method)},
          {"elements", to_json(report.order.cells.method)},
          {"card", or_null(report.card != nullptr ? report.card->name : "")},
          {"kernels", kernels}};
}

}  // namespace meshorder::command
