// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Detects machines whose numbers are individually but not jointly possible: the last check of
/// every importer.
#pragma once

#include "grid/files/problems.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// Reports model::problems_of, motors that are not beyond the bed, and a place of the bed where no
/// sled can hang, or where the chains would need more pull than motors have.
void check_geometry(const model::Machine& machine, Problems& problems);

/// The longest chain that any place of the bed needs, from the sprocket to the sled. \pre a machine
/// without problems.
[[nodiscard]] double longest_chain_mm(const model::Machine& machine);

/// How to give a machine that runs LinuxCNC or Klipper, where `text` is such a program's settings;
/// reports it.
void refuse_foreign_settings(std::string_view text, Problems& problems);

}  // namespace chaintrue::grid::files
