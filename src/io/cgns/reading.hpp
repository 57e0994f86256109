// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/cgns/cgns.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace meshorder::cgns {

/// A zone that is being read.
struct ZonePlaces {
  Node* node = nullptr;
  std::string path;
  Index first_vertex = 0;
  Index vertices = 0;
  std::vector<int> sections = {};       ///< ascending by their numbers
  std::vector<Index> first_cells = {};  ///< of these sections
  std::vector<Index> centred_cells =
      {};  ///< those of the base's dimension, which have values at their centres
  std::map<std::string, int> steps = {};  ///< of solutions and coordinates, from 1, where there are several
};

/// Values of some vertices or cells, of one node.
struct Piece {
  std::string solution;
  std::string name;
  int zone = 0;
  Association association = Association::vertices;
  std::shared_ptr<const std::vector<Index>> rows;
  Values values;
  int field = 0;
};

/// A file that is being read, and what has been found so far.
struct Reading {
  Reading(const FilePath& path, Notes& warnings) : file(path.string()), notes(warnings) {}

  [[noreturn]] void fail(const std::string& place, const std::string& what, const std::string& remedy) const;
  /// Gives a node a field instead of its bytes, and returns the place of the field.
  int bind(Node& node, Field field);

  std::string file;
  Notes& notes;
  Mesh mesh = {};
  Tree tree = {};
  std::shared_ptr<Metadata> metadata = std::make_shared<Metadata>();
  std::vector<ZonePlaces> zones = {};
  std::vector<Piece> pieces = {};
};

/// Returns the values of a node of whole numbers; throws InputError for others.
std::vector<std::int64_t> whole_numbers(const Reading& reading, const Node& node, const std::string& path);

/// Returns the numbers of a node in their own type; text, bits and the like give none.
Values numbers_of(const Node& node);

/// Reads solutions, boundary conditions and everything else in the zones that names vertices or cells.
void read_attachments(Reading& reading);

/// Makes arrays of the pieces.
void add_arrays(Reading& reading);

}  // namespace meshorder::cgns
