// SPDX-License-Identifier: GPL-3.0-or-later
/// The cords of V-plotters against 40-digit tables (fixtures/plotter/table.py) and against the
/// equilibrium of two chains.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "model/kinematics.hpp"
#include "model/plotter/plotter_controller.hpp"
#include "model/plotter/plotter_mechanism.hpp"

namespace chaintrue::model::plotter_test {
namespace {

nlohmann::json of_table(const char* key) {
  std::ifstream in(CHAINTRUE_FIXTURES "/plotter/table.json");
  return nlohmann::json::parse(in).at(key);
}

nlohmann::json kinds_of_table() { return of_table("kinds"); }

PlotterMachine machine_of(const nlohmann::json& kind) {
  PlotterMachine machine;
  machine.pin_spacing_mm = kind.at("pin_spacing_mm");
  machine.pin_rise_mm = kind.at("pin_rise_mm");
  machine.motors = kind.at("motors") == "wall" ? MotorPlace::wall : MotorPlace::gondola;
  machine.pulley_radius_mm = kind.at("pulley_radius_mm");
  machine.gondola = {.spacing_mm = kind.at("spacing_mm"),
                     .pen_below_mm = kind.at("pen_below_mm"),
                     .pen_right_mm = kind.at("pen_right_mm"),
                     .mass_below_mm = kind.at("mass_below_mm"),
                     .mass_right_mm = kind.at("mass_right_mm"),
                     .mass_kg = kind.at("mass_kg"),
                     .standoff_mm = kind.at("standoff_mm")};
  machine.cord = {.mass_kg_per_m = kind.at("mass_kg_per_m"),
                  .compliance_per_n = kind.at("compliance_per_n")};
  machine.area = {-0.4 * machine.pin_spacing_mm, 0.4 * machine.pin_spacing_mm, -200.0, -1600.0};
  return machine;
}

TEST(PlotterStatics, LengthsMatchTheTables) {
  int poses = 0;
  for (const nlohmann::json& kind : kinds_of_table()) {
    const PlotterMachine machine = machine_of(kind);
    for (const nlohmann::json& pose : kind.at("poses")) {
      const auto cords = plotter::cords_at(
          plotter::statics_of(machine),
          {pose.at("x_mm"), pose.at("y_mm"), machine.pin_spacing_mm, machine.pin_rise_mm});
      ASSERT_TRUE(cords) << kind.at("name") << pose;
      // As the header states.
      EXPECT_NEAR(cords->left.length_mm.value, std::stod(pose.at("left_mm").get<std::string>()),
                  1e-9)
          << kind.at("name") << pose;
      EXPECT_NEAR(cords->right.length_mm.value, std::stod(pose.at("right_mm").get<std::string>()),
                  1e-9)
          << kind.at("name") << pose;
      EXPECT_NEAR(cords->tilt_rad.value, std::stod(pose.at("tilt_rad").get<std::string>()), 1e-11)
          << kind.at("name") << pose;
      ++poses;
    }
  }
  EXPECT_EQ(poses, 15);
}

TEST(PlotterStatics, PositionsMatchTheTables) {
  for (const nlohmann::json& kind : kinds_of_table()) {
    const auto mechanism = make_plotter_mechanism(machine_of(kind));
    for (const nlohmann::json& pose : kind.at("poses")) {
      const auto found =
          mechanism->locate_by_first({std::stod(pose.at("left_mm").get<std::string>()),
                                      std::stod(pose.at("right_mm").get<std::string>())});
      ASSERT_TRUE(found) << kind.at("name") << pose << found.error().sentence();
      // The lengths' 1e-9 mm where they meet at an angle of a radian.
      EXPECT_NEAR(found->x_mm, pose.at("x_mm").get<double>(), 5e-9) << kind.at("name") << pose;
      EXPECT_NEAR(found->y_mm, pose.at("y_mm").get<double>(), 5e-9) << kind.at("name") << pose;
    }
  }
}

/// Brackets are a body with motors on the wall; both sources of equations agree.
TEST(PlotterStatics, ABodyOnTheWallsMotorsIsASledOnBrackets) {
  EquilibriumParameters sled;
  sled.motors.left = {-700.0, 3.0};
  sled.motors.right = {700.0, -3.0};
  sled.sprocket_radius_mm = 11.0;
  sled.attachment = Brackets{90.0, 30.0, 25.0};
  sled.sled_weight_n = 6.0;
  sled.chain_weight_n_per_mm = 1e-4;
  sled.chain_compliance_per_n = 1e-4;
  plotter::Statics body;
  body.spacing_mm = 90.0;
  body.pen_below_mm = 30.0;
  body.mass_below_mm = 55.0;
  body.weight_n = 6.0;
  body.radius_mm = 11.0;
  body.cord = {{1e-4, 1e-4}, {1e-4, 1e-4}};
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    sled.feed = feed;
    body.feed_sign = feed == Feed::over_top ? 1.0 : -1.0;
    const auto kinematics = make_kinematics(sled);
    for (const BedPoint& p : {BedPoint{0.0, -700.0}, {-420.0, -300.0}, {380.0, -1200.0}}) {
      const auto pose = kinematics->inverse(p);
      const auto cords = plotter::cords_at(body, {p.x_mm, p.y_mm, 1400.0, -6.0});
      ASSERT_TRUE(pose && cords);
      // What both state of their accuracy.
      EXPECT_NEAR(cords->left.length_mm.value, pose->lengths.left_mm, 1e-9);
      EXPECT_NEAR(cords->right.length_mm.value, pose->lengths.right_mm, 1e-9);
      EXPECT_NEAR(cords->tilt_rad.value, pose->sled_rotation_rad, 1e-11);
      const Eigen::Matrix2d jacobian = kinematics->jacobian(*pose);
      for (const std::size_t axis : {0u, 1u}) {
        const auto column = static_cast<Eigen::Index>(axis);
        EXPECT_NEAR(cords->left.length_mm.d[axis], jacobian(0, column), 1e-11);
        EXPECT_NEAR(cords->right.length_mm.d[axis], jacobian(1, column), 1e-11);
      }
    }
  }
}

TEST(PlotterStatics, NamesPosesWithoutEquilibrium) {
  const plotter::Statics mural_bot = plotter::statics_of(mural(1500.0));
  const auto failure = [&](double x, double y) {
    const auto cords = plotter::cords_at(mural_bot, {x, y, 1500.0, 0.0});
    return cords ? std::string("none") : std::string(name(cords.error().reason));
  };
  EXPECT_EQ(failure(0.0, 10.0), "above_the_pins");
  EXPECT_EQ(failure(760.0, -500.0), "outside_the_pins");
  EXPECT_EQ(failure(0.0, -500.0), "none");
  plotter::Statics dragged = mural_bot;
  dragged.side_n = dragged.weight_n + 1.0;
  const auto cords = plotter::cords_at(dragged, {0.0, -500.0, 1500.0, 0.0});
  ASSERT_FALSE(cords);
  EXPECT_EQ(cords.error(), PlotterReason::slack);
  const auto nowhere = make_plotter_mechanism(mural(1500.0))->locate_by_first({200.0, 200.0});
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().reason.name, "cords_do_not_meet");
}

TEST(PlotterController, AMuralPaysOutTheLengthsOfItsFirmware) {
  int poses = 0;
  for (const nlohmann::json& pose : of_table("mural_firmware_1500")) {
    const auto lengths =
        paid_out(PlotterFirmware::mural, mural(1500.0), {pose.at("x_mm"), pose.at("y_mm")});
    ASSERT_TRUE(lengths) << pose;
    // Rounding of sums of 2 m, and a tilt to 1e-14 rad.
    EXPECT_NEAR(lengths->left_mm, std::stod(pose.at("left_mm").get<std::string>()), 1e-10) << pose;
    EXPECT_NEAR(lengths->right_mm, std::stod(pose.at("right_mm").get<std::string>()), 1e-10)
        << pose;
    ++poses;
  }
  EXPECT_EQ(poses, 5);
}

TEST(PlotterController, UsesItsSettings) {
  PlotterMachine set;
  set.zero_mm = {5.0, -3.0};
  set.scale_mm_per_m = {2.0, 0.0};
  const auto lengths = paid_out(PlotterFirmware::marlin, set, {0.0, -800.0});
  ASSERT_TRUE(lengths);
  EXPECT_NEAR(lengths->left_mm, 1000.0 * 1.002 + 5.0, 1e-11);
  EXPECT_NEAR(lengths->right_mm, 1000.0 - 3.0, 1e-11);
  set.pin_rise_mm = 40.0;
  EXPECT_NEAR(paid_out(PlotterFirmware::fluidnc, set, {0.0, -800.0})->right_mm + 3.0,
              std::hypot(600.0, 820.0), 1e-11);
  EXPECT_EQ(paid_out(PlotterFirmware::marlin, set, {0.0, -800.0})->right_mm, 997.0);
  EXPECT_EQ(paid_out(PlotterFirmware::marlin, set, {700.0, -800.0}).error(),
            PlotterReason::outside_the_pins);
  EXPECT_EQ(paid_out(PlotterFirmware::marlin, set, {0.0, 5.0}).error(),
            PlotterReason::above_the_pins);
  EXPECT_THROW((void)paid_out(PlotterFirmware::mural, set, {0.0, -800.0}), std::invalid_argument);
}

TEST(PlotterMachine, RefusesPinsCloserThanTheGondolaIsWide) {
  const auto problems = problems_of(mural(60.0));
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems.front().parameter, "/pin_spacing_mm");
  PlotterMachine inches = mural(1500.0);
  inches.pin_spacing_mm = 1500.0 / 12.7;
  inches.area = {-30.0, 30.0, -20.0, -100.0};
  ASSERT_EQ(problems_of(inches).size(), 1u);
  EXPECT_NE(problems_of(inches).front().expected.find("inches"), std::string::npos);
  EXPECT_THROW((void)make_plotter_mechanism(inches), std::invalid_argument);
}

TEST(PlotterMachine, ChecksEveryRange) {
  PlotterMachine machine = mural(1500.0);
  EXPECT_TRUE(problems_of(machine).empty());
  machine.gondola.mass_kg = std::nan("");
  machine.cord.tooth_mm = 0.0;
  machine.zero_mm.right_mm = 1e6;
  machine.uncertainty.zero_mm = 0.0;
  EXPECT_EQ(problems_of(machine).size(), 4u);
  machine = mural(1500.0);
  std::swap(machine.area.top_mm, machine.area.bottom_mm);
  EXPECT_EQ(problems_of(machine).size(), 1u);
  machine = PlotterMachine{};
  EXPECT_TRUE(problems_of(machine).empty());
  machine.gondola.pen_right_mm = 3.0;
  machine.motors = MotorPlace::gondola;
  EXPECT_EQ(problems_of(machine).size(), 2u);
}

}  // namespace
}  // namespace chaintrue::model::plotter_test
