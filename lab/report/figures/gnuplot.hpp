// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/figures/figures.hpp"
#include "lab/study/results.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Runs gnuplot and returns the figure with its SVG document, which can be embedded in a page: well-formed,
/// without XML declaration, with the title, the caption and unique ids, scaled by its viewBox, without
/// version or time. The document is the same on every run. Throws Error with the name of the package if
/// gnuplot is not installed, and with gnuplot's last line if it fails.
///
/// @param script  in gnuplot's language; axes are thin and grey, the grid is light, the key above
/// @param height  in pixels; the width is 520, text is 13 pixels high
Figure drawn(Figure figure, int height, const std::string& script);

/// Returns a quoted gnuplot string; control characters become blanks.
std::string gnuplot_quoted(std::string_view text);

/// Returns a quoted gnuplot string for an entry of the key, cut to `characters` characters.
std::string gnuplot_key(std::string_view text, int characters = 24);

/// Returns a quoted gnuplot string for the label of a tic, with '%' escaped, cut to 24 characters and to
/// gnuplot's limit of 49 bytes.
std::string gnuplot_tic(std::string_view text);

/// How an order is drawn in all figures of a study: orders differ in shape, dashes and pattern as well as in
/// colour. Everyone can distinguish the colours, whatever their colour vision (Okabe and Ito 2008, Color
/// Universal Design).
struct OrderStyle {
  std::string_view colour;
  int filled = 0;  ///< gnuplot's point type, like `hollow`
  int hollow = 0;
  std::string_view dashes;
  int pattern = 0;  ///< gnuplot's fill pattern
};

/// Returns the style of an order. The paper's orders have the same style in all studies; other orders get the
/// remaining styles in rotation, in the study's sequence.
OrderStyle style_of(const StudyResults& results, std::string_view ordering);

/// Returns a block of inline data, "$NAME << EOD …".
std::string data_block(std::string_view name, const std::vector<std::string>& lines);

/// Returns a figure's name for a mesh, such as "spans-dragon": lower-case letters, digits and '-', unique in
/// the study.
std::string figure_name(std::string_view kind, const StudyResults& results, const MeshRecord& mesh);

}  // namespace meshorder
