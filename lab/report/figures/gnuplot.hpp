// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace meshorder {

/// A drawing; its script is in gnuplot's language, without the terminal.
struct Drawing {
  std::string name;  ///< of letters, digits, '-' and '.'; prefix of ids in the picture
  std::string title;
  std::string description;
  int width = 520;  ///< pixels; text is 13 pixels high
  int height = 360;
  std::string script;
};

/// Runs gnuplot and returns an SVG document that can be embedded in a page: well-formed, without XML
/// declaration, with a title, a description and unique ids, scaled by its viewBox, without version or time.
/// The document is the same on every run. Throws Error with the name of the package if gnuplot is not
/// installed, and with gnuplot's last line if it fails.
std::string draw(const Drawing& drawing);

/// Returns a quoted gnuplot string; control characters become blanks.
std::string gnuplot_quoted(std::string_view text);

/// Returns a quoted gnuplot string for an entry of the key, cut to `characters` characters.
std::string gnuplot_key(std::string_view text, int characters = 24);

/// Returns a quoted gnuplot string for the label of a tic, with '%' escaped, cut to 24 characters and to
/// gnuplot's limit of 49 bytes.
std::string gnuplot_tic(std::string_view text);

}  // namespace meshorder
