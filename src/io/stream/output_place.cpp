// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/output_place.hpp"

#include "io/stream/descriptor.hpp"
#include <meshorder/error.hpp>

#include <sys/stat.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/xattr.h>
#endif

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

constexpr int kMostLinks = 40;
constexpr mode_t kModeBits = 07777;

/// Returns N for /dev/fd/N and /proc/self/fd/N, −1 for other paths.
int own_descriptor(const fs::path& path) {
  const std::string text = path.string();
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    int number = 0;
    const char* const end = text.data() + text.size();
    if (!text.starts_with(folder)) continue;
    const auto [stop, error] = std::from_chars(text.data() + folder.size(), end, number);
    if (error == std::errc() && stop == end && number >= 0) return number;
  }
  return -1;
}

/// Throws InputError for a link in a folder like /tmp, unless the link belongs to this user or the folder's
/// owner. The kernel's protected_symlinks does the same.
void refuse_link_of_others(const fs::path& link) {
  struct stat folder {};
  struct stat own {};
  if (::stat(folder_of(link).c_str(), &folder) != 0 || ::lstat(link.c_str(), &own) != 0) return;
  const bool is_open_to_all = (folder.st_mode & S_ISVTX) != 0 && (folder.st_mode & S_IWOTH) != 0;
  if (!is_open_to_all || own.st_uid == ::geteuid() || own.st_uid == folder.st_uid) return;
  throw InputError(link.string(), "is a symbolic link of another user in a folder open to all",
                   "name the file itself");
}

/// Throws InputError if a part of the path that this program named is a symbolic link: another user may have
/// put the link there to make this program replace another file.
void refuse_links_in_derived(const FilePath& file) {
  if (!file.folder()) return;
  fs::path path = file.path();
  const fs::path folder = file.folder()->empty() ? fs::path(".") : file.folder()->lexically_normal();
  const fs::path derived = path.lexically_normal().lexically_relative(folder);
  for (auto names = std::distance(derived.begin(), derived.end()); names > 0; --names) {
    struct stat status {};
    if (::lstat(path.c_str(), &status) == 0 && S_ISLNK(status.st_mode)) {
      throw InputError(path.string(),
                       "is a symbolic link, and links are followed only in names that you give",
                       "remove it or choose another name");
    }
    path = path.parent_path();
  }
}

/// Returns the target of the link `path`, joined to the link's folder; nullopt if `path` is no link.
std::optional<fs::path> link_content(const fs::path& path) {
  std::error_code code;
  const fs::path content = fs::read_symlink(path, code);
  if (code) return std::nullopt;
  return path.parent_path() / content;
}

#ifdef __linux__
constexpr const char* kAcl = "system.posix_acl_access";

bool has_acl(const fs::path& path) { return ::getxattr(path.c_str(), kAcl, nullptr, 0) > 0; }

/// Copies the extended attributes that the system lets this process copy.
void copy_extended_attributes(const fs::path& from, const Descriptor& to) {
  // removes the ACL that came from the folder's default ACL
  (void)::fremovexattr(to.get(), kAcl);
  const ssize_t size = ::listxattr(from.c_str(), nullptr, 0);
  if (size <= 0) return;
  std::string names(static_cast<std::size_t>(size), '\0');
  const ssize_t listed = ::listxattr(from.c_str(), names.data(), names.size());
  if (listed <= 0) return;
  names.resize(static_cast<std::size_t>(listed));
  for (std::string_view rest = names; !rest.empty();) {
    const std::string name(rest.substr(0, rest.find('\0')));
    rest.remove_prefix(std::min(name.size() + 1, rest.size()));
    const ssize_t length = ::getxattr(from.c_str(), name.c_str(), nullptr, 0);
    if (length < 0) continue;
    std::vector<char> value(static_cast<std::size_t>(length));
    const ssize_t read = ::getxattr(from.c_str(), name.c_str(), value.data(), value.size());
    if (read >= 0) (void)::fsetxattr(to.get(), name.c_str(), value.data(), static_cast<std::size_t>(read), 0);
  }
}
#endif

}  // namespace

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

OutputPlace output_place(const FilePath& file) {
  const fs::path& path = file.path();
  refuse_links_in_derived(file);
  OutputPlace place;
  place.path = path;
  for (int links = 0; own_descriptor(place.path) < 0; ++links) {
    std::optional<fs::path> next = link_content(place.path);
    if (!next) break;
    if (links == kMostLinks) throw_system_fault(path.string(), "cannot be written", ELOOP);
    refuse_link_of_others(place.path);
    place.path = std::move(*next);
  }
  place.own_descriptor = own_descriptor(place.path);
  if (place.own_descriptor >= 0) {
    place.exists = place.is_through = true;
    return place;
  }
  struct stat status {};
  if (::stat(place.path.c_str(), &status) != 0) {
    if (errno != ENOENT) throw_system_fault(path.string(), "cannot be written", errno);
    return place;
  }
  if (S_ISDIR(status.st_mode))
    throw InputError(path.string(), "is a folder", "give a file name for the output");
  place.exists = true;
  place.is_through = !S_ISREG(status.st_mode);
  if (place.is_through && file.folder())
    throw InputError(path.string(), "is not an ordinary file", "remove it or choose another name");
  place.other_names = static_cast<unsigned>(status.st_nlink) - 1;
  return place;
}

int copy_attributes(const fs::path& from, const Descriptor& to) {
  struct stat old {};
  struct stat fresh {};
  if (::stat(from.c_str(), &old) != 0) return errno == ENOENT ? 0 : errno;
  if (::fstat(to.get(), &fresh) != 0) return errno;
  mode_t mode = old.st_mode & kModeBits;
  bool has_owner = fresh.st_uid == old.st_uid;
  bool has_group = fresh.st_gid == old.st_gid;
  if (!has_owner) has_owner = ::fchown(to.get(), old.st_uid, static_cast<gid_t>(-1)) == 0;
  if (!has_group) has_group = ::fchown(to.get(), static_cast<uid_t>(-1), old.st_gid) == 0;
  if (!has_owner || !has_group) mode &= ~static_cast<mode_t>(S_ISUID | S_ISGID);
  if (!has_group) mode &= ~static_cast<mode_t>(S_IRWXG) | ((mode & S_IRWXO) << 3U);
#ifdef __linux__
  copy_extended_attributes(from, to);
  if (has_group && has_acl(from)) return 0;  // the ACL has set the mode
#endif
  return ::fchmod(to.get(), mode) == 0 ? 0 : errno;
}

}  // namespace meshorder
