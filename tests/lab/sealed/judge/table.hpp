// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The figures of many trials as Markdown.
#pragma once

#include <string>
#include <vector>

#include "sealed/judge/calibration.hpp"
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

/// For every cause that is named, alone, among several or in a set; and how often those of 0.95 and more act.
struct Honesty {
  Calibration calibration;
  Share sure_right;
};
[[nodiscard]] Honesty honesty(const std::vector<Trial>& trials);

/// The rows of rates.hpp and what these do not count. Deterministic except for the times, which have a
/// separate row.
[[nodiscard]] std::string markdown(const TrialOptions& options, const std::vector<Trial>& trials);

}  // namespace chaintrue::sealed
