// SPDX-License-Identifier: GPL-3.0-or-later
/// Settings from simulated test drawings: a mural whose zero is 23 mm off, machines of each kind, and
/// drawings with a slip in what was measured.
#include "grid/plotter/drawing_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "grid/synthetic/random.hpp"

namespace chaintrue::grid::plotter_test {
namespace {

using model::PlotterFirmware;
using model::PlotterMachine;
using observation::DrawnMeasure;
using Reason = DrawingFailure::Reason;

/// What a person measures on the page that `truth` draws with a controller that holds `stated`.
TestDrawing measured(const PlotterMachine& stated,
                     PlotterFirmware firmware,
                     const PlotterMachine& truth,
                     double noise_mm,
                     std::uint64_t seed) {
  TestDrawing drawing = planned_drawing(stated, firmware);
  const auto machine = model::make_plotter_mechanism(truth);
  std::vector<Eigen::Vector2d> pens;
  for (const DrawnCross& cross : drawing.crosses) {
    const auto pen = pen_of_command(firmware, stated, *machine, cross.commanded);
    EXPECT_TRUE(pen) << cross.name;
    pens.emplace_back(pen->x_mm, pen->y_mm);
  }
  synthetic::Random random(seed, 41);
  for (DrawnMeasure& m : drawing.measures) {
    m.value_mm = observation::measured_between(m.kind, pens[m.from], pens[m.to], pens[m.middle]) +
                 noise_mm * random.normal();
  }
  return drawing;
}

double largest_bow(const TestDrawing& drawing,
                   const std::vector<FittedMeasure>& measures,
                   double FittedMeasure::*value) {
  double most = 0.0;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    if (drawing.measures[i].kind == DrawnMeasure::Kind::bow)
      most = std::max(most, std::abs(measures[i].*value));
  }
  return most;
}

/// The bows of the page that `truth` draws with what `fit` has typed in.
double bow_of_next_page(const TestDrawing& drawing,
                        const DrawingFit& fit,
                        const PlotterMachine& truth) {
  const auto machine = model::make_plotter_mechanism(truth);
  double most = 0.0;
  for (const DrawnMeasure& m : drawing.measures) {
    if (m.kind != DrawnMeasure::Kind::bow) continue;
    std::vector<Eigen::Vector2d> pens;
    for (const std::size_t cross : {m.from, m.to, m.middle}) {
      const auto pen =
          pen_of_command(drawing.firmware, fit.to_set, *machine, drawing.crosses[cross].commanded);
      EXPECT_TRUE(pen);
      pens.emplace_back(pen->x_mm, pen->y_mm);
    }
    most =
        std::max(most, std::abs(observation::measured_between(m.kind, pens[0], pens[1], pens[2])));
  }
  return most;
}

PlotterMachine mural_with_zero_off() {
  PlotterMachine truth = model::mural(1500.0);
  truth.zero_mm = {23.0, 23.0};
  return truth;
}

// nikivanov/mural, pull request 43: a zero of 40 mm in place of 17 mm bowed lines by 14 mm.
TEST(DrawingFit, AMuralWithItsZero23MmOffDrawsStraightLinesNext) {
  const PlotterMachine stated = model::mural(1500.0);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TestDrawing drawing =
        measured(stated, PlotterFirmware::mural, mural_with_zero_off(), 0.5, seed);
    const auto fit = fit_drawing(drawing);
    ASSERT_TRUE(fit) << "seed " << seed << ": " << fit.error().sentence();
    EXPECT_GT(largest_bow(drawing, fit->measures, &FittedMeasure::measured_mm), 8.0);
    EXPECT_LT(bow_of_next_page(drawing, *fit, mural_with_zero_off()), 1.0) << "seed " << seed;
    EXPECT_LT(largest_bow(drawing, fit->measures, &FittedMeasure::after_mm), 1.0)
        << "seed " << seed;
    const PlotterSetting& zero = fit->settings[model::kZeroLeft];
    EXPECT_EQ(zero.name, "zero_left_mm");
    EXPECT_TRUE(zero.is_off) << "seed " << seed;
    // Five of its own sigmas: one seed in 90 000 of twenty.
    EXPECT_NEAR(zero.found, 23.0, 5.0 * zero.sigma) << "seed " << seed;
  }
}

/// Settings of each kind within what is said of them: chi-square of six parameters.
TEST(DrawingFit, SigmasAreThoseOfTheErrors) {
  constexpr int kSets = 60;
  PlotterMachine point;
  point.cord.compliance_per_n = 2e-5;
  for (const auto& [stated, firmware] : {std::pair{model::mural(1500.0), PlotterFirmware::mural},
                                         std::pair{point, PlotterFirmware::fluidnc}}) {
    double square = 0.0, settings = 0.0;
    for (int seed = 1; seed <= kSets; ++seed) {
      synthetic::Random random(static_cast<std::uint64_t>(seed), 42);
      PlotterMachine truth = stated;
      const model::PlotterUncertainty& sigma = stated.uncertainty;
      truth.pin_spacing_mm += sigma.pin_spacing_mm * random.normal();
      truth.pin_rise_mm += sigma.pin_rise_mm * random.normal();
      for (const model::Side side : model::kSides) {
        truth.zero_mm[side] += sigma.zero_mm * random.normal();
        truth.scale_mm_per_m[side] += sigma.scale_mm_per_m * random.normal();
      }
      const auto fit =
          fit_drawing(measured(stated, firmware, truth, 0.5, static_cast<std::uint64_t>(seed)));
      ASSERT_TRUE(fit) << stated.name << " seed " << seed << ": " << fit.error().sentence();
      const Eigen::VectorXd true_values = model::make_plotter_mechanism(truth)->values();
      for (std::size_t k = 0; k < fit->settings.size(); ++k) {
        const double error = fit->settings[k].found - true_values[static_cast<Eigen::Index>(k)];
        square += error * error / (fit->settings[k].sigma * fit->settings[k].sigma);
        ++settings;
      }
    }
    // A mean square of 1; settings of one drawing go together, so that 360 are worth 120 at least, and
    // the noise is found from 18 readings: four sigmas of both.
    EXPECT_NEAR(square / settings, 1.0, 4.0 * std::sqrt(2.0 / 120.0) + 2.0 / 16.0) << stated.name;
  }
}

TEST(DrawingFit, ASoundMachineHasNothingOff) {
  int off = 0;
  constexpr int kSets = 60;
  for (int seed = 1; seed <= kSets; ++seed) {
    const PlotterMachine stated = model::mural(1400.0);
    const auto fit = fit_drawing(
        measured(stated, PlotterFirmware::mural, stated, 0.5, static_cast<std::uint64_t>(seed)));
    ASSERT_TRUE(fit) << "seed " << seed;
    for (const PlotterSetting& one : fit->settings) off += one.is_off ? 1 : 0;
  }
  // Each at 0.0045 (Student's t, three sigmas, 18 readings): 1.6 of 360; seven once in a thousand.
  EXPECT_LE(off, 6) << "seeds 1 to " << kSets;
}

TestDrawing slipped(const std::function<void(TestDrawing&)>& slip) {
  TestDrawing drawing =
      measured(model::mural(1500.0), PlotterFirmware::mural, mural_with_zero_off(), 0.5, 3);
  slip(drawing);
  return drawing;
}

void scale_all(TestDrawing& drawing, double factor) {
  for (DrawnMeasure& m : drawing.measures) m.value_mm *= factor;
}

TEST(DrawingFit, SlipsAreNamedAndNothingIsFound) {
  const auto reason_of = [](const std::function<void(TestDrawing&)>& slip) {
    const auto fit = fit_drawing(slipped(slip));
    EXPECT_FALSE(fit);
    return fit ? Reason::not_converged : fit.error().reason;
  };
  EXPECT_EQ(reason_of([](TestDrawing& d) { scale_all(d, 1.0 / 25.4); }), Reason::inches);
  EXPECT_EQ(reason_of([](TestDrawing& d) { scale_all(d, 0.5); }), Reason::scaled_when_printed);
  EXPECT_EQ(reason_of([](TestDrawing& d) { scale_all(d, 0.96); }), Reason::scaled_when_printed);
  EXPECT_EQ(
      reason_of([](TestDrawing& d) { std::swap(d.measures[0].value_mm, d.measures[6].value_mm); }),
      Reason::rows_exchanged);
  EXPECT_EQ(reason_of([](TestDrawing& d) { d.measures[18].value_mm = 900.0; }),
            Reason::bow_is_a_length);
  EXPECT_EQ(reason_of([](TestDrawing& d) { d.measures.resize(8); }), Reason::too_few);
  EXPECT_EQ(reason_of([](TestDrawing& d) { d.crosses[4].commanded.y_mm = 50.0; }),
            Reason::cross_out_of_reach);
  EXPECT_EQ(reason_of([](TestDrawing& d) {
              for (std::size_t i = 0; i < d.measures.size(); ++i)
                d.measures[i].value_mm += i % 3 == 0 ? 25.0 : i % 3 == 1 ? -18.0 : 6.0;
            }),
            Reason::no_settings_fit);
}

TEST(DrawingFit, OneMeasureThatFitsNothingIsSetAside) {
  const TestDrawing drawing = slipped([](TestDrawing& d) { d.measures[9].value_mm += 12.0; });
  const auto fit = fit_drawing(drawing);
  ASSERT_TRUE(fit) << fit.error().sentence();
  for (std::size_t i = 0; i < fit->measures.size(); ++i)
    EXPECT_EQ(fit->measures[i].rejected, i == 9) << words_of(drawing, i);
  EXPECT_LT(bow_of_next_page(drawing, *fit, mural_with_zero_off()), 1.0);
}

}  // namespace
}  // namespace chaintrue::grid::plotter_test
