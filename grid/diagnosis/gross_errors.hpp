// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Slips of a whole file, which no effect resembles (grid/input_checks): of data that no reader of
/// files has looked at.
#pragma once

#include <optional>

#include "grid/diagnosis/observations.hpp"

namespace chaintrue::grid::diagnosis {

/// What to look at before any cause is looked for; nothing where nothing is suspected.
[[nodiscard]] std::optional<DiagnosisFailure> suspected_slip(const Measured& measured);

}  // namespace chaintrue::grid::diagnosis
