// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/study/mesh_study.hpp>

namespace meshorder {

OrderedMesh study_mesh(const Mesh& /*mesh*/, const std::vector<StudyOrdering>& /*orderings*/,
                       const MeshStudyOptions& /*options*/) {
  return {};
}

}  // namespace meshorder
