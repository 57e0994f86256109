// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// makes HDF5 1.12 and later offer the functions of 1.10
#ifndef H5_USE_110_API
#define H5_USE_110_API
#endif
#include <hdf5.h>
