// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/local_steps.hpp"

#include "base/parallel.hpp"
#include "kernels/positions.hpp"
#include <meshorder/error.hpp>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace meshorder {
namespace {

template <class Real>
void run(LocalModel model, const LocalPass<Real>& pass) {
  switch (model) {
    case LocalModel::springs:
      return pass_springs(pass);
    case LocalModel::strain:
      return pass_strain(pass);
    case LocalModel::stvk:
      return pass_stvk(pass);
    case LocalModel::neo_hookean:
      return pass_neo_hookean(pass);
    case LocalModel::log_neo_hookean:
      return pass_log_neo_hookean(pass);
  }
}

/// Returns the bounds of ranges of vertices with about equal numbers of element corners.
template <class Real>
std::vector<Index> ranges_of(const LocalElements<Real>& elements, Index n) {
  std::vector<Offset> corners(static_cast<std::size_t>(n) + 1, 0);
  for (const Index v : elements.vertices) ++corners[v + 1];
  for (Index v = 0; v < n; ++v) corners[v + 1] += corners[v];
  return balanced_ranges(corners, std::max(1, thread_count()));
}

template <class Real>
void check_vertices(std::span<const Real> vectors, Index n, const char* what) {
  if (vectors.size() >= static_cast<std::size_t>(kPaddedStride) * static_cast<std::size_t>(n)) return;
  throw InvalidArgument(fmt::format("local steps: {} of {} numbers for {} vertices of {}", what,
                                    vectors.size(), n, kPaddedStride));
}

}  // namespace

template <class Real>
LocalSteps<Real>::LocalSteps(const LocalLaw& law, const Simplices& simplices, std::span<const Point> points)
    : model_(law.model),
      vertex_count_(index_size(points)),
      elements_(local_elements<Real>(law, simplices, points)) {
  // owned_batches counts in batches of kBatch elements
  const Index widths = kLocalBatch<Real> / kBatch;
  shares_ =
      owned_batches(elements_.vertices, elements_.corners * widths, ranges_of(elements_, vertex_count_));
  copies_.resize(elements_.batches());
  Offset copies = 0;
  for (const OwnedBatches& share : shares_) {
    first_copies_.push_back(copies);
    for (const Index batch : share.batches) copies_[batch] = copies++;
  }
  duals_.assign(duals_of(copies), Real{0});
  residuals_.assign(2 * copies, 0.0);
}

template <class Real>
SparseMatrix LocalSteps<Real>::stiffness() const {
  return stiffness_of(elements_, vertex_count_);
}

template <class Real>
LocalResidual LocalSteps<Real>::pass(std::span<const Real> positions, Real scale,
                                     std::span<Real> right_hand_side) {
  check_vertices(positions, vertex_count_, "positions");
  check_vertices(std::span<const Real>(right_hand_side), room(), "a right-hand side");
  for_each_part(index_size(shares_), [&](Index part) {
    const OwnedBatches& share = shares_[part];
    std::fill(right_hand_side.begin() + Offset{kPaddedStride} * share.begin,
              right_hand_side.begin() + Offset{kPaddedStride} * share.end, Real{0});
    LocalPass<Real> pass{share};
    pass.vertices = elements_.vertices.data();
    pass.rest = elements_.rest.data();
    pass.directions = elements_.directions.data();
    pass.softness = elements_.softness.data();
    pass.softness_stride = elements_.softness_stride;
    pass.stiffness = elements_.stiffness;
    pass.scale = scale;
    pass.positions = positions.data();
    pass.right_hand_side = right_hand_side.data();
    pass.duals = duals_.data() + duals_of(first_copies_[part]);
    pass.residuals = residuals_.data() + 2 * first_copies_[part];
    run(model_, pass);
  });
  // summed in the order of the batches, which does not depend on the shares
  LocalResidual sum;
  for (const Offset copy : copies_) {
    sum.primal += residuals_[2 * copy];
    sum.magnitude += residuals_[2 * copy + 1];
  }
  return sum;
}

template <class Real>
Index LocalSteps<Real>::room() const noexcept {
  return shares_.back().room;
}

template <class Real>
void LocalSteps<Real>::reset_duals() {
  std::fill(duals_.begin(), duals_.end(), Real{0});
}

template <class Real>
std::vector<Real> LocalSteps<Real>::duals() const {
  const Index rows = elements_.rows();
  std::vector<Real> result;
  result.reserve(elements_.count * rows);
  for (Offset s = 0; s < elements_.count; ++s) {
    const Real* const first =
        duals_.data() + duals_of(copies_[s / kLocalBatch<Real>]) + s % kLocalBatch<Real>;
    for (Index k = 0; k < rows; ++k) result.push_back(first[k * kLocalBatch<Real>]);
  }
  return result;
}

template <class Real>
void LocalSteps<Real>::set_duals(std::span<const Real> duals) {
  const Index rows = elements_.rows();
  if (static_cast<Offset>(duals.size()) != elements_.count * rows) {
    throw InvalidArgument(fmt::format("local steps: {} duals for {} elements; each has {}", duals.size(),
                                      elements_.count, rows));
  }
  if (!std::all_of(duals.begin(), duals.end(), [](Real dual) { return std::isfinite(dual); }))
    throw InvalidArgument("local steps: duals that are not finite");
  const Offset last = elements_.count - 1;
  for_each_part(index_size(shares_), [&](Index part) {
    Offset copy = first_copies_[part];
    for (const Index batch : shares_[part].batches) {
      Real* const first = duals_.data() + duals_of(copy++);
      for (Index lane = 0; lane < kLocalBatch<Real>; ++lane) {
        const Offset s = Offset{batch} * kLocalBatch<Real> + lane;
        // lanes that fill the last batch: springs have no length, and tetrahedra copy the last tetrahedron
        const Offset from = elements_.corners == 4 ? std::min(s, last) : s;
        for (Index k = 0; k < rows; ++k) {
          first[k * kLocalBatch<Real> + lane] = from <= last ? duals[from * rows + k] : Real{0};
        }
      }
    }
  });
}

template <class Real>
double LocalSteps<Real>::energy(std::span<const Real> positions) const {
  check_vertices(positions, vertex_count_, "positions");
  return energy_of(model_, elements_, positions);
}

template <class Real>
Offset LocalSteps<Real>::element_count() const noexcept {
  return elements_.count;
}

template <class Real>
std::size_t LocalSteps<Real>::bytes() const {
  const auto of = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  std::size_t sum = of(elements_.vertices) + of(elements_.rest) + of(elements_.directions) +
                    of(elements_.softness) + of(copies_) + of(duals_) + of(residuals_);
  for (const OwnedBatches& share : shares_) sum += of(share.batches) + of(share.boundary) + of(share.targets);
  return sum;
}

template class LocalSteps<double>;
template class LocalSteps<float>;

}  // namespace meshorder
