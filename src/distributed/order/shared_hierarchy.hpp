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

/// A rank's rows of the Laplacian of a graph, and their aggregation to the next coarser level.
struct SharedLevel {
  Layout layout;                    ///< the owners of the rows
  Halo halo;                        ///< halo of the neighbours on other ranks
  Laplacian laplacian;              ///< rows of this rank; columns: these rows, then the halo's numbers
  std::vector<double> masses = {};  ///< masses of this rank's rows, as in `Level`
  Aggregation aggregation = {};     ///< aggregates of this rank's rows

  [[nodiscard]] std::size_t rows() const { return static_cast<std::size_t>(laplacian.size()); }
};

/// A `Hierarchy` of one connected, distributed graph. Each rank aggregates its own rows until few coarse
/// vertices are left on all ranks together. The root then gets these vertices and builds the coarser levels
/// alone. Every rank has to call all functions.
///
/// The cycle is the serial one, except that Gauss–Seidel uses the values that other ranks had before the
/// sweep. Such a sweep still lowers the energy of the error, since 2 D − L is positive semi-definite for any
/// graph.
class SharedHierarchy {
 public:
  /// @param few  coarse vertices go to the root when all ranks together have at most this many, or when a
  ///             coarsening step is not worthwhile (`kWorthwhile`)
  /// @throws SharedError if a rank lacks memory
  SharedHierarchy(const Communicator& communicator, SharedLevel finest, GlobalIndex few);

  [[nodiscard]] const std::vector<SharedLevel>& levels() const noexcept { return levels_; }
  [[nodiscard]] const Communicator& communicator() const noexcept { return communicator_; }

  /// As `Hierarchy::cycle`, for this rank's rows.
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
  Layout gathered_;                  ///< the owners of the vertices of the finest level in `bottom_`
  std::optional<Hierarchy> bottom_;  ///< the levels that only the root has
};

/// Truncates x to this rank's rows and appends the values of the level's halo. Every rank has to call it.
template <class Row>
void fetch_others(const SharedLevel& level, std::vector<Row>& x) {
  x.resize(level.rows());
  const std::vector<Row> others = level.halo.fetch(x);
  x.insert(x.end(), others.begin(), others.end());
}

}  // namespace meshorder::distributed
