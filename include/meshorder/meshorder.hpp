// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// The short way in: read a mesh, reorder it, write it, and what that needs.
#include "base/error.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "mesh/mesh.hpp"
#include "mesh/reorder.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "spectral/fiedler.hpp"
