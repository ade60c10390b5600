// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of two-chain maps and of plotters' settings agree with their stated sigmas; rates of right
// verdicts of a map's check.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include <cmath>

#include "grid/map/fit.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/plotter/drawing_fit.hpp"
#include "grid/random.hpp"
#include "tests/holes/checked_map.hpp"
#include "tests/lab/coverage/rates.hpp"

namespace chaintrue::grid {
namespace {

using coverage::Rate;
using coverage::seeds;
using coverage::Squares;
using testing_support::usual_spec;

/// Root mean square over the bed of the error of a tool that pays out the lengths of `map` on the true machine, for
/// the best placement of the sheet.
double best_placed_rms_mm(const CompensationMap& map, const model::Machine& truth) {
  constexpr int kAcross = 13;
  constexpr int kUp = 7;
  const model::ReadingModel model(truth);
  const model::Bed bed = testing_support::classic().bed;
  std::vector<double> errors;
  std::vector<double> rigid;
  for (int i = 0; i < kAcross * kUp; ++i) {
    const model::BedPoint wanted{0.9 * bed.width_mm * ((i % kAcross + 0.5) / kAcross - 0.5),
                                 0.9 * bed.height_mm * ((i / kAcross + 0.5) / kUp - 0.5)};
    const auto answer = map.lengths(model::identity_placement(wanted));
    if (!answer) continue;
    const auto reading = model.find(answer->lengths, wanted);
    if (!reading) continue;
    errors.push_back(reading->pose.position.x_mm - wanted.x_mm);
    errors.push_back(reading->pose.position.y_mm - wanted.y_mm);
    rigid.insert(rigid.end(), {1.0, 0.0, -1e-3 * wanted.y_mm, 0.0, 1.0, 1e-3 * wanted.x_mm});
  }
  const auto count = static_cast<Eigen::Index>(errors.size());
  const Eigen::Map<const Eigen::VectorXd> all(errors.data(), count);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> whole(rigid.data(), count, 3);
  const Eigen::VectorXd left = all - whole * whole.colPivHouseholderQr().solve(all);
  return std::sqrt(2.0 * left.squaredNorm() / static_cast<double>(count));
}

TEST(MapCoverage, CoversSettingsAndTheToolsError) {
  // Six settings of one bed go together, worth two; a bed's errors are worth about nine.
  Squares settings(2.0), tool(9.0);
  for (const std::uint64_t seed : seeds(40)) {
    const auto made = synthetic::generate(model::Machine{}, usual_spec(seed)).value();
    const auto map = fit(made.grid);
    ASSERT_TRUE(map) << "seed " << seed;
    double square = 0.0;
    for (const SettingResult& result : map->contents().settings) {
      double truth = result.stated;
      for (const auto& offset : made.answer.offsets) {
        if (offset.setting == result.setting) truth += offset.offset;
      }
      square += std::pow((result.calibrated - truth) / result.sigma, 2);
    }
    settings.add(2.0 * square / static_cast<double>(map->contents().settings.size()));
    const double expected = map->contents().accuracy.expected_tool.rms_mm;
    tool.add(9.0 * std::pow(testing_support::true_tool_rms_mm(*map, made.answer) / expected, 2));
  }
  settings.expect_unit();
  tool.expect_unit(0.2);  // the raster reaches beyond the outermost points
}

TEST(MapCoverage, CoversLengthsOfABendingMachine) {
  const model::Machine classic = testing_support::classic();
  double covered = 0.0, points2 = 0.0, holes2 = 0.0, both2 = 0.0;
  const auto all = seeds(24);
  for (const std::uint64_t seed : all) {
    synthetic::SyntheticSpec spec = usual_spec(seed);
    spec.design.columns = 4;
    spec.design.rows = 3;
    spec.repeats = 0;
    spec.hidden = {{"beam_flex", "", {{"flexibility_mm_per_n", 0.01}}},
                   {"side_pull", "", {{"force_n", 3.0}}}};
    const auto session = synthetic::generate(classic, spec).value();
    const auto cut = synthetic::simulate_holes(
        testing_support::nine_holes(), testing_support::usual_holes(seed), session.answer.machine);
    const auto points = fit(session.grid);
    const auto holes = joint_fit(cut->set);
    const auto both = joint_fit({{"points", session.grid}, {"holes", cut->set}});
    ASSERT_TRUE(points && holes && both) << "seed " << seed;
    const auto square = [&](const CompensationMap& map) {
      return std::pow(best_placed_rms_mm(map, session.answer.machine), 2);
    };
    points2 += square(*points);
    holes2 += square(holes->map);
    both2 += square(both->map);
    const model::ReadingModel truth(session.answer.machine);
    int within = 0, asked = 0;
    for (double x = -1100.0; x <= 1100.0; x += 200.0) {
      for (double y = -500.0; y <= 500.0; y += 200.0) {
        const auto reply = both->map.query({x, y});
        const auto reading = truth.at(session.answer.sheet.to_bed({x, y}));
        if (!reply || !reading) continue;
        for (const model::Side side : model::kSides) {
          within += std::abs(reply->lengths[side] - reading->lengths[side]) < 1.96 * reply->sigma[side];
          ++asked;
        }
      }
    }
    covered += static_cast<double>(within) / asked;
  }
  EXPECT_LT(both2, points2);
  EXPECT_LT(both2, holes2);
  // 95 %; each of 24 beds is one draw of some five independent errors: three of its deviations.
  EXPECT_GT(covered / static_cast<double>(all.size()), 0.90);
}

TEST(DrawingCoverage, CoversSettingsAndAcceptsSoundOnes) {
  const model::PlotterMachine stated = model::mural(1500.0);
  // Six settings of one drawing go together, worth two.
  Squares settings(2.0);
  Rate off;
  for (const std::uint64_t seed : seeds(60)) {
    Random random(seed, 42);
    const auto measured = [&](const model::PlotterMachine& truth) {
      TestDrawing drawing = planned_drawing(stated, model::PlotterFirmware::mural);
      const auto machine = model::make_plotter_mechanism(truth);
      std::vector<Eigen::Vector2d> pens;
      for (const DrawnCross& cross : drawing.crosses) {
        const auto pen = pen_of_command(drawing.firmware, stated, *machine, cross.commanded);
        pens.emplace_back(pen->x_mm, pen->y_mm);
      }
      for (observation::DrawnMeasure& m : drawing.measures) {
        m.value_mm = observation::measured_between(m.kind, pens[m.from], pens[m.to], pens[m.middle]) +
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
