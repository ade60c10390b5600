// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "grid/statistics.hpp"

namespace chaintrue::grid {

/// Root mean square and largest value of a set of errors. For expected errors, the largest is a
/// bound that holds in 95 of 100 sessions (largest_error.hpp).
struct ErrorSummary {
  double rms_mm = 0.0;
  double maximum_mm = 0.0;
};
inline ErrorSummary summary_of(const std::vector<double>& errors_mm) {
  double largest = 0.0;
  for (const double error : errors_mm) largest = std::max(largest, std::abs(error));
  return {rms(errors_mm), largest};
}

}  // namespace chaintrue::grid
