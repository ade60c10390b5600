// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/plotter/plotter_machine.hpp"

#include <fmt/format.h>

#include <cmath>

#include "model/machine_ranges.hpp"

namespace chaintrue::model {
namespace {

void check_gondola(const PlotterMachine& machine, RangeChecks& checks) {
  const Gondola& g = machine.gondola;
  checks.range("/gondola/spacing_mm", g.spacing_mm, 0.0, 1000.0);
  checks.range("/gondola/pen_below_mm", g.pen_below_mm, -500.0, 500.0);
  checks.range("/gondola/pen_right_mm", g.pen_right_mm, -500.0, 500.0);
  checks.range("/gondola/mass_below_mm", g.mass_below_mm, -100.0, 500.0);
  checks.range("/gondola/mass_right_mm", g.mass_right_mm, -500.0, 500.0);
  checks.range("/gondola/mass_kg", g.mass_kg, 0.005, 50.0);
  checks.range("/gondola/standoff_mm", g.standoff_mm, -200.0, 200.0);
  if (!is_point(g)) return;
  if (g.pen_below_mm != 0.0 || g.pen_right_mm != 0.0 || g.mass_below_mm != 0.0 ||
      g.mass_right_mm != 0.0) {
    checks.add("/gondola", "a spacing of 0, and a pen or a mass away from the cords' end",
               "0 for pen and mass if both cords end at the pen; otherwise the spacing of the two "
               "points where the cords hold the gondola");
  }
  if (machine.motors == MotorPlace::gondola) {
    checks.add(
        "/motors", "gondola",
        "wall if both cords end at the pen; otherwise the spacing of the pulleys in the gondola");
  }
}

void check_area(const PlotterMachine& machine, RangeChecks& checks) {
  const DrawingArea& area = machine.area;
  const double reach_mm = 0.5 * machine.pin_spacing_mm;
  const double low_pin_mm = -0.5 * std::abs(machine.pin_rise_mm);
  checks.range("/area/left_mm", area.left_mm, -reach_mm, reach_mm);
  checks.range("/area/right_mm", area.right_mm, -reach_mm, reach_mm);
  checks.range("/area/bottom_mm", area.bottom_mm, -20000.0, low_pin_mm);
  checks.range("/area/top_mm", area.top_mm, -20000.0, low_pin_mm);
  if (!checks.sound()) return;
  if (!(area.left_mm < area.right_mm && area.bottom_mm < area.top_mm)) {
    checks.add("/area",
               fmt::format("x from {} to {}, y from {} to {}", area.left_mm, area.right_mm,
                           area.bottom_mm, area.top_mm),
               "left below right and bottom below top; y is 0 at the pins and negative below them");
  }
}

}  // namespace

std::string_view name(MotorPlace place) { return place == MotorPlace::wall ? "wall" : "gondola"; }

PlotterMachine mural(double pin_spacing_mm) {
  constexpr double kPulleyDiameterMm = 12.69;
  constexpr double kAxlesMm = 85.0;
  constexpr double kMargin = 0.2;
  PlotterMachine machine;
  machine.name = "mural";
  machine.pin_spacing_mm = pin_spacing_mm;
  machine.motors = MotorPlace::gondola;
  machine.pulley_radius_mm = 0.5 * kPulleyDiameterMm;
  // The firmware's Q, the middle between the tangent points of cords at 45 degrees, is q above the
  // line of the axles; its pen is q below Q and its centre of mass 10 mm below the pen.
  machine.gondola = {.spacing_mm = kAxlesMm,
                     .pen_below_mm = 0.0,
                     .pen_right_mm = 0.0,
                     .mass_below_mm = 10.0,
                     .mass_right_mm = 0.0,
                     .mass_kg = 0.55,
                     .standoff_mm = 41.0};
  machine.cord = {.mass_kg_per_m = 0.0, .compliance_per_n = 5e-5, .tooth_mm = 2.0};
  machine.area = {-(0.5 - kMargin) * pin_spacing_mm, (0.5 - kMargin) * pin_spacing_mm,
                  -kMargin * pin_spacing_mm, -pin_spacing_mm};
  return machine;
}

std::vector<MachineProblem> problems_of(const PlotterMachine& machine) {
  RangeChecks checks;
  checks.range("/pin_spacing_mm", machine.pin_spacing_mm, 100.0, 20000.0);
  checks.range("/pin_rise_mm", machine.pin_rise_mm, -2000.0, 2000.0);
  checks.range("/pulley_radius_mm", machine.pulley_radius_mm, 0.0, 200.0);
  checks.range("/cord/mass_kg_per_m", machine.cord.mass_kg_per_m, 0.0, 1.0);
  checks.range("/cord/compliance_per_n", machine.cord.compliance_per_n, 0.0, 0.01);
  checks.range("/cord/tooth_mm", machine.cord.tooth_mm, 0.001, 50.0);
  for (const Side side : kSides) {
    const char* word = side == Side::left ? "left" : "right";
    checks.range(fmt::format("/zero/{}_mm", word), machine.zero_mm[side], -20000.0, 20000.0);
    checks.range(fmt::format("/scale/{}_mm_per_m", word), machine.scale_mm_per_m[side], -500.0,
                 500.0);
  }
  const PlotterUncertainty& sigma = machine.uncertainty;
  checks.range("/uncertainty/pin_spacing_mm", sigma.pin_spacing_mm, 1e-3, 1000.0);
  checks.range("/uncertainty/pin_rise_mm", sigma.pin_rise_mm, 1e-3, 1000.0);
  checks.range("/uncertainty/zero_mm", sigma.zero_mm, 1e-3, 1000.0);
  checks.range("/uncertainty/scale_mm_per_m", sigma.scale_mm_per_m, 1e-3, 100.0);
  check_gondola(machine, checks);
  if (!checks.sound()) return checks.take();
  // With a body as wide as the pins are apart, the cords hang straight down and fix no position.
  if (!(machine.pin_spacing_mm > 1.5 * machine.gondola.spacing_mm)) {
    checks.add("/pin_spacing_mm", machine.pin_spacing_mm,
               fmt::format("more than one and a half times the gondola's spacing of {} mm; was it "
                           "given in inches?",
                           machine.gondola.spacing_mm));
  }
  check_area(machine, checks);
  return checks.take();
}

}  // namespace chaintrue::model
