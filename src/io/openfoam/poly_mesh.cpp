// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Format: OpenFOAM User Guide, "Mesh description". Cell c owns the faces f with owner[f] = c; the
// cell on the other side of an internal face f is neighbour[f]. Internal faces come first.
#include "io/openfoam/poly_mesh.hpp"

#include "base/point.hpp"
#include "io/openfoam/foam_file.hpp"
#include "io/stream/read_limits.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace meshorder::openfoam {
namespace {

namespace fs = std::filesystem;

/// The cells on both sides of the faces.
struct Sides {
  std::vector<Index> owner;      ///< owner of every face
  std::vector<Index> neighbour;  ///< neighbour of each internal face; internal faces come first
  Index cells = 0;
};

/// Throws unless each cell has a face.
void require_faces(const Sides& sides, const fs::path& folder) {
  std::vector<bool> has_face(static_cast<std::size_t>(sides.cells), false);
  for (const auto* cells : {&sides.owner, &sides.neighbour}) {
    for (const Index c : *cells) has_face[static_cast<std::size_t>(c)] = true;
  }
  const auto without = std::find(has_face.begin(), has_face.end(), false);
  if (without == has_face.end()) return;
  throw InputError((folder / "owner").string(),
                   fmt::format("cell {} of {} has no face", without - has_face.begin(), sides.cells),
                   "cells are numbered from 0 without a gap");
}

/// The folder `polyMesh`, and the case that it must lie in.
struct MeshFolder {
  const fs::path& of_case;
  const fs::path& path;

  [[nodiscard]] FilePath file(std::string_view name) const { return FilePath::in(of_case, path / name); }
};

void require_files(const MeshFolder& folder) {
  for (const std::string_view name : {"owner", "neighbour", "points", "faces", "boundary"}) {
    if (!FoamFile::exists(folder.file(name))) refuse_missing(folder.path / name);
  }
}

/// Returns the number after a key in a header's note, such as "nPoints:882  nCells:400"; nullopt if the key
/// is missing.
std::optional<std::int64_t> count_in(std::string_view note, std::string_view key) {
  std::size_t at = note.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  at = note.find_first_not_of(": ", at + key.size());
  if (at == std::string_view::npos) return std::nullopt;
  std::int64_t count = 0;
  const bool is_number =
      std::from_chars(note.data() + at, note.data() + note.size(), count).ec == std::errc{};
  return is_number ? std::optional(count) : std::nullopt;
}

/// Notes the counts in a header that differ from the counts of the mesh.
void compare_counts(const FoamFile& file, const Sides& sides, Notes& notes) {
  const std::array<std::pair<std::string_view, std::int64_t>, 3> found{
      {{"nCells", sides.cells},
       {"nFaces", std::ssize(sides.owner)},
       {"nInternalFaces", std::ssize(sides.neighbour)}}};
  std::string others;
  for (const auto& [key, count] : found) {
    const auto said = count_in(file.note(), key);
    if (!said || *said == count) continue;
    others += fmt::format("{}{} is {}, the files have {}", others.empty() ? "" : ", ", key, *said, count);
  }
  if (others.empty()) return;
  notes.push_back(fmt::format("{}: the counts in the header are those of another mesh: {}; run checkMesh",
                              file.file(), others));
}

Sides read_sides(const MeshFolder& folder, Notes& notes) {
  Sides sides;
  FoamFile owner(folder.file("owner"));
  owner.require_class("labelList");
  // every cell has a face, so there are at most as many cells as faces
  owner.read_labels(sides.owner, "owner", 0, std::nullopt);
  const auto faces = static_cast<std::int64_t>(sides.owner.size());
  FoamFile neighbour(folder.file("neighbour"));
  neighbour.require_class("labelList");
  neighbour.read_labels(sides.neighbour, "neighbour", -1, faces);
  // old versions list all faces, with −1 for those at the boundary
  while (!sides.neighbour.empty() && sides.neighbour.back() < 0) sides.neighbour.pop_back();
  if (sides.neighbour.size() > sides.owner.size()) {
    throw InputError(neighbour.file(),
                     fmt::format("lists {} faces, {} only {}", sides.neighbour.size(), owner.file(), faces),
                     "the files belong to different meshes");
  }
  Index last = -1;
  for (std::size_t f = 0; f < sides.owner.size(); ++f) {
    const Index a = sides.owner[f];
    last = std::max(last, a);
    if (f >= sides.neighbour.size()) continue;
    const Index b = sides.neighbour[f];
    if (b < 0 || b == a) {
      throw InputError(
          neighbour.file(),
          fmt::format("face {} has {}", f, b < 0 ? "no neighbour" : fmt::format("cell {} on both sides", a)),
          "internal faces come first and are between two cells");
    }
    if (b < a) {
      throw InputError(neighbour.file(),
                       fmt::format("face {} has the owner {} and the neighbour {}", f, a, b),
                       "the owner of an internal face is the cell with the lower number; run checkMesh");
    }
    last = std::max(last, b);
  }
  sides.cells = last + 1;
  require_faces(sides, folder.path);
  for (const FoamFile* file : {&owner, &neighbour}) compare_counts(*file, sides, notes);
  return sides;
}

CsrGraph graph_of(const Sides& sides) {
  std::vector<Edge> edges;
  edges.reserve(sides.neighbour.size());
  for (std::size_t f = 0; f < sides.neighbour.size(); ++f) {
    edges.push_back({sides.owner[f], sides.neighbour[f]});
  }
  return graph_from_edges(sides.cells, edges);
}

/// Sums the centres of the faces of each cell; faces are added in the order of the file.
class CentreSums {
 public:
  explicit CentreSums(const Sides& sides)
      : sides_(sides),
        sums_(static_cast<std::size_t>(sides.cells), Point{}),
        counts_(static_cast<std::size_t>(sides.cells), 0) {}

  [[nodiscard]] bool is_complete() const { return face_ == sides_.owner.size(); }
  [[nodiscard]] std::size_t faces() const { return face_; }

  void add(const Point& centre) {
    add_to(sides_.owner[face_], centre);
    if (face_ < sides_.neighbour.size()) add_to(sides_.neighbour[face_], centre);
    ++face_;
  }

  std::vector<Point> means() && {
    for (std::size_t c = 0; c < sums_.size(); ++c) sums_[c] = scaled(1.0 / counts_[c], sums_[c]);
    return std::move(sums_);
  }

 private:
  void add_to(Index cell, const Point& centre) {
    const auto at = static_cast<std::size_t>(cell);
    sums_[at] = plus_scaled(sums_[at], 1, centre);
    ++counts_[at];
  }

  const Sides& sides_;
  std::vector<Point> sums_;
  std::vector<Index> counts_;  // number of faces of each cell
  std::size_t face_ = 0;
};

class CentreReader {
 public:
  CentreReader(const MeshFolder& folder, const Sides& sides)
      : points_(FoamFile(folder.file("points")).read_points()), faces_(folder.file("faces")), sums_(sides) {}

  std::vector<Point> read() {
    if (faces_.class_name() == "faceCompactList") {
      read_compact();
    } else {
      read_nested();
    }
    if (!sums_.is_complete()) faces_.fail("there are fewer faces than owners", kOtherMesh);
    return std::move(sums_).means();
  }

 private:
  static constexpr const char* kOtherMesh = "the files belong to different meshes";

  /// Reads a list of lists, such as "6(4(1 7 37 31) 3(6 36 37) …)".
  void read_nested() {
    const std::int64_t count = faces_.begin_lists("faces");
    std::vector<Index> face;
    for (std::int64_t f = 0; f < count; ++f) {
      read_point_numbers(face);
      add(face);
    }
    faces_.end_lists("faces");
  }

  /// Reads where each face begins in the list of points and where the last face ends, then reads that list.
  void read_compact() {
    std::vector<Index> begins;
    faces_.read_labels(begins, "face's begin", 0, kMaxIndex);
    std::vector<Index> points;
    read_point_numbers(points);
    for (std::size_t f = 0; f + 1 < begins.size(); ++f) {
      const auto begin = static_cast<std::size_t>(begins[f]);
      const auto end = static_cast<std::size_t>(begins[f + 1]);
      if (begin > end || end > points.size()) {
        faces_.fail(fmt::format("face {} has the points {} to {} of {}", f, begin, end, points.size()),
                    "offsets must ascend");
      }
      add(std::span(points).subspan(begin, end - begin));
    }
  }

  void read_point_numbers(std::vector<Index>& points) {
    faces_.read_labels(points, "point", 0, static_cast<std::int64_t>(points_.size()));
  }

  void add(std::span<const Index> face) {
    if (sums_.is_complete()) faces_.fail("there are more faces than owners", kOtherMesh);
    if (face.empty()) faces_.fail(fmt::format("face {} has no points", sums_.faces()), "three are needed");
    Point sum{};
    for (const Index p : face) sum = plus_scaled(sum, 1, points_[static_cast<std::size_t>(p)]);
    sums_.add(scaled(1.0 / static_cast<double>(face.size()), sum));
  }

  std::vector<Point> points_;
  FoamFile faces_;
  CentreSums sums_;
};

}  // namespace

void refuse_missing(const fs::path& file) {
  throw InputError(file.string(), "is missing, but a mesh of OpenFOAM needs it",
                   "restore it, or make the mesh again");
}

PolyMesh read_poly_mesh(const fs::path& of_case, const fs::path& folder, bool with_centres, Notes& notes) {
  const FilePath path(folder);
  const ReadScope scope(path);
  const MeshFolder files{of_case, folder};
  require_files(files);
  const Sides sides = read_sides(files, notes);
  check_boundary(files.file("boundary"), std::ssize(sides.owner), std::ssize(sides.neighbour));
  PolyMesh mesh;
  mesh.internal_faces = index_size(sides.neighbour);
  if (with_centres) mesh.centres = CentreReader(files, sides).read();
  mesh.graph = graph_of(sides);
  return mesh;
}

}  // namespace meshorder::openfoam
