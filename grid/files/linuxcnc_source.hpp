// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The text (C) of a kinematics module of LinuxCNC around its table. Private to grid/files.
#pragma once

#include <string>

#include "grid/files/linuxcnc_kinematics.hpp"

namespace chaintrue::grid::files {

/// Same table, same bytes.
[[nodiscard]] std::string linuxcnc_source(const LengthTable& table, const LinuxcncNames& names);

}  // namespace chaintrue::grid::files
