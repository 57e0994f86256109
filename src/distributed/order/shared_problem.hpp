// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/order/shared_hierarchy.hpp"
#include "spectral/hiding.hpp"
#include "spectral/lobpcg.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace meshorder::distributed {

/// The eigenproblem on a level of a distributed hierarchy. Sums over the ranks are added up in rank order.
class SharedProblem : public EigenProblem {
 public:
  /// @param hierarchy  must outlive this object
  SharedProblem(SharedHierarchy& hierarchy, std::size_t level)
      : EigenProblem(hierarchy.levels()[level].laplacian.size(), hierarchy.levels()[level].masses),
        hierarchy_(hierarchy),
        level_(level) {}

  void apply(const VectorBlock<1>& x, VectorBlock<1>& y) const override { multiply<1>(x, y, one_); }
  void apply(const VectorBlock<2>& x, VectorBlock<2>& y) const override { multiply<2>(x, y, two_); }
  void precondition(const VectorBlock<1>& r, VectorBlock<1>& w) override {
    hierarchy_.cycle<1>(level_, r, w);
  }
  void precondition(const VectorBlock<2>& r, VectorBlock<2>& w) override {
    hierarchy_.cycle<2>(level_, r, w);
  }
  [[nodiscard]] bool may_hide(double eigenvalue) const override {
    const SharedLevel& level = hierarchy_.levels()[level_];
    const Communicator& communicator = hierarchy_.communicator();
    const bool here = communicator.together(
        [&] { return meshorder::may_hide(level.laplacian, level.aggregation, level.masses, eigenvalue); });
    return communicator.sum(here ? 1 : 0) > 0;
  }
  void add_up(std::span<double> sums) const override {
    constexpr std::size_t kMost = 32;
    struct Sums {
      std::array<double, kMost> values{};
      Sums& operator+=(const Sums& other) {
        for (std::size_t k = 0; k < kMost; ++k) values[k] += other.values[k];
        return *this;
      }
    };
    for (std::size_t at = 0; at < sums.size(); at += kMost) {
      const std::span<double> some = sums.subspan(at, std::min(kMost, sums.size() - at));
      Sums own;
      std::copy(some.begin(), some.end(), own.values.begin());
      const Sums total = hierarchy_.communicator().sum(own);
      std::copy_n(total.values.begin(), some.size(), some.begin());
    }
  }

 private:
  template <int M>
  void multiply(const VectorBlock<M>& x, VectorBlock<M>& y, VectorBlock<M>& with_others) const {
    const SharedLevel& level = hierarchy_.levels()[level_];
    with_others = x;
    fetch_others(level, with_others);
    level.laplacian.apply<M>(with_others, y);
  }

  SharedHierarchy& hierarchy_;
  std::size_t level_;
  mutable VectorBlock<1> one_;  ///< work space: a vector of this rank's rows followed by the halo's entries
  mutable VectorBlock<2> two_;
};

}  // namespace meshorder::distributed
