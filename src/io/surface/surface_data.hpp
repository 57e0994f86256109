// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace meshorder {

/// A kind of surface array for which OFF, OBJ and PLY have fields: normals, colours or texture coordinates. A
/// mesh holds it as one array of several components ("normal") or, as PLY does, as arrays of one component
/// ("nx", "ny", "nz").
struct SurfaceVector {
  std::string_view name;
  std::vector<std::string_view> components;
  int least;  ///< number of required components; the others may be missing
};

inline const SurfaceVector kNormal{"normal", {"nx", "ny", "nz"}, 3};
inline const SurfaceVector kColor{"color", {"red", "green", "blue", "alpha"}, 3};
inline const SurfaceVector kTexture{"texture", {"s", "t"}, 2};

/// The rows of a SurfaceVector, gathered from its arrays.
struct GatheredVector {
  int width = 0;          ///< components; 0 when the mesh has no such vector
  bool integers = false;  ///< whether the arrays are of an integer type
  std::vector<double> values;
  std::vector<const DataArray*> from;

  [[nodiscard]] std::span<const double> operator[](Index row) const {
    return {values.data() + static_cast<Offset>(row) * width, static_cast<std::size_t>(width)};
  }
};

/// Returns the vector of all vertices or cells; of width 0 unless the mesh has it for all of them. O(rows).
GatheredVector gather(const Mesh& mesh, const SurfaceVector& vector, Association association);

/// Returns the shape of a face, also of one with one or two vertices.
Shape face_shape(Index vertices);

}  // namespace meshorder
