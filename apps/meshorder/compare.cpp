// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "console.hpp"
#include "progress.hpp"
#include "report.hpp"
#include <meshorder/base/stopwatch.hpp>
#include <meshorder/io/format.hpp>
#include <meshorder/mesh/graphs.hpp>
#include <meshorder/mesh/mesh_ordering.hpp>
#include <meshorder/mesh/reorder.hpp>
#include <meshorder/metrics/edge_span.hpp>
#include <meshorder/study/kernel_timing.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace meshorder::command {
namespace {

struct CompareArguments : Common {
  std::string input;
  std::vector<std::string> methods;
  OrderingOptions ordering;
  double budget_seconds = TimingOptions{}.budget_seconds;
};

/// One order in the comparison: its names, what it cost and how good it is.
struct Candidate {
  std::string vertices;
  std::string elements;
  Reordering order;
  EdgeSpan span;
};

std::vector<std::string> default_methods() {
  std::vector<std::string> names;
  for (const VertexMethod& method : vertex_methods()) names.emplace_back(method.name);
  names.insert(std::find(names.begin(), names.end(), "fiedler") + 1, "fiedler/fiedler");
  return names;
}

/// VERTICES or VERTICES/ELEMENTS; elements follow the default where only vertices are named, and stay or are
/// scrambled when vertices do or are.
Candidate parsed(const std::string& name) {
  Candidate candidate;
  const auto slash = name.find('/');
  candidate.vertices = name.substr(0, slash);
  const bool plain = candidate.vertices == "original" || candidate.vertices == "scrambled";
  candidate.elements = slash != std::string::npos ? name.substr(slash + 1)
                       : plain                    ? candidate.vertices
                                                  : ReorderingOptions{}.elements;
  return candidate;
}

/// The candidates with scrambled/scrambled, the point of reference, in front.
std::vector<Candidate> candidates_of(const std::vector<std::string>& names) {
  std::vector<Candidate> candidates{parsed("scrambled")};
  for (const std::string& name : names) {
    const Candidate candidate = parsed(name);
    const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
      return c.vertices == candidate.vertices && c.elements == candidate.elements;
    });
    if (!known) candidates.push_back(candidate);
  }
  return candidates;
}

void print_quality(const Console& console, const std::vector<Candidate>& candidates) {
  console.print("\n{:<11} {:<14} {:>8} {:>12} {:>10} {:>10}", "vertices", "elements", "cost", "span: mean",
                "max", "mean log2");
  for (const Candidate& c : candidates) {
    console.print("{:<11} {:<14} {:>8} {:>12.1f} {:>10} {:>10.2f}", c.vertices, c.elements,
                  duration(c.order.vertex_seconds + c.order.element_seconds), c.span.mean,
                  with_commas(c.span.max), c.span.mean_log2);
  }
}

void print_kernels(const Console& console, const std::vector<Candidate>& candidates,
                   const std::vector<OrderTimes>& times) {
  console.print(
      "\nKernels: best and median milliseconds, speedup of the best over scrambled (one thread, rounds "
      "interleaved)");
  console.print("{:<11} {:<14} {:>20} {:>20} {:>20} {:>20}", "vertices", "elements", "SpMV", "element force",
                "assembly", "springs");
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    std::string row = fmt::format("{:<11} {:<14}", candidates[i].vertices, candidates[i].elements);
    for (const Kernel kernel : kKernels) {
      const KernelTimes& t = times[i][kernel];
      row += fmt::format(" {:>6.3g} {:>6.3g} {:>5.2f}x", t.best_ms, t.median_ms, t.speedup);
    }
    console.print("{}", row);
  }
}

nlohmann::ordered_json table_json(const std::vector<Candidate>& candidates,
                                  const std::vector<OrderTimes>& times) {
  auto methods = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    nlohmann::ordered_json kernels;
    for (const Kernel kernel : kKernels) {
      const KernelTimes& t = times[i][kernel];
      kernels[std::string(name(kernel))] = {{"milliseconds", t.median_ms},
                                            {"best_milliseconds", t.best_ms},
                                            {"samples", t.samples},
                                            {"speedup", t.speedup}};
    }
    methods.push_back({{"vertices", c.vertices},
                       {"elements", c.elements},
                       {"seconds", c.order.vertex_seconds + c.order.element_seconds},
                       {"edge_span", to_json(c.span)},
                       {"fiedler", to_json(c.order.vertex_fiedler)},
                       {"kernels", kernels}});
  }
  return methods;
}

void run(const CompareArguments& arguments) {
  const Console console(arguments);
  Progress progress(!console.quiet());
  progress.stage("reading " + arguments.input, 0, 0.05);
  Notes notes;
  Mesh mesh = read_mesh(arguments.input, &notes);
  mesh.cell_blocks.clear();  // what is compared is the orders, not a file's layout
  const CsrGraph graph = vertex_graph(mesh);

  std::vector<Candidate> candidates = candidates_of(arguments.methods);
  const double share = 0.35 / static_cast<double>(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Candidate& c = candidates[i];
    const double from = 0.05 + share * static_cast<double>(i);
    progress.stage("ordering by " + c.vertices + "/" + c.elements, from, from + share);
    c.order = compute_reordering(mesh, graph, {c.vertices, c.elements, arguments.ordering});
    c.span = edge_span(graph, c.order.vertices);
    note_convergence(c.order.vertex_fiedler, "the vertices by " + c.vertices, notes);
  }

  progress.stage("running kernels", 0.4, 1);
  TimingOptions timing;
  timing.budget_seconds = arguments.budget_seconds;
  const std::vector<OrderTimes> times = time_orders(
      index_size(candidates),
      [&](Index i) {
        Mesh ordered = mesh;
        reorder(ordered, candidates[i].order.vertices, candidates[i].order.cells);
        return KernelBench(ordered, renumbered(graph, candidates[i].order.vertices.old_to_new()));
      },
      timing);

  progress.finish();
  console.log_notes(notes);
  console.print("{}: {} vertices, {}", arguments.input, with_commas(mesh.vertex_count()),
                cells_in_words(mesh));
  print_quality(console, candidates);
  print_kernels(console, candidates, times);
  console.print_json({{"file", arguments.input},
                      {"vertices", mesh.vertex_count()},
                      {"cells", cells_by_type(mesh)},
                      {"reference", "scrambled"},
                      {"methods", table_json(candidates, times)}});
}

}  // namespace

void add_compare(CLI::App& app) {
  CLI::App* subcommand = app.add_subcommand(
      "compare", "Every order's cost, quality and measured simulation kernels on this machine, in one table");
  const auto arguments = std::make_shared<CompareArguments>();
  arguments->methods = default_methods();
  subcommand->add_option("MESH", arguments->input, "Mesh file")->required();
  subcommand
      ->add_option("--methods", arguments->methods,
                   "Orders to compare, VERTICES or VERTICES/ELEMENTS, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  subcommand->add_option("--budget", arguments->budget_seconds, "Seconds to spend on running kernels")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_ordering_options(*subcommand, arguments->ordering);
  add_common(*subcommand, *arguments);
  subcommand->callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
