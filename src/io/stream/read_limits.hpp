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

/// The reading of one mesh by the current thread. Sums the sizes of the mesh's files and the claims: memory
/// for data that these files announce but do not hold. Lists the folders whose files the mesh may name.
///
/// All claims of a mesh together must not exceed a limit: `memory`, else the limit given to the process, else
/// 256 MiB plus 100 times the total size of the files, but at most `memory_limit()`. Without a ReadScope,
/// each single claim may take `memory_limit()`.
class ReadScope {
 public:
  /// @param file             the mesh, for messages; must outlive this object
  /// @param memory           the limit on claims in bytes; if empty, the default above
  /// @param include_folders  further folders for files that the mesh names, besides its own folder
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
  std::set<std::string> counted_;  ///< paths of the files read so far
  std::uint64_t stored_ = 0;       ///< total size of these files in bytes
  std::uint64_t claimed_ = 0;
  ReadScope* outer_;
};

/// Counts a file that was read as part of the mesh. Reading the file again counts as a claim.
void count_file(const FilePath& file, std::uint64_t bytes);

/// Number of copies of claimed data that may be in memory at the same time: in the reader, in the mesh, in
/// the reordered mesh and in the output.
inline constexpr std::uint64_t kCopiesOfClaim = 4;

/// Claims memory for data that a file announces but does not hold. Call it before the allocation. The bytes
/// count `kCopiesOfClaim` times. If all claims of the mesh together would exceed the limit, claims nothing
/// and returns the fault, "WHAT would take 64 GiB …"; else returns an empty text.
[[nodiscard]] std::string refused_claim(std::uint64_t bytes, std::string_view what);

/// As `refused_claim`, for memory that a library needs only while it reads: the bytes count once, and later
/// claims do not include them.
[[nodiscard]] std::string refused_for_a_while(std::uint64_t bytes, std::string_view what);

/// Returns how many bytes of the limit were unclaimed after this process last read a mesh.
std::uint64_t left_by_last_reading();

/// The advice in messages about a claim that is refused.
inline constexpr const char* kClaimRemedy = "if you trust the file, raise the memory limit (--limit-memory)";

/// As `refused_claim`, but throws InputError at `where`; if `where` has no file, names the mesh that is being
/// read.
void claim_memory(std::uint64_t bytes, std::string_view what, Location where = {});

/// Returns the limit in bytes on an input whose size is not known before it is read.
std::uint64_t limit_on_unknown_sizes();

/// Lets all meshes that this process reads include files below `folder`.
void allow_includes_from(std::filesystem::path folder);

/// Returns the folders that `allow_includes_from` has allowed.
const std::vector<std::filesystem::path>& allowed_include_folders();

/// Returns the folders that may hold files named by a file in `folder`: `folder` and all allowed folders.
std::vector<std::filesystem::path> folders_for_includes(const std::filesystem::path& folder);

/// Returns whether the mesh `from` may name `file` as a file to read: `file` must be below the folder of
/// `from` or an allowed folder, after links and .. are resolved. For files in a store only the names count.
bool may_include(const FilePath& from, const FilePath& file);

/// The advice in messages about a file that `may_include` refuses.
inline constexpr const char* kIncludeRemedy =
    "put it below the mesh's folder, or allow its own with --allow-includes-from";

}  // namespace meshorder
