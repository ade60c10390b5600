// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/model/oracle/chain_shape.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "model/equilibrium.hpp"

namespace chaintrue::model {

ChainShape::ChainShape(const EquilibriumParameters& parameters,
                       const Pose& pose,
                       Side side,
                       Model model) {
  const bool spatial = model == Model::elastic_3d;
  if (!spatial && model != Model::elastic && model != Model::inextensible) {
    throw std::invalid_argument(
        "only the chains of an equilibrium have a shape, not those of a closed formula");
  }
  const EquilibriumConstants m = equilibrium_constants(parameters);
  const ChainState& c = pose.chains[side];
  towards_ = side == Side::left ? -1.0 : 1.0;
  chain_ = {m.chain.weight_n_per_mm, model == Model::inextensible ? 0.0 : m.chain.compliance_per_n};
  const double h = c.horizontal_n, v = c.vertical_at_sled_n, n = c.out_of_sheet_n;
  load_ = {h, v, c.free_length_mm};
  if (spatial) {
    up_y_ = std::cos(parameters.tilt_rad);
    up_z_ = std::sin(parameters.tilt_rad);
    chain_.weight_n_per_mm /= up_y_;
    const double up = v * up_y_ + n * up_z_;
    const double y = v - up * up_y_, z = n - up * up_z_;
    const double across = std::sqrt(h * h + y * y + z * z);
    across_u_ = h / across;
    across_y_ = y / across;
    across_z_ = z / across;
    load_ = {across, up, c.free_length_mm};
  }
  const Attachments a = attachments(m, pose.sled_rotation_rad);
  const double ax = side == Side::left ? a.left_x : a.right_x,
               ay = side == Side::left ? a.left_y : a.right_y;
  const double ring = m.rho / c.tension_at_sled_n;
  end_ = {pose.position.x_mm + ax + towards_ * ring * h, pose.position.y_mm + ay + ring * v};
  end_off_sheet_mm_ = ring * n;
}

ShapePoint ChainShape::at(double s_mm) const {
  if (!(s_mm >= 0.0 && s_mm <= load_.length_mm)) {
    throw std::invalid_argument(fmt::format(
        "s_mm = {}: expected a length from 0 to the chain's {} mm", s_mm, load_.length_mm));
  }
  const CatenaryPoint p = catenary_point(load_, chain_, s_mm);
  return {
      {end_.x_mm + towards_ * p.u_mm * across_u_, end_.y_mm + p.u_mm * across_y_ + p.y_mm * up_y_},
      end_off_sheet_mm_ + p.u_mm * across_z_ + p.y_mm * up_z_,
      p.tension_n,
      p.stretched_length_mm};
}

}  // namespace chaintrue::model
