// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/scratch.hpp"
#include "restrictions.hpp"

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace meshorder::command {

/// A private folder in which a program runs on a mesh in one order after another, with copies of the files
/// beside the mesh. Every run finds the same files at the same paths; files that a run leaves are removed.
///
/// Files beside the mesh, also in folders that links lead to, are copied, the smallest first, up to 1 GiB and
/// to a quarter of the free space. Larger ones share their blocks with yours where the file system can do
/// that; else they become links, and `protection` keeps the program from writing through them. Hidden files
/// are left out. If a folder is ordered instead of a file, each order is made in a full copy of the folder.
class TrialFolder {
 public:
  /// @param folder       folder of the mesh
  /// @param mesh         name of its file, order 0; empty if the folder itself is ordered
  /// @param with         names of the files and folders to copy from `folder`; empty: all
  /// @param is_protected whether to make a `protection`
  /// Throws InvalidArgument for a name that is not in `folder`, for more than 10,000 files, and for files
  /// that are neither copied nor protected; InputError if the disk is full.
  TrialFolder(const std::filesystem::path& folder, std::string mesh, const std::vector<std::string>& with,
              bool is_protected);

  /// Returns the program's current directory.
  [[nodiscard]] std::filesystem::path run() const { return private_.path() / "run"; }
  /// Returns the prefix of the files that receive what the program prints.
  [[nodiscard]] std::filesystem::path log() const { return private_.path() / "log"; }
  /// Returns a path for outputs, where nothing exists when a run begins.
  [[nodiscard]] std::filesystem::path output() const { return private_.path() / "out"; }
  /// Returns the program's folder for temporary files.
  [[nodiscard]] std::filesystem::path temporary() const { return private_.path() / "tmp"; }
  /// Returns the rules by which the program cannot write to the originals; null if there are none.
  [[nodiscard]] const WriteProtection* protection() const;

  /// Makes the folder of an order and returns its path; the caller writes the order's files there.
  std::filesystem::path add_order(std::size_t order);
  /// Copies all files beside the mesh into the folder of an order.
  void copy_files(std::size_t order) const;
  /// Records the files that were written for an order. Files equal to those beside the mesh are not part of
  /// the order.
  void complete_order(std::size_t order);
  /// Removes the files of the order that was added last.
  void drop_order(std::size_t order);
  /// Returns whether two orders have the same files.
  [[nodiscard]] bool is_same(std::size_t a, std::size_t b) const;

  /// Moves the files of an order into the program's directory.
  void begin_run(std::size_t order);
  /// Returns whether the program read a file of the mesh in the run that has ended, or changed one; true if
  /// this is not known, because the file system does not record it.
  [[nodiscard]] bool was_read(std::size_t order) const;
  /// If `kept` is not empty, copies the program's output files to the folder `kept`, without pipes and
  /// devices. Then moves the files of the order back, removes everything else and restores the files beside
  /// the mesh. Throws InvalidArgument if the program changed its mesh or, without protection, if an original
  /// changed.
  void end_run(std::size_t order, const std::filesystem::path& kept = {});

 private:
  /// Properties that show a change of a file.
  struct Stamp {
    std::uint64_t inode = 0;
    std::uint64_t size = 0;
    std::int64_t seconds = 0;
    std::int64_t nanoseconds = 0;
    bool operator==(const Stamp&) const = default;
  };
  struct Companion {
    std::filesystem::path source;
    bool is_copied = true;
    Stamp here;  ///< of the copy or link
  };
  struct MeshFile {
    Stamp stamp;
    std::size_t hash = 0;
  };

  static Stamp stamp_of(const std::filesystem::path& path, bool follow);
  static std::size_t hash_of(const std::filesystem::path& path);
  [[nodiscard]] std::filesystem::path folder_of_order(std::size_t order) const;
  void add_file(std::size_t order, const std::string& name);
  void move_into_orders(const std::string& name);
  void find_companions(const std::filesystem::path& folder, const std::vector<std::string>& with);
  void add_companion(const std::filesystem::path& source);
  void add_all_below(const std::filesystem::path& folder, std::vector<std::filesystem::path> above);
  void refuse_many() const;
  void choose_copies();
  void place(const std::string& name, Companion& companion) const;
  [[nodiscard]] bool is_in_place(const std::filesystem::path& folder) const;
  [[nodiscard]] std::map<std::filesystem::path, Stamp> files_of_mesh(std::size_t order) const;
  [[nodiscard]] std::map<std::filesystem::path, Stamp> stamps_of_originals() const;
  void keep(const std::filesystem::path& kept) const;
  void remove_new() const;
  void restore();

  PrivateFolder private_;
  std::filesystem::path folder_;  ///< of the mesh
  std::string name_;              ///< of the mesh; empty for a folder
  bool knows_what_is_read_;
  std::unique_ptr<const WriteProtection> protection_;
  std::map<std::string, Companion> companions_;
  std::map<std::string, std::filesystem::path>
      folders_;                                       ///< below the folder of the mesh, with their sources
  std::vector<std::filesystem::path> links_;          ///< beside the mesh
  std::map<std::filesystem::path, Stamp> originals_;  ///< before a run; empty if they are protected
  std::vector<std::map<std::string, MeshFile>> orders_;
};

}  // namespace meshorder::command
