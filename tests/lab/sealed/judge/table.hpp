// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The figures of many trials as Markdown.
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

/// The rows of rates.hpp and what these do not count. Deterministic except for the times, which have a
/// separate row.
[[nodiscard]] std::string markdown(const TrialOptions& options, const std::vector<Trial>& trials);

}  // namespace chaintrue::sealed
