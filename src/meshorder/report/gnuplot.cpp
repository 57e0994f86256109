// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/io/vtk/xml_text.hpp>
#include <meshorder/models/process.hpp>
#include <meshorder/report/figures.hpp>
#include <meshorder/report/gnuplot.hpp>

#include <fmt/format.h>
#include <stdlib.h>  // mkdtemp

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <system_error>

namespace meshorder {
namespace fs = std::filesystem;

namespace {

constexpr const char* kProgram = "gnuplot";

/// A new folder for a run of gnuplot, removed at the end.
class WorkFolder {
 public:
  WorkFolder() {
    std::string pattern = (fs::temp_directory_path() / "meshorder-figure-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) {
      throw Error(pattern, std::generic_category().message(errno), "is the disk full?");
    }
    path_ = pattern;
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder(WorkFolder&&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  WorkFolder& operator=(WorkFolder&&) = delete;

  [[nodiscard]] const fs::path& path() const noexcept { return path_; }

 private:
  fs::path path_;
};

/// Text without control characters, which neither gnuplot's strings nor XML can hold.
std::string printable(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return result;
}

std::string read(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Makes ids and references to them begin with `prefix`. Looks into tags alone, not at what a picture says.
std::string with_own_ids(const std::string& svg, const std::string& prefix) {
  static const std::regex id("(\\sid=['\"]|xlink:href=['\"]#|url\\(#)");
  std::string result;
  for (std::size_t begin = 0; begin < svg.size();) {
    const std::size_t tag = std::min(svg.find('<', begin), svg.size());
    const std::size_t end = std::min(svg.find('>', tag), svg.size());
    result += svg.substr(begin, tag - begin);
    result += std::regex_replace(svg.substr(tag, end - tag), id, "$&" + prefix);
    begin = end;
  }
  return result;
}

/// Replaces gnuplot's own head.
std::string tidied(const std::string& svg, const Drawing& drawing) {
  const std::size_t begin = svg.find("<svg");
  const std::size_t title = svg.find("<title>", begin);
  const std::size_t end = svg.find("</desc>", title);
  if (end == std::string::npos || svg.find("</svg>", end) == std::string::npos) {
    throw Error("figure " + drawing.name, "gnuplot drew no SVG picture", "is its package gnuplot-nox?");
  }
  const std::string head = std::regex_replace(svg.substr(begin, title - begin), std::regex("\\s+"), " ");
  const std::string body = svg.substr(end + std::string_view("</desc>").size());
  return fmt::format("{}\n<title>{}</title>\n<desc>{}</desc>{}", head, xml_escaped(printable(drawing.title)),
                     xml_escaped(printable(drawing.description)), with_own_ids(body, drawing.name + "-"));
}

}  // namespace

bool can_draw_figures() { return !models::find_program(kProgram).empty(); }

std::string draw(const Drawing& drawing) {
  const fs::path program = models::find_program(kProgram);
  if (program.empty()) {
    throw Error("figure " + drawing.name, "gnuplot is not installed", "apt-get install gnuplot-nox");
  }
  const WorkFolder folder;
  const fs::path script = folder.path() / "script";
  std::ofstream(script, std::ios::binary) << fmt::format(
      "set encoding utf8\n"
      "set terminal svg size {},{} fixed font 'sans-serif,13' noenhanced background '#ffffff'\n"
      "set output 'figure.svg'\n{}\nunset output\n",
      drawing.width, drawing.height, drawing.script);
  // without the user's own settings
  const models::Ended ended = models::run_process(program, {"--default-settings", script.string()},
                                                  folder.path(), folder.path() / "log");
  if (ended.code != 0) {
    throw Error("figure " + drawing.name,
                fmt::format("gnuplot failed: {}",
                            ended.last_line.empty() ? fmt::format("status {}", ended.code) : ended.last_line),
                "is it version 5.4 or newer, and is there space in the folder for temporary files?");
  }
  return tidied(read(folder.path() / "figure.svg"), drawing);
}

std::string gnuplot_quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : printable(text)) {
    if (c == '\'') result += '\'';
    result += c;
  }
  return result + "'";
}

std::string gnuplot_tic(std::string_view text) {
  std::string doubled;
  for (const char c : text) {
    if (c == '%') doubled += '%';
    doubled += c;
  }
  return gnuplot_quoted(doubled);
}

}  // namespace meshorder
