// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Orders along space-filling curves through the points of a lattice. Morton: A Computer Oriented Geodetic
// Data Base (1966). Hilbert's curve by the transformation of Skilling: Programming the Hilbert Curve (2004).
#include "ordering/space_filling.hpp"

#include "base/parallel.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/sorted.hpp"
#include <meshorder/error.hpp>

#include <bit>
#include <cmath>
#include <string>
#include <utility>

namespace meshorder {

void check_points(const PointsView& points, std::size_t count, std::string_view method) {
  if (points.size() == count) return;
  throw InvalidArgument("order '" + std::string(method) + "' needs the coordinates of all " +
                        std::to_string(count) + " vertices (points), got " +
                        (points.empty() ? "none" : std::to_string(points.size())));
}

Lattice::Lattice(const Point& low, const Point& high) : low_(low) {
  for (int a = 0; a < 3; ++a) {
    if (!(high[a] > low[a])) continue;
    used_[axes_++] = a;
    extent_ = std::max(extent_, high[a] - low[a]);
  }
  bits_ = axes_ == 3 ? 21 : 31;
  last_ = std::ldexp(1.0, bits_) - 1;
  if (std::isfinite(extent_)) return;
  shrink_ = 0.5;
  extent_ = 0;
  for (int a = 0; a < 3; ++a) extent_ = std::max(extent_, shrink_ * high[a] - shrink_ * low[a]);
}

std::array<std::uint32_t, 3> Lattice::cell_of(const Point& point) const {
  const auto along = [&](int a) {
    const double share = (shrink_ * point[a] - shrink_ * low_[a]) / extent_;
    return static_cast<std::uint32_t>(share > 0 ? std::min(share, 1.0) * last_ : 0);
  };
  if (axes_ == 3) return {along(0), along(1), along(2)};  // a fast path without reads of `used_`
  std::array<std::uint32_t, 3> cell{0, 0, 0};
  for (int k = 0; k < axes_; ++k) cell[k] = along(used_[k]);
  return cell;
}

namespace {

constexpr Index kPointsAtOnce = 16384;  // points that a thread examines at a time

}  // namespace

Lattice lattice_of(const PointsView& points) {
  const Box box = sum_over_chunks<Box>(index_size(points), kPointsAtOnce, [&](Index begin, Index end) {
    Box of_chunk;
    for (Index i = begin; i < end; ++i) of_chunk += Box{point_at(points, i), point_at(points, i)};
    return of_chunk;
  });
  return {box.low, box.high};
}

namespace {

/// Returns a mask with groups of `size` ones, each followed by Axes − 1 groups of zeros.
template <int Axes>
constexpr std::uint64_t spread_mask(unsigned size) {
  std::uint64_t mask = 0;
  for (unsigned bit = 0; bit < 64; ++bit) {
    if (bit / size % Axes == 0) mask |= std::uint64_t{1} << bit;
  }
  return mask;
}

/// Moves bit i to place Axes · i. Each step halves the groups of bits and moves the upper halves up.
template <int Axes>
constexpr std::uint64_t spread(std::uint64_t bits) {
  constexpr std::array kMasks{spread_mask<Axes>(16), spread_mask<Axes>(8), spread_mask<Axes>(4),
                              spread_mask<Axes>(2), spread_mask<Axes>(1)};
  unsigned shift = 16 * (Axes - 1);
  for (const std::uint64_t mask : kMasks) {
    bits = (bits | bits << shift) & mask;
    shift /= 2;
  }
  return bits;
}

template <int Axes>
std::uint64_t interleaved_axes(const std::array<std::uint32_t, 3>& x) {
  std::uint64_t key = 0;
  for (int a = 0; a < Axes; ++a) key = key << 1U | spread<Axes>(x[a]);
  return key;
}

}  // namespace

std::uint64_t interleaved(const std::array<std::uint32_t, 3>& coordinates, int axes) {
  switch (axes) {
    case 1:
      return coordinates[0];
    case 2:
      return interleaved_axes<2>(coordinates);
    case 3:
      return interleaved_axes<3>(coordinates);
    default:
      return 0;
  }
}

namespace {

/// The course of Hilbert's curve through a cube of the lattice: the curve's axes, reflections and direction.
struct CurveState {
  std::array<int, 3> axis{0, 1, 2};  ///< the lattice's axis for each axis of the curve
  unsigned reflected = 0;            ///< a bit for each axis of the curve
  bool backwards = false;            ///< whether the Gray code began with an odd number

  constexpr bool operator==(const CurveState&) const = default;
};

/// A step into a part of a cube: a quarter or eighth, or a part of such a part. It has two numbers: the
/// part's number along the curve in the cube, and the number of the part's state.
class CurveStep {
 public:
  static constexpr unsigned kNumberBits = 9;
  constexpr CurveStep() = default;
  constexpr CurveStep(std::size_t number, std::size_t state)
      : packed_(static_cast<std::uint16_t>(state << kNumberBits | number)) {}
  [[nodiscard]] constexpr std::size_t number() const { return packed_ & ((1U << kNumberBits) - 1); }
  [[nodiscard]] constexpr std::size_t state() const { return packed_ >> kNumberBits; }

 private:
  std::uint16_t packed_ = 0;  // 16 bits, so that the tables of steps stay in the caches
};

/// Enters a part of a cube. `halves` gives the part by a bit for each axis of the lattice; the first axis has
/// the highest bit. Returns the part's number along the curve and its state, by one scale of Skilling's
/// transformation.
template <int Axes>
constexpr std::pair<unsigned, CurveState> enter(CurveState state, unsigned halves) {
  unsigned number = 0;
  bool odd = false;
  const CurveState outside = state;
  for (int a = 0; a < Axes; ++a) {
    const unsigned half = (halves >> static_cast<unsigned>(Axes - 1 - outside.axis[a]) ^
                           outside.reflected >> static_cast<unsigned>(a)) &
                          1U;
    odd = odd != (half != 0);
    number = number << 1U | (odd != outside.backwards ? 1U : 0U);
    if (half != 0) {
      state.reflected ^= 1U;
    } else {
      std::swap(state.axis[0], state.axis[a]);
      const unsigned differ = (state.reflected ^ state.reflected >> static_cast<unsigned>(a)) & 1U;
      state.reflected ^= differ | differ << static_cast<unsigned>(a);
    }
  }
  state.backwards = outside.backwards != odd;
  return {number, state};
}

constexpr std::size_t kCurveStates = 48;  // 6 rotations, 4 reflections, 2 directions

/// Returns the steps from each state into each part. States are numbered in the order of their discovery.
template <int Axes>
constexpr auto curve_steps() {
  constexpr unsigned kCubes = 1U << static_cast<unsigned>(Axes);
  std::array<CurveState, kCurveStates> states{};
  std::array<std::array<CurveStep, kCubes>, kCurveStates> steps{};
  std::size_t found = 1;
  for (std::size_t s = 0; s < found; ++s) {
    for (unsigned halves = 0; halves < kCubes; ++halves) {
      const auto [number, state] = enter<Axes>(states[s], halves);
      std::size_t place = 0;
      while (place < found && !(states[place] == state)) ++place;
      if (place == found) states[found++] = state;
      steps[s][halves] = {number, place};
    }
  }
  return steps;
}

constexpr unsigned kScalesAtOnce = 3;

/// Like `curve_steps`, for `kScalesAtOnce` scales at once.
template <unsigned Axes>
auto curve_strides() {
  constexpr auto kSteps = curve_steps<Axes>();
  constexpr unsigned kParts = 1U << (kScalesAtOnce * Axes);
  std::array<std::array<CurveStep, kParts>, kCurveStates> strides{};
  for (std::size_t s = 0; s < kCurveStates; ++s) {
    for (unsigned halves = 0; halves < kParts; ++halves) {
      CurveStep stride(0, s);
      for (unsigned left = kScalesAtOnce * Axes; left > 0;) {
        left -= Axes;
        const CurveStep step = kSteps[stride.state()][halves >> left & ((1U << Axes) - 1)];
        stride = {stride.number() << Axes | step.number(), step.state()};
      }
      strides[s][halves] = stride;
    }
  }
  return strides;
}

template <unsigned Axes>
std::uint64_t along_curve(const std::array<std::uint32_t, 3>& x, int bits) {
  static constexpr auto kSteps = curve_steps<Axes>();
  static const auto strides = curve_strides<Axes>();  // too many steps for a compile-time constant
  constexpr unsigned kStride = kScalesAtOnce * Axes;
  const std::uint64_t halves = interleaved_axes<Axes>(x);
  std::uint64_t key = 0;
  std::size_t state = 0;
  unsigned left = Axes * static_cast<unsigned>(bits);
  while (left % kStride != 0) {
    left -= Axes;
    const CurveStep step = kSteps[state][halves >> left & ((1U << Axes) - 1)];
    key = key << Axes | step.number();
    state = step.state();
  }
  while (left > 0) {
    left -= kStride;
    const CurveStep step = strides[state][halves >> left & ((1U << kStride) - 1)];
    key = key << kStride | step.number();
    state = step.state();
  }
  return key;
}

}  // namespace

std::uint64_t hilbert_key(const std::array<std::uint32_t, 3>& x, int axes, int bits) {
  switch (axes) {
    case 1:
      return x[0];
    case 2:
      return along_curve<2>(x, bits);
    case 3:
      return along_curve<3>(x, bits);
    default:
      return 0;
  }
}

namespace {

constexpr int kFirstBits = 30;  // leading bits of a point's number along a curve; few points share them all

/// Sorts points by their number along a curve, which `key(cell, axes, scales)` returns; ties by index. Sorts
/// first by the number of the first scales. Only points with equal numbers need the number of all scales.
/// O(n) if few numbers are equal.
template <class Key>
Permutation sorted_along(const PointsView& points, const Key& key) {
  using Entry = ValuedItem<std::uint32_t>;
  const Index n = index_size(points);
  const Lattice lattice = lattice_of(points);
  const int axes = lattice.axes();
  const int first_scales = std::min(lattice.bits(), kFirstBits / std::max(axes, 1));
  const auto number_of = [&](Index i, int scales) {
    std::array<std::uint32_t, 3> cell = lattice.cell_of(point_at(points, i));
    for (std::uint32_t& x : cell) x >>= static_cast<unsigned>(lattice.bits() - scales);
    return key(cell, axes, scales);
  };
  const auto first_bits = [&](Index i) { return static_cast<std::uint32_t>(number_of(i, first_scales)); };

  const int bits = std::min(axes * first_scales, static_cast<int>(std::bit_width(std::uint32_t(n))) + 1);
  const int shift = axes * first_scales - bits;
  const auto place = [shift](std::uint32_t number) {
    return static_cast<Index>(number >> static_cast<unsigned>(shift));
  };
  const auto sort_equal = [&](std::span<Entry> entries) {
    std::vector<std::pair<std::uint64_t, Index>> whole;
    whole.reserve(entries.size());
    for (const Entry& entry : entries) whole.emplace_back(number_of(entry.item, lattice.bits()), entry.item);
    std::ranges::sort(whole);
    for (std::size_t k = 0; k < entries.size(); ++k) entries[k].item = whole[k].second;
  };
  const auto sort = [&](std::span<Entry> entries) {
    std::ranges::sort(entries, {}, &Entry::value);
    for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
      while (end < entries.size() && entries[end].value == entries[begin].value) ++end;
      if (end - begin > 1) sort_equal(entries.subspan(begin, end - begin));
    }
  };
  return sorted_by(n, first_bits, Index{1} << bits, place, sort);
}

Permutation along_hilbert_curve(const PointsView& points) { return sorted_along(points, hilbert_key); }

}  // namespace

Order morton_vertices(const VertexInput& input, const OrderOptions&) {
  const auto number = [](const auto& cell, int axes, int /*scales*/) { return interleaved(cell, axes); };
  return {sorted_along(input.points, number), {}};
}

Order hilbert_vertices(const VertexInput& input, const OrderOptions&) {
  return {along_hilbert_curve(input.points), {}};
}

Order hilbert_elements(const ElementInput& input, const OrderOptions&) {
  const IncidenceRef elements = input.elements;
  std::vector<Point> centroids(elements.size(), Point{});
  for_each_chunk(elements.size(), kPointsAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index e = begin; e < end; ++e) {
      const double share = 1.0 / static_cast<double>(elements[e].size());
      for (const Index v : elements[e])
        centroids[e] = plus_scaled(centroids[e], share, point_at(input.points, v));
    }
  });
  return {along_hilbert_curve(PointsView(centroids)), {}};
}

}  // namespace meshorder
