// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/number_set.hpp"

#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace meshorder::distributed {

/// The numbers whose values this rank needs from their owners. A Halo is set up once and can then fetch many
/// arrays of values.
class Halo {
 public:
  /// Every rank has to call it. O((numbers + ranks) · log numbers) at most.
  ///
  /// @param layout   the owners of the numbers
  /// @param numbers  numbers whose values this rank needs, in any order; its own numbers and repeats are
  ///                 allowed
  /// @throws as `Communicator::exchange`
  Halo(const Communicator& communicator, const Layout& layout, std::span<const GlobalIndex> numbers);

  /// Returns the numbers that this rank needs, ascending, each once.
  [[nodiscard]] const std::vector<GlobalIndex>& numbers() const noexcept { return wanted_.numbers(); }
  /// Returns the numbers that the ranks need from this rank, rank by rank; numbers may occur several times.
  [[nodiscard]] const std::vector<GlobalIndex>& asked_of_this_rank() const noexcept { return asked_.values; }
  /// Returns the position of a number in `numbers()`. O(1) or O(log numbers), as `NumberSet::position`.
  [[nodiscard]] std::size_t position(GlobalIndex number) const { return wanted_.position(number); }

  /// Returns the owners' values, one for each of `numbers()`. Every rank has to call it.
  ///
  /// @param own  a value for each number that this rank owns
  /// @throws as `Communicator::exchange`
  template <class T>
  [[nodiscard]] std::vector<T> fetch(std::span<const T> own) const {
    Parcels<T> answers;
    communicator_.together([&] {
      answers.starts = asked_.starts;
      answers.values.reserve(asked_.values.size());
      for (const GlobalIndex number : asked_.values)
        answers.values.push_back(own[static_cast<std::size_t>(number - first_)]);
    });
    return communicator_.exchange(answers).values;
  }
  template <class T>
  [[nodiscard]] std::vector<T> fetch(const std::vector<T>& own) const {
    return fetch(std::span<const T>(own));
  }

  /// Returns the owners' rows, `width` bytes for each of `numbers()`. Every rank has to call it. O(bytes).
  ///
  /// @param own  a row for each number that this rank owns
  /// @throws as `Communicator::exchange`
  [[nodiscard]] std::vector<std::byte> fetch_rows(std::span<const std::byte> own, Offset width) const;

 private:
  const Communicator& communicator_;
  GlobalIndex first_;  ///< first number that this rank owns
  NumberSet wanted_;
  Parcels<GlobalIndex> asked_;  ///< numbers that each rank needs from this rank
};

/// The values of a rank's own numbers and of its halo's numbers.
template <class T>
class HaloValues {
 public:
  /// Every rank has to call it. Throws as `Communicator::exchange`.
  ///
  /// @param halo   must outlive this object
  /// @param first  first number that this rank owns
  HaloValues(const Halo& halo, GlobalIndex first, std::vector<T> own)
      : halo_(halo), first_(first), own_(std::move(own)), others_(halo.fetch(own_)) {}

  /// Returns the value of the k-th number that this rank owns.
  [[nodiscard]] const T& own(Offset k) const { return own_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const std::vector<T>& own() const noexcept { return own_; }
  /// Returns a number's value. O(1) if this rank owns the number, else as `Halo::position`.
  [[nodiscard]] const T& operator[](GlobalIndex number) const {
    const GlobalIndex k = number - first_;
    if (k >= 0 && k < std::ssize(own_)) return own(k);
    return others_[halo_.position(number)];
  }

 private:
  const Halo& halo_;
  GlobalIndex first_;
  std::vector<T> own_;
  std::vector<T> others_;
};

/// Sends values to the owners of their numbers. Every rank has to call it. O(numbers · log ranks).
///
/// @param numbers  numbers in any order, each on one rank at most
/// @param values   one value for each number
/// @param missing  value for a number that no rank passes
/// @return the values of the numbers that this rank owns
/// @throws as `Communicator::exchange`
template <class T>
[[nodiscard]] std::vector<T> delivered(const Communicator& communicator, const Layout& layout,
                                       std::span<const GlobalIndex> numbers, std::span<const T> values,
                                       const T& missing) {
  struct Letter {
    GlobalIndex number;
    T value;
  };
  const Parcels<Letter> letters = communicator.together([&] {
    return parcels_by_rank(
        numbers.size(), layout.ranks(), [&](std::size_t k) { return layout.owner(numbers[k]); },
        [&](std::size_t k) {
          return Letter{numbers[k], values[k]};
        });
  });
  const Parcels<Letter> received = communicator.exchange(letters);
  return communicator.together([&] {
    std::vector<T> own(static_cast<std::size_t>(layout.size(communicator.rank())), missing);
    const GlobalIndex first = layout.begin(communicator.rank());
    for (const Letter& letter : received.values)
      own[static_cast<std::size_t>(letter.number - first)] = letter.value;
    return own;
  });
}

}  // namespace meshorder::distributed
