// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The figures of many trials as Markdown, and one line for each trial.
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

/// Mean difference between the stated probability of the best causes and their rate of being right,
/// in ten bins; and that rate for probabilities of 0.95 or more.
struct Honesty {
  double calibration_error = 0.0;
  int claims = 0;
  Share sure_right;
};
[[nodiscard]] Honesty honesty(const std::vector<Trial>& trials);

/// Deterministic except for the times, which have a separate row.
[[nodiscard]] std::string markdown(const TrialOptions& options, const std::vector<Trial>& trials);
[[nodiscard]] std::string csv(const std::vector<Trial>& trials);

}  // namespace chaintrue::sealed
