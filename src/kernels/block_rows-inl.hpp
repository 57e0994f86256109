// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Included once for each instruction set: Highway's foreach_target.h compiles the including file repeatedly.
#if defined(MESHORDER_BLOCK_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MESHORDER_BLOCK_ROWS_INL
#undef MESHORDER_BLOCK_ROWS_INL
#else
#define MESHORDER_BLOCK_ROWS_INL
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_MAX_BYTES >= 32
/// The sums of the products of a row's blocks and the vector. Each of a block's nine products has its own
/// sum: adding three products to one sum would make additions wait for each other. The first eight sums are
/// in vectors.
struct RowSums {
  using Tag = hn::CappedTag<double, 8>;
  static constexpr int kLanes = static_cast<int>(MaxLanes(Tag()));
  static constexpr int kVectors = 8 / kLanes;
  hn::Vec<Tag> sums[kVectors];
  double last = 0.0;

  HWY_INLINE RowSums() {
    for (auto& sum : sums) sum = hn::Zero(Tag());
  }

  template <class Value>
  HWY_INLINE void add(const Value* block, const double* p) {
    // p₀ p₁ p₂ p₂: nothing may be read beyond p₂. The loads are as wide as the stores of subtract_from: wider
    // loads would wait for these stores
    const hn::FixedTag<double, 2> two;
    const hn::FixedTag<double, 4> four;
    const auto p0122 = hn::Combine(four, hn::Set(two, p[2]), hn::LoadU(two, p));
    alignas(64) constexpr std::int64_t kPlaces[8] = {0, 1, 2, 0, 1, 2, 0, 1};
    const Tag d;
    for (int i = 0; i < kVectors; ++i) {
      const auto places = hn::SetTableIndices(d, kPlaces + i * kLanes);
      sums[i] = hn::MulAdd(load(block + i * kLanes), hn::TableLookupLanes(widened(p0122), places), sums[i]);
    }
    last += block[8] * p[2];
  }

  HWY_INLINE void store(double* q) const {
    alignas(64) double s[8];
    for (int i = 0; i < kVectors; ++i) hn::Store(sums[i], Tag(), s + i * kLanes);
    q[0] = s[0] + s[1] + s[2];
    q[1] = s[3] + s[4] + s[5];
    q[2] = s[6] + s[7] + last;
  }

  /// Sets q to r minus the sums.
  HWY_INLINE void subtract_from(const double* r, double* q) const {
    alignas(64) double s[8];
    for (int i = 0; i < kVectors; ++i) hn::Store(sums[i], Tag(), s + i * kLanes);
    const hn::FixedTag<double, 2> two;
    alignas(16) const double q01[2] = {r[0] - (s[0] + s[1] + s[2]), r[1] - (s[3] + s[4] + s[5])};
    hn::StoreU(hn::Load(two, q01), two, q);
    q[2] = r[2] - (s[6] + s[7] + last);
  }

 private:
  static HWY_INLINE hn::Vec<Tag> load(const double* values) { return hn::LoadU(Tag(), values); }
  static HWY_INLINE hn::Vec<Tag> load(const float* values) {
    return hn::PromoteTo(Tag(), hn::LoadU(hn::Rebind<float, Tag>(), values));
  }
  template <class Four>
  static HWY_INLINE hn::Vec<Tag> widened(Four four) {
    if constexpr (kLanes == 4) {
      return four;
    } else {
      return hn::ZeroExtendVector(Tag(), four);
    }
  }
};
#else
/// The same sums without vectors: vectors of two lanes would gain nothing.
struct RowSums {
  double s[9] = {};

  template <class Value>
  HWY_INLINE void add(const Value* block, const double* p) {
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    s[0] += block[0] * p0;
    s[1] += block[1] * p1;
    s[2] += block[2] * p2;
    s[3] += block[3] * p0;
    s[4] += block[4] * p1;
    s[5] += block[5] * p2;
    s[6] += block[6] * p0;
    s[7] += block[7] * p1;
    s[8] += block[8] * p2;
  }

  HWY_INLINE void store(double* q) const {
    q[0] = s[0] + s[1] + s[2];
    q[1] = s[3] + s[4] + s[5];
    q[2] = s[6] + s[7] + s[8];
  }

  /// Sets q to r minus the sums.
  HWY_INLINE void subtract_from(const double* r, double* q) const {
    q[0] = r[0] - (s[0] + s[1] + s[2]);
    q[1] = r[1] - (s[3] + s[4] + s[5]);
    q[2] = r[2] - (s[6] + s[7] + s[8]);
  }
};
#endif

}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
