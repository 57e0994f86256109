// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/hdf5/hdf5_file.hpp"

#include "base/memory.hpp"
#include "base/resize_in_steps.hpp"
#include "io/hdf5/session.hpp"
#include "io/hdf5/visitor.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/read_limits.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <new>
#include <type_traits>
#include <variant>

namespace meshorder::hdf5 {
namespace {

constexpr std::size_t kCoreStep = std::size_t{1} << 20;  // by which a file in memory grows, in bytes

/// Returns the library's number types in memory, in the order of Values.
std::array<hid_t, 10> native_types() {
  return {H5T_NATIVE_DOUBLE, H5T_NATIVE_FLOAT, H5T_NATIVE_INT8,   H5T_NATIVE_UINT8, H5T_NATIVE_INT16,
          H5T_NATIVE_UINT16, H5T_NATIVE_INT32, H5T_NATIVE_UINT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64};
}

/// Returns the alternative of Values for the usual number types, in either byte order; 10 for all others.
std::size_t alternative_of(hid_t type) {
  // the library trusts the bit fields of others, which a damaged file may have put anywhere
  const std::array<std::array<hid_t, 2>, 10> known{{{H5T_IEEE_F64LE, H5T_IEEE_F64BE},
                                                    {H5T_IEEE_F32LE, H5T_IEEE_F32BE},
                                                    {H5T_STD_I8LE, H5T_STD_I8BE},
                                                    {H5T_STD_U8LE, H5T_STD_U8BE},
                                                    {H5T_STD_I16LE, H5T_STD_I16BE},
                                                    {H5T_STD_U16LE, H5T_STD_U16BE},
                                                    {H5T_STD_I32LE, H5T_STD_I32BE},
                                                    {H5T_STD_U32LE, H5T_STD_U32BE},
                                                    {H5T_STD_I64LE, H5T_STD_I64BE},
                                                    {H5T_STD_U64LE, H5T_STD_U64BE}}};
  const auto found = std::find_if(known.begin(), known.end(), [&](const std::array<hid_t, 2>& orders) {
    return std::any_of(orders.begin(), orders.end(), [&](hid_t one) { return H5Tequal(type, one) > 0; });
  });
  return static_cast<std::size_t>(found - known.begin());
}

Handle link_access() {
  Handle access(H5Pcreate(H5P_LINK_ACCESS), H5Pclose);
  // links to other files are not followed: the XML says where the data are
  const auto refuse = [](const char* /*file*/, const char* /*group*/, const char* /*target*/,
                         const char* /*object*/, unsigned* /*flags*/, hid_t /*access*/,
                         void* /*data*/) -> herr_t { return -1; };
  H5Pset_elink_cb(access.id(), refuse, nullptr);
  return access;
}

Handle dataset_access() {
  Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  const auto refuse = [](const char* /*file*/, const char* /*group*/, const char* /*target*/,
                         const char* /*object*/, unsigned* /*flags*/, hid_t /*access*/,
                         void* /*data*/) -> herr_t { return -1; };
  H5Pset_elink_cb(access.id(), refuse, nullptr);
  return access;
}

/// Returns the first part of a path, up to a link to another file; an empty text without one.
std::string external_link_on(hid_t file, const std::string& path) {
  const Handle access = link_access();
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    std::string part = path.substr(0, end);
    H5L_info_t link;
    if (H5Lget_info(file, part.c_str(), &link, access.id()) < 0) return {};
    if (link.type == H5L_TYPE_EXTERNAL) return part;
    if (end == std::string::npos) return {};
  }
}

/// Returns the name of a filter of the dataset that this library lacks; an empty text if it has all.
std::string lacking_filter(hid_t creation) {
  const int filters = H5Pget_nfilters(creation);
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    std::array<char, 64> name{};
    const H5Z_filter_t filter = H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr,
                                               name.size(), name.data(), nullptr);
    if (filter >= 0 && H5Zfilter_avail(filter) <= 0) {
      name.back() = '\0';
      return name.front() == '\0' ? std::to_string(filter) : std::string(name.data());
    }
  }
  return {};
}

Handle file_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  return access;
}

Handle memory_access(std::string_view bytes) {
  Handle access = file_access();
  // otherwise the library would make a file on the disk
  if (H5Pset_fapl_core(access.id(), kCoreStep, false) < 0) throw std::bad_alloc();
  if (!bytes.empty()) {
    std::string copy(bytes);  // the library copies it once more, and wants to be allowed to write
    if (H5Pset_file_image(access.id(), copy.data(), copy.size()) < 0) throw std::bad_alloc();
  }
  return access;
}

// ---- copies of files without the values of some datasets

/// Copies an attribute to another object. Those that hold references are left out: they name places in the
/// old file.
void copy_attribute(hid_t from, const char* name, hid_t to) {
  const Handle attribute(H5Aopen(from, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (!type.is_open() || !space.is_open() || H5Tdetect_class(type.id(), H5T_REFERENCE) > 0) return;
  // what needs no conversion gets none: the library trusts the bit fields of numbers, which a damaged file
  // may have put anywhere
  const bool varies = H5Tdetect_class(type.id(), H5T_VLEN) > 0 || H5Tis_variable_str(type.id()) > 0;
  const Handle memory(varies ? H5Tget_native_type(type.id(), H5T_DIR_DEFAULT) : H5Tcopy(type.id()), H5Tclose);
  if (!memory.is_open()) return;
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  const std::size_t size = std::max(H5Tget_size(type.id()), H5Tget_size(memory.id()));
  const Handle copy(H5Acreate2(to, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!copy.is_open() || count <= 0) return;
  std::vector<char> bytes(static_cast<std::size_t>(count) * size);
  if (H5Aread(attribute.id(), memory.id(), bytes.data()) < 0) return;
  H5Awrite(copy.id(), memory.id(), bytes.data());
  if (varies) H5Dvlen_reclaim(memory.id(), space.id(), H5P_DEFAULT, bytes.data());
}

/// Copies all attributes to another object. Returns false, and copies none, where one is damaged: the library
/// does not survive to iterate over such.
bool copy_attributes(hid_t from, hid_t to) {
  if (H5Aexists(from, "\x01") < 0) return false;
  Visitor<H5A_info_t> visitor(
      [&](hid_t object, const char* name, const H5A_info_t& /*info*/) { copy_attribute(object, name, to); });
  const herr_t status =
      H5Aiterate2(from, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, decltype(visitor)::visit, &visitor);
  visitor.rethrow();
  return status >= 0;
}

/// Returns the names in a group, in the order of the names or of the creation of links. The library's own
/// sorting trusts what a damaged group says of its size.
std::vector<std::string> names_in(hid_t group, H5_index_t index = H5_INDEX_NAME) {
  std::vector<std::pair<std::int64_t, std::string>> links;
  Visitor<H5L_info_t> visitor([&](hid_t /*group*/, const char* name, const H5L_info_t& info) {
    links.emplace_back(info.corder, name);
  });
  H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, decltype(visitor)::visit, &visitor);
  visitor.rethrow();
  if (index == H5_INDEX_NAME) {
    for (auto& [order, name] : links) order = 0;
  }
  std::sort(links.begin(), links.end());
  std::vector<std::string> names;
  names.reserve(links.size());
  for (auto& [order, name] : links) names.push_back(std::move(name));
  return names;
}

/// Returns the order in which the links of a group were made if it keeps that, else that of their names.
H5_index_t order_of(hid_t group) {
  const Handle creation(H5Gget_create_plist(group), H5Pclose);
  unsigned flags = 0;
  if (H5Pget_link_creation_order(creation.id(), &flags) < 0) return H5_INDEX_NAME;
  return (flags & H5P_CRT_ORDER_INDEXED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
}

/// Returns how a copy of a group is made: one that keeps the order of its links if the group does. The list
/// of the group itself would do harm, as it has the addresses of its links in the old file.
Handle creation_of_copy(hid_t group) {
  const Handle old(H5Gget_create_plist(group), H5Pclose);
  Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  unsigned flags = 0;
  if (H5Pget_link_creation_order(old.id(), &flags) >= 0 && flags != 0) {
    H5Pset_link_creation_order(creation.id(), flags);
  }
  return creation;
}

/// Returns the number of characters of each row of a dataset of texts, 0 for other types.
std::size_t width_of_texts(hid_t type) {
  constexpr std::size_t kMostCharacters = 1024;
  if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) <= 0) {
    const std::size_t size = H5Tget_size(type);
    return size <= kMostCharacters ? size : 0;
  }
  if (H5Tget_class(type) != H5T_ARRAY || H5Tget_array_ndims(type) != 1) return 0;
  hsize_t count = 0;
  const Handle base(H5Tget_super(type), H5Tclose);
  constexpr std::size_t kInt8 = 2;
  constexpr std::size_t kUint8 = 3;
  const std::size_t alternative = alternative_of(base.id());
  if (H5Tget_array_dims2(type, &count) < 0 || (alternative != kInt8 && alternative != kUint8)) return 0;
  return count <= kMostCharacters ? static_cast<std::size_t>(count) : 0;
}

/// Returns the type of texts of any length.
Handle type_of_strings() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  return type;
}

/// Returns a type of so many characters, as an array of small numbers.
Handle type_of_texts(std::size_t width) {
  const hsize_t count = width;
  return {H5Tarray_create2(H5T_STD_I8LE, 1, &count), H5Tclose};
}

/// Returns the most bytes that the values of a dataset may take: no filter of HDF5 makes more than some
/// thousand bytes of one.
std::uint64_t most_bytes(hid_t dataset) {
  constexpr std::uint64_t kMostFromOneByte = 4096;
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  return H5Pget_layout(creation.id()) == H5D_CHUNKED ? kMostFromOneByte * (stored + 1) : stored;
}

std::string without_padding(std::string_view text) {
  text = text.substr(0, text.find('\0'));
  return std::string(text.substr(0, text.find_last_not_of(' ') + 1));
}

/// Sets that a dataset does not hold when it was last changed: the same mesh is the same bytes at any time.
void forget_times(const Handle& creation) { H5Pset_obj_track_times(creation.id(), false); }

/// Makes a dataset of the type, the attributes, chunks and filters of another one.
Handle empty_copy(hid_t dataset, hid_t target, const char* name, hid_t space) {
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const bool chunked = H5Pget_layout(creation.id()) == H5D_CHUNKED;
  if (H5Pget_layout(creation.id()) != H5D_COMPACT) {
    H5Pset_alloc_time(creation.id(), chunked ? H5D_ALLOC_TIME_INCR : H5D_ALLOC_TIME_LATE);
  }
  forget_times(creation);
  Handle copy(H5Dcreate2(target, name, type.id(), space, H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Dclose);
  if (copy.is_open()) (void)copy_attributes(dataset, copy.id());
  return copy;
}

class CopyWithoutValues {
 public:
  CopyWithoutValues(const std::set<std::string>& paths, hid_t target) : paths_(paths), target_(target) {}

  void copy_group(hid_t from, hid_t to, const std::string& path) {
    if (!copy_attributes(from, to)) damaged_ = path;
    H5O_info_t group;
    H5Oget_info(from, &group);
    first_paths_.emplace(group.addr, path.empty() ? "/" : path);
    for (const std::string& name : names_in(from, order_of(from)))
      copy_link(from, to, name, fmt::format("{}/{}", path, name));
  }

  /// Returns the path of a group whose attributes could not be copied; an empty text without.
  [[nodiscard]] const std::string& damaged() const noexcept { return damaged_; }

 private:
  void copy_link(hid_t from, hid_t to, const std::string& name, const std::string& path) {
    H5L_info_t link;
    if (H5Lget_info(from, name.c_str(), &link, H5P_DEFAULT) < 0) return;
    if (link.type != H5L_TYPE_HARD) return copy_reference(from, to, name, link);
    H5O_info_t object;
    if (H5Oget_info_by_name(from, name.c_str(), &object, H5P_DEFAULT) < 0) return;
    if (const auto known = first_paths_.find(object.addr); known != first_paths_.end()) {
      H5Lcreate_hard(target_, known->second.c_str(), to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      return;
    }
    if (object.type == H5O_TYPE_DATASET && paths_.contains(path)) {
      const Handle dataset(H5Dopen2(from, name.c_str(), H5P_DEFAULT), H5Dclose);
      const Handle space(H5Dget_space(dataset.id()), H5Sclose);
      (void)empty_copy(dataset.id(), to, name.c_str(), space.id());
    } else if (object.type == H5O_TYPE_GROUP && has_listed(path)) {
      const Handle old_group(H5Gopen2(from, name.c_str(), H5P_DEFAULT), H5Gclose);
      const Handle creation = creation_of_copy(old_group.id());
      const Handle new_group(H5Gcreate2(to, name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose);
      copy_group(old_group.id(), new_group.id(), path);
      return;
    } else {
      H5Ocopy(from, name.c_str(), to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
    first_paths_.emplace(object.addr, path);
  }

  static void copy_reference(hid_t from, hid_t to, const std::string& name, const H5L_info_t& link) {
    std::string value(link.u.val_size, '\0');  // NOLINT(*-union-access): the library's
    if (H5Lget_val(from, name.c_str(), value.data(), value.size(), H5P_DEFAULT) < 0) return;
    if (link.type == H5L_TYPE_SOFT) {
      H5Lcreate_soft(value.c_str(), to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    } else if (link.type == H5L_TYPE_EXTERNAL) {
      const char* file = nullptr;
      const char* object = nullptr;
      unsigned flags = 0;
      if (H5Lunpack_elink_val(value.data(), value.size(), &flags, &file, &object) < 0) return;
      H5Lcreate_external(file, object, to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
  }

  /// Returns whether one of the datasets is somewhere in the group.
  [[nodiscard]] bool has_listed(const std::string& group) const {
    const auto next = paths_.lower_bound(group + "/");
    return next != paths_.end() && next->starts_with(group + "/");
  }

  const std::set<std::string>& paths_;
  hid_t target_;
  std::string damaged_;
  std::map<haddr_t, std::string> first_paths_;  // in the copy, of objects by their place in the old file
};

}  // namespace

Handle::~Handle() { (void)close(); }

herr_t Handle::close() {
  if (id_ < 0) return 0;
  const Session session;
  return close_(std::exchange(id_, -1));
}

std::uint64_t DatasetInfo::size() const {
  std::uint64_t size = 1;
  for (const std::uint64_t n : shape) {
    if (n != 0 && size > UINT64_MAX / n) return UINT64_MAX;
    size *= n;
  }
  return size;
}

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
  // not those of pipes, which HDF5 would wait for, and of devices, which are refused
  if (path.store() != nullptr || !path.is_file()) return in_memory(path.read(), path.string());
  std::error_code ignored;
  count_file(path, std::filesystem::file_size(path.path(), ignored));
  return open(path.path(), path.string());
}

File File::open(const std::filesystem::path& path, std::string name) {
  const Session session;
  const Handle access = file_access();
  Handle file(H5Fopen(path.string().c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!file.is_open()) {
    const std::string cause = last_cause();
    throw InputError(name, fmt::format("HDF5 cannot open it ({})", cause),
                     "it may be damaged, cut short, or open for writing elsewhere");
  }
  return {std::move(file), std::move(name)};
}

File File::change(const std::filesystem::path& path, std::string name) {
  const Session session;
  const Handle access = file_access();
  Handle file(H5Fopen(path.string().c_str(), H5F_ACC_RDWR, access.id()), H5Fclose);
  if (!file.is_open()) {
    throw InputError(name, fmt::format("HDF5 cannot write it ({})", last_cause()), "is the disk full?");
  }
  return {std::move(file), std::move(name)};
}

File File::in_memory(std::string_view bytes, std::string name) {
  const Session session;
  const Handle access = memory_access(bytes);
  // the library takes two files of one name for the same
  static std::uint64_t number = 0;
  const std::string label = fmt::format("meshorder-memory-{}", number++);
  Handle file(bytes.empty() ? H5Fcreate(label.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id())
                            : H5Fopen(label.c_str(), H5F_ACC_RDWR, access.id()),
              H5Fclose);
  if (!file.is_open()) {
    throw InputError(name, fmt::format("HDF5 cannot open it ({})", last_cause()),
                     "it may be damaged or cut short");
  }
  return {std::move(file), std::move(name)};
}

Handle File::open_dataset(const std::string& path) const {
  const Handle access = dataset_access();
  Handle dataset(H5Dopen2(file_.id(), path.c_str(), access.id()), H5Dclose);
  if (dataset.is_open()) return dataset;
  if (const std::string link = external_link_on(file_.id(), path); !link.empty()) {
    fail(path, fmt::format("is behind '{}', a link to another file, which is not followed", link),
         "name that file in the XML, or copy the dataset into this one (h5copy)");
  }
  fail(path, "is missing or damaged", "`h5ls -r` lists what the file has");
}

DatasetInfo File::info(const std::string& path) const {
  const Session session;
  const Handle dataset = open_dataset(path);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const Handle creation(H5Dget_create_plist(dataset.id()), H5Pclose);
  DatasetInfo info;
  info.alternative = alternative_of(type.id());
  if (info.alternative == native_types().size()) {
    fail(path, "does not hold plain numbers",
         "whole numbers of 8 to 64 bits, float and double are understood");
  }
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 0 || H5Sget_simple_extent_type(space.id()) == H5S_NULL) {
    fail(path, "has no values", "the file may be damaged");
  }
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
  info.shape.assign(shape.begin(), shape.end());

  const H5D_layout_t layout = H5Pget_layout(creation.id());
  if (layout == H5D_VIRTUAL || H5Pget_external_count(creation.id()) > 0) {
    fail(path, "has its values in other files", "copy them into one file (h5repack)");
  }
  if (const std::string filter = lacking_filter(creation.id()); !filter.empty()) {
    fail(path, fmt::format("is compressed by the filter '{}', which this HDF5 lacks", filter),
         "decompress it (h5repack -f NONE)");
  }
  const std::uint64_t possible = most_bytes(dataset.id());
  if (info.size() > possible / std::min<std::size_t>(H5Tget_size(type.id()), 8) && info.size() > 0) {
    fail(path,
         fmt::format("claims {} values, but only {} bytes are there", info.size(),
                     H5Dget_storage_size(dataset.id())),
         "it may never have been written, or the file is damaged");
  }
  return info;
}

std::optional<std::size_t> File::number_type(const std::string& path) const {
  const Session session;
  const Handle dataset(has(path) ? H5Dopen2(file_.id(), path.c_str(), H5P_DEFAULT) : -1, H5Dclose);
  if (!dataset.is_open()) return {};
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const std::size_t alternative = alternative_of(type.id());
  if (alternative == native_types().size()) return {};
  return alternative;
}

void File::read(const std::string& path, hid_t type, void* values) const {
  const Handle dataset = open_dataset(path);
  if (H5Dread(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    const std::string cause = last_cause();
    fail(path, fmt::format("cannot be read ({})", cause), "the file may be damaged or cut short");
  }
}

Values File::read(const std::string& path) const {
  const Session session;
  const DatasetInfo of = info(path);
  Values values;
  const auto read_as = [&]<std::size_t I>(std::integral_constant<std::size_t, I> /*alternative*/) {
    if (I != of.alternative) return;
    auto& numbers = values.emplace<I>();
    claim(path, bytes_for(of.size(), sizeof(numbers.front())));
    resize_in_steps(numbers, of.size());
    if (!numbers.empty()) read(path, native_types()[I], numbers.data());
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (read_as(std::integral_constant<std::size_t, I>{}), ...);
  }
  (std::make_index_sequence<10>());
  return values;
}

std::vector<Index> File::read_indices(const std::string& path) const {
  const Session session;
  std::vector<Index> values;
  const std::uint64_t size = info(path).size();
  claim(path, bytes_for(size, sizeof(Index)));
  resize_in_steps(values, size);
  if (!values.empty()) read(path, H5T_NATIVE_INT32, values.data());
  return values;
}

std::optional<std::uint64_t> File::place_of_values(const std::string& path) const {
  const Session session;
  const DatasetInfo of = info(path);
  if (of.size() == 0) return 0;
  const Handle dataset = open_dataset(path);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const Handle creation(H5Dget_create_plist(dataset.id()), H5Pclose);
  if (H5Pget_layout(creation.id()) != H5D_CONTIGUOUS ||
      H5Tequal(type.id(), native_types()[of.alternative]) <= 0)
    return {};
  const haddr_t place = H5Dget_offset(dataset.id());
  if (place == HADDR_UNDEF) return {};
  return place;
}

std::vector<std::pair<std::string, std::uint64_t>> File::datasets() const {
  const Session session;
  std::vector<std::pair<std::string, std::uint64_t>> result;
  Visitor<H5O_info_t> visitor([&](hid_t file, const char* name, const H5O_info_t& object) {
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

void File::write(const std::string& path, const Values& values, const std::vector<std::uint64_t>& shape) {
  const Session session;
  std::visit(
      [&](const auto& numbers) {
        this->write(path, native_types()[values.index()], numbers.data(), numbers.size(), shape);
      },
      values);
}

void File::write(const std::string& path, std::span<const Index> values,
                 const std::vector<std::uint64_t>& shape) {
  const Session session;
  write(path, H5T_NATIVE_INT32, values.data(), values.size(), shape);
}

void File::write(const std::string& path, hid_t type, const void* values, std::uint64_t count,
                 const std::vector<std::uint64_t>& shape) {
  const std::vector<hsize_t> dims(shape.begin(), shape.end());
  const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  Handle dataset(H5Dopen2(file_.id(), path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.is_open()) {
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.id(), 1);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    forget_times(creation);
    dataset =
        Handle(H5Dcreate2(file_.id(), path.c_str(), type, space.id(), links.id(), creation.id(), H5P_DEFAULT),
               H5Dclose);
  } else {
    const Handle old_space(H5Dget_space(dataset.id()), H5Sclose);
    const hssize_t old_count = H5Sget_simple_extent_npoints(old_space.id());
    if (old_count < 0 || static_cast<std::uint64_t>(old_count) != count) {
      const std::string aside = path + ".old";
      H5Lmove(file_.id(), path.c_str(), file_.id(), aside.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      Handle copy = empty_copy(dataset.id(), file_.id(), path.c_str(), space.id());
      H5Ldelete(file_.id(), aside.c_str(), H5P_DEFAULT);
      dataset = std::move(copy);
    }
  }
  // what the library buffers of the values is written when the dataset is closed
  const bool written =
      dataset.is_open() &&
      (count == 0 || H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0) &&
      dataset.close() >= 0;
  if (!written) fail(path, fmt::format("cannot be written ({})", last_cause()), "is the disk full?");
}

Handle File::open_object(const std::string& path) const {
  const Handle access = link_access();
  return {H5Oopen(file_.id(), path.c_str(), access.id()), H5Oclose};
}

bool File::has(const std::string& path) const {
  const Session session;
  return open_object(path).is_open();
}

std::vector<std::string> File::names(const std::string& group) const {
  const Session session;
  const Handle object = open_object(group);
  if (!object.is_open() || H5Iget_type(object.id()) != H5I_GROUP) return {};
  return names_in(object.id());
}

/// Returns texts of any length, without what follows a zero byte.
std::vector<std::string> File::read_strings(const std::string& path, const Handle& dataset,
                                            const Handle& type) const {
  constexpr std::uint64_t kReference = 16;  // bytes of a dataset for each text
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const hssize_t rows = H5Sget_simple_extent_npoints(space.id());
  if (rows < 0) fail(path, "has no values", "the file may be damaged");
  const auto count = static_cast<std::uint64_t>(rows);
  if (count > most_bytes(dataset.id()) / kReference) {
    fail(path,
         fmt::format("claims {} texts, but only {} bytes are there", rows, H5Dget_storage_size(dataset.id())),
         "it may never have been written, or the file is damaged");
  }
  hsize_t bytes = 0;
  const bool is_sized = count == 0 || H5Dvlen_get_buf_size(dataset.id(), type.id(), space.id(), &bytes) >= 0;
  claim(path, bytes_for(count, sizeof(std::string) + sizeof(char*)) + bytes);
  std::vector<char*> pointers(static_cast<std::size_t>(rows), nullptr);
  if (!is_sized || (!pointers.empty() &&
                    H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0)) {
    const std::string cause = last_cause();
    if (!pointers.empty()) H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, pointers.data());
    fail(path, fmt::format("cannot be read ({})", cause), "the file may be damaged or cut short");
  }
  std::vector<std::string> texts;
  texts.reserve(pointers.size());
  for (const char* const text : pointers) texts.emplace_back(text == nullptr ? "" : text);
  if (!pointers.empty()) H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, pointers.data());
  return texts;
}

std::vector<std::string> File::read_texts(const std::string& path) const {
  const Session session;
  const Handle dataset = open_dataset(path);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  if (H5Tis_variable_str(type.id()) > 0) return read_strings(path, dataset, type);
  const std::size_t width = width_of_texts(type.id());
  const hssize_t rows = H5Sget_simple_extent_npoints(space.id());
  if (width == 0 || rows < 0) fail(path, "does not hold texts of one length", "the file may be damaged");
  if (static_cast<std::uint64_t>(rows) > most_bytes(dataset.id()) / width) {
    fail(path,
         fmt::format("claims {} texts, but only {} bytes are there", rows, H5Dget_storage_size(dataset.id())),
         "it may never have been written, or the file is damaged");
  }
  claim(path, bytes_for(static_cast<std::uint64_t>(rows), width + sizeof(std::string)));
  std::string bytes(static_cast<std::size_t>(rows) * width, '\0');
  if (!bytes.empty()) read(path, type.id(), bytes.data());
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < bytes.size(); at += width) {
    texts.push_back(without_padding(std::string_view(bytes).substr(at, width)));
  }
  return texts;
}

bool File::has_texts(const std::string& path) const {
  const Session session;
  const Handle dataset(has(path) ? H5Dopen2(file_.id(), path.c_str(), H5P_DEFAULT) : -1, H5Dclose);
  const Handle type(dataset.is_open() ? H5Dget_type(dataset.id()) : -1, H5Tclose);
  return type.is_open() && (H5Tis_variable_str(type.id()) > 0 || width_of_texts(type.id()) > 0);
}

Handle File::open_attribute(const std::string& path, const std::string& name) const {
  const Handle object = open_object(path);
  if (!object.is_open() || H5Aexists(object.id(), name.c_str()) <= 0) return {};
  return {H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), H5Aclose};
}

std::optional<std::int64_t> File::integer_attribute(const std::string& path, const std::string& name) const {
  const std::vector<std::int64_t> values = integers_attribute(path, name);
  if (values.size() != 1) return {};
  return values.front();
}

std::vector<std::int64_t> File::integers_attribute(const std::string& path, const std::string& name) const {
  const Session session;
  const Handle attribute = open_attribute(path, name);
  if (!attribute.is_open()) return {};
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  constexpr std::size_t kFirstWhole = 2;
  constexpr hssize_t kMost = 64;
  const std::size_t alternative = alternative_of(type.id());
  const bool is_whole = alternative >= kFirstWhole && alternative < native_types().size();
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (!is_whole || count < 1 || count > kMost) return {};
  std::vector<std::int64_t> values(static_cast<std::size_t>(count));
  if (H5Aread(attribute.id(), H5T_NATIVE_INT64, values.data()) < 0) return {};
  return values;
}

std::optional<std::string> File::text_attribute(const std::string& path, const std::string& name) const {
  const Session session;
  const Handle attribute = open_attribute(path, name);
  if (!attribute.is_open()) return {};
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  constexpr std::size_t kMostBytes = 65536;
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) > 0) return {};
  const std::size_t size = H5Tget_size(type.id());
  if (size > kMostBytes || H5Sget_simple_extent_npoints(space.id()) != 1) return {};
  std::string value(size, '\0');
  if (H5Aread(attribute.id(), type.id(), value.data()) < 0) return {};
  value.resize(std::min(value.find('\0'), value.size()));
  return value;
}

void File::write_texts(const std::string& path, std::span<const std::string> texts, std::size_t width,
                       char filling) {
  const Session session;
  std::string bytes;
  bytes.reserve(texts.size() * width);
  for (const std::string& text : texts) {
    bytes += text.substr(0, width);
    bytes.append(width - std::min(width, text.size()), filling);
  }
  const Handle type = type_of_texts(width);
  const Handle old(has(path) ? H5Dopen2(file_.id(), path.c_str(), H5P_DEFAULT) : -1, H5Dclose);
  const std::string aside = path + ".old";
  if (old.is_open()) H5Lmove(file_.id(), path.c_str(), file_.id(), aside.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  write(path, type.id(), bytes.data(), texts.size(), {texts.size()});
  if (!old.is_open()) return;
  (void)copy_attributes(old.id(), open_dataset(path).id());
  H5Ldelete(file_.id(), aside.c_str(), H5P_DEFAULT);
}

void File::write_strings(const std::string& path, std::span<const std::string> texts) {
  const Session session;
  std::vector<const char*> pointers;
  pointers.reserve(texts.size());
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const Handle type = type_of_strings();
  write(path, type.id(), pointers.data(), texts.size(), {texts.size()});
}

void File::make_room(const std::string& path, std::size_t alternative,
                     const std::vector<std::uint64_t>& shape) {
  const Session session;
  const std::vector<hsize_t> dims(shape.begin(), shape.end());
  const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  forget_times(creation);
  H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
  const Handle dataset(H5Dcreate2(file_.id(), path.c_str(), native_types()[alternative], space.id(),
                                  links.id(), creation.id(), H5P_DEFAULT),
                       H5Dclose);
  if (!dataset.is_open())
    fail(path, fmt::format("cannot be written ({})", last_cause()), "is the disk full?");
}

void File::give_room(const std::string& path) {
  const Session session;
  Handle dataset = open_dataset(path);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  // the library allots all of a dataset when a value of it is written
  const std::vector<hsize_t> first(
      static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space.id()), 0)), 0);
  const std::vector<hsize_t> one(first.size(), 1);
  if (!first.empty()) {
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, first.data(), nullptr, one.data(), nullptr);
  }
  const Handle memory(H5Screate(H5S_SCALAR), H5Sclose);
  const std::vector<char> value(H5Tget_size(type.id()), '\0');
  const bool written =
      H5Dwrite(dataset.id(), type.id(), memory.id(), space.id(), H5P_DEFAULT, value.data()) >= 0 &&
      dataset.close() >= 0;
  if (!written) fail(path, fmt::format("cannot be written ({})", last_cause()), "is the disk full?");
}

void File::make_group(const std::string& path, LinkOrder order) {
  const Session session;
  if (has(path)) return;
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  if (order == LinkOrder::made)
    H5Pset_link_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  const Handle group(H5Gcreate2(file_.id(), path.c_str(), links.id(), creation.id(), H5P_DEFAULT), H5Gclose);
  if (!group.is_open()) {
    throw InputError(name_, fmt::format("the group '{}' cannot be written ({})", path, last_cause()),
                     "is the disk full?");
  }
}

void File::put_attribute(const std::string& path, const std::string& name, hid_t space, hid_t type,
                         hid_t memory, const void* value) {
  const Handle object = open_object(path);
  if (H5Aexists(object.id(), name.c_str()) > 0) H5Adelete(object.id(), name.c_str());
  const Handle attribute(H5Acreate2(object.id(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (attribute.is_open() && H5Awrite(attribute.id(), memory, value) >= 0) return;
  throw InputError(name_,
                   fmt::format("the attribute {} of '{}' cannot be written ({})", name, path, last_cause()),
                   "is the disk full?");
}

void File::set_attribute(const std::string& path, const std::string& name, std::int64_t value) {
  const Session session;
  const auto type_of_old = [&] {
    const Handle old = open_attribute(path, name);
    Handle type(old.is_open() ? H5Aget_type(old.id()) : -1, H5Tclose);
    const bool is_known = type.is_open() && alternative_of(type.id()) < native_types().size();
    return is_known ? std::move(type) : Handle(H5Tcopy(H5T_STD_I64LE), H5Tclose);
  };
  const Handle type = type_of_old();
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  put_attribute(path, name, space.id(), type.id(), H5T_NATIVE_INT64, &value);
}

void File::set_attribute(const std::string& path, const std::string& name, double value) {
  const Session session;
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  put_attribute(path, name, space.id(), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void File::set_attribute(const std::string& path, const std::string& name, const std::string& value) {
  const Session session;
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), value.size() + 1);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  put_attribute(path, name, space.id(), type.id(), type.id(), value.c_str());
}

void File::set_attribute(const std::string& path, const std::string& name,
                         std::span<const std::int64_t> values) {
  const Session session;
  const hsize_t count = values.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  put_attribute(path, name, space.id(), H5T_STD_I64LE, H5T_NATIVE_INT64, values.data());
}

void File::move(const std::string& path, const std::string& new_path) {
  const Session session;
  H5Lmove(file_.id(), path.c_str(), file_.id(), new_path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
}

void File::remove(const std::string& path) {
  const Session session;
  H5Ldelete(file_.id(), path.c_str(), H5P_DEFAULT);
}

std::string File::without_values(const std::set<std::string>& paths) const {
  const Session session;
  const File copy = in_memory({}, name_);
  const Handle from(H5Gopen2(file_.id(), "/", H5P_DEFAULT), H5Gclose);
  const Handle to(H5Gopen2(copy.file_.id(), "/", H5P_DEFAULT), H5Gclose);
  CopyWithoutValues work(paths, copy.file_.id());
  work.copy_group(from.id(), to.id(), "");
  if (!work.damaged().empty()) {
    throw InputError(name_, fmt::format("the attributes of the group '{}' cannot be read", work.damaged()),
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
  session.require_no_fault(name_);
}

void write_from(const FilePath& path, const std::string& bytes, const std::function<void(File&)>& fill) {
  OutputFile out(path);
  const auto open = [&] {
    if (path.store() != nullptr) return File::in_memory(bytes, path.string());
    out.write(bytes);
    out.close();
    return File::change(out.temporary(), path.string());
  };
  std::optional<File> file(open());
  fill(*file);
  if (path.store() != nullptr) {
    out.write(file->bytes());
  } else {
    file->close();
  }
  file.reset();
  out.commit();
}

}  // namespace meshorder::hdf5
