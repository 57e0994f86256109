// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/hdf5/library.hpp"

#include <cgns_io.h>

#ifdef MESHORDER_CGNS_FILE
#include "io/loaded_library.hpp"

namespace meshorder {

inline constinit const LoadedLibrary kCgns{"the CGNS library", MESHORDER_CGNS_FILE};

#define MESHORDER_CGNS_FUNCTION(name) MESHORDER_LOADED_FUNCTION(kCgns, name)

MESHORDER_CGNS_FUNCTION(cgio_check_file);
MESHORDER_CGNS_FUNCTION(cgio_children_ids);
MESHORDER_CGNS_FUNCTION(cgio_close_file);
MESHORDER_CGNS_FUNCTION(cgio_error_message);
MESHORDER_CGNS_FUNCTION(cgio_get_data_type);
MESHORDER_CGNS_FUNCTION(cgio_get_dimensions);
MESHORDER_CGNS_FUNCTION(cgio_get_label);
MESHORDER_CGNS_FUNCTION(cgio_get_name);
MESHORDER_CGNS_FUNCTION(cgio_get_root_id);
MESHORDER_CGNS_FUNCTION(cgio_is_link);
MESHORDER_CGNS_FUNCTION(cgio_new_node);
MESHORDER_CGNS_FUNCTION(cgio_number_children);
MESHORDER_CGNS_FUNCTION(cgio_open_file);
MESHORDER_CGNS_FUNCTION(cgio_read_all_data);
MESHORDER_CGNS_FUNCTION(cgio_release_id);

}  // namespace meshorder
#endif

namespace meshorder::cgns {

/// Loads the CGNS library and HDF5 in builds that load them on demand. Throws Unavailable if one is not
/// found.
inline void load_library() {
#ifdef MESHORDER_CGNS_FILE
  kCgns.load();
#endif
  hdf5::load_library();
}

}  // namespace meshorder::cgns
