// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/model/oracle/chain_shape.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace chaintrue::model {
namespace {

// Every model's chain starts at the sled's attachment and ends on the sprocket, touching it, in the
// sheet, with the pose's tensions.
TEST(ChainShape, LeadsFromTheSledToTheSprocketsTangent) {
  for (const Model model : {Model::inextensible, Model::elastic, Model::elastic_3d}) {
    for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
      for (const Attachment& attachment : {Attachment{Ring{}}, Attachment{Brackets{}}}) {
        Machine machine;
        machine.feed = feed;
        machine.attachment = attachment;
        EquilibriumParameters m = equilibrium_parameters(machine);
        m.motors.right.y_mm += 40.0;
        const auto kinematics = make_kinematics(m, model);
        for (const BedPoint p : {BedPoint{-1100.0, -500.0}, {300.0, 200.0}}) {
          const Pose pose = kinematics->inverse(p).value();
          for (const Side side : kSides) {
            SCOPED_TRACE(testing::Message() << "model " << static_cast<int>(model) << " at "
                                            << p.x_mm << (side == Side::left ? " left" : " right"));
            const ChainShape shape(m, pose, side, model);
            const ChainState& c = pose.chains[side];
            const double outward = side == Side::left ? 1.0 : -1.0,
                         sg = feed == Feed::over_top ? 1.0 : -1.0;
            const double r = m.sprocket_radius_mm;
            const ShapePoint top = shape.at(shape.length_mm());
            constexpr double kTolerance = 1e-11;  // of the pose
            EXPECT_NEAR(top.place.x_mm,
                        m.motors[side].x_mm + outward * sg * r * std::sin(c.angle_rad),
                        kTolerance);
            EXPECT_NEAR(
                top.place.y_mm, m.motors[side].y_mm + sg * r * std::cos(c.angle_rad), kTolerance);
            EXPECT_NEAR(top.off_sheet_mm, 0.0, kTolerance);
            EXPECT_NEAR(top.tension_n, c.tension_at_sprocket_n, 1e-12 * c.tension_at_sprocket_n);
            const ShapePoint end = shape.at(0.0);
            EXPECT_DOUBLE_EQ(end.tension_n, c.tension_at_sled_n);
            const double reach =
                std::holds_alternative<Ring>(attachment) ? 139.1 : std::hypot(155.0, 139.0);
            EXPECT_NEAR(
                std::hypot(end.place.x_mm - p.x_mm, end.place.y_mm - p.y_mm, end.off_sheet_mm),
                reach,
                1e-11);
            // Tension changes by the chain's weight times the height climbed, exactly
            // so without stretch.
            if (model == Model::inextensible) {
              const ShapePoint half = shape.at(0.5 * shape.length_mm());
              EXPECT_NEAR(top.tension_n - half.tension_n,
                          m.chain_weight_n_per_mm * (top.place.y_mm - half.place.y_mm),
                          1e-12);
              EXPECT_DOUBLE_EQ(top.stretched_length_mm, shape.length_mm());
            }
          }
        }
      }
    }
  }
}

TEST(ChainShape, RefusesAFormulaAndAPlaceBeyondTheChain) {
  const EquilibriumParameters m = equilibrium_parameters(Machine{});
  const Pose pose = make_kinematics(m)->inverse({0.0, 0.0}).value();
  EXPECT_THROW(ChainShape(m, pose, Side::left, Model::wrap), std::invalid_argument);
  const ChainShape shape(m, pose, Side::left);
  EXPECT_THROW(std::ignore = shape.at(-1.0), std::invalid_argument);
  EXPECT_THROW(std::ignore = shape.at(shape.length_mm() + 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::model
