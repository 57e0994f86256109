// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include <meshorder/error.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace meshorder::distributed {

/// A file that all ranks read or write at the same time with MPI-IO; each rank has its own range of bytes.
/// Every rank has to call all functions.
class SharedFile {
 public:
  enum class Use : std::uint8_t { read, write };

  /// Opens an existing file; `name` is its name in messages.
  ///
  /// @throws SharedError if a rank cannot open it
  SharedFile(const Communicator& communicator, const std::string& path, std::string name, Use use);
  ~SharedFile();
  SharedFile(const SharedFile&) = delete;
  SharedFile(SharedFile&&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;
  SharedFile& operator=(SharedFile&&) = delete;

  /// Reads the file from byte `at` on into `bytes`; each rank has its own place and size. O(bytes).
  ///
  /// @throws SharedError if a rank cannot read all of its bytes
  void read(Offset at, std::span<std::byte> bytes) const;

  /// Writes `bytes` to the file from byte `at` on; each rank has its own place and size. O(bytes).
  ///
  /// @throws SharedError if a rank cannot write, as on a full disk
  void write(Offset at, std::span<const std::byte> bytes) const;

  /// Writes buffered bytes and closes the file.
  ///
  /// @throws SharedError if a rank cannot write or close it
  void close();

 private:
  /// Texts of the messages on a call that fails, and on a call that transfers too few bytes.
  struct Words {
    std::string_view fault;
    std::string_view too_short;  ///< text before the number of the byte where the transfer should have ended
    std::string_view remedy;
  };

  [[nodiscard]] InputError cannot_be_opened(const std::string& reason) const;

  /// Reads or writes the rank's own bytes with a function of MPI, chunk by chunk.
  template <class Byte, class Call>
  void transfer(Offset at, std::span<Byte> bytes, const Call& call, const Words& words) const;

  const Communicator& communicator_;
  std::string name_;
  MPI_File handle_ = MPI_FILE_NULL;
};

}  // namespace meshorder::distributed
