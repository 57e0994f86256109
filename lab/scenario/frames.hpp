// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/vtu.hpp"
#include "lab/scenario/followers.hpp"
#include "lab/scenario/simulation.hpp"

#include <filesystem>
#include <vector>

namespace meshorder {

/// Writes a motion into a folder as one .vtu file for each frame, NAME-000012.vtu after step 12, and
/// NAME.pvd, which ParaView opens as an animation; it is complete after every frame.
///
/// A frame has the moved mesh with all that is attached to it, and on its vertices `displacement` (m, from
/// the mesh at rest) and `velocity` (m/s) in single precision, as points are. `original_vertex` and
/// `original_cell` number the vertices and cells as the mesh's file did, from 0, so that frames of two orders
/// can be laid over each other. What the body may meet stands in NAME-obstacles.vtu.
class FrameWriter {
 public:
  /// A frame after every `every`-th step, and one of the start. Makes the folder. Throws Error when it cannot
  /// be made or written.
  FrameWriter(const Simulation& simulation, std::filesystem::path folder, Index every);

  /// Lists the frames up to that step that an earlier run left in the folder.
  void resume_after(Index step);

  /// Whether a frame is due after that step.
  [[nodiscard]] bool is_due(Index step) const { return step % every_ == 0; }

  /// Writes a frame, and the collection anew. Throws Error when it cannot. Frames of one state are the same
  /// bytes. O(size of the mesh).
  void write(MotionState state);

  [[nodiscard]] const std::filesystem::path& collection() const noexcept { return collection_; }
  /// What the files could not hold of the mesh.
  [[nodiscard]] const Notes& notes() const noexcept { return notes_; }

 private:
  void write_obstacles(const Simulation& simulation) const;
  [[nodiscard]] std::string file_name(Index step) const;
  void list(Index step);

  std::filesystem::path folder_;
  std::string name_;
  Index every_;
  double time_step_;
  std::filesystem::path collection_;
  std::vector<Point> rest_;
  std::vector<Follower> followers_;
  Mesh frame_;
  std::vector<PvdEntry> entries_;
  Notes notes_;
};

}  // namespace meshorder
