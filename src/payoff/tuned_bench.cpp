// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/tuned_bench.hpp"

#include "base/parallel.hpp"
#include "kernels/apart.hpp"
#include "kernels/block_csr.hpp"
#include "kernels/elasticity.hpp"
#include "kernels/positions.hpp"

#include <algorithm>
#include <utility>

namespace meshorder {
namespace {

// soft rubber; the values do not affect the times
const Elasticity kMaterial{MaterialModel::stvk, Tangent::exact, Lame::from_young(1e6, 0.45), {}, {}};
constexpr double kStiffness = 1e3;

}  // namespace

TunedBench::TunedBench(const KernelInput& input)
    : matrix_(zero_block_csr(input.graph())),
      rest_(rest_shapes(input.simplices(), input.points())),
      map_(assembly_map(rest_, matrix_)),
      springs_(springs_on_edges(input.graph(), input.points())),
      forces_(padded_zeros(index_size(input.points()))),
      x_(3 * input.points().size(), 0.0),
      y_(3 * input.points().size(), 0.0) {
  const std::vector<Point> moved = displaced(input.points());
  positions_ = padded_positions(moved);
  for (std::size_t v = 0; v < moved.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) x_[3 * v + c] = moved[v][c] - input.points()[v][c];
  }
}

void TunedBench::share(int threads) {
  shares_.clear();
  if (threads < 2) return;
  const std::vector<Index> bounds = balanced_ranges(matrix_.offsets, threads);
  std::vector<OwnedBatches> of_elements;
  std::vector<OwnedBatches> of_springs;
  for_each_chunk(2, 1, [&](Index i, Index /*begin*/, Index /*end*/) {
    if (i == 0) {
      of_elements = owned_batches(rest_.vertices, rest_.dimension + 1, bounds);
    } else {
      of_springs = owned_batches(springs_.ends, 2, bounds);
    }
  });
  shares_.resize(static_cast<std::size_t>(threads));
  for_each_chunk(threads, 1, [&](Index part, Index /*begin*/, Index /*end*/) {
    OwnedBlocks blocks = owned_blocks(rest_, map_, matrix_, of_elements[part], part);
    shares_[part] = {std::move(of_elements[part]), std::move(blocks), std::move(of_springs[part])};
  });
  const Index room = std::max(shares_.back().elements.room, shares_.back().springs.room);
  forces_ = reserved_apart<double>(Offset{kPaddedStride} * room, {positions_.data()});
  forces_.assign(Offset{kPaddedStride} * room, 0.0);
  matrix_.values.resize(9 * static_cast<std::size_t>(shares_.back().blocks.room), 0.0);
}

void TunedBench::run_shared(Kernel kernel) {
  const Stiffness stiffness{map_, matrix_};
  for_each_part(index_size(shares_), [&](Index part) {
    const Share& share = shares_[part];
    const Index begin = share.elements.begin;
    const Index end = share.elements.end;
    // each thread clears the values of its own range
    const auto clear = [](AlignedVector<double>& values, Offset first, Offset last) {
      std::fill(values.begin() + first, values.begin() + last, 0.0);
    };
    switch (kernel) {
      case Kernel::spmv:
        multiply_rows(matrix_, x_, y_, begin, end);
        return;
      case Kernel::element:
        clear(forces_, Offset{kPaddedStride} * begin, Offset{kPaddedStride} * end);
        add_elasticity(rest_, kMaterial, positions_, forces_, nullptr, share.elements, share.blocks);
        return;
      case Kernel::assembly:
        clear(matrix_.values, 9 * matrix_.offsets[begin], 9 * matrix_.offsets[end]);
        add_elasticity(rest_, kMaterial, positions_, {}, &stiffness, share.elements, share.blocks);
        return;
      case Kernel::springs:
        clear(forces_, Offset{kPaddedStride} * begin, Offset{kPaddedStride} * end);
        add_spring_forces(springs_, kStiffness, positions_, forces_, share.springs);
        return;
    }
  });
}

double TunedBench::redundancy() const {
  if (shares_.empty() || rest_.count == 0) return 0.0;
  Offset computed = 0;
  for (const Share& share : shares_) computed += static_cast<Offset>(share.elements.batches.size());
  return static_cast<double>(computed - rest_.batches()) / static_cast<double>(rest_.batches());
}

void TunedBench::compute(Kernel kernel) {
  if (!shares_.empty()) return run_shared(kernel);
  const Stiffness stiffness{map_, matrix_};
  switch (kernel) {
    case Kernel::spmv:
      multiply(matrix_, x_, y_);
      return;
    case Kernel::element:
      std::fill(forces_.begin(), forces_.end(), 0.0);
      add_elasticity(rest_, kMaterial, positions_, forces_, nullptr);
      return;
    case Kernel::assembly:
      matrix_.set_zero();
      add_elasticity(rest_, kMaterial, positions_, {}, &stiffness);
      return;
    case Kernel::springs:
      std::fill(forces_.begin(), forces_.end(), 0.0);
      add_spring_forces(springs_, kStiffness, positions_, forces_);
      return;
  }
}

std::span<const double> TunedBench::result(Kernel kernel) const {
  switch (kernel) {
    case Kernel::spmv:
      return y_;
    case Kernel::assembly:
      return std::span(matrix_.values).first(9 * static_cast<std::size_t>(matrix_.block_count()));
    case Kernel::element:
    case Kernel::springs:
      break;
  }
  return std::span(forces_).first(positions_.size());
}

double TunedBench::streamed_bytes(Kernel kernel) const {
  // arrays that are cleared and then added to are written, read and written again
  const std::size_t vertices = bytes_of(positions_) + 3 * bytes_of(forces_);
  const std::size_t elements = bytes_of(rest_.vertices) + bytes_of(rest_.geometry);
  std::size_t bytes = 0;
  switch (kernel) {
    case Kernel::spmv:
      bytes = bytes_of(matrix_.values) + bytes_of(matrix_.columns) + bytes_of(matrix_.offsets) +
              bytes_of(x_) + bytes_of(y_);
      break;
    case Kernel::element:
      bytes = elements + vertices;
      break;
    case Kernel::assembly:
      bytes = elements + bytes_of(positions_) + bytes_of(map_.blocks) + 3 * bytes_of(matrix_.values);
      break;
    case Kernel::springs:
      bytes = bytes_of(springs_.ends) + bytes_of(springs_.rest_lengths) + vertices;
      break;
  }
  return static_cast<double>(bytes);
}

std::size_t TunedBench::bytes() const {
  std::size_t of_shares = 0;
  for (const Share& share : shares_) {
    of_shares += bytes_of(share.blocks.blocks);
    for (const OwnedBatches* owned : {&share.elements, &share.springs}) {
      of_shares += bytes_of(owned->batches) + bytes_of(owned->boundary) + bytes_of(owned->targets);
    }
  }
  return of_shares + bytes_of(matrix_.offsets) + bytes_of(matrix_.columns) + bytes_of(matrix_.values) +
         bytes_of(rest_.vertices) + bytes_of(rest_.geometry) + bytes_of(map_.blocks) +
         bytes_of(springs_.ends) + bytes_of(springs_.rest_lengths) + bytes_of(positions_) +
         bytes_of(forces_) + bytes_of(x_) + bytes_of(y_);
}

}  // namespace meshorder
