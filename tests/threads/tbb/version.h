// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#define TBB_VERSION_MAJOR 0
#define TBB_VERSION_MINOR 0
