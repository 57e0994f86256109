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

/// A moved mesh as a .vtu file holds it: what `scattered_grid` makes of the whole mesh once that is in its
/// new order. Labels and ids are as wide as those of any rank need, sets are marked in the order of all their
/// members.
class MovedGrid {
 public:
  /// Every rank has to call it. O(size of the part).
  ///
  /// @param communicator  outlives this object
  /// @param moved  outlives this object; its cells, which VTK holds, are taken by `rows`
  MovedGrid(const Communicator& communicator, MovedPart& moved);

  /// Returns the mesh, this object's as long as it lives; to be called once. Every rank has to call it.
  /// O(size of the cells).
  ///
  /// @param notes  at the root: what VTK's files hold in another way
  [[nodiscard]] GridRows rows(Notes& notes);

 private:
  /// An array of the .vtu file.
  struct Array {
    enum class Source : std::uint8_t { data, set, ids };
    Source source;
    std::size_t number;  ///< among the mesh's arrays or sets
    Association association;
    std::size_t type;  ///< number type, as the alternatives of Values
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
  std::vector<std::vector<std::int32_t>> set_ranks_;  ///< of the members of each set; none: 1 for each
  std::vector<Array> arrays_;
  std::vector<std::uint8_t> types_;  ///< VTK's
};

}  // namespace meshorder::distributed
