// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/gauss_seidel.hpp"

#include "base/parallel.hpp"
#include "kernels/positions.hpp"
#include "lab/contact/solve/coloured_rows.hpp"
#include "lab/contact/solve/contact_rows.hpp"
#include "lab/contact/solve/node_contacts.hpp"
#include "lab/contact/solve/remembered_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace meshorder {
namespace {

// a colour of fewer rows takes less than the start of threads' tasks
constexpr Index kLeastRows = 512;
// sweeps have calmed down where their change is this part of the first one's
constexpr double kCalm = 0.5;
constexpr int kMostSweepsBetweenUpdates = 10;

template <class Real>
class GaussSeidel final : public ContactSolver<Real> {
 public:
  GaussSeidel(const SparseMatrix& matrix, const CholeskyFactor<Real>& factor,
              const ContactSolverOptions& options)
      : options_(options), factor_(factor), rows_(matrix) {}

  ContactSolveReport solve(std::span<const Contact> contacts, std::span<const Real> b,
                           std::span<const double> from, std::span<Real> x) override {
    check_vectors(rows_.size(), b.size(), from.size(), x.size());
    ContactSolveReport report;
    normal_forces_.assign(contacts.size(), 0.0);
    if (contacts.empty()) {
      factor_.solve(b, x);
      remembered_.forget();
      report.converged = true;
      return report;
    }
    check_contacts(contacts, rows_.size());
    std::vector<ContactForce> first(contacts.size());
    for (std::size_t k = 0; k < contacts.size(); ++k) first[k] = remembered_.of(contacts[k]);
    nodes_.set(contacts, first, from, [&](Index v) { return rows_.diagonal(v); });
    sort_nodes();
    sweep_until_calm(contacts, b, x, report);
    nodes_.take_forces(contacts, std::span<const Real>(x), first);
    remembered_.remember(contacts, first);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      normal_forces_[k] = first[k].normal;
      if (normal_forces_[k] > 0.0) ++report.pushing;
      report.violation = std::max(report.violation, depth(contacts[k], std::span<const Real>(x)));
    }
    return report;
  }

  [[nodiscard]] std::span<const double> forces() const override { return normal_forces_; }
  void forget() override {
    remembered_.forget();
    largest_change_ = 0.0;
  }
  [[nodiscard]] std::size_t bytes() const override { return rows_.bytes() + remembered_.bytes(); }

 private:
  static constexpr Index kParts = ColouredRows<Real>::kParts;

  /// Nodes by their places, and apart those that are tied to others.
  void sort_nodes() {
    places_.clear();
    for (Index node = 0; node < nodes_.size(); ++node)
      places_.push_back({rows_.place_of(nodes_.vertex(node)), node});
    std::sort(places_.begin(), places_.end());
  }

  void sweep_until_calm(std::span<const Contact> contacts, std::span<const Real> b, std::span<Real> x,
                        ContactSolveReport& report) {
    const bool has_updates = nodes_.has_updates();
    const double rounding = rounding_of(x);
    double after_update = 0.0;
    int since_update = 0;
    double scale = 0.0;
    while (report.iterations < options_.max_iterations && !report.converged) {
      double change = sweep(contacts, b, x);
      if (report.iterations++ == 0) largest_change_ = std::max(largest_change_, change);
      scale = std::max(largest_change_, rounding / options_.tolerance);
      if (since_update++ == 0) after_update = change;
      bool calm = change <= options_.tolerance * scale;
      if (has_updates &&
          (calm || change <= kCalm * after_update || since_update >= kMostSweepsBetweenUpdates)) {
        change = std::max(change, nodes_.update(contacts, std::span<const Real>(x)));
        calm = change <= options_.tolerance * scale;
        since_update = 0;
      }
      report.residual = scale > 0.0 ? change / scale : 0.0;
      report.converged = calm;
    }
    const double left = nodes_.depth_left(contacts, std::span<const Real>(x));
    if (!(left <= options_.tolerance * scale)) {
      report.converged = false;
      report.residual = std::max(report.residual, left / scale);
    }
  }

  /// A change of all of x by a rounding, in the norm of the energy.
  [[nodiscard]] double rounding_of(std::span<const Real> x) const {
    double square = 0.0;
    for (Index v = 0; v < rows_.size(); ++v) {
      for (Index c = 0; c < 3; ++c) {
        const auto coordinate = static_cast<double>(x[Offset{kPaddedStride} * v + c]);
        square += rows_.diagonal(v) * coordinate * coordinate;
      }
    }
    return static_cast<double>(std::numeric_limits<Real>::epsilon()) * std::sqrt(square);
  }

  /// Returns the norm of the change, in that of the energy.
  double sweep(std::span<const Contact> contacts, std::span<const Real> b, std::span<Real> x) {
    double square = 0.0;
    for (Index colour = 0; colour + 1 < index_size(rows_.colours()); ++colour) {
      const std::span<const Index> parts = rows_.parts(colour);
      std::array<double, kParts> squares{};
      const auto work = [&](Index part) {
        squares[static_cast<std::size_t>(part)] = sweep_rows(contacts, parts[part], parts[part + 1], b, x);
      };
      if (parts[kParts] - parts[0] < kLeastRows) {
        for (Index part = 0; part < kParts; ++part) work(part);
      } else {
        for_each_part(kParts, work);
      }
      for (const double part : squares) square += part;
    }
    for (const auto& [place, node] : places_) {
      if (nodes_.is_tied(node)) square += relax_node(contacts, node, b, x);
    }
    return std::sqrt(square);
  }

  double sweep_rows(std::span<const Contact> contacts, Index begin, Index end, std::span<const Real> b,
                    std::span<Real> x) {
    const auto relaxation = static_cast<Real>(options_.over_relaxation);
    double square = 0.0;
    auto next = std::lower_bound(places_.begin(), places_.end(), std::pair{begin, Index{0}});
    while (begin < end) {
      const Index stop = next == places_.end() ? end : std::min(end, next->first);
      square += rows_.relax(begin, stop, relaxation, b, x);
      if (stop < end && !nodes_.is_tied(next->second)) square += relax_node(contacts, next->second, b, x);
      begin = stop + 1;
      ++next;
    }
    return square;
  }

  double relax_node(std::span<const Contact> contacts, Index node, std::span<const Real> b,
                    std::span<Real> x) {
    const Index v = nodes_.vertex(node);
    Point residual = rows_.residual(v, b, x);
    double stiffness = rows_.diagonal(v);
    nodes_.add_ties(contacts, node, std::span<const Real>(x), residual, stiffness);
    Real* const at = x.data() + Offset{kPaddedStride} * v;
    const double way = options_.over_relaxation / stiffness;
    Point aim{};
    for (std::size_t c = 0; c < 3; ++c) aim[c] = static_cast<double>(at[c]) + way * residual[c];
    nodes_.project(contacts, node, way, aim);
    double square = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double change = aim[c] - static_cast<double>(at[c]);
      square += stiffness * change * change;
      at[c] = static_cast<Real>(aim[c]);
    }
    return square;
  }

  ContactSolverOptions options_;
  const CholeskyFactor<Real>& factor_;
  ColouredRows<Real> rows_;
  RememberedForces remembered_;
  mutable NodeContacts nodes_;                   ///< each node's forces change with it alone
  std::vector<std::pair<Index, Index>> places_;  ///< rising, with their nodes
  std::vector<double> normal_forces_;
  double largest_change_ = 0.0;  ///< of a first sweep since `forget`
};

}  // namespace

template <class Real>
std::unique_ptr<ContactSolver<Real>> make_gauss_seidel(const SparseMatrix& matrix,
                                                       const CholeskyFactor<Real>& factor,
                                                       const ContactSolverOptions& options) {
  return std::make_unique<GaussSeidel<Real>>(matrix, factor, options);
}

template std::unique_ptr<ContactSolver<double>> make_gauss_seidel(const SparseMatrix&,
                                                                  const CholeskyFactor<double>&,
                                                                  const ContactSolverOptions&);
template std::unique_ptr<ContactSolver<float>> make_gauss_seidel(const SparseMatrix&,
                                                                 const CholeskyFactor<float>&,
                                                                 const ContactSolverOptions&);

}  // namespace meshorder
