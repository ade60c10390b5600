// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/link_priors.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

/// A slip stands beside any number of causes. Odds that a visit bears one, before they are shared
/// among the effects of the catalogue: one reading in a thousand, for each kind of slip.
constexpr double kSlipOddsOfVisit = 0.5 / 34.0;

/// Of whole numbers of links, one is the rule.
double log_share_of_links(double links) { return std::log(0.25) * (std::abs(links) - 1.0); }

/// log(e^a + e^b)
double log_add(double a, double b) {
  return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b)));
}

/// In logarithms: readings much better than usual make every density smaller than any double.
double log_strength_density(double delta) {
  const auto log_normal = [&](double sigma) {
    return -0.5 * std::pow(delta / sigma, 2) - std::log(sigma);
  };
  return log_add(std::log(1.0 - kWideDeltaPrior) + log_normal(kUsualDelta),
                 std::log(kWideDeltaPrior) + log_normal(kWideDelta));
}

}  // namespace

void share_out_links(const Space& space, Rows& rows) {
  std::size_t first = 0;
  while (first < rows.directions.size()) {
    std::size_t last = first;
    double log_sum = 0.0;
    std::vector<double> log_weight;
    for (; last < rows.directions.size(); ++last) {
      const Direction& d = rows.directions[last];
      if (!(d.cause == rows.directions[first].cause)) break;
      log_weight.push_back(
          log_share_of_links(d.values.front()) +
          log_strength_density(space.g.col(static_cast<Eigen::Index>(last)).norm()));
      log_sum = last == first ? log_weight.back() : log_add(log_sum, log_weight.back());
    }
    for (std::size_t k = first; k < last && rows.directions[first].fixed; ++k) {
      Direction& d = rows.directions[k];
      d.log_prior = log_weight[k - first] - log_sum -
                    std::log(static_cast<double>(d.cause.effect->sides.size()));
      if (d.slip) d.log_prior += std::log(kSlipOddsOfVisit * d.visits);
    }
    first = last;
  }
}

}  // namespace chaintrue::grid::diagnosis
