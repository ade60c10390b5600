// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/reading_model.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace chaintrue::model {
namespace {

const Machine& sound(const Machine& machine) {
  const auto problems = problems_of(machine);
  if (problems.empty()) return machine;
  std::string text = "a machine that cannot be computed with:";
  for (const MachineProblem& p : problems) {
    text += fmt::format(" {} = {}, expected {};", p.parameter, p.value, p.expected);
  }
  text.pop_back();
  throw std::invalid_argument(text);
}

}  // namespace

ReadingModel::ReadingModel(const Machine& machine, Model model)
    : machine_(sound(machine)),
      kinematics_(make_kinematics(equilibrium_parameters(machine), model)) {
  if (!machine.effects.empty()) {
    throw std::invalid_argument(
        fmt::format("the effect \"{}\" is not catalogued", machine.effects.front().effect));
  }
}

tl::expected<PointReading, PoseFailure> ReadingModel::at(BedPoint point) const {
  return kinematics_->inverse(point).map([this](const Pose& pose) {
    PointReading reading;
    reading.pose = pose;
    reading.lengths = {pose.lengths.left_mm + machine_.chain_zero.left_mm,
                       pose.lengths.right_mm + machine_.chain_zero.right_mm};
    reading.position_jacobian = kinematics_->jacobian(pose);
    return reading;
  });
}

Eigen::Vector2d ReadingModel::sensitivity(const PointReading& reading, Setting setting) const {
  switch (setting) {
    case Setting::motor_left_x_mm:
      return kinematics_->sensitivity(reading.pose, Parameter::motor_left_x_mm);
    case Setting::motor_left_y_mm:
      return kinematics_->sensitivity(reading.pose, Parameter::motor_left_y_mm);
    case Setting::motor_right_x_mm:
      return kinematics_->sensitivity(reading.pose, Parameter::motor_right_x_mm);
    case Setting::motor_right_y_mm:
      return kinematics_->sensitivity(reading.pose, Parameter::motor_right_y_mm);
    case Setting::chain_zero_left_mm:
      return {1.0, 0.0};
    case Setting::chain_zero_right_mm:
      return {0.0, 1.0};
    case Setting::sheet_x_mm:
    case Setting::sheet_y_mm:
    case Setting::sheet_rotation_rad:
      break;
  }
  throw std::invalid_argument(
      "the sheet's placement is no setting of the machine: a reading model has none");
}

}  // namespace chaintrue::model
