// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace chaintrue::grid {

/// Root mean square and largest value of a set of errors. Of errors that are expected, not seen, the
/// largest is a bound that 95 of 100 sessions keep (largest_error.hpp).
struct ErrorSummary {
  double rms_mm = 0.0;
  double maximum_mm = 0.0;
};

}  // namespace chaintrue::grid
