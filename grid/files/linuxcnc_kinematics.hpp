// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A map as a kinematics module of LinuxCNC: the source (C) of a component that interpolates both
/// lengths in a table (length_table.hpp).
///
/// Joints 0 and 1 are the lengths left and right, joint 2 is z, in mm. Outside the table both
/// directions fail, which stops LinuxCNC.
///
/// \code
///   const auto module = linuxcnc_kinematics(MapInFrame(map), {"chaintrue_kins", "my map"});
///   if (module) write_whole_file("chaintrue_kins.c", module->source);
/// \endcode
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "grid/files/length_table.hpp"

namespace chaintrue::grid::files {

struct LinuxcncNames {
  std::string module;  ///< of the component: an identifier, the source's file without its .c
  std::string map;     ///< for a comment
};

/// Over the map's domain. Fails if the map has no answer somewhere in it.
[[nodiscard]] tl::expected<TableModule, MapFailure> linuxcnc_kinematics(const LengthMap& map,
                                                                        const LinuxcncNames& names);

}  // namespace chaintrue::grid::files
