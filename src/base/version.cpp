// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/version.hpp>

#include <tbb/version.h>
#ifdef MESHORDER_HAS_METIS
#include <metis.h>
#endif

namespace meshorder {
inline namespace v0_3 {
namespace {

std::string number(int major, int minor) { return std::to_string(major) + "." + std::to_string(minor); }

}  // namespace

std::uint32_t version() noexcept { return MESHORDER_VERSION; }

std::string build_info() {
  std::string info = std::to_string(MESHORDER_VERSION_MAJOR) + "." + std::to_string(MESHORDER_VERSION_MINOR) +
                     "." + std::to_string(MESHORDER_VERSION_PATCH);
#if defined(__clang__)
  info += " clang " + number(__clang_major__, __clang_minor__);
#elif defined(__GNUC__)
  info += " gcc " + number(__GNUC__, __GNUC_MINOR__);
#endif
  info += " tbb " + number(TBB_VERSION_MAJOR, TBB_VERSION_MINOR);
#ifdef MESHORDER_HAS_METIS
  info += " metis " + number(METIS_VER_MAJOR, METIS_VER_MINOR) + "/" + std::to_string(IDXTYPEWIDTH);
#endif
#ifdef MESHORDER_HAS_ZLIB
  info += " zlib";
#endif
#ifdef MESHORDER_HAS_LZMA
  info += " lzma";
#endif
#ifdef MESHORDER_HAS_LZ4
  info += " lz4";
#endif
#ifdef MESHORDER_HAS_NETCDF
  info += " netcdf";
#endif
#ifdef MESHORDER_HAS_HDF5
  info += " hdf5";
#endif
#ifdef MESHORDER_HAS_CGNS
  info += " cgns";
#endif
  return info;
}

}  // namespace v0_3
}  // namespace meshorder
