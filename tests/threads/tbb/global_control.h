// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "threads.hpp"  // IWYU pragma: export
