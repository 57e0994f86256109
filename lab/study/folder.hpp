// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace meshorder {

/// Where things stand in a study's folder, so that a study can be resumed and its report made anew from it.
/// What is measured stands in `data`; the rest is made of it.
class StudyFolder {
 public:
  explicit StudyFolder(std::filesystem::path root) : root_(std::move(root)) {}

  [[nodiscard]] const std::filesystem::path& root() const noexcept { return root_; }
  [[nodiscard]] std::filesystem::path results() const { return root_ / "results.json"; }
  [[nodiscard]] std::filesystem::path data() const { return root_ / "data"; }
  [[nodiscard]] std::filesystem::path page() const { return root_ / "report.html"; }
  [[nodiscard]] std::filesystem::path tables(std::string_view extension) const {
    return root_ / ("tables" + std::string(extension));
  }
  [[nodiscard]] std::filesystem::path figure(std::string_view name) const {
    return root_ / "figures" / (std::string(name) + ".svg");
  }
  /// A mesh in its own order, with points and cells alone.
  [[nodiscard]] std::filesystem::path mesh(std::string_view mesh) const {
    return data() / (std::string(mesh) + ".vtu");
  }
  /// The place of each vertex or cell in an order: old_to_new, as NumPy's array.
  [[nodiscard]] std::filesystem::path vertex_order(std::string_view mesh, std::string_view ordering) const {
    return data() / (std::string(mesh) + "-" + std::string(ordering) + ".vertices.npy");
  }
  [[nodiscard]] std::filesystem::path cell_order(std::string_view mesh, std::string_view ordering) const {
    return data() / (std::string(mesh) + "-" + std::string(ordering) + ".cells.npy");
  }
  /// Frames of a scenario, vertices numbered as in the mesh's own order: a NumPy array of single precision,
  /// frames × vertices × 3.
  [[nodiscard]] std::filesystem::path motion(std::string_view scenario) const {
    return data() / (std::string(scenario) + "-motion.npy");
  }
  /// What the body meets there, as a surface; there is none without obstacles.
  [[nodiscard]] std::filesystem::path obstacles(std::string_view scenario) const {
    return data() / (std::string(scenario) + "-obstacles.vtu");
  }

 private:
  std::filesystem::path root_;
};

}  // namespace meshorder
