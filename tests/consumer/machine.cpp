// SPDX-License-Identifier: GPL-3.0-or-later
// machine: chain lengths of the classic machine, and why there are none above its motors.
#include <fmt/format.h>

#include <chaintrue/model.hpp>

namespace model = chaintrue::model;

int main() {
  const model::Machine machine;
  const auto kinematics = model::make_kinematics(model::equilibrium_parameters(machine));
  for (const model::BedPoint place : {model::BedPoint{0.0, 0.0}, model::BedPoint{0.0, 1200.0}}) {
    const auto pose = kinematics->inverse(place);
    if (pose) {
      fmt::print("left {:.2f} mm\n", pose->lengths.left_mm);
    } else if (pose.error() == model::PoseReason::above_sprockets) {
      fmt::print("{}\n", pose.error().sentence());
    }
  }
}
