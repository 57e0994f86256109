// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// How an order is drawn in all figures of a study: orders differ in shape, dashes and pattern as well as in
/// colour. The colours are those of Okabe and Ito (2008, Color Universal Design), which can be told apart
/// with every kind of colour vision.
struct OrderStyle {
  std::string_view colour;
  int filled = 0;  ///< gnuplot's point types
  int hollow = 0;
  std::string_view dashes;
  int pattern = 0;  ///< gnuplot's, of areas
};

/// Returns the style of an order. The paper's orders have the same style in all studies; others take the
/// remaining styles, in the study's sequence.
OrderStyle style_of(const StudyResults& results, std::string_view ordering);

/// Returns the beginning of all scripts: thin grey axes, a light grid, the key above.
std::string plain_axes();

/// Returns a block of inline data, "$NAME << EOD …".
std::string data_block(std::string_view name, const std::vector<std::string>& lines);

/// Returns a figure's name for one of the study's meshes, "spans-dragon", of lower-case letters, digits and
/// '-', unique among the meshes.
std::string figure_name(std::string_view kind, const StudyResults& results, const MeshRecord& mesh);

}  // namespace meshorder
