// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/dual_contact_solver.hpp"

#include "kernels/positions.hpp"
#include "lab/contact/solve/contact_rows.hpp"
#include "lab/contact/solve/force_problem.hpp"
#include "lab/contact/solve/remembered_forces.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshorder {
namespace {

// softness (see ForceSolveOptions) as a share of the tolerance: too small to affect the result
constexpr double kSoftness = 0.01;
// after this many rounds of tangential bounds without progress, the next round is the last
constexpr int kMaxFailures = 3;
// An eighth of the multiplications is reserved for the last round. Each earlier round takes at most half of
// the multiplications that are left.
constexpr int kPartOfLast = 8;

/// The operator S = C A⁻¹Cᵀ of the contacts of one call.
template <class Real>
class ContactOperator final : public ForceOperator {
 public:
  ContactOperator(const SparseMatrix& matrix, const CholeskyFactor<Real>& factor)
      : matrix_(matrix),
        factor_(factor),
        load_(Offset{kPaddedStride} * matrix.size()),
        moved_(load_.size()),
        place_of_(matrix.size(), -1),
        diagonal_(matrix.size()) {
    for (Index v = 0; v < matrix.size(); ++v) {
      for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
        if (matrix.columns[k] == v) diagonal_[v] = matrix.values[k];
      }
    }
  }

  void set(std::span<const Contact> contacts) {
    check_contacts(contacts, matrix_.size());
    ContactRows rows = contact_rows(contacts);
    const bool same_vertices = rows.vertices == rows_.vertices;
    rows_ = std::move(rows);
    if (!same_vertices) {
      reach_ = factor_.reach_of(rows_.vertices);
      take_submatrix();
    }
    touched_.resize(3 * rows_.vertices.size());
    pulled_.resize(touched_.size());
    scale_.assign(rows_.size(), 0.0);
    for (Index k = 0; k < rows_.contacts(); ++k) {
      for (std::size_t i = 0; i < 4; ++i) {
        const Index v = rows_.places[k][i];
        const double w = rows_.weights[k][i];
        if (v >= 0) scale_[k] += w * w / diagonal_[rows_.vertices[v]];
      }
    }
    for (Index k = 0; k < index_size(rows_.frictional); ++k) {
      scale_[rows_.row_of(k)] = scale_[rows_.row_of(k) + 1] = scale_[rows_.frictional[k]];
    }
    weighed_.resize(rows_.size());
  }

  void multiply(std::span<const double> forces, std::span<double> result) override {
    multiply_transposed(rows_, forces, touched_);
    for (std::size_t i = 0; i < rows_.vertices.size(); ++i) {
      Real* const load = load_.data() + Offset{kPaddedStride} * rows_.vertices[i];
      for (std::size_t c = 0; c < 3; ++c) load[c] = static_cast<Real>(touched_[3 * i + c]);
    }
    factor_.solve(reach_, load_, moved_);
    meshorder::multiply(rows_, std::span<const Real>(moved_), result);
  }

  /// Multiplies by W C D⁻¹ A D⁻¹ Cᵀ W, where D is the diagonal of A and W the inverse of the diagonal of
  /// C D⁻¹ Cᵀ: the lumped preconditioner with weights by stiffness (Rixen, Farhat 1999).
  void precondition(std::span<const double> moves, std::span<double> result) override {
    for (std::size_t k = 0; k < weighed_.size(); ++k) weighed_[k] = moves[k] / scale_[k];
    multiply_transposed(rows_, weighed_, touched_);
    scale_by_diagonal(touched_);
    for (std::size_t i = 0; i < rows_.vertices.size(); ++i) {
      Point sum{};
      for (Offset k = offsets_[i]; k < offsets_[i + 1]; ++k) {
        for (std::size_t c = 0; c < 3; ++c) sum[c] += values_[k] * touched_[3 * columns_[k] + c];
      }
      for (std::size_t c = 0; c < 3; ++c) pulled_[3 * i + c] = sum[c];
    }
    scale_by_diagonal(pulled_);
    multiply_touched(rows_, pulled_, result);
    for (std::size_t k = 0; k < weighed_.size(); ++k) result[k] /= scale_[k];
  }

  /// Computes result = b + Cᵀ forces.
  void add_forces(std::span<const double> forces, std::span<const Real> b, std::span<Real> result) {
    multiply_transposed(rows_, forces, touched_);
    std::copy(b.begin(), b.end(), result.begin());
    for (std::size_t i = 0; i < rows_.vertices.size(); ++i) {
      Real* const at = result.data() + Offset{kPaddedStride} * rows_.vertices[i];
      for (std::size_t c = 0; c < 3; ++c)
        at[c] = static_cast<Real>(static_cast<double>(at[c]) + touched_[3 * i + c]);
    }
  }

  [[nodiscard]] const ContactRows& rows() const noexcept { return rows_; }
  [[nodiscard]] std::span<const double> scale() const noexcept { return scale_; }
  [[nodiscard]] std::size_t bytes() const {
    return 2 * load_.size() * sizeof(Real) + place_of_.size() * (sizeof(Index) + sizeof(double)) +
           values_.capacity() * (sizeof(double) + sizeof(Index));
  }

 private:
  /// Copies the rows and columns of A at the vertices of contacts.
  void take_submatrix() {
    offsets_.assign(1, 0);
    columns_.clear();
    values_.clear();
    for (std::size_t i = 0; i < rows_.vertices.size(); ++i)
      place_of_[rows_.vertices[i]] = static_cast<Index>(i);
    for (const Index v : rows_.vertices) {
      for (Offset k = matrix_.offsets[v]; k < matrix_.offsets[v + 1]; ++k) {
        const Index place = place_of_[matrix_.columns[k]];
        if (place < 0) continue;
        columns_.push_back(place);
        values_.push_back(matrix_.values[k]);
      }
      offsets_.push_back(static_cast<Offset>(columns_.size()));
    }
    for (const Index v : rows_.vertices) place_of_[v] = -1;
  }

  void scale_by_diagonal(std::vector<double>& vector) const {
    for (std::size_t i = 0; i < vector.size(); ++i) vector[i] /= diagonal_[rows_.vertices[i / 3]];
  }

  const SparseMatrix& matrix_;
  const CholeskyFactor<Real>& factor_;
  AlignedVector<Real> load_, moved_;  ///< of all vertices; only those of contacts are used
  std::vector<Index> place_of_;       ///< of all vertices; −1 except within take_submatrix
  std::vector<double> diagonal_;      ///< of A
  ContactRows rows_;
  FactorReach reach_;
  std::vector<Offset> offsets_;  ///< of the part of A at contacts' vertices
  std::vector<Index> columns_;
  std::vector<double> values_;
  std::vector<double> scale_;                       ///< of each row: the diagonal entry of C D⁻¹ Cᵀ
  std::vector<double> touched_, pulled_, weighed_;  ///< scratch
};

template <class Real>
class Solver final : public DualContactSolver<Real> {
 public:
  Solver(const SparseMatrix& matrix, const CholeskyFactor<Real>& factor, const ContactSolverOptions& options)
      : options_(options),
        factor_(factor),
        operator_(matrix, factor),
        loads_(Offset{kPaddedStride} * matrix.size()) {}

  ContactSolveReport solve(std::span<const Contact> contacts, std::span<const Real> b,
                           std::span<const double> from, std::span<Real> x) override {
    check_vectors(factor_.size(), b.size(), from.size(), x.size());
    ContactSolveReport report;
    report.converged = true;
    factor_.solve(b, x);
    normal_forces_.assign(contacts.size(), 0.0);
    if (contacts.empty()) {
      remembered_.forget();
      return report;
    }
    operator_.set(contacts);
    take_depths(contacts, from, x);
    start_from_remembered(contacts);
    find_forces(contacts, report);
    if (std::any_of(forces_.begin(), forces_.end(), [](double force) { return force != 0.0; })) {
      operator_.add_forces(forces_, b, loads_);
      factor_.solve(loads_, x);
    }
    remember(contacts);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      report.violation = std::max(report.violation, depth(contacts[k], std::span<const Real>(x)));
      if (normal_forces_[k] > 0.0) ++report.pushing;
    }
    return report;
  }

  [[nodiscard]] std::span<const double> forces() const override { return normal_forces_; }
  void forget() override { remembered_.forget(); }
  [[nodiscard]] std::size_t bytes() const override {
    return operator_.bytes() + loads_.size() * sizeof(Real) + remembered_.bytes();
  }

 private:
  [[nodiscard]] const ContactRows& rows() const noexcept { return operator_.rows(); }

  /// Computes g: the depth at x for normal rows; minus the displacement since `from` for tangential rows.
  void take_depths(std::span<const Contact> contacts, std::span<const double> from, std::span<const Real> x) {
    depths_.resize(rows().size());
    multiply(rows(), x, std::span<double>(depths_));
    for (std::size_t k = 0; k < contacts.size(); ++k) depths_[k] = contacts[k].offset - depths_[k];
    if (rows().frictional.empty()) return;
    std::vector<double> places(rows().size());
    multiply(rows(), from, std::span<double>(places));
    for (Index row = rows().contacts(); row < rows().size(); ++row) depths_[row] = places[row] - depths_[row];
  }

  void start_from_remembered(std::span<const Contact> contacts) {
    forces_.assign(rows().size(), 0.0);
    bounds_.normals = rows().contacts();
    bounds_.radii.assign(rows().frictional.size(), 0.0);
    for (Index k = 0; k < rows().contacts(); ++k) forces_[k] = remembered_.of(contacts[k]).normal;
    for (Index k = 0; k < index_size(rows().frictional); ++k) {
      const Point along = remembered_.of(contacts[rows().frictional[k]]).along;
      for (const Index row : {rows().row_of(k), rows().row_of(k) + 1}) {
        for (std::size_t c = 0; c < 3; ++c) forces_[row] += along[c] * rows().directions[row][c];
      }
    }
  }

  /// Sets the bounds of tangential forces by the normal forces, and projects the forces onto these bounds.
  void set_radii(std::span<const Contact> contacts) {
    for (Index k = 0; k < index_size(rows().frictional); ++k) {
      const Index contact = rows().frictional[k];
      bounds_.radii[k] = contacts[contact].friction * forces_[contact];
    }
    project(bounds_, forces_);
  }

  void find_forces(std::span<const Contact> contacts, ContactSolveReport& report) {
    double depth_square = 0.0;
    for (std::size_t k = 0; k < contacts.size(); ++k)
      depth_square += std::max(depths_[k], 0.0) * std::max(depths_[k], 0.0);
    const double depth_norm = std::sqrt(depth_square);
    if (depth_norm == 0.0) {
      // no contact is violated: the solution has no forces
      std::fill(forces_.begin(), forces_.end(), 0.0);
      return;
    }
    ForceSolveOptions options;
    options.tolerance = options_.tolerance * depth_norm;
    options.scale = operator_.scale();
    options.softness = kSoftness * options_.tolerance;
    const bool friction = !rows().frictional.empty();
    double best = std::numeric_limits<double>::infinity();
    int failures = 0;
    for (bool last = !friction;;) {
      set_radii(contacts);
      report.iterations += take_gradient();
      const double residual = projected_gradient(bounds_, options.scale, forces_, gradient_);
      report.converged = residual <= options.tolerance;
      const int left = options_.max_iterations - report.iterations;
      if (report.converged || left <= 0) break;
      // bounds and forces may increase each other without end: the last round then keeps the bounds
      if (residual >= best) ++failures;
      best = std::min(best, residual);
      last = last || failures >= kMaxFailures || left <= options_.max_iterations / kPartOfLast;
      options.max_multiplications = last ? left : left / 2;
      const ForceSolveReport solved = minimise_forces(operator_, bounds_, options, forces_, gradient_);
      report.iterations += solved.multiplications;
      report.converged = !friction && solved.residual <= options.tolerance;
      if (last) break;
    }
    // measure the residual without the softness: contradictory contacts converge only because of the softness
    for (std::size_t i = 0; i < forces_.size(); ++i)
      gradient_[i] += options.softness * options.scale[i] * forces_[i];
    report.residual = projected_gradient(bounds_, options.scale, forces_, gradient_) / depth_norm;
    report.converged = report.converged && report.residual <= 2 * options_.tolerance;
  }

  /// Computes the gradient g − S λ with softness. Returns the number of multiplications by S.
  int take_gradient() {
    gradient_ = depths_;
    if (std::all_of(forces_.begin(), forces_.end(), [](double force) { return force == 0.0; })) return 0;
    moves_.resize(forces_.size());
    operator_.multiply(forces_, moves_);
    for (std::size_t i = 0; i < moves_.size(); ++i)
      gradient_[i] -= moves_[i] + kSoftness * options_.tolerance * operator_.scale()[i] * forces_[i];
    return 1;
  }

  void remember(std::span<const Contact> contacts) {
    std::vector<ContactForce> found(contacts.size());
    for (std::size_t k = 0; k < contacts.size(); ++k) found[k].normal = normal_forces_[k] = forces_[k];
    for (Index k = 0; k < index_size(rows().frictional); ++k) {
      for (const Index row : {rows().row_of(k), rows().row_of(k) + 1}) {
        for (std::size_t c = 0; c < 3; ++c)
          found[rows().frictional[k]].along[c] += forces_[row] * rows().directions[row][c];
      }
    }
    remembered_.remember(contacts, found);
  }

  ContactSolverOptions options_;
  const CholeskyFactor<Real>& factor_;
  ContactOperator<Real> operator_;
  AlignedVector<Real> loads_;
  RememberedForces remembered_;
  ForceBounds bounds_;
  std::vector<double> depths_, forces_, gradient_, moves_;  ///< of each row
  std::vector<double> normal_forces_;
};

}  // namespace

template <class Real>
std::unique_ptr<DualContactSolver<Real>> DualContactSolver<Real>::make(const SparseMatrix& matrix,
                                                                       const CholeskyFactor<Real>& factor,
                                                                       const ContactSolverOptions& options) {
  if (!(options.tolerance > 0.0)) throw InvalidArgument("DualContactSolver: tolerance must be positive");
  if (options.max_iterations < 0)
    throw InvalidArgument("DualContactSolver: max_iterations must not be negative");
  if (matrix.size() != factor.size())
    throw InvalidArgument("DualContactSolver: the factor must be that of the matrix");
  return std::make_unique<Solver<Real>>(matrix, factor, options);
}

template class DualContactSolver<double>;
template class DualContactSolver<float>;

}  // namespace meshorder
