// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/hdf5/parts.hpp"

#include "io/hdf5/visitor.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace meshorder::hdf5 {

std::array<hid_t, 10> native_types() {
  return {H5T_NATIVE_DOUBLE, H5T_NATIVE_FLOAT, H5T_NATIVE_INT8,   H5T_NATIVE_UINT8, H5T_NATIVE_INT16,
          H5T_NATIVE_UINT16, H5T_NATIVE_INT32, H5T_NATIVE_UINT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64};
}

std::size_t alternative_of(hid_t type) {
  // compares with known types only: in damaged files, the library does not check the bit fields of other
  // types
  constexpr bool kIsBig = std::endian::native == std::endian::big;
  const std::array<hid_t, 10> known = native_types();
  const auto is_other_order_of = [&](hid_t native) {
    const Handle swapped(H5Tcopy(native), H5Tclose);
    H5Tset_order(swapped.id(), kIsBig ? H5T_ORDER_LE : H5T_ORDER_BE);
    return H5Tequal(type, swapped.id()) > 0;
  };
  const auto found = std::find_if(known.begin(), known.end(), [&](hid_t native) {
    return H5Tequal(type, native) > 0 || is_other_order_of(native);
  });
  return static_cast<std::size_t>(found - known.begin());
}

Handle space_of(const std::vector<std::uint64_t>& shape) {
  const std::vector<hsize_t> lengths(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr), H5Sclose};
}

std::uint64_t most_bytes(hid_t dataset) {
  constexpr std::uint64_t kMostFromOneByte = 4096;
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  return H5Pget_layout(creation.id()) == H5D_CHUNKED ? kMostFromOneByte * (stored + 1) : stored;
}

bool has_values_elsewhere(hid_t dataset) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  return H5Pget_layout(creation.id()) == H5D_VIRTUAL || H5Pget_external_count(creation.id()) > 0;
}

void forget_times(const Handle& creation) { H5Pset_obj_track_times(creation.id(), false); }

std::vector<std::string> names_in(hid_t group, H5_index_t index, H5_iter_order_t order) {
  std::vector<std::pair<std::int64_t, std::string>> links;
  Visitor<H5L_info_t> visitor([&](hid_t /*group*/, const char* name, const H5L_info_t& info) {
    links.emplace_back(index == H5_INDEX_NAME ? 0 : info.corder, name);
  });
  H5Literate(group, order == H5_ITER_NATIVE ? index : H5_INDEX_NAME, H5_ITER_NATIVE, nullptr,
             decltype(visitor)::visit, &visitor);
  visitor.rethrow();
  if (order != H5_ITER_NATIVE) std::sort(links.begin(), links.end());
  std::vector<std::string> names;
  names.reserve(links.size());
  for (auto& link : links) names.push_back(std::move(link.second));
  return names;
}

}  // namespace meshorder::hdf5
