// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/models/cache.hpp"

#include "base/host.hpp"
#include "base/input_file.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <sstream>
#include <string>
#include <system_error>

namespace meshorder::models {
namespace fs = std::filesystem;

namespace {

constexpr const char* kElsewhere = "set MESHORDER_CACHE to a folder that can be written";

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
  throw InputError(path.string(), what, kElsewhere);
}

/// Returns the first number of a file outside its comments; 0 if there is no such number, or no such file.
Index first_number(const fs::path& path) {
  if (std::error_code code; !fs::exists(path, code)) return 0;
  constexpr std::size_t kMost = 1 << 16;
  std::string start(kMost, '\0');
  start.resize(InputFile(path, std::array{path.parent_path()}).read(start));
  std::istringstream in(start);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word.front() == '#') continue;
    Index number = 0;
    std::istringstream(word) >> number;
    return number;
  }
  return 0;
}

}  // namespace

fs::path cache_folder() {
  if (fs::path folder = user_cache_folder(); !folder.empty()) return folder;
  refuse("models", "neither HOME nor XDG_CACHE_HOME is set, so there is no folder to store them");
}

void make_folder(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code || !fs::is_directory(folder)) {
    refuse(folder, "cannot be made" + (code ? ": " + code.message() : std::string()));
  }
}

MakingLock::MakingLock(const fs::path& folder, std::string_view name)
    : file_(::open((folder / ("." + std::string(name) + ".lock")).c_str(),
                   O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644)) {
  if (file_ < 0) refuse(folder, "cannot be written: " + std::generic_category().message(errno));
  // on a file system without locks (ENOLCK), continues without a lock
  while (::flock(file_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

MakingLock::~MakingLock() { ::close(file_); }

ScratchFolder::ScratchFolder(const fs::path& folder, std::string_view name)
    : path_(folder / ("." + std::string(name) + ".making")) {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  make_folder(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

Counts counts_of(const fs::path& node_file) {
  fs::path ele_file = node_file;
  ele_file.replace_extension(".ele");
  const Counts counts{first_number(node_file), first_number(ele_file)};
  return counts.vertices > 0 && counts.elements > 0 ? counts : Counts{};
}

void publish(const fs::path& from, const fs::path& to) {
  // the .node file is removed first and moved last: without it the model does not exist
  std::error_code ignored;
  fs::remove(fs::path(to) += ".node", ignored);
  for (const std::string_view extension : {".ele", ".node"}) {
    fs::path source = from;
    fs::path target = to;
    source += extension;
    target += extension;
    std::error_code code;
    fs::rename(source, target, code);
    if (code) refuse(target, "cannot be written: " + code.message());
  }
}

}  // namespace meshorder::models
