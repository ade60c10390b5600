// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/binomial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace chaintrue::sealed {
namespace {

constexpr double kEachSide = 0.025;

double probability_of(int k, int of, double p) {
  if (p == 0.0) return k == 0 ? 1.0 : 0.0;
  if (p == 1.0) return k == of ? 1.0 : 0.0;
  const double ways = std::lgamma(of + 1.0) - std::lgamma(k + 1.0) - std::lgamma(of - k + 1.0);
  return std::exp(ways + k * std::log(p) + (of - k) * std::log1p(-p));
}

/// The p at which a probability that increases with p is `wanted`.
template <class Chance>
double where(Chance chance, double wanted) {
  double low = 0.0, high = 1.0;
  constexpr int kHalvings = 60;  // to the last bit of a number near one
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (low + high);
    (chance(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double probability_of_at_least(int least, int of, double p) {
  if (!(p >= 0.0 && p <= 1.0) || of < 0) {
    throw std::invalid_argument(
        fmt::format("probability_of_at_least: {} trials of probability {}", of, p));
  }
  // The shorter tail is summed, so that a small probability is not the difference of two large
  // ones.
  double sum = 0.0;
  if (least > p * of) {
    for (int k = of; k >= std::max(least, 0); --k) sum += probability_of(k, of, p);
    return std::min(1.0, sum);
  }
  for (int k = 0; k < least; ++k) sum += probability_of(k, of, p);
  return std::max(0.0, 1.0 - sum);
}

RateBounds rate_bounds_95(int hits, int of) {
  if (hits < 0 || hits > of) {
    throw std::invalid_argument(fmt::format("rate_bounds_95: {} of {}", hits, of));
  }
  RateBounds bounds;
  if (hits > 0) {
    bounds.lower = where([&](double p) { return probability_of_at_least(hits, of, p); }, kEachSide);
  }
  if (hits < of) {
    bounds.upper =
        where([&](double p) { return probability_of_at_least(hits + 1, of, p); }, 1.0 - kEachSide);
  }
  return bounds;
}

RateBounds clustered_bounds(const std::vector<Count>& clusters) {
  // Quantile 97.5 % of Student's t, by its degrees of freedom.
  constexpr std::array kQuantiles = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.26};
  Count all;
  for (const Count& own : clusters) all = {all.hits + own.hits, all.of + own.of};
  if (clusters.size() < 2 || all.of == 0) return {};
  const double rate = static_cast<double>(all.hits) / all.of;
  double square = 0.0;
  for (const Count& own : clusters) square += std::pow(own.hits - rate * own.of, 2);
  const auto n = static_cast<double>(clusters.size());
  const double off = kQuantiles[std::min(clusters.size() - 2, kQuantiles.size() - 1)] *
                     std::sqrt(n / (n - 1.0) * square) / all.of;
  const RateBounds binomial = rate_bounds_95(all.hits, all.of);
  return {std::max(0.0, std::min(binomial.lower, rate - off)),
          std::min(1.0, std::max(binomial.upper, rate + off))};
}

double sign_test(int lost, int gained) {
  if (lost < 0 || gained < 0) {
    throw std::invalid_argument(fmt::format("sign_test: {} lost, {} gained", lost, gained));
  }
  return probability_of_at_least(lost, lost + gained, 0.5);
}

}  // namespace chaintrue::sealed
