// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Replaces hdf5.cpp in builds without libhdf5.
#include "fuzz/families/families.hpp"

namespace meshorder::fuzz {

std::string mutate_hdf5(std::string /*input*/, std::uint32_t /*seed*/) { return {}; }

}  // namespace meshorder::fuzz
