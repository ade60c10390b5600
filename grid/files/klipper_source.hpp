// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The text (Python) of a kinematics module of Klipper around its table. Private to grid/files.
#pragma once

#include <string>

#include "grid/files/klipper_kinematics.hpp"

namespace chaintrue::grid::files {

/// Same table, same bytes.
[[nodiscard]] std::string klipper_source(const LengthTable& table,
                                         const StraightChains& straight,
                                         double piece_mm,
                                         std::string name);

}  // namespace chaintrue::grid::files
