// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/reorderer_state.hpp"

#include "base/checksum.hpp"
#include <meshorder/error.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <utility>

namespace meshorder {
namespace {

/// Writes and reads the numbers of a state.
class Bytes {
 public:
  template <class Number>
  void add(Number number) {
    const auto raw = std::bit_cast<std::array<std::byte, sizeof(Number)>>(number);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }
  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class Number>
  Number take() {
    Number number;
    if (rest_.size() < sizeof number) throw InvalidArgument("state: it is cut off");
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_ = rest_.subspan(sizeof number);
    return number;
  }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::byte> rest_;
};

constexpr std::uint64_t kMark = 0x31'72'6f'65'72'72'6f'6dU;  // "morreor1"

std::uint64_t checksum_of(std::span<const std::byte> bytes) {
  Checksum sum;
  for (const std::byte byte : bytes) sum.add(static_cast<std::uint8_t>(byte));
  return sum.value();
}

}  // namespace

std::vector<std::byte> to_bytes(const ReordererState& memory) {
  Bytes out;
  out.add(kMark);
  out.add(memory.begun);
  out.add(memory.count);
  out.add(memory.since);
  out.add(memory.interval);
  for (const double number :
       {memory.fresh_span, memory.fresh_seconds, memory.warm_seconds, memory.observed.count,
        memory.observed.k, memory.observed.kk, memory.observed.t, memory.observed.kt})
    out.add(number);
  out.add(static_cast<std::uint64_t>(memory.method.size()));
  for (const char letter : memory.method) out.add(letter);
  out.add(static_cast<std::uint64_t>(memory.vector.size()));
  for (const double number : memory.vector) out.add(number);
  out.add(checksum_of(out.bytes()));
  return std::move(out.bytes());
}

ReordererState reorderer_state(std::span<const std::byte> state) {
  Reader in(state);
  if (in.take<std::uint64_t>() != kMark) throw InvalidArgument("state: this is none of a Reorderer");
  constexpr std::size_t kSum = sizeof(std::uint64_t);
  if (state.size() < 2 * kSum ||
      Reader(state.last(kSum)).take<std::uint64_t>() != checksum_of(state.first(state.size() - kSum)))
    throw InvalidArgument("state: it is cut off or damaged");
  ReordererState memory;
  memory.begun = in.take<std::uint8_t>();
  memory.count = in.take<Index>();
  memory.since = in.take<Index>();
  memory.interval = in.take<Index>();
  for (double* const number :
       {&memory.fresh_span, &memory.fresh_seconds, &memory.warm_seconds, &memory.observed.count,
        &memory.observed.k, &memory.observed.kk, &memory.observed.t, &memory.observed.kt})
    *number = in.take<double>();
  const auto letters = in.take<std::uint64_t>();
  if (letters > in.left()) throw InvalidArgument("state: it is cut off or damaged");
  for (std::uint64_t i = 0; i < letters; ++i) memory.method += in.take<char>();
  const auto entries = in.take<std::uint64_t>();
  if (entries > in.left() / sizeof(double)) throw InvalidArgument("state: it is cut off or damaged");
  for (std::uint64_t i = 0; i < entries; ++i) memory.vector.push_back(in.take<double>());
  const bool fits = memory.count >= 0 && memory.interval >= 1 && in.left() == kSum &&
                    (memory.vector.empty() || std::cmp_equal(memory.vector.size(), memory.count));
  if (!fits) throw InvalidArgument("state: it is cut off or damaged");
  return memory;
}

}  // namespace meshorder
