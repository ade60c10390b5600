// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points along a chain and its energies. Notation in model/catenary.hpp.
#pragma once

#include "model/catenary.hpp"

namespace chaintrue::model {

/// A point of the chain.
struct CatenaryPoint {
  double u_mm = 0.0, y_mm = 0.0;  ///< from the sled's end
  double tension_n = 0.0;
  double slope_rad = 0.0;            ///< of the tension, above the horizontal
  double stretched_length_mm = 0.0;  ///< from the sled's end to here
};

/// The chain at unstretched length `s_mm` from the sled's end, 0 <= s_mm <= length.
CatenaryPoint catenary_point(const CatenaryLoad& load, const ChainMaterial& material, double s_mm);

/// Elastic energy stored in the chain, N mm: c/2 times the integral of T^2.
double catenary_strain_energy(const CatenaryLoad& load, const ChainMaterial& material);
/// Weight moment about the sled's end, N mm: w times the integral of y(s), the chain's potential
/// energy relative to that end.
double catenary_weight_energy(const CatenaryLoad& load, const ChainMaterial& material);

}  // namespace chaintrue::model
