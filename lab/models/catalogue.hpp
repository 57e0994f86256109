// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// A tetrahedral mesh that anyone can make by its name.
struct Model {
  std::string name;            ///< "dragon"; a procedural one that is made has its size in it, "grid-20"
  std::string sentence;        ///< for a list of models
  bool procedural = false;     ///< made by rule in any size, without other programs
  std::filesystem::path path;  ///< the .node file, its .ele beside it; empty until it is made
  Index vertices = 0;          ///< 0 until it is made
  Index elements = 0;          ///< 0 until it is made
};

/// Where models are kept: `$MESHORDER_CACHE`, or else `$XDG_CACHE_HOME/meshorder`, or else
/// `~/.cache/meshorder`, and in it `models`. Throws Error when none of the three variables tells.
std::filesystem::path models_folder();

/// All models: the paper's and larger ones, then the procedural ones, each of these without a size and then
/// in the sizes that are made. Reads first lines of files, no mesh.
std::vector<Model> list_models();

struct MakeOptions {
  Index size = 20;     ///< of procedural models: lattice cubes across the shape
  bool force = false;  ///< makes it again where it is made already
  /// Is told each step as it begins, and which fraction of the time is over by then (below 0: unknown).
  std::function<void(std::string_view step, double fraction)> progress = {};
};

/// Makes the model of that name and keeps it, or does nothing but look when it is kept already. The name of a
/// procedural model may carry its size, "grid-40", which then counts.
///
/// The others come out of surfaces in Debian's package libcgal-demo (24 MB to download, once), prepared by
/// `meshorder-models` and filled by `tetgen`. Of two processes that make the same model, one waits for the
/// other. Whatever interrupts it, no half of a model is left under its name.
///
/// Throws InvalidArgument for an unknown name or a wrong size; Error, which says what would help, when a
/// program is not installed or fails, or the folder cannot be written.
Model make_model(std::string_view name, const MakeOptions& options = {});

}  // namespace meshorder
