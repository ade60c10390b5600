// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/kinematics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "model/chain_formulas.hpp"
#include "model/equilibrium_kinematics.hpp"
#include "model/formula_kinematics.hpp"
#include "model/spatial_kinematics.hpp"

namespace chaintrue::model {
namespace {

constexpr double kStandardGravity = 9.80665;  // m/s^2, CGPM 1901
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void require(const char* parameter, double value, double least, double most) {
  if (value >= least && value <= most) return;  // false for NaN
  throw std::invalid_argument(
      fmt::format("{} = {}: expected a number from {} to {}", parameter, value, least, most));
}

void require_sound(const EquilibriumParameters& p) {
  constexpr double kMost = 1e6;  // mm and N: a kilometre, a hundred tonnes
  for (const Side side : kSides) {
    require("motor x_mm", p.motors[side].x_mm, -kMost, kMost);
    require("motor y_mm", p.motors[side].y_mm, -kMost, kMost);
  }
  require("sprocket_radius_mm", p.sprocket_radius_mm, 0.0, 1e3);
  if (!(p.motors.right.x_mm - p.motors.left.x_mm > 2.0 * p.sprocket_radius_mm)) {
    throw std::invalid_argument(
        fmt::format("motor x_mm, left {} and right {}: expected the right motor right of the left "
                    "one by more than the sprocket's diameter",
                    p.motors.left.x_mm, p.motors.right.x_mm));
  }
  if (const auto* ring = std::get_if<Ring>(&p.attachment)) {
    require("ring_radius_mm", ring->radius_mm, 0.0, 1e4);
  } else {
    const auto& brackets = std::get<Brackets>(p.attachment);
    require("brackets spacing_mm", brackets.spacing_mm, 0.0, 1e4);
    require("brackets height_mm", brackets.height_mm, 0.0, 1e4);
    require("brackets cg_below_bit_mm", brackets.cg_below_bit_mm, -1e4, 1e4);
  }
  require("sled_weight_n", p.sled_weight_n, std::numeric_limits<double>::min(), kMost);
  require("chain_weight_n_per_mm", p.chain_weight_n_per_mm, 0.0, 1.0);
  require("chain_compliance_per_n", p.chain_compliance_per_n, 0.0, 0.01);
  require("tilt_rad", p.tilt_rad, -1.55, 1.55);  // on a flat frame the chains do not hang
  require("beam_flexibility_mm_per_n", p.beam_flexibility_mm_per_n, 0.0, 10.0);
  require("side_force_n", p.side_force_n, -kMost, kMost);
  require("sag_correction", p.sag_correction, -kInfinity, kInfinity);
}

/// The weightless limit: where the beam yields or the sled rotates there is no closed form, and the
/// equilibrium is solved with weightless inextensible chains.
std::unique_ptr<const Kinematics> weightless(const EquilibriumParameters& p, Formula formula) {
  const bool closed =
      std::holds_alternative<Ring>(p.attachment) && p.beam_flexibility_mm_per_n == 0.0;
  if (closed) return make_formula_kinematics(p, formula);
  return make_equilibrium_kinematics(
      p, {.sprocket = formula == Formula::straight, .chain_weight = true, .compliance = true});
}

}  // namespace

EquilibriumParameters equilibrium_parameters(const Machine& machine) {
  EquilibriumParameters p;
  p.motors = machine.motors;
  p.sprocket_radius_mm = machine.sprocket.effective_radius_mm();
  p.feed = machine.feed;
  p.attachment = machine.attachment;
  p.tilt_rad = machine.frame.tilt_from_vertical_deg * std::numbers::pi / 180.0;
  const double gravity = kStandardGravity * std::cos(p.tilt_rad);
  p.sled_weight_n = machine.sled.mass_kg * gravity;
  p.chain_weight_n_per_mm = machine.chain.mass_kg_per_m * 1e-3 * gravity;
  p.chain_compliance_per_n = machine.chain.compliance_per_n;
  p.sag_correction = closed_form_sag_correction(p.chain_weight_n_per_mm, p.sled_weight_n);
  return p;
}

MechanismReason named(PoseReason reason) {
  constexpr std::array<MechanismReason, 6> kReasons = {{
      {"outside_verticals",
       "the point is not between the two motors; no sled can hang outside them"},
      {"above_sprockets",
       "the point is at least as high as the motors; a sled can only hang below them"},
      {"link_does_not_fit",
       "the point is so close to a sprocket that the ring or bracket would reach past it"},
      {"slack", "one chain would have to push, so it hangs slack"},
      {"too_short", "the chains are too short to meet"},
      {"not_converged", "no equilibrium of the sled was found"},
  }};
  return kReasons.at(static_cast<std::size_t>(reason));
}

Eigen::Matrix2d Kinematics::jacobian(const Pose& pose) const {
  const PerSide<ChainNumbers<2>> chains = by_place(pose);
  const auto &left = chains.left.length_mm.d, &right = chains.right.length_mm.d;
  Eigen::Matrix2d j;
  j << left[0], left[1], right[0], right[1];
  return j;
}

std::unique_ptr<const Kinematics> make_kinematics(const EquilibriumParameters& parameters,
                                                  Model model) {
  require_sound(parameters);
  const bool ring = std::holds_alternative<Ring>(parameters.attachment);
  switch (model) {
    case Model::straight:
      return weightless(parameters, Formula::straight);
    case Model::wrap:
      return weightless(parameters, Formula::wrap);
    // The firmware's quadrilateral has neither sag nor stretch: it is the weightless model.
    case Model::firmware:
      if (!ring) return weightless(parameters, Formula::wrap);
      return make_formula_kinematics(parameters, Formula::firmware);
    case Model::one_shot:
      return make_formula_kinematics(parameters, Formula::one_shot);
    case Model::inextensible:
      return make_equilibrium_kinematics(parameters, {.compliance = true});
    case Model::elastic:
      return make_equilibrium_kinematics(parameters);
    case Model::elastic_3d:
      break;
  }
  return make_spatial_kinematics(parameters);
}

}  // namespace chaintrue::model
