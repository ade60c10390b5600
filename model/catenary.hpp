// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One heavy elastic chain between two points: the elastic catenary in a form without cancellation.
///
/// Notation (used in this file and the equilibrium's sources)
///   H        horizontal tension, N, constant along the chain
///   V, Vb    vertical tension at the sled's end (s = 0) and at the sprocket (s = S): Vb = V + w S
///   Ta, Tb   tension at the two ends
///   S        unstretched length, mm
///   w, c     weight per unstretched mm (N/mm), strain per newton (1/N)
///   u, y     sprocket's end relative to the sled's end: towards the sprocket, and up
///   z, f     z = w S / (Ta + Tb), f = atanh(z) / z
///
/// Irvine's equations (H. M. Irvine, Cable Structures, MIT Press 1981, section 2.6)
///   u = H/w (asinh(Vb/H) - asinh(V/H)) + c H S,   y = (Tb - Ta)/w + c (V S + w S^2 / 2)
/// cancel for a light or taut chain. With
///   tanh((b - a) / 2) = (sinh b - sinh a) / (cosh b + cosh a)
/// they become
///   u = S H (2 f / (Ta + Tb) + c),   y = S (V + w S / 2) (2 / (Ta + Tb) + c)                (1)
/// which holds for every w >= 0, for V < 0 (a chain that hangs below its end) and has the
/// weightless chain as its limit. Accuracy: a few units in the last place of u and y. Stateless;
/// nothing allocates or throws.
///
/// \code
///   const CatenaryLoad load{.horizontal_n = 60, .vertical_n = 50, .length_mm = 1700};
///   const CatenaryExtent end = catenary_extent(load, ChainMaterial{1.3e-3, 5.2e-6});
/// \endcode
#pragma once

#include <cmath>

namespace chaintrue::model {

struct ChainMaterial {
  double weight_n_per_mm = 0.0;
  double compliance_per_n = 0.0;
};

/// The pull at the sled's end, and how much chain hangs on it.
struct CatenaryLoad {
  double horizontal_n = 0.0;
  double vertical_n = 0.0;
  double length_mm = 0.0;
};

/// Where the series of atanh(z)/z is exact to the last bit: the first term left out, q^8/17, is
/// below 6e-18.
inline constexpr double kSeriesMost = 0.01;

/// atanh(z)/z for |z| < 1.
inline double atanh_ratio(double z) {
  const double q = z * z;
  if (q < kSeriesMost) {
    return 1.0 +
           q * (1.0 / 3 +
                q * (1.0 / 5 +
                     q * (1.0 / 7 + q * (1.0 / 9 + q * (1.0 / 11 + q * (1.0 / 13 + q / 15))))));
  }
  return std::atanh(z) / z;
}

/// d(atanh(z)/z)/dz.
inline double atanh_ratio_slope(double z) {
  const double q = z * z;
  if (q < kSeriesMost) {
    return z * (2.0 / 3 +
                q * (4.0 / 5 +
                     q * (6.0 / 7 +
                          q * (8.0 / 9 + q * (10.0 / 11 + q * (12.0 / 13 + q * 14.0 / 15))))));
  }
  return (1.0 / (1.0 - q) - std::atanh(z) / z) / z;
}

/// The chain's extent and its symmetric flexibility matrix (u, y) by (H, V), which is the Hessian
/// of the complementary energy and positive definite.
struct CatenaryExtent {
  double vb_n = 0.0, ta_n = 0.0, tb_n = 0.0;
  double u_mm = 0.0, y_mm = 0.0;
  double u_by_h = 0.0, u_by_v = 0.0, y_by_v = 0.0;  ///< mm/N; y_by_h = u_by_v
};

inline CatenaryExtent catenary_extent(const CatenaryLoad& load, const ChainMaterial& material) {
  const double h = load.horizontal_n, v = load.vertical_n, s = load.length_mm;
  const double w = material.weight_n_per_mm, c = material.compliance_per_n;
  CatenaryExtent e;
  e.vb_n = v + w * s;
  e.ta_n = std::sqrt(h * h + v * v);
  e.tb_n = std::sqrt(h * h + e.vb_n * e.vb_n);
  const double per_sum = 1.0 / (e.ta_n + e.tb_n);
  const double per_product = per_sum / (e.ta_n * e.tb_n);
  const double vm = v + 0.5 * w * s;
  const double mean = 2.0 * per_sum * atanh_ratio(w * s * per_sum);
  const double bend = s * (h * h + e.ta_n * e.tb_n - v * e.vb_n) * per_product;
  e.u_mm = s * h * (mean + c);
  e.y_mm = s * vm * (2.0 * per_sum + c);
  e.u_by_h = s * mean - bend + c * s;
  e.u_by_v = -2.0 * h * s * vm * per_product;
  e.y_by_v = bend + c * s;
  return e;
}

}  // namespace chaintrue::model
