// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "io/format.hpp"
#include "mesh/groups.hpp"
#include "mesh/mesh.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "spectral/fiedler.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace meshorder::command {

/// {"mean", "max", "mean_log2"}
nlohmann::ordered_json to_json(const EdgeSpan& span);

/// {"method", "chosen_by", "because"}: "auto" and why, or "user" and null
nlohmann::ordered_json to_json(const MethodChoice& choice);

/// {"name", "on", "groups": [{"value", "first_vertex", "vertices", "cells"}]}
nlohmann::ordered_json to_json(const Grouping& grouping);

/// {"components": [{"size", "lambda2", "residual", "iterations", "converged"}]}
nlohmann::ordered_json to_json(const std::vector<FiedlerComponent>& components);

/// {"tetrahedron": 161222, …}, highest dimension first
nlohmann::ordered_json cells_by_type(const Mesh& mesh);

/// "161,222 tetrahedra, 12 triangles"
std::string cells_in_words(const Mesh& mesh);

/// "hilbert", or "hilbert (auto)"
std::string method_in_words(const MethodChoice& choice);

/// "3 groups by label on cells: 1, 2, 7"
std::string groups_in_words(const Grouping& grouping);

/// Notes each component that did not converge.
void note_convergence(const std::vector<FiedlerComponent>& components, const std::string& of, Notes& notes);

}  // namespace meshorder::command
