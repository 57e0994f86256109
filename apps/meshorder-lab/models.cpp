// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "console.hpp"
#include "lab.hpp"
#include "lab/models/catalogue.hpp"
#include "progress.hpp"
#include "wording.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include <vector>

namespace meshorder::command {
namespace {

struct MakeArguments : Common {
  std::string name;
  MakeOptions options;
};

nlohmann::ordered_json model_json(const Model& model) {
  const bool made = !model.path.empty();
  return {{"name", model.name},
          {"sentence", model.description},
          {"path", or_null(model.path.string())},
          {"vertices", made ? nlohmann::ordered_json(model.vertices) : nlohmann::ordered_json(nullptr)},
          {"elements", made ? nlohmann::ordered_json(model.elements) : nlohmann::ordered_json(nullptr)}};
}

void print_model(const Console& console, const Model& model) {
  if (model.path.empty()) {
    console.print_list("  {:<16} {:>10} {:>12}  {}", model.name, "–", "–", model.description);
  } else {
    console.print_list("  {:<16} {:>10} {:>12}  {}", model.name, with_commas(model.vertices),
                       with_commas(model.elements), model.path.string());
  }
}

void list(const Common& common) {
  const Console console(common);
  auto models = nlohmann::ordered_json::array();
  console.print_list("  {:<16} {:>10} {:>12}", "model", "vertices", "elements");
  for (const Model& model : list_models()) {
    print_model(console, model);
    models.push_back(model_json(model));
  }
  console.print_list("Models without a path do not exist yet; `meshorder models make NAME` makes one");
  console.print_json({{"models", models}});
}

/// Adds the options given before `make` to those given after it; both have the same meaning.
void add_options_before(const Common& common, MakeArguments& arguments) {
  arguments.json = arguments.json || common.json;
  arguments.quiet = arguments.quiet || common.quiet;
  if (arguments.threads == 0) arguments.threads = common.threads;
}

void make(const MakeArguments& arguments) {
  const Console console(arguments);
  std::vector<std::string> names;
  if (arguments.name == "all") {
    for (const Model& model : list_models()) {
      if (!model.procedural) names.push_back(model.name);
    }
  } else {
    names.push_back(arguments.name);
  }

  Progress progress(!console.quiet());
  std::vector<Model> made;
  const double share = 1.0 / static_cast<double>(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double from = share * static_cast<double>(i);
    MakeOptions options = arguments.options;
    options.progress = [&](std::string_view step, double fraction) {
      if (fraction < 0) {
        progress.stage(names[i] + ": " + std::string(step), from, from + share);
      } else {
        progress.stage(names[i] + ": " + std::string(step), from + share * fraction, from + share);
        progress.at(from + share * fraction);
      }
    };
    made.push_back(make_model(names[i], options));
  }
  progress.finish();
  auto models = nlohmann::ordered_json::array();
  for (const Model& model : made) {
    if (!console.quiet()) print_model(console, model);
    models.push_back(model_json(model));
  }
  console.print_json({{"models", models}});
}

}  // namespace

void add_models(CLI::App& subcommand) {
  subcommand.footer(
      "Examples:\n"
      "  meshorder models\n"
      "  meshorder models make dragon");
  const auto common = std::make_shared<Common>();
  add_common(subcommand, *common, kQuietList);
  subcommand.require_subcommand(0, 1);
  CLI::App* list_command = subcommand.add_subcommand("list", "List the models and where they are stored");
  add_common(*list_command, *common, kQuietList);
  list_command->callback([common] { list(*common); });

  CLI::App* make_command =
      subcommand.add_subcommand("make",
                                "Make a model and keep it in your cache folder.\n"
                                "The scanned bodies are downloaded from Debian's package archive (24 MB).");
  make_command->footer(
      "Example:\n"
      "  meshorder models make grid --size 40");
  const auto arguments = std::make_shared<MakeArguments>();
  make_command
      ->add_option("NAME", arguments->name, "A name from `meshorder models`, or `all` for all scanned bodies")
      ->required();
  make_command
      ->add_option("--size", arguments->options.size, "Procedural models: number of lattice cubes across")
      ->check(whole_from(1))
      ->default_str(std::to_string(kUsualSize));
  make_command->add_flag("--force", arguments->options.force, "Build it again");
  add_common(*make_command, *arguments);
  make_command->callback([arguments, common] {
    add_options_before(*common, *arguments);
    with_threads(arguments->threads, [&] { make(*arguments); });
  });

  subcommand.callback([&subcommand, common] {
    if (subcommand.get_subcommands().empty()) list(*common);
  });
}

}  // namespace meshorder::command
