// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/error.hpp"
#include "command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

namespace {

constexpr int kBadInput = 2;
constexpr int kOwnFailure = 1;

int report(const char* message, int status) {
  fmt::print(stderr, "meshorder: {}\n", message);
  return status;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): what could still throw is the printing of a message
int main(int argc, char** argv) {
  CLI::App app{
      "Reorders the vertices and elements of a simulation mesh so that physics on it runs faster, and "
      "carries\n"
      "everything in the file along.\n\n"
      "  meshorder order  dragon.veg -o ordered.veg   the sensible default, chosen for the mesh\n"
      "  meshorder info   dragon.veg                  counts, spans, is it in a good order?\n"
      "  meshorder compare dragon.veg                 every order: cost, quality, measured kernels\n"
      "  meshorder simulate falling --mesh dragon.veg an elastic body in motion, timed\n"
      "  meshorder reproduce -o results               the paper's study on this machine, as a page\n"
      "  meshorder report dragon.veg                  all of it as a page for the browser\n",
      "meshorder"};
  app.set_version_flag("--version", MESHORDER_VERSION);
  app.require_subcommand(1);
  meshorder::command::add_order(app);
  meshorder::command::add_apply(app);
  meshorder::command::add_info(app);
  meshorder::command::add_compare(app);
  meshorder::command::add_simulate(app);
  meshorder::command::add_reproduce(app);
  meshorder::command::add_report(app);
  meshorder::command::add_models(app);
  meshorder::command::add_methods(app);
  meshorder::command::add_serve_steps(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return report((std::string(error.what()) + "; see meshorder --help").c_str(), kBadInput);
  } catch (const meshorder::command::Stopped& stopped) {
    return report(stopped.what(), stopped.status);
  } catch (const meshorder::Error& error) {
    return report(error.what(), kBadInput);
  } catch (const meshorder::InvalidArgument& error) {
    return report(error.what(), kBadInput);
  } catch (const std::bad_alloc&) {
    return report("out of memory", kOwnFailure);
  } catch (const std::exception& error) {
    return report(error.what(), kOwnFailure);
  }
}
