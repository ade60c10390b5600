// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The tables of a chaintrue_belts file, for the formats that hold one or its machine. Private to
/// grid/files.
#pragma once

#include "grid/belts/measured_belts.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

inline constexpr Range kBeltLengthMm{"mm", 1.0, 20000.0};
inline constexpr Range kBeltDistanceMm{"mm", 1.0, 20000.0};

/// Includes the checks of model::problems_of.
[[nodiscard]] const Record<model::BeltMachine>& belt_machine_record();

[[nodiscard]] const Record<MeasuredBelts>& belts_record();

}  // namespace chaintrue::grid::files
