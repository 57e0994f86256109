// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// What the functions of File have in common. To be called in a Session.

#include "io/hdf5/handle.hpp"
#include "io/hdf5/library.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace meshorder::hdf5 {

/// Returns the library's number types in memory, in the order of Values.
std::array<hid_t, 10> native_types();

/// Returns the alternative of Values for the usual number types, in either byte order; 10 for all others.
std::size_t alternative_of(hid_t type);

/// Returns the most bytes that the values of a dataset may take: no filter of HDF5 makes more than some
/// thousand bytes of one.
std::uint64_t most_bytes(hid_t dataset);

/// Returns whether the values of a dataset are in files of their own, or those of datasets of other files.
bool has_values_elsewhere(hid_t dataset);

/// Sets that a dataset does not hold when it was last changed: the same mesh is the same bytes at any time.
void forget_times(const Handle& creation);

/// Returns the names in a group, in the order of the names or of the creation of links. The library's own
/// sorting trusts what a damaged group says of its size.
std::vector<std::string> names_in(hid_t group, H5_index_t index = H5_INDEX_NAME);

/// Copies all attributes to another object. Returns false, and copies none, where one is damaged: the library
/// does not survive to iterate over such.
bool copy_attributes(hid_t from, hid_t to);

/// Makes a dataset of the type, the attributes, chunks and filters of another one, but of another shape and
/// without its values.
Handle empty_copy(hid_t dataset, hid_t target, const char* name, hid_t space);

/// Copies everything in a file to an empty one, but for the values of what these paths name: see
/// File::without_values. Returns the path of a group whose attributes could not be copied; an empty text
/// without.
std::string copy_without_values(hid_t file, hid_t copy, const std::set<std::string>& paths);

}  // namespace meshorder::hdf5
