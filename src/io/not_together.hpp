// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/error.hpp>

namespace meshorder {

/// Thrown if the marks of a mesh's files show that they were not written together.
struct NotTogether : InputError {
  using InputError::InputError;
  explicit NotTogether(const InputError& error) : InputError(error) {}
};

}  // namespace meshorder
