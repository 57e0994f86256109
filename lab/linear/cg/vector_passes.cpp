// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cg/vector_passes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/linear/cg/vector_passes.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using Value = hn::Vec<Tag>;

/// Calls `many(i)` for the start i of each full register within 0 … count − 1, then `one(i)` for each
/// remaining i.
template <class Many, class One>
HWY_INLINE void for_lanes(Offset count, Many many, One one) {
  constexpr Offset kLanes = MaxLanes(Tag());
  Offset i = 0;
  for (; i + kLanes <= count; i += kLanes) many(i);
  for (; i < count; ++i) one(i);
}

HWY_INLINE double sum_of(Value lanes) { return hn::GetLane(hn::SumOfLanes(Tag(), lanes)); }

double dot_lanes(const double* a, const double* b, Offset count) {
  const Tag d;
  Value lanes = hn::Zero(d);
  double rest = 0.0;
  for_lanes(
      count, [&](Offset i) HWY_ATTR { lanes = hn::MulAdd(hn::LoadU(d, a + i), hn::LoadU(d, b + i), lanes); },
      [&](Offset i) { rest += a[i] * b[i]; });
  return sum_of(lanes) + rest;
}

double subtract_from_lanes(const double* b, double* y, Offset count) {
  const Tag d;
  Value lanes = hn::Zero(d);
  double rest = 0.0;
  for_lanes(
      count,
      [&](Offset i) HWY_ATTR {
        const Value value = hn::Sub(hn::LoadU(d, b + i), hn::LoadU(d, y + i));
        hn::StoreU(value, d, y + i);
        lanes = hn::MulAdd(value, value, lanes);
      },
      [&](Offset i) {
        y[i] = b[i] - y[i];
        rest += y[i] * y[i];
      });
  return sum_of(lanes) + rest;
}

double subtract_lanes(double alpha, const double* q, double* r, Offset count) {
  const Tag d;
  const Value factor = hn::Set(d, -alpha);
  Value lanes = hn::Zero(d);
  double rest = 0.0;
  for_lanes(
      count,
      [&](Offset i) HWY_ATTR {
        const Value value = hn::MulAdd(factor, hn::LoadU(d, q + i), hn::LoadU(d, r + i));
        hn::StoreU(value, d, r + i);
        lanes = hn::MulAdd(value, value, lanes);
      },
      [&](Offset i) {
        r[i] -= alpha * q[i];
        rest += r[i] * r[i];
      });
  return sum_of(lanes) + rest;
}

void add_lanes(double alpha, const double* p, double* x, Offset count) {
  const Tag d;
  const Value factor = hn::Set(d, alpha);
  for_lanes(
      count,
      [&](Offset i)
          HWY_ATTR { hn::StoreU(hn::MulAdd(factor, hn::LoadU(d, p + i), hn::LoadU(d, x + i)), d, x + i); },
      [&](Offset i) { x[i] += alpha * p[i]; });
}

void step_lanes(double alpha, double beta, const double* z, double* p, double* x, Offset count) {
  const Tag d;
  const Value along = hn::Set(d, alpha);
  const Value kept = hn::Set(d, beta);
  for_lanes(
      count,
      [&](Offset i) HWY_ATTR {
        const Value direction = hn::LoadU(d, p + i);
        hn::StoreU(hn::MulAdd(along, direction, hn::LoadU(d, x + i)), d, x + i);
        hn::StoreU(hn::MulAdd(kept, direction, hn::LoadU(d, z + i)), d, p + i);
      },
      [&](Offset i) {
        x[i] += alpha * p[i];
        p[i] = z[i] + beta * p[i];
      });
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder::passes {
namespace {

MESHORDER_SIMD_VERSIONS(dot_lanes);
MESHORDER_SIMD_VERSIONS(subtract_from_lanes);
MESHORDER_SIMD_VERSIONS(subtract_lanes);
MESHORDER_SIMD_VERSIONS(add_lanes);
MESHORDER_SIMD_VERSIONS(step_lanes);

Offset entries(Index begin, Index end) { return Offset{3} * (end - begin); }

template <class Vector>
auto* at(Vector vector, Index vertex) {
  return vector.data() + Offset{3} * vertex;
}

}  // namespace

double dot(std::span<const double> a, std::span<const double> b, Index begin, Index end) {
  return MESHORDER_SIMD(dot_lanes)(at(a, begin), at(b, begin), entries(begin, end));
}

double subtract_from(std::span<const double> b, std::span<double> y, Index begin, Index end) {
  return MESHORDER_SIMD(subtract_from_lanes)(at(b, begin), at(y, begin), entries(begin, end));
}

double subtract(double alpha, std::span<const double> q, std::span<double> r, Index begin, Index end) {
  return MESHORDER_SIMD(subtract_lanes)(alpha, at(q, begin), at(r, begin), entries(begin, end));
}

void add(double alpha, std::span<const double> p, std::span<double> x, Index begin, Index end) {
  MESHORDER_SIMD(add_lanes)(alpha, at(p, begin), at(x, begin), entries(begin, end));
}

void step(double alpha, double beta, std::span<const double> z, std::span<double> p, std::span<double> x,
          Index begin, Index end) {
  MESHORDER_SIMD(step_lanes)
  (alpha, beta, at(z, begin), at(p, begin), at(x, begin), entries(begin, end));
}

}  // namespace meshorder::passes
#endif
