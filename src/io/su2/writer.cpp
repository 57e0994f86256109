// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/su2/su2.hpp"
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace meshorder::su2 {
namespace {

using SectionKind = Su2Metadata::SectionKind;

constexpr std::string_view kUnmarked = "unmarked";

/// A part of the boundary.
struct Marker {
  std::string name;
  std::vector<Index> cells;  ///< ascending
};

/// The markers of a mesh, and notes on what they cannot hold.
struct Markers {
  explicit Markers(const Mesh& of) : mesh(of), dimension(of.cells.highest_dimension()) {
    marked.assign(mesh.cells.shapes.size(), false);
    for (const EntitySet& set : mesh.sets) add_set(set);
    add_others();
    for (Marker& marker : markers) std::sort(marker.cells.begin(), marker.cells.end());
  }

  [[nodiscard]] bool is_volume(Index c) const {
    return meshorder::dimension(mesh.cells.shapes[c]) == dimension;
  }

  const Mesh& mesh;
  int dimension;  ///< dimension of the elements; boundary cells have one dimension less
  std::vector<Marker> markers;
  std::map<std::string, std::size_t, std::less<>> places;  ///< positions in `markers`, by name
  DistinctNames names;                                     ///< names of the sets' markers
  std::vector<bool> marked;
  Notes notes;
  bool has_lost_labels = false;

 private:
  Marker& marker(const std::string& name) {
    const auto [found, is_new] = places.try_emplace(name, markers.size());
    if (is_new) markers.push_back({name, {}});
    return markers[found->second];
  }

  [[nodiscard]] bool is_boundary(Index c) const {
    return meshorder::dimension(mesh.cells.shapes[c]) == dimension - 1;
  }

  [[nodiscard]] bool has_place(const EntitySet& set) const {
    if (set.association != Association::cells) return false;
    return set.members.empty() || std::any_of(set.members.begin(), set.members.end(),
                                              [&](Index member) { return is_boundary(member); });
  }

  void add_set(const EntitySet& set) {
    if (!has_place(set)) return note_set_unsupported(set, "SU2", notes);
    Marker& into = marker(name_of(set));
    places.try_emplace(set.name, static_cast<std::size_t>(&into - markers.data()));  // also by the set's name
    std::int64_t others = 0;
    std::int64_t repeated = 0;
    for (const Index c : set.members) {
      if (!is_boundary(c)) {
        ++others;
      } else if (marked[c]) {
        ++repeated;
      } else {
        marked[c] = true;
        into.cells.push_back(c);
      }
    }
    if (others > 0) {
      notes.push_back(
          fmt::format("the marker '{}' is written without {} cells of the set that are not on a "
                      "boundary: SU2 cannot hold them",
                      into.name, others));
    }
    if (repeated > 0) {
      notes.push_back(
          fmt::format("the marker '{}' is written without {} cells that another marker has: in SU2 "
                      "a boundary element has one",
                      into.name, repeated));
    }
  }

  /// Returns the name of a set's marker, without characters that would end the name in a file.
  std::string name_of(const EntitySet& set) {
    const std::string plain = plain_name(set.name, "%=");
    std::string name(trimmed(plain));
    if (name.empty()) name = kUnmarked;
    if (name == "SEND_RECEIVE") name += '_';  // in SU2 this name has another meaning: parts of a mesh
    name = names.take(name);
    if (name != set.name)
      notes.push_back(fmt::format("the set '{}' is written as the marker '{}'", set.name, name));
    if (name.find_first_of(" \t") != std::string::npos) {
      notes.push_back(fmt::format("the marker '{}' has a blank, which SU2 drops from the name", name));
    }
    return name;
  }

  /// Adds the boundary cells that are in no set to the markers of their labels.
  void add_others() {
    const Labels labels = labels_of(mesh, Association::cells);
    std::int64_t unmarked = 0;
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      const std::int64_t label = labels.any() ? labels.values[c] : 0;
      if (label != 0 && (marked[c] || !is_boundary(c))) has_lost_labels = true;
      if (marked[c] || !is_boundary(c)) continue;
      if (label == 0) ++unmarked;
      marked[c] = true;
      marker(label == 0 ? std::string(kUnmarked) : std::to_string(label)).cells.push_back(c);
    }
    if (unmarked > 0 && mesh.format != "su2") {
      notes.push_back(fmt::format(
          "{} boundary elements that are in no set and have no label are written as the marker '{}'",
          unmarked, kUnmarked));
    }
  }
};

bool is_flat(const Mesh& mesh) {
  return std::all_of(mesh.points.begin(), mesh.points.end(),
                     [&](const Point& point) { return point[2] == mesh.points.front()[2]; });
}

/// Returns the number of coordinates that a file gives to a point.
int dimension_of_file(const Mesh& mesh, int of_cells, Notes& notes) {
  if (of_cells == 3 || mesh.dimension == 2) return of_cells;
  const double height = mesh.points.empty() ? 0 : mesh.points.front()[2];
  if (height != 0)
    notes.push_back(fmt::format("the third coordinate, {}, of all points is not written", height));
  return 2;
}

const ElementKind* kind_of(Shape shape, int nodes) {
  const auto found = std::find_if(kElementKinds.begin(), kElementKinds.end(), [&](const ElementKind& kind) {
    return kind.shape == shape && kind.nodes == nodes;
  });
  return found == kElementKinds.end() ? nullptr : &*found;
}

/// Returns whether SU2 has the type, and its dimension is the mesh's highest (at least 2) or one less.
bool holds(const Mesh& mesh, Shape shape, int vertices) {
  const int highest = mesh.cells.highest_dimension();
  return kind_of(shape, vertices) != nullptr && highest >= 2 && dimension(shape) >= highest - 1;
}

std::string conflict(const Mesh& mesh) {
  const bool in_space = mesh.cells.highest_dimension() == 2 && mesh.dimension == 3 && !is_flat(mesh);
  return in_space ? "SU2 cannot hold a surface in space" : "";
}

class Su2Writer {
 public:
  Su2Writer(const Mesh& mesh, const Markers& markers, int dimension, OutputFile& out)
      : mesh_(mesh),
        markers_(markers),
        own_(dynamic_cast<const Su2Metadata*>(mesh.format_metadata.get())),
        dimension_(dimension),
        out_(out),
        written_(markers.markers.size(), false) {}

  void write() {
    static const std::vector<Su2Metadata::FileSection> plain{{SectionKind::dimension},
                                                             {SectionKind::elements},
                                                             {SectionKind::points},
                                                             {SectionKind::marker_count}};
    for (const Su2Metadata::FileSection& section : own_ != nullptr ? own_->sections : plain) write(section);
    for (std::size_t i = 0; i < markers_.markers.size(); ++i) {
      if (!written_[i]) write(markers_.markers[i], {});
    }
  }

 private:
  void write(const Su2Metadata::FileSection& section) {
    switch (section.part) {
      case SectionKind::dimension:
        return out_.print("NDIME= {}\n", dimension_);
      case SectionKind::elements:
        return write_elements();
      case SectionKind::points:
        return write_points();
      case SectionKind::marker_count:
        return out_.print("NMARK= {}\n", markers_.markers.size() + empty_labels());
      case SectionKind::marker:
        return write_marker(section);
      case SectionKind::surface_points:
        return write_surface_points(section.surface_points);
      case SectionKind::verbatim:
        return out_.write(section.text);
    }
  }

  void write_elements() {
    std::vector<Index> cells;
    cells.reserve(mesh_.cells.shapes.size());
    for (Index c = 0; c < mesh_.cell_count(); ++c) {
      if (markers_.is_volume(c)) cells.push_back(c);
    }
    out_.print("NELEM= {}\n", cells.size());
    write(cells, own_ != nullptr && own_->numbers_elements);
  }

  void write(const std::vector<Index>& cells, bool numbered) {
    const bool turn = own_ == nullptr || !own_->wedges_face_inward;
    write_rows(out_, index_size(cells), [&](Text& row, Index i) {
      const auto cell = mesh_.cells[cells[i]];
      const Shape shape = mesh_.cells.shapes[cells[i]];
      row.integer("", kind_of(shape, static_cast<int>(cell.size()))->type);
      for (std::size_t k = 0; k < cell.size(); ++k) {
        row.integer(" ", cell[turn && shape == Shape::wedge ? kWedge[k] : k]);
      }
      if (numbered) row.integer(" ", i);
      row.write("\n");
    });
  }

  void write_points() {
    const bool twice = own_ != nullptr && own_->counts_physical_points;
    out_.print("NPOIN= {}", mesh_.vertex_count());
    if (twice) out_.integer(" ", mesh_.vertex_count());
    out_.write("\n");
    const bool numbered = own_ != nullptr && own_->numbers_points;
    write_rows(out_, mesh_.vertex_count(), [&](Text& row, Index v) {
      for (int k = 0; k < dimension_; ++k) row.real(k == 0 ? "" : " ", mesh_.points[v][k]);
      if (numbered) row.integer(" ", v);
      row.write("\n");
    });
  }

  void write_surface_points(const std::vector<Su2Metadata::SurfacePoint>& points) {
    out_.print("FFD_SURFACE_POINTS= {}\n", points.size());
    for (const Su2Metadata::SurfacePoint& point : points) {
      out_.integer(point.before, point.vertex);
      out_.write(point.after);
      out_.write("\n");
    }
  }

  // ---- markers

  [[nodiscard]] std::optional<std::size_t> place_of(std::string_view name) const {
    const auto found = markers_.places.find(name);
    return found == markers_.places.end() ? std::nullopt : std::optional(found->second);
  }

  /// Returns how many of the file's markers have a label as their name, but no cells.
  [[nodiscard]] std::size_t empty_labels() const {
    if (own_ == nullptr) return 0;
    return static_cast<std::size_t>(std::count_if(
        own_->sections.begin(), own_->sections.end(), [&](const Su2Metadata::FileSection& section) {
          return section.part == SectionKind::marker && label_of_name(section.text) != 0 &&
                 !place_of(section.text);
        }));
  }

  /// Writes a marker of the file that the mesh came from.
  void write_marker(const Su2Metadata::FileSection& section) {
    if (const auto place = place_of(section.text)) {
      write(markers_.markers[*place], section.comments);
      written_[*place] = true;
    } else if (label_of_name(section.text) != 0) {
      write(Marker{section.text, {}}, section.comments);
    }
  }

  void write(const Marker& marker, std::string_view comments) {
    out_.print("MARKER_TAG= {}\n", marker.name);
    out_.write(comments);
    out_.print("MARKER_ELEMS= {}\n", marker.cells.size());
    write(marker.cells, own_ != nullptr && own_->numbers_marker_elements);
  }

  const Mesh& mesh_;
  const Markers& markers_;
  const Su2Metadata* own_;  // nullptr if the mesh comes from another format
  int dimension_;
  OutputFile& out_;
  std::vector<bool> written_;  // whether each marker has been written
};

}  // namespace

std::shared_ptr<const FormatMetadata> Su2Metadata::moved(std::span<const Index> vertices,
                                                         std::span<const Index> /*cells*/) const {
  auto result = std::make_shared<Su2Metadata>(*this);
  if (vertices.empty()) return result;
  for (FileSection& section : result->sections) {
    for (SurfacePoint& point : section.surface_points)
      point.vertex = vertices[static_cast<std::size_t>(point.vertex)];
  }
  return result;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const Markers markers(mesh);
  const int dimension = dimension_of_file(mesh, markers.dimension, notes);
  OutputFile out(path);
  Su2Writer(mesh, markers, dimension, out).write();
  out.commit();

  notes.insert(notes.end(), markers.notes.begin(), markers.notes.end());
  for (const DataArray& array : mesh.data) {
    const bool is_marked = &array == label_array(mesh, Association::cells) && !markers.has_lost_labels;
    if (!is_marked) note_array_unsupported(array, "SU2", notes);
  }
  note_ids_unsupported(mesh, "SU2", notes);
  if (dynamic_cast<const Su2Metadata*>(mesh.format_metadata.get()) == nullptr) {
    note_metadata_unsupported(mesh, "SU2", notes);
  }
}

Permutation places(const Mesh& mesh, std::vector<Index>& blocks) {
  const Markers markers(mesh);
  std::vector<Index> new_to_old;
  new_to_old.reserve(mesh.cells.shapes.size());
  blocks.clear();
  const auto add = [&](auto&& is_next) {
    const Index first = index_size(new_to_old);
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      if (is_next(c)) new_to_old.push_back(c);
    }
    if (index_size(new_to_old) > first) blocks.push_back(first);
  };
  add([&](Index c) { return markers.is_volume(c); });
  for (const Marker& marker : markers.markers) {
    if (!marker.cells.empty()) blocks.push_back(index_size(new_to_old));
    new_to_old.insert(new_to_old.end(), marker.cells.begin(), marker.cells.end());
  }
  // cells that are not written
  add([&](Index c) { return !markers.is_volume(c) && !markers.marked[c]; });
  return Permutation::from_new_to_old(std::move(new_to_old));
}

}  // namespace meshorder::su2

namespace meshorder {

Format su2_format() {
  return {"SU2", {".su2"}, false, su2::read, su2::write, su2::holds, su2::conflict, su2::places};
}

}  // namespace meshorder
