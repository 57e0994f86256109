// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/checksum.hpp"
#include "base/index.hpp"
#include <meshorder/error.hpp>

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace meshorder::distributed {

/// Initialises MPI; the destructor finalises MPI. A process makes one Session, before any `Communicator`.
class Session {
 public:
  /// @throws Unavailable if MPI does not support calls from several threads, which PT-Scotch needs
  Session(int& argc, char**& argv);
  ~Session();
  Session(const Session&) = delete;
  Session(Session&&) = delete;
  Session& operator=(const Session&) = delete;
  Session& operator=(Session&&) = delete;

  /// Ends all processes; for use when this process cannot go on and others may wait for it.
  [[noreturn]] static void abort(int status) noexcept;
};

/// Returns the name and version of the MPI library: "Open MPI v4.1.4".
std::string name_of_mpi();

/// The exception of one rank, thrown on all ranks, so that no rank waits for another.
struct SharedError : Error {
  using Error::Error;
};

/// Values to or from each rank: values[starts[r]] … values[starts[r + 1] − 1] belong to rank r.
template <class T>
struct Parcels {
  std::vector<T> values;
  std::vector<Offset> starts;  ///< ranks + 1 entries, ascending from 0

  [[nodiscard]] std::span<const T> operator[](int rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return {values.data() + starts[r], values.data() + starts[r + 1]};
  }
};

/// Returns the values sorted into parcels, one for each rank. The values for one rank keep their sequence.
/// O(values + ranks) time, plus the calls of the two functions.
///
/// @param rank_of   returns the rank of value k; called twice for each value
/// @param value_of  returns value k
template <class RankOf, class ValueOf>
[[nodiscard]] auto parcels_by_rank(std::size_t count, int ranks, const RankOf& rank_of,
                                   const ValueOf& value_of) {
  Parcels<std::invoke_result_t<const ValueOf&, std::size_t>> parcels;
  parcels.starts.assign(static_cast<std::size_t>(ranks) + 1, 0);
  for (std::size_t k = 0; k < count; ++k) ++parcels.starts[static_cast<std::size_t>(rank_of(k)) + 1];
  std::partial_sum(parcels.starts.begin(), parcels.starts.end(), parcels.starts.begin());
  std::vector<Offset> next(parcels.starts.begin(), parcels.starts.end() - 1);
  parcels.values.resize(count);
  for (std::size_t k = 0; k < count; ++k)
    parcels.values[static_cast<std::size_t>(next[static_cast<std::size_t>(rank_of(k))]++)] = value_of(k);
  return parcels;
}

/// A group of ranks. All ranks have to call the functions of this class in the same sequence, except
/// `handle`, `rank`, `size`, `is_root`, `set_chunk_limit` and `chunk_limit`. Sums do not depend on timing.
class Communicator {
 public:
  /// Duplicates an MPI communicator; by default, that of all ranks.
  explicit Communicator(MPI_Comm ranks = MPI_COMM_WORLD);
  ~Communicator();
  Communicator(const Communicator&) = delete;
  Communicator(Communicator&&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  Communicator& operator=(Communicator&&) = delete;

  [[nodiscard]] MPI_Comm handle() const noexcept { return handle_; }
  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] bool is_root() const noexcept { return rank_ == 0; }

  /// Returns how many ranks run on this rank's machine, this rank included.
  [[nodiscard]] int ranks_on_this_machine() const;

  /// Sets the maximum size of a message in bytes, 1 … 2^31 − 1: MPI 3 counts bytes with an int.
  void set_chunk_limit(Offset bytes) noexcept { chunk_limit_ = bytes; }
  [[nodiscard]] Offset chunk_limit() const noexcept { return chunk_limit_; }

  /// Sends one parcel to each rank and returns the parcels received. Messages are sent in chunks, so that a
  /// parcel may have more than 2 GiB. O(values + ranks).
  ///
  /// @param values  values[starts[r]] … values[starts[r + 1] − 1] go to rank r
  /// @param starts  ranks + 1 entries, ascending
  /// @throws SharedError if a rank lacks memory for the values that it receives
  template <class T>
  [[nodiscard]] Parcels<T> exchange(std::span<const T> values, const std::vector<Offset>& starts) const {
    static_assert(std::is_trivially_copyable_v<T>);
    Parcels<T> received;
    received.starts = starts_to_receive(starts);
    together([&] { received.values.resize(static_cast<std::size_t>(received.starts.back())); });
    exchange_bytes(reinterpret_cast<const std::byte*>(values.data()), starts,
                   reinterpret_cast<std::byte*>(received.values.data()), received.starts, sizeof(T));
    return received;
  }
  template <class T>
  [[nodiscard]] Parcels<T> exchange(const Parcels<T>& sent) const {
    return exchange(std::span<const T>(sent.values), sent.starts);
  }

  /// At the root, returns the values of all ranks, in rank order; elsewhere, nothing. Throws as `exchange`.
  template <class T>
  [[nodiscard]] std::vector<T> gathered_at_root(const std::vector<T>& own) const {
    std::vector<Offset> starts(static_cast<std::size_t>(size_) + 1, static_cast<Offset>(own.size()));
    starts[0] = 0;
    return exchange(std::span<const T>(own), starts).values;
  }

  /// Returns this rank's share of the root's values: rank r gets values starts[r] … starts[r + 1] − 1. Throws
  /// as `exchange`.
  ///
  /// @param at_root  values of the root; ignored on other ranks
  /// @param starts   ranks + 1 entries, ascending; other ranks use only its size
  template <class T>
  [[nodiscard]] std::vector<T> scattered_from_root(const std::vector<T>& at_root,
                                                   const std::vector<Offset>& starts) const {
    const std::vector<Offset> nothing(starts.size(), 0);
    return is_root() ? exchange(std::span<const T>(at_root), starts).values
                     : exchange(std::span<const T>(), nothing).values;
  }

  /// Returns the root's values on all ranks. Throws as `exchange`.
  template <class T>
  [[nodiscard]] std::vector<T> broadcast(std::vector<T> at_root) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::int64_t count = broadcast_count(static_cast<std::int64_t>(at_root.size()));
    together([&] { at_root.resize(static_cast<std::size_t>(count)); });
    broadcast_bytes(reinterpret_cast<std::byte*>(at_root.data()), count * Offset{sizeof(T)});
    return at_root;
  }

  /// Returns the root's texts on all ranks. Texts must not contain zero bytes.
  [[nodiscard]] std::vector<std::string> broadcast(const std::vector<std::string>& at_root) const;

  /// Returns the values of all ranks, in rank order, on every rank. O(ranks).
  template <class T>
  [[nodiscard]] std::vector<T> gathered(const T& own) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> all(static_cast<std::size_t>(size_));
    gather_bytes(reinterpret_cast<const std::byte*>(&own), reinterpret_cast<std::byte*>(all.data()),
                 sizeof(T));
    return all;
  }

  /// Returns the sum of the ranks' values, added up in rank order. `Sum{}` must be zero; `Sum` needs +=.
  template <class Sum>
  [[nodiscard]] Sum sum(const Sum& own) const {
    Sum total{};
    for (const Sum& value : gathered(own)) total += value;
    return total;
  }

  /// Returns the sums of the ranks' values, entry by entry; `own` has the same size on all ranks.
  [[nodiscard]] std::vector<std::int64_t> sums(std::vector<std::int64_t> own) const;

  /// Calls `work` on this rank and returns its result. `work` must not communicate.
  ///
  /// @throws SharedError on all ranks if `work` throws on any rank
  template <class Work>
  auto together(const Work& work) const {  // NOLINT(modernize-use-nodiscard): work may return nothing
    using Result = std::invoke_result_t<const Work&>;
    std::exception_ptr fault;
    if constexpr (std::is_void_v<Result>) {
      try {
        work();
      } catch (...) {
        fault = std::current_exception();
      }
      settle(fault);
    } else {
      std::optional<Result> result;
      try {
        result.emplace(work());
      } catch (...) {
        fault = std::current_exception();
      }
      settle(fault);
      return *std::move(result);
    }
  }

  /// As `together`, but only the root calls `work`; the other ranks return `Result{}`.
  template <class Work>
  auto at_root(const Work& work) const {  // NOLINT(modernize-use-nodiscard): work may return nothing
    using Result = std::invoke_result_t<const Work&>;
    return together([&] {
      if constexpr (std::is_void_v<Result>) {
        if (is_root()) work();
      } else {
        return is_root() ? work() : Result{};
      }
    });
  }

 private:
  [[nodiscard]] std::vector<Offset> starts_to_receive(const std::vector<Offset>& sent) const;
  void exchange_bytes(const std::byte* sent, const std::vector<Offset>& sent_starts, std::byte* received,
                      const std::vector<Offset>& received_starts, std::size_t size_of_value) const;
  [[nodiscard]] std::int64_t broadcast_count(std::int64_t at_root) const;
  void broadcast_bytes(std::byte* bytes, Offset count) const;
  void gather_bytes(const std::byte* own, std::byte* all, std::size_t bytes_each) const;
  /// Throws SharedError on all ranks if any rank passes a fault.
  void settle(const std::exception_ptr& fault) const;

  MPI_Comm handle_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
  Offset chunk_limit_ = Offset{1} << 30;
};

/// Adds data of all ranks to a checksum that is the same on all ranks. One rank after another, in rank order,
/// calls `add()`, which adds the rank's own data to `checksum` and must not throw. Every rank has to call
/// this function.
template <class Add>
void add_in_rank_order(const Communicator& communicator, Checksum& checksum, const Add& add) {
  for (int turn = 0; turn < communicator.size(); ++turn) {
    if (turn == communicator.rank()) add();
    checksum = communicator.gathered(checksum)[static_cast<std::size_t>(turn)];
  }
}

}  // namespace meshorder::distributed
