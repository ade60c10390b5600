// SPDX-License-Identifier: GPL-3.0-or-later
// Without a cause every reported p-value is uniform: below one in ten in one case of ten.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/normal_plot.hpp"
#include "grid/diagnosis/periodogram.hpp"
#include "grid/synthetic/holes.hpp"
#include "grid/synthetic/simulated_belts.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing_support::session_of;
using testing_support::verdict_alone;

/// Sessions with nothing hidden; with CHAINTRUE_LONG set in the environment three times as many.
std::uint64_t null_sessions() { return std::getenv("CHAINTRUE_LONG") != nullptr ? 120 : 40; }

/// Kolmogorov's distance from the uniform distribution, times the square root of the number of
/// values.
double kolmogorov(std::vector<double> p) {
  std::sort(p.begin(), p.end());
  const auto n = static_cast<double>(p.size());
  double most = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto k = static_cast<double>(i);
    most = std::max({most, p[i] - k / n, (k + 1.0) / n - p[i]});
  }
  return most * std::sqrt(n);
}

/// 1 in 1000 for uniform values (N. Smirnov, Ann. Math. Stat. 19 (1948), 279).
constexpr double kCritical = 1.95;

/// No cause, and settings with their stated uncertainties.
TEST(Chances, AreUniformWhereNothingIsHidden) {
  std::vector<double> left_over_chance, normal_plot_chance, family_wise_chance;
  for (std::uint64_t seed = 1; seed <= null_sessions(); ++seed) {
    DiagnosisOptions options = verdict_alone();
    options.seed = seed;
    const auto a = analyse(observations_of(session_of({}, 5000 + seed, 6, 4)).value(), options);
    left_over_chance.push_back(left_over(*a).p_value);
    normal_plot_chance.push_back(normal_plot(*a)->p_value);
    family_wise_chance.push_back(a->family_wise_p);
  }
  SCOPED_TRACE(testing::Message() << "seeds 5001 to " << 5000 + null_sessions());
  EXPECT_LT(kolmogorov(left_over_chance), kCritical) << "of what is left over";
  EXPECT_LT(kolmogorov(normal_plot_chance), kCritical) << "of the normal plot";
  EXPECT_LT(kolmogorov(family_wise_chance), kCritical) << "of the strongest effect";
}

/// Few positions, where noise, anchors and causes have the fewest checks; stated anchors with
/// errors of about 100 mm.
TEST(Chances, AreUniformWhereNothingIsHiddenInFourBelts) {
  model::BeltMachine stated;
  stated.anchors = {
      {-20.0, 2050.0, 100.0}, {2910.0, 2070.0, 56.0}, {0.0, 0.0, 34.0}, {2950.0, 0.0, 78.0}};
  stated.anchors_known = true;
  model::BeltMachine truth = stated;
  truth.anchors.tl.x_mm += 14.0;
  truth.anchors.br.x_mm -= 11.0;
  std::vector<double> family_wise_chance;
  for (std::uint64_t seed = 1; seed <= null_sessions(); ++seed) {
    synthetic::BeltsSpec spec;
    spec.columns = spec.rows = 3;
    spec.width_share = 0.6;
    spec.height_share = 0.5;
    spec.noise_mm = 0.2 + 0.01 * static_cast<double>(seed);
    spec.seed = 6000 + seed;
    DiagnosisOptions options = verdict_alone();
    options.seed = seed;
    const auto a = analyse(synthetic::simulate_belts(stated, truth, spec).value(), options);
    family_wise_chance.push_back(a->analysis.family_wise_p);
  }
  SCOPED_TRACE(testing::Message() << "seeds 6001 to " << 6000 + null_sessions());
  EXPECT_LT(kolmogorov(family_wise_chance), kCritical) << "of the strongest cause";
  // Names depend on the tail: one of 100 is expected, and more than 3 of 40 or 5 of 120 in 1 run of 720 at most.
  EXPECT_LE(std::count_if(family_wise_chance.begin(),
                          family_wise_chance.end(),
                          [](double p) { return p < 0.01; }),
            null_sessions() == 40 ? 3 : 5);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
