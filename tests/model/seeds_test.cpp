// SPDX-License-Identifier: GPL-3.0-or-later
// Worked examples and formulas published by the community.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "model/chain_formulas.hpp"
#include "model/controllers/payout.hpp"
#include "model/formula_kinematics.hpp"
#include "tests/support/random.hpp"

namespace chaintrue::model {
namespace {

constexpr double kPi = std::numbers::pi;

/// The chain to a motor in the arccosine form of "Accounting for Motor Sprocket Induced Error"
/// (Maslow forum, 2018).
struct ArccosForm {
  double distance_mm, arc_mm, length_mm;
};
ArccosForm arccos_form(double across_mm, double down_mm, double radius_mm) {
  const double d = std::sqrt(across_mm * across_mm + down_mm * down_mm);
  const double arc = radius_mm * (kPi - std::acos(radius_mm / d) - std::acos(down_mm / d));
  return {d, arc, arc + std::sqrt(d * d - radius_mm * radius_mm)};
}

// Motor at (-1000, 1000), target (-25, 70): 1347.41, 7.85, 1355.22 as printed there, to 0.01 mm.
// The post states no radius; the sprocket's 10.1063 mm would print 7.77. Its digits are those of R
// = 10.2, the firmware's constant at the time (MaslowCNC/Firmware, cnc_ctrl_v1/Kinematics.h of
// 2017).
TEST(Seeds, WrapExampleIsReproducedWithTheFirmwaresRadiusOfItsTime) {
  const ArccosForm example = arccos_form(975.0, 930.0, 10.2);
  EXPECT_NEAR(example.distance_mm, 1347.41, 0.005);
  EXPECT_NEAR(example.arc_mm, 7.85, 0.005);
  EXPECT_NEAR(example.length_mm, 1355.22, 0.005);
  EXPECT_NEAR(arccos_form(975.0, 930.0, 63.5 / (2.0 * kPi)).arc_mm, 7.77, 0.005);
}

TEST(Seeds, WrapFormulasAgree) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  testing_support::Random random(kSeed);
  for (int n = 0; n < 300; ++n) {
    const double u = random.uniform(200.0, 3200.0);
    const double y = random.uniform(100.0, 1900.0);
    const double r = 10.2, d = std::hypot(u, y);
    const auto over = straight_chain(u, y, r, 1.0), off = straight_chain(u, y, r, -1.0);
    // Rounding of an angle near pi/2 in acos: 1e-15 * sqrt, times the radius; 1e-12 of the length.
    EXPECT_NEAR(over.wrap_mm + over.straight_mm, arccos_form(u, y, r).length_mm, 2e-12);
    EXPECT_NEAR(over.wrap_mm, r * (std::asin(y / d) + std::asin(r / d)), 1e-12);
    EXPECT_NEAR(off.wrap_mm, r * (kPi - std::asin(y / d) + std::asin(r / d)), 1e-12);
  }
}

/// The firmware's steps in order, as listed in the community's wiki (2018-08), feeds and tolerances
/// included.
ChainLengths firmware_by_hand(const Machine& machine, BedPoint p, double radius_mm) {
  const ControllerSettings& s = machine.controller.settings;
  const double k = s.chain_sag_correction.value_or(0.0);
  const bool top = machine.feed == Feed::over_top;
  const double x = 0.5 * *s.motor_spacing_mm, y = 0.5 * *s.bed_height_mm + *s.motor_offset_y_mm;
  const double d1 = std::sqrt(std::pow(-x - p.x_mm, 2) + std::pow(y - p.y_mm, 2));
  const double d2 = std::sqrt(std::pow(x - p.x_mm, 2) + std::pow(y - p.y_mm, 2));
  const double sign = top ? 1.0 : -1.0;
  const double a1 = std::asin((y - p.y_mm) / d1) + sign * std::asin(radius_mm / d1);
  const double a2 = std::asin((y - p.y_mm) / d2) + sign * std::asin(radius_mm / d2);
  const double around1 = top ? radius_mm * a1 : radius_mm * (kPi - a1);
  const double around2 = top ? radius_mm * a2 : radius_mm * (kPi - a2);
  double s1 = std::sqrt(d1 * d1 - radius_mm * radius_mm),
         s2 = std::sqrt(d2 * d2 - radius_mm * radius_mm);
  s1 *= 1 + k / 1e12 * std::pow(std::cos(a1), 2) * s1 * s1 *
                std::pow(std::tan(a2) * std::cos(a1) + std::sin(a1), 2);
  s2 *= 1 + k / 1e12 * std::pow(std::cos(a2), 2) * s2 * s2 *
                std::pow(std::tan(a1) * std::cos(a2) + std::sin(a2), 2);
  s1 /= 1 + *s.left_chain_tolerance_percent / 100;
  s2 /= 1 + *s.right_chain_tolerance_percent / 100;
  return {around1 + s1 - *s.rotation_radius_mm, around2 + s2 - *s.rotation_radius_mm};
}

Machine with_settings(Feed feed) {
  Machine machine;
  machine.feed = feed;
  machine.controller.kind = ControllerKind::maslow_classic;
  ControllerSettings& s = machine.controller.settings;
  s.bed_width_mm = 2438.4;
  s.bed_height_mm = 1219.2;
  s.motor_spacing_mm = 3602.71093;
  s.motor_offset_y_mm = 474.34945;
  s.rotation_radius_mm = 138.832;
  s.chain_sag_correction = 28.292794;
  s.left_chain_tolerance_percent = 0.06165;
  s.right_chain_tolerance_percent = 0.22163;
  s.chain_pitch_mm = 6.35;
  s.gear_teeth = 10;
  s.chain_over_sprocket_top = feed == Feed::over_top;
  return machine;
}

// Both feeds and both definitions of the pitch radius: pitch * teeth / (2 pi), and the pins'
// circle.
TEST(Seeds, FirmwaresChainOfFormulasStepByStep) {
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    Machine machine = with_settings(feed);
    for (const double radius_mm : {63.5 / (2.0 * kPi), 6.35 / (2.0 * std::sin(kPi / 10.0))}) {
      if (radius_mm > 10.2) {
        // The settings cannot represent the pins' circle; the stated machine can.
        machine.controller.settings.chain_pitch_mm.reset();
        machine.controller.settings.gear_teeth.reset();
        machine.sprocket.radius_mm = radius_mm;
      }
      const auto controller = make_controller_kinematics(machine);
      for (const BedPoint p :
           {BedPoint{0.0, 0.0}, {-1219.2, -609.6}, {1219.2, 609.6}, {-400.0, 300.0}}) {
        const ChainLengths expected = firmware_by_hand(machine, p, radius_mm);
        const auto lengths = controller->lengths(p);
        ASSERT_TRUE(lengths);
        EXPECT_NEAR(lengths->left_mm, expected.left_mm, 2e-12);  // rounding of a length
        EXPECT_NEAR(lengths->right_mm, expected.right_mm, 2e-12);
        const auto command = controller->command(*lengths);
        ASSERT_TRUE(command);
        EXPECT_NEAR(command->x_mm, p.x_mm, 1e-9);  // as stated in payout.hpp
        EXPECT_NEAR(command->y_mm, p.y_mm, 1e-9);
      }
    }
  }
}

// k = 1e12 (lambda/m)^2 / 24 makes the parabola the catenary's first term. The error of the
// formula, from the chains' own weight in the tension and the ring, is 0.31 mm where a chain hangs
// deepest and under a micrometre high up.
TEST(Seeds, SagFactorHasTheCatenarysClosedForm) {
  const EquilibriumParameters m = equilibrium_parameters(Machine{});
  EXPECT_NEAR(m.sag_correction, 6.069, 0.0005);
  EXPECT_NEAR(m.sag_correction, 1e12 * std::pow(0.14e-3 / 11.6, 2) / 24.0, 1e-12);
  const auto firmware = make_kinematics(m, Model::firmware),
             catenary = make_kinematics(m, Model::inextensible);
  const auto wrap = make_kinematics(m, Model::wrap);
  const auto difference = [&](const Kinematics& a, const Kinematics& b, BedPoint p) {
    const ChainLengths u = a.inverse(p)->lengths, v = b.inverse(p)->lengths;
    return std::max(std::abs(u.left_mm - v.left_mm), std::abs(u.right_mm - v.right_mm));
  };
  EXPECT_NEAR(difference(*firmware, *catenary, {-1219.2, -609.6}), 0.312, 0.001);
  EXPECT_NEAR(difference(*firmware, *wrap, {-1219.2, -609.6}), 4.8, 0.5);
  EXPECT_LT(difference(*firmware, *catenary, {0.0, 500.0}), 1e-3);
}

TEST(Controllers, BeamTiltTurnsTheMotorsAboutTheirMiddle) {
  Machine machine = with_settings(Feed::over_top);
  machine.controller.settings.top_beam_tilt_deg = 0.5;
  machine.controller.settings.chain_sag_correction = 0.0;
  machine.controller.settings.left_chain_tolerance_percent = 0.0;
  machine.controller.settings.right_chain_tolerance_percent = 0.0;
  const double half = 0.5 * 3602.71093, y = 609.6 + 474.34945, t = 0.5 * kPi / 180.0,
               r = 63.5 / (2.0 * kPi);
  const BedPoint p{200.0, -100.0};
  const auto expected = [&](double side) {
    const double mx = side * half * std::cos(t), my = y + side * half * std::sin(t);
    return arccos_form(std::abs(mx - p.x_mm), my - p.y_mm, r).length_mm - 138.832;
  };
  const ChainLengths lengths = make_controller_kinematics(machine)->lengths(p).value();
  EXPECT_NEAR(lengths.left_mm, expected(-1.0), 2e-12);  // rounding
  EXPECT_NEAR(lengths.right_mm, expected(1.0), 2e-12);
}

TEST(Controllers, MissingSettingsComeFromTheMachine) {
  Machine machine;
  machine.chain_zero = {3.0, -2.0};
  const BedPoint p{-700.0, 250.0};
  const EquilibriumParameters m = equilibrium_parameters(machine);
  const auto lengths = [&](ControllerKind kind) {
    machine.controller.kind = kind;
    return make_controller_kinematics(machine)->lengths(p).value();
  };
  const auto model = [&](Model which) { return make_kinematics(m, which)->inverse(p)->lengths; };
  EXPECT_EQ(lengths(ControllerKind::maslow_classic).left_mm, model(Model::firmware).left_mm);
  EXPECT_EQ(lengths(ControllerKind::holey).right_mm, model(Model::one_shot).right_mm);
  EXPECT_EQ(lengths(ControllerKind::fluidnc_wallplotter).left_mm, model(Model::straight).left_mm);
  // The ideal controller includes the machine's own zeros.
  EXPECT_EQ(lengths(ControllerKind::ideal).left_mm, model(Model::elastic).left_mm + 3.0);
  EXPECT_EQ(lengths(ControllerKind::ideal).right_mm, model(Model::elastic).right_mm - 2.0);
}

// The later firmware's steps: tensions of straight chains, a catenary, the mean stretch subtracted.
TEST(Controllers, HoleyStepByStep) {
  Machine machine = with_settings(Feed::over_top);
  machine.controller.kind = ControllerKind::holey;
  ControllerSettings& s = machine.controller.settings;
  s.sled_weight_n = 97.9;
  s.chain_elongation_per_n = 8.1e-6;
  const double x = 0.5 * *s.motor_spacing_mm, y = 609.6 + *s.motor_offset_y_mm,
               r = 63.5 / (2.0 * kPi);
  const double w = 0.14e-3 * 9.80665;
  const BedPoint p{-600.0, -400.0};
  const double d1 = std::hypot(x + p.x_mm, y - p.y_mm), d2 = std::hypot(x - p.x_mm, y - p.y_mm);
  const double a1 = std::asin((y - p.y_mm) / d1) + std::asin(r / d1),
               a2 = std::asin((y - p.y_mm) / d2) + std::asin(r / d2);
  const double s1 = std::sqrt(d1 * d1 - r * r), s2 = std::sqrt(d2 * d2 - r * r);
  const double total = 97.9 + 0.5 * w * (s1 + s2);
  const double t1 = total * std::cos(a2) / std::sin(a1 + a2),
               t2 = total * std::cos(a1) / std::sin(a1 + a2);
  const double c = t1 * std::cos(a1) / w;
  const auto chain = [&](double straight, double a, double tension, double tolerance) {
    const double h = straight * std::cos(a), v = straight * std::sin(a);
    const double length = std::sqrt(std::pow(2 * c * std::sinh(h / (2 * c)), 2) + v * v);
    return r * a + length / (1 + tolerance / 100) / (1 + tension * 8.1e-6) - *s.rotation_radius_mm;
  };
  const ChainLengths lengths = make_controller_kinematics(machine)->lengths(p).value();
  EXPECT_NEAR(lengths.left_mm, chain(s1, a1, t1, 0.06165),
              5e-12);  // rounding of sinh at a tenth of a radian
  EXPECT_NEAR(lengths.right_mm, chain(s2, a2, t2, 0.22163), 5e-12);
}

TEST(Controllers, NameUnreachableCommands) {
  Machine machine = with_settings(Feed::over_top);
  const auto controller = make_controller_kinematics(machine);
  EXPECT_EQ(controller->lengths({0.0, 1200.0}).error(), PoseReason::above_sprockets);
  EXPECT_EQ(controller->lengths({5000.0, 0.0}).error(), PoseReason::outside_verticals);
  EXPECT_EQ(controller->command({200.0, 200.0}).error(), PoseReason::too_short);
}

TEST(Controllers, BracketsHaveNoOneShotFormula) {
  Machine machine;
  machine.attachment = Brackets{};
  machine.controller.kind = ControllerKind::holey;
  EXPECT_THROW(std::ignore = make_controller_kinematics(machine), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::model
