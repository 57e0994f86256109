// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/polymorphic.hpp"
#include "cells/cell_arrays.hpp"
#include "graph/clean_graph.hpp"
#include "graph/csr_graph.hpp"
#include "ordering/carried.hpp"
#include "ordering/method.hpp"

#include <optional>
#include <span>
#include <string_view>

namespace meshorder {

/// The vertices of an update of a `Reorderer`, and which of them should be near each other.
class Neighbourhood : public Polymorphic {
 public:
  [[nodiscard]] virtual Index size() const = 0;
  /// Returns `Update::span_log2` of an order.
  ///
  /// @param place_of  the new place of each vertex; empty: the present places
  [[nodiscard]] virtual double span_log2(std::span<const Index> place_of) const = 0;
  /// Returns the largest `span_log2` at which an order is still kept.
  [[nodiscard]] virtual double most_span(double fresh, double slack) const { return fresh * (1 + slack); }
  /// Words for the reason of an update: `too_far` if `span_log2` exceeds `most_span`, else `near_enough`.
  [[nodiscard]] virtual std::string_view too_far() const {
    return "neighbours are too far apart: the mean log2 span is";
  }
  [[nodiscard]] virtual std::string_view near_enough() const { return "neighbours are as close"; }
  /// Returns the neighbours of the given vertices, which must ascend.
  [[nodiscard]] virtual NeighbourRows rows_of(std::span<const Index> vertices) const = 0;
  /// Orders the vertices by that method.
  [[nodiscard]] virtual Order order_by(std::string_view method, const OrderOptions& options) = 0;
  /// Returns whether a sweep over the vertices in their present numbering reads memory forward; a new order
  /// would then gain nothing (see `jump_share`). False if only points are known.
  [[nodiscard]] virtual bool is_read_forward() { return false; }
};

/// The vertices of a graph, which must outlive this object.
class GraphNeighbourhood : public Neighbourhood {
 public:
  GraphNeighbourhood(const GraphArrays& graph, const PointsView& points) : graph_(graph), points_(points) {}

  [[nodiscard]] Index size() const override { return graph_.size(); }
  [[nodiscard]] double span_log2(std::span<const Index> place_of) const override;
  [[nodiscard]] NeighbourRows rows_of(std::span<const Index> vertices) const override;
  [[nodiscard]] Order order_by(std::string_view method, const OrderOptions& options) override;
  [[nodiscard]] bool is_read_forward() override;

 private:
  const GraphArrays& graph_;
  const PointsView& points_;
};

/// The vertices of a mesh, which must outlive this object. Builds the graph at the first call of `order_by`
/// or `is_read_forward`.
class CellNeighbourhood : public Neighbourhood {
 public:
  /// @param by_curve  the method is a curve, which needs no graph; `rows_of` then returns empty rows
  CellNeighbourhood(const CellArrays& cells, const PointsView& points, bool by_curve)
      : cells_(cells), points_(points), by_curve_(by_curve) {}

  [[nodiscard]] Index size() const override { return cells_.vertex_count; }
  [[nodiscard]] double span_log2(std::span<const Index> place_of) const override;
  [[nodiscard]] NeighbourRows rows_of(std::span<const Index> vertices) const override;
  [[nodiscard]] Order order_by(std::string_view method, const OrderOptions& options) override;
  [[nodiscard]] bool is_read_forward() override;

 private:
  const CsrGraph& graph();
  [[nodiscard]] Shape shape_of(Index cell) const;

  const CellArrays& cells_;
  const PointsView& points_;
  bool by_curve_;
  std::optional<CsrGraph> graph_;
};

/// Points without a graph; the ideal place of a point is its place on a curve.
class PointNeighbourhood : public Neighbourhood {
 public:
  explicit PointNeighbourhood(const PointsView& points) : points_(points) {}

  [[nodiscard]] Index size() const override { return static_cast<Index>(points_.size()); }
  [[nodiscard]] double span_log2(std::span<const Index> place_of) const override;
  /// Returns `fresh` + `slack` · log₂(1 + n), since `fresh` is 0 for the order along the curve itself.
  [[nodiscard]] double most_span(double fresh, double slack) const override;
  [[nodiscard]] std::string_view too_far() const override {
    return "points are too far from their places on the curve: the mean log2 distance is";
  }
  [[nodiscard]] std::string_view near_enough() const override {
    return "points are as close to their places on the curve";
  }
  [[nodiscard]] NeighbourRows rows_of(std::span<const Index> vertices) const override;
  [[nodiscard]] Order order_by(std::string_view method, const OrderOptions& options) override;

 private:
  const PointsView& points_;
};

}  // namespace meshorder
