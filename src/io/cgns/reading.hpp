// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/cgns/cgns.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::cgns {

/// A zone that is being read.
struct ZonePlaces {
  Node* node = nullptr;
  std::string path;
  Index first_vertex = 0;
  Index vertices = 0;
  int first_section = 0;  ///< index in the metadata; a zone's sections ascend by element number
  int section_count = 0;
  std::vector<Index> centred_cells = {};  ///< cells of the base's dimension ("CellCenter")
  std::map<std::string, int> steps = {};  ///< step of each solution and grid, from 1; empty for one step
};

/// The values of one node, which become all or part of an array.
struct Piece {
  std::string solution;
  std::string name;
  Values values;
  int field = 0;
};

/// Consecutive cells of the mesh.
struct CellRange {
  Index first = 0;
  Index count = 0;
};

/// A file that is being read, and the results so far.
struct Reading {
  Reading(const FilePath& path, Notes& warnings) : file(path.string()), notes(warnings) {}

  [[noreturn]] void fail(const std::string& place, const std::string& what,
                         const std::string& remedy = "the file may be damaged") const;
  /// Replaces the bytes of a node by a field, and returns the index of the field.
  int bind(Node& node, Field field);
  /// Returns vertex `number` of a zone. Throws InputError, with the text of `place`, if there is none.
  template <class Number, class Place>
  [[nodiscard]] Index vertex_of(Number number, const ZonePlaces& zone, const Place& place) const {
    if (number < 1 || std::cmp_greater(number, zone.vertices)) {
      fail(place(), fmt::format("vertex {} does not exist", number),
           fmt::format("the vertices are 1 to {}", zone.vertices));
    }
    return zone.first_vertex + static_cast<Index>(number) - 1;
  }
  /// Returns the vertices or cells that have the values of a field, in the order of the values.
  [[nodiscard]] std::vector<Index> rows_of(const Field& field) const;
  /// Returns the zone of that name or path, −1 if there is none.
  [[nodiscard]] int zone_named(std::string_view path) const;

  std::string file;
  Notes& notes;
  Mesh mesh = {};
  Tree tree = {};
  std::shared_ptr<CgnsMetadata> metadata = std::make_shared<CgnsMetadata>();
  std::vector<ZonePlaces> zones = {};
  std::vector<CellRange> cells_of_section = {};
  std::vector<Piece> pieces = {};
  std::shared_ptr<Polyhedra> polyhedra = std::make_shared<Polyhedra>();
};

/// A section before its cells are in the mesh.
struct FoundSection {
  Node* node;
  Node* connectivity;
  std::string path;
  Section section;

  /// Returns the number of the last element.
  [[nodiscard]] std::int64_t last() const { return section.first + section.count - 1; }
};

/// Returns the values of a node as whole numbers; throws InputError if they are of another type.
std::vector<std::int64_t> whole_numbers(const Reading& reading, const Node& node, const std::string& path);

/// Returns the numbers of a node in their own type; an empty vector of strings if it holds no numbers.
Values numbers_of(const Node& node);

/// Calls `work` with the numbers of a node in their own type; throws InputError unless they are whole.
template <class Work>
void with_whole_numbers(const Reading& reading, const Node& node, const std::string& path, const Work& work) {
  const Values values = numbers_of(node);
  if (!are_integers(values)) reading.fail(path, "does not hold whole numbers", "I4 or I8 is expected");
  with_integers(values, work);
}

/// Returns what a node's data belong to: vertices or cells (also faces, edges); `inherited` by default.
Association location_of(const Node& node, Association inherited);

/// Ranges of element numbers: first and last.
using NumberRanges = std::vector<std::pair<std::int64_t, std::int64_t>>;

/// Returns, for each zone, the elements that conditions, solutions and connectivities list by number.
std::vector<NumberRanges> listed_elements(const Reading& reading);

/// Reads the polygons and polyhedra of a zone into `reading.polyhedra`. `sections`: the sections of the zone,
/// ascending by their numbers; `listed`: polygons that become cells even if they are between two polyhedra.
void read_polyhedra(Reading& reading, const ZonePlaces& zone, std::vector<FoundSection>& sections,
                    const NumberRanges& listed);
/// Appends the cells of a section of polygons or polyhedra to the mesh.
void append_cells(Reading& reading, const FoundSection& found);

/// Reads all nodes of the zones that refer to vertices or cells: solutions, boundary conditions and others.
void read_attachments(Reading& reading);

/// Makes the arrays of the mesh from the pieces. Pieces of one name become one array if they fit together.
void add_arrays(Reading& reading);

}  // namespace meshorder::cgns
