// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/error.hpp>

namespace meshorder {

/// Thrown for files of one mesh that were not written together, by their marks.
struct NotTogether : InputError {
  using InputError::InputError;
  explicit NotTogether(const InputError& error) : InputError(error) {}
};

}  // namespace meshorder
