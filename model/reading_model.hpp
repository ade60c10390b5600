// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From a machine with its effects to the lengths that a person would read off it: machine -> chain
/// -> reading.
///
///   reading = (L0 + chain effects) / (1 + e) + chain_zero (1)
///
/// L0 from the equilibrium with every machine effect on; chain effects in the catalogue's order on
/// that state; e the elongation of chain_pitch_error. This class answers the repeatable part of a
/// reading: what it would be without drift, skips and hysteresis, which depend on the visit and not
/// on the place.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <tl/expected.hpp>

#include "model/kinematics.hpp"
#include "model/machine.hpp"

namespace chaintrue::model {

/// What a grid can calibrate before anything is named (shared words with the file formats).
enum class Setting {
  motor_left_x_mm,
  motor_left_y_mm,
  motor_right_x_mm,
  motor_right_y_mm,
  chain_zero_left_mm,
  chain_zero_right_mm,
  sheet_x_mm,
  sheet_y_mm,
  sheet_rotation_rad,
};

struct PointReading {
  Pose pose;
  ChainLengths lengths;
  /// d(left, right)/d(x, y)
  Eigen::Matrix2d position_jacobian = Eigen::Matrix2d::Zero();
};

class ReadingModel {
 public:
  /// \throws std::invalid_argument for a machine with problems (problems_of) or an effect that is
  /// not catalogued.
  explicit ReadingModel(const Machine& machine, Model model = Model::elastic);
  [[nodiscard]] tl::expected<PointReading, PoseFailure> at(BedPoint point) const;
  /// d(left, right)/d(setting) for the motor positions and chain zeros.
  [[nodiscard]] Eigen::Vector2d sensitivity(const PointReading& reading, Setting setting) const;
  [[nodiscard]] const Machine& machine() const { return machine_; }

 private:
  Machine machine_;
  std::shared_ptr<const Kinematics> kinematics_;
};

}  // namespace chaintrue::model
