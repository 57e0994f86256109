// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "results.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <utility>

namespace meshorder::python {

nb::list described(const std::vector<FiedlerComponent>& components) {
  nb::list list;
  for (const FiedlerComponent& component : components) {
    list.append(nb::make_tuple(component.size, component.lambda2, component.residual, component.iterations,
                               component.converged));
  }
  return list;
}

nb::dict described(Order order) {
  nb::dict result;
  result["permutation"] = nb::cast(std::move(order.permutation));
  result["method"] = order.method.name;
  result["reason"] = order.method.reason;
  result["fiedler"] = described(order.fiedler);
  result["vector"] = order.vector.empty() ? nb::object(nb::none()) : nb::cast(given(std::move(order.vector)));
  result["complete"] = order.complete;
  result["seconds"] = order.seconds;
  result["notes"] = order.notes;
  return result;
}

nb::dict described(const Quality& quality) {
  nb::dict result;
  result["edges"] = quality.edges;
  result["mean_span"] = quality.mean_span;
  result["mean_log2_span"] = quality.mean_log2_span;
  result["bandwidth"] = quality.bandwidth;
  result["profile"] = quality.profile;
  result["histogram_log2"] = quality.histogram_log2;
  result["jump_share"] = quality.jump_share;
  return result;
}

nb::object described(SparsityPattern pattern) {
  const auto side = static_cast<std::size_t>(pattern.side);
  return nb::cast(given(std::move(pattern.counts))).attr("reshape")(side, side);
}

}  // namespace meshorder::python
