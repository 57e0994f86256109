// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "console.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <memory>

namespace meshorder::command {
namespace {

template <class Methods>
nlohmann::ordered_json list_json(const Methods& methods) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& method : methods)
    list.push_back({{"name", method.name}, {"sentence", method.description}});
  return list;
}

template <class Methods>
void list_text(const Console& console, const Methods& methods) {
  for (const auto& method : methods) console.print_list("  {:<14} {}", method.name, method.description);
}

void run(const Common& common) {
  const Console console(common);
  console.print_list("Methods for vertices (--vertices):");
  list_text(console, vertex_methods());
  console.print_list("\nMethods for elements (--elements); cells of lower dimension follow lexmax:");
  list_text(console, element_methods());
  console.print_json({{"vertices", list_json(vertex_methods())}, {"elements", list_json(element_methods())}});
}

}  // namespace

void add_methods(CLI::App& subcommand) {
  subcommand.description("List and describe the ordering methods.");
  subcommand.footer(
      "Example:\n"
      "  meshorder methods");
  const auto common = std::make_shared<Common>();
  add_common(subcommand, *common, kQuietList);
  subcommand.callback([common] { run(*common); });
}

}  // namespace meshorder::command
