// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/balance.hpp"

#include "distributed/comm/number_set.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>

namespace meshorder::distributed {
namespace {

/// A contribution to a vertex's weight, for the vertex's owner.
struct Share {
  GlobalIndex vertex;
  GlobalIndex weight;
};

Parcels<Share> shares_by_owner(const Layout& layout, const Rows& elements) {
  const NumberSet vertices(elements.entries);
  std::vector<GlobalIndex> weights(vertices.numbers().size(), 0);
  for (Offset e = 0; e < elements.size(); ++e) {
    const auto element = elements[e];
    for (const GlobalIndex vertex : element)
      weights[vertices.position(vertex)] += std::max<GlobalIndex>(kElementWeight / std::ssize(element), 1);
  }
  return parcels_by_rank(
      weights.size(), layout.ranks(), [&](std::size_t k) { return layout.owner(vertices.numbers()[k]); },
      [&](std::size_t k) {
        return Share{vertices.numbers()[k], weights[k]};
      });
}

}  // namespace

std::vector<GlobalIndex> shares_in_elements(const Communicator& communicator, const Layout& layout,
                                            const Rows& elements) {
  const Parcels<Share> received =
      communicator.exchange(communicator.together([&] { return shares_by_owner(layout, elements); }));
  return communicator.together([&] {
    std::vector<GlobalIndex> shares(static_cast<std::size_t>(layout.size(communicator.rank())), 0);
    for (const Share& share : received.values)
      shares[static_cast<std::size_t>(share.vertex - layout.begin(communicator.rank()))] += share.weight;
    return shares;
  });
}

double imbalance_of(const Communicator& communicator, const std::vector<Index>& part_of,
                    const std::vector<GlobalIndex>& weights, Index parts) {
  std::vector<GlobalIndex> sums = communicator.together([&] {
    std::vector<GlobalIndex> own(static_cast<std::size_t>(parts), 0);
    for (std::size_t v = 0; v < part_of.size(); ++v)
      own[static_cast<std::size_t>(part_of[v])] += weights.empty() ? 1 : weights[v];
    return own;
  });
  sums = communicator.sums(std::move(sums));
  const auto mean = static_cast<double>(std::accumulate(sums.begin(), sums.end(), GlobalIndex{0})) / parts;
  return mean > 0 ? static_cast<double>(*std::max_element(sums.begin(), sums.end())) / mean : 1;
}

}  // namespace meshorder::distributed
