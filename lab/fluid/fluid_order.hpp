// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/fluid/alpha_shape.hpp"
#include <meshorder/changing.hpp>
#include <meshorder/order.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// How particles and tetrahedra of a fluid are ordered.
struct FluidOrdering {
  /// Method for the particles: "original" keeps their first order, "scrambled" mixes them at the start.
  std::string vertices = "auto";
  std::string elements = "auto";  ///< method for the tetrahedra, in each step; "original": as triangulated
  /// Steps from one order of the particles to the next; 0: a `Reorderer` decides.
  Index every = 0;
  OrderOptions options = {};

  /// Returns whether the order of the particles never changes after the start.
  [[nodiscard]] bool stays() const { return vertices == "original" || vertices == "scrambled"; }
};

/// Orders the particles and tetrahedra of a fluid during a simulation.
class FluidOrder {
 public:
  /// Throws InvalidArgument for unknown methods.
  explicit FluidOrder(FluidOrdering ordering);

  /// Returns the permutation to apply to the particles before step `step`, counted from 0; nothing if they
  /// keep their order.
  std::optional<Permutation> particles(Index step, const FluidMesh& mesh, std::span<const Point> points);

  void sort(FluidMesh& mesh, std::span<const Point> points) const;

  [[nodiscard]] const FluidOrdering& ordering() const noexcept { return ordering_; }
  /// Returns how often all particles were ordered anew.
  [[nodiscard]] Index fresh_orders() const noexcept { return fresh_; }

  [[nodiscard]] std::vector<std::byte> state() const { return reorderer_.state(); }
  void restore(std::span<const std::byte> state) { reorderer_.restore(state); }

 private:
  FluidOrdering ordering_;
  Reorderer reorderer_;
  Index fresh_ = 0;
};

}  // namespace meshorder
