// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/hdf5/mutex.hpp"

#include <string>

namespace meshorder::exodus {

/// Loads netCDF and HDF5 in builds that load them on demand. Throws Unavailable if a library is not found.
void load_library();

/// A lock on libnetcdf and libhdf5: while it lives, no other thread can enter them, and no plug-ins are
/// loaded. The first object starts libnetcdf and keeps libnetcdf from reading cloud credentials, and settings
/// (.ncrc, .daprc, .dodsrc) in the current folder or in HOME.
class Library {
 public:
  Library();
  ~Library();
  Library(const Library&) = delete;
  Library(Library&&) = delete;
  Library& operator=(const Library&) = delete;
  Library& operator=(Library&&) = delete;

 private:
  hdf5::LibraryLock lock_;
  unsigned plugins_ = 0;
};

/// Throws InputError if an HDF5 file has groups, links to other files, or values in other files: libnetcdf
/// would follow all of these, and a mesh needs none. Call it while a Library object lives.
///
/// @param path   the file; empty if it is in memory
/// @param bytes  the content of the file if `path` is empty
/// @param name   for messages
void require_whole_hdf5(const std::string& path, const std::string& bytes, const std::string& name);

}  // namespace meshorder::exodus
