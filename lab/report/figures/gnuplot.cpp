// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/gnuplot.hpp"

#include "base/text.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/scratch.hpp"
#include "lab/report/figures/figures.hpp"
#include "lab/support/process.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace meshorder {
namespace fs = std::filesystem;

namespace {

constexpr const char* kProgram = "gnuplot";

/// Returns text with blanks in place of control characters, which neither gnuplot's strings nor XML can hold.
std::string printable(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return result;
}

constexpr std::ptrdiff_t kLongest = 24;   ///< characters of a text beside an axis
constexpr std::ptrdiff_t kTicBytes = 49;  ///< bytes that gnuplot keeps of a tic's label

/// Cuts UTF-8 text to at most `characters` characters and `bytes` bytes; "…" replaces what is cut off.
std::string shortened(std::string_view text, std::ptrdiff_t characters, std::ptrdiff_t bytes) {
  const auto begins_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; };
  if (std::count_if(text.begin(), text.end(), begins_character) <= characters && std::ssize(text) <= bytes) {
    return std::string(text);
  }
  constexpr std::string_view kCut = "…";
  std::size_t end = 0;
  for (std::size_t i = 1; i <= text.size(); ++i) {
    if (i < text.size() && !begins_character(text[i])) continue;
    const auto count =
        std::count_if(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), begins_character);
    if (count + 1 > characters || static_cast<std::ptrdiff_t>(i + kCut.size()) > bytes) break;
    end = i;
  }
  return std::string(text.substr(0, end)) + std::string(kCut);
}

/// Adds `prefix` to the ids that a tag defines or refers to.
std::string with_own_ids_in(std::string tag, const std::string& prefix) {
  for (const std::string_view before : {" id='", " id=\"", "\tid='", "\tid=\"", "\nid='", "\nid=\"",
                                        "xlink:href='#", "xlink:href=\"#", "url(#"}) {
    for (auto at = tag.find(before); at != std::string::npos; at = tag.find(before, at)) {
      at += before.size();
      tag.insert(at, prefix);
    }
  }
  return tag;
}

/// Returns text with each run of white space replaced by one blank.
std::string in_one_line(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (!blank || !result.ends_with(' ')) result += blank ? ' ' : c;
  }
  return result;
}

/// Adds `prefix` to ids and references to them, and escapes '>' in the picture's texts, since "]]>" in a text
/// is not valid XML.
std::string with_own_ids(const std::string& svg, const std::string& prefix) {
  std::string result;
  for (std::size_t begin = 0; begin < svg.size();) {
    const std::size_t tag = std::min(svg.find('<', begin), svg.size());
    const std::size_t end = std::min(svg.find('>', tag), svg.size() - 1) + 1;
    for (const char c : svg.substr(begin, tag - begin)) result += c == '>' ? "&gt;" : std::string(1, c);
    result += with_own_ids_in(svg.substr(tag, end - tag), prefix);
    begin = end;
  }
  return result;
}

/// Replaces gnuplot's title and description by the figure's, and makes the ids unique.
std::string tidied(const std::string& svg, const Figure& figure) {
  const std::size_t begin = svg.find("<svg");
  const std::size_t title = svg.find("<title>", begin);
  const std::size_t end = svg.find("</desc>", title);
  if (end == std::string::npos || svg.find("</svg>", end) == std::string::npos) {
    throw InputError("figure " + figure.name, "gnuplot drew no SVG picture", "is its package gnuplot-nox?");
  }
  const std::string head = in_one_line(std::string_view(svg).substr(begin, title - begin));
  const std::string body = svg.substr(end + std::string_view("</desc>").size());
  return fmt::format("{}\n<title>{}</title>\n<desc>{}</desc>{}", head, xml_escaped(printable(figure.title)),
                     xml_escaped(printable(figure.caption)), with_own_ids(body, figure.name + "-"));
}

}  // namespace

bool can_draw_figures() { return !find_program(kProgram).empty(); }

Figure drawn(Figure figure, int height, const std::string& script) {
  const fs::path program = find_program(kProgram);
  if (program.empty()) {
    throw InputError("figure " + figure.name, "gnuplot is not installed", "apt-get install gnuplot-nox");
  }
  const PrivateFolder folder;
  const fs::path commands = folder.path() / "script";
  std::ofstream(commands, std::ios::binary) << fmt::format(
      "set encoding utf8\n"
      "set terminal svg size 520,{} fixed font 'sans-serif,13' noenhanced background '#ffffff'\n"
      "set output 'figure.svg'\n"
      "set border 3 linecolor '#555555' linewidth 1\n"
      "set tics nomirror textcolor '#222222'\n"
      "set xlabel textcolor '#222222'\n"
      "set ylabel textcolor '#222222'\n"
      "set grid linecolor '#dddddd' linewidth 1 dashtype solid\n"
      "set key outside top center horizontal textcolor '#222222' samplen 2.5\n{}\nunset output\n",
      height, script);
  // without the user's own gnuplot settings
  const ExitStatus ended =
      run_process(program, {"--default-settings", commands.string()}, folder.path(), folder.path() / "log");
  if (ended.code != 0) {
    throw InputError(
        "figure " + figure.name,
        fmt::format("gnuplot failed: {}",
                    ended.last_line.empty() ? fmt::format("status {}", ended.code) : ended.last_line),
        "is it version 5.4 or newer, and is there space in the folder for temporary files?");
  }
  figure.svg = tidied(FilePath(folder.path() / "figure.svg").read(), figure);
  return figure;
}

std::string gnuplot_quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : printable(text)) {
    if (c == '\'') result += '\'';
    result += c;
  }
  return result + "'";
}

std::string gnuplot_key(std::string_view text, int characters) {
  return gnuplot_quoted(shortened(text, characters, std::ssize(text) + 3));
}

std::string gnuplot_tic(std::string_view text) {
  std::string doubled;
  for (const char c : shortened(text, kLongest, kTicBytes - std::count(text.begin(), text.end(), '%'))) {
    if (c == '%') doubled += '%';
    doubled += c;
  }
  return gnuplot_quoted(doubled);
}

}  // namespace meshorder
