// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/values.hpp"

#include "base/memory.hpp"
#include "io/hdf5/hdf5_file.hpp"
#include "io/hdf5/parts.hpp"
#include "io/hdf5/session.hpp"
#include "io/stream/read_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

namespace meshorder::hdf5 {
namespace {

/// Returns the name or number of a dataset's filter that this library lacks; empty if it has all filters.
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

/// Returns the size of a chunk in bytes: less than 4 GiB in files that the library has written.
std::uint64_t bytes_of_chunk(hid_t creation, hid_t type) {
  std::array<hsize_t, H5S_MAX_RANK> lengths{};
  const int rank = H5Pget_chunk(creation, H5S_MAX_RANK, lengths.data());
  std::uint64_t bytes = H5Tget_size(type);
  for (int k = 0; k < rank; ++k) bytes = bytes_for(bytes, lengths.at(static_cast<std::size_t>(k)));
  return bytes;
}

/// Returns the properties of a new dataset.
Handle new_creation() {
  Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  forget_times(creation);
  return creation;
}

/// Makes a dataset, and the groups that contain it.
Handle new_dataset(hid_t file, const std::string& path, hid_t type, const std::vector<std::uint64_t>& shape,
                   const Handle& creation) {
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  return {H5Dcreate2(file, path.c_str(), type, space_of(shape).id(), links.id(), creation.id(), H5P_DEFAULT),
          H5Dclose};
}

}  // namespace

std::uint64_t DatasetInfo::size() const {
  std::uint64_t size = 1;
  for (const std::uint64_t n : shape) {
    if (n != 0 && size > UINT64_MAX / n) return UINT64_MAX;
    size *= n;
  }
  return size;
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
         "whole numbers of 8 to 64 bits, float and double are supported");
  }
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 0 || H5Sget_simple_extent_type(space.id()) == H5S_NULL) {
    fail(path, "has no values", "the file may be damaged");
  }
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
  info.shape.assign(shape.begin(), shape.end());

  if (has_values_elsewhere(dataset.id())) {
    fail(path, "has its values in other files", "copy them into one file (h5repack)");
  }
  if (const std::string filter = lacking_filter(creation.id()); !filter.empty()) {
    fail(path, fmt::format("is compressed by the filter '{}', which this HDF5 lacks", filter),
         "decompress it (h5repack -f NONE)");
  }
  if (H5Pget_layout(creation.id()) == H5D_CHUNKED) {
    // memory for two copies: the stored bytes and the decoded bytes
    const std::string fault =
        refused_for_a_while(2 * bytes_of_chunk(creation.id(), type.id()), "a chunk of it");
    if (!fault.empty()) fail(path, "cannot be read: " + fault, kClaimRemedy);
  }
  require_stored(path, dataset, info.size(), std::min<std::size_t>(H5Tget_size(type.id()), 8), "values");
  return info;
}

void File::require_stored(const std::string& path, const Handle& dataset, std::uint64_t count,
                          std::uint64_t bytes_each, std::string_view what) const {
  if (count <= most_bytes(dataset.id()) / bytes_each) return;
  fail(path,
       fmt::format("claims {} {}, but only {} bytes are stored", count, what,
                   H5Dget_storage_size(dataset.id())),
       "it may never have been written, or the file is damaged");
}

std::optional<std::size_t> File::number_type(const std::string& path) const {
  const Session session;
  const Handle dataset = open_dataset_if_there(path);
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
  return numbers_of_type(of.alternative, [&](auto& numbers) {
    claim(path, bytes_for(of.size(), sizeof(numbers[0])));
    resize_large(numbers, of.size());
    if (!numbers.empty()) read(path, native_types()[of.alternative], numbers.data());
  });
}

std::vector<Index> File::read_indices(const std::string& path) const {
  const Session session;
  std::vector<Index> values;
  const std::uint64_t size = info(path).size();
  claim(path, bytes_for(size, sizeof(Index)));
  resize_large(values, size);
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
  Handle dataset = open_dataset_if_there(path);
  if (!dataset.is_open()) {
    dataset = new_dataset(file_.id(), path, type, shape, new_creation());
  } else {
    const Handle old_space(H5Dget_space(dataset.id()), H5Sclose);
    const hssize_t old_count = H5Sget_simple_extent_npoints(old_space.id());
    if (old_count < 0 || static_cast<std::uint64_t>(old_count) != count) {
      const std::string aside = free_path(path);
      H5Lmove(file_.id(), path.c_str(), file_.id(), aside.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      Handle copy = empty_copy(dataset.id(), file_.id(), path.c_str(), space_of(shape).id());
      H5Ldelete(file_.id(), aside.c_str(), H5P_DEFAULT);
      dataset = std::move(copy);
    }
  }
  // closing the dataset writes the values that the library has buffered
  const bool written =
      dataset.is_open() &&
      (count == 0 || H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0) &&
      dataset.close() >= 0;
  if (!written) fail(path, fmt::format("cannot be written ({})", last_cause()), "is the disk full?");
}

std::string File::free_path(const std::string& path) const {
  std::string free = path + ".old";
  for (int k = 2; H5Lexists(file_.id(), free.c_str(), H5P_DEFAULT) > 0; ++k)
    free = fmt::format("{}.old{}", path, k);
  return free;
}

void File::make_room(const std::string& path, std::size_t alternative,
                     const std::vector<std::uint64_t>& shape) {
  const Session session;
  const Handle creation = new_creation();
  H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
  const Handle dataset = new_dataset(file_.id(), path, native_types()[alternative], shape, creation);
  if (!dataset.is_open())
    fail(path, fmt::format("cannot be written ({})", last_cause()), "is the disk full?");
}

void File::give_room(const std::string& path) {
  const Session session;
  Handle dataset = open_dataset(path);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  // writing one value makes the library allocate the whole dataset
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

}  // namespace meshorder::hdf5
