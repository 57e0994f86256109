// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Keeps the orders of changing meshes and particles up to date. Experimental: may change in any version
/// below 1.0.

#include <meshorder/export.hpp>
#include <meshorder/number_view.hpp>
#include <meshorder/options.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/view.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// How an update found its order, the cheapest first.
enum class Repair : std::uint8_t {
  none,     ///< nothing moves
  carried,  ///< vertices that stayed keep their order, new ones come next to their neighbours or last
  warm,     ///< computed again from the last Fiedler vector, to 30 times the tolerance
  fresh,    ///< computed again from the start
};

/// Returns "none", "carried", "warm" or "fresh". Valid for the life of the program.
MESHORDER_API std::string_view to_string(Repair repair);

/// Options of a `Reorderer`.
struct ReordererOptions {
  /// Name of a vertex method. `auto` chooses one for the first mesh, as `order_vertices` does (`hilbert` for
  /// points alone), and moves nothing if the present numbering is as good.
  std::string method = "auto";
  /// Share, ≥ 0, by which `Update::span_log2` may exceed `Update::fresh_span_log2` before a new order is
  /// computed. For points alone, the limit is `fresh_span_log2` + `slack` · log₂ (n + 1).
  double slack = 0.02;
  /// Seconds, ≥ 0: no new order is computed if the last computation took longer.
  double budget_seconds = std::numeric_limits<double>::infinity();
  OrderOptions order = {};  ///< options of every order; `groups`, `cell_groups` and `start` must be empty
};

/// Result of `Reorderer::update`.
struct Update {
  Permutation permutation;  ///< moves rows from their present places; identity under `Repair::none`
  Repair repair = Repair::none;
  std::string reason = {};  ///< a sentence: why a new order was computed or not
  /// Distance of neighbours in the order: the mean of ⌊log₂ |i − j|⌋ over the edges of one in 16 vertices of
  /// a graph, or one in 16 cells of a mesh. For points alone, the mean of log₂ (1 + distance of a point from
  /// its place on the curve) over a sample. Compare only values of the same method.
  double span_log2 = 0;
  double fresh_span_log2 = 0;  ///< `span_log2` right after the last search for a new order
  Index added = 0;             ///< vertices that are new
  Index removed = 0;           ///< vertices that are gone
  double seconds = 0;          ///< wall-clock time of the call
  bool complete = true;        ///< false: the budget prevented or the time limit ended a search for an order
  std::vector<std::string> notes = {};  ///< as in `Order`
};

/// Keeps the order of a changing mesh, graph or set of particles up to date.
///
/// Call `update` whenever connectivity or positions have changed, and move all arrays by its permutation. The
/// arrays then have the last order, so this object does not store the order. Most updates only read a sample
/// of the rows, and move nothing. A new order is computed when neighbours are too far apart, and as a test
/// after some updates: 10 at first, twice as many after each test that finds no better order.
///
/// To order the elements, call `order_elements` with the method `max` after every change of connectivity:
/// this saves time from the first step on.
///
/// @note One update at a time. Without `budget_seconds`, `Run::time_limit` and `observe`, equal calls give
///       equal orders on any number of threads. Memory: a few numbers; for Fiedler orders 8 n bytes
///       more.
class MESHORDER_API Reorderer {
 public:
  /// @throws InvalidArgument for an unknown method, a negative or NaN slack or budget, and if the options
  ///         have groups or a start
  explicit Reorderer(ReordererOptions options = {});
  ~Reorderer();
  Reorderer(Reorderer&&) noexcept;
  Reorderer& operator=(Reorderer&&) noexcept;
  Reorderer(const Reorderer&) = delete;
  Reorderer& operator=(const Reorderer&) = delete;

  /// Brings the order of a graph up to date.
  ///
  /// @param graph     n vertices, in the present order of the arrays
  /// @param points    n points, or none; geometric methods need them
  /// @param previous  place of each vertex after the last update, no place twice; −1 for a new vertex;
  ///                  none: the same vertices in the same places. In the first update: none, or −1
  ///                  for all
  /// @throws as `order_vertices`, and InvalidArgument for a `previous` that does not fit; the object is then
  ///         unchanged
  /// @note Cost with `Check::none`: if nothing has to be done, a pass over the edges of n / 16 vertices; if
  ///       the order is carried, O(n + edges of new vertices); if it is computed anew, the cost of the
  ///       method.
  Update update(const GraphView& graph, const PointsView& points = {}, const IndexView& previous = {});

  /// The same for a mesh. Builds the mesh's graph only to compute an order anew, and not for `hilbert` and
  /// `morton`. With these two, the points are sorted anew whenever vertices are new: O(n + cells).
  Update update(const MeshView& mesh, const IndexView& previous = {});

  /// The same for points alone, such as particles, by `hilbert` or `morton`.
  ///
  /// @throws InvalidArgument also for other methods
  Update update(const PointsView& points, const IndexView& previous = {});

  /// Reports the duration of the step after the last update. From the fifth report on, a new order is
  /// computed once slower steps have lost more time than the order costs: √(2 cost / slope) steps after the
  /// last new order, where `slope` is the growth of the duration from one step to the next. Optional.
  ///
  /// @param step_seconds  the duration, ≥ 0 and finite
  /// @throws InvalidArgument for other durations
  void observe(double step_seconds);

  /// Returns the state, for a checkpoint; `restore` continues from it.
  [[nodiscard]] std::vector<std::byte> state() const;

  /// Continues from a state of the same method. The other options are not part of the state.
  ///
  /// @throws InvalidArgument for bytes that are not a whole state, or for another method; the object is then
  ///         unchanged
  void restore(std::span<const std::byte> state);

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace v0_3
}  // namespace meshorder
