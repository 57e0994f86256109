// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/hdf5/parts.hpp"
#include "io/hdf5/visitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace meshorder::hdf5 {
namespace {

/// Copies an attribute to another object. Leaves out an attribute of references: these are addresses in the
/// old file.
void copy_attribute(hid_t from, const char* name, hid_t to) {
  const Handle attribute(H5Aopen(from, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (!type.is_open() || !space.is_open() || H5Tdetect_class(type.id(), H5T_REFERENCE) > 0) return;
  // converts only types that need it: the library does not check the bit fields of number types, which a
  // damaged file may place anywhere
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

/// Returns whether a group records the order in which its links were made.
bool records_order(hid_t group) {
  const Handle creation(H5Gget_create_plist(group), H5Pclose);
  unsigned flags = 0;
  return H5Pget_link_creation_order(creation.id(), &flags) >= 0 && (flags & H5P_CRT_ORDER_TRACKED) != 0;
}

/// See copy_without_values.
class CopyWithoutValues {
 public:
  CopyWithoutValues(const std::set<std::string>& paths, hid_t target, H5_iter_order_t order)
      : paths_(paths), target_(target), order_(order) {}

  void copy_group(hid_t from, hid_t to, const std::string& path) {
    if (!copy_attributes(from, to)) damaged_ = path;
    H5O_info_t group;
    H5Oget_info(from, &group);
    first_paths_.emplace(group.addr, path.empty() ? "/" : path);
    const bool by_creation = records_order(from);
    for (const std::string& name :
         names_in(from, by_creation ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME, by_creation ? order_ : H5_ITER_INC))
      copy_link(from, to, name, fmt::format("{}/{}", path, name));
  }

  /// Returns the path of a group whose attributes could not be copied; an empty text if there is none.
  [[nodiscard]] const std::string& damaged() const noexcept { return damaged_; }

 private:
  void copy_link(hid_t from, hid_t to, const std::string& name, const std::string& path) {
    H5L_info_t link;
    if (H5Lget_info(from, name.c_str(), &link, H5P_DEFAULT) < 0) return;
    // an object that will change gets a copy for each of its listed paths
    const bool leads_to_listed = paths_.contains(path) || has_listed(path);
    const bool is_followed = link.type == H5L_TYPE_HARD || (link.type == H5L_TYPE_SOFT && leads_to_listed);
    if (!is_followed) return copy_reference(from, to, name, link);
    H5O_info_t object;
    if (H5Oget_info_by_name(from, name.c_str(), &object, H5P_DEFAULT) < 0) return;
    const bool is_listed = object.type == H5O_TYPE_DATASET && paths_.contains(path);
    const bool is_around_listed = object.type == H5O_TYPE_GROUP && has_listed(path);
    const auto known = first_paths_.find(object.addr);
    if (known != first_paths_.end() && !is_listed && !is_around_listed) {
      H5Lcreate_hard(target_, known->second.c_str(), to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      return;
    }
    if (is_listed) {
      const Handle dataset(H5Dopen2(from, name.c_str(), H5P_DEFAULT), H5Dclose);
      const Handle space(H5Dget_space(dataset.id()), H5Sclose);
      (void)empty_copy(dataset.id(), to, name.c_str(), space.id());
    } else if (is_around_listed) {
      const Handle old_group(H5Gopen2(from, name.c_str(), H5P_DEFAULT), H5Gclose);
      const Handle creation = creation_of_copy(old_group.id(), H5P_GROUP_CREATE);
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

  /// Returns whether the group, or something in it, is listed.
  [[nodiscard]] bool has_listed(const std::string& group) const {
    const auto next = paths_.lower_bound(group + "/");
    return next != paths_.end() && next->starts_with(group + "/");
  }

  const std::set<std::string>& paths_;
  hid_t target_;
  H5_iter_order_t order_;
  std::string damaged_;
  std::map<haddr_t, std::string> first_paths_;  // path of each object in the copy, by address in the old file
};

}  // namespace

void keep_order_of_links(const Handle& creation) {
  H5Pset_link_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_link_phase_change(creation.id(), 0, 0);  // not in the group's header, whose parts the library moves
  forget_times(creation);
}

Handle creation_of_copy(hid_t group, hid_t kind) {
  Handle creation(H5Pcreate(kind), H5Pclose);
  if (records_order(group)) keep_order_of_links(creation);
  return creation;
}

bool copy_attributes(hid_t from, hid_t to) {
  if (H5Aexists(from, "\x01") < 0) return false;
  Visitor<H5A_info_t> visitor(
      [&](hid_t object, const char* name, const H5A_info_t& /*info*/) { copy_attribute(object, name, to); });
  const herr_t status =
      H5Aiterate2(from, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, decltype(visitor)::visit, &visitor);
  visitor.rethrow();
  return status >= 0;
}

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

std::string copy_without_values(hid_t file, hid_t copy, const std::set<std::string>& paths,
                                H5_iter_order_t order) {
  const Handle from(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  const Handle to(H5Gopen2(copy, "/", H5P_DEFAULT), H5Gclose);
  CopyWithoutValues work(paths, copy, order);
  work.copy_group(from.id(), to.id(), "");
  return work.damaged();
}

}  // namespace meshorder::hdf5
