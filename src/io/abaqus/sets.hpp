// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/abaqus/cards.hpp"
#include "io/deck/metadata.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_set>
#include <vector>

namespace meshorder::abaqus {

/// Returns "node set" or "element set".
std::string_view name_of_sets(Association association);

/// Returns a note such as "*BOUNDARY names one number that the deck does not have, the first is 7". `which`
/// is the beginning of the note, up to "names".
std::string note_of_missing(std::string_view which, const std::vector<std::int64_t>& numbers);

/// Reads the node and element sets of a deck: collects the additions of all cards, then finds the members.
class SetReader {
 public:
  /// All arguments must outlive this object; they may change until the call of `members`.
  ///
  /// @param others  numbers of elements that are not cells; sets may name these elements but do not contain
  ///                them
  SetReader(const DeckContents& deck, const Cells& cells, const std::unordered_set<std::int64_t>& others)
      : deck_(deck), cells_(cells), others_(others) {}

  /// Sets whether the next cards belong to the assembly. A set of the assembly may have the name of a part's
  /// set.
  void enter_assembly(bool inside) { in_assembly_ = inside; }

  /// Adds `count` nodes or elements of the file, from position `first` on, to the set of that name.
  void add_block(Association association, std::string_view name, Index first, Index count);
  /// Begins a card *NSET or *ELSET, whose lines follow.
  void begin_card(Association association, const Card& card, Location place);
  /// Adds a data line of the last card; returns the fault of the line, an empty text if it has none.
  std::string add_line(std::string_view line);

  /// Returns whether cards so far define or extend a set of that name, in the part or in the assembly.
  [[nodiscard]] bool knows(Association association, std::string_view name) const;

  /// Returns the sets with their members. Notes names and numbers that do not exist.
  std::vector<EntitySet> members(Notes& notes);

 private:
  /// The addition of one card to a set.
  struct Addition {
    std::size_t set = 0;
    Association association = Association::vertices;
    bool in_assembly = false;  ///< whether names and numbers are the assembly's, not the part's
    Location place = {};
    bool generate = false;
    Index first = 0;  ///< position of the block that `add_block` adds
    Index count = 0;
    std::vector<Index> numbers = {};
    std::vector<std::array<std::int64_t, 3>> ranges = {};  ///< from, to, step
    std::vector<std::string> names = {};
    std::string nodes_of = {};  ///< name of an element set whose nodes are added
  };
  class Repeats;
  using Key = std::tuple<Association, bool, std::string>;  ///< bool: whether the set belongs to the assembly

  std::size_t set_named(Association association, std::string_view name);
  [[nodiscard]] const EntitySet* find(Association association, bool in_assembly, std::string_view name) const;
  void add_members(const Addition& addition, Repeats& repeats, Notes& notes);

  const DeckContents& deck_;
  const Cells& cells_;
  const std::unordered_set<std::int64_t>& others_;
  bool in_assembly_ = false;
  std::vector<EntitySet> sets_;
  std::map<Key, std::size_t> places_;
  std::vector<Addition> additions_;
};

}  // namespace meshorder::abaqus
