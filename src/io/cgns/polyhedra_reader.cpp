// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "cells/polyhedron.hpp"
#include "io/cgns/reading.hpp"
#include "io/wedges.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

// Reads sections of polygons (NGON_n) and polyhedra (NFACE_n). Since version 3.4 of CGNS, ElementStartOffset
// gives the first member of each element; in older files, the number of an element's members precedes the
// members.

namespace meshorder::cgns {
namespace {

constexpr std::uint8_t kBothSides = 2;

/// Returns the corners of faces, each once, in the order of their first appearance. The result is in
/// `corners`, whose memory is reused.
std::span<const Index> corners_of(std::span<const PolyhedronFace> faces, std::vector<Index>& corners) {
  corners.clear();
  for (const PolyhedronFace& face : faces) {
    for (const Index corner : face.corners) {
      if (std::find(corners.begin(), corners.end(), corner) == corners.end()) corners.push_back(corner);
    }
  }
  return corners;
}

bool is_list(const Node& node) {
  return node.name == "PointList" || node.name == "PointRange" || node.name == "PointListDonor";
}

bool is_list_of_elements(const Node& node) {
  return node.name == "ElementList" || node.name == "ElementRange" || node.name == "CellListDonor";
}

/// Collects the elements that nodes of the zones list by number.
class ListedElements {
 public:
  explicit ListedElements(const Reading& reading) : reading_(reading), ranges_(reading.zones.size()) {}

  std::vector<NumberRanges> collect() {
    for (std::size_t z = 0; z < reading_.zones.size(); ++z) {
      for (const Node& node : reading_.zones[z].node->children) {
        if (node.label != "Elements_t") visit(node, z, Association::vertices);
      }
    }
    return std::move(ranges_);
  }

 private:
  void visit(const Node& node, std::size_t zone, Association inherited) {
    const Association association = location_of(node, inherited);
    for (const Node& child : node.children) {
      visit(child, zone, association);
      if (!is_list_of_elements(child) && !(is_list(child) && association == Association::cells)) continue;
      const std::size_t of_zone = child.name.ends_with("Donor") ? zone_named(node.text(), zone) : zone;
      const std::vector<std::int64_t> numbers = whole_numbers(reading_, child, reading_.zones[zone].path);
      if (child.label == "IndexRange_t" && numbers.size() == 2) {
        ranges_[of_zone].emplace_back(numbers[0], numbers[1]);
      } else {
        for (const std::int64_t number : numbers) ranges_[of_zone].emplace_back(number, number);
      }
    }
  }

  /// Returns the zone of that name or path; `otherwise` if there is none.
  [[nodiscard]] std::size_t zone_named(std::string_view name, std::size_t otherwise) const {
    name.remove_prefix(name.rfind('/') + 1);
    for (std::size_t z = 0; z < reading_.zones.size(); ++z) {
      if (reading_.zones[z].node->name == name) return z;
    }
    return otherwise;
  }

  const Reading& reading_;
  std::vector<NumberRanges> ranges_;
};

std::string element_place(const FoundSection& found, std::int64_t place) {
  return fmt::format("{}, element {}", found.path, found.section.first + place);
}

}  // namespace

std::vector<NumberRanges> listed_elements(const Reading& reading) {
  return ListedElements(reading).collect();
}

void PolyhedraReader::read(const NumberRanges& listed) {
  Polyhedra& polyhedra = *reading_.polyhedra;
  first_polygon_ = polyhedra.polygon_count();
  first_polyhedron_ = polyhedra.polyhedron_count();
  for (const int type : {kPolygons, kPolyhedra}) {
    for (FoundSection& found : sections_) {
      if (found.section.type == type) read_section(found);
    }
  }
  reading_.metadata->cell_of_polygon.resize(polyhedra.corner_starts.size() - 1, -1);
  reading_.metadata->cell_of_polyhedron.resize(polyhedra.face_starts.size() - 1, -1);
  require_cells();
  count_uses();
  for (const auto& [first, last] : listed) {
    for (const FoundSection& found : sections_) {
      if (found.section.type != kPolygons || last < found.section.first) continue;
      const Index before = found.section.first_item - first_polygon_;
      const std::int64_t begin = std::max(first, found.section.first) - found.section.first;
      const std::int64_t end = std::min(last, found.last) - found.section.first;
      for (std::int64_t k = begin; k <= end; ++k) uses_[static_cast<std::size_t>(before + k)] = 0;
    }
  }
}

/// Throws if the zone has polygons with ParentElements, but neither polyhedra nor other elements.
void PolyhedraReader::require_cells() const {
  if (reading_.metadata->cell_dimension < 3) return;
  for (const FoundSection& found : sections_) {
    if (found.section.type != kPolygons) return;
  }
  for (const FoundSection& found : sections_) {
    if (found.node->child("ParentElements") == nullptr) continue;
    reading_.fail(found.path, "gives polyhedra by the ParentElements of their faces only",
                  "save it with a section NFACE_n of the polyhedra");
  }
}

void PolyhedraReader::read_section(FoundSection& found) {
  Polyhedra& polyhedra = *reading_.polyhedra;
  const bool has_polygons = found.section.type == kPolygons;
  const Index before = has_polygons ? polyhedra.polygon_count() : polyhedra.polyhedron_count();
  if (std::int64_t{before} + found.section.count >= kMaxIndex) {
    reading_.fail("", "has more than 2,147,483,646 polygons or polyhedra", "split the mesh");
  }
  found.section.first_item = before;
  const Node* const connectivity = found.node->child("ElementConnectivity");
  if (connectivity == nullptr) {
    reading_.fail(found.path, "has no ElementConnectivity", "the file may be damaged");
  }
  const bool is_whole = with_integers(numbers_of(*connectivity), [&](const auto& numbers) {
    read_rows(found, numbers);
    return true;
  });
  if (!is_whole) {
    reading_.fail(found.path + "/ElementConnectivity", "does not hold whole numbers", "I4 or I8 is expected");
  }
}

template <class Number>
void PolyhedraReader::read_rows(const FoundSection& found, const std::vector<Number>& numbers) {
  const std::string path = found.path + "/ElementStartOffset";
  const Node* const offsets = found.node->child("ElementStartOffset");
  const auto count = static_cast<std::size_t>(found.section.count);
  std::vector<std::int64_t> starts;
  if (offsets != nullptr) starts = whole_numbers(reading_, *offsets, path);
  if (offsets != nullptr && (starts.size() != count + 1 || starts.front() != 0)) {
    reading_.fail(path, fmt::format("has {} values for {} elements", starts.size(), count),
                  "one more than elements is expected, the first of them 0");
  }
  std::vector<std::int64_t> members;
  std::size_t at = 0;
  for (std::size_t e = 0; e < count; ++e) {
    const auto fail_at = [&](const std::string& what) {
      reading_.fail(element_place(found, static_cast<std::int64_t>(e)), what, "the file may be damaged");
    };
    std::size_t size = 0;
    if (offsets != nullptr) {
      if (starts[e + 1] < starts[e]) fail_at("ends before it begins by ElementStartOffset");
      size = static_cast<std::size_t>(starts[e + 1] - starts[e]);
    } else {
      if (at == numbers.size()) fail_at("is not there: ElementConnectivity ends before");
      if (std::cmp_less(numbers[at], 0)) fail_at(fmt::format("counts {} members", numbers[at]));
      size = static_cast<std::size_t>(numbers[at++]);
    }
    if (size > numbers.size() - at) fail_at("has more members than ElementConnectivity");
    members.assign(numbers.begin() + static_cast<std::ptrdiff_t>(at),
                   numbers.begin() + static_cast<std::ptrdiff_t>(at + size));
    at += size;
    if (found.section.type == kPolygons) {
      add_polygon(found, members);
    } else {
      add_polyhedron(found, members);
    }
  }
  if (at != numbers.size()) {
    reading_.fail(
        found.path + "/ElementConnectivity",
        fmt::format("has {} numbers more than its {} elements need", numbers.size() - at, count),
        offsets != nullptr ? "ElementStartOffset may be damaged" : "each element is a count and its members");
  }
}

void PolyhedraReader::add_polygon(const FoundSection& found, std::span<const std::int64_t> corners) {
  Polyhedra& polyhedra = *reading_.polyhedra;
  const auto place = [&] {
    return element_place(found, polyhedra.polygon_count() - found.section.first_item);
  };
  if (corners.size() < 3) {
    reading_.fail(place(), fmt::format("is a polygon of {} vertices", corners.size()), "it has at least 3");
  }
  for (const std::int64_t number : corners) {
    if (number < 1 || number > zone_.vertices) {
      reading_.fail(place(), fmt::format("vertex {} does not exist", number),
                    fmt::format("the vertices are 1 to {}", zone_.vertices));
    }
    polyhedra.corners.push_back(zone_.first_vertex + static_cast<Index>(number) - 1);
  }
  polyhedra.corner_starts.push_back(static_cast<Offset>(polyhedra.corners.size()));
}

void PolyhedraReader::add_polyhedron(const FoundSection& found, std::span<const std::int64_t> faces) {
  Polyhedra& polyhedra = *reading_.polyhedra;
  for (const std::int64_t number : faces) {
    const bool is_inward = number < 0;
    const auto size = static_cast<std::uint64_t>(number);
    const Index polygon = polygon_of(is_inward ? 0 - size : size);
    if (polygon < 0) {
      reading_.fail(element_place(found, polyhedra.polyhedron_count() - found.section.first_item),
                    fmt::format("face {} does not exist", number),
                    "the faces are the elements of the sections NGON_n");
    }
    polyhedra.faces.push_back(is_inward ? -1 - polygon : 1 + polygon);
  }
  polyhedra.face_starts.push_back(static_cast<Offset>(polyhedra.faces.size()));
}

/// Returns the polygon with that element number, −1 if there is none.
Index PolyhedraReader::polygon_of(std::uint64_t number) const {
  for (const FoundSection& found : sections_) {
    const auto first = static_cast<std::uint64_t>(found.section.first);
    if (found.section.type == kPolygons && number >= first && std::cmp_less_equal(number, found.last)) {
      return found.section.first_item + static_cast<Index>(number - first);
    }
  }
  return -1;
}

std::int64_t PolyhedraReader::number_of(Index polygon) const {
  std::int64_t number = 0;
  for (const FoundSection& found : sections_) {
    const Index place = polygon - found.section.first_item;
    if (found.section.type == kPolygons && place >= 0 && place < found.section.count) {
      number = found.section.first + place;
    }
  }
  return number;
}

void PolyhedraReader::count_uses() {
  const Polyhedra& polyhedra = *reading_.polyhedra;
  uses_.assign(static_cast<std::size_t>(polyhedra.polygon_count() - first_polygon_), 0);
  for (Index p = first_polyhedron_; p < polyhedra.polyhedron_count(); ++p) {
    for (const Index face : polyhedra.faces_of(p)) {
      const Index polygon = Polyhedra::polygon_of(face);
      if (++uses_[static_cast<std::size_t>(polygon - first_polygon_)] > kBothSides) {
        reading_.fail(zone_.path,
                      fmt::format("the polygon {} is a face of three polyhedra", number_of(polygon)),
                      "it has two sides");
      }
    }
  }
}

void PolyhedraReader::append_cells(const FoundSection& found) {
  if (found.section.type == kPolygons) return append_polygons(found);
  append_polyhedra(found);
}

void PolyhedraReader::append_polygons(const FoundSection& found) {
  Mesh& mesh = reading_.mesh;
  for (Index k = 0; k < found.section.count; ++k) {
    const Index polygon = found.section.first_item + k;
    if (uses_[static_cast<std::size_t>(polygon - first_polygon_)] == kBothSides) continue;
    const std::span<const Index> corners = reading_.polyhedra->corners_of(polygon);
    reading_.metadata->cell_of_polygon[polygon] = mesh.cell_count();
    mesh.cells.push_back(corners.size() == 3   ? Shape::triangle
                         : corners.size() == 4 ? Shape::quad
                                               : Shape::polygon,
                         corners);
  }
}

void PolyhedraReader::append_polyhedra(const FoundSection& found) {
  const Polyhedra& polyhedra = *reading_.polyhedra;
  Mesh& mesh = reading_.mesh;
  const Index first = mesh.cell_count();
  std::vector<PolyhedronFace> faces;
  WedgeVote vote(mesh.points);
  Index contradictions = 0;
  std::vector<Index> corners;
  for (Index k = 0; k < found.section.count; ++k) {
    const Index polyhedron = found.section.first_item + k;
    faces.clear();
    for (const Index face : polyhedra.faces_of(polyhedron)) {
      faces.push_back({polyhedra.corners_of(Polyhedra::polygon_of(face)), face < 0});
    }
    const CellOfFaces cell = cell_of_faces(faces);
    if (cell.kind == CellOfFaces::Kind::open) {
      reading_.fail(element_place(found, k),
                    fmt::format("its {} faces do not enclose a volume", faces.size()),
                    "each edge belongs to two faces of a polyhedron");
    }
    reading_.metadata->cell_of_polyhedron[polyhedron] = mesh.cell_count();
    if (cell.kind == CellOfFaces::Kind::other) {
      mesh.cells.push_back(Shape::polyhedron, corners_of(faces, corners));
      continue;
    }
    if (!cell.signs_agree) ++contradictions;
    vote.add(cell.shape, cell.cell());
    mesh.cells.push_back(cell.shape, cell.cell());
  }
  turn_by_volumes(first, found.path, contradictions, vote.sign_of_volumes());
}

/// Turns cells from `first` on inside out. If the signs of faces contradict each other, turns the cells with
/// negative volumes; otherwise turns all cells if `sign` < 0.
void PolyhedraReader::turn_by_volumes(Index first, const std::string& path, Index contradictions, int sign) {
  Mesh& mesh = reading_.mesh;
  if (contradictions > 0) {
    reading_.notes.push_back(fmt::format(
        "the cells of '{}' are turned by their volumes: in {} of them the signs of the faces contradict each "
        "other",
        path, contradictions));
  } else if (sign < 0) {
    reading_.notes.push_back(fmt::format(
        "the signs of the faces in '{}' say that their normals point into the cells, and are taken the other "
        "way",
        path));
  } else {
    return;
  }
  for (Index c = first; c < mesh.cell_count(); ++c) {
    const Shape shape = mesh.cells.shapes[c];
    if (contradictions == 0 || volume_at_first_corner(mesh.points, shape, mesh.cells[c]) < 0) {
      turn_inside_out(shape, mesh.cells[c]);
    }
  }
}

}  // namespace meshorder::cgns
