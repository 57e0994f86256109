// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "trial_folder.hpp"

#include "base/input_file.hpp"
#include "io/stream/descriptor.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#ifdef __linux__
#include <linux/fs.h>
#include <sys/ioctl.h>
#endif

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostCopied = std::uintmax_t{1} << 30U;
constexpr std::uintmax_t kPartOfFreeSpace = 4;
constexpr std::size_t kMostFiles = 10'000;
constexpr std::string_view kMeshOfCase = "constant/polyMesh/";

bool is_hidden(const fs::path& path) { return path.filename().string().starts_with('.'); }

/// Returns whether a folder is the other one or contains it; both paths are canonical.
bool contains(const fs::path& folder, const fs::path& other) {
  return *other.lexically_relative(folder).begin() != "..";
}

/// Makes a new file that shares its blocks with another until one of them is changed. Returns whether the
/// file system can do that.
bool clone(const fs::path& from, const fs::path& to) {
#ifdef FICLONE
  struct stat status {};
  const Descriptor source(from, O_RDONLY);
  if (!source.is_open() || ::fstat(source.get(), &status) != 0) return false;
  const Descriptor copy(to, O_WRONLY | O_CREAT | O_EXCL, status.st_mode & ALLPERMS);
  if (copy.is_open() && ::ioctl(copy.get(), FICLONE, source.get()) == 0) return true;
  if (copy.is_open()) ::unlink(to.c_str());
#else
  (void)from;
  (void)to;
#endif
  return false;
}

/// Copies a file, if possible by `clone`. Throws filesystem_error.
void copy_to(const fs::path& from, const fs::path& to) {
  if (!clone(from, to)) fs::copy_file(from, to);
}

void forget_reading(const fs::path& file) {
  const std::array<timespec, 2> times{timespec{.tv_sec = 1, .tv_nsec = 0},
                                      timespec{.tv_sec = 0, .tv_nsec = UTIME_OMIT}};
  (void)::utimensat(AT_FDCWD, file.c_str(), times.data(), AT_SYMLINK_NOFOLLOW);
}

/// Returns whether a file was read after `forget_reading`.
bool was_read_since(const fs::path& file) {
  struct stat status {};
#ifdef __APPLE__
  return ::lstat(file.c_str(), &status) == 0 && status.st_atimespec.tv_sec != 1;
#else
  return ::lstat(file.c_str(), &status) == 0 && status.st_atim.tv_sec != 1;
#endif
}

/// Returns whether the file system of a folder records that a file was read, also if it was copied.
bool records_reading(const fs::path& folder) {
  const fs::path probe = folder / "probe";
  const fs::path copy = folder / "copy";
  const Descriptor file(probe, O_WRONLY | O_CREAT | O_EXCL, S_IRUSR | S_IWUSR);
  if (!file.is_open() || file.write("probe") != 0) return false;
  forget_reading(probe);
  const bool was_read_before = was_read_since(probe);
  copy_to(probe, copy);
  const bool is_recorded = !was_read_before && was_read_since(probe);
  fs::remove(probe);
  fs::remove(copy);
  return is_recorded;
}

}  // namespace

TrialFolder::TrialFolder(const fs::path& folder, std::string mesh, const std::vector<std::string>& with,
                         bool is_protected)
    : folder_(fs::canonical(folder)),
      name_(std::move(mesh)),
      knows_what_is_read_(records_reading(private_.path())) {
  fs::create_directory(run());
  fs::create_directory(temporary());
  find_companions(folder_, with);
  companions_.erase(name_);
  std::vector<fs::path> originals{folder_};
  originals.insert(originals.end(), links_.begin(), links_.end());
  if (!name_.empty()) originals.push_back(folder_ / name_);
  if (is_protected) protection_ = std::make_unique<const WriteProtection>(originals, private_.path());
  choose_copies();
  for (const auto& [name, source] : folders_) fs::create_directories(run() / name);
  for (auto& [name, companion] : companions_) place(name, companion);
  add_order(0);
  if (name_.empty()) return;
  copy_to(folder_ / name_, folder_of_order(0) / name_);
  complete_order(0);
}

const WriteProtection* TrialFolder::protection() const {
  return protection_ && protection_->is_possible() ? protection_.get() : nullptr;
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

void TrialFolder::add_companion(const fs::path& source) {
  std::error_code ignored;
  if (!fs::is_regular_file(source, ignored)) return;  // a device, a pipe or a link to nowhere
  if (fs::is_symlink(source, ignored)) links_.push_back(source);
  companions_[source.lexically_relative(folder_).string()].source = source;
  refuse_many();
}

void TrialFolder::refuse_many() const {
  if (companions_.size() + folders_.size() <= kMostFiles) return;
  throw InvalidArgument(
      fmt::format("{}: more than {} files are beside the mesh; name those that the program needs by "
                  "--with, or put them and the mesh into a separate folder",
                  folder_.string(), kMostFiles));
}

/// Adds the files below a folder, also in folders that links lead to. Leaves out hidden files, and links to
/// folders that contain the link. `above` are the canonical paths of the folders above.
void TrialFolder::add_all_below(const fs::path& folder, std::vector<fs::path> above) {
  std::error_code code;
  above.push_back(fs::canonical(folder, code));
  if (code) return;
  if (folder != folder_) folders_[folder.lexically_relative(folder_).string()] = folder;
  refuse_many();
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    std::error_code ignored;
    if (is_hidden(entry->path())) continue;
    if (!entry->is_directory(ignored)) {
      add_companion(entry->path());
      continue;
    }
    if (entry->is_symlink(ignored)) {
      const fs::path target = fs::canonical(entry->path(), ignored);
      if (std::ranges::any_of(above, [&](const fs::path& other) { return contains(target, other); }))
        continue;
      links_.push_back(entry->path());
    }
    add_all_below(entry->path(), above);
  }
}

void TrialFolder::find_companions(const fs::path& folder, const std::vector<std::string>& with) {
  if (with.empty()) add_all_below(folder, {});
  for (const std::string& name : with) {
    const fs::path path = folder / name;
    std::error_code ignored;
    if (name.find('/') != std::string::npos || name == ".." || !fs::exists(path, ignored))
      throw InvalidArgument(fmt::format("--with {}: there is no such file or folder beside the mesh", name));
    if (!fs::is_directory(path, ignored)) {
      add_companion(path);
      continue;
    }
    if (fs::is_symlink(path, ignored)) links_.push_back(path);
    add_all_below(path, {});
  }
}

/// Returns whether a folder below the program's directory is there, and no link leads out of that directory.
bool TrialFolder::is_in_place(const fs::path& folder) const {
  std::error_code code;
  const fs::path place = fs::canonical(private_.path(), code) / folder.lexically_relative(private_.path());
  return fs::canonical(folder, code) == place;
}

/// Chooses the files that are copied, the smallest first. Throws InvalidArgument if others would be writable.
void TrialFolder::choose_copies() {
  std::vector<std::pair<std::uintmax_t, std::string>> sizes;
  std::error_code ignored;
  for (const auto& [name, companion] : companions_)
    sizes.emplace_back(fs::file_size(companion.source, ignored), name);
  std::sort(sizes.begin(), sizes.end());
  const std::uintmax_t most = std::min(kMostCopied, fs::space(private_.path()).available / kPartOfFreeSpace);
  std::uintmax_t copied = 0;
  for (const auto& [size, name] : sizes) {
    Companion& companion = companions_[name];
    copied += size;
    const fs::path probe = private_.path() / "probe";
    if (copied <= most || clone(companion.source, probe)) {
      fs::remove(probe, ignored);
      continue;
    }
    if (protection() == nullptr) {
      throw InvalidArgument(fmt::format(
          "{}: it and the other files beside the mesh are too large to copy, and nothing would keep "
          "the program from writing to them; name the files that the program needs by --with, or "
          "set TMPDIR to a folder with more room",
          companion.source.string()));
    }
    companion.is_copied = false;
  }
}

void TrialFolder::place(const std::string& name, Companion& companion) const {
  const fs::path here = run() / name;
  std::error_code code;
  fs::create_directories(here.parent_path(), code);
  fs::remove_all(here, code);
  if (companion.is_copied) {
    if (!clone(companion.source, here)) fs::copy_file(companion.source, here, code);
    if (code && code != std::errc::permission_denied && code != std::errc::no_such_file_or_directory)
      throw fs::filesystem_error("", here, code);  // else, the program could not read the file either
  } else {
    fs::create_symlink(companion.source, here);
  }
  companion.here = stamp_of(here, false);
}

fs::path TrialFolder::add_order(std::size_t order) {
  fs::create_directory(folder_of_order(order));
  if (orders_.size() <= order) orders_.resize(order + 1);
  return folder_of_order(order);
}

void TrialFolder::copy_files(std::size_t order) const {
  for (const auto& [name, source] : folders_) fs::create_directories(folder_of_order(order) / name);
  for (const auto& [name, companion] : companions_) {
    const fs::path here = folder_of_order(order) / name;
    fs::create_directories(here.parent_path());
    copy_to(companion.source, here);
  }
  for (const auto& [name, file] : orders_[0]) {
    fs::create_directories((folder_of_order(order) / name).parent_path());
    copy_to(folder_of_order(0) / name, folder_of_order(order) / name);
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
    copy_to(companions_[name].source, path);
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

/// Returns the copies of the mesh in the program's directory.
std::map<fs::path, TrialFolder::Stamp> TrialFolder::files_of_mesh(std::size_t order) const {
  std::map<fs::path, Stamp> files;
  for (const auto& [name, file] : orders_[order]) {
    if (!name_.empty() || name.starts_with(kMeshOfCase)) files[run() / name] = file.stamp;
  }
  for (const auto& [name, companion] : companions_) {
    if (name_.empty() && name.starts_with(kMeshOfCase)) files[run() / name] = companion.here;
  }
  return files;
}

std::map<fs::path, TrialFolder::Stamp> TrialFolder::stamps_of_originals() const {
  std::map<fs::path, Stamp> stamps{{folder_, stamp_of(folder_, true)}};
  if (!name_.empty()) stamps[folder_ / name_] = stamp_of(folder_ / name_, true);
  for (const auto& [name, source] : folders_) stamps[source] = stamp_of(source, true);
  for (const auto& [name, companion] : companions_)
    stamps[companion.source] = stamp_of(companion.source, true);
  return stamps;
}

void TrialFolder::begin_run(std::size_t order) {
  for (const auto& [name, file] : orders_[order]) {
    fs::create_directories((run() / name).parent_path());
    fs::rename(folder_of_order(order) / name, run() / name);
  }
  for (const auto& [file, stamp] : files_of_mesh(order)) forget_reading(file);
  if (protection() == nullptr) originals_ = stamps_of_originals();
}

bool TrialFolder::was_read(std::size_t order) const {
  if (!knows_what_is_read_) return true;
  return std::ranges::any_of(files_of_mesh(order), [](const auto& file) {
    const auto& [path, stamp] = file;
    return fs::is_symlink(path) || stamp_of(path, false) != stamp || was_read_since(path);
  });
}

void TrialFolder::end_run(std::size_t order, const fs::path& kept) {
  if (protection() == nullptr) {
    const std::map<fs::path, Stamp> now = stamps_of_originals();
    const auto changed = std::ranges::find_if(
        originals_, [&](const auto& original) { return now.at(original.first) != original.second; });
    if (changed != originals_.end()) {
      throw InvalidArgument(
          fmt::format("{}: it changed while the program ran; have the program write to {{out}} or to its "
                      "current folder",
                      changed->first.string()));
    }
  }
  if (!is_in_place(run())) throw InvalidArgument("the program replaces the folder that it runs in");
  std::string changed;
  if (!kept.empty()) keep(kept);
  for (auto& [name, file] : orders_[order]) {
    const fs::path here = run() / name;
    const Stamp now = stamp_of(here, false);
    if (!is_in_place(here.parent_path()) ||
        (now != file.stamp &&
         (!fs::is_regular_file(fs::symlink_status(here)) || hash_of(here) != file.hash))) {
      changed = name;
      continue;
    }
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
  const auto keep_entry = [&](const fs::path& from, const fs::path& to) {
    const fs::file_status status = fs::symlink_status(from);
    if (!fs::is_regular_file(status) && !fs::is_symlink(status)) return;
    fs::create_directories(to.parent_path());
    fs::copy(from, to, fs::copy_options::copy_symlinks);
  };
  fs::create_directories(kept);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(run())) {
    const fs::path name = entry.path().lexically_relative(run());
    const auto companion = companions_.find(name.string());
    if (companion == companions_.end() || stamp_of(entry.path(), false) != companion->second.here)
      keep_entry(entry.path(), kept / name);
  }
  if (!fs::is_directory(fs::symlink_status(output()))) {
    if (fs::exists(fs::symlink_status(output()))) keep_entry(output(), kept / "out");
  } else {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(output()))
      keep_entry(entry.path(), kept / "out" / entry.path().lexically_relative(output()));
  }
  fs::copy_file(log().string() + ".out", kept / "stdout.txt", fs::copy_options::overwrite_existing);
  fs::copy_file(log().string() + ".err", kept / "stderr.txt", fs::copy_options::overwrite_existing);
}

void TrialFolder::remove_new() const {
  std::error_code ignored;
  fs::remove_all(output(), ignored);
  fs::remove_all(temporary(), ignored);
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
  fs::create_directories(temporary());
  for (auto& [name, companion] : companions_) {
    if (stamp_of(run() / name, false) != companion.here) place(name, companion);
  }
  for (const auto& [name, source] : folders_) fs::create_directories(run() / name);
}

}  // namespace meshorder::command
