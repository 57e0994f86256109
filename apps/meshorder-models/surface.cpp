// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "surface.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace meshorder::models {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

/// Yields the non-blank lines of a text, and the words of the current line.
class Lines {
 public:
  Lines(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  /// Moves to the next line that is neither blank nor a comment. Returns false if there is none.
  bool next() {
    while (!text_.empty()) {
      const auto end = text_.find('\n');
      line_ = text_.substr(0, end);
      line_ = line_.substr(0, line_.find('#'));
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
      ++number_;
      if (at_word()) return true;
    }
    return false;
  }

  /// Returns true if the current line has another word.
  bool at_word() {
    line_.remove_prefix(std::min(line_.find_first_not_of(blanks), line_.size()));
    return !line_.empty();
  }

  std::string_view word() {
    if (!at_word()) return {};
    const auto result = line_.substr(0, line_.find_first_of(blanks));
    line_.remove_prefix(result.size());
    return result;
  }

  template <class Number>
  Number number(std::string_view wanted) {
    const auto text = word();
    if (text.empty()) fail("the line ends too early", fmt::format("expected {}", wanted));
    const char* begin = text.data() + (text.front() == '+' ? 1 : 0);
    const char* end = text.data() + text.size();
    Number value{};
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || stop != end) {
      fail(fmt::format("'{}' is not {}", text.substr(0, 40), wanted), fmt::format("expected {}", wanted));
    }
    return value;
  }

  [[noreturn]] void fail(std::string_view what, std::string_view right) const {
    throw InputError(fmt::format("{}:{}: {}; {}", file_, number_, what, right));
  }

 private:
  std::string_view text_;  ///< text after the current line
  std::string_view line_;  ///< rest of the current line
  std::size_t number_ = 0;
  std::string file_;
};

std::string read_text(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError(fmt::format("{}: no such file; give an OFF file of triangles", file.string()));
  }
  std::ifstream in(file, std::ios::binary);  // opened directly: this program does not link libmeshorder
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad()) {
    throw InputError(fmt::format("{}: cannot be read; make it readable", file.string()));
  }
  return text;
}

}  // namespace

Surface read_off(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  if (text.empty()) throw InputError(fmt::format("{}: empty; give an OFF file of triangles", file.string()));
  Lines lines(text, file.string());

  if (!lines.next() || lines.word() != "OFF") {
    lines.fail("not an OFF file", "its first word should be OFF");
  }
  if (!lines.at_word() && !lines.next()) lines.fail("ends before the counts", "two counts must follow OFF");
  const auto n_points = lines.number<std::uint32_t>("a number of vertices");
  const auto n_faces = lines.number<std::uint32_t>("a number of faces");
  if (n_points < 3 || n_faces < 1) lines.fail("the surface is empty", "at least one triangle is needed");

  // a vertex or a face takes six bytes or more, so a false count cannot reserve much memory
  Surface surface;
  surface.points.reserve(std::min<std::size_t>(n_points, text.size() / 6));
  surface.triangles.reserve(std::min<std::size_t>(n_faces, text.size() / 6));
  for (std::uint32_t v = 0; v < n_points; ++v) {
    if (!lines.next()) {
      lines.fail(fmt::format("ends after {} of {} vertices", v, n_points), "the rest of the file is missing");
    }
    auto& point = surface.points.emplace_back();
    for (double& x : point) {
      x = lines.number<double>("a coordinate");
      if (!std::isfinite(x)) lines.fail("a coordinate is not finite", "a finite number is needed");
    }
  }
  for (std::uint32_t f = 0; f < n_faces; ++f) {
    if (!lines.next()) {
      lines.fail(fmt::format("ends after {} of {} faces", f, n_faces), "the rest of the file is missing");
    }
    const auto corners = lines.number<std::uint32_t>("a number of corners");
    if (corners != 3)
      lines.fail(fmt::format("a face has {} corners", corners), "all faces must be triangles");
    auto& triangle = surface.triangles.emplace_back();
    for (auto& v : triangle) {
      v = lines.number<std::uint32_t>("a vertex");
      if (v >= n_points) {
        lines.fail(fmt::format("vertex {} does not exist", v), fmt::format("the last is {}", n_points - 1));
      }
    }
  }
  return surface;
}

void check_writable_place(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) {
    throw InputError(fmt::format("{}: is a folder; give the name of a file to write", file.string()));
  }
  if (file.has_parent_path() && !std::filesystem::is_directory(file.parent_path())) {
    throw InputError(fmt::format("{}: the folder {} does not exist; make it first", file.string(),
                                 file.parent_path().string()));
  }
}

void write_off(const std::filesystem::path& file, const Surface& surface) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "OFF\n{} {} 0\n", surface.points.size(), surface.triangles.size());
  for (const auto& [x, y, z] : surface.points) fmt::format_to(out, "{} {} {}\n", x, y, z);
  for (const auto& [a, b, c] : surface.triangles) fmt::format_to(out, "3 {} {} {}\n", a, b, c);

  const std::filesystem::path partial = fmt::format("{}.{}.partial", file.string(), ::getpid());
  // O_EXCL and O_NOFOLLOW: another user of the folder may have put a link there
  const int opened = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  std::string_view rest(text.data(), text.size());
  for (ssize_t written = 0; opened >= 0 && !rest.empty();
       rest.remove_prefix(static_cast<std::size_t>(written))) {
    written = ::write(opened, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) written = 0;
    if (written < 0) break;
  }
  const bool is_complete = opened >= 0 && ::close(opened) == 0 && rest.empty();
  std::error_code error;
  if (is_complete) std::filesystem::rename(partial, file, error);
  if (!is_complete || error) {
    std::error_code ignored;
    if (opened >= 0) std::filesystem::remove(partial, ignored);
    throw std::runtime_error(
        fmt::format("{}: cannot be written; check the space and permissions of its folder", file.string()));
  }
}

}  // namespace meshorder::models
