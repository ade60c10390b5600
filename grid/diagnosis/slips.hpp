// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Slips of a whole file, which no effect resembles: columns exchanged, an axis turned round,
/// inches.
#pragma once

#include <optional>

#include "grid/diagnosis/observations.hpp"

namespace chaintrue::grid::diagnosis {

/// Where the points are far off what the stated machine says and one such slip mends that: what to
/// look at. Nothing where none does.
[[nodiscard]] std::optional<DiagnosisFailure> suspected_slip(const ObservationSet& session);

}  // namespace chaintrue::grid::diagnosis
