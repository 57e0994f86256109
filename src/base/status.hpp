// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include <meshorder/error.hpp>

#include <meshorder.h>

#include <exception>
#include <new>
#include <string>

namespace meshorder {

static_assert(static_cast<int>(Code::ok) == MO_OK);
static_assert(static_cast<int>(Code::invalid_argument) == MO_INVALID_ARGUMENT);
static_assert(static_cast<int>(Code::bad_input) == MO_BAD_INPUT);
static_assert(static_cast<int>(Code::too_large) == MO_TOO_LARGE);
static_assert(static_cast<int>(Code::unavailable) == MO_UNAVAILABLE);
static_assert(static_cast<int>(Code::stopped) == MO_STOPPED);
static_assert(static_cast<int>(Code::io) == MO_IO);
static_assert(static_cast<int>(Code::internal) == MO_INTERNAL);

/// Calls `work()` for a caller in C. Returns MO_OK, or the status of the exception that `work` throws. The
/// text of the exception then replaces `message`, with control characters escaped (see `visible`).
template <class Work>
mo_status status_of(const Work& work, std::string& message) noexcept {
  const auto failure = [&](mo_status status, const char* sentence) noexcept {
    try {
      message = visible(sentence);
    } catch (...) {
      message.clear();  // no memory for the message: return only the status
    }
    return status;
  };
  try {
    work();
    return MO_OK;
  } catch (const Error& error) {
    return failure(static_cast<mo_status>(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return failure(MO_OUT_OF_MEMORY, "out of memory");
  } catch (const std::exception& error) {
    return failure(MO_INTERNAL, error.what());
  } catch (...) {
    return failure(MO_INTERNAL, "unknown failure");
  }
}

}  // namespace meshorder
