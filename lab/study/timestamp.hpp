// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <fmt/chrono.h>

#include <ctime>
#include <string>

namespace meshorder {

/// "2026-11-20T17:30:00Z"
inline std::string timestamp_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace meshorder
