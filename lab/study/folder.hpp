// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"

#include <array>
#include <ctime>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace meshorder {

/// Paths of the files in a study's folder. `results.json` and the files in `data` suffice to resume a study
/// and to make its report again; all other files are made from these.
class StudyFolder {
 public:
  /// @param is_named  whether the user gave the folder, which may then be a symbolic link
  explicit StudyFolder(std::filesystem::path root, bool is_named = true)
      : root_(std::move(root)), named_(is_named ? root_ : root_.parent_path()) {}

  [[nodiscard]] const std::filesystem::path& root() const noexcept { return root_; }
  /// Returns one of the paths below as a file; it is not read if it lies outside the named folder.
  [[nodiscard]] FilePath file(const std::filesystem::path& path) const { return FilePath::in(named_, path); }
  [[nodiscard]] std::filesystem::path results() const { return root_ / "results.json"; }
  [[nodiscard]] std::filesystem::path data() const { return root_ / "data"; }
  [[nodiscard]] std::filesystem::path page() const { return root_ / "report.html"; }
  [[nodiscard]] std::filesystem::path tables(std::string_view extension) const {
    return root_ / ("tables" + std::string(extension));
  }
  [[nodiscard]] std::filesystem::path figure(std::string_view name) const {
    return root_ / "figures" / (std::string(name) + ".svg");
  }
  /// Returns the path of a mesh in its own order: points and cells only.
  [[nodiscard]] std::filesystem::path mesh(std::string_view mesh) const {
    return data() / (std::string(mesh) + ".vtu");
  }
  /// Return the paths of an order's NumPy arrays old_to_new: the new number of each vertex, or each cell.
  [[nodiscard]] std::filesystem::path vertex_order(std::string_view mesh, std::string_view ordering) const {
    return data() / (std::string(mesh) + "-" + std::string(ordering) + ".vertices.npy");
  }
  [[nodiscard]] std::filesystem::path cell_order(std::string_view mesh, std::string_view ordering) const {
    return data() / (std::string(mesh) + "-" + std::string(ordering) + ".cells.npy");
  }
  /// Returns the path of a scenario's frames, with vertices in the mesh's own order: a NumPy array of single
  /// precision, frames × vertices × 3.
  [[nodiscard]] std::filesystem::path motion(std::string_view scenario) const {
    return data() / (std::string(scenario) + "-motion.npy");
  }
  /// Returns the path of the surface triangles of a fluid: a NumPy array of rows (frame, three vertices). A
  /// body has no such file.
  [[nodiscard]] std::filesystem::path surfaces(std::string_view scenario) const {
    return data() / (std::string(scenario) + "-surfaces.npy");
  }
  /// Returns the path of a scenario's obstacles as a surface mesh. A scenario without obstacles has no such
  /// file.
  [[nodiscard]] std::filesystem::path obstacles(std::string_view scenario) const {
    return data() / (std::string(scenario) + "-obstacles.vtu");
  }

 private:
  std::filesystem::path root_;
  std::filesystem::path named_;
};

/// Returns the UTC time now, "2026-11-20T17:30:00Z".
inline std::string timestamp_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
  return text.data();
}

}  // namespace meshorder
