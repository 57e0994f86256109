// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// HDF5 1.12 and later know the functions of 1.10, too.
#ifndef H5_USE_110_API
#define H5_USE_110_API
#endif
#include <hdf5.h>
