// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "kernels/aligned.hpp"

#include <cstdint>

namespace meshorder {

/// Isotropic energies per rest volume, in J/m³; F is the deformation gradient.
enum class MaterialModel : std::uint8_t {
  corotational,  ///< μ‖F − R‖² + ½λ tr²(RᵀF − I), R the rotation closest to F (Müller, Gross 2004)
  stvk,          ///< Saint Venant–Kirchhoff: μ E:E + ½λ tr(E)², E = ½(FᵀF − I)
  /// Stable Neo-Hookean (Smith, De Goes, Kim 2018): ψ(F) − ψ(I) with ψ = ½μ'(‖F‖² − 3) + ½λ'(det F − α)² −
  /// ½μ' log(‖F‖² + 1), α = 1 + ¾ μ'/λ'. The logarithm keeps a collapsed element from resting at F = 0. Near
  /// rest, μ' = 4/3 μ and λ' = λ + 5/6 μ give Hooke's law with Lamé's μ and λ.
  neo_hookean,
};

template <>
struct EnumNames<MaterialModel> {
  static constexpr std::string_view kind = "material model";
  static constexpr std::array names{std::pair{MaterialModel::corotational, "corotational"},
                                    std::pair{MaterialModel::stvk, "stvk"},
                                    std::pair{MaterialModel::neo_hookean, "neo-hookean"}};
};

/// The matrix used as the Hessian of the energy.
enum class Tangent : std::uint8_t {
  exact,        ///< the Hessian; indefinite under compression
  approximate,  ///< corotational only: R held constant; semi-definite (Müller, Gross 2004)
  projected,    ///< the semi-definite part of ∂²Ψ/∂F², simplex by simplex; tetrahedra only
};

template <>
struct EnumNames<Tangent> {
  static constexpr std::string_view kind = "tangent";
  static constexpr std::array names{std::pair{Tangent::exact, "exact"},
                                    std::pair{Tangent::approximate, "approximate"},
                                    std::pair{Tangent::projected, "projected"}};
};

/// Lamé's parameters of an isotropic material, in units of stress.
struct Lame {
  double mu = 0.0;
  double lambda = 0.0;

  /// Returns μ = E / (2(1 + ν)) and λ = E ν / ((1 + ν)(1 − 2ν)).
  static Lame from_young(double young, double poisson) {
    return {young / (2.0 * (1.0 + poisson)), young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))};
  }
};

/// The elastic law of all simplices of a mesh.
struct Elasticity {
  MaterialModel model = MaterialModel::corotational;
  Tangent tangent = Tangent::exact;
  Lame lame;  ///< parameters of all simplices, if `mu` and `lambda` are empty
  /// Parameters of each simplex, padded to whole batches (see RestShapes); empty if `lame` is for all.
  AlignedVector<double> mu, lambda;
};

}  // namespace meshorder
