// SPDX-License-Identifier: GPL-3.0-or-later
// Where nothing is hidden every chance that is told is uniform: as often below one in ten as one in
// ten, and no more often.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/normal_plot.hpp"
#include "grid/diagnosis/periodogram.hpp"
#include "grid/synthetic/holes.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing_support::session_of;
using testing_support::verdict_alone;

constexpr int kSessions = 120;

/// Kolmogorov's distance from the uniform distribution, times the root of how many there are.
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

struct Chances {
  std::vector<double> left_over, normal_plot, family_wise;
};

/// Nothing hidden, settings stated as well as they are.
const Chances& chances() {
  static const Chances kChances = [] {
    Chances result;
    for (std::uint64_t seed = 1; seed <= kSessions; ++seed) {
      DiagnosisOptions options = verdict_alone();
      options.seed = seed;
      const auto a = analyse(make_session(session_of({}, 5000 + seed, 6, 4)).value(), options);
      result.left_over.push_back(left_over(*a).p_value);
      result.normal_plot.push_back(normal_plot(*a)->p_value);
      result.family_wise.push_back(a->family_wise_p);
    }
    return result;
  }();
  return kChances;
}

TEST(Chances, OfWhatIsLeftOverIsUniform) {
  EXPECT_LT(kolmogorov(chances().left_over), kCritical) << "seeds 5001 to " << 5000 + kSessions;
}

TEST(Chances, OfTheNormalPlotIsUniform) {
  EXPECT_LT(kolmogorov(chances().normal_plot), kCritical) << "seeds 5001 to " << 5000 + kSessions;
}

TEST(Chances, OfTheStrongestEffectIsUniform) {
  EXPECT_LT(kolmogorov(chances().family_wise), kCritical) << "seeds 5001 to " << 5000 + kSessions;
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
