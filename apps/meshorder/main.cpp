// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include <meshorder/error.hpp>
#include <meshorder/registry.hpp>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <numeric>
#include <string>
#include <vector>

namespace {

constexpr int kBadInput = 2;
constexpr int kOwnFailure = 1;

struct Subcommand {
  const char* name;
  void (*add)(CLI::App& subcommand);
};

/// In the order of the help.
constexpr std::array kSubcommands{
    Subcommand{"order", meshorder::command::add_order},
    Subcommand{"apply", meshorder::command::add_apply},
    Subcommand{"info", meshorder::command::add_info},
    Subcommand{"compare", meshorder::command::add_compare},
    Subcommand{"simulate", meshorder::command::add_simulate},
    Subcommand{"reproduce", meshorder::command::add_reproduce},
    Subcommand{"report", meshorder::command::add_report},
    Subcommand{"models", meshorder::command::add_models},
    Subcommand{"methods", meshorder::command::add_methods},
    Subcommand{"serve-steps", meshorder::command::add_serve_steps},
};

int report(const std::string& message, int status) {
  fmt::print(stderr, "meshorder: {}\n", message);
  return status;
}

/// Returns the number of letters to insert, delete or replace that turn one word into the other
/// (Levenshtein).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

/// Returns "; did you mean order?" if a subcommand is spelt almost like `word`, else where the help is.
std::string suggestion(const CLI::App& app, const std::string& word) {
  constexpr std::size_t kMaxDistance = 2;
  std::string nearest;
  std::size_t least = kMaxDistance + 1;
  for (const CLI::App* const subcommand : app.get_subcommands({})) {
    const std::size_t distance = edit_distance(word, subcommand->get_name());
    if (subcommand->get_group().empty() || distance >= least) continue;
    least = distance;
    nearest = subcommand->get_name();
  }
  return nearest.empty() ? "; see meshorder --help" : "; did you mean " + nearest + "?";
}

/// Returns the subcommand that the arguments name, "meshorder models make", as far as they were understood.
std::string command_named_by(const CLI::App& app) {
  std::string words = "meshorder";
  for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    words += " " + at->get_name();
  }
  return words;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): only printing a message could still throw
int main(int argc, char** argv) {
  CLI::App app{
      "Reorders the vertices and elements of a simulation mesh, with all data in its file, so that\n"
      "physics on it runs faster.\n\n"
      "  meshorder order  dragon.veg -o ordered.veg   order by the method chosen for the mesh\n"
      "  meshorder info   dragon.veg                  counts and spans; is it in a good order?\n"
      "  meshorder compare dragon.veg                 every order: cost, quality, measured kernels\n"
#ifdef MESHORDER_HAS_LAB
      "  meshorder simulate falling --mesh dragon.veg simulate an elastic body and time it\n"
      "  meshorder reproduce -o results               the paper's study on this machine, as a page\n"
      "  meshorder report dragon.veg                  all of it as a page for the browser\n"
#endif
      ,
      "meshorder"};
  app.set_version_flag("-V,--version", MESHORDER_VERSION);
  app.require_subcommand(1);
  app.fallthrough();  // subcommands take --plugin, too
  app.add_option_function<std::vector<std::string>>(
         "--plugin",
         [](const std::vector<std::string>& files) {
           for (const std::string& file : files) meshorder::load_methods(file);
         },
         "Shared library with methods of your own (see examples/own_method.cpp); may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->trigger_on_parse();
  for (const auto& [name, add] : kSubcommands) add(*app.add_subcommand(name));
  try {
    if (argc < 2) {
      fmt::print(stderr, "{}", app.help());
      return kBadInput;
    }
    const std::string first = argv[1];
    const auto has_first_name = [&](const CLI::App* subcommand) { return subcommand->get_name() == first; };
    if (!first.starts_with('-') && app.get_subcommands(has_first_name).empty())
      return report("unknown subcommand '" + first + "'" + suggestion(app, first), kBadInput);
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return report(std::string(error.what()) + "; see " + command_named_by(app) + " --help", kBadInput);
  } catch (const meshorder::command::CommandError& error) {
    return report(error.what(), error.status);
  } catch (const meshorder::Error& error) {
    return report(error.what(), error.code() == meshorder::Code::internal ? kOwnFailure : kBadInput);
  } catch (const std::bad_alloc&) {
    return report("out of memory", kOwnFailure);
  } catch (const std::exception& error) {
    return report(error.what(), kOwnFailure);
  }
}
