// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/communicator.hpp"

#include <algorithm>
#include <array>
#include <new>

namespace meshorder::distributed {
namespace {

constexpr int kTag = 0;

/// Converts an exception to an Error with its message.
Error in_words(const std::exception_ptr& fault) {
  try {
    std::rethrow_exception(fault);
  } catch (const Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return {Code::internal, "out of memory"};
  } catch (const std::exception& error) {
    return {Code::internal, error.what()};
  } catch (...) {
    return {Code::internal, "unknown failure"};
  }
}

}  // namespace

Session::Session(int& argc, char**& argv) {
  int given = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &given);
  if (given >= MPI_THREAD_MULTIPLE) return;
  MPI_Finalize();
  throw Unavailable("this MPI does not let several threads call it, which PT-Scotch needs");
}

Session::~Session() { MPI_Finalize(); }

void Session::abort(int status) noexcept {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::_Exit(status);
}

std::string name_of_mpi() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  // cut off what follows the version: the packager and date, or lines of settings
  const std::string name(text.data(), static_cast<std::size_t>(length));
  return name.substr(0, name.find_first_of(",\n"));
}

Communicator::Communicator(MPI_Comm ranks) {
  MPI_Comm_dup(ranks, &handle_);
  MPI_Comm_rank(handle_, &rank_);
  MPI_Comm_size(handle_, &size_);
}

Communicator::~Communicator() { MPI_Comm_free(&handle_); }

int Communicator::ranks_on_this_machine() const {
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(handle_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int ranks = 1;
  MPI_Comm_size(machine, &ranks);
  MPI_Comm_free(&machine);
  return ranks;
}

std::vector<Offset> Communicator::starts_to_receive(const std::vector<Offset>& sent) const {
  const auto ranks = static_cast<std::size_t>(size_);
  std::vector<std::int64_t> out(ranks);
  for (std::size_t r = 0; r < ranks; ++r) out[r] = sent[r + 1] - sent[r];
  std::vector<std::int64_t> in(ranks);
  MPI_Alltoall(out.data(), 1, MPI_INT64_T, in.data(), 1, MPI_INT64_T, handle_);
  std::vector<Offset> starts(ranks + 1, 0);
  for (std::size_t r = 0; r < ranks; ++r) starts[r + 1] = starts[r] + in[r];
  return starts;
}

void Communicator::exchange_bytes(const std::byte* sent, const std::vector<Offset>& sent_starts,
                                  std::byte* received, const std::vector<Offset>& received_starts,
                                  std::size_t size_of_value) const {
  const auto width = static_cast<Offset>(size_of_value);
  std::vector<MPI_Request> requests;
  // chunks need no numbers: messages between two ranks arrive in the order in which they are sent
  const auto in_chunks = [&](const std::vector<Offset>& starts, int rank, const auto& start_message) {
    const Offset end = starts[static_cast<std::size_t>(rank) + 1] * width;
    for (Offset at = starts[static_cast<std::size_t>(rank)] * width; at < end; at += chunk_limit_)
      start_message(at, static_cast<int>(std::min(chunk_limit_, end - at)), &requests.emplace_back());
  };
  for (int step = 1; step < size_; ++step) {
    const int from = (rank_ + size_ - step) % size_;
    in_chunks(received_starts, from, [&](Offset at, int count, MPI_Request* request) {
      MPI_Irecv(received + at, count, MPI_BYTE, from, kTag, handle_, request);
    });
  }
  for (int step = 1; step < size_; ++step) {
    const int to = (rank_ + step) % size_;
    in_chunks(sent_starts, to, [&](Offset at, int count, MPI_Request* request) {
      MPI_Isend(sent + at, count, MPI_BYTE, to, kTag, handle_, request);
    });
  }
  const auto own = static_cast<std::size_t>(rank_);
  std::copy(sent + sent_starts[own] * width, sent + sent_starts[own + 1] * width,
            received + received_starts[own] * width);
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

std::vector<std::string> Communicator::broadcast(const std::vector<std::string>& at_root) const {
  std::vector<char> characters;
  together([&] {
    for (const std::string& text : at_root)
      characters.insert(characters.end(), text.c_str(), text.c_str() + text.size() + 1);
  });
  characters = broadcast(std::move(characters));
  return together([&] {
    std::vector<std::string> texts;
    for (const char* at = characters.data(); at < characters.data() + characters.size();)
      at += texts.emplace_back(at).size() + 1;
    return texts;
  });
}

std::int64_t Communicator::broadcast_count(std::int64_t at_root) const {
  MPI_Bcast(&at_root, 1, MPI_INT64_T, 0, handle_);
  return at_root;
}

void Communicator::broadcast_bytes(std::byte* bytes, Offset count) const {
  for (Offset at = 0; at < count; at += chunk_limit_)
    MPI_Bcast(bytes + at, static_cast<int>(std::min(chunk_limit_, count - at)), MPI_BYTE, 0, handle_);
}

void Communicator::gather_bytes(const std::byte* own, std::byte* all, std::size_t bytes_each) const {
  const auto count = static_cast<int>(bytes_each);
  MPI_Allgather(own, count, MPI_BYTE, all, count, MPI_BYTE, handle_);
}

std::vector<std::int64_t> Communicator::sums(std::vector<std::int64_t> own) const {
  // sums of integers do not depend on the sequence of additions
  const auto count = static_cast<Offset>(own.size());
  const Offset most = std::max<Offset>(1, chunk_limit_ / Offset{sizeof(std::int64_t)});
  for (Offset at = 0; at < count; at += most) {
    MPI_Allreduce(MPI_IN_PLACE, own.data() + at, static_cast<int>(std::min(most, count - at)), MPI_INT64_T,
                  MPI_SUM, handle_);
  }
  return own;
}

void Communicator::settle(const std::exception_ptr& fault) const {
  int first = fault ? rank_ : size_;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, handle_);
  if (first == size_) return;
  std::string message;
  auto code = static_cast<int>(Code::internal);
  if (rank_ == first) {
    const Error error = in_words(fault);
    code = static_cast<int>(error.code());
    message = first == 0 ? error.what() : "rank " + std::to_string(first) + ": " + error.what();
  }
  auto length = static_cast<int>(message.size());
  MPI_Bcast(&code, 1, MPI_INT, first, handle_);
  MPI_Bcast(&length, 1, MPI_INT, first, handle_);
  message.resize(static_cast<std::size_t>(length));
  MPI_Bcast(message.data(), length, MPI_CHAR, first, handle_);
  throw SharedError(static_cast<Code>(code), message);
}

}  // namespace meshorder::distributed
