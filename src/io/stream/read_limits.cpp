// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/read_limits.hpp"

#include "base/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <utility>

namespace meshorder {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLeastLimit = std::uint64_t{256} << 20;
constexpr std::uint64_t kMultiple = 100;  // bytes of memory for each byte of the files

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): one for each thread
thread_local ReadScope* current_reading = nullptr;
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): one for the process
std::atomic<std::uint64_t> left_by_last = UINT64_MAX;

std::vector<fs::path>& folders_of_process() {
  static std::vector<fs::path> folders;
  return folders;
}

bool is_below_by_name(const fs::path& path, const fs::path& folder) {
  const fs::path rest =
      path.lexically_normal().lexically_relative(folder.empty() ? fs::path(".") : folder.lexically_normal());
  return !rest.empty() && *rest.begin() != "..";
}

}  // namespace

ReadScope::ReadScope(const FilePath& file, std::optional<std::uint64_t> memory,
                     std::vector<fs::path> include_folders)
    : file_(file),
      memory_(memory),
      include_folders_(std::move(include_folders)),
      outer_(std::exchange(current_reading, this)) {}

ReadScope::~ReadScope() {
  current_reading = outer_;
  const std::uint64_t all = limit();
  left_by_last = all - std::min(all, claimed_);
}

std::uint64_t left_by_last_reading() { return left_by_last; }

std::uint64_t ReadScope::limit() const {
  if (memory_) return *memory_;
  const MemoryLimit of_process = memory_limit();
  if (of_process.is_given) return of_process.bytes;
  const std::uint64_t multiple = bytes_for(stored_, kMultiple);
  return std::min(of_process.bytes, std::max(multiple, multiple + kLeastLimit));
}

void count_file(const FilePath& file, std::uint64_t bytes) {
  ReadScope* const reading = current_reading;
  if (reading == nullptr) return;
  if (reading->counted_.insert(file.path().lexically_normal().string()).second) {
    reading->stored_ += bytes;
  } else {
    const std::string fault = refused_for_a_while(bytes, "the file, which is read again,");
    if (!fault.empty()) throw InputError(file.string(), fault, kClaimRemedy);
    reading->claimed_ += bytes;
  }
}

std::string refused_claim(std::uint64_t bytes, std::string_view what) {
  const std::uint64_t claim = bytes_for(kCopiesOfClaim, bytes);
  std::string fault = refused_for_a_while(claim, what);
  if (fault.empty() && current_reading != nullptr) current_reading->claimed_ += claim;
  return fault;
}

std::string refused_for_a_while(std::uint64_t bytes, std::string_view what) {
  const ReadScope* const reading = current_reading;
  const std::uint64_t limit = reading != nullptr ? reading->limit() : memory_limit().bytes;
  const std::uint64_t before = reading != nullptr ? reading->claimed_ : 0;
  if (bytes <= limit && before <= limit - bytes) return {};
  return fmt::format("{} would take {}{}, more than the limit of {}", what, size_text(bytes),
                     before > 0 ? fmt::format(" in addition to {}", size_text(before)) : "",
                     size_text(limit));
}

void claim_memory(std::uint64_t bytes, std::string_view what, Location where) {
  const std::string fault = refused_claim(bytes, what);
  if (fault.empty()) return;
  if (where.file.empty() && current_reading != nullptr) where.file = current_reading->file_.string();
  throw InputError(std::move(where), fault, kClaimRemedy);
}

std::uint64_t limit_on_unknown_sizes() {
  const ReadScope* const reading = current_reading;
  return reading != nullptr && reading->memory_ ? *reading->memory_ : memory_limit().bytes;
}

void allow_includes_from(fs::path folder) { folders_of_process().push_back(std::move(folder)); }

const std::vector<fs::path>& allowed_include_folders() { return folders_of_process(); }

std::vector<fs::path> folders_for_includes(const fs::path& folder) {
  std::vector<fs::path> folders = folders_of_process();
  if (const ReadScope* const reading = current_reading; reading != nullptr) {
    folders.insert(folders.begin(), reading->include_folders_.begin(), reading->include_folders_.end());
  }
  folders.insert(folders.begin(), folder);
  return folders;
}

bool may_include(const FilePath& from, const FilePath& file) {
  const std::vector<fs::path> folders = folders_for_includes(from.path().parent_path());
  if (file.store() == nullptr) return real_path_below(file.path(), folders).has_value();
  return std::any_of(folders.begin(), folders.end(),
                     [&](const fs::path& folder) { return is_below_by_name(file.path(), folder); });
}

}  // namespace meshorder
