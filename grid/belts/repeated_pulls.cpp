// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/repeated_pulls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"

namespace chaintrue::grid {

namespace {

/// The firmware repeats a reading until it agrees to this; starting places are 100 mm apart.
constexpr double kSamePlaceMm = 1.0;
/// The repeatability of two consecutive readings is never better.
constexpr double kLeastSigmaMm = 0.1;

}  // namespace

std::vector<RepeatedPull> repeated_pulls(const MeasuredBelts& belts) {
  std::vector<RepeatedPull> found;
  for (std::size_t k = 0; k + 1 < belts.points.size(); ++k) {
    const BeltPoint& first = belts.points[k];
    const BeltPoint& second = belts.points[k + 1];
    if (pulled_belts(first) != pulled_belts(second)) continue;
    RepeatedPull pull{k, k + 1, 0.0, 0.0};
    double held_square = 0.0, length_mm = 0.0;
    int held = 0, pulled = 0;
    bool stays = true;
    for (const Belt belt : kBelts) {
      const double shorter = first.lengths_mm[belt] - second.lengths_mm[belt];
      if (is_pulled(first, belt)) {
        pull.share += shorter / first.lengths_mm[belt];
        length_mm += first.lengths_mm[belt];
        ++pulled;
      } else {
        stays = stays && std::abs(shorter) < kSamePlaceMm;
        held_square += shorter * shorter;
        ++held;
      }
    }
    if (!stays || held == 0 || pulled == 0) continue;
    pull.share /= pulled;
    // A difference of two readings, as for the holding belts.
    const double one_mm = std::max(std::sqrt(held_square / held), std::sqrt(2.0) * kLeastSigmaMm);
    pull.sigma = one_mm * std::sqrt(as_double(pulled)) / length_mm;
    found.push_back(pull);
    ++k;
  }
  return found;
}

std::string repeated_pulls_in_words(const MeasuredBelts& belts) {
  const std::vector<RepeatedPull> found = repeated_pulls(belts);
  if (found.empty()) return "";
  std::string text =
      "Places read at two pulls, with the holding belts unchanged, show how much the pulled belts "
      "stretch from one pull to the other:";
  for (const RepeatedPull& pull : found) {
    text +=
        fmt::format("{} points {} and {} {:.3f} +- {:.3f} %", &pull == &found.front() ? "" : ",",
                    pull.first + 1, pull.second + 1, 100.0 * pull.share, 100.0 * pull.sigma);
  }
  return text + ".";
}

}  // namespace chaintrue::grid
