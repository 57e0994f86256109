// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "arrays.hpp"
#include <meshorder/fiedler.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>

#include <vector>

namespace meshorder::python {

/// Return results as dicts with the names of their members; arrays are not copied.
nb::dict described(Order order);
nb::dict described(const Quality& quality);
nb::object described(SparsityPattern pattern);  // side × side numbers
nb::list described(const std::vector<FiedlerComponent>& components);

}  // namespace meshorder::python
