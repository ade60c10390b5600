// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From many trials to the figures that are stated of them, as Markdown, and to a line a trial.
#pragma once

#include <string>
#include <vector>

#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

/// A share with its 95 % bounds (binomial.hpp).
struct Share {
  int hits = 0;
  int of = 0;
  void count(bool hit) {
    hits += hit ? 1 : 0;
    ++of;
  }
  [[nodiscard]] double value() const { return of == 0 ? 0.0 : static_cast<double>(hits) / of; }
};
[[nodiscard]] std::string text(const Share& share);

/// Mean gap between what leading causes claim and how often they are right, in ten bins; and how
/// often claims of 0.95 or more are.
struct Honesty {
  double calibration_error = 0.0;
  int claims = 0;
  Share sure_right;
};
[[nodiscard]] Honesty honesty(const std::vector<Trial>& trials);

/// Deterministic but for the times, which stand in a row of their own.
[[nodiscard]] std::string markdown(const TrialOptions& options, const std::vector<Trial>& trials);
[[nodiscard]] std::string csv(const std::vector<Trial>& trials);

}  // namespace chaintrue::sealed
