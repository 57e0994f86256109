// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"

#include <cstdint>

namespace meshorder::openfoam {

/// Checks that the patches of a file `boundary` cover the faces after the internal ones, one after another.
/// Patches without faces may begin anywhere. Does not check a file that refers to other numbers by `$` or
/// `#`. O(bytes of the file).
///
/// @throws InputError for a file that is no list of patches, for a patch without `nFaces` or `startFace`, and
///         for patches that leave a gap, overlap or end too early or too late
void check_boundary(const FilePath& path, std::int64_t faces, std::int64_t internal_faces);

}  // namespace meshorder::openfoam
