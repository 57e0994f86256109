// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/admm/local_elements.hpp"

#include <cstdint>
#include <span>

namespace meshorder {

enum class LocalModel : std::uint8_t;

/// Returns Σ U(D x) of all elements: see LocalSteps::energy. Runs on all threads, one element at a time, with
/// the same bits for any number of threads.
template <class Real>
double energy_of(LocalModel model, const LocalElements<Real>& elements, std::span<const Real> positions);

}  // namespace meshorder
