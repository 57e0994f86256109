// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of I-deas universal files.
//
// Format: SDRC, I-deas Universal File Datasets. A file is a sequence of datasets, each between two lines of
// −1.

#include "io/deck/metadata.hpp"
#include "io/stream/scanner.hpp"
#include "io/unv/elements.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::unv {

// Numbers of datasets, by content.
inline constexpr int kNodes = 2411;
inline constexpr int kNodesInDouble = 781;
inline constexpr int kNodesInSingle = 15;
inline constexpr int kElements = 2412;
inline constexpr int kElementsOfOld = 780;
inline constexpr int kGroups = 2477;
inline constexpr int kResults = 2414;
inline constexpr int kResultsAtNodes = 55;
inline constexpr int kResultsAtElements = 56;
inline constexpr int kHeader = 151;    ///< header of the file
inline constexpr int kSystems = 2420;  ///< coordinate systems

// Codes of the kinds of group members.
inline constexpr std::int64_t kNodeCode = 7;
inline constexpr std::int64_t kElementCode = 8;

// Widths of fields in columns.
inline constexpr std::size_t kWholeWidth = 10;
inline constexpr std::size_t kCoordinateWidth = 25;
inline constexpr std::size_t kSingleWidth = 13;  ///< of real numbers in single precision
inline constexpr std::size_t kWholesOnLine = 8;
inline constexpr std::size_t kRecordWidth = kWholesOnLine * kWholeWidth;

/// Texts after the fields of records, by item and by line of the item, both from 0.
using Remarks = std::map<std::pair<Index, Index>, std::string>;

/// The fields of a node besides its number and coordinates.
struct NodeFields {
  std::int64_t system = 1;
  std::int64_t displacement_system = 1;
  std::int64_t colour = 11;

  auto operator<=>(const NodeFields&) const = default;
};

/// The fields of an element besides its number and nodes.
struct ElementFields {
  std::int64_t type = 0;
  std::int64_t property_table = 0;  ///< in dataset 780 only, like `material_table`
  std::int64_t property = 1;
  std::int64_t material_table = 0;
  std::int64_t material = 0;
  std::int64_t colour = 7;
  bool has_beam = false;                  ///< whether the file has a line for `beam`
  std::array<std::int64_t, 3> beam = {};  ///< node that gives the orientation, cross-sections of both ends

  auto operator<=>(const ElementFields&) const = default;
};

/// The fields of all items in the order of the file; each combination is stored once.
template <class Fields>
class FieldTable {
 public:
  void add(const Fields& fields) {
    if (size_ == 0 || different_[last_] != fields) {
      const auto [found, is_new] = places_.try_emplace(fields, index_size(different_));
      if (is_new) different_.push_back(fields);
      last_ = found->second;
    }
    if (last_ != 0 && of_.empty()) of_.resize(static_cast<std::size_t>(size_), 0);
    if (!of_.empty()) of_.push_back(last_);
    ++size_;
  }
  [[nodiscard]] const Fields& operator[](Index item) const { return different_[of_.empty() ? 0 : of_[item]]; }
  [[nodiscard]] const std::vector<Fields>& different() const { return different_; }

 private:
  Index size_ = 0;
  Index last_ = 0;
  std::vector<Fields> different_;
  std::vector<Index> of_;  // combination of each item; empty while all items have the first
  std::map<Fields, Index> places_;
};

/// An element that is not a cell.
struct OtherElement {
  std::int64_t number;
  ElementFields fields;
  std::vector<std::int64_t> nodes;  ///< numbers of the nodes
  Remarks remarks = {};             ///< of item 0
};

/// A permanent group.
struct Group {
  std::vector<std::int64_t> fields;  ///< numbers of the first line but for the count of members
  std::string name;                  ///< as in the file
  std::string set;                   ///< name of its sets in the mesh
  bool has_nodes = false;            ///< whether it has a set of vertices; true for empty groups
  bool has_elements = false;         ///< whether it has a set of cells
  std::vector<std::array<std::int64_t, 4>> others;  ///< members of other kinds: code, number, two more
};

/// Values at nodes or elements.
struct Results {
  std::string array;  ///< name in the mesh
  std::string name;   ///< as in the file
  Association association = Association::vertices;
  Index components = 1;
  std::int64_t components_in_file = 1;  ///< complex numbers count once
  int digits = 5;                       ///< digits after the point
  bool integers = false;                ///< whether the values are whole numbers
  Remarks remarks = {};                 ///< by node or element of the file

  /// Returns the greatest number of values on a line.
  [[nodiscard]] std::size_t on_line() const { return integers ? kWholesOnLine : digits > 5 ? 3 : 6; }
  /// Returns the width of a value in columns.
  [[nodiscard]] std::size_t width() const {
    return integers ? kWholeWidth : static_cast<std::size_t>(digits) + 8;
  }
};

enum class DatasetKind : std::uint8_t { text, nodes, elements, groups, results };

/// A dataset, or the lines between two datasets.
struct Dataset {
  DatasetKind part = DatasetKind::text;
  int dataset = 0;
  std::string text = {};  ///< all lines if they are kept as they are, else the lines before the first item
  Index first = 0;        ///< position in the file of its first node, element, group or result
  Index count = 0;
  std::string end = {};                   ///< text after the -1 at its end
  std::vector<OtherElement> others = {};  ///< elements that are not cells
};

/// The contents of a universal file, in its order. Its groups are not in `sets`.
struct Contents : DeckContents {
  std::vector<Dataset> sections;
  FieldTable<NodeFields> node_fields;
  FieldTable<ElementFields> element_fields;
  std::vector<Group> groups;
  std::vector<Results> results;
  Remarks node_remarks;     ///< by node of the file
  Remarks element_remarks;  ///< by element of the file that is a cell
  Remarks group_remarks;    ///< by group; the name's line does not count
  char exponent = 'D';      ///< letter before exponents of coordinates
};

/// A universal file, and where its nodes and elements are in the mesh.
using UnvMetadata = DeckMetadata<Contents>;

/// Name of the array on cells that holds the numbers of materials, if they differ.
inline constexpr std::string_view kMaterial = "material";

/// Returns how many numbers a member has in a dataset of groups, 2 or 4; 0 for other datasets.
int numbers_of_member(int dataset);

// ---- reading

Mesh read(const FilePath& path, Notes& notes);

/// A dataset of results before all nodes and elements are known.
struct FoundResults {
  Results results;  ///< without the array's name
  std::int64_t line = 0;
  std::vector<std::int64_t> numbers = {};  ///< numbers of nodes or elements
  std::vector<double> values = {};         ///< `components` for each number
  std::string text = {};                   ///< the lines before the values
  std::string all = {};                    ///< all lines
};

/// Takes the records before the values; returns nullopt for faulty records, and for values of an unknown
/// place or type.
std::optional<Results> read_results_header(Scanner& in, int dataset);

/// Returns the values as an array; nullopt if there are no values, or if an item is unknown or comes twice.
std::optional<DataArray> array_of(const FoundResults& found, const IdMap& items);

/// Returns the numbers of those coordinate systems of a dataset 2420 that are not the global system.
std::vector<std::int64_t> local_systems(std::string_view text);

/// Parses a real number as Fortran writes it: 1.5D-3, 1.5E-3, 1.5-103. Throws InputError, with the line of
/// `at`, for other words.
double real_of(const Scanner& at, std::string_view word, std::string_view what);

/// Returns whether a whole number leaves a blank in its ten columns. Readers can then split the line at
/// blanks.
inline bool fits_columns(std::int64_t number) {
  constexpr std::int64_t kLargest = 999'999'999;
  return number <= kLargest && number >= -kLargest / 10;
}

}  // namespace meshorder::unv
