// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/model/oracle/catenary_shape.hpp"

#include <cmath>

namespace chaintrue::model {
namespace {

/// Integral of the tension over the unstretched length: half of [q T]/w + H u, without the division
/// by w.
double tension_integral(const CatenaryLoad& load, const ChainMaterial& material) {
  const double h = load.horizontal_n, v = load.vertical_n, s = load.length_mm;
  const double w = material.weight_n_per_mm;
  const double vb = v + w * s, vm = v + 0.5 * w * s;
  const double ta = std::sqrt(h * h + v * v), tb = std::sqrt(h * h + vb * vb);
  const double per_sum = 1.0 / (ta + tb);
  const double mean = 2.0 * per_sum * atanh_ratio(w * s * per_sum);
  return 0.5 * s * (2.0 * vb * vm * per_sum + ta + h * h * mean);
}

}  // namespace

CatenaryPoint catenary_point(const CatenaryLoad& load, const ChainMaterial& material, double s_mm) {
  const CatenaryLoad part{load.horizontal_n, load.vertical_n, s_mm};
  const CatenaryExtent e = catenary_extent(part, material);
  return {e.u_mm, e.y_mm, e.tb_n, std::atan2(e.vb_n, load.horizontal_n),
          s_mm + material.compliance_per_n * tension_integral(part, material)};
}

double catenary_strain_energy(const CatenaryLoad& load, const ChainMaterial& material) {
  const double h = load.horizontal_n, v = load.vertical_n, s = load.length_mm;
  const double ws = material.weight_n_per_mm * s;
  return 0.5 * material.compliance_per_n * s * (h * h + v * v + v * ws + ws * ws / 3.0);
}

double catenary_weight_energy(const CatenaryLoad& load, const ChainMaterial& material) {
  const double h = load.horizontal_n, v = load.vertical_n, s = load.length_mm;
  const double ws = material.weight_n_per_mm * s;
  const double rigid = tension_integral(load, material) - s * std::sqrt(h * h + v * v);
  return rigid + material.compliance_per_n * s * ws * (0.5 * v + ws / 6.0);
}

}  // namespace chaintrue::model
