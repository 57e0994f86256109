// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "report.hpp"

#include "base/memory.hpp"
#include "base/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <algorithm>
#include <numeric>
#include <string>

namespace meshorder::command {
namespace {

using distributed::DistributedOptions;
using distributed::DistributedReport;
using distributed::GlobalEdgeSpan;
using distributed::GlobalIndex;

nlohmann::ordered_json span_json(const GlobalEdgeSpan& span) {
  return {{"mean", span.mean}, {"max", span.max}, {"mean_log2", span.mean_log2}};
}

double share_of_edges(const DistributedReport& report) {
  return report.edges > 0 ? static_cast<double>(report.cut) / static_cast<double>(report.edges) : 0;
}

}  // namespace

std::int64_t peak_memory() {
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-union-access): glibc's declaration
  return std::int64_t{usage.ru_maxrss} * 1024;  // Linux counts in KiB
}

void print_report(const Console& console, const DistributedOptions& options, const DistributedReport& report,
                  const std::vector<std::int64_t>& peaks, const StoredMatrix* stored) {
  const bool is_matrix = stored != nullptr && !stored->is_graph;
  console.print(
      "{:<10} {} by {}, {:.2f} % of the edges between them, largest {:.3f} of the mean by {}, {} neighbours "
      "in other parts",
      "parts", report.parts, to_string(report.partitioner), 100 * share_of_edges(report), report.imbalance,
      to_string(options.balance), with_commas(report.ghosts));
  console.print(
      "{:<10} {} {}, {} on the interfaces{}", is_matrix ? "rows" : "vertices", options.vertices,
      report.partitioner == distributed::Partitioner::order ? "of the whole mesh" : "in each part",
      with_commas(std::accumulate(report.interfaces.begin(), report.interfaces.end(), GlobalIndex{0})),
      options.interface_place == distributed::InterfacePlace::last ? ", after the others" : "");
  if (stored == nullptr) console.print("{:<10} lexmax", "elements");
  if (is_matrix) console.print("{:<10} keep their places in the file", "entries");
  console.print("{:<10} mean {:.1f} → {:.1f}, largest {} → {}, mean log2 {:.2f} → {:.2f}",
                stored != nullptr ? "distance" : "edge span", report.before.mean, report.after.mean,
                with_commas(report.before.max), with_commas(report.after.max), report.before.mean_log2,
                report.after.mean_log2);
  std::string stages;
  for (const auto& [stage, seconds] : report.seconds)
    stages += fmt::format("{}{} {}", stages.empty() ? "" : ", ", stage, duration(seconds));
  console.print("{:<10} {}", "time", stages);
  console.print("{:<10} at most {} on a rank, {} at rank 0", "memory",
                size_text(static_cast<std::uint64_t>(*std::max_element(peaks.begin(), peaks.end()))),
                size_text(static_cast<std::uint64_t>(peaks.front())));
}

nlohmann::ordered_json to_json(const DistributedOptions& options, const DistributedReport& report,
                               const std::vector<std::int64_t>& peaks) {
  nlohmann::ordered_json seconds;
  for (const auto& [stage, time] : report.seconds) seconds[std::string(stage)] = time;
  const std::vector<distributed::GlobalIndex> first_vertices(report.part_starts.begin(),
                                                             report.part_starts.end() - 1);
  return {{"ranks", peaks.size()},
          {"parts", report.parts},
          {"partition",
           {{"method", to_string(report.partitioner)},
            {"because", report.partition_reason.empty() ? nlohmann::ordered_json(nullptr)
                                                        : nlohmann::ordered_json(report.partition_reason)},
            {"edges", report.edges},
            {"cut", report.cut},
            {"balance", to_string(options.balance)},
            {"imbalance", report.imbalance},
            {"ghosts", report.ghosts},
            {"first_vertices", first_vertices},
            {"interface", to_string(options.interface_place)},
            {"interface_vertices", report.interfaces}}},
          {"edge_span", {{"before", span_json(report.before)}, {"after", span_json(report.after)}}},
          {"memory_bytes", peaks},
          {"seconds", seconds}};
}

}  // namespace meshorder::command
