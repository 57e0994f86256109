// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/shared_file.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace meshorder::distributed {
namespace {

// Ranks transfer by calls of their own, not by collective ones: their bytes are contiguous, and Open
// MPI 4.1.4 does not tell of a disk that is full in MPI_File_write_at_all.

std::string words_of_mpi(int fault) {
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(fault, text.data(), &length);
  return {text.data(), static_cast<std::size_t>(length)};
}

}  // namespace

SharedFile::SharedFile(const Communicator& communicator, const std::string& path, std::string name, Use use)
    : communicator_(communicator), name_(std::move(name)) {
  const int mode = use == Use::read ? MPI_MODE_RDONLY : MPI_MODE_WRONLY;
  const int fault = MPI_File_open(communicator.handle(), path.c_str(), mode, MPI_INFO_NULL, &handle_);
  communicator.together([&] {
    if (fault != MPI_SUCCESS)
      throw InputError(name_, "cannot be opened: " + words_of_mpi(fault), "every rank has to see the file");
  });
}

SharedFile::~SharedFile() {
  if (handle_ != MPI_FILE_NULL) MPI_File_close(&handle_);
}

template <class Byte, class Transfer>
void SharedFile::in_chunks(Offset at, std::span<Byte> bytes, const Transfer& transfer) const {
  const auto size = static_cast<Offset>(bytes.size());
  const Offset chunk = communicator_.chunk_limit();
  for (Offset done = 0; done < size; done += chunk)
    transfer(at + done, bytes.data() + done, static_cast<int>(std::min(chunk, size - done)));
}

void SharedFile::read(Offset at, std::span<std::byte> bytes) const {
  std::string fault;
  in_chunks(at, bytes, [&](Offset from, std::byte* target, int count) {
    MPI_Status status{};
    const int code = MPI_File_read_at(handle_, from, target, count, MPI_BYTE, &status);
    int got = 0;
    if (code == MPI_SUCCESS) MPI_Get_count(&status, MPI_BYTE, &got);
    if (code != MPI_SUCCESS) {
      fault = "cannot be read: " + words_of_mpi(code);
    } else if (got < count) {
      fault = "ends before byte " + std::to_string(from + count);
    }
  });
  communicator_.together([&] {
    if (!fault.empty()) throw InputError(name_, fault, "it may have changed while it was read");
  });
}

void SharedFile::write(Offset at, std::span<const std::byte> bytes) const {
  std::string fault;
  in_chunks(at, bytes, [&](Offset to, const std::byte* source, int count) {
    MPI_Status status{};
    const int code = MPI_File_write_at(handle_, to, source, count, MPI_BYTE, &status);
    int put = 0;
    if (code == MPI_SUCCESS) MPI_Get_count(&status, MPI_BYTE, &put);
    if (code != MPI_SUCCESS) {
      fault = "cannot be written: " + words_of_mpi(code);
    } else if (put < count) {
      fault = "cannot be written to its end";
    }
  });
  communicator_.together([&] {
    if (!fault.empty()) throw InputError(name_, fault, "the disk may be full");
  });
}

void SharedFile::close() {
  const int code = handle_ == MPI_FILE_NULL ? MPI_SUCCESS : MPI_File_close(&handle_);
  communicator_.together([&] {
    if (code != MPI_SUCCESS)
      throw InputError(name_, "cannot be completed: " + words_of_mpi(code), "the disk may be full");
  });
}

}  // namespace meshorder::distributed
