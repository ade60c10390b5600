// SPDX-License-Identifier: GPL-3.0-or-later
/// Settings from simulated test drawings: a mural whose zero is 23 mm off, machines of each kind, and
/// drawings with a slip in what was measured.
#include "grid/plotter/drawing_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "grid/random.hpp"

namespace chaintrue::grid::plotter_test {
namespace {

using model::PlotterFirmware;
using model::PlotterMachine;
using observation::DrawnMeasure;
using Reason = DrawingFailure::Reason;

/// Measures of the page that `truth` draws with a controller set to `stated`.
TestDrawing measured(const PlotterMachine& stated, PlotterFirmware firmware,
                     const PlotterMachine& truth, double noise_mm, std::uint64_t seed) {
  TestDrawing drawing = planned_drawing({stated, firmware});
  const auto machine = model::make_plotter_mechanism(truth);
  std::vector<Eigen::Vector2d> pens;
  for (const DrawnCross& cross : drawing.crosses) {
    const auto pen = pen_of_command(firmware, stated, *machine, cross.commanded);
    EXPECT_TRUE(pen) << cross.name;
    pens.emplace_back(pen->x_mm, pen->y_mm);
  }
  Random random(seed, 41);
  for (DrawnMeasure& m : drawing.measures) {
    m.value_mm =
        observation::measure_row(m.kind, pens[m.from], pens[m.to], pens[m.middle]).value_mm +
        noise_mm * random.normal();
  }
  return drawing;
}

double largest_bow(const TestDrawing& drawing, const std::vector<FittedMeasure>& measures,
                   double FittedMeasure::*value) {
  double most = 0.0;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    if (drawing.measures[i].kind == DrawnMeasure::Kind::bow)
      most = std::max(most, std::abs(measures[i].*value));
  }
  return most;
}

/// The bows of the page that `truth` draws with the settings of `fit`.
double bow_of_next_page(const TestDrawing& drawing, const DrawingFit& fit,
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
    most = std::max(most,
                    std::abs(observation::measure_row(m.kind, pens[0], pens[1], pens[2]).value_mm));
  }
  return most;
}

PlotterMachine mural_with_zero_off() {
  PlotterMachine truth = model::mural(1500.0);
  truth.zero_mm = {23.0, 23.0};
  return truth;
}

TEST(DrawingFit, FindsAMuralsZeroAndStraightensItsLines) {
  const TestDrawing drawing =
      measured(model::mural(1500.0), PlotterFirmware::mural, mural_with_zero_off(), 0.5, 1);
  const auto fit = fit_drawing(drawing);
  ASSERT_TRUE(fit) << "seed 1: " << fit.error().sentence();
  EXPECT_GT(largest_bow(drawing, fit->measures, &FittedMeasure::measured_mm), 8.0);
  EXPECT_LT(bow_of_next_page(drawing, *fit, mural_with_zero_off()), 1.0) << "seed 1";
  EXPECT_LT(largest_bow(drawing, fit->measures, &FittedMeasure::after_mm), 1.0) << "seed 1";
  const PlotterSetting& zero = fit->settings[model::kZeroLeft];
  EXPECT_EQ(zero.name, "zero_left_mm");
  EXPECT_TRUE(zero.is_off);
  // Four of its own sigmas: one seed in 16 000.
  EXPECT_NEAR(zero.found, 23.0, 4.0 * zero.sigma) << "seed 1";
}

TEST(DrawingFit, ReportsNothingOnASoundMachine) {
  const PlotterMachine stated = model::mural(1400.0);
  const auto fit = fit_drawing(measured(stated, PlotterFirmware::mural, stated, 0.5, 1));
  ASSERT_TRUE(fit) << fit.error().sentence();
  for (const PlotterSetting& one : fit->settings)
    EXPECT_FALSE(one.is_off) << one.name << ", seed 1";
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

TEST(DrawingFit, NamesSlipsWithoutAFit) {
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

PlotterMachine usual_machine(PlotterFirmware firmware) {
  if (firmware == PlotterFirmware::mural) return model::mural(1500.0);
  PlotterMachine machine;
  machine.pin_spacing_mm = 1200.0;
  machine.gondola.mass_kg = 0.3;
  machine.area = {-360.0, 360.0, -300.0, -1020.0};
  return machine;
}

TEST(DrawingFit, SlipsOfAPartAndOfAFewPercentAreNamedOnEveryPlotter) {
  using Slip = std::function<void(DrawnMeasure&, std::size_t)>;
  const auto is_bow = [](const DrawnMeasure& m) { return m.kind == DrawnMeasure::Kind::bow; };
  const std::pair<Slip, Reason> slips[] = {
      {[](DrawnMeasure& m, std::size_t) { m.value_mm *= 0.97; }, Reason::scaled_when_printed},
      {[](DrawnMeasure& m, std::size_t) { m.value_mm *= 1.03; }, Reason::scaled_when_printed},
      {[&](DrawnMeasure& m, std::size_t i) { m.value_mm /= !is_bow(m) && i % 2 == 1 ? 25.4 : 1.0; },
       Reason::inches},
      {[&](DrawnMeasure& m, std::size_t i) { m.value_mm /= !is_bow(m) && i >= 7 ? 25.4 : 1.0; },
       Reason::inches},
      {[&](DrawnMeasure& m, std::size_t) { m.value_mm *= is_bow(m) ? -1.0 : 1.0; },
       Reason::bows_turned}};
  for (const PlotterFirmware firmware : model::kPlotterFirmwares) {
    const PlotterMachine stated = usual_machine(firmware);
    PlotterMachine truth = stated;
    truth.zero_mm = {18.0, 18.0};
    truth.pin_spacing_mm += 3.0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const TestDrawing drawing = measured(stated, firmware, truth, 0.4, seed);
      const auto sound = fit_drawing(drawing);
      EXPECT_TRUE(sound) << name(firmware) << ", seed " << seed << ": " << sound.error().sentence();
      for (const auto& [slip, reason] : slips) {
        TestDrawing spoilt = drawing;
        for (std::size_t i = 0; i < spoilt.measures.size(); ++i) slip(spoilt.measures[i], i);
        const auto fit = fit_drawing(spoilt);
        ASSERT_FALSE(fit) << name(firmware) << ", seed " << seed << ", slip "
                          << static_cast<int>(reason);
        EXPECT_EQ(fit.error().reason, reason)
            << name(firmware) << ", seed " << seed << ": " << fit.error().sentence();
      }
    }
  }
}

TEST(DrawingFit, RejectsAnInconsistentMeasure) {
  const TestDrawing drawing = slipped([](TestDrawing& d) { d.measures[9].value_mm += 12.0; });
  const auto fit = fit_drawing(drawing);
  ASSERT_TRUE(fit) << fit.error().sentence();
  for (std::size_t i = 0; i < fit->measures.size(); ++i)
    EXPECT_EQ(fit->measures[i].rejected, i == 9) << words_of(drawing, i);
  EXPECT_LT(bow_of_next_page(drawing, *fit, mural_with_zero_off()), 1.0);
}

}  // namespace
}  // namespace chaintrue::grid::plotter_test
