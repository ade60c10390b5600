// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How probable each change is that a check knows, by map_check.hpp (1). Private to grid/map.
#pragma once

#include <vector>

#include "grid/map/check_readings.hpp"

namespace chaintrue::grid {

/// Every hypothesis that the readings allow for, with its probability; these sum to one. The order
/// does not depend on the residuals.
[[nodiscard]] std::vector<CheckHypothesis> weighed_hypotheses(const CheckReadings& readings);

}  // namespace chaintrue::grid
