// SPDX-License-Identifier: GPL-3.0-or-later
/// Effects of V-plotters: each equation by hand, and what is refused. Their laws are those of every
/// mechanism's effects (tests/contracts/mechanism_contract_test.cpp).
#include "model/plotter/plotter_effects.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/plotter/plotter_mechanism.hpp"

namespace chaintrue::model::plotter_effects_test {
namespace {

constexpr ToolPosition kPlace{200.0, -700.0};

std::shared_ptr<const PlotterMechanism> bot() { return make_plotter_mechanism(mural(1500.0)); }

/// What effects add to both lengths of `machine`.
Eigen::Vector2d added(const PlotterMachine& machine, const AppliedEffect& effect,
                      const MechanismVisit& visit = {}) {
  return *added_by(*make_plotter_mechanism(machine), effect, kPlace, visit);
}

TEST(PlotterEffects, StandAtOneStage) {
  for (const effects::Effect* own : plotter::plotter_effects()) {
    EXPECT_NE(own->alter_cords != nullptr, own->add != nullptr) << own->id;
    EXPECT_EQ(own->station == effects::Station::machine, own->alter_cords != nullptr);
  }
}

TEST(PlotterEffects, CordEffectsAgreeWithHandCalculation) {
  PlotterMachine machine = mural(1500.0);
  const Eigen::Vector2d plain = make_plotter_mechanism(machine)->predict(kPlace, {})->lengths_mm;
  const double turn_mm = std::numbers::pi * 12.69;
  // Rounding of sums of 1 m.
  constexpr double kRounding = 1e-11;
  const Eigen::Vector2d waves =
      added(machine, {"spool_eccentricity", "left", {{"amplitude_mm", 0.3}, {"phase_rad", 1.0}}});
  EXPECT_NEAR(waves[0], 0.3 * std::sin(2.0 * std::numbers::pi * plain[0] / turn_mm + 1.0),
              kRounding);
  EXPECT_EQ(waves[1], 0.0);
  const Eigen::Vector2d layers =
      added(machine, {"spool_layers", "both", {{"growth_mm_per_m2", 6.0}}});
  EXPECT_NEAR(layers[0], 3e-6 * plain[0] * plain[0], kRounding);
  EXPECT_NEAR(layers[1], 3e-6 * plain[1] * plain[1], kRounding);
  const MechanismVisit before{9, {}, {}}, after{10, {}, {}};
  const AppliedEffect skip{"tooth_skip", "right", {{"teeth", -2.0}, {"first_visit", 10.0}}};
  EXPECT_EQ(added(machine, skip, before).norm(), 0.0);
  EXPECT_NEAR(added(machine, skip, after)[1], -4.0, kRounding);
  const AppliedEffect shift{"zero_shift", "left", {{"shift_mm", 1.5}, {"first_visit", 10.0}}};
  EXPECT_EQ(added(machine, shift, before).norm(), 0.0);
  EXPECT_NEAR(added(machine, shift, after)[0], 1.5, kRounding);
  EXPECT_NEAR(added(machine, {"drift", "both", {{"rate_mm_per_visit", 0.05}}}, after)[1], 0.5,
              kRounding);
  // A scale counts what effects add as well.
  machine.scale_mm_per_m.left_mm = 10.0;
  EXPECT_NEAR(added(machine, shift, after)[0], 1.515, kRounding);
}

TEST(PlotterEffects, EachMachineEffectEqualsAChangedMachine) {
  const PlotterMachine stated = mural(1500.0);
  const auto lengths_of = [](const PlotterMachine& machine) {
    return make_plotter_mechanism(machine)->predict(kPlace, {})->lengths_mm;
  };
  const auto expect_same = [&](const AppliedEffect& effect, const PlotterMachine& other) {
    SCOPED_TRACE(effect.effect);
    const Eigen::VectorXd with = bot()->with_effects({effect})->predict(kPlace, {})->lengths_mm;
    // The same equations with the same numbers, but for rounding.
    EXPECT_LT((with - lengths_of(other)).norm(), 1e-9);
  };
  PlotterMachine other = stated;
  other.gondola.pen_right_mm += 5.0;
  expect_same({"pen_off_centre", "", {{"offset_mm", 5.0}}}, other);
  other = stated;
  other.gondola.mass_right_mm -= 4.0;
  expect_same({"servo_arm", "", {{"offset_mm", -4.0}}}, other);
  other = stated;
  other.gondola.spacing_mm += 2.0;
  expect_same({"gondola_width", "", {{"offset_mm", 2.0}}}, other);
  other = stated;
  other.gondola.standoff_mm -= 10.0;
  expect_same({"standoff", "", {{"offset_mm", -10.0}}}, other);
  other = stated;
  other.gondola.mass_kg *= 0.6;
  expect_same({"gondola_mass", "", {{"relative", -0.4}}}, other);
  other = stated;
  other.cord.compliance_per_n += 2e-4;
  expect_same({"cord_stretch", "both", {{"compliance_per_n", 2e-4}}}, other);
  other = stated;
  other.cord.mass_kg_per_m += 0.008;
  expect_same({"cord_weight", "both", {{"more_g_per_m", 8.0}}}, other);
}

/// A move down is held up, as if the gondola were lighter by the force.
TEST(PlotterEffects, APenThatRubsCarriesAPartOfAGondolaThatMovesDown) {
  PlotterMachine machine;
  machine.cord.compliance_per_n = 1e-4;
  PlotterMachine lighter = machine;
  lighter.gondola.mass_kg -= 0.2 / 9.80665;
  const AppliedEffect rubs{"pen_friction", "", {{"force_n", 0.2}}};
  const MechanismVisit down{3, {1.0, 1.0}, {}};
  const auto with = make_plotter_mechanism(machine)->with_effects({rubs});
  EXPECT_LT((with->predict(kPlace, down)->lengths_mm -
             make_plotter_mechanism(lighter)->predict(kPlace, down)->lengths_mm)
                .norm(),
            1e-9);
  // Moving right, the right cord pulls against the pen as well: it stretches more, and less of it is
  // counted; the left one pulls less.
  const MechanismVisit right{4, {1.0, -1.0}, {}};
  const Eigen::VectorXd change = *added_by(*make_plotter_mechanism(machine), rubs, kPlace, right);
  EXPECT_LT(change[1], 0.0);
  EXPECT_GT(change[0], 0.0);
}

TEST(PlotterEffects, ReportImpossibleValues) {
  const auto problem_of = [](const PlotterMachine& machine, const AppliedEffect& effect) {
    const auto problems = make_plotter_mechanism(machine)->problems_of_effects({effect});
    return problems.empty() ? std::string() : problems.front().parameter;
  };
  const PlotterMachine point;
  EXPECT_EQ(problem_of(point, {"servo_arm", "", {}}), "/effects/0/effect");
  EXPECT_EQ(problem_of(point, {"spool_eccentricity", "left", {}}), "/effects/0/effect");
  EXPECT_EQ(problem_of(point, {"cord_stretch", "both", {}}), "");
  EXPECT_EQ(problem_of(point, {"cord_stretch", "x", {}}), "/effects/0/side");
  EXPECT_EQ(problem_of(point, {"standoff", "", {{"offset_mm", 1e6}}}),
            "/effects/0/parameters/offset_mm");
  EXPECT_EQ(problem_of(point, {"tooth_skip", "left", {{"teeth", 0.5}}}),
            "/effects/0/parameters/teeth");
}

}  // namespace
}  // namespace chaintrue::model::plotter_effects_test
