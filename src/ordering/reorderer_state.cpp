// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/reorderer_state.hpp"

#include "base/checksum.hpp"
#include <meshorder/error.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace meshorder {
namespace {

/// Collects the bytes of a state's numbers.
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

std::vector<std::byte> to_bytes(const ReordererState& state) {
  Bytes out;
  out.add(kMark);
  out.add(state.begun);
  out.add(state.count);
  out.add(state.since);
  out.add(state.interval);
  for (const double number : {state.fresh_span, state.fresh_seconds, state.warm_seconds, state.observed.count,
                              state.observed.k, state.observed.kk, state.observed.t, state.observed.kt})
    out.add(number);
  out.add(static_cast<std::uint64_t>(state.method.size()));
  for (const char letter : state.method) out.add(letter);
  out.add(static_cast<std::uint64_t>(state.vector.size()));
  for (const double number : state.vector) out.add(number);
  out.add(checksum_of(out.bytes()));
  return std::move(out.bytes());
}

ReordererState reorderer_state(std::span<const std::byte> bytes) {
  Reader in(bytes);
  if (in.take<std::uint64_t>() != kMark) throw InvalidArgument("state: this is not the state of a Reorderer");
  constexpr std::size_t kSum = sizeof(std::uint64_t);
  if (bytes.size() < 2 * kSum ||
      Reader(bytes.last(kSum)).take<std::uint64_t>() != checksum_of(bytes.first(bytes.size() - kSum)))
    throw InvalidArgument("state: it is cut off or damaged");
  ReordererState state;
  state.begun = in.take<std::uint8_t>();
  state.count = in.take<Index>();
  state.since = in.take<Index>();
  state.interval = in.take<Index>();
  for (double* const number :
       {&state.fresh_span, &state.fresh_seconds, &state.warm_seconds, &state.observed.count,
        &state.observed.k, &state.observed.kk, &state.observed.t, &state.observed.kt})
    *number = in.take<double>();
  const auto letters = in.take<std::uint64_t>();
  if (letters > in.left()) throw InvalidArgument("state: it is cut off or damaged");
  for (std::uint64_t i = 0; i < letters; ++i) state.method += in.take<char>();
  const auto entries = in.take<std::uint64_t>();
  if (entries > in.left() / sizeof(double)) throw InvalidArgument("state: it is cut off or damaged");
  for (std::uint64_t i = 0; i < entries; ++i) state.vector.push_back(in.take<double>());
  const auto is_amount = [](double x) { return x >= 0 && std::isfinite(x); };
  const bool fits = state.begun <= 1 && state.count >= 0 && state.since >= 0 && state.since < kMaxIndex &&
                    state.interval >= 1 && state.interval <= kMostInterval && is_amount(state.fresh_span) &&
                    is_amount(state.fresh_seconds) && is_amount(state.warm_seconds) &&
                    is_amount(state.observed.count) && is_amount(state.observed.k) &&
                    is_amount(state.observed.kk) && is_amount(state.observed.t) &&
                    is_amount(state.observed.kt) && in.left() == kSum &&
                    (state.vector.empty() || std::cmp_equal(state.vector.size(), state.count));
  if (!fits) throw InvalidArgument("state: it is cut off or damaged");
  return state;
}

}  // namespace meshorder
