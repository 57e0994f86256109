// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "io/format.hpp"
#include "mesh/groups.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "spectral/fiedler.hpp"
#include <meshorder/mesh.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace meshorder::command {

/// Returns a text as JSON; null for an empty text.
nlohmann::ordered_json or_null(std::string_view text);

/// Returns {"mean", "max", "mean_log2"}.
nlohmann::ordered_json to_json(const EdgeSpan& span);

/// Returns {"method", "chosen_by", "because"}: "auto" and the reason, or "user" and null.
nlohmann::ordered_json to_json(const MethodChoice& choice);

/// Returns {"name", "on", "groups": [{"value", "first_vertex", "vertices", "cells"}]}.
nlohmann::ordered_json to_json(const Grouping& grouping);

/// Returns {"components": [{"size", "lambda2", "residual", "iterations", "converged"}]}.
nlohmann::ordered_json to_json(const std::vector<FiedlerComponent>& components);

/// Returns {"tetrahedron": 161222, …}, highest dimension first.
nlohmann::ordered_json cells_by_type(const Mesh& mesh);

/// Returns "161,222 tetrahedra, 12 triangles".
std::string cells_in_words(const Mesh& mesh);

/// Returns "hilbert", or "hilbert (auto)".
std::string method_in_words(const MethodChoice& choice);

/// Returns "3 groups by label on cells: 1, 2, 7".
std::string groups_in_words(const Grouping& grouping);

/// Adds a note for each component whose eigensolver did not converge.
void note_convergence(const std::vector<FiedlerComponent>& components, const std::string& of, Notes& notes);

/// Returns the file name that messages propose for the mesh in a new order: "ordered-dragon.veg".
std::string ordered_name(const std::string& mesh);

/// Returns a bar whose length is a share, 0 … 1, of `width` blocks; at least one thin block.
std::string bar(double share, int width);

/// Returns a word that a shell reads as this text.
std::string in_shell(const std::string& text);

/// Returns `text` with `with` in place of each `what`.
std::string replaced(std::string text, std::string_view what, const std::string& with);

/// Merges notes that differ only in their first quoted name: "the set 'a' of vertices is not written
/// (likewise 'b', 'c' and 15 more)". The merged note takes the position of the first of them.
Notes grouped_by_name(const Notes& notes);

}  // namespace meshorder::command
