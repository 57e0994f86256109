// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/descriptor.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// A folder beside an output for what is not complete: `.meshorder-DIGITS.new`, of mode 700, with a name that
/// nobody can guess. Its file `lock` is locked (`flock`) as long as its owner lives, also on other machines
/// that share the disk. It holds the new file, and while a set of files is put in place the old one (see
/// output_set.hpp).
class Scratch {
 public:
  /// Makes the folder beside `target`. Throws InputError if the system refuses.
  explicit Scratch(const std::filesystem::path& target);
  /// Removes it with all that is in it, unless `keep` was called.
  ~Scratch();
  Scratch(Scratch&& other) noexcept;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  Scratch& operator=(Scratch&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Returns the path of the new file.
  [[nodiscard]] std::filesystem::path file() const { return path_ / kNew; }
  /// Returns the path of another file of that name in it.
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return path_ / name; }

  /// Gives the folder another path. Returns 0 or an `errno`.
  [[nodiscard]] int rename(const std::filesystem::path& path);
  /// Leaves the folder to the next run, unless `remove` is called.
  void keep() noexcept;
  void remove();

  static constexpr std::string_view kNew = "new";
  // of the names of the folders
  static constexpr std::string_view kPrefix = ".meshorder-";
  static constexpr std::string_view kSuffix = ".new";
  static constexpr std::string_view kSuffixInSet = ".set";

 private:
  std::filesystem::path path_;
  Descriptor lock_;
  int slot_ = -1;
  bool is_kept_ = false;
};

/// A scratch folder of an owner that has died, locked by this object.
class DeadScratch {
 public:
  enum class State {
    none,     ///< there is no such folder
    foreign,  ///< it belongs to another user, or the file system knows no locks
    alive,    ///< its owner is at work
    dead,     ///< locked now
  };
  explicit DeadScratch(std::filesystem::path path);

  [[nodiscard]] State state() const noexcept { return state_; }
  /// Removes the folder with all that is in it.
  void remove() const;

 private:
  std::filesystem::path path_;
  Descriptor lock_;
  State state_ = State::none;
};

/// Returns the paths of all scratch folders in a folder, at the first call for it in a process; later none.
std::vector<std::filesystem::path> scratches_not_seen(const std::filesystem::path& folder);

/// Removes all scratch folders of this process whose files are not complete; for a signal handler that ends
/// the process, as it calls nothing but system functions that are safe there.
void remove_unfinished_outputs() noexcept;

}  // namespace meshorder
