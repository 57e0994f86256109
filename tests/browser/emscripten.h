/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
/* What browser/order.cpp needs of Emscripten's header, for its tests by any compiler. */
#pragma once

#define EMSCRIPTEN_KEEPALIVE
#define EM_JS(type, name, parameters, ...) type name parameters
