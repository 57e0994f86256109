// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/hdf5/hdf5_file.hpp"
#include "io/hdf5/parts.hpp"
#include "io/hdf5/session.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace meshorder::hdf5 {

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

void File::put_attribute(const std::string& path, const std::string& name,
                         const std::vector<std::uint64_t>& shape, hid_t type, hid_t memory,
                         const void* value) {
  const Handle object = open_object(path);
  if (H5Aexists(object.id(), name.c_str()) > 0) H5Adelete(object.id(), name.c_str());
  const Handle space = space_of(shape);
  const Handle attribute(H5Acreate2(object.id(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT),
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
  put_attribute(path, name, {}, type_of_old().id(), H5T_NATIVE_INT64, &value);
}

void File::set_attribute(const std::string& path, const std::string& name, double value) {
  const Session session;
  put_attribute(path, name, {}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void File::set_attribute(const std::string& path, const std::string& name, const std::string& value) {
  const Session session;
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), value.size() + 1);
  put_attribute(path, name, {}, type.id(), type.id(), value.c_str());
}

void File::set_attribute(const std::string& path, const std::string& name,
                         std::span<const std::int64_t> values) {
  const Session session;
  put_attribute(path, name, {values.size()}, H5T_STD_I64LE, H5T_NATIVE_INT64, values.data());
}

}  // namespace meshorder::hdf5
