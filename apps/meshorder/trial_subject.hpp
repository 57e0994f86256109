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

/// The mesh, or case of OpenFOAM, on which a program is tried.
class TrialSubject : public Polymorphic {
 public:
  /// Return the replacements for {} and for {stem} in the command.
  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual std::string stem() const = 0;

  /// Returns the files and folders that the command must not name, because {} stands for their copies.
  [[nodiscard]] virtual std::vector<std::filesystem::path> originals() const = 0;

  /// Returns a new folder with a copy of the subject, as the constructor of TrialFolder.
  [[nodiscard]] virtual TrialFolder folder(const std::vector<std::string>& with, bool is_protected) const = 0;

  /// Returns the orders that are tried if the user names none.
  [[nodiscard]] virtual std::vector<std::string> orders() const = 0;

  /// Throws InvalidArgument if no order has this name.
  virtual void check_order(const std::string& name) const = 0;

  /// Writes the subject in another order to the folder of order `number`, and completes `order`. Returns
  /// whether the order moves nothing. Throws CommandError if the order cannot be made.
  virtual bool make(TriedOrder& order, TrialFolder& folder, std::size_t number) const = 0;
};

/// Options for making orders.
struct OrderingOptions {
  int threads = 0;
  std::string ids = "renumber";      ///< as in `order`
  std::vector<std::string> words{};  ///< further options for `order` and `openfoam`, passed on unchanged
};

/// Returns the mesh, or the case if the path is a folder or a .foam file. Throws InvalidArgument
/// and InputError for a path that cannot be tried.
std::unique_ptr<TrialSubject> trial_subject(const std::string& path, OrderingOptions options);

}  // namespace meshorder::command
