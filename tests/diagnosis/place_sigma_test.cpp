// SPDX-License-Identifier: GPL-3.0-or-later
// Where a cause acts, with its sigma: against the scatter over sessions that differ by their noise and by
// how far each machine is from what was stated of it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>

#include "grid/synthetic/generator.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing_support::verdict_alone;

struct PlacedCause {
  const char* effect;
  const char* place;
  model::AppliedEffect hidden;
  double unmodelled_mm;
};

void PrintTo(const PlacedCause& own, std::ostream* out) {
  *out << own.effect << ", " << own.hidden.parameters.begin()->second << " at "
       << own.hidden.parameters.at(own.place) << ", " << own.unmodelled_mm << " mm unmodelled";
}

class PlaceSigma : public testing::TestWithParam<PlacedCause> {};

MeasuredGrid session_with(const PlacedCause& own, std::uint64_t seed) {
  synthetic::SyntheticSpec spec;
  spec.design.columns = 9;
  spec.design.rows = 5;
  spec.order = synthetic::VisitingOrder::random;
  spec.repeats = 6;
  spec.noise = {.length_mm = 0.2, .position_mm = 0.3};
  spec.stated = StatedNoise{0.2, 0.3, 12.0};
  spec.hidden = {own.hidden};
  spec.unmodelled_mm = own.unmodelled_mm;
  // A sigma says how far a machine may be whose settings are as likely as stated. A large wave lies as
  // surely along its chain as the motors are known, so that settings without error would scatter less.
  spec.draw_settings = true;
  spec.seed = seed;
  return synthetic::generate(model::Machine{}, spec).value().grid;
}

TEST_P(PlaceSigma, IsWhatThePlaceScattersBy) {
  const PlacedCause& own = GetParam();
  // With CHAINTRUE_LONG set in the environment forty.
  const int draws = std::getenv("CHAINTRUE_LONG") != nullptr ? 40 : 12;
  DiagnosisOptions options = verdict_alone();
  options.stability = false;
  const double truth = own.hidden.parameters.at(own.place);
  double square = 0.0;
  double stated = 0.0;
  double pulls = 0.0;
  int named = 0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(draws); ++seed) {
    const auto found = diagnose(session_with(own, seed), options);
    ASSERT_TRUE(found) << "seed " << seed;
    for (const Cause& cause : found->causes) {
      if (cause.cause.effect->id != own.effect) continue;
      for (const ParameterEstimate& parameter : cause.parameters) {
        if (parameter.parameter != own.place) continue;
        const double off = std::remainder(parameter.value - truth, 2.0 * std::numbers::pi);
        square += off * off;
        stated += parameter.sigma * parameter.sigma;
        pulls += std::pow(off / parameter.sigma, 2);
        ++named;
      }
    }
  }
  std::cout << named << " of " << draws << " named: off by " << std::sqrt(square / named)
            << " rad rms, sigma " << std::sqrt(stated / named) << ", rms of off/sigma "
            << std::sqrt(pulls / named) << "\n";
  ASSERT_GE(named, draws / 2);
  // n draws know a scatter to 1/sqrt(2 n); three of these, and a fifth more, since the phase is no straight line over
  // its sigma: a factor of 1.5 for forty.
  const double factor = std::exp(1.2 * 3.0 / std::sqrt(2.0 * named));
  EXPECT_GT(std::sqrt(stated / square), 1.0 / factor);
  EXPECT_LT(std::sqrt(stated / square), factor);
}

INSTANTIATE_TEST_SUITE_P(
    Catalogue,
    PlaceSigma,
    testing::Values(PlacedCause{"sprocket_eccentricity",
                         "phase_rad",
                         {"sprocket_eccentricity", "left", {{"amplitude_mm", 0.5}, {"phase_rad", 1.3}}},
                         0.0},
                    PlacedCause{"sprocket_eccentricity",
                         "phase_rad",
                         {"sprocket_eccentricity", "left", {{"amplitude_mm", 2.0}, {"phase_rad", 1.3}}},
                         0.0},
                    PlacedCause{"sprocket_eccentricity",
                         "phase_rad",
                         {"sprocket_eccentricity", "left", {{"amplitude_mm", 0.7}, {"phase_rad", 3.4}}},
                         0.8}));

}  // namespace
}  // namespace chaintrue::grid::diagnosis
