// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/cgns/cgns.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::cgns {

/// A zone that is being read.
struct ZonePlaces {
  Node* node = nullptr;
  std::string path;
  Index first_vertex = 0;
  Index vertices = 0;
  std::vector<int> sections = {};       ///< ascending by their numbers
  std::vector<Index> first_cells = {};  ///< first cell of each of these sections
  std::vector<Index> cell_counts = {};  ///< number of cells in the mesh of each of these sections
  std::vector<Index> centred_cells =
      {};  ///< cells of the base's dimension, which have values at their centres
  std::map<std::string, int> steps = {};  ///< time step of solutions and grids, from 1, if there are several
};

/// The values of one node, which belong to the vertices or cells `rows`.
struct Piece {
  std::string solution;
  std::string name;
  int zone = 0;
  Association association = Association::vertices;
  std::shared_ptr<const std::vector<Index>> rows;
  Values values;
  int field = 0;
};

/// A file that is being read, and the results so far.
struct Reading {
  Reading(const FilePath& path, Notes& warnings) : file(path.string()), notes(warnings) {}

  [[noreturn]] void fail(const std::string& place, const std::string& what, const std::string& remedy) const;
  /// Replaces the bytes of a node by a field, and returns the index of the field.
  int bind(Node& node, Field field);

  std::string file;
  Notes& notes;
  Mesh mesh = {};
  Tree tree = {};
  std::shared_ptr<CgnsMetadata> metadata = std::make_shared<CgnsMetadata>();
  std::vector<ZonePlaces> zones = {};
  std::vector<Piece> pieces = {};
  std::shared_ptr<Polyhedra> polyhedra = std::make_shared<Polyhedra>();
};

/// A section before its cells are in the mesh.
struct FoundSection {
  Node* node;
  std::string path;
  Section section;
  std::int64_t last = 0;
};

/// Returns the values of a node as whole numbers; throws InputError if they are of another type.
std::vector<std::int64_t> whole_numbers(const Reading& reading, const Node& node, const std::string& path);

/// Returns the numbers of a node in their own type; an empty vector of strings if it holds no numbers.
Values numbers_of(const Node& node);

/// Returns whether values and lists of a node belong to vertices or cells; faces and edges count as cells.
Association location_of(const Node& node, Association inherited);

/// Ranges of element numbers: first and last.
using NumberRanges = std::vector<std::pair<std::int64_t, std::int64_t>>;

/// Returns, for each zone, the elements that conditions, solutions and connectivities list by number.
std::vector<NumberRanges> listed_elements(const Reading& reading);

/// Reads the polygons and polyhedra of a zone. Throws InputError if they are damaged.
class PolyhedraReader {
 public:
  /// `sections`: the sections of the zone, ascending by their numbers.
  PolyhedraReader(Reading& reading, const ZonePlaces& zone, std::vector<FoundSection>& sections)
      : reading_(reading), zone_(zone), sections_(sections) {}

  /// Reads all sections of polygons and polyhedra into `reading.polyhedra`. `listed`: elements that become
  /// cells even if they lie between two polyhedra.
  void read(const NumberRanges& listed);
  /// Appends the cells of a section to the mesh.
  void append_cells(const FoundSection& found);

 private:
  void read_section(FoundSection& found);
  template <class Number>
  void read_rows(const FoundSection& found, const std::vector<Number>& numbers);
  void add_polygon(const FoundSection& found, std::span<const std::int64_t> corners);
  void add_polyhedron(const FoundSection& found, std::span<const std::int64_t> faces);
  [[nodiscard]] Index polygon_of(std::uint64_t number) const;
  [[nodiscard]] std::int64_t number_of(Index polygon) const;
  void require_cells() const;
  void count_uses();
  void append_polygons(const FoundSection& found);
  void append_polyhedra(const FoundSection& found);
  void turn_by_volumes(Index first, const std::string& path, Index contradictions, int sign);

  Reading& reading_;
  const ZonePlaces& zone_;
  std::vector<FoundSection>& sections_;
  Index first_polygon_ = 0;
  Index first_polyhedron_ = 0;
  /// For each polygon, the number of polyhedra that have it as a face; 0 if the polygon is listed.
  std::vector<std::uint8_t> uses_ = {};
};

/// Reads all nodes of the zones that refer to vertices or cells: solutions, boundary conditions and others.
void read_attachments(Reading& reading);

/// Makes the arrays of the mesh from the pieces; pieces of one name become one array if they can.
void add_arrays(Reading& reading);

}  // namespace meshorder::cgns
