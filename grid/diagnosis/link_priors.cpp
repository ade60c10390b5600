// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/link_priors.hpp"

#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

/// Of whole numbers of links, one is the rule.
double share_of_links(double links) { return std::pow(0.25, std::abs(links) - 1.0); }

double strength_density(double signal_to_noise) {
  const auto normal = [&](double sigma) {
    return std::exp(-0.5 * std::pow(signal_to_noise / sigma, 2)) / sigma;
  };
  return (1.0 - kWideSignalToNoisePrior) * normal(kUsualSignalToNoise) +
         kWideSignalToNoisePrior * normal(kWideSignalToNoise);
}

}  // namespace

void share_out_links(const MarginalisedSystem& marginalised, LinearisedSystem& system) {
  std::size_t first = 0;
  while (first < system.regressors.size()) {
    std::size_t last = first;
    double sum = 0.0;
    std::vector<double> weight;
    for (; last < system.regressors.size(); ++last) {
      const Regressor& d = system.regressors[last];
      if (!(d.cause == system.regressors[first].cause)) break;
      weight.push_back(
          share_of_links(d.values.front()) *
          strength_density(marginalised.g.col(static_cast<Eigen::Index>(last)).norm()));
      sum += weight.back();
    }
    for (std::size_t k = first; k < last && system.regressors[first].fixed; ++k) {
      Regressor& d = system.regressors[k];
      d.log_prior = std::log(weight[k - first] / sum) -
                    std::log(static_cast<double>(d.cause.effect->sides.size()));
      if (d.slip) d.log_prior += std::log(kSlipOddsOfVisit * d.visits);
    }
    first = last;
  }
}

}  // namespace chaintrue::grid::diagnosis
