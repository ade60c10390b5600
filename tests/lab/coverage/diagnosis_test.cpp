// SPDX-License-Identifier: GPL-3.0-or-later
// Without a cause every reported p-value is uniform; the place of a cause has its stated
// uncertainty; and proposed measurements make the right answer likelier.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/laws.hpp"
#include "grid/diagnosis/next_measurements.hpp"
#include "tests/support/belt_frame.hpp"
#include "tests/diagnosis/law_sessions.hpp"
#include "tests/lab/coverage/rates.hpp"
#include "tests/support/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using coverage::expect_uniform;
using coverage::Rate;
using coverage::seeds;
using testing_support::session_of;
using testing_support::verdict_alone;

TEST(PValues, AreUniformOnSoundMachines) {
  std::vector<double> remainder, family_wise;
  for (const std::uint64_t seed : seeds(120)) {
    DiagnosisOptions options = verdict_alone();
    options.seed = seed;
    const auto a = analyse(observations_of(session_of({}, 5000 + seed, 6, 4)).value(), options);
    remainder.push_back(left_over(*a).p_value);
    family_wise.push_back(a->family_wise_p);
  }
  expect_uniform(remainder);
  expect_uniform(family_wise);
}

/// Few positions, where noise, anchors and causes have the fewest checks.
TEST(PValues, AreUniformOnSoundBeltMachines) {
  std::vector<double> family_wise;
  Rate tail;
  for (const std::uint64_t seed : seeds(120)) {
    synthetic::BeltsSpec spec;
    spec.columns = spec.rows = 3;
    spec.width_share = 0.6;
    spec.height_share = 0.5;
    spec.noise_mm = 0.2 + 0.01 * static_cast<double>(seed % 100);
    spec.seed = 6000 + seed;
    DiagnosisOptions options = verdict_alone();
    options.seed = seed;
    const auto a = analyse(
        synthetic::simulate_belts(chaintrue::testing_support::stated(), chaintrue::testing_support::truth(), spec)
            .value(),
        options);
    family_wise.push_back(a->family_wise_p);
    tail.add(a->family_wise_p < 0.01);
  }
  expect_uniform(family_wise);
  tail.expect_at_most(0.01);  // names depend on it
}

TEST(PlaceSigma, EqualsTheScatterOfThePlace) {
  for (const auto& [hidden, place, unmodelled_mm] :
       {std::tuple(model::AppliedEffect{"sprocket_eccentricity", "left", {{"amplitude_mm", 2.0}, {"phase_rad", 1.3}}},
                   "phase_rad",
                   0.0),
        std::tuple(model::AppliedEffect{"sprocket_eccentricity", "left", {{"amplitude_mm", 0.7}, {"phase_rad", 3.4}}},
                   "phase_rad",
                   0.8),
        std::tuple(model::AppliedEffect{"angular_kink", "right", {{"slope_mm_per_rad", 12.0}, {"knee_rad", 0.7}}},
                   "knee_rad",
                   0.0)}) {
    SCOPED_TRACE(hidden.effect);
    double square = 0.0, stated = 0.0;
    Rate named;
    for (const std::uint64_t seed : seeds(40)) {
      synthetic::SyntheticSpec spec;
      spec.design.columns = 9;
      spec.design.rows = 5;
      spec.order = synthetic::VisitingOrder::random;
      spec.repeats = 6;
      spec.noise = {.length_mm = 0.2, .position_mm = 0.3};
      spec.stated = StatedNoise{0.2, 0.3, 12.0};
      spec.hidden = {hidden};
      spec.unmodelled_mm = unmodelled_mm;
      // A sigma is valid for machines whose settings have the stated distribution.
      spec.draw_settings = true;
      spec.seed = seed;
      const auto found =
          diagnose(synthetic::generate(model::Machine{}, spec).value().grid, verdict_alone()).value();
      const auto own = std::find_if(found.causes.begin(), found.causes.end(), [&](const Cause& cause) {
        return cause.cause.effect->id == hidden.effect;
      });
      named.add(own != found.causes.end());
      if (own == found.causes.end()) continue;
      const ParameterEstimate& at = own->parameters.back();
      square += std::pow(std::remainder(at.value - hidden.parameters.at(place), 2.0 * std::numbers::pi), 2);
      stated += at.sigma * at.sigma;
    }
    named.expect_at_least(0.8);
    // n draws know a scatter to 1/sqrt(2 n); three of these, and a fifth more, since the phase is no
    // straight line over its sigma: a factor of 1.5 for forty.
    const double factor = std::exp(1.2 * 3.0 / std::sqrt(2.0 * named.found));
    EXPECT_GT(std::sqrt(stated / square), 1.0 / factor);
    EXPECT_LT(std::sqrt(stated / square), factor);
  }
}

double probability_of_step(const std::vector<Law>& laws) {
  double p = 0.0;
  for (const Law& law : laws)
    p += law.of == Coordinate::x && law.enters == Enters::left ? law.probability : 0.0;
  return p;
}

TEST(NextForLaws, RaisesTheProbabilityOfTheTrueLaw) {
  Rate likelier;
  for (const std::uint64_t seed : seeds(40)) {
    const auto step = [](const model::MarkPoint& mark, const auto&) { return mark.x_mm >= 250.0 ? 1.0 : 0.0; };
    MeasuredGrid grid = laws::with_left(session_of({}, 50 + seed), step);
    const Analysis a = laws::analysed(grid);
    const LawsFound found = laws_found(a);
    const std::vector<NextMeasurement> next = next_for_laws(a, found);
    if (next.empty()) continue;
    const model::ReadingModel machine(*grid.machine);
    chaintrue::testing_support::Random random(seed);
    const auto noise = [&random] { return random.normal(); };
    for (const NextMeasurement& one : next) {
      if (!one.mark) continue;
      MeasuredPoint point = grid.points.front();
      point.mark = *one.mark;
      point.order = static_cast<int>(grid.points.size());
      const model::MarkPoint truth{one.mark->x_mm + 0.3 * noise(), one.mark->y_mm + 0.3 * noise()};
      const auto reading = machine.at(model::identity_placement(truth)).value();
      point.lengths = reading.pose.lengths;
      point.lengths->left_mm += step(truth, reading) + 0.2 * noise();
      point.lengths->right_mm += 0.2 * noise();
      grid.points.push_back(point);
    }
    likelier.add(probability_of_step(laws_found(laws::analysed(grid)).laws) > probability_of_step(found.laws));
  }
  likelier.expect_at_least(0.83);  // the noise of the new readings misleads one in six
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
