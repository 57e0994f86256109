// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/hdf5/hdf5_file.hpp"
#include "io/hdf5/parts.hpp"
#include "io/hdf5/session.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

namespace meshorder::hdf5 {
namespace {

/// Returns the length in bytes of the texts of a type, if they have one length of at most 1,024; else 0.
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

/// Returns the type of a text of `width` characters: an array of 8-bit integers.
Handle type_of_texts(std::size_t width) {
  const hsize_t count = width;
  return {H5Tarray_create2(H5T_STD_I8LE, 1, &count), H5Tclose};
}

std::string without_padding(std::string_view text) {
  text = text.substr(0, text.find('\0'));
  return std::string(text.substr(0, text.find_last_not_of(' ') + 1));
}

}  // namespace

/// Returns texts of any length, each up to its first zero byte.
std::vector<std::string> File::read_strings(const std::string& path, const Handle& dataset,
                                            const Handle& type) const {
  constexpr std::uint64_t kReference = 16;  // bytes that a dataset stores for each text
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const hssize_t rows = H5Sget_simple_extent_npoints(space.id());
  if (rows < 0) fail(path, "has no values", "the file may be damaged");
  const auto count = static_cast<std::uint64_t>(rows);
  require_stored(path, dataset, count, kReference, "texts");
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
  require_stored(path, dataset, static_cast<std::uint64_t>(rows), width, "texts");
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
  const Handle dataset = open_dataset_if_there(path);
  const Handle type(dataset.is_open() ? H5Dget_type(dataset.id()) : -1, H5Tclose);
  return type.is_open() && (H5Tis_variable_str(type.id()) > 0 || width_of_texts(type.id()) > 0);
}

void File::write_texts(const std::string& path, std::span<const std::string> texts, std::size_t width,
                       char filling) {
  const Session session;
  std::string bytes;
  bytes.reserve(texts.size() * width);
  for (const std::string& text : texts) {
    const std::string_view held = utf8_prefix(text, width);
    bytes.append(held);
    bytes.append(width - held.size(), filling);
  }
  const Handle type = type_of_texts(width);
  const Handle old = open_dataset_if_there(path);
  const std::string aside = free_path(path);
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

}  // namespace meshorder::hdf5
