// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace meshorder {

/// What is drawn, in gnuplot's language: everything after the terminal is set.
struct Drawing {
  std::string name;  ///< of letters, digits, '-' and '.'; ids inside the picture begin with it
  std::string title;
  std::string description;
  int width = 520;  ///< pixels, at which the text is 13 high
  int height = 360;
  std::string script;
};

/// Runs gnuplot on it and returns an SVG document without XML declaration, which can stand in a page as it
/// is: well-formed, with a title and a description, ids of its own, and no trace of the program's version or
/// of the time. It scales by its viewBox. The same on every run. Throws Error, which names the package, where
/// gnuplot is not installed, and with its last line where it fails.
std::string draw(const Drawing& drawing);

/// A string as gnuplot reads it, with quotes; control characters become blanks.
std::string gnuplot_quoted(std::string_view text);

/// The same for an entry of a key, where long ones push others out: not more than so many characters.
std::string gnuplot_key(std::string_view text, int characters = 24);

/// The same for the label of a tic, where '%' begins a format: not more than 24 characters, nor than the 49
/// bytes that gnuplot keeps.
std::string gnuplot_tic(std::string_view text);

}  // namespace meshorder
