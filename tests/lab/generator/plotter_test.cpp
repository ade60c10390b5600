// SPDX-License-Identifier: GPL-3.0-or-later
// A second implementation of V-plotters against the product: the lowest pose of a gondola on stiff
// cords, and a pen on cords of links.
#include <gtest/gtest.h>

#include "generator/hidden/plotter.hpp"
#include "model/plotter/plotter_mechanism.hpp"

namespace chaintrue::generator {
namespace {

constexpr double kGravity = 9.80665;

/// The hidden one of a machine; over the top.
HiddenPlotter hidden_of(const model::PlotterMachine& machine) {
  const model::Gondola& g = machine.gondola;
  return {machine.pin_spacing_mm,
          machine.pin_rise_mm,
          machine.pulley_radius_mm,
          machine.motors == model::MotorPlace::gondola,
          g.spacing_mm,
          g.pen_below_mm,
          g.pen_right_mm,
          g.mass_below_mm,
          g.mass_right_mm,
          g.standoff_mm,
          g.mass_kg * kGravity,
          machine.cord.mass_kg_per_m * 1e-3 * kGravity,
          machine.cord.compliance_per_n};
}

void expect_lowest(const model::PlotterMachine& machine) {
  const auto mechanism = model::make_plotter_mechanism(machine);
  const model::DrawingArea& area = machine.area;
  for (const double across : {0.05, 0.5, 0.9}) {
    for (const double up : {0.1, 0.85}) {
      const double x = area.left_mm + across * (area.right_mm - area.left_mm);
      const double y = area.bottom_mm + up * (area.top_mm - area.bottom_mm);
      const auto at = mechanism->predict({x, y}, {});
      ASSERT_TRUE(at) << x << " " << y << ": " << at.error().sentence();
      const PenAtRest rest = lowest_pose(hidden_of(machine), at->lengths_mm[0], at->lengths_mm[1]);
      // The lowest height fixes the tilt to 1e-8 rad, over 150 mm of gondola.
      EXPECT_NEAR(rest.x_mm, x, 2e-6) << x << " " << y << " tilt " << rest.tilt_rad;
      EXPECT_NEAR(rest.y_mm, y, 2e-6) << x << " " << y << " tilt " << rest.tilt_rad;
    }
  }
}

TEST(HiddenPlotter, AMuralHangsInItsLowestPose) {
  model::PlotterMachine machine = model::mural(1500.0);
  machine.cord.compliance_per_n = 0.0;
  machine.pin_rise_mm = -7.0;
  machine.gondola.pen_right_mm = 4.0;
  machine.gondola.pen_below_mm = 20.0;
  machine.gondola.mass_right_mm = -3.0;
  machine.gondola.mass_below_mm = 45.0;
  machine.gondola.standoff_mm = 0.0;
  expect_lowest(machine);
}

TEST(HiddenPlotter, ABodyOnMotorsOnTheWallHangsInItsLowestPose) {
  model::PlotterMachine machine;
  machine.pulley_radius_mm = 12.0;
  machine.pin_rise_mm = 5.0;
  machine.gondola = {.spacing_mm = 60.0, .pen_below_mm = 25.0, .mass_below_mm = 40.0};
  expect_lowest(machine);
}

TEST(HiddenPlotter, ALightPenHangsOnHeavyCordsAsOnLinks) {
  constexpr int kLinks = 2000;
  model::PlotterMachine machine;
  machine.pin_spacing_mm = 2000.0;
  machine.pin_rise_mm = 8.0;
  machine.gondola.mass_kg = 0.12;
  machine.cord = {.mass_kg_per_m = 0.012, .compliance_per_n = 1e-4};
  const auto mechanism = model::make_plotter_mechanism(machine);
  for (const model::ToolPosition& q :
       {model::ToolPosition{0.0, -800.0}, {-600.0, -500.0}, {500.0, -1400.0}}) {
    const auto at = mechanism->predict(q, {});
    ASSERT_TRUE(at) << at.error().sentence();
    const auto links = lengths_of_links(hidden_of(machine), q.x_mm, q.y_mm, kLinks);
    // (w S / T)^2 / 24 of 2.1 m over the square of the links, w S / T up to 0.5: 5e-6 mm.
    EXPECT_NEAR(at->lengths_mm[0], links[0], 1e-5) << q.x_mm;
    EXPECT_NEAR(at->lengths_mm[1], links[1], 1e-5) << q.x_mm;
  }
}

}  // namespace
}  // namespace chaintrue::generator
