// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "trial_folder.hpp"

#include "base/input_file.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostCopied = std::uintmax_t{64} << 20U;
constexpr std::size_t kMostFiles = 10'000;

bool is_hidden(const fs::path& path) { return path.filename().string().starts_with('.'); }

/// Calls `take` with the files and links below a folder, except hidden ones. If `enters`, also calls it with
/// the files in folders that links lead to.
void for_each_file(const fs::path& folder, bool enters,
                   const std::function<void(const fs::directory_entry&)>& take) {
  std::error_code code;
  auto options = fs::directory_options::skip_permission_denied;
  if (enters) options |= fs::directory_options::follow_directory_symlink;
  for (fs::recursive_directory_iterator entry(folder, options, code), end; !code && entry != end;
       entry.increment(code)) {
    if (is_hidden(entry->path())) {
      entry.disable_recursion_pending();
    } else if (std::error_code ignored; entry->is_symlink(ignored) || entry->is_regular_file(ignored)) {
      take(*entry);
    }
  }
}

}  // namespace

TrialFolder::TrialFolder(const fs::path& folder, std::string mesh, const std::vector<std::string>& with)
    : name_(std::move(mesh)) {
  fs::create_directory(run());
  find_companions(fs::absolute(folder), with);
  companions_.erase(name_);
  for (auto& [name, companion] : companions_) place(name, companion);
  add_order(0);
  if (name_.empty()) return;
  fs::copy_file(folder / name_, folder_of_order(0) / name_);
  complete_order(0);
}

fs::path TrialFolder::folder_of_order(std::size_t order) const {
  return private_.path() / fmt::format("order{}", order);
}

TrialFolder::Stamp TrialFolder::stamp_of(const fs::path& path, bool follow) {
  struct stat status {};
  const int failed = follow ? ::stat(path.c_str(), &status) : ::lstat(path.c_str(), &status);
  if (failed != 0) return {};
#ifdef __APPLE__
  const timespec time = status.st_mtimespec;
#else
  const timespec time = status.st_mtim;
#endif
  return {status.st_ino, static_cast<std::uint64_t>(status.st_size), time.tv_sec, time.tv_nsec};
}

std::size_t TrialFolder::hash_of(const fs::path& path) {
  constexpr std::size_t kBlock = std::size_t{1} << 20U;
  constexpr std::size_t kFactor = 1099511628211U;
  InputFile file(path);
  std::string block(kBlock, '\0');
  std::size_t hash = 0;
  for (std::size_t read = 0; (read = file.read(block)) > 0;)
    hash = hash * kFactor + std::hash<std::string_view>{}(std::string_view(block).substr(0, read));
  return hash;
}

void TrialFolder::find_companions(const fs::path& folder, const std::vector<std::string>& with) {
  // an order is made in a copy of the folder, so no link there may lead out of it
  const bool enters = name_.empty();
  std::vector<std::pair<std::uintmax_t, std::string>> sizes;
  const auto add = [&](const fs::directory_entry& entry) {
    std::error_code ignored;
    const std::string name = entry.path().lexically_relative(folder).string();
    const bool is_file = entry.is_regular_file(ignored);
    // skips devices, links to nowhere, and links to folders that are entered
    if (!is_file && (enters || !entry.is_directory(ignored))) return;
    sizes.emplace_back(is_file ? entry.file_size(ignored) : kMostCopied, name);
    companions_[name].source = entry.path();
    if (companions_.size() <= kMostFiles) return;
    throw InvalidArgument(
        fmt::format("{}: more than {} files are beside the mesh; name those that the program needs by "
                    "--with, or put them and the mesh into a separate folder",
                    folder.string(), kMostFiles));
  };
  if (with.empty()) for_each_file(folder, enters, add);
  for (const std::string& name : with) {
    const fs::directory_entry entry(folder / name);
    if (name.find('/') != std::string::npos || name == ".." || !entry.exists())
      throw InvalidArgument(fmt::format("--with {}: there is no such file or folder beside the mesh", name));
    if (entry.is_regular_file() || entry.is_symlink()) add(entry);
    if (entry.is_directory() && (enters || !entry.is_symlink())) for_each_file(entry.path(), enters, add);
  }
  std::sort(sizes.begin(), sizes.end());
  std::uintmax_t copied = 0;
  for (const auto& [size, name] : sizes) {
    if (name == name_) continue;
    companions_[name].is_copied = size < kMostCopied && copied + size <= kMostCopied;
    copied += size;
  }
}

void TrialFolder::place(const std::string& name, Companion& companion) const {
  const fs::path here = run() / name;
  std::error_code ignored;
  fs::create_directories(here.parent_path(), ignored);
  fs::remove_all(here, ignored);
  if (companion.is_copied) {
    fs::copy_file(companion.source, here, ignored);  // on failure, the program could not read the file either
  } else {
    fs::create_symlink(companion.source, here, ignored);
    companion.there = stamp_of(companion.source, true);
  }
  companion.here = stamp_of(here, false);
}

fs::path TrialFolder::add_order(std::size_t order) {
  fs::create_directory(folder_of_order(order));
  if (orders_.size() <= order) orders_.resize(order + 1);
  return folder_of_order(order);
}

void TrialFolder::copy_files(std::size_t order) const {
  for (const auto& [name, companion] : companions_) {
    const fs::path here = folder_of_order(order) / name;
    fs::create_directories(here.parent_path());
    fs::copy_file(companion.source, here);
  }
  for (const auto& [name, file] : orders_[0]) {
    fs::create_directories((folder_of_order(order) / name).parent_path());
    fs::copy_file(folder_of_order(0) / name, folder_of_order(order) / name);
  }
}

void TrialFolder::add_file(std::size_t order, const std::string& name) {
  const fs::path path = folder_of_order(order) / name;
  orders_[order][name] = {stamp_of(path, false), hash_of(path)};
}

/// Adds a file beside the mesh to all orders that lack it, because the file differs in some order.
void TrialFolder::move_into_orders(const std::string& name) {
  for (std::size_t order = 0; order < orders_.size(); ++order) {
    const fs::path path = folder_of_order(order) / name;
    if (orders_[order].contains(name) || fs::exists(path)) continue;
    fs::create_directories(path.parent_path());
    fs::copy_file(companions_[name].source, path);
    add_file(order, name);
  }
  fs::remove(run() / name);
  companions_.erase(name);
}

void TrialFolder::complete_order(std::size_t order) {
  std::vector<std::string> written;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_of_order(order))) {
    if (entry.is_regular_file() && !entry.is_symlink())
      written.push_back(entry.path().lexically_relative(folder_of_order(order)).string());
  }
  for (const std::string& name : written) {
    const fs::path path = folder_of_order(order) / name;
    const auto companion = companions_.find(name);
    if (companion != companions_.end() && hash_of(path) == hash_of(companion->second.source)) {
      fs::remove(path);
      continue;
    }
    add_file(order, name);
    if (companion != companions_.end()) move_into_orders(name);
  }
}

void TrialFolder::drop_order(std::size_t order) {
  fs::remove_all(folder_of_order(order));
  orders_.resize(order);
}

bool TrialFolder::is_same(std::size_t a, std::size_t b) const {
  return std::equal(orders_[a].begin(), orders_[a].end(), orders_[b].begin(), orders_[b].end(),
                    [](const auto& x, const auto& y) {
                      return x.first == y.first && x.second.hash == y.second.hash &&
                             x.second.stamp.size == y.second.stamp.size;
                    });
}

void TrialFolder::begin_run(std::size_t order) {
  for (const auto& [name, file] : orders_[order]) {
    fs::create_directories((run() / name).parent_path());
    fs::rename(folder_of_order(order) / name, run() / name);
  }
}

void TrialFolder::end_run(std::size_t order, const fs::path& kept) {
  std::string changed;
  if (!kept.empty()) keep(kept);
  for (auto& [name, file] : orders_[order]) {
    const fs::path here = run() / name;
    const Stamp now = stamp_of(here, false);
    if (now != file.stamp && (!fs::is_regular_file(fs::symlink_status(here)) || hash_of(here) != file.hash))
      changed = name;
    file.stamp = now;
    std::error_code ignored;
    fs::rename(here, folder_of_order(order) / name, ignored);
  }
  if (!changed.empty()) {
    throw InvalidArgument(
        fmt::format("the program changes its mesh, {}: only programs that do not change it can be tried, "
                    "such as one that works on a copy",
                    changed));
  }
  remove_new();
  restore();
}

void TrialFolder::keep(const fs::path& kept) const {
  constexpr auto kOptions = fs::copy_options::recursive | fs::copy_options::copy_symlinks;
  fs::create_directories(kept);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(run())) {
    const fs::path name = entry.path().lexically_relative(run());
    const auto companion = companions_.find(name.string());
    const bool is_as_it_was =
        companion != companions_.end() && stamp_of(entry.path(), false) == companion->second.here;
    if (is_as_it_was || fs::is_directory(entry.symlink_status())) continue;
    fs::create_directories((kept / name).parent_path());
    fs::copy(entry.path(), kept / name, kOptions);
  }
  if (fs::exists(output())) fs::copy(output(), kept / "out", kOptions);
  fs::copy_file(log().string() + ".out", kept / "stdout.txt", fs::copy_options::overwrite_existing);
  fs::copy_file(log().string() + ".err", kept / "stderr.txt", fs::copy_options::overwrite_existing);
}

void TrialFolder::remove_new() const {
  std::error_code ignored;
  fs::remove_all(output(), ignored);
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(run()))
    found.push_back(entry.path());
  std::reverse(found.begin(), found.end());  // files before their folders
  for (const fs::path& path : found) {
    const std::string name = path.lexically_relative(run()).string();
    if (!companions_.contains(name)) fs::remove(path, ignored);  // does not remove folders that are not empty
  }
}

void TrialFolder::restore() {
  for (auto& [name, companion] : companions_) {
    if (!companion.is_copied && stamp_of(companion.source, true) != companion.there &&
        !fs::is_directory(companion.source)) {
      throw InvalidArgument(
          fmt::format("{}: it changed while the program ran; the file is large, so the program saw it "
                      "through a link; have the program write to {{out}}",
                      companion.source.string()));
    }
    if (stamp_of(run() / name, false) != companion.here) place(name, companion);
  }
}

}  // namespace meshorder::command
