// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/error.hpp>

#include <cstddef>
#include <cstring>
#include <string>

// Structures of callers in C that grow from version to version. They begin with `struct_size`, the size of
// the structure in the caller's header.

namespace meshorder::c {

/// The largest `struct_size` that is accepted; a larger value is probably an unset field.
inline constexpr std::size_t kLargestStruct = 4096;

/// Throws InvalidArgument unless the size is one that a header can have. `least` is the size of the
/// structure's first version.
inline void check_struct_size(std::size_t size, const std::string& name,
                              std::size_t least = sizeof(std::size_t)) {
  if (size >= least && size <= kLargestStruct) return;
  throw InvalidArgument(name + ": struct_size is " + std::to_string(size) +
                        ", must be the size of the structure");
}

/// Copies each of the given fields that lies entirely within the first `size` bytes of the structure.
template <class Struct, class... Fields>
void copy_fields(const Struct& from, Struct& to, std::size_t size, Fields Struct::*... fields) {
  const auto copy = [&](auto field) {
    const auto* const begin = reinterpret_cast<const char*>(&from);
    const auto* const end = reinterpret_cast<const char*>(&(from.*field)) + sizeof(from.*field);
    if (static_cast<std::size_t>(end - begin) > size) return;
    std::memcpy(&(to.*field), &(from.*field), sizeof(from.*field));
  };
  (copy(fields), ...);
}

/// Fills in a caller's structure of `size` bytes: its fields, by `copy(to)`, and `struct_size`. Sets the
/// fields that only the caller's newer header has to 0. Does nothing for a null pointer.
template <class Struct, class Copy>
void fill_struct(Struct* to, std::size_t size, const Copy& copy) {
  if (to == nullptr || size < sizeof(std::size_t)) return;
  if (size <= kLargestStruct) std::memset(static_cast<void*>(to), 0, size);
  copy(*to);
  to->struct_size = size;
}

}  // namespace meshorder::c
