// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/memory.hpp"
#include "command.hpp"
#include "confinement.hpp"
#include "io/stream/read_limits.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::command {
namespace {

/// Returns the bytes of "4G", the largest limit for "none", nothing for other texts.
std::optional<std::uint64_t> limit_of(const std::string& text) {
  if (text == "none") return UINT64_MAX;
  const std::optional<std::uint64_t> size = parse_size(text);
  return size && *size > 0 ? size : std::nullopt;
}

}  // namespace

void add_reading_options(CLI::App& subcommand) {
  subcommand
      .add_option_function<std::string>(
          "--limit-memory", [](const std::string& text) { set_memory_limit(*limit_of(text)); },
          "Memory limit, such as 4G. It applies to the graph of the cells and to values that the file has\n"
          "in a short form: compressed, repeated or only counted. Files that need more are refused. `none`:\n"
          "no limit. Default: 256M plus 100 times the file's size, at most three quarters of the memory")
      ->check(CLI::Validator(
          [](std::string& text) {
            return limit_of(text) ? std::string() : "'" + text + "' is neither a size, such as 4G, nor none";
          },
          ""))
      ->type_name("SIZE");
  subcommand
      .add_option_function<std::vector<std::string>>(
          "--allow-includes-from",
          [](const std::vector<std::string>& folders) {
            for (const std::string& folder : folders) allow_includes_from(folder);
          },
          "Also read included files from this folder and its subfolders, not only from the folder of the\n"
          "mesh; may be repeated")
      ->check(CLI::ExistingDirectory)
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  subcommand.add_flag_callback(
      "--trust", trust_files,
      "Read CGNS, Exodus, MED, VTKHDF and XDMF files with all rights of this process. By default, a\n"
      "confined process reads them, because libraries parse them");
}

}  // namespace meshorder::command
