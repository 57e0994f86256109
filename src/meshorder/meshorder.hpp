// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// The short way in: read a mesh, reorder it, write it, and what that needs.
#include <meshorder/base/error.hpp>
#include <meshorder/io/format.hpp>
#include <meshorder/mesh/graphs.hpp>
#include <meshorder/mesh/mesh.hpp>
#include <meshorder/mesh/mesh_ordering.hpp>
#include <meshorder/mesh/reorder.hpp>
#include <meshorder/metrics/edge_span.hpp>
#include <meshorder/ordering/method.hpp>
#include <meshorder/spectral/fiedler.hpp>
