// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/tables/each_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace meshorder {
namespace {

void add(Table& table, const char* what, TableCell cell) {
  if (!cell.text.empty()) table.rows.push_back({text_cell(what), std::move(cell)});
}

TableCell with_unit(double number, const char* unit) {
  if (number <= 0) return {};
  return {fmt::format("{} {}", with_digits(number, 3), unit), number, false};
}

/// Returns `word_for(scenario)` once if all scenarios agree, else for each: "falling 240, bowl 120".
template <class WordFor>
std::string of_scenarios(const StudyResults& results, WordFor word_for) {
  std::vector<std::string> words;
  for (const ScenarioRecord& scenario : results.scenarios) words.push_back(word_for(scenario));
  if (words.empty()) return {};
  if (std::all_of(words.begin(), words.end(), [&](const std::string& w) { return w == words.front(); })) {
    return words.front();
  }
  for (std::size_t s = 0; s < words.size(); ++s) words[s] = results.scenarios[s].name + " " + words[s];
  return fmt::format("{}", fmt::join(words, ", "));
}

/// Returns "46,316 vertices, 161,222 tetrahedra, 253,111 edges".
std::string mesh_in_words(const MeshRecord& mesh) {
  return fmt::format("{} vertices, {} tetrahedra, {} edges", count_cell(mesh.vertices).text,
                     count_cell(mesh.tetrahedra).text, count_cell(mesh.edges).text);
}

/// Returns "vertices fiedler, elements original; on dragon: hilbert, lexmax".
std::string methods_in_words(const StudyResults& results, const OrderingSpec& ordering) {
  std::string words = fmt::format("vertices {}, elements {}", ordering.vertices, ordering.elements);
  for (const MeshRecord& mesh : results.meshes) {
    const MeshOrderRecord* const order = find_order(mesh, ordering.name);
    if (order == nullptr ||
        (order->vertex_method == ordering.vertices && order->element_method == ordering.elements)) {
      continue;
    }
    words += fmt::format("; on {}: {}, {}", mesh.name, order->vertex_method, order->element_method);
  }
  return words;
}

}  // namespace

Table machine_table(const StudyResults& results) {
  Table table{
      "machine", "The machine", "The machine and the program of all measurements here.", {"What", "Is"}, {}};
  const MachineRecord& machine = results.machine;
  add(table, "Processor", text_cell(machine.processor));
  if (machine.cores > 0) add(table, "Cores", count_cell(machine.cores));
  std::vector<std::string> caches;
  for (const Offset bytes : machine.caches.level_bytes) {
    caches.push_back(fmt::format("L{} {}", caches.size() + 1, bytes_in_words(static_cast<double>(bytes))));
  }
  add(table, "Data caches of a core", text_cell(fmt::format("{}", fmt::join(caches, ", "))));
  if (machine.memory_bytes > 0) {
    const auto bytes = static_cast<double>(machine.memory_bytes);
    add(table, "Memory", {bytes_in_words(bytes), bytes, false});
  }
  add(table, "Read bandwidth, one thread", with_unit(machine.read_bandwidth, "GB/s"));
  add(table, "Read bandwidth, all threads", with_unit(machine.read_bandwidth_all, "GB/s"));
  add(table, "System", text_cell(machine.system));
  if (!machine.program.empty()) add(table, "Program", text_cell(program_in_words(machine)));
  add(table, "Compiler", text_cell(machine.compiler));
  add(table, "Its options", text_cell(machine.flags));
  add(table, "SIMD of the kernels", text_cell(machine.simd));
  return table;
}

Table protocol_table(const StudyResults& results) {
  Table table{"protocol",
              "How it was measured",
              results.scenarios.empty() ? "" : "Only the steps are timed.",
              {"What", "Is"},
              {}};
  add(table, "Began", text_cell(results.began));
  if (!results.scenarios.empty()) {
    add(table, "Steps",
        text_cell(of_scenarios(results, [](const ScenarioRecord& s) { return fmt::format("{}", s.steps); })));
    add(table, "Runs of each", count_cell(results.runs));
    add(table, "Threads", count_cell(results.threads));
    add(table, "Threads bound to", text_cell(of_scenarios(results, [](const ScenarioRecord& s) {
          return s.processors.empty() ? "no processor"
                                      : fmt::format("processor {}", fmt::join(s.processors, "+"));
        })));
    add(table, "Orders take turns", text_cell(of_scenarios(results, [](const ScenarioRecord& s) {
          return s.interleaved ? fmt::format("of {} steps", s.turn)
                               : "of whole runs, since memory cannot hold all orders";
        })));
    add(table, "Arrays' addresses", text_cell(of_scenarios(results, [](const ScenarioRecord& s) {
          return s.fixed_addresses ? "the same for every order" : "chosen by the system";
        })));
  }
  add(table, "Compared with", text_cell(title_of(results, results.reference)));
  for (const OrderingSpec& ordering : results.orderings) {
    const std::string head = "Order " + title_of(results, ordering.name);
    add(table, head.c_str(), text_cell(methods_in_words(results, ordering)));
  }
  for (const MeshRecord& mesh : results.meshes) {
    const std::string head = "Mesh " + mesh.name;
    add(table, head.c_str(), text_cell(mesh_in_words(mesh)));
  }
  for (const ScenarioRecord& scenario : results.scenarios) {
    const std::string head = "Scenario " + scenario.name;
    add(table, head.c_str(),
        text_cell(fmt::format("{}{}{}, {}, on {}", scenario.title, scenario.title.empty() ? "" : ": ",
                              scenario.method, scenario.material, scenario.mesh)));
  }
  return table;
}

}  // namespace meshorder
