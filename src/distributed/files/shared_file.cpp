// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/shared_file.hpp"

#include "base/input_file.hpp"
#include "io/stream/descriptor.hpp"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace meshorder::distributed {
namespace {

// Ranks use independent calls, not collective ones: the bytes of a rank are contiguous, and
// MPI_File_write_at_all of Open MPI 4.1.4 does not report a full disk.

std::string words_of_mpi(int fault) {
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(fault, text.data(), &length);
  return {text.data(), static_cast<std::size_t>(length)};
}

}  // namespace

SharedFile::SharedFile(const Communicator& communicator, const std::string& path, std::string name, Use use)
    : communicator_(communicator), name_(std::move(name)) {
  // Open MPI 4.1.4 hangs if only some of the ranks see the file, so check that first
  communicator.together([&] {
    if (use == Use::read) {
      (void)InputFile(path);
      return;
    }
    const Descriptor file(path, O_WRONLY);
    if (!file.is_open()) throw cannot_be_opened(std::generic_category().message(errno));
  });
  const int mode = use == Use::read ? MPI_MODE_RDONLY : MPI_MODE_WRONLY;
  const int fault = MPI_File_open(communicator.handle(), path.c_str(), mode, MPI_INFO_NULL, &handle_);
  communicator.together([&] {
    if (fault != MPI_SUCCESS) throw cannot_be_opened(words_of_mpi(fault));
  });
}

InputError SharedFile::cannot_be_opened(const std::string& reason) const {
  return {name_, "cannot be opened: " + reason, "every rank has to see the file"};
}

SharedFile::~SharedFile() {
  if (handle_ != MPI_FILE_NULL) MPI_File_close(&handle_);
}

template <class Byte, class Call>
void SharedFile::transfer(Offset at, std::span<Byte> bytes, const Call& call, const Words& words) const {
  const auto size = static_cast<Offset>(bytes.size());
  const Offset chunk = communicator_.chunk_limit();
  std::string fault;
  for (Offset done = 0; done < size && fault.empty(); done += chunk) {
    const auto count = static_cast<int>(std::min(chunk, size - done));
    MPI_Status status{};
    const int code = call(handle_, at + done, bytes.data() + done, count, MPI_BYTE, &status);
    int moved = 0;
    if (code == MPI_SUCCESS) MPI_Get_count(&status, MPI_BYTE, &moved);
    if (code != MPI_SUCCESS) {
      fault = std::string(words.fault) + ": " + words_of_mpi(code);
    } else if (moved < count) {
      fault = std::string(words.too_short) + std::to_string(at + done + count);
    }
  }
  communicator_.together([&] {
    if (!fault.empty()) throw InputError(name_, fault, std::string(words.remedy));
  });
}

void SharedFile::read(Offset at, std::span<std::byte> bytes) const {
  transfer(at, bytes, MPI_File_read_at,
           {"cannot be read", "ends before byte ", "it may have changed while it was read"});
}

void SharedFile::write(Offset at, std::span<const std::byte> bytes) const {
  transfer(at, bytes, MPI_File_write_at,
           {"cannot be written", "cannot be written to byte ", "the disk may be full"});
}

void SharedFile::close() {
  const int code = handle_ == MPI_FILE_NULL ? MPI_SUCCESS : MPI_File_close(&handle_);
  communicator_.together([&] {
    if (code != MPI_SUCCESS)
      throw InputError(name_, "cannot be completed: " + words_of_mpi(code), "the disk may be full");
  });
}

}  // namespace meshorder::distributed
