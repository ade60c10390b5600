// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace chaintrue::grid {

/// Root mean square and largest value of a set of errors.
struct ErrorSummary {
  double rms_mm = 0.0;
  double maximum_mm = 0.0;
};

}  // namespace chaintrue::grid
