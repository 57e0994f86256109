// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/hdf5/mutex.hpp"

#include <string>

namespace meshorder::exodus {

/// Keeps other threads out of libnetcdf, and out of libhdf5 below it, as long as it lives; meanwhile no
/// plug-ins are loaded. The first one starts libnetcdf, which otherwise reads settings of the current folder
/// and of HOME (.ncrc, .daprc, .dodsrc) and the credentials of clouds.
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

/// Throws InputError unless all that a file of HDF5 holds is in the file itself, as it is in a mesh's:
/// libnetcdf follows links, and reads values in other files, wherever they lead. To be called while a Library
/// lives.
///
/// @param path   the file, or empty
/// @param bytes  the file in memory where there is no path
/// @param name   for messages
void require_whole_hdf5(const std::string& path, const std::string& bytes, const std::string& name);

}  // namespace meshorder::exodus
