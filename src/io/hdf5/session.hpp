// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/hdf5/library.hpp"
#include "io/hdf5/mutex.hpp"

#include <string>

namespace meshorder::hdf5 {

/// A use of libhdf5. While it lives, no other thread can enter libhdf5, and the library prints no errors and
/// loads no plug-ins, which a file can request by the number of a filter. Records calls that fail, even if
/// the library, or a library on top of it, ignores their result. May be nested.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session(Session&&) = delete;
  Session& operator=(const Session&) = delete;
  Session& operator=(Session&&) = delete;

  /// Makes the session record failures again after a library on top of libhdf5 has stopped that.
  void watch() const;

  /// Throws InputError if the system had no memory for a call or could not read or write since the outermost
  /// session began.
  void require_no_fault(const std::string& file) const;

  /// Throws InputError if any call has failed since the outermost session began. For code that opens only
  /// objects that it knows to exist: there, only damage makes a call fail.
  void require_no_failure(const std::string& file) const;

 private:
  LibraryLock lock_;
  unsigned plugins_ = 0;
  H5E_auto2_t handler_ = nullptr;
  void* data_ = nullptr;
};

/// Runs `work`, which reads a file, in a session and returns its result. Throws InputError if any call fails:
/// data that the library could not read must not count as absent.
template <class Work>
auto read_whole(const std::string& file, const Work& work) {
  const Session session;
  auto result = work();
  session.require_no_failure(file);
  return result;
}

/// A pause in a session: while it lives, calls that fail are not recorded. Use it for questions that a failed
/// call answers, for example whether a link leads to an object.
class Unwatched {
 public:
  Unwatched() {
    H5Eget_auto2(H5E_DEFAULT, &handler_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Unwatched() { H5Eset_auto2(H5E_DEFAULT, handler_, data_); }
  Unwatched(const Unwatched&) = delete;
  Unwatched(Unwatched&&) = delete;
  Unwatched& operator=(const Unwatched&) = delete;
  Unwatched& operator=(Unwatched&&) = delete;

 private:
  H5E_auto2_t handler_ = nullptr;
  void* data_ = nullptr;
};

/// Returns the innermost cause of the last failure, in the library's or the system's words, in one line.
std::string last_cause();

}  // namespace meshorder::hdf5
