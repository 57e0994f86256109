// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Format: OpenFOAM User Guide, "Mesh description": "2 ( inlet { type patch; nFaces 20; startFace 760; } … )".
#include "io/openfoam/foam_file.hpp"
#include "io/openfoam/poly_mesh.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace meshorder::openfoam {
namespace {

constexpr const char* kRemedy = "write the boundary again; checkMesh checks it";

/// The faces of a patch.
struct Patch {
  std::string name = {};
  std::optional<std::int64_t> faces = {};
  std::optional<std::int64_t> first = {};
};

class BoundaryReader {
 public:
  explicit BoundaryReader(const FilePath& path) : file_(path) {}

  void check(std::int64_t faces, std::int64_t internal_faces) {
    begin();
    std::int64_t next = internal_faces;
    while (const auto patch = read_patch()) {
      if (refers_elsewhere_) return;
      next += checked(*patch, next);
    }
    if (next == faces) return;
    throw InputError(file_.file(),
                     fmt::format("the patches cover faces {} to {}, but the boundary has faces {} to {}",
                                 internal_faces, next - 1, internal_faces, faces - 1),
                     kRemedy);
  }

 private:
  std::string word() {
    if (file_.at_end()) file_.fail("the file ends within the list of patches", "it may be cut short");
    std::string result(file_.token());
    if (result.starts_with('$') || result.starts_with('#')) refers_elsewhere_ = true;
    return result;
  }

  /// Takes the number of patches, which the file may omit, and the opening parenthesis.
  void begin() {
    const std::string first = word();
    if (first == "(" || word() == "(") return;
    file_.fail(fmt::format("expected a list of patches, found '{}'", first), kRemedy);
  }

  /// Returns the next patch, nullopt at the end of the list.
  std::optional<Patch> read_patch() {
    Patch patch{.name = word()};
    if (patch.name == ")") return std::nullopt;
    if (word() != "{") file_.fail(fmt::format("expected '{{' after the patch '{}'", patch.name), kRemedy);
    int depth = 1;  // depth of braces; entries in deeper braces are not the patch's
    while (depth > 0) {
      const std::string key = word();
      if (key == "{") ++depth;
      if (key == "}") --depth;
      if (depth != 1) continue;
      if (key == "nFaces") patch.faces = number();
      if (key == "startFace") patch.first = number();
    }
    return patch;
  }

  /// Returns the next word as a number, nullopt if the word is not a number.
  std::optional<std::int64_t> number() {
    const std::string text = word();
    std::int64_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = code == std::errc{} && end == text.data() + text.size();
    return is_number && value >= 0 ? std::optional(value) : std::nullopt;
  }

  /// Returns the number of faces of a patch; throws InputError for a missing or wrong `nFaces` or
  /// `startFace`.
  [[nodiscard]] std::int64_t checked(const Patch& patch, std::int64_t next) const {
    if (!patch.faces || !patch.first) {
      file_.fail(fmt::format("the patch '{}' gives no number for {}", patch.name,
                             patch.faces ? "startFace" : "nFaces"),
                 kRemedy);
    }
    if (*patch.faces > 0 && *patch.first != next) {
      file_.fail(fmt::format("the patch '{}' begins at face {}, but face {} is next", patch.name,
                             *patch.first, next),
                 kRemedy);
    }
    return *patch.faces;
  }

  FoamFile file_;
  bool refers_elsewhere_ = false;
};

}  // namespace

void check_boundary(const FilePath& path, std::int64_t faces, std::int64_t internal_faces) {
  BoundaryReader(path).check(faces, internal_faces);
}

}  // namespace meshorder::openfoam
