// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/link_priors.hpp"
#include "grid/containers.hpp"
#include "grid/statistics.hpp"

#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

/// Of whole numbers of links, one is the rule.
double log_share_of_links(double links) { return std::log(0.25) * (std::abs(links) - 1.0); }

/// In logarithms: readings much better than usual make every density smaller than any double.
double log_strength_density(double signal_to_noise) {
  const auto log_normal = [&](double sigma) {
    return -0.5 * std::pow(signal_to_noise / sigma, 2) - std::log(sigma);
  };
  return log_sum(std::log(1.0 - kWideSignalToNoisePrior) + log_normal(kUsualSignalToNoise),
                 std::log(kWideSignalToNoisePrior) + log_normal(kWideSignalToNoise));
}

}  // namespace

void share_out_links(const MarginalisedSystem& marginalised, RegressorSystem& system) {
  std::size_t first = 0;
  while (first < system.regressors.size()) {
    std::size_t last = first;
    double log_all = 0.0;
    std::vector<double> log_weight;
    for (; last < system.regressors.size(); ++last) {
      const Regressor& d = system.regressors[last];
      if (!(d.cause == system.regressors[first].cause)) break;
      log_weight.push_back(log_share_of_links(d.values.front()) +
                           log_strength_density(marginalised.g.col(as_index(last)).norm()));
      log_all = last == first ? log_weight.back() : log_sum(log_all, log_weight.back());
    }
    for (std::size_t k = first; k < last && system.regressors[first].fixed; ++k) {
      Regressor& d = system.regressors[k];
      d.log_prior =
          log_weight[k - first] - log_all - std::log(as_double(d.cause.effect->sides.size()));
      if (d.slip) d.log_prior += std::log(kSlipOddsOfVisit * d.visits);
    }
    first = last;
  }
}

}  // namespace chaintrue::grid::diagnosis
