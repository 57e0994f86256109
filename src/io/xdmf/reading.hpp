// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/names.hpp"
#include "io/vtk/vtk.hpp"
#include "io/xdmf/document.hpp"
#include "io/xdmf/xdmf.hpp"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace meshorder::xdmf {

/// A uniform Grid and its step in a series of time steps.
struct GridElement {
  pugi::xml_node element;
  int series = -1;  ///< number of its temporal collection; −1: not in such a collection
  int step = 0;
};

/// The file that is being read, and the results so far.
struct Reading {
  Reading(const FilePath& path, Notes& warnings) : document(path), data(document, path), notes(warnings) {}

  /// Returns the only DataItem of an element.
  [[nodiscard]] pugi::xml_node item_of(pugi::xml_node element) const;
  /// Adds a set of the cells of a Grid; returns the set's name.
  std::string add_set_of_grid(const std::string& wanted, const std::vector<Index>& cells_of_grid);
  /// Returns the set that a field belongs to; renames the field if its part has a field of that name already.
  EntitySet& set_of(Field& field);

  Document document;
  DataReader data;
  Notes& notes;
  Mesh mesh = {};
  std::shared_ptr<XdmfLayout> layout = std::make_shared<XdmfLayout>();
  vtk::FileCells cells = {};
  std::vector<std::vector<Index>> rows = {};  ///< cells of each part, in the order of the file
  pugi::xml_node where_cells_are = {};

 private:
  struct KnownSet {
    std::size_t place;    // index in `mesh.sets`
    bool is_grid;         // whether it is the set of a Grid's cells
    std::set<int> parts;  // parts that have members in it
  };
  std::string next_set_name(Association association, const std::string& wanted, int part);

  std::map<std::pair<Association, std::string>, KnownSet> known_sets_;
  /// The highest number given to a name so far, by the wanted name and the part (−1 for sets of Grids).
  std::map<std::tuple<Association, std::string, int>, int> set_numbers_;
};

/// Returns the DataItems of an element.
std::vector<pugi::xml_node> items_of(pugi::xml_node element);
/// Returns the beginning of a text of the file, for messages.
std::string shortened(const std::string& text);
/// Reads Topologies; keeps only one copy of cells that several Topologies share.
class TopologyReader {
 public:
  explicit TopologyReader(Reading& reading) : reading_(reading) {}

  /// Reads a Topology; returns the number of its part.
  int read(const GridElement& grid, pugi::xml_node topology);

 private:
  /// Adds cells as a part, or finds the part that has them; returns the part's number.
  int part_of(const GridElement& grid, pugi::xml_node topology, vtk::FileCells piece);

  Reading& reading_;
  std::map<std::string, std::size_t> known_topologies_;  ///< indices of fields in the layout, by key
  std::map<int, int> series_parts_;
};

/// Reads Attributes and Sets, and makes arrays of them when all Grids have been read.
class ArrayReader {
 public:
  explicit ArrayReader(Reading& reading) : reading_(reading) {}

  /// Keeps the points of a time step as an array: they differ from the points of the mesh.
  void add_moved_points(const GridElement& grid, std::vector<Field>& fields, std::vector<Point> points,
                        int dimension);
  void read_attribute(const GridElement& grid, int part, pugi::xml_node element);
  void read_set(int part, pugi::xml_node element);
  /// Adds the arrays to the mesh.
  void finish();

 private:
  /// An array without its final name, which may need the number of its time step.
  struct Pending {
    Field field;
    DataArray array;
    GridElement grid;
  };

  /// An array to which the rows of several parts may be appended.
  struct GrowingArray {
    DataArray array;
    std::vector<bool> has_row;  ///< whether each cell has a row; empty before rows are appended
  };

  /// Adds an array under its name or, if that is taken, under a free name; returns the array's name.
  std::string add_growing(DataArray array);
  [[nodiscard]] std::string name_of(pugi::xml_node element) const;
  void read_of_grid(pugi::xml_node item, const std::string& name);
  /// Returns whether an array holds labels of cells: tags of FEniCSx or FEniCS, or an array called kLabel.
  [[nodiscard]] bool is_label(const Field& field, const DataArray& array) const;
  /// Renames an array to kLabel, unless one of its cells has a label already.
  void take_label(const Field& field, DataArray& array);
  /// Adds an array, or appends its rows to the array of that name if they fit; returns the array's name.
  std::string add(DataArray array, int part);
  /// Appends rows if their type fits and their cells have no rows yet; else returns false.
  bool append_rows(GrowingArray& growing, DataArray& array, const std::vector<Index>& rows) const;

  Reading& reading_;
  std::vector<GrowingArray> arrays_;
  UniqueNames array_names_;
  std::map<std::pair<Association, std::string>, std::size_t> place_of_array_;
  std::vector<Pending> pending_;
  std::vector<bool> labelled_;  ///< whether each cell has a label
  /// Indices in `pending_`, by key; nullopt for arrays without values.
  std::map<std::string, std::optional<std::size_t>> known_arrays_;
  std::map<std::string, std::size_t> known_sets_;  ///< indices of fields in the layout, by key
};

}  // namespace meshorder::xdmf
