// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/hdf5/session.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <new>
#include <string_view>

namespace meshorder::hdf5 {
namespace {

/// Failures since the outermost session began; recorded without allocating memory.
struct Faults {
  int sessions = 0;
  bool any = false;
  bool memory = false;
  std::array<char, 64> words{};  ///< the system's message for a failed read or write, if there was one
  std::array<char, 64> cause{};  ///< the library's message for the first call that failed
};

/// Guarded by the library's mutex.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): libhdf5 has one state, too
Faults faults;

/// Returns the system's message within the library's description of a failed call; an empty text if there is
/// none.
std::string_view system_words(std::string_view cause) {
  constexpr std::string_view kBefore = "error message = '";
  const std::size_t at = cause.find(kBefore);
  if (at == std::string_view::npos) return {};
  cause.remove_prefix(at + kBefore.size());
  return cause.substr(0, cause.find('\''));
}

/// Copies as much of a text as fits before a final zero byte.
template <std::size_t Size>
void keep(std::string_view text, std::array<char, Size>& into) {
  into = {};
  std::copy_n(text.begin(), std::min(text.size(), Size - 1), into.begin());
}

/// Records one error of the library's stack. `first` points to a bool: whether no call has failed before.
herr_t note_cause(unsigned /*depth*/, const H5E_error2_t* error, void* first) {
  const std::string_view cause = error->desc != nullptr ? error->desc : "";
  if (cause.starts_with("memory allocation failed")) faults.memory = true;
  if (faults.words.front() == '\0') keep(system_words(cause), faults.words);
  // later causes overwrite earlier ones: the walk ends at the innermost function, which failed first
  if (*static_cast<const bool*>(first)) keep(cause.substr(0, cause.find('\n')), faults.cause);
  return 0;
}

herr_t note_failure(hid_t stack, void* /*data*/) {
  bool first = !faults.any;
  faults.any = true;
  return H5Ewalk2(stack, H5E_WALK_DOWNWARD, note_cause, &first);
}

}  // namespace

Session::Session() : lock_(enter_library()) {
  if (faults.sessions++ == 0) {
    faults = {.sessions = 1};
    errno = 0;
  }
  H5PLget_loading_state(&plugins_);
  H5PLset_loading_state(0);
  H5Eget_auto2(H5E_DEFAULT, &handler_, &data_);
  watch();
}

Session::~Session() {
  faults.memory = faults.memory || errno == ENOMEM;
  H5Eset_auto2(H5E_DEFAULT, handler_, data_);
  H5PLset_loading_state(plugins_);
  --faults.sessions;
}

// NOLINTBEGIN(readability-convert-member-functions-to-static): without a session these functions mean nothing
void Session::watch() const { H5Eset_auto2(H5E_DEFAULT, note_failure, nullptr); }

void Session::require_no_fault(const std::string& file) const {
  if (faults.words.front() != '\0') {
    throw InputError(file,
                     std::string("HDF5 could not read or write all of it (") + faults.words.data() + ")",
                     "is the disk full or failing?");
  }
  // parts of the library ignore a failed malloc; a later failure then gives another cause or no cause
  if (faults.memory || errno == ENOMEM)
    throw InputError(file, "HDF5 had too little memory for a part of it", "the file may be damaged");
}

void Session::require_no_failure(const std::string& file) const {
  require_no_fault(file);
  if (!faults.any) return;
  throw InputError(file,
                   std::string("HDF5 could not read or write a part of it (") + faults.cause.data() + ")",
                   "the file may be damaged");
}
// NOLINTEND(readability-convert-member-functions-to-static)

std::string last_cause() {
  std::string cause;
  const auto take = [](unsigned /*depth*/, const H5E_error2_t* error, void* into) -> herr_t {
    try {
      if (error->desc != nullptr) *static_cast<std::string*>(into) = error->desc;
      return 0;
    } catch (const std::bad_alloc&) {
      return -1;  // keeps the cause found before
    }
  };
  // the walk goes from the called function to the innermost one, which failed first
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, take, &cause);
  const std::string_view words = system_words(cause);
  if (!words.empty()) return std::string(words);
  return cause.empty() ? "it gives no cause" : cause.substr(0, cause.find('\n'));
}

void close_nothing_at_exit() {
  at_first_entry = [] { H5dont_atexit(); };
}

}  // namespace meshorder::hdf5
