// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/hdf5/hdf5_file.hpp"

#include "io/hdf5/parts.hpp"
#include "io/hdf5/session.hpp"
#include "io/hdf5/visitor.hpp"
#include "io/stream/read_limits.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <new>

namespace meshorder::hdf5 {
namespace {

constexpr std::size_t kCoreStep = std::size_t{1} << 20;  // growth of a file in memory, in bytes

/// Returns access properties for links or datasets; with them HDF5 follows no link to another file.
Handle access_within_file(hid_t kind) {
  Handle access(H5Pcreate(kind), H5Pclose);
  const auto refuse = [](const char* /*file*/, const char* /*group*/, const char* /*target*/,
                         const char* /*object*/, unsigned* /*flags*/, hid_t /*access*/,
                         void* /*data*/) -> herr_t { return -1; };
  H5Pset_elink_cb(access.id(), refuse, nullptr);
  return access;
}

/// Returns a path up to its first link to another file; an empty text if it has no such link.
std::string external_link_on(hid_t file, const std::string& path) {
  const Handle access = access_within_file(H5P_LINK_ACCESS);
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    std::string part = path.substr(0, end);
    H5L_info_t link;
    if (H5Lget_info(file, part.c_str(), &link, access.id()) < 0) return {};
    if (link.type == H5L_TYPE_EXTERNAL) return part;
    if (end == std::string::npos) return {};
  }
}

/// Returns whether an entry of a group leads to an object of this file.
bool leads_to_object(hid_t group, const std::string& name) {
  if (H5Lexists(group, name.c_str(), H5P_DEFAULT) <= 0) return false;
  H5L_info_t link;
  if (H5Lget_info(group, name.c_str(), &link, H5P_DEFAULT) < 0) return false;
  if (link.type == H5L_TYPE_HARD) return true;
  const Unwatched may_lead_nowhere;
  const Handle access = access_within_file(H5P_LINK_ACCESS);
  return link.type == H5L_TYPE_SOFT && H5Oexists_by_name(group, name.c_str(), access.id()) > 0;
}

Handle file_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  H5Pset_fapl_sec2(access.id());  // regardless of HDF5_DRIVER in the environment
  return access;
}

Handle memory_access(std::string_view bytes) {
  Handle access = file_access();
  // false: the library makes no file on the disk
  if (H5Pset_fapl_core(access.id(), kCoreStep, false) < 0) throw std::bad_alloc();
  if (!bytes.empty()) {
    std::string copy(bytes);  // not `bytes`: the library takes no pointer to const
    if (H5Pset_file_image(access.id(), copy.data(), copy.size()) < 0) throw std::bad_alloc();
  }
  return access;
}

}  // namespace

std::string normal_path(std::string_view path) {
  std::string result;
  for (const char c : path) {
    if (c == '/' && !result.empty() && result.back() == '/') continue;
    if (result.empty() && c != '/') result = "/";
    result += c;
  }
  if (result.size() > 1 && result.back() == '/') result.pop_back();
  return result;
}

void File::fail(const std::string& path, const std::string& what, const std::string& remedy) const {
  throw InputError(name_, path.empty() ? what : fmt::format("the dataset '{}' {}", path, what), remedy);
}

void File::claim(const std::string& path, std::uint64_t bytes) const {
  claim_memory(bytes, fmt::format("the dataset '{}'", path), {.file = name_});
}

File File::open(const FilePath& path) {
  const Session session;
  // HDF5 would wait for a pipe; `read` reads pipes and refuses devices
  if (path.store() != nullptr || !path.is_file()) return in_memory(path.read(), path.string());
  const InputFile file = path.open();
  count_file(path, file.size());
  return open(file.path_for_libraries(), path.string());
}

File File::made_of(hid_t file, std::string name, std::string_view what, const char* remedy) {
  if (file < 0) throw InputError(name, fmt::format("HDF5 cannot {} it ({})", what, last_cause()), remedy);
  return {Handle(file, H5Fclose), std::move(name)};
}

File File::open(const std::filesystem::path& path, std::string name) {
  const Session session;
  const Handle access = file_access();
  return made_of(H5Fopen(path.string().c_str(), H5F_ACC_RDONLY, access.id()), std::move(name), "open",
                 "it may be damaged, cut short, or open for writing elsewhere");
}

File File::change(const std::filesystem::path& path, std::string name) {
  const Session session;
  const Handle access = file_access();
  return made_of(H5Fopen(path.string().c_str(), H5F_ACC_RDWR, access.id()), std::move(name), "write",
                 "is the disk full?");
}

File File::make(const std::filesystem::path& path, std::string_view bytes, std::string name) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), std::ssize(bytes));
  file.close();
  if (!file) throw InputError(name, "cannot be written", "is the disk full?");
  return change(path, std::move(name));
}

File File::in_memory(std::string_view bytes, std::string name, hid_t creation) {
  const Session session;
  const Handle access = memory_access(bytes);
  // the library treats two files with the same name as one file
  static std::uint64_t number = 0;
  const std::string label = fmt::format("meshorder-memory-{}", number++);
  return made_of(bytes.empty() ? H5Fcreate(label.c_str(), H5F_ACC_TRUNC, creation, access.id())
                               : H5Fopen(label.c_str(), H5F_ACC_RDWR, access.id()),
                 std::move(name), "open", "it may be damaged or cut short");
}

Handle File::open_dataset(const std::string& path) const {
  const Handle access = access_within_file(H5P_DATASET_ACCESS);
  Handle dataset(H5Dopen2(file_.id(), path.c_str(), access.id()), H5Dclose);
  if (dataset.is_open()) return dataset;
  if (const std::string link = external_link_on(file_.id(), path); !link.empty()) {
    fail(path,
         fmt::format("is reached through '{}', a link to another file; such links are not followed", link),
         "name that file in the XML, or copy the dataset into this one (h5copy)");
  }
  fail(path, "is missing or damaged", "`h5ls -r` lists the contents of the file");
}

std::vector<std::pair<std::string, std::uint64_t>> File::datasets() const {
  const Session session;
  std::vector<std::pair<std::string, std::uint64_t>> result;
  // The library visits an object once if the object's count of links is right. Without this check, the
  // library would never finish a damaged group that contains itself.
  std::set<haddr_t> groups;
  Visitor<H5O_info_t> visitor([&](hid_t file, const char* name, const H5O_info_t& object) {
    if (object.type == H5O_TYPE_GROUP && !groups.insert(object.addr).second)
      throw InputError(
          name_, fmt::format("the group '{}' is in the file twice, or within itself", normal_path(name)),
          "the file is damaged");
    if (object.type != H5O_TYPE_DATASET) return;
    const Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
    const Handle space(dataset.is_open() ? H5Dget_space(dataset.id()) : -1, H5Sclose);
    const int rank = space.is_open() ? H5Sget_simple_extent_ndims(space.id()) : 0;
    if (rank <= 0) return;
    std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
    result.emplace_back(normal_path(name), shape.front());
  });
  H5Ovisit2(file_.id(), H5_INDEX_NAME, H5_ITER_NATIVE, decltype(visitor)::visit, &visitor, H5O_INFO_BASIC);
  visitor.rethrow();
  std::sort(result.begin(), result.end());
  return result;
}

Handle File::open_object(const std::string& path) const {
  const Handle access = access_within_file(H5P_LINK_ACCESS);
  Handle object(H5Oopen(file_.id(), "/", access.id()), H5Oclose);
  const std::string normal = normal_path(path);
  for (std::size_t begin = 1; begin < normal.size();) {
    const std::size_t end = std::min(normal.find('/', begin), normal.size());
    const std::string name = normal.substr(begin, end - begin);
    const bool is_there = H5Iget_type(object.id()) == H5I_GROUP && leads_to_object(object.id(), name);
    if (!is_there) return {};
    object = Handle(H5Oopen(object.id(), name.c_str(), access.id()), H5Oclose);
    if (!object.is_open()) return {};
    begin = end + 1;
  }
  return object;
}

Handle File::open_dataset_if_there(const std::string& path) const {
  Handle object = open_object(path);
  return H5Iget_type(object.id()) == H5I_DATASET ? std::move(object) : Handle();
}

bool File::has(const std::string& path) const {
  const Session session;
  return open_object(path).is_open();
}

std::vector<std::string> File::names(const std::string& group, H5_iter_order_t order) const {
  const Session session;
  const Handle object = open_object(group);
  if (!object.is_open() || H5Iget_type(object.id()) != H5I_GROUP) return {};
  return names_in(object.id(), H5_INDEX_NAME, order);
}

void File::make_group(const std::string& path, LinkOrder order) {
  const Session session;
  if (has(path)) return;
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  if (order == LinkOrder::made) keep_order_of_links(creation);
  make_group(path, creation);
}

void File::make_list(const std::string& path, std::span<const std::string> names) {
  constexpr std::size_t kPerLink = 40;  // bytes, besides the name, which may get a number
  constexpr std::size_t kForAttributes = 2048;
  constexpr std::size_t kMost = std::size_t{32} << 10;
  const Session session;
  std::size_t bytes = kForAttributes;
  for (const std::string& name : names) bytes += name.size() + kPerLink;
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  if (!names.empty() && bytes <= kMost) {
    const auto count = static_cast<unsigned>(names.size());
    // all links are in the group's header, which has room for them
    H5Pset_link_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Pset_link_phase_change(creation.id(), count, 0);
    H5Pset_est_link_info(creation.id(), count, static_cast<unsigned>(bytes / names.size()));
    forget_times(creation);
  }
  make_group(path, creation);
}

void File::make_group(const std::string& path, const Handle& creation) {
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  const Handle group(H5Gcreate2(file_.id(), path.c_str(), links.id(), creation.id(), H5P_DEFAULT), H5Gclose);
  if (!group.is_open()) {
    throw InputError(name_, fmt::format("the group '{}' cannot be written ({})", path, last_cause()),
                     "is the disk full?");
  }
}

void File::move(const std::string& path, const std::string& new_path) {
  const Session session;
  H5Lmove(file_.id(), path.c_str(), file_.id(), new_path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
}

void File::remove(const std::string& path) {
  const Session session;
  const std::string normal = normal_path(path);
  const std::size_t slash = normal.rfind('/');
  const Handle group = open_object(normal.substr(0, slash));
  const std::string name = normal.substr(slash + 1);
  if (H5Iget_type(group.id()) != H5I_GROUP || H5Lexists(group.id(), name.c_str(), H5P_DEFAULT) <= 0) return;
  H5Ldelete(group.id(), name.c_str(), H5P_DEFAULT);
}

std::string File::without_values(const std::set<std::string>& paths, H5_iter_order_t order) const {
  const Session session;
  const Handle root = open_object("/");
  const File copy = in_memory({}, name_, creation_of_copy(root.id(), H5P_FILE_CREATE).id());
  const std::string damaged = copy_without_values(file_.id(), copy.file_.id(), paths, order);
  if (!damaged.empty()) {
    throw InputError(name_, fmt::format("the attributes of the group '{}' cannot be read", damaged),
                     "the file may be damaged");
  }
  return copy.bytes();
}

std::string File::bytes() const {
  const Session session;
  flush();
  const ssize_t size = H5Fget_file_image(file_.id(), nullptr, 0);
  std::string result(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  if (size <= 0 || H5Fget_file_image(file_.id(), result.data(), result.size()) != size) {
    fail("", "HDF5 cannot give the bytes of a file in memory", "");
  }
  return result;
}

void File::flush() const {
  const Session session;
  if (H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) < 0) {
    fail("", fmt::format("cannot be written to the end ({})", last_cause()), "is the disk full?");
  }
}

void File::close() {
  const Session session;
  flush();
  if (file_.close() < 0) {
    fail("", fmt::format("cannot be written to the end ({})", last_cause()), "is the disk full?");
  }
  session.require_no_failure(name_);
}

NewFile::NewFile(const FilePath& path, const std::string& bytes) : path_(path), out_(path) {
  if (path.store() != nullptr) {
    file_.emplace(File::in_memory(bytes, path.string()));
    return;
  }
  out_.write(bytes);
  out_.close();
  file_.emplace(File::change(out_.temporary(), path.string()));
}

OutputFile NewFile::finish() {
  if (path_.store() != nullptr) {
    out_.write(file_->bytes());
  } else {
    file_->close();
  }
  file_.reset();
  return std::move(out_);
}

void write_from(const FilePath& path, const std::string& bytes, const std::function<void(File&)>& fill) {
  NewFile file(path, bytes);
  fill(file.file());
  file.finish().commit();
}

}  // namespace meshorder::hdf5
