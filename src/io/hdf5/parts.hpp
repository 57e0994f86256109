// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Functions that several parts of File use. Call them in a Session.

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

/// Returns a dataspace of this shape; that of a single value if the shape is empty.
Handle space_of(const std::vector<std::uint64_t>& shape);

/// Returns an upper bound on the bytes of a dataset's values. In a dataset of chunks, which filters may have
/// compressed, each stored byte counts as 4096.
std::uint64_t most_bytes(hid_t dataset);

/// Returns whether the values of a dataset are in external files, or in other datasets (a virtual dataset).
bool has_values_elsewhere(hid_t dataset);

/// Makes new datasets store no times of change: the same mesh then always gives the same bytes.
void forget_times(const Handle& creation);

/// Returns the names in a group, sorted by name or by the creation of links (H5_ITER_INC), or as the library
/// lists them unsorted (H5_ITER_NATIVE). Does not use the library's sorting, which trusts the size that a
/// damaged group claims.
std::vector<std::string> names_in(hid_t group, H5_index_t index = H5_INDEX_NAME,
                                  H5_iter_order_t order = H5_ITER_INC);

/// Makes new groups list links by creation in the order in which they are made, also to programs that do not
/// sort them.
void keep_order_of_links(const Handle& creation);

/// Returns the creation properties for a copy of a group, of the kind of a group or of a file, whose root is
/// then the copy. The copy records the order of links if the group does. The group's own properties cannot
/// be used: they hold the addresses of its links in the old file.
Handle creation_of_copy(hid_t group, hid_t kind);

/// Copies all attributes to another object, except references. Returns false if an attribute is damaged, and
/// then copies nothing, because iterating over damaged attributes crashes the library.
bool copy_attributes(hid_t from, hid_t to);

/// Makes a dataset with the type, attributes, chunks and filters of another dataset, but with the shape
/// `space` and without values.
Handle empty_copy(hid_t dataset, hid_t target, const char* name, hid_t space);

/// Copies everything in a file to an empty file, except the values of the datasets at these paths: see
/// File::without_values. Returns the path of a group whose attributes could not be copied; an empty text if
/// there is none.
std::string copy_without_values(hid_t file, hid_t copy, const std::set<std::string>& paths,
                                H5_iter_order_t order);

}  // namespace meshorder::hdf5
