// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "ordering/carried.hpp"
#include "ordering/method.hpp"
#include "ordering/moved.hpp"
#include "ordering/neighbourhood.hpp"
#include "ordering/point_checks.hpp"
#include "ordering/reorderer_state.hpp"
#include <meshorder/changing.hpp>
#include <meshorder/error.hpp>
#include <meshorder/registry.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace meshorder {
inline namespace v0_3 {
namespace {

/// The tolerance of a warm order as a multiple of the tolerance of a fresh order. At this tolerance, the best
/// combination of the last vector and the vectors of coarser graphs brings neighbours as near as a fresh
/// order does, without an iteration on the whole graph.
constexpr double kWarmTolerance = 30;

/// Returns the start vector in the numbering of this update; 0 for new vertices.
std::vector<double> carried_vector(const std::vector<double>& vector, const VertexChanges& changes) {
  if (vector.empty() || changes.places.empty()) return vector;
  std::vector<double> result(changes.places.size());
  for (std::size_t v = 0; v < result.size(); ++v) {
    if (changes.places[v] >= 0) result[v] = vector[static_cast<std::size_t>(changes.places[v])];
  }
  return result;
}

std::string in_words(double span) {
  std::string text = std::to_string(span);
  return text.substr(0, text.find('.') + 3);
}

}  // namespace

std::string_view to_string(Repair repair) {
  switch (repair) {
    case Repair::none:
      return "none";
    case Repair::carried:
      return "carried";
    case Repair::warm:
      return "warm";
    case Repair::fresh:
      return "fresh";
  }
  return "";
}

class Reorderer::Inside {
 public:
  explicit Inside(ReordererOptions options) : options_(std::move(options)) {
    if (options_.method != "auto" && !method_named(vertex_methods(), options_.method)) {
      // ordering an empty graph throws for an unknown name, and lists the known ones
      (void)order_graph(options_.method, {CsrGraph()}, options_.order);
    }
    if (!(options_.slack >= 0))
      throw InvalidArgument("slack: " + std::to_string(options_.slack) + ", must be ≥ 0");
    if (!(options_.budget_seconds >= 0))
      throw InvalidArgument("budget_seconds: " + std::to_string(options_.budget_seconds) + ", must be ≥ 0");
    if (!options_.order.groups.empty() || !options_.order.cell_groups.empty() ||
        !options_.order.start.empty())
      throw InvalidArgument("order: groups, cell_groups and start change with the mesh, and must be empty");
  }

  [[nodiscard]] const OrderOptions& order() const { return options_.order; }
  [[nodiscard]] const std::string& method() const { return options_.method; }
  [[nodiscard]] bool by_curve() const { return options_.method == "hilbert" || options_.method == "morton"; }
  /// Returns whether the budget allows another order without a start vector.
  [[nodiscard]] bool may_order() const { return memory_.fresh_seconds <= options_.budget_seconds; }

  /// @param renews_for_new  whether new vertices are enough for a new order
  Update update(Neighbourhood& hood, const IndexView& previous, bool renews_for_new = false) {
    const Stopwatch stopwatch;
    ReordererState next = memory_;
    const VertexChanges changes = changes_of(previous, hood.size(), memory_.count);
    Update update;
    update.added = static_cast<Index>(memory_.count == 0 ? hood.size() : std::ssize(changes.added));
    update.removed = changes.removed;
    const bool is_first = memory_.begun == 0 || update.added == hood.size();
    const bool all_stay = is_first || changes.places.empty();
    Permutation carried = all_stay ? Permutation::identity(hood.size()) : carry(hood, changes);
    const double carried_span = hood.span_log2(all_stay ? std::span<const Index>() : places_of(carried));
    next.vector = carried_vector(memory_.vector, changes);
    next.begun = 1;
    next.count = hood.size();
    next.since = std::min(next.since + 1, kMaxIndex - 1);
    update.reason = is_first                             ? "this is the first order"
                    : renews_for_new && update.added > 0 ? "vertices are new"
                                                         : reason_to_renew(hood, next, carried_span);
    if (update.reason.empty()) {
      keep(update, std::move(carried), carried_span);
      update.reason = std::string(hood.near_enough()) + " as in the last fresh order";
    } else {
      renew(update, hood, next, is_first, std::move(carried), carried_span);
    }
    update.fresh_span_log2 = next.fresh_span;
    if (!next.vector.empty() && update.repair != Repair::none)
      next.vector = moved(update.permutation, next.vector);
    update.seconds = stopwatch.seconds();
    memory_ = std::move(next);
    return update;
  }

  void observe(double seconds) {
    if (!(seconds >= 0) || std::isinf(seconds))
      throw InvalidArgument("observe: a step of " + std::to_string(seconds) + " s");
    memory_.observed.add(static_cast<double>(memory_.since), seconds);
  }

  [[nodiscard]] std::vector<std::byte> state() const {
    ReordererState memory = memory_;
    memory.method = options_.method + "\n" + memory_.method;
    return to_bytes(memory);
  }

  void restore(std::span<const std::byte> state) {
    ReordererState memory = reorderer_state(state);
    const auto end = memory.method.find('\n');
    if (end == std::string::npos) throw InvalidArgument("state: it is cut off or damaged");
    if (memory.method.substr(0, end) != options_.method) {
      throw InvalidArgument("state: it is of the method '" + memory.method.substr(0, end) + "', not '" +
                            options_.method + "'");
    }
    memory.method.erase(0, end + 1);
    memory_ = std::move(memory);
  }

 private:
  static std::span<const Index> places_of(const Permutation& order) { return order.old_to_new(); }

  static Permutation carry(const Neighbourhood& hood, const VertexChanges& changes) {
    const NeighbourRows rows = changes.added.empty() ? NeighbourRows{} : hood.rows_of(changes.added);
    const Index count = changes.removed + hood.size() - static_cast<Index>(changes.added.size());
    return Permutation::from_new_to_old(carried_order(changes.places, count, changes.added, rows));
  }

  static void keep(Update& update, Permutation carried, double span) {
    update.repair = carried.is_identity() ? Repair::none : Repair::carried;
    update.permutation = std::move(carried);
    update.span_log2 = span;
  }

  /// Keeps the order after an attempt that found no better one.
  static void pass(Update& update, ReordererState& next, bool is_first, Permutation carried, double span) {
    if (!is_first) next.interval = std::min(2 * next.interval, kMostInterval);
    next.since = 0;
    next.observed = {};
    next.fresh_span = span;
    keep(update, std::move(carried), span);
  }

  /// Returns the number of updates between new orders. If the slowdown per update and the cost of an order
  /// are known: the number after which the time lost equals that cost.
  [[nodiscard]] static Index interval(const ReordererState& memory) {
    const double slope = memory.observed.slope();
    const double cost = memory.warm_seconds > 0 ? memory.warm_seconds : memory.fresh_seconds;
    if (slope <= 0 || cost <= 0) return memory.interval;
    return static_cast<Index>(std::clamp(std::sqrt(2 * cost / slope), 1.0, double{kMostInterval}));
  }

  [[nodiscard]] std::string reason_to_renew(const Neighbourhood& hood, const ReordererState& memory,
                                            double span) const {
    if (span > hood.most_span(memory.fresh_span, options_.slack)) {
      return std::string(hood.too_far()) + " " + in_words(span) + ", but was " + in_words(memory.fresh_span) +
             " in the last fresh order";
    }
    if (memory.since < interval(memory)) return "";
    return std::to_string(memory.since) + " updates have passed since the last fresh order";
  }

  void renew(Update& update, Neighbourhood& hood, ReordererState& next, bool is_first, Permutation carried,
             double carried_span) {
    const bool is_warm = !next.vector.empty() && !is_first;
    double& last_seconds = is_warm ? next.warm_seconds : next.fresh_seconds;
    if (!is_first && last_seconds > options_.budget_seconds) {
      update.reason += "; the last new order took " + in_words(last_seconds) + " s, more than the budget";
      update.complete = false;
      return keep(update, std::move(carried), carried_span);
    }
    const bool by_auto = options_.method == "auto" && (is_first || next.method == "auto");
    if (by_auto && carried.is_identity() && hood.is_read_forward()) {
      next.method = "auto";
      update.reason += "; the present numbering already reads memory forward";
      return pass(update, next, is_first, std::move(carried), carried_span);
    }
    const Stopwatch stopwatch;
    if (next.method.empty()) next.method = options_.method;
    OrderOptions options = options_.order;
    if (is_warm) {
      options.start = next.vector;
      options.tolerance *= kWarmTolerance;
    }
    // `auto` judges the first order as in any call; if `auto` then keeps the numbering, it judges later
    // orders, too
    const std::string asked = is_first ? options_.method : next.method;
    Order order = hood.order_by(asked, options);
    last_seconds = stopwatch.seconds();
    if (asked == "auto") next.method = order.method.name == "original" ? "auto" : order.method.name;
    const double span = hood.span_log2(places_of(order.permutation));
    const bool is_better =
        asked == "auto" ? order.method.name != "original" : is_first || span < carried_span;
    update.notes = std::move(order.notes);
    update.complete = order.complete;
    if (!is_better) {
      update.reason +=
          order.method.reason.empty() ? "; a new one would be no better" : "; " + order.method.reason;
      return pass(update, next, is_first, std::move(carried), carried_span);
    }
    if (!is_first) {
      const double gain = span > 0 ? (carried_span - span) / span : 0;
      if (gain < options_.slack / 2) next.interval = std::min(2 * next.interval, kMostInterval);
      if (gain > options_.slack) next.interval = std::max(next.interval / 2, Index{1});
    }
    next.since = 0;
    next.observed = {};
    next.vector = std::move(order.vector);
    next.fresh_span = span;
    update.permutation = std::move(order.permutation);
    update.repair = update.permutation.is_identity() ? Repair::none : is_warm ? Repair::warm : Repair::fresh;
    update.span_log2 = span;
    if (is_first && !order.method.reason.empty())
      update.reason += ", " + order.method.name + ": " + order.method.reason;
  }

  ReordererOptions options_;
  ReordererState memory_;
};

Reorderer::Reorderer(ReordererOptions options) : inside_(std::make_unique<Inside>(std::move(options))) {}
Reorderer::~Reorderer() = default;
Reorderer::Reorderer(Reorderer&&) noexcept = default;
Reorderer& Reorderer::operator=(Reorderer&&) noexcept = default;

Update Reorderer::update(const GraphView& graph, const PointsView& points, const IndexView& previous) {
  const OrderOptions& options = inside_->order();
  return in_call(options.run, [&] {
    const GraphArrays arrays = clean_graph(graph, options.check, options.symmetry);
    check_finite(points, static_cast<std::size_t>(arrays.size()), options.check);
    GraphNeighbourhood hood(arrays, points);
    return inside_->update(hood, previous);
  });
}

Update Reorderer::update(const MeshView& mesh, const IndexView& previous) {
  const OrderOptions& options = inside_->order();
  return in_call(options.run, [&] {
    const std::size_t n = vertex_count_of(mesh);
    const CellArrays cells = cell_arrays(mesh.cells, n, options.check);
    check_finite(mesh.points, n, options.check);
    // a sort along a curve costs less than to find the neighbours of new vertices in all cells
    const bool by_curve = inside_->by_curve() && inside_->may_order();
    CellNeighbourhood hood(cells, mesh.points, by_curve);
    return inside_->update(hood, previous, by_curve);
  });
}

Update Reorderer::update(const PointsView& points, const IndexView& previous) {
  const OrderOptions& options = inside_->order();
  return in_call(options.run, [&] {
    const std::string& method = inside_->method();
    if (method != "auto" && !inside_->by_curve())
      throw InvalidArgument("method: '" + method +
                            "' needs a graph or cells; of points alone there are hilbert and morton");
    check_finite(points, points.size(), options.check);
    PointNeighbourhood hood(points);
    return inside_->update(hood, previous);
  });
}

void Reorderer::observe(double step_seconds) { inside_->observe(step_seconds); }
std::vector<std::byte> Reorderer::state() const { return inside_->state(); }
void Reorderer::restore(std::span<const std::byte> state) { inside_->restore(state); }

}  // namespace v0_3
}  // namespace meshorder
