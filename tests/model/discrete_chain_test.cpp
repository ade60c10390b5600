// SPDX-License-Identifier: GPL-3.0-or-later
// The pose compared with chains of straight links, each with half of its weight at either end, as the laboratory's
// machine has them: no catenary is used.
#include <gtest/gtest.h>

#include <cmath>

#include "generator/hidden/rest.hpp"
#include "model/kinematics.hpp"
#include "model/machine.hpp"

namespace chaintrue::model {
namespace {

generator::TrueMachine linked(const Machine& machine) {
  generator::TrueMachine m;
  m.axis = {{{machine.motors.left.x_mm, machine.motors.left.y_mm},
             {machine.motors.right.x_mm, machine.motors.right.y_mm}}};
  m.over_top = machine.feed == Feed::over_top;
  m.ring_radius_mm = std::get<Ring>(machine.attachment).radius_mm;
  m.chain_mass_kg_per_m = machine.chain.mass_kg_per_m;
  m.compliance_per_n = machine.chain.compliance_per_n;
  m.sled_mass_kg = machine.sled.mass_kg;
  m.tilt_from_vertical_deg = machine.frame.tilt_from_vertical_deg;
  m.wheel = generator::WheelShape::round;
  return m;
}

TEST(DiscreteChain, ApproachesThePoseAsItsPiecesGetShorter) {
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    Machine machine;
    machine.feed = feed;
    generator::TrueMachine links = linked(machine);
    const auto kinematics = make_kinematics(equilibrium_parameters(machine));
    for (const BedPoint p :
         {BedPoint{0.0, 0.0}, {-1100.0, -550.0}, {700.0, 500.0}, {1200.0, -100.0}}) {
      const ChainLengths pose = kinematics->inverse(p).value().lengths;
      for (const Side side : kSides) {
        SCOPED_TRACE(testing::Message()
                     << (links.over_top ? "over top" : "off bottom") << " (" << p.x_mm << ", "
                     << p.y_mm << ")" << (side == Side::left ? " left" : " right"));
        double error[3];
        for (int k = 0; k < 3; ++k) {
          links.pieces_per_link = 1 << k;
          const auto rest = generator::come_to_rest(links, {p.x_mm, p.y_mm});
          ASSERT_TRUE(rest);
          error[k] = rest->chain[side == Side::left ? 0 : 1].length_mm - pose[side];
        }
        EXPECT_LE(std::abs(error[0]), 7e-5);
        // The bend at each pin makes an error of h^2; with that eliminated h^4 remains, and Newton's last step.
        EXPECT_LE(std::abs(4.0 * error[2] - error[1]) / 3.0, 1e-10);
      }
    }
  }
}

}  // namespace
}  // namespace chaintrue::model
