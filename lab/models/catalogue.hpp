// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// A tetrahedral mesh that meshorder can make by name.
struct Model {
  std::string name;            ///< "dragon"; "grid-20" for a procedural model that is made
  std::string description;     ///< for a list of models
  bool procedural = false;     ///< made in any size, without other programs
  std::filesystem::path path;  ///< the .node file, its .ele beside it; empty until it is made
  Index vertices = 0;          ///< 0 until it is made
  Index elements = 0;          ///< 0 until it is made
};

/// Returns the folder of the models: `models` in `$MESHORDER_CACHE`, else in `$XDG_CACHE_HOME/meshorder`,
/// else in `~/.cache/meshorder`. Throws Error if neither these variables nor HOME are set.
std::filesystem::path models_folder();

/// Returns all models: the paper's and larger models, then the procedural models, each first without a size,
/// then in the sizes that are made. Reads only the first lines of files.
std::vector<Model> list_models();

/// Lattice cubes across a procedural model if no size is given.
inline constexpr Index kUsualSize = 20;

struct MakeOptions {
  /// Lattice cubes across a procedural model without a size in its name; by default kUsualSize. Other models
  /// take no size.
  std::optional<Index> size = {};
  bool force = false;  ///< make it again if it exists
  /// Called as each step begins, with the fraction of the time that has passed (below 0: unknown).
  std::function<void(std::string_view step, double fraction)> progress = {};
};

/// Makes a model and stores it, unless it is stored already, and returns it. The name of a procedural model
/// may include its size, "grid-40".
///
/// The other models are made from surfaces in Debian's package libcgal-demo (downloaded once, 24 MB),
/// prepared by `meshorder-models` and filled by `tetgen`. If two processes make the same model, one waits for
/// the other. An interruption never leaves an incomplete model under its name.
///
/// Throws InvalidArgument for an unknown name, an invalid size or a size that the model does not take; Error,
/// with a remedy, if a program is not installed or fails, or if the folder cannot be written.
Model make_model(std::string_view name, const MakeOptions& options = {});

}  // namespace meshorder
