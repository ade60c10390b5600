// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/controllers/payout.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "model/chain_formulas.hpp"
#include "model/formula_kinematics.hpp"

namespace chaintrue::model {
namespace {

/// A controller whose kinematics is one of the model's.
class BelievedKinematics final : public ControllerKinematics {
 public:
  BelievedKinematics(std::unique_ptr<const Kinematics> kinematics, ChainLengths zero)
      : kinematics_(std::move(kinematics)), zero_(zero) {}

  [[nodiscard]] tl::expected<ChainLengths, PoseFailure> lengths(BedPoint command) const override {
    return kinematics_->inverse(command).map([this](const Pose& pose) {
      return ChainLengths{pose.lengths.left_mm + zero_.left_mm,
                          pose.lengths.right_mm + zero_.right_mm};
    });
  }
  [[nodiscard]] tl::expected<BedPoint, PoseFailure> command(ChainLengths lengths) const override {
    return kinematics_
        ->forward({lengths.left_mm - zero_.left_mm, lengths.right_mm - zero_.right_mm})
        .map([](const Pose& pose) { return pose.position; });
  }

 private:
  std::unique_ptr<const Kinematics> kinematics_;
  ChainLengths zero_;
};

/// Motor positions of the settings; those not set are the stated machine's.
PerSide<MotorPosition> believed_motors(const Machine& machine) {
  const ControllerSettings& s = machine.controller.settings;
  PerSide<MotorPosition> motors = machine.motors;
  if (s.motor_spacing_mm) {
    motors.left.x_mm = -0.5 * *s.motor_spacing_mm;
    motors.right.x_mm = 0.5 * *s.motor_spacing_mm;
  }
  if (s.motor_offset_y_mm) {
    const double y = 0.5 * s.bed_height_mm.value_or(machine.bed.height_mm) + *s.motor_offset_y_mm;
    motors.left.y_mm = motors.right.y_mm = y;
  }
  const double tilt = s.top_beam_tilt_deg.value_or(0.0) * std::numbers::pi / 180.0;
  const double cx = 0.5 * (motors.left.x_mm + motors.right.x_mm);
  const double cy = 0.5 * (motors.left.y_mm + motors.right.y_mm);
  for (const Side side : kSides) {
    const double dx = motors[side].x_mm - cx, dy = motors[side].y_mm - cy;
    motors[side] = {cx + dx * std::cos(tilt) - dy * std::sin(tilt),
                    cy + dx * std::sin(tilt) + dy * std::cos(tilt)};
  }
  return motors;
}

EquilibriumParameters believed_parameters(const Machine& machine) {
  constexpr double kStandardGravity = 9.80665;
  const ControllerSettings& s = machine.controller.settings;
  EquilibriumParameters p = equilibrium_parameters(machine);
  p.motors = believed_motors(machine);
  if (s.rotation_radius_mm && std::holds_alternative<Ring>(p.attachment)) {
    p.attachment = Ring{*s.rotation_radius_mm};
  }
  if (auto* brackets = std::get_if<Brackets>(&p.attachment)) {
    brackets->spacing_mm = s.sled_width_mm.value_or(brackets->spacing_mm);
    brackets->height_mm = s.sled_height_mm.value_or(brackets->height_mm);
    brackets->cg_below_bit_mm = s.sled_cg_mm.value_or(brackets->cg_below_bit_mm);
  }
  if (s.chain_pitch_mm || s.gear_teeth) {
    p.sprocket_radius_mm = s.chain_pitch_mm.value_or(machine.sprocket.pitch_mm) *
                           s.gear_teeth.value_or(machine.sprocket.teeth) / (2.0 * std::numbers::pi);
  }
  if (s.chain_over_sprocket_top) {
    p.feed = *s.chain_over_sprocket_top ? Feed::over_top : Feed::off_bottom;
  }
  if (s.sled_weight_n) {
    // The firmware's weights of chain and sled are those on a vertical frame.
    p.sled_weight_n = *s.sled_weight_n;
    p.chain_weight_n_per_mm = machine.chain.mass_kg_per_m * 1e-3 * kStandardGravity;
    p.sag_correction = closed_form_sag_correction(p.chain_weight_n_per_mm, p.sled_weight_n);
  }
  if (s.chain_elongation_per_n) p.chain_compliance_per_n = *s.chain_elongation_per_n;
  if (s.chain_sag_correction) p.sag_correction = *s.chain_sag_correction;
  return p;
}

std::unique_ptr<const Kinematics> believed_kinematics(const Machine& machine) {
  const EquilibriumParameters p = believed_parameters(machine);
  const ControllerSettings& s = machine.controller.settings;
  const PerSide<double> tolerance{s.left_chain_tolerance_percent.value_or(0.0),
                                  s.right_chain_tolerance_percent.value_or(0.0)};
  switch (machine.controller.kind) {
    case ControllerKind::ideal:
      return make_kinematics(equilibrium_parameters(machine), Model::elastic);
    case ControllerKind::maslow_classic:
      // The firmware's quadrilateral has neither sag nor tolerances.
      if (!std::holds_alternative<Ring>(p.attachment)) return make_kinematics(p, Model::firmware);
      return make_formula_kinematics(p, Formula::firmware, tolerance);
    case ControllerKind::holey:
      return make_formula_kinematics(p, Formula::one_shot, tolerance);
    case ControllerKind::fluidnc_wallplotter:
      break;
  }
  return make_formula_kinematics(p, Formula::straight);
}

}  // namespace

std::unique_ptr<const ControllerKinematics> make_controller_kinematics(const Machine& machine) {
  const bool ideal = machine.controller.kind == ControllerKind::ideal;
  return std::make_unique<BelievedKinematics>(believed_kinematics(machine),
                                              ideal ? machine.chain_zero : ChainLengths{});
}

}  // namespace chaintrue::model
