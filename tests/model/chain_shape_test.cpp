// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "model/equilibrium.hpp"
#include "model/kinematics.hpp"
#include "tests/model/oracle/catenary_shape.hpp"

namespace chaintrue::model {
namespace {

/// A point of a chain: in the sheet's axes, the third towards the front.
struct ShapePoint {
  BedPoint place;
  double off_sheet_mm = 0.0;
  double tension_n = 0.0;
};

/// The catenary of a pose at unstretched length s from the sled's end.
ShapePoint point_of_chain(const EquilibriumParameters& parameters, const Pose& pose, Side side,
                          Model model, double s_mm) {
  const EquilibriumConstants m = equilibrium_constants(parameters);
  const ChainState& c = pose.chains[side];
  const double towards = side == Side::left ? -1.0 : 1.0;
  ChainMaterial chain{m.chain.weight_n_per_mm,
                      model == Model::inextensible ? 0.0 : m.chain.compliance_per_n};
  const double h = c.horizontal_n, v = c.vertical_at_sled_n, n = c.out_of_sheet_n;
  CatenaryLoad load{h, v, c.free_length_mm};
  // The horizontal of the vertical plane that the chain hangs in, and that plane's up.
  double across_u = 1.0, across_y = 0.0, across_z = 0.0, up_y = 1.0, up_z = 0.0;
  if (model == Model::elastic_3d) {
    up_y = std::cos(parameters.tilt_rad);
    up_z = std::sin(parameters.tilt_rad);
    chain.weight_n_per_mm /= up_y;
    const double up = v * up_y + n * up_z;
    const double y = v - up * up_y, z = n - up * up_z;
    const double across = std::sqrt(h * h + y * y + z * z);
    across_u = h / across;
    across_y = y / across;
    across_z = z / across;
    load = {across, up, c.free_length_mm};
  }
  const Attachments a = attachments(m, pose.sled_rotation_rad);
  const double ax = side == Side::left ? a.left_x : a.right_x,
               ay = side == Side::left ? a.left_y : a.right_y;
  const double ring = m.rho / c.tension_at_sled_n;
  const CatenaryPoint p = catenary_point(load, chain, s_mm);
  return {{pose.position.x_mm + ax + towards * (ring * h + p.u_mm * across_u),
           pose.position.y_mm + ay + ring * v + p.u_mm * across_y + p.y_mm * up_y},
          ring * n + p.u_mm * across_z + p.y_mm * up_z,
          p.tension_n};
}

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
        for (const BedPoint p :
             {BedPoint{-1100.0, -500.0}, {300.0, 200.0}, {1210.0, -600.0}, {-40.0, 590.0}}) {
          const Pose pose = kinematics->inverse(p).value();
          // Without a side force the chains carry the sled between them.
          EXPECT_EQ(pose.chains.left.horizontal_n, pose.chains.right.horizontal_n);
          EXPECT_NEAR(pose.chains.left.vertical_at_sled_n + pose.chains.right.vertical_at_sled_n,
                      m.sled_weight_n, 1e-13 * m.sled_weight_n);
          for (const Side side : kSides) {
            SCOPED_TRACE(testing::Message() << "model " << static_cast<int>(model) << " at "
                                            << p.x_mm << (side == Side::left ? " left" : " right"));
            const ChainState& c = pose.chains[side];
            const auto shape = [&](double s_mm) {
              return point_of_chain(m, pose, side, model, s_mm);
            };
            const double outward = side == Side::left ? 1.0 : -1.0,
                         sg = feed == Feed::over_top ? 1.0 : -1.0;
            const double r = m.sprocket_radius_mm;
            const ShapePoint top = shape(c.free_length_mm);
            constexpr double kTolerance = 1e-11;  // of the pose
            EXPECT_NEAR(top.place.x_mm,
                        m.motors[side].x_mm + outward * sg * r * std::sin(c.angle_rad), kTolerance);
            EXPECT_NEAR(top.place.y_mm, m.motors[side].y_mm + sg * r * std::cos(c.angle_rad),
                        kTolerance);
            EXPECT_NEAR(top.off_sheet_mm, 0.0, kTolerance);
            EXPECT_NEAR(top.tension_n, c.tension_at_sprocket_n, 1e-12 * c.tension_at_sprocket_n);
            const ShapePoint end = shape(0.0);
            EXPECT_DOUBLE_EQ(end.tension_n, c.tension_at_sled_n);
            const double reach =
                std::holds_alternative<Ring>(attachment) ? 139.1 : std::hypot(155.0, 139.0);
            EXPECT_NEAR(
                std::hypot(end.place.x_mm - p.x_mm, end.place.y_mm - p.y_mm, end.off_sheet_mm),
                reach, 1e-11);
            // Tension changes by the chain's weight times the height climbed, exactly
            // so without stretch.
            if (model == Model::inextensible) {
              const ShapePoint half = shape(0.5 * c.free_length_mm);
              EXPECT_NEAR(top.tension_n - half.tension_n,
                          m.chain_weight_n_per_mm * (top.place.y_mm - half.place.y_mm), 1e-12);
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace chaintrue::model
