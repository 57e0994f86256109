// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/files/grid_rows.hpp"
#include "distributed/files/moved_part.hpp"
#include <meshorder/io.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// A moved mesh in the form of a .vtu file: equal to what `scattered_grid` makes from the whole mesh in its
/// new order. The types of labels and ids fit the values of all ranks; the marks of a set follow the order of
/// all its members.
class MovedGrid {
 public:
  /// Every rank has to call it. O(size of the part).
  ///
  /// @param communicator  must outlive this object
  /// @param moved  must outlive this object, and have only cells that VTK can hold; `rows` moves its cells
  ///               out of it
  MovedGrid(const Communicator& communicator, MovedPart& moved);

  /// Returns the mesh, valid as long as this object. Call it only once. Every rank has to call it.
  /// O(size of the cells).
  ///
  /// @param notes  receives, at the root, notes on data that VTK's files store in another form
  [[nodiscard]] GridRows rows(Notes& notes);

 private:
  /// An array of the .vtu file.
  struct Array {
    enum class Source : std::uint8_t { data, set, ids };
    Source source;
    std::size_t number;  ///< place among the mesh's arrays or sets
    Association association;
    std::size_t type;  ///< number type: index of an alternative of Values
    Index components;
  };

  [[nodiscard]] std::vector<std::int32_t> ranks_in_set(std::size_t set) const;
  void list_arrays();
  /// Returns the rows of the k-th array of the file that are in this rank's places.
  [[nodiscard]] std::vector<std::byte> rows_of_array(std::size_t k) const;
  [[nodiscard]] std::vector<std::byte> marks_of_set(const Array& array) const;
  [[nodiscard]] std::string xml(Notes& notes) const;

  const Communicator& communicator_;
  MovedPart& moved_;
  std::vector<std::vector<std::int32_t>> set_ranks_;  ///< place of each member in its set; empty: mark with 1
  std::vector<Array> arrays_;
  std::vector<std::uint8_t> types_;  ///< VTK cell types
};

}  // namespace meshorder::distributed
