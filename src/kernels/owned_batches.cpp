// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/owned_batches.hpp"

#include "kernels/positions.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <string>

namespace meshorder {
namespace {

/// Returns the first spare vertex of a share. With 32 bytes per vertex, this vertex begins a cache line.
Index first_spare(Index n, Index part) { return n + n % 2 + kBatch * part; }

void append(OwnedBatches& share, Index batch, std::span<const Index> vertices, Index spare) {
  const auto owned = [&](Index v) { return v >= share.begin && v < share.end; };
  share.batches.push_back(batch);
  if (std::all_of(vertices.begin(), vertices.end(), owned)) {
    share.boundary.push_back(-1);
    return;
  }
  share.boundary.push_back(static_cast<Index>(share.targets.size() / vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    // a spare vertex for each lane, so that additions of different lanes need not wait for each other
    const Index spare_of_lane = spare + static_cast<Index>(i % kBatch);
    share.targets.push_back(owned(vertices[i]) ? vertices[i] : spare_of_lane);
  }
}

}  // namespace

std::vector<Index> balanced_ranges(std::span<const Offset> offsets, Index parts) {
  std::vector<Index> bounds{0};
  for (Index part = 1; part < parts; ++part) {
    const Offset share = offsets.back() / parts * part + offsets.back() % parts * part / parts;
    const auto row = std::lower_bound(offsets.begin(), offsets.end() - 1, share) - offsets.begin();
    bounds.push_back(std::max(bounds.back(), static_cast<Index>(row)));
  }
  bounds.push_back(static_cast<Index>(offsets.size()) - 1);
  return bounds;
}

void owners_of(std::span<const Index> vertices, std::span<const Index> bounds, std::vector<Index>& owners) {
  owners.clear();
  for (const Index v : vertices) {
    owners.push_back(
        static_cast<Index>(std::upper_bound(bounds.begin() + 1, bounds.end(), v) - bounds.begin()) - 1);
  }
  std::sort(owners.begin(), owners.end());
  owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
}

std::vector<OwnedBatches> owned_batches(std::span<const Index> vertices, Index corners,
                                        std::span<const Index> bounds) {
  const Index parts = index_size(bounds) - 1;
  std::vector<OwnedBatches> shares(static_cast<std::size_t>(parts));
  for (Index part = 0; part < parts; ++part) {
    shares[part].begin = bounds[part];
    shares[part].end = bounds[part + 1];
    shares[part].room = first_spare(bounds.back(), part + 1);
  }
  const auto size = static_cast<std::size_t>(corners) * kBatch;
  std::vector<Index> owners;
  for (std::size_t first = 0; first < vertices.size(); first += size) {
    const std::span<const Index> of_batch = vertices.subspan(first, size);
    owners_of(of_batch, bounds, owners);
    for (const Index part : owners) {
      append(shares[part], static_cast<Index>(first / size), of_batch, first_spare(bounds.back(), part));
    }
  }
  return shares;
}

void check_room(std::span<const double> forces, const OwnedBatches& share, const char* function) {
  if (forces.size() < static_cast<std::size_t>(kPaddedStride) * static_cast<std::size_t>(share.room)) {
    throw InvalidArgument(std::string(function) + ": the forces must have room for " +
                          std::to_string(share.room) + " vertices, including spare ones");
  }
}

}  // namespace meshorder
