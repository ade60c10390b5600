// SPDX-License-Identifier: GPL-3.0-or-later
// Without a cause every reported p-value is uniform.
#include <gtest/gtest.h>

#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/synthetic/simulated_belts.hpp"
#include "tests/diagnosis/law_sessions.hpp"
#include "tests/lab/coverage/rates.hpp"
#include "tests/support/belt_frame.hpp"

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
    const auto a = analyse(synthetic::simulate_belts(chaintrue::testing_support::stated(),
                                                     chaintrue::testing_support::truth(), spec)
                               .value(),
                           options);
    family_wise.push_back(a->family_wise_p);
    tail.add(a->family_wise_p < 0.01);
  }
  expect_uniform(family_wise);
  tail.expect_at_most(0.01);  // names depend on it
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
