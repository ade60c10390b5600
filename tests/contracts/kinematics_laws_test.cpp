// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of every kinematics. A new model is one line in kinds().
#include <gmock/gmock.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "model/kinematics.hpp"
#include "tests/support/over_the_bed.hpp"

namespace chaintrue::model {
namespace {

using testing_support::over_the_bed;

constexpr std::uint64_t kLawSeed = 20260115;

struct Kind {
  std::string name;
  EquilibriumParameters parameters;
  Model model;
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

EquilibriumParameters classic(Feed feed, Attachment attachment = Ring{}) {
  Machine machine;
  machine.feed = feed;
  machine.attachment = attachment;
  return equilibrium_parameters(machine);
}

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  const std::pair<Model, std::string> ring_models[] = {
      {Model::straight, "straight"},    {Model::wrap, "wrap"},
      {Model::firmware, "firmware"},    {Model::one_shot, "one_shot"},
      {Model::elastic, "elastic"},      {Model::inextensible, "inextensible"},
      {Model::elastic_3d, "elastic_3d"}};
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    const std::string way = feed == Feed::over_top ? "_over_top" : "_off_bottom";
    for (const auto& [model, name] : ring_models) {
      all.push_back({"ring_" + name + way, classic(feed), model});
    }
    for (const auto& [model, name] : ring_models) {
      if (model == Model::one_shot) continue;  // needs a ring
      all.push_back({"brackets_" + name + way, classic(feed, Brackets{}), model});
    }
    // A beam that rises to the right and yields under the chains, and a hose that pulls.
    for (const auto& [attachment, sled] :
         {std::pair<Attachment, std::string>{Ring{}, "ring"}, {Brackets{}, "brackets"}}) {
      EquilibriumParameters leaning = classic(feed, attachment);
      leaning.motors.right.y_mm += 60.0;
      leaning.motors.left.x_mm -= 25.0;
      leaning.beam_flexibility_mm_per_n = 0.01;
      leaning.side_force_n = 4.0;
      all.push_back({"leaning_" + sled + "_elastic" + way, leaning, Model::elastic});
      all.push_back({"leaning_" + sled + "_elastic_3d" + way, leaning, Model::elastic_3d});
    }
    EquilibriumParameters yielding = classic(feed);
    yielding.beam_flexibility_mm_per_n = 0.01;
    all.push_back({"yielding_ring_wrap" + way, yielding, Model::wrap});
  }
  return all;
}

class KinematicsLaws : public testing::TestWithParam<Kind> {
 protected:
  const EquilibriumParameters& parameters() const { return GetParam().parameters; }
  std::unique_ptr<const Kinematics> make(const EquilibriumParameters& p) const {
    return make_kinematics(p, GetParam().model);
  }
  std::unique_ptr<const Kinematics> kinematics_ =
      make_kinematics(GetParam().parameters, GetParam().model);
};

INSTANTIATE_TEST_SUITE_P(Every, KinematicsLaws, testing::ValuesIn(kinds()),
                         [](const auto& kind) { return kind.param.name; });

Eigen::Vector2d vector(ChainLengths l) { return {l.left_mm, l.right_mm}; }

/// Central difference of order h^6: three central differences, their h^2 and h^4 terms removed.
Eigen::Vector2d difference(const std::function<Eigen::Vector2d(double)>& f, double h) {
  const auto central = [&f](double step) -> Eigen::Vector2d {
    return (f(step) - f(-step)) / (2.0 * step);
  };
  const Eigen::Vector2d wide = (4.0 * central(0.5 * h) - central(h)) / 3.0;
  const Eigen::Vector2d narrow = (4.0 * central(0.25 * h) - central(0.5 * h)) / 3.0;
  return (16.0 * narrow - wide) / 15.0;
}

TEST_P(KinematicsLaws, ForwardUndoesInverse) {
  over_the_bed(kLawSeed + 0, 60, [&](BedPoint p) {
    const PoseResult pose = kinematics_->inverse(p);
    ASSERT_TRUE(pose) << pose.error().sentence();
    EXPECT_EQ(pose->position.x_mm, p.x_mm);
    const PoseResult back = kinematics_->forward(pose->lengths);
    ASSERT_TRUE(back) << back.error().sentence();
    // Rounding of a length, 2e-13 mm, times the worst amplification of 2.4 and a few sums.
    EXPECT_NEAR(back->position.x_mm, p.x_mm, 2e-11);
    EXPECT_NEAR(back->position.y_mm, p.y_mm, 2e-11);
    EXPECT_NEAR(back->sled_rotation_rad, pose->sled_rotation_rad, 1e-12);
  });
}

TEST_P(KinematicsLaws, JacobianIsTheDerivativeOfTheLengths) {
  over_the_bed(kLawSeed + 1, 25, [&](BedPoint p) {
    const auto at = [&](double dx, double dy) {
      return vector(kinematics_->inverse({p.x_mm + dx, p.y_mm + dy}).value().lengths);
    };
    const Eigen::Matrix2d j = kinematics_->jacobian(kinematics_->inverse(p).value());
    // 3e-12 mm of rounding over the narrowest step of 1.5 mm, magnified 1.4 times by the
    // extrapolation.
    constexpr double kTolerance = 4e-12;
    const Eigen::Vector2d by_x = difference([&](double h) { return at(h, 0.0); }, 6.0);
    const Eigen::Vector2d by_y = difference([&](double h) { return at(0.0, h); }, 6.0);
    EXPECT_LE((j.col(0) - by_x).cwiseAbs().maxCoeff(), kTolerance);
    EXPECT_LE((j.col(1) - by_y).cwiseAbs().maxCoeff(), kTolerance);
  });
}

struct Knob {
  Parameter parameter;
  const char* name;
  double step;  // of the difference, in the parameter's unit
  std::function<double&(EquilibriumParameters&)> of;
};

std::vector<Knob> knobs() {
  using P = EquilibriumParameters;
  const auto motor = [](Side side, double MotorPosition::*axis) {
    return [side, axis](P& p) -> double& { return p.motors[side].*axis; };
  };
  return {
      {Parameter::motor_left_x_mm, "motor_left_x_mm", 4.0, motor(Side::left, &MotorPosition::x_mm)},
      {Parameter::motor_left_y_mm, "motor_left_y_mm", 4.0, motor(Side::left, &MotorPosition::y_mm)},
      {Parameter::motor_right_x_mm, "motor_right_x_mm", 4.0,
       motor(Side::right, &MotorPosition::x_mm)},
      {Parameter::motor_right_y_mm, "motor_right_y_mm", 4.0,
       motor(Side::right, &MotorPosition::y_mm)},
      {Parameter::ring_radius_mm, "ring_radius_mm", 4.0,
       [](P& p) -> double& { return std::get<Ring>(p.attachment).radius_mm; }},
      {Parameter::sprocket_radius_mm, "sprocket_radius_mm", 1.0, &P::sprocket_radius_mm},
      {Parameter::sled_weight_n, "sled_weight_n", 1.0, &P::sled_weight_n},
      {Parameter::chain_weight_n_per_mm, "chain_weight_n_per_mm", 1e-4, &P::chain_weight_n_per_mm},
      {Parameter::chain_compliance_per_n, "chain_compliance_per_n", 1e-6,
       &P::chain_compliance_per_n},
      {Parameter::beam_flexibility_mm_per_n, "beam_flexibility_mm_per_n", 0.002,
       &P::beam_flexibility_mm_per_n},
      {Parameter::side_force_n, "side_force_n", 1.0, &P::side_force_n},
  };
}

TEST_P(KinematicsLaws, SensitivityIsTheDerivativeByEachParameter) {
  // If a range begins at zero, the difference is taken about a parameter inside it.
  EquilibriumParameters base = parameters();
  const bool closed = GetParam().model == Model::straight || GetParam().model == Model::wrap ||
                      GetParam().model == Model::firmware || GetParam().model == Model::one_shot;
  if (!closed) base.beam_flexibility_mm_per_n = std::max(base.beam_flexibility_mm_per_n, 0.004);
  const auto kinematics = make(base);
  const bool ring = std::holds_alternative<Ring>(base.attachment);
  for (const Knob& knob : knobs()) {
    SCOPED_TRACE(knob.name);
    if (knob.parameter == Parameter::ring_radius_mm && !ring) continue;
    // A weightless closed formula has no yielding beam; make_kinematics solves the equilibrium
    // there.
    if (knob.parameter == Parameter::beam_flexibility_mm_per_n && closed &&
        base.beam_flexibility_mm_per_n == 0.0) {
      continue;
    }
    over_the_bed(kLawSeed + 2, 12, [&](BedPoint p) {
      const auto at = [&](double change) {
        EquilibriumParameters changed = base;
        knob.of(changed) += change;
        return vector(make(changed)->inverse(p).value().lengths);
      };
      const Eigen::Vector2d expected = difference(at, knob.step);
      const auto chains = kinematics->by_parameter(kinematics->inverse(p).value(), knob.parameter);
      const Eigen::Vector2d found(chains.left.length_mm.d[0], chains.right.length_mm.d[0]);
      // Rounding of 3e-12 mm over the narrowest step; h^6 of the curve, small against the change
      // itself.
      const double tolerance = 1.5e-11 / knob.step + 1e-7 * expected.cwiseAbs().maxCoeff();
      EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance)
          << "found " << found.transpose() << ", difference " << expected.transpose();
    });
  }
}

TEST_P(KinematicsLaws, MirroredMachineSwapsTheChains) {
  EquilibriumParameters mirrored = parameters();
  mirrored.motors.left = {-parameters().motors.right.x_mm, parameters().motors.right.y_mm};
  mirrored.motors.right = {-parameters().motors.left.x_mm, parameters().motors.left.y_mm};
  mirrored.side_force_n = -parameters().side_force_n;
  const auto mirror = make(mirrored);
  over_the_bed(kLawSeed + 3, 60, [&](BedPoint p) {
    const Pose a = kinematics_->inverse(p).value(), b = mirror->inverse({-p.x_mm, p.y_mm}).value();
    constexpr double kTolerance = 5e-12;  // ten units in the last place of a length
    EXPECT_NEAR(a.lengths.left_mm, b.lengths.right_mm, kTolerance);
    EXPECT_NEAR(a.lengths.right_mm, b.lengths.left_mm, kTolerance);
    EXPECT_NEAR(a.sled_rotation_rad, -b.sled_rotation_rad, 1e-13);
    EXPECT_NEAR(a.chains.left.horizontal_n, b.chains.right.horizontal_n,
                1e-12 * parameters().sled_weight_n);
  });
}

TEST_P(KinematicsLaws, ForcesScaledTogetherLeaveTheLengths) {
  for (const double factor : {0.25, 7.0}) {
    EquilibriumParameters scaled = parameters();
    scaled.sled_weight_n *= factor;
    scaled.chain_weight_n_per_mm *= factor;
    scaled.side_force_n *= factor;
    scaled.chain_compliance_per_n /= factor;
    scaled.beam_flexibility_mm_per_n /= factor;
    const auto other = make(scaled);
    over_the_bed(kLawSeed + 4, 30, [&](BedPoint p) {
      const Pose a = kinematics_->inverse(p).value(), b = other->inverse(p).value();
      EXPECT_LE((vector(a.lengths) - vector(b.lengths)).norm(), 1e-11);  // rounding of the solution
      EXPECT_NEAR(b.chains.left.tension_at_sprocket_n, factor * a.chains.left.tension_at_sprocket_n,
                  1e-11 * b.chains.left.tension_at_sprocket_n);
    });
  }
}

TEST_P(KinematicsLaws, LengthsScaledTogetherScaleTheChains) {
  for (const double factor : {0.5, 3.0}) {
    EquilibriumParameters scaled = parameters();
    for (const Side side : kSides) {
      scaled.motors[side].x_mm *= factor;
      scaled.motors[side].y_mm *= factor;
    }
    scaled.sprocket_radius_mm *= factor;
    if (auto* ring = std::get_if<Ring>(&scaled.attachment)) ring->radius_mm *= factor;
    if (auto* b = std::get_if<Brackets>(&scaled.attachment)) {
      *b = {factor * b->spacing_mm, factor * b->height_mm, factor * b->cg_below_bit_mm};
    }
    scaled.chain_weight_n_per_mm /= factor;
    scaled.beam_flexibility_mm_per_n *= factor;
    scaled.sag_correction /= factor * factor;
    const auto other = make(scaled);
    over_the_bed(kLawSeed + 5, 30, [&](BedPoint p) {
      const Pose a = kinematics_->inverse(p).value();
      const Pose b = other->inverse({factor * p.x_mm, factor * p.y_mm}).value();
      EXPECT_LE((factor * vector(a.lengths) - vector(b.lengths)).norm(), 1e-11 * factor + 1e-11);
      EXPECT_NEAR(a.sled_rotation_rad, b.sled_rotation_rad, 1e-12);
    });
  }
}

// Newton on inverse from anywhere on the bed ends at the unique point with these lengths.
TEST_P(KinematicsLaws, TheSolutionDoesNotDependOnTheStart) {
  testing_support::Random starts(7);
  over_the_bed(kLawSeed + 6, 20, [&](BedPoint target) {
    const Eigen::Vector2d wanted = vector(kinematics_->inverse(target).value().lengths);
    BedPoint p = testing_support::on_the_bed(starts);
    SCOPED_TRACE(testing::Message() << "from (" << p.x_mm << ", " << p.y_mm << ")");
    for (int step = 0; step < 60; ++step) {
      const Pose pose = kinematics_->inverse(p).value();
      const Eigen::Vector2d d =
          kinematics_->jacobian(pose).inverse() * (wanted - vector(pose.lengths));
      // A short step cannot leave the domain between the sprockets.
      const double share = d.norm() > 150.0 ? 150.0 / d.norm() : 1.0;
      p = {p.x_mm + share * d.x(), p.y_mm + share * d.y()};
    }
    EXPECT_NEAR(p.x_mm, target.x_mm, 2e-11);  // as in ForwardUndoesInverse
    EXPECT_NEAR(p.y_mm, target.y_mm, 2e-11);
  });
}

// Lengths are continuous along a straight path: the second difference is the path's step squared
// times the curvature of the lengths, at most 1 / (distance to a sprocket).
TEST_P(KinematicsLaws, LengthsAreContinuousAlongPaths) {
  const bool brackets = std::holds_alternative<Brackets>(parameters().attachment);
  const BedPoint corners[] = {{-1219.2, -609.6}, {1219.2, 609.6}, {-1219.2, 609.6},
                              {1219.2, -609.6},  {0.0, -609.6},   {0.0, 609.6}};
  for (std::size_t path = 0; path + 1 < std::size(corners); ++path) {
    const BedPoint a = corners[path], b = corners[path + 1];
    const int steps = 400;
    const double stride = std::hypot(b.x_mm - a.x_mm, b.y_mm - a.y_mm) / steps;
    const double most =
        (brackets ? 3.0 : 1.0) * stride * stride / 300.0;  // brackets sit 210 mm nearer, and rotate
    Eigen::Vector2d before2, before;
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const BedPoint p{a.x_mm + t * (b.x_mm - a.x_mm), a.y_mm + t * (b.y_mm - a.y_mm)};
      const Eigen::Vector2d now = vector(kinematics_->inverse(p).value().lengths);
      if (i >= 2) {
        ASSERT_LE((now - 2.0 * before + before2).norm(), most) << "path " << path << " step " << i;
      }
      before2 = before;
      before = now;
    }
  }
}

TEST_P(KinematicsLaws, NameImpossiblePoses) {
  const double y = std::max(parameters().motors.left.y_mm, parameters().motors.right.y_mm);
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  const MotorPosition& left = parameters().motors.left;
  const std::pair<BedPoint, PoseReason> impossible[] = {
      {{parameters().motors.right.x_mm + 30.0, 0.0}, PoseReason::outside_verticals},
      {{-1e9, 0.0}, PoseReason::outside_verticals},
      {{0.0, y + 1.0}, PoseReason::above_sprockets},
      {{0.0, 1e9}, PoseReason::above_sprockets},
      {{left.x_mm + 40.0, left.y_mm - 40.0}, PoseReason::link_does_not_fit},
      {{nan, 0.0}, PoseReason::outside_verticals},
      {{0.0, nan}, PoseReason::above_sprockets},
      {{infinity, infinity}, PoseReason::outside_verticals}};
  for (const auto& [p, reason] : impossible) {
    const PoseResult pose = kinematics_->inverse(p);
    EXPECT_TRUE(!pose && pose.error() == reason) << p.x_mm << " " << p.y_mm;
  }
  for (const ChainLengths lengths :
       {ChainLengths{nan, 1500.0}, {1500.0, infinity}, {-5.0, 1500.0}, {10.0, 20.0}}) {
    const PoseResult pose = kinematics_->forward(lengths);
    EXPECT_FALSE(pose) << lengths.left_mm << " " << lengths.right_mm;
  }
}

}  // namespace
}  // namespace chaintrue::model
