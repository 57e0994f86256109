// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/stopwatch.hpp"
#include "console.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::command {

/// Measures the wall-clock time of a command, stage by stage.
class StageTimes {
 public:
  /// Adds the time since the last call, or since the object was made, to the stage of that name.
  void end(std::string stage);

  /// Sets how many bytes a stage read or wrote.
  void set_bytes(const std::string& stage, std::uint64_t bytes);

  /// Returns the time of a stage; 0 if there was none.
  [[nodiscard]] double seconds(const std::string& stage) const;

  /// Prints a line for each stage and for all: name, time, bytes per second.
  void print(const Console& console) const;

  /// Returns [{"stage", "seconds", "bytes"}, …]; bytes are null if a stage has none.
  [[nodiscard]] nlohmann::ordered_json to_json() const;

 private:
  struct Stage {
    std::string name;
    double seconds = 0;
    std::optional<std::uint64_t> bytes = {};
  };
  Stopwatch since_start_;
  double ended_ = 0;  ///< the end of the last stage, in seconds since the start
  std::vector<Stage> stages_;
};

/// Returns the bytes of a mesh on disk, including the further files of TetGen and XDMF; 0 if the mesh does
/// not exist.
std::uint64_t bytes_on_disk(const std::string& mesh);

}  // namespace meshorder::command
