// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include <meshorder/error.hpp>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// The reading of one mesh by the current thread: adds up what its files have and what they claim beyond
/// that, and knows where files that they name may be.
///
/// Claims of a mesh may take the limit that is given; without one 256 MiB and 100 times the size of its
/// files, but no more than `memory_limit()`. What is read outside of any scope has `memory_limit()` for each
/// claim.
class ReadScope {
 public:
  /// @param file             the mesh, for messages; must outlive this object
  /// @param memory           the limit on claims in bytes; none: as above
  /// @param include_folders  folders besides its own that may hold the files that it names
  explicit ReadScope(const FilePath& file, std::optional<std::uint64_t> memory = {},
                     std::vector<std::filesystem::path> include_folders = {});
  ~ReadScope();
  ReadScope(const ReadScope&) = delete;
  ReadScope(ReadScope&&) = delete;
  ReadScope& operator=(const ReadScope&) = delete;
  ReadScope& operator=(ReadScope&&) = delete;

 private:
  friend void count_file(const FilePath& file, std::uint64_t bytes);
  friend std::string refused_claim(std::uint64_t bytes, std::string_view what);
  friend std::string refused_for_a_while(std::uint64_t bytes, std::string_view what);
  friend void claim_memory(std::uint64_t bytes, std::string_view what, Location where);
  friend std::uint64_t limit_on_unknown_sizes();
  friend std::vector<std::filesystem::path> folders_for_includes(const std::filesystem::path& folder);

  [[nodiscard]] std::uint64_t limit() const;

  const FilePath& file_;
  std::optional<std::uint64_t> memory_;
  std::vector<std::filesystem::path> include_folders_;
  std::set<std::string> counted_;  ///< paths of files
  std::uint64_t stored_ = 0;       ///< bytes of files
  std::uint64_t claimed_ = 0;
  ReadScope* outer_;
};

/// Adds a file that was read to those of the mesh. One that is read again is a claim.
void count_file(const FilePath& file, std::uint64_t bytes);

/// How often what a file claims is in memory at a time: as it is read, in the mesh, as it moves to its new
/// order, and in the output.
inline constexpr std::uint64_t kCopiesOfClaim = 4;

/// Asks whether so many bytes more may be allocated for what a file claims rather than holds, to be called
/// before the allocation. They count `kCopiesOfClaim` times. Returns an empty text if so, else the fault,
/// "WHAT would take 64 GiB …": all claims of the mesh together would exceed its limit.
[[nodiscard]] std::string refused_claim(std::uint64_t bytes, std::string_view what);

/// The same for memory that a library takes while it reads: it counts once, and not for later claims.
[[nodiscard]] std::string refused_for_a_while(std::uint64_t bytes, std::string_view what);

/// Returns the bytes of the limit that the claims of the mesh which was read last have left.
std::uint64_t left_by_last_reading();

/// What messages advise where a claim is refused.
inline constexpr const char* kClaimRemedy =
    "if you trust the file, raise the limit on memory (--limit-memory)";

/// As `refused_claim`, but throws InputError at that place; without a file, of the mesh that is read.
void claim_memory(std::uint64_t bytes, std::string_view what, Location where = {});

/// Returns the most bytes that are read of an input whose size is not known before.
std::uint64_t limit_on_unknown_sizes();

/// Allows files below that folder to be included by all meshes that this process reads.
void allow_includes_from(std::filesystem::path folder);

/// Returns the folders that are allowed so.
const std::vector<std::filesystem::path>& allowed_include_folders();

/// Returns the folders where files may be that a file in `folder` names: this and the allowed ones.
std::vector<std::filesystem::path> folders_for_includes(const std::filesystem::path& folder);

/// Returns whether a mesh may name this file to be read: whether it is below the folder of `from` or an
/// allowed one, links and .. resolved; in memory by the names alone.
bool may_include(const FilePath& from, const FilePath& file);

/// What messages advise for a file that `may_include` refuses.
inline constexpr const char* kIncludeRemedy =
    "put it below the mesh's folder, or allow its own by --allow-includes-from";

}  // namespace meshorder
