// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/vtu.hpp"
#include "lab/fluid/fluid.hpp"
#include "lab/scenario/embedded_vertices.hpp"
#include "lab/scenario/motion_file.hpp"
#include "lab/scenario/simulation.hpp"

#include <filesystem>
#include <vector>

namespace meshorder {

/// Writes a motion into a folder: a .vtu file for each frame, NAME-000012.vtu after step 12, and NAME.pvd,
/// which ParaView opens as an animation and which is complete after every frame.
///
/// A frame is the moved mesh with its data and, on its vertices, `displacement` (m, from rest) and `velocity`
/// (m/s) in single precision, as the points are. `original_vertex` and `original_cell` are the numbers in the
/// mesh's file, from 0, so that frames of two orders can be compared. NAME-obstacles.vtu holds the obstacles.
/// A frame of a fluid has the particles in their order, with `velocity`, `pressure` (Pa) and
/// `original_vertex`, and the tetrahedra of the last step.
class FrameWriter {
 public:
  /// Makes the folder and writes the obstacles. Frames are due at the start and after every `every`-th step.
  /// Throws Error if the folder cannot be made or written, InvalidArgument unless `every` is positive.
  FrameWriter(const Simulation& simulation, std::filesystem::path folder, Index every);

  /// Lists each recorded step's frame that an earlier run left in the folder.
  void resume_after(const MotionRecord& record);

  /// Returns whether a frame is due after `step`.
  [[nodiscard]] bool is_due(Index step) const { return step % every_ == 0; }

  /// Writes a frame and the collection. Throws Error if a file cannot be written. The bytes depend on the
  /// state only. O(size of the mesh).
  void write(MotionState state);

  [[nodiscard]] const std::filesystem::path& collection() const noexcept { return collection_; }
  /// Returns notes on data of the mesh that the files cannot hold.
  [[nodiscard]] const Notes& notes() const noexcept { return notes_; }

 private:
  void write_obstacles(const Simulation& simulation) const;
  [[nodiscard]] std::string file_name(Index step) const;
  void list(Index step, double time);
  void take(const MotionState& state);
  void take(const Fluid& fluid, const MotionState& state);

  std::filesystem::path folder_;
  std::string name_;
  Index every_;
  const Fluid* fluid_;  ///< null for a body
  std::filesystem::path collection_;
  std::vector<Point> rest_;  ///< of a body
  std::vector<EmbeddedVertex> embedded_;
  Mesh frame_;
  std::vector<PvdEntry> entries_;
  Notes notes_;
};

}  // namespace meshorder
