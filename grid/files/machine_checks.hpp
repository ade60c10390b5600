// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A machine whose numbers are each possible and together are not: every importer's last look.
#pragma once

#include "grid/files/problems.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// Reports what model::problems_of says of it, motors that are not beyond the bed, and a place of the bed
/// where no sled hangs, or one that chains would have to pull harder than motors can.
void check_geometry(const model::Machine& machine, Problems& problems);

/// The longest chain that any place of the bed takes, from the sprocket to the sled. \pre a machine
/// without problems.
[[nodiscard]] double longest_chain_mm(const model::Machine& machine);

/// How to give a machine that runs LinuxCNC or Klipper, where `text` is such a program's settings;
/// reports it.
void refuse_foreign_settings(std::string_view text, Problems& problems);

}  // namespace chaintrue::grid::files
