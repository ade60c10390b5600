// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Simulated sessions of four belts at one pull and at two.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "grid/synthetic/simulated_belts.hpp"
#include "tests/belts/frame.hpp"

namespace chaintrue::grid::two_pulls {

/// Pull of the second pass over the first.
inline constexpr double kHarder = 1.6;

inline MeasuredBelts measured(std::vector<model::AppliedEffect> hidden,
                       std::vector<double> pulls,
                       double noise_mm,
                       std::uint64_t seed) {
  synthetic::BeltsSpec spec;
  spec.columns = 7;
  spec.rows = 6;
  spec.noise_mm = noise_mm;
  spec.hidden = std::move(hidden);
  spec.pulls = std::move(pulls);
  spec.seed = seed;
  return synthetic::simulate_belts(testing_support::stated(), testing_support::truth(), spec).value();
}

}  // namespace chaintrue::grid::two_pulls
