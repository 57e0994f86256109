// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/hdf5/library.hpp"
#include "io/hdf5/mutex.hpp"

#include <string>

namespace meshorder::hdf5 {

/// Keeps other threads out of libhdf5 and the library quiet as long as it lives. Meanwhile the library loads
/// no plug-ins, which a file can ask for by the number of a filter. May be nested. Takes note of calls that
/// fail, also where the library, or one on top of it, does not look at their result.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session(Session&&) = delete;
  Session& operator=(const Session&) = delete;
  Session& operator=(Session&&) = delete;

  /// Takes note of failures again after a library on top of libhdf5 has turned that off.
  void watch() const;

  /// Throws InputError if the system had no memory for a call or could not read or write since the outermost
  /// session began.
  void require_no_fault(const std::string& file) const;

  /// Throws InputError if any call has failed since then: for what asks first whether a thing is there, so
  /// that only damage makes a call fail.
  void require_no_failure(const std::string& file) const;

 private:
  LibraryLock lock_;
  unsigned plugins_ = 0;
  H5E_auto2_t handler_ = nullptr;
  void* data_ = nullptr;
};

/// Returns what `work` reads of a file, in a session. Throws InputError if any call fails meanwhile: what the
/// library could not read must not be taken for absent.
template <class Work>
auto read_whole(const std::string& file, const Work& work) {
  const Session session;
  auto result = work();
  session.require_no_failure(file);
  return result;
}

/// Within a session, takes no note of calls that fail as long as it lives: for questions to which failure is
/// an answer.
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

/// Returns what the library says of the last failure, its first cause, in one line.
std::string last_cause();

}  // namespace meshorder::hdf5
