// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// How an order looks in every figure of a study: told apart by shape, dashes and pattern as well as by
/// colour. Colours of Okabe and Ito (Color Universal Design, 2008), which differ for every kind of colour
/// vision.
struct OrderStyle {
  std::string_view colour;
  int filled = 0;  ///< gnuplot's point types
  int hollow = 0;
  std::string_view dashes;
  int pattern = 0;  ///< gnuplot's, of areas
};

/// The paper's orders look the same in all studies; others take what looks are left, in the study's order.
OrderStyle style_of(const StudyResults& results, std::string_view ordering);

/// What all scripts begin with: thin grey axes, a light grid, the key above.
std::string plain_axes();

/// A block of inline data "$NAME << EOD …".
std::string data_block(std::string_view name, const std::vector<std::string>& lines);

/// "spans-dragon": a figure's name for one of the study's meshes, of lower-case letters, digits and '-', and
/// another one for each mesh.
std::string figure_name(std::string_view kind, const StudyResults& results, const MeshRecord& mesh);

}  // namespace meshorder
