// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What to measure next so that the leading causes part.
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

[[nodiscard]] std::vector<NextMeasurement> next_measurements(const Session& session,
                                                             const Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
