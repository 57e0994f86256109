// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Includes all public headers of the components that are installed.

#include <meshorder/changing.hpp>
#include <meshorder/error.hpp>
#include <meshorder/fiedler.hpp>
#include <meshorder/layouts.hpp>
#include <meshorder/options.hpp>
#include <meshorder/order.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/quality.hpp>
#include <meshorder/registry.hpp>
#include <meshorder/shape.hpp>
#include <meshorder/version.hpp>
#include <meshorder/view.hpp>

#if __has_include(<meshorder/io.hpp>)
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>
#endif
#if __has_include(<meshorder/payoff.hpp>)
#include <meshorder/payoff.hpp>
#endif
