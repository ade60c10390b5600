// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of plotters' settings agree with their stated sigmas; rates of right verdicts of a map's check.
#include <gtest/gtest.h>

#include <cmath>

#include "grid/plotter/drawing_fit.hpp"
#include "grid/random.hpp"
#include "tests/holes/checked_map.hpp"
#include "tests/lab/coverage/rates.hpp"

namespace chaintrue::grid {
namespace {

using coverage::Rate;
using coverage::seeds;
using coverage::Squares;

TEST(DrawingCoverage, CoversSettingsAndAcceptsSoundOnes) {
  const model::PlotterMachine stated = model::mural(1500.0);
  // Six settings of one drawing go together, worth two.
  Squares settings(2.0);
  Rate off;
  for (const std::uint64_t seed : seeds(60)) {
    Random random(seed, 42);
    const auto measured = [&](const model::PlotterMachine& truth) {
      TestDrawing drawing = planned_drawing({stated, model::PlotterFirmware::mural});
      const auto machine = model::make_plotter_mechanism(truth);
      std::vector<Eigen::Vector2d> pens;
      for (const DrawnCross& cross : drawing.crosses) {
        const auto pen = pen_of_command(drawing.firmware, stated, *machine, cross.commanded);
        pens.emplace_back(pen->x_mm, pen->y_mm);
      }
      for (observation::DrawnMeasure& m : drawing.measures) {
        m.value_mm =
            observation::measure_row(m.kind, pens[m.from], pens[m.to], pens[m.middle]).value_mm +
            0.5 * random.normal();
      }
      return drawing;
    };
    model::PlotterMachine truth = stated;
    truth.pin_spacing_mm += stated.uncertainty.pin_spacing_mm * random.normal();
    truth.pin_rise_mm += stated.uncertainty.pin_rise_mm * random.normal();
    for (const model::Side side : model::kSides) {
      truth.zero_mm[side] += stated.uncertainty.zero_mm * random.normal();
      truth.scale_mm_per_m[side] += stated.uncertainty.scale_mm_per_m * random.normal();
    }
    const auto fit = fit_drawing(measured(truth));
    const auto sound = fit_drawing(measured(stated));
    ASSERT_TRUE(fit && sound) << "seed " << seed;
    const Eigen::VectorXd true_values = model::make_plotter_mechanism(truth)->values();
    double square = 0.0;
    for (std::size_t k = 0; k < fit->settings.size(); ++k) {
      const double error = fit->settings[k].found - true_values[static_cast<Eigen::Index>(k)];
      square += std::pow(error / fit->settings[k].sigma, 2);
    }
    settings.add(2.0 * square / static_cast<double>(fit->settings.size()));
    for (const PlotterSetting& one : sound->settings) off.add(one.is_off);
  }
  settings.expect_unit(2.0 / 16.0);  // the noise is estimated from 18 readings
  off.expect_at_most(0.0045);        // three sigmas of Student's t
}

TEST(MapCheckRates, VerdictsAreRightInNineteenOfTwentyCases) {
  std::vector<testing_support::MeasuredMachine> machines;
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    machines.push_back(testing_support::measured_machine(seed));
  for (const testing_support::MachineChange& change : testing_support::machine_changes()) {
    SCOPED_TRACE(change.name);
    Rate right, named;
    for (const std::uint64_t seed : seeds(1200)) {
      const testing_support::MeasuredMachine& one = machines[seed % machines.size()];
      Random random(seed, 40);
      model::Machine changed = one.truth;
      change.happens(changed, random);
      const auto check = check_map(one.map, testing_support::read_at(one.planned, changed, random));
      ASSERT_TRUE(check) << "seed " << seed;
      right.add(check->verdict == change.verdict);
      named.add(check->hypotheses.front().what == change.what);
    }
    right.expect_at_least(0.95);
    named.expect_at_least(0.95);
  }
}

}  // namespace
}  // namespace chaintrue::grid
