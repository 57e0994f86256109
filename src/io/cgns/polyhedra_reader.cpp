// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "cells/polyhedron.hpp"
#include "io/cgns/reading.hpp"
#include "io/wedges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

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

/// Collects the elements that a node of a zone and the nodes below it list by number.
void collect_listed(const Reading& reading, const Node& node, int zone, Association inherited,
                    std::vector<NumberRanges>& listed) {
  const Association association = location_of(node, inherited);
  for (const Node& child : node.children) {
    collect_listed(reading, child, zone, association, listed);
    if (!is_list_of_elements(child) && !(is_list(child) && association == Association::cells)) continue;
    const int donor = child.name.ends_with("Donor") ? reading.zone_named(node.text()) : -1;
    NumberRanges& ranges = listed[donor < 0 ? zone : donor];
    const std::vector<std::int64_t> numbers = whole_numbers(reading, child, reading.zones[zone].path);
    if (child.label == "IndexRange_t" && numbers.size() == 2) {
      ranges.emplace_back(numbers[0], numbers[1]);
    } else {
      for (const std::int64_t number : numbers) ranges.emplace_back(number, number);
    }
  }
}

std::string element_place(const FoundSection& found, std::int64_t place) {
  return fmt::format("{}, element {}", found.path, found.section.first + place);
}

class PolyhedraReader {
 public:
  PolyhedraReader(Reading& reading, const ZonePlaces& zone, std::vector<FoundSection>& sections)
      : reading_(reading),
        polyhedra_(*reading.polyhedra),
        zone_(zone),
        sections_(sections),
        first_polygon_(polyhedra_.polygon_count()),
        first_polyhedron_(polyhedra_.polyhedron_count()) {}

  void read(const NumberRanges& listed) {
    for (const int type : {kPolygons, kPolyhedra}) {
      for (FoundSection& found : sections_) {
        if (found.section.type == type) read_section(found);
      }
    }
    require_cells();
    std::vector<Index>& cells = reading_.metadata->cell_of_polygon;
    for (const std::uint8_t uses : uses_of_polygons()) cells.push_back(uses == kBothSides ? -1 : 0);
    reading_.metadata->cell_of_polyhedron.resize(polyhedra_.face_starts.size() - 1, -1);
    for (const auto& [first, last] : listed) {
      for (const FoundSection& found : sections_) {
        if (found.section.type != kPolygons || last < found.section.first) continue;
        const std::int64_t begin = std::max(first, found.section.first) - found.section.first;
        const std::int64_t end = std::min(last, found.last()) - found.section.first;
        for (std::int64_t k = begin; k <= end; ++k) cells[found.section.first_item + k] = 0;
      }
    }
  }

 private:
  void read_section(FoundSection& found) {
    const bool has_polygons = found.section.type == kPolygons;
    const Index before = has_polygons ? polyhedra_.polygon_count() : polyhedra_.polyhedron_count();
    if (std::int64_t{before} + found.section.count >= kMaxIndex) {
      reading_.fail("", "has more than 2,147,483,646 polygons or polyhedra", "split the mesh");
    }
    found.section.first_item = before;
    with_whole_numbers(reading_, *found.connectivity, found.path + "/ElementConnectivity",
                       [&](const auto& numbers) { read_rows(found, numbers); });
  }

  template <class Number>
  void read_rows(const FoundSection& found, const std::vector<Number>& numbers) {
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
        reading_.fail(element_place(found, static_cast<std::int64_t>(e)), what);
      };
      std::size_t size = 0;
      if (offsets != nullptr) {
        if (starts[e + 1] < starts[e]) fail_at("ends before it begins by ElementStartOffset");
        size = static_cast<std::size_t>(starts[e + 1] - starts[e]);
      } else {
        if (at == numbers.size()) fail_at("is missing: ElementConnectivity ends before it");
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
      reading_.fail(found.path + "/ElementConnectivity",
                    fmt::format("has {} numbers more than its {} elements need", numbers.size() - at, count),
                    offsets != nullptr ? "ElementStartOffset may be damaged"
                                       : "each element is a count and its members");
    }
  }

  void add_polygon(const FoundSection& found, std::span<const std::int64_t> corners) {
    const auto place = [&] {
      return element_place(found, polyhedra_.polygon_count() - found.section.first_item);
    };
    if (corners.size() < 3) {
      reading_.fail(place(), fmt::format("is a polygon of {} vertices", corners.size()), "it has at least 3");
    }
    for (const std::int64_t number : corners) {
      polyhedra_.corners.push_back(reading_.vertex_of(number, zone_, place));
    }
    polyhedra_.corner_starts.push_back(static_cast<Offset>(polyhedra_.corners.size()));
  }

  void add_polyhedron(const FoundSection& found, std::span<const std::int64_t> faces) {
    for (const std::int64_t number : faces) {
      const bool is_inward = number < 0;
      const auto size = static_cast<std::uint64_t>(number);
      const Index polygon = polygon_of(is_inward ? 0 - size : size);
      if (polygon < 0) {
        reading_.fail(element_place(found, polyhedra_.polyhedron_count() - found.section.first_item),
                      fmt::format("face {} does not exist", number),
                      "the faces are the elements of the sections NGON_n");
      }
      polyhedra_.faces.push_back(is_inward ? -1 - polygon : 1 + polygon);
    }
    polyhedra_.face_starts.push_back(static_cast<Offset>(polyhedra_.faces.size()));
  }

  /// Returns the polygon with that element number, −1 if there is none.
  [[nodiscard]] Index polygon_of(std::uint64_t number) const {
    for (const FoundSection& found : sections_) {
      const auto first = static_cast<std::uint64_t>(found.section.first);
      if (found.section.type == kPolygons && number >= first && std::cmp_less_equal(number, found.last())) {
        return found.section.first_item + static_cast<Index>(number - first);
      }
    }
    return -1;
  }

  [[nodiscard]] std::int64_t number_of(Index polygon) const {
    std::int64_t number = 0;
    for (const FoundSection& found : sections_) {
      const Index place = polygon - found.section.first_item;
      if (found.section.type == kPolygons && place >= 0 && place < found.section.count) {
        number = found.section.first + place;
      }
    }
    return number;
  }

  /// Throws if a zone of volumes has only sections of polygons, and one of them has ParentElements.
  void require_cells() const {
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

  /// Returns the number of polyhedra at each polygon of the zone; fails if a polygon has three.
  [[nodiscard]] std::vector<std::uint8_t> uses_of_polygons() const {
    std::vector<std::uint8_t> uses(polyhedra_.polygon_count() - first_polygon_);
    for (Index p = first_polyhedron_; p < polyhedra_.polyhedron_count(); ++p) {
      for (const Index face : polyhedra_.faces_of(p)) {
        const Index polygon = Polyhedra::polygon_of(face);
        if (++uses[polygon - first_polygon_] > kBothSides) {
          reading_.fail(zone_.path,
                        fmt::format("the polygon {} is a face of three polyhedra", number_of(polygon)),
                        "it has two sides");
        }
      }
    }
    return uses;
  }

  Reading& reading_;
  Polyhedra& polyhedra_;
  const ZonePlaces& zone_;
  std::vector<FoundSection>& sections_;
  Index first_polygon_;
  Index first_polyhedron_;
};

void append_polygons(Reading& reading, const FoundSection& found) {
  Mesh& mesh = reading.mesh;
  for (Index k = 0; k < found.section.count; ++k) {
    const Index polygon = found.section.first_item + k;
    Index& cell = reading.metadata->cell_of_polygon[polygon];
    if (cell < 0) continue;
    cell = mesh.cell_count();
    const std::span<const Index> corners = reading.polyhedra->corners_of(polygon);
    mesh.cells.push_back(corners.size() == 3   ? Shape::triangle
                         : corners.size() == 4 ? Shape::quad
                                               : Shape::polygon,
                         corners);
  }
}

/// Turns cells from `first` on inside out: if `contradictions` > 0, those with negative volumes; else, if
/// `sign` < 0, all. Notes what it turns.
void turn_by_volumes(Reading& reading, Index first, const std::string& path, Index contradictions, int sign) {
  Mesh& mesh = reading.mesh;
  if (contradictions > 0) {
    reading.notes.push_back(fmt::format(
        "the cells of '{}' are turned by their volumes: in {} of them the signs of the faces contradict each "
        "other",
        path, contradictions));
  } else if (sign < 0) {
    reading.notes.push_back(fmt::format(
        "the normals of the faces in '{}' point into the cells by their signs; the signs are reversed",
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

void append_polyhedra(Reading& reading, const FoundSection& found) {
  const Polyhedra& polyhedra = *reading.polyhedra;
  Mesh& mesh = reading.mesh;
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
      reading.fail(element_place(found, k), fmt::format("its {} faces do not enclose a volume", faces.size()),
                   "each edge belongs to two faces of a polyhedron");
    }
    reading.metadata->cell_of_polyhedron[polyhedron] = mesh.cell_count();
    if (cell.kind == CellOfFaces::Kind::other) {
      mesh.cells.push_back(Shape::polyhedron, corners_of(faces, corners));
      continue;
    }
    if (!cell.signs_agree) ++contradictions;
    vote.add(cell.shape, cell.cell());
    mesh.cells.push_back(cell.shape, cell.cell());
  }
  turn_by_volumes(reading, first, found.path, contradictions, vote.sign_of_volumes());
}

}  // namespace

std::vector<NumberRanges> listed_elements(const Reading& reading) {
  std::vector<NumberRanges> listed(reading.zones.size());
  for (std::size_t z = 0; z < reading.zones.size(); ++z) {
    for (const Node& node : reading.zones[z].node->children) {
      if (node.label != "Elements_t") {
        collect_listed(reading, node, static_cast<int>(z), Association::vertices, listed);
      }
    }
  }
  return listed;
}

void read_polyhedra(Reading& reading, const ZonePlaces& zone, std::vector<FoundSection>& sections,
                    const NumberRanges& listed) {
  PolyhedraReader(reading, zone, sections).read(listed);
}

void append_cells(Reading& reading, const FoundSection& found) {
  if (found.section.type == kPolygons) return append_polygons(reading, found);
  append_polyhedra(reading, found);
}

}  // namespace meshorder::cgns
