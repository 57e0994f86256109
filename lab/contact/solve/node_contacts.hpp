// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/solve/remembered_forces.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// The contacts of each vertex that has any, a node, and their forces, for sweeps over vertices. A contact of
/// one vertex, against an obstacle, is hard: its vertex is projected. One of several ties them to each other:
/// it pushes by a force and a penalty.
class NodeContacts {
 public:
  /// `first` are first guesses of forces, `from` positions at the step's begin (kPaddedStride numbers each),
  /// `diagonal(v)` that of A. O(contacts · log contacts).
  template <class Diagonal>
  void set(std::span<const Contact> contacts, std::span<const ContactForce> first,
           std::span<const double> from, Diagonal diagonal) {
    take_contacts(contacts, first, from);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      double softness = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        const Index v = contacts[k].vertices[i];
        if (v != Contact::kAbsent) softness += contacts[k].weights[i] * contacts[k].weights[i] / diagonal(v);
      }
      penalties_[k] = 1.0 / softness;
    }
  }

  [[nodiscard]] Index size() const noexcept { return index_size(vertices_); }
  [[nodiscard]] Index vertex(Index node) const { return vertices_[node]; }
  /// Whether the node shares a contact with others.
  [[nodiscard]] bool is_tied(Index node) const { return tied_[node] != 0; }
  /// Whether there is something that `update` changes.
  [[nodiscard]] bool has_updates() const noexcept { return has_updates_; }

  /// Adds the forces of the node's ties to `force`, and a bound of their stiffness to `stiffness`.
  template <class Real>
  void add_ties(std::span<const Contact> contacts, Index node, std::span<const Real> x, Point& force,
                double& stiffness) const;

  /// x ← the nearest place that the node's hard contacts leave; their forces move it by `way` each, and with
  /// friction their tangential ones within their bounds by what they can against its motion.
  void project(std::span<const Contact> contacts, Index node, double way, Point& x);

  /// Forces of ties become what they are at x, and bounds of tangential forces what normal ones allow.
  /// Returns the norm of these changes, in that of the energy.
  template <class Real>
  double update(std::span<const Contact> contacts, std::span<const Real> x);

  /// The norm of the depths of hard contacts, in that of the energy.
  template <class Real>
  [[nodiscard]] double depth_left(std::span<const Contact> contacts, std::span<const Real> x) const;

  /// The force of each contact at x.
  template <class Real>
  void take_forces(std::span<const Contact> contacts, std::span<const Real> x,
                   std::span<ContactForce> forces) const;

 private:
  struct Entry {
    Index vertex = 0, contact = 0;
    double weight = 0.0;
  };

  void take_contacts(std::span<const Contact> contacts, std::span<const ContactForce> first,
                     std::span<const double> from);
  [[nodiscard]] std::span<const Entry> entries(Index node) const {
    return {entries_.data() + offsets_[node], entries_.data() + offsets_[node + 1]};
  }
  /// The force of a tie with its penalty, where Σ w x is `place`.
  [[nodiscard]] ContactForce pushed(const Contact& contact, Index k, const Point& place) const;
  /// Brings the force of a hard contact and x, which it moves, to where they belong; returns how far x moved.
  double meet(const Contact& contact, const Entry& entry, double way, Point& x);

  std::vector<Entry> entries_;  ///< by vertex
  std::vector<Index> offsets_;  ///< of each node among the entries
  std::vector<Index> vertices_;
  std::vector<char> tied_;
  bool has_updates_ = false;
  // of each contact
  std::vector<ContactForce> forces_;
  std::vector<Point> from_;        ///< Σ w x at the step's begin
  std::vector<double> radii_;      ///< of tangential forces
  std::vector<double> penalties_;  ///< what its vertices of themselves set against it, per m
};

}  // namespace meshorder
