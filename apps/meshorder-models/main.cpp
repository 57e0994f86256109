// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// meshorder-models: makes the surfaces of the study's models, which TetGen fills with tetrahedra.
// Like meshorder-delaunay, it uses CGAL's GPL parts; README.md has the recipes.
#include "surface.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

namespace {

using namespace meshorder::models;

void run_wrap(const std::string& in, const std::string& out, const WrapOptions& options) {
  if (std::isnan(options.alpha_ratio) || std::isnan(options.offset_ratio)) {  // CLI::Range accepts NaN
    throw InputError("a ratio is not a number; it must be 1 or more");
  }
  check_writable_place(out);
  const Surface surface = read_off(in);
  Surface wrapped;
  try {
    wrapped = wrap(surface, options);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", in, error.what()));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", in, error.what()));
  }
  write_off(out, wrapped);
  fmt::print("{}: {} vertices, {} triangles\n", out, wrapped.points.size(), wrapped.triangles.size());
}

int fail(int code, const char* what) {
  // CGAL and CLI11 give messages of several lines; a failure is reported in one line
  std::string line = what;
  for (char& c : line) {
    if (c == '\n') c = ' ';
  }
  fmt::print(stderr, "meshorder-models: {}\n", line);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes closed surfaces that TetGen can fill.", "meshorder-models"};
  app.require_subcommand(1);

  std::string in;
  std::string out;
  WrapOptions options;
  auto* wrap_command = app.add_subcommand("wrap", "Wrap triangles that may intersect into a closed surface");
  wrap_command->add_option("IN", in, "OFF file of triangles")->required();
  wrap_command->add_option("OUT", out, "OFF file to write")->required();
  wrap_command->add_option("--alpha-ratio", options.alpha_ratio, "diagonal of the bounding box / alpha")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  wrap_command->add_option("--offset-ratio", options.offset_ratio, "diagonal of the bounding box / offset")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();

  try {
    app.parse(argc, argv);
    run_wrap(in, out, options);
    return 0;
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return fail(2, fmt::format("{}; see meshorder-models --help", error.what()).c_str());
  } catch (const InputError& error) {
    return fail(2, error.what());
  } catch (const std::exception& error) {
    return fail(1, error.what());
  }
}
