// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/comm/layout.hpp"
#include "graph/laplacian.hpp"
#include "spectral/hierarchy.hpp"
#include "spectral/nested_start.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace meshorder::distributed {

/// The rows that a rank has of the Laplacian of a graph, and the way to the next coarser one.
struct SharedLevel {
  Layout layout;                    ///< of the rows' numbers
  Halo halo;                        ///< of the neighbours on other ranks
  Laplacian laplacian;              ///< own rows; columns are these and after them the halo's numbers
  std::vector<double> masses = {};  ///< as of `Level`, of the own rows
  Aggregation aggregation = {};     ///< of the own rows

  [[nodiscard]] std::size_t rows() const { return static_cast<std::size_t>(laplacian.size()); }
};

/// A `Hierarchy` of one connected graph that the ranks share. Each rank aggregates its own rows, until all
/// ranks together have few coarse vertices: those go to the root, which coarsens on by itself. Every rank has
/// to call all functions.
///
/// The cycle is the serial one but for Gauss–Seidel, which takes the values of other ranks as they were
/// before the sweep. That lowers the energy of the error for any graph, as 2 D − L of it is no less than 0.
class SharedHierarchy {
 public:
  /// @param few  coarse vertices of all ranks together that go to the root; more do only where coarsening
  ///             leaves most of them
  /// @throws SharedError where a rank has no memory
  SharedHierarchy(const Communicator& communicator, SharedLevel finest, GlobalIndex few);

  [[nodiscard]] const std::vector<SharedLevel>& levels() const noexcept { return levels_; }
  [[nodiscard]] const Communicator& communicator() const noexcept { return communicator_; }

  /// As `Hierarchy::cycle`; x receives the own rows.
  template <int M>
  void cycle(std::size_t level, const VectorBlock<M>& b, VectorBlock<M>& x);

  /// Returns start vectors on the finest graph, as the serial `nested_start`.
  [[nodiscard]] StartBlock nested_start(std::uint64_t seed);

 private:
  [[nodiscard]] bool coarsen(GlobalIndex few);
  void gather(const SharedLevel& coarse);
  template <int M>
  VectorBlock<M> corrected_at_root(const VectorBlock<M>& own);
  template <int M>
  VectorBlock<M> coarse_correction(std::size_t level, VectorBlock<M> b);

  const Communicator& communicator_;
  std::vector<SharedLevel> levels_;
  Layout gathered_;                  ///< of the vertices of the first level that the root has alone
  std::optional<Hierarchy> bottom_;  ///< at the root
};

/// Adds to the own rows of x those of others that they touch. Every rank has to call it.
template <class Row>
void fetch_others(const SharedLevel& level, std::vector<Row>& x) {
  x.resize(level.rows());
  const std::vector<Row> others = level.halo.fetch(x);
  x.insert(x.end(), others.begin(), others.end());
}

}  // namespace meshorder::distributed
