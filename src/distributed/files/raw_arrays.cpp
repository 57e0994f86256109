// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/raw_arrays.hpp"

#include "distributed/comm/number_types.hpp"

#include <algorithm>
#include <cstdint>

namespace meshorder::distributed {

FileArray raw_array(std::string_view name, FileArray::Role role, Association association, std::size_t type,
                    Offset row, Offset rows, Offset at) {
  FileArray array{};
  name = name.substr(0, array.name.size() - 1);
  std::replace_copy_if(
      name.begin(), name.end(), array.name.begin(),
      [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  array.role = role;
  array.association = association;
  array.type = static_cast<std::uint8_t>(type);
  array.row = size_of_type(type) * row;
  array.at = at;
  array.size = rows * array.row;
  array.stored = array.size;
  return array;
}

bool sort_by_bytes(std::vector<FileArray>& arrays, Offset bytes) {
  std::sort(arrays.begin(), arrays.end(), [](const FileArray& a, const FileArray& b) { return a.at < b.at; });
  Offset before = 0;
  return std::all_of(arrays.begin(), arrays.end(), [&](const FileArray& array) {
    const bool is_free = array.at >= before && array.at <= bytes - array.size;
    before = array.at + array.size;
    return is_free;
  });
}

}  // namespace meshorder::distributed
