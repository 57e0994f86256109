// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Orders of meshes and particles that change: kept fresh, update by update. Experimental: may change in any
/// version below 1.0.

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

/// How an update came by its order, the cheapest first.
enum class Repair : std::uint8_t {
  none,     ///< nothing moves
  carried,  ///< vertices that stayed keep their order, new ones come next to their neighbours
  warm,     ///< computed anew from the last Fiedler vector, to 30 times the tolerance
  fresh,    ///< computed anew
};

/// Returns "none", "carried", "warm" or "fresh". Valid for the life of the program.
MESHORDER_API std::string_view to_string(Repair repair);

/// Options of a `Reorderer`.
struct ReordererOptions {
  /// Name of a vertex method. `auto` takes what it would for the first mesh, of points alone `hilbert`, and
  /// moves nothing where the numbering is as good as that.
  std::string method = "auto";
  /// The share, ≥ 0, by which `Update::span_log2` may exceed that of the last fresh order before there is a
  /// new one.
  double slack = 0.02;
  /// Seconds, ≥ 0: no order is computed anew that took longer the last time.
  double budget_seconds = std::numeric_limits<double>::infinity();
  OrderOptions order = {};  ///< of the orders; `groups`, `cell_groups` and `start` must be empty
};

/// What `Reorderer::update` found.
struct Update {
  Permutation permutation;  ///< from the places that the arrays have now; moves nothing under `Repair::none`
  Repair repair = Repair::none;
  std::string reason = {};  ///< why there is a new order, or none; a sentence
  /// How near neighbours are in the order: the mean of ⌊log₂ |i − j|⌋ over the edges of every 16th vertex. Of
  /// points alone the mean of log₂ (1 + places that a point is away from its place on the curve) over a
  /// sample. Compare it with that of the same method only.
  double span_log2 = 0;
  double fresh_span_log2 = 0;  ///< the same of the last order that was computed anew
  Index added = 0;             ///< vertices that are new
  Index removed = 0;           ///< vertices that are gone
  double seconds = 0;          ///< wall-clock time of the call
  bool complete = true;  ///< false: `budget_seconds` or the time limit kept a better order from being found
  std::vector<std::string> notes = {};  ///< as of `Order`
};

/// Keeps the order of a mesh, graph or set of particles fresh while it changes.
///
/// Call `update` whenever connectivity or positions have changed, and move all arrays as its permutation
/// says: the arrays then have the last order, so this object does not store it. Most updates cost a pass over
/// a sample, and nothing moves. A new order comes when neighbours are too far apart, and now and then to see
/// whether it would be better: at first after 10 updates, and twice as rarely whenever that was in vain.
///
/// Elements: `order_elements` with `max` after every change of connectivity pays at once.
///
/// @note One update at a time. Without `budget_seconds`, `Run::time_limit` and `observe`, equal calls give
/// equal orders, on
///       any number of threads. Memory: a few numbers; of Fiedler orders 8 n bytes.
class MESHORDER_API Reorderer {
 public:
  /// @throws InvalidArgument for an unknown method, a negative or NaN slack or budget, and for groups or a
  /// start
  explicit Reorderer(ReordererOptions options = {});
  ~Reorderer();
  Reorderer(Reorderer&&) noexcept;
  Reorderer& operator=(Reorderer&&) noexcept;
  Reorderer(const Reorderer&) = delete;
  Reorderer& operator=(const Reorderer&) = delete;

  /// Brings the order of a graph up to date.
  ///
  /// @param graph     n vertices, in the places that the arrays have now
  /// @param points    n points, or none: geometric methods need them
  /// @param previous  for each vertex its place after the last update, −1 for a new one, each at most once;
  /// none: the
  ///                  same vertices in the same places. In the first update none, or −1 for all
  /// @throws as `order_vertices`, and InvalidArgument for a `previous` that does not fit; the object is
  /// unchanged then
  /// @note With `Check::none` and nothing to do: the edges of n / 16 vertices. Carried: O(n + edges of new
  /// vertices). Computed
  ///       anew: what the method costs.
  Update update(const GraphView& graph, const PointsView& points = {}, const IndexView& previous = {});

  /// The same of a mesh. Builds its graph only to compute an order anew.
  Update update(const MeshView& mesh, const IndexView& previous = {});

  /// The same of points alone, such as particles, by `hilbert` or `morton`.
  ///
  /// @throws InvalidArgument for other methods, besides
  Update update(const PointsView& points, const IndexView& previous = {});

  /// Reports how long the step took that followed the last update. From the fifth report on a new order comes
  /// when the time that slower steps lose exceeds its cost: √(2 cost / slope) steps after the last one.
  /// Optional.
  ///
  /// @param step_seconds  ≥ 0 and finite
  /// @throws InvalidArgument otherwise
  void observe(double step_seconds);

  /// Returns the state, for a checkpoint: `restore` continues from it.
  [[nodiscard]] std::vector<std::byte> state() const;

  /// Continues from a state of the same method. The other options are not part of it.
  ///
  /// @throws InvalidArgument for bytes that are no whole state, or one of another method; the object is
  /// unchanged then
  void restore(std::span<const std::byte> state);

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace v0_3
}  // namespace meshorder
