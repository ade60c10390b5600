// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_significance.hpp"

namespace chaintrue::grid::diagnosis {

void test_significance_of_belts(BeltsAnalysis& a) {
  // The length of the residuals is given, so that nothing is known of the noise besides.
  constexpr double kNothingStated = 1e-3;
  // Enough draws for a family-wise 1 in 300; fewer where one draw is long.
  constexpr int kDraws = 4000;
  constexpr int kFewerDraws = 2000;
  constexpr std::size_t kManyUnits = 300;
  Analysis& own = a.analysis;
  BeltsSystem about_anchors =
      system_of(a.belts, {a.alone, {}}, own.candidates.testable, a.sigma_mm);
  turn_to(a.suspects, a.sigma_mm, about_anchors);
  const RegressorSystem& system = about_anchors.system;
  const std::vector<bool>& bad =
      own.comparison.marginalised_systems[own.comparison.best().marginalised].outliers;
  const MarginalisedSystem marginalised = marginalise(system, bad, own.options.steps);
  const SingleScore score(system, marginalised, kNothingStated);
  own.null = draw_null_of_length(score,
                                 marginalised,
                                 system.units.size() > kManyUnits ? kFewerDraws : kDraws,
                                 own.options.seed);
  const Eigen::VectorXd by_cause = score.by_cause(marginalised.e);
  own.score = by_cause.maxCoeff();
  own.family_wise_p = own.null.p_value(own.score);
  own.tested.clear();
  for (std::size_t k = 0; k < score.causes().size(); ++k)
    own.tested.emplace_back(score.causes()[k], by_cause(static_cast<Eigen::Index>(k)));
}

}  // namespace chaintrue::grid::diagnosis
