// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/polymorphic.hpp"
#include "trial_folder.hpp"
#include "try_report.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace meshorder::command {

/// What a program is tried on: a mesh, or a case of OpenFOAM.
class TrialSubject : public Polymorphic {
 public:
  /// Returns what replaces {} in the command, and what replaces {stem}.
  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual std::string stem() const = 0;

  /// Returns a new folder with a copy of it.
  [[nodiscard]] virtual TrialFolder folder(const std::vector<std::string>& with) const = 0;

  /// Returns the orders that are tried where none are named.
  [[nodiscard]] virtual std::vector<std::string> orders() const = 0;

  /// Throws InvalidArgument for an order that there is not.
  virtual void check_order(const std::string& name) const = 0;

  /// Writes it in another order, the one of that number in the folder, and completes `order`. Returns whether
  /// that is its own order, in which everything stays. Throws CommandError where the order cannot be made.
  virtual bool make(TriedOrder& order, TrialFolder& folder, std::size_t number) const = 0;
};

/// How orders are made.
struct OrderingOptions {
  int threads = 0;
  std::string ids = "renumber";      ///< as in `order`
  std::vector<std::string> words{};  ///< further options of `order` and `openfoam`, passed on as they are
};

/// Returns the mesh, or the case where the path is that of a folder or a .foam file. Throws InvalidArgument
/// and InputError for what cannot be tried.
std::unique_ptr<TrialSubject> trial_subject(const std::string& path, OrderingOptions options);

}  // namespace meshorder::command
