// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <netcdf.h>
#include <netcdf_mem.h>

#ifdef MESHORDER_NETCDF_FILE
#include "io/loaded_library.hpp"

namespace meshorder {

inline constinit const LoadedLibrary kNetcdf{"netCDF", MESHORDER_NETCDF_FILE};

#define MESHORDER_NETCDF_FUNCTION(name) MESHORDER_LOADED_FUNCTION(kNetcdf, name)

MESHORDER_NETCDF_FUNCTION(nc__create);
MESHORDER_NETCDF_FUNCTION(nc__open);
MESHORDER_NETCDF_FUNCTION(nc_abort);
MESHORDER_NETCDF_FUNCTION(nc_close);
MESHORDER_NETCDF_FUNCTION(nc_close_memio);
MESHORDER_NETCDF_FUNCTION(nc_create_mem);
MESHORDER_NETCDF_FUNCTION(nc_def_dim);
MESHORDER_NETCDF_FUNCTION(nc_def_var);
MESHORDER_NETCDF_FUNCTION(nc_def_var_deflate);
MESHORDER_NETCDF_FUNCTION(nc_enddef);
MESHORDER_NETCDF_FUNCTION(nc_free_string);
MESHORDER_NETCDF_FUNCTION(nc_get_att);
MESHORDER_NETCDF_FUNCTION(nc_get_att_string);
MESHORDER_NETCDF_FUNCTION(nc_get_var);
MESHORDER_NETCDF_FUNCTION(nc_get_vara);
MESHORDER_NETCDF_FUNCTION(nc_get_vara_double);
MESHORDER_NETCDF_FUNCTION(nc_get_vara_int);
MESHORDER_NETCDF_FUNCTION(nc_get_vara_longlong);
MESHORDER_NETCDF_FUNCTION(nc_initialize);
MESHORDER_NETCDF_FUNCTION(nc_inq);
MESHORDER_NETCDF_FUNCTION(nc_inq_att);
MESHORDER_NETCDF_FUNCTION(nc_inq_attname);
MESHORDER_NETCDF_FUNCTION(nc_inq_dim);
MESHORDER_NETCDF_FUNCTION(nc_inq_dimids);
MESHORDER_NETCDF_FUNCTION(nc_inq_format);
MESHORDER_NETCDF_FUNCTION(nc_inq_unlimdims);
MESHORDER_NETCDF_FUNCTION(nc_inq_var);
MESHORDER_NETCDF_FUNCTION(nc_inq_var_chunking);
MESHORDER_NETCDF_FUNCTION(nc_inq_var_deflate);
MESHORDER_NETCDF_FUNCTION(nc_inq_varnatts);
MESHORDER_NETCDF_FUNCTION(nc_inq_vardimid);
MESHORDER_NETCDF_FUNCTION(nc_open_mem);
MESHORDER_NETCDF_FUNCTION(nc_put_att);
MESHORDER_NETCDF_FUNCTION(nc_put_att_text);
MESHORDER_NETCDF_FUNCTION(nc_put_vara);
MESHORDER_NETCDF_FUNCTION(nc_put_vara_double);
MESHORDER_NETCDF_FUNCTION(nc_put_vara_float);
MESHORDER_NETCDF_FUNCTION(nc_put_vara_int);
MESHORDER_NETCDF_FUNCTION(nc_put_vara_longlong);
MESHORDER_NETCDF_FUNCTION(nc_put_vara_ulonglong);
MESHORDER_NETCDF_FUNCTION(nc_set_fill);
MESHORDER_NETCDF_FUNCTION(nc_strerror);

}  // namespace meshorder
#endif
