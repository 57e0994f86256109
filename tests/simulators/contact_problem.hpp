// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/random.hpp"
#include "kernels/positions.hpp"
#include "lab/contact/solve/dual_contact_solver.hpp"
#include "mesh/graphs.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <vector>

namespace meshorder::test {

/// A body with the energy ½xᵀA x − bᵀx, and its contacts.
struct ContactProblem {
  SparseMatrix matrix;
  std::vector<double> masses;
  AlignedVector<double> rest, b;  ///< kPaddedStride numbers for each vertex; at first A rest = b
  std::vector<Contact> contacts;

  [[nodiscard]] Index size() const { return matrix.size(); }

  /// b += A's masses times a displacement: as gravity does in one time step.
  void push(const Point& displacement) {
    for (Index v = 0; v < size(); ++v) {
      for (Index c = 0; c < 3; ++c) b[kPaddedStride * v + c] += masses[v] * displacement[c];
    }
  }

  /// Keeps every vertex that rests within `reach` of the plane normal · x = offset above it.
  void add_plane(const Point& normal, double offset, double reach, std::int32_t with, double friction = 0.0) {
    for (Index v = 0; v < size(); ++v) {
      double height = -offset;
      for (Index c = 0; c < 3; ++c) height += normal[c] * rest[kPaddedStride * v + c];
      if (height <= reach)
        contacts.push_back({{v, -1, -1, -1}, {1, 0, 0, 0}, normal, offset, friction, with});
    }
  }
};

/// b = A x
inline AlignedVector<double> product(const SparseMatrix& matrix, const AlignedVector<double>& x) {
  AlignedVector<double> b(x.size(), 0.0);
  for (Index row = 0; row < matrix.size(); ++row) {
    for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
      for (Index c = 0; c < 3; ++c)
        b[kPaddedStride * row + c] += matrix.values[k] * x[kPaddedStride * matrix.columns[k] + c];
    }
  }
  return b;
}

/// A mesh with springs of rest length 0 on its edges, of irregular stiffness about `stiffness`, whose
/// vertices have masses about 1: A is an M-matrix of condition about 12 · stiffness.
inline ContactProblem contact_problem(const Mesh& mesh, double stiffness, std::uint64_t seed = 1) {
  const CsrGraph graph = vertex_graph(mesh);
  Random random(seed);
  ContactProblem problem;
  std::vector<std::vector<double>> edges(graph.size());
  std::vector<double> diagonal;
  for (Index v = 0; v < graph.size(); ++v) {
    problem.masses.push_back(0.5 + random.unit());
    diagonal.push_back(problem.masses.back());
    for (const Index u : graph[v]) {
      const auto twin = std::lower_bound(graph[u].begin(), graph[u].end(), v) - graph[u].begin();
      edges[v].push_back(u > v ? stiffness * (0.5 + random.unit())
                               : edges[u][static_cast<std::size_t>(twin)]);
      diagonal[v] += edges[v].back();
    }
  }
  for (Index v = 0; v < graph.size(); ++v) {
    std::vector<std::pair<Index, double>> row{{v, diagonal[v]}};
    for (Index k = 0; k < graph.degree(v); ++k) row.emplace_back(graph[v][k], -edges[v][k]);
    std::sort(row.begin(), row.end());
    for (const auto& [column, value] : row) {
      problem.matrix.columns.push_back(column);
      problem.matrix.values.push_back(value);
    }
    problem.matrix.offsets.push_back(static_cast<Offset>(problem.matrix.columns.size()));
  }
  problem.rest = padded_positions(mesh.points);
  problem.b = product(problem.matrix, problem.rest);
  return problem;
}

/// Contacts in all directions, of one vertex or between a vertex and a triangle, some satisfied, some
/// violated.
inline void add_random_contacts(ContactProblem& problem, int count, bool with_itself, std::uint64_t seed) {
  Random random(seed);
  const auto vertex = [&] {
    return static_cast<Index>(random.below(static_cast<std::uint64_t>(problem.size())));
  };
  for (int k = 0; k < count; ++k) {
    Contact contact;
    contact.with = k;
    double length = 0.0;
    for (double& c : contact.normal) {
      c = random.unit() - 0.5;
      length += c * c;
    }
    for (double& c : contact.normal) c /= std::sqrt(length);
    contact.vertices[0] = vertex();
    contact.weights[0] = 1.0;
    if (with_itself && k % 2 == 0) {
      contact.with = -1 - k;
      const double a = random.unit(), b = random.unit() * (1 - a);
      contact.weights = {1.0, -a, -b, a + b - 1.0};
      for (std::size_t i = 1; i < 4; ++i) {
        do contact.vertices[i] = vertex();
        while (std::count(contact.vertices.begin(), contact.vertices.end(), contact.vertices[i]) > 1);
      }
    }
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t c = 0; c < 3 && contact.vertices[i] >= 0; ++c) {
        contact.offset += contact.weights[i] * contact.normal[c] *
                          problem.rest[kPaddedStride * contact.vertices[i] + static_cast<Index>(c)];
      }
    }
    contact.offset += 0.3 * random.unit() - 0.1;
    problem.contacts.push_back(contact);
  }
}

/// A for x, y and z of all vertices.
inline Eigen::MatrixXd dense_in_space(const SparseMatrix& matrix) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * matrix.size(), 3 * matrix.size());
  for (Index row = 0; row < matrix.size(); ++row) {
    for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
      for (Index c = 0; c < 3; ++c) result(3 * row + c, 3 * matrix.columns[k] + c) = matrix.values[k];
    }
  }
  return result;
}

/// A matrix with a row for each contact.
inline Eigen::MatrixXd dense_rows(const ContactProblem& problem) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(index_size(problem.contacts), 3 * problem.size());
  for (Index k = 0; k < index_size(problem.contacts); ++k) {
    const Contact& contact = problem.contacts[k];
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t c = 0; c < 3 && contact.vertices[i] >= 0; ++c)
        rows(k, 3 * contact.vertices[i] + static_cast<Index>(c)) += contact.weights[i] * contact.normal[c];
    }
  }
  return rows;
}

template <class Vector>
Eigen::VectorXd compact(const Vector& padded) {
  Eigen::VectorXd result(3 * static_cast<Eigen::Index>(padded.size()) / kPaddedStride);
  for (Eigen::Index i = 0; i < result.size(); ++i)
    result(i) = static_cast<double>(padded[static_cast<std::size_t>(kPaddedStride * (i / 3) + i % 3)]);
  return result;
}

inline Eigen::VectorXd offsets(const ContactProblem& problem) {
  Eigen::VectorXd result(index_size(problem.contacts));
  for (Index k = 0; k < index_size(problem.contacts); ++k) result(k) = problem.contacts[k].offset;
  return result;
}

/// The solution and the forces, dense.
struct DenseSolution {
  Eigen::VectorXd x, forces;
};

/// Solves by trying all sets of pushing contacts; for up to about ten contacts.
inline DenseSolution by_enumeration(const ContactProblem& problem) {
  const Eigen::LLT<Eigen::MatrixXd> factor(dense_in_space(problem.matrix));
  const Eigen::MatrixXd rows = dense_rows(problem);
  const Eigen::VectorXd free = factor.solve(compact(problem.b));
  const Eigen::VectorXd depths = offsets(problem) - rows * free;
  const Eigen::MatrixXd moves = rows * factor.solve(rows.transpose());
  const auto count = static_cast<unsigned>(problem.contacts.size());
  for (unsigned set = 0; set < 1U << count; ++set) {
    std::vector<Eigen::Index> members;
    for (unsigned k = 0; k < count; ++k) {
      if ((set >> k & 1U) != 0) members.push_back(k);
    }
    Eigen::VectorXd forces = Eigen::VectorXd::Zero(count);
    if (!members.empty()) {
      const Eigen::VectorXd some = moves(members, members).ldlt().solve(Eigen::VectorXd(depths(members)));
      forces(members) = some;
    }
    const Eigen::VectorXd left = depths - moves * forces;
    if (forces.minCoeff() >= 0.0 && left.maxCoeff() <= 1e-10)
      return {free + factor.solve(rows.transpose() * forces), forces};
  }
  return {};
}

/// Solves by cyclic coordinate descent over the contacts (Hildreth 1957).
inline DenseSolution by_coordinates(const ContactProblem& problem) {
  const Eigen::LLT<Eigen::MatrixXd> factor(dense_in_space(problem.matrix));
  const Eigen::MatrixXd rows = dense_rows(problem);
  const Eigen::VectorXd free = factor.solve(compact(problem.b));
  Eigen::VectorXd left = offsets(problem) - rows * free;
  const Eigen::MatrixXd moves = rows * factor.solve(rows.transpose());
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(left.size());
  for (int sweep = 0; sweep < 100'000; ++sweep) {
    double largest = 0.0;
    for (Eigen::Index k = 0; k < forces.size(); ++k) {
      const double change = std::max(-forces(k), left(k) / moves(k, k));
      if (change == 0.0) continue;
      forces(k) += change;
      left -= change * moves.col(k);
      largest = std::max(largest, std::abs(change));
    }
    if (largest <= 1e-14 * forces.maxCoeff()) break;
  }
  return {free + factor.solve(rows.transpose() * forces), forces};
}

}  // namespace meshorder::test
