// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/graph/csr_graph.hpp>
#include <meshorder/io/format.hpp>
#include <meshorder/mesh/mesh.hpp>
#include <meshorder/metrics/edge_span.hpp>
#include <meshorder/spectral/fiedler.hpp>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace meshorder::command {

/// {"mean", "max", "mean_log2"}
nlohmann::ordered_json to_json(const EdgeSpan& span);

/// {"components": [{"size", "lambda2", "residual", "iterations", "converged"}]}
nlohmann::ordered_json to_json(const std::vector<FiedlerComponent>& components);

/// {"tetrahedron": 161222, …}, highest dimension first
nlohmann::ordered_json cells_by_type(const Mesh& mesh);

/// "161,222 tetrahedra, 12 triangles"
std::string cells_in_words(const Mesh& mesh);

/// Notes each component that did not converge.
void note_convergence(const std::vector<FiedlerComponent>& components, const std::string& of, Notes& notes);

}  // namespace meshorder::command
