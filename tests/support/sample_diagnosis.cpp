// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/sample_diagnosis.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"
#include "tests/support/random.hpp"

namespace chaintrue::grid::testing {
namespace {

using diagnosis::CauseId;
using diagnosis::Diagnosis;
using diagnosis::PointPicture;
using model::effects::EffectSide;

constexpr double kElongation = 0.0012;
constexpr double kNoiseMm = 0.15;

CauseId cause(const char* id, EffectSide side = EffectSide::none) {
  return {model::effects::find_effect(id), side};
}

/// The chains' residuals are those of a left chain that is too long; the tool's follow from them.
std::vector<PointPicture> sample_points(const model::Machine& machine) {
  const model::ReadingModel model(machine);
  testing_support::Random random(20240608);
  std::vector<PointPicture> points;
  for (int row = 0; row < 4; ++row) {
    for (int k = 0; k < 7; ++k) {
      const int column = row % 2 == 0 ? k : 6 - k;
      PointPicture point;
      point.index = points.size();
      point.mark = {-1100.0 + 2200.0 * column / 6 + 4.0 * random.normal(),
                    -500.0 + 1000.0 * row / 3 + 4.0 * random.normal()};
      point.order = static_cast<int>(points.size());
      const model::PointReading reading = model.at(model::identity_placement(point.mark)).value();
      point.lengths = reading.lengths;
      const double left_mm = kElongation * (2000.0 - reading.lengths.left_mm);
      point.best_mm = {left_mm, 0.0};
      point.rival_mm = {0.8 * left_mm, 0.15};
      point.chain_after_mm = {kNoiseMm * random.normal(), kNoiseMm * random.normal()};
      point.chain_before_mm = point.best_mm + point.chain_after_mm;
      const Eigen::Matrix2d to_tool = reading.position_jacobian.inverse();
      point.before_mm = to_tool * point.chain_before_mm;
      point.after_mm = to_tool * point.chain_after_mm;
      point.noise_sigma_mm = {0.33, 0.36};
      point.angle_left_rad = reading.pose.chains.left.angle_rad;
      point.angle_right_rad = reading.pose.chains.right.angle_rad;
      point.tension_left_n = reading.pose.chains.left.tension_at_sprocket_n;
      point.tension_right_n = reading.pose.chains.right.tension_at_sprocket_n;
      point.direction_left = row % 2 == 0 ? 1 : -1;
      point.direction_right = -point.direction_left;
      points.push_back(point);
    }
  }
  points[9].bad = true;
  points[9].before_mm += Eigen::Vector2d(3.0, -4.0);
  points[9].after_mm += Eigen::Vector2d(3.0, -4.0);
  return points;
}

diagnosis::HeldOutImprovement sample_improvement() {
  diagnosis::HeldOutImprovement improvement;
  improvement.scheme = "eight blocks of the bed, each predicted by the others";
  improvement.uncalibrated = {3.91, 6.40, 3.42, 4.38};
  improvement.placed = diagnosis::HeldOut{2.20, 3.90, 1.95, 2.44};
  improvement.calibrated = {0.94, 1.71, 0.81, 1.08};
  improvement.extended = {0.31, 0.55, 0.27, 0.36};
  improvement.extended_and_surface = {0.30, 0.53, 0.26, 0.35};
  improvement.surface_only = {0.52, 0.99, 0.44, 0.61};
  improvement.noise_floor_mm = 0.29;
  improvement.folds = 8;
  improvement.folds_agree = 7;
  return improvement;
}

void add_causes(Diagnosis& found) {
  diagnosis::Cause named;
  named.cause = cause("chain_pitch_error", EffectSide::left);
  named.probability = 0.97;
  named.signal_to_noise = 11.3;
  named.share_left = 0.28;
  named.parameters = {{"elongation", kElongation, 0.0001}};
  named.same_as = {{cause("tape_scale", EffectSide::both), {{"scale", -kElongation, 0.0001}}}};
  named.rival = cause("tooth_skip", EffectSide::left);
  named.rival_collinearity = 0.81;
  named.order_assumed = true;
  found.causes = {named};
  found.hypotheses = {{"chain_pitch_error", "left", 0.97},
                      {"tooth_skip", "left", 0.015},
                      {"beam_flex", "", 0.01},
                      {"unknown", "", 0.004},
                      {"nothing", "", 0.001}};
}

void add_follow_up(Diagnosis& found) {
  using diagnosis::MeasurementKind;
  diagnosis::NextMeasurement links{
      MeasurementKind::reading, "", "left", std::nullopt, 0.001, 0.985};
  links.reading = ReadingOf::link_pitch;
  found.next_measurements = {links,
                             {MeasurementKind::revisit,
                              "Visit point 1 again, last of all.",
                              "",
                              found.points[0].mark,
                              0.0,
                              0.99},
                             {MeasurementKind::point,
                              "Measure a new mark.",
                              "",
                              model::MarkPoint{1150.0, 540.0},
                              0.0,
                              0.995}};
}

/// Every point and a column left out; without the third point another cause is named.
diagnosis::Stability sample_stability(const std::vector<PointPicture>& points) {
  diagnosis::Stability stability;
  stability.probability = 0.97;
  for (const PointPicture& point : points) {
    const bool rests = point.index == 2;
    stability.removals.push_back(
        {.index = point.index,
         .verdict = rests ? diagnosis::Verdict::named_set : diagnosis::Verdict::named,
         .causes = {cause(rests ? "beam_flex" : "chain_pitch_error",
                          rests ? EffectSide::none : EffectSide::left)},
         .stands = !rests,
         .probability = rests ? 0.31 : 0.96,
         .support = rests ? 4.3 : -0.2});
  }
  stability.removals.push_back({.what = diagnosis::Removal::What::column,
                                .at_mm = -1100.0,
                                .points = 4,
                                .verdict = diagnosis::Verdict::named,
                                .causes = {cause("chain_pitch_error", EffectSide::left)},
                                .probability = 0.93,
                                .support = 0.9});
  return stability;
}

}  // namespace

Diagnosis sample_diagnosis() {
  Diagnosis found;
  found.verdict = diagnosis::Verdict::named;
  found.sentence =
      "Most likely the left chain is 0.12 % long: 1.2 mm on a metre (probability 97 %).";
  found.what_to_do = {"Measure 100 links of the left chain under load.",
                      "Put the elongation into the machine, or change the chain."};
  found.not_proved = "Another cause outside the catalogue may look the same at these points.";
  found.notes = {"The order of the visits was assumed, row by row."};
  found.left_over = {2.1, "angle_left", 0.31, 0.4};
  found.outliers = {{.index = 9, .shift_mm = {3.0, -4.0}, .distance = 8.4}};
  found.not_testable = {{cause("drift", EffectSide::left), "the points bear no order"}};
  found.bounds = {{cause("beam_flex"), "flexibility_mm_per_n", 0.004},
                  {cause("side_pull"), "force_n", 1.3}};
  found.settings = {{model::Setting::motor_left_x_mm, -1489.2, 3.0, -1490.1, 0.4, false},
                    {model::Setting::chain_zero_right_mm, 0.0, 1.0, 6.2, 0.3, true},
                    {model::Setting::sheet_rotation_rad, 0.0, 0.01, 0.0021, 0.0003, false}};
  found.visiting_order = {{.rows = false, .serpentine = true, .from_right = true, .from_below = false}, 0.998, true};
  found.tool_today = ErrorSummary{4.83, 8.03};
  found.improvement = sample_improvement();
  found.points = sample_points(found.extended_machine);
  add_causes(found);
  add_follow_up(found);
  found.extended_machine.effects = {{"chain_pitch_error", "left", {{"elongation", kElongation}}}};
  found.data_corrections = {{"tape_scale", "x", {{"scale", 0.0004}}}};
  found.noise_factor = 1.04;
  found.family_wise_p = 1e-4;
  found.seed = 18446744073709551615ULL;
  found.grid_name = "workshop grid";
  found.stated_noise = StatedNoise{0.2, 0.3, 12.0};
  found.stability = sample_stability(found.points);
  found.bed_parts = {
      {0.2, "", 8, {"chain_pitch_error", "left", 0.96}, {{"chain_pitch_error", "left", 0.96}}},
      {2.2, "", 8, {"nothing", "", 0.7}, {{"chain_pitch_error", "left", 0.2}}}};
  found.sessions = {{0.0,
                     "monday.json",
                     34,
                     {"chain_pitch_error", "left", 0.97},
                     {{"chain_pitch_error", "left", 0.97}}}};
  found.transferred = diagnosis::Transfer{"a day later",
                                          60,
                                          {3.80, 6.10, 3.40, 4.20},
                                          {0.99, 1.80, 0.85, 1.15},
                                          {0.35, 0.60, 0.30, 0.41},
                                          {0.36, 0.62, 0.31, 0.42},
                                          0.29};
  return found;
}

Diagnosis quiet_diagnosis() {
  Diagnosis found = sample_diagnosis();
  found.verdict = diagnosis::Verdict::nothing_found;
  found.sentence = "Nothing was found: the machine as calibrated explains the points.";
  found.what_to_do.clear();
  found.notes.clear();
  found.causes.clear();
  found.left_over = {};
  found.outliers.clear();
  found.hypotheses = {{"nothing", "", 0.99}, {"unknown", "", 0.01}};
  found.next_measurements.clear();
  found.data_corrections.clear();
  found.extended_machine.effects.clear();
  found.improvement.reset();
  found.transferred.reset();
  found.stability.reset();
  found.bed_parts.clear();
  found.sessions.clear();
  found.stated_noise.reset();
  found.seed = 1;
  for (PointPicture& point : found.points) {
    point.order.reset();
    point.bad = false;
    point.direction_left = point.direction_right = 0;
    point.best_mm.setZero();
    point.rival_mm.setZero();
  }
  return found;
}

}  // namespace chaintrue::grid::testing
