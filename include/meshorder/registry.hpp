// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>
#include <meshorder/number_view.hpp>
#include <meshorder/options.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/view.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// Description of a method in lists of methods.
struct MethodInfo {
  std::string name = {};         ///< lower case letters, digits, '-' and '_'; unique
  std::string description = {};  ///< one line
  bool needs_points = false;     ///< a call without coordinates throws InvalidArgument
  bool deterministic = true;     ///< the same result on every run and for any number of threads
  std::string source = "built in";
};

/// Input of a vertex method: a clean graph (rows ascend, no loops, no repeats, symmetric). Valid during the
/// call.
struct VertexProblem {
  std::span<const Offset> offsets;    ///< n + 1, from 0
  std::span<const Index> neighbours;  ///< offsets[n]
  std::span<const double> weights;    ///< one for each neighbour, or none
  PointsView points;                  ///< n, or none
};

/// Input of an element method: cells of one dimension and the order of the vertices. Valid during the call.
struct ElementProblem {
  std::span<const Offset> offsets;      ///< m + 1, from 0
  std::span<const Index> vertices;      ///< offsets[m] numbers in 0 … n−1
  std::span<const Index> vertex_ranks;  ///< n: the new place of each vertex
  PointsView points;                    ///< n, in the vertices' old order, or none
};

/// A vertex method returns the order of the n vertices. It may throw; the exception reaches the caller that
/// requested the order. It runs on the caller's thread, and on several threads at once if several request an
/// order.
using VertexMethod = std::function<Permutation(const VertexProblem&, const OrderOptions&)>;

/// An element method returns the order of the m elements. Calls and exceptions are as for a `VertexMethod`.
using ElementMethod = std::function<Permutation(const ElementProblem&, const OrderOptions&)>;

/// Owner of an entry in the list of methods; the destructor removes the method. Calls that are running
/// finish with their own copy of the method. Move-only.
class [[nodiscard]] MESHORDER_API Registration {
 public:
  /// Owns nothing.
  Registration() = default;
  Registration(Registration&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Registration& operator=(Registration&& other) noexcept;
  Registration(const Registration&) = delete;
  Registration& operator=(const Registration&) = delete;
  ~Registration();

  /// Leaves the method in the list until the program ends.
  void keep() && noexcept { id_ = 0; }

  /// For the registry only: owns the entry with that number, > 0.
  explicit Registration(std::uint64_t id) noexcept : id_(id) {}

 private:
  std::uint64_t id_ = 0;
};

/// Adds a vertex method, which `order_vertices`, `compare` and the C interface then find by its name. `auto`
/// never chooses it.
///
/// @param info    name and description
/// @param method  must not be empty; its result is checked to have n places
/// @throws InvalidArgument if the name is taken, is "auto" or has characters that are not allowed, and for an
///         empty method
/// @note Thread-safe.
MESHORDER_API Registration register_vertex_method(MethodInfo info, VertexMethod method);

/// Adds an element method. Parameters and exceptions are those of `register_vertex_method`.
MESHORDER_API Registration register_element_method(MethodInfo info, ElementMethod method);

/// Lists the methods of this build and the registered ones, in the order in which help shows them.
/// Thread-safe.
[[nodiscard]] MESHORDER_API std::vector<MethodInfo> vertex_methods();
[[nodiscard]] MESHORDER_API std::vector<MethodInfo> element_methods();

/// Loads a shared library and calls its `meshorder_plugin_v1` (see meshorder.h), which registers methods. The
/// library is never unloaded.
///
/// @throws Unavailable if the library cannot be loaded or lacks that function, or if the platform has no
///         shared libraries
/// @throws InvalidArgument if that function returns a number other than 0
/// @warning Runs code of that library.
MESHORDER_API void load_methods(const std::filesystem::path& shared_library);

}  // namespace v0_3
}  // namespace meshorder
