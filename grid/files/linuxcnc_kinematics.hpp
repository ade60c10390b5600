// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A map as a kinematics module of LinuxCNC: the source (C) of a component that interpolates both
/// lengths in a table.
///
/// Between nodes of a regular lattice lengths are interpolated by cubic convolution in x and in y (R.
/// Keys, IEEE Trans. Acoust. Speech Signal Process. 29 (1981), 1153, eq. 4 and the boundary values of
/// eq. 25). The table is as dense as it has to be: what it is off by is looked for in the middles of
/// cells and of their sides, where it is largest.
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

#include "grid/map/length_map.hpp"

namespace chaintrue::grid::files {

/// What a table may be off by, mm: the hundredth part of what a careful hand reads.
inline constexpr double kTableErrorMm = 0.005;

struct LinuxcncNames {
  std::string module;  ///< of the component: an identifier, the source's file without its .c
  std::string map;     ///< for a comment
};

struct LinuxcncKinematics {
  std::string source;
  int columns = 0;
  int rows = 0;
  double spacing_mm = 0.0;        ///< the larger of both
  /// Of a length, as it was looked for; above kTableErrorMm only where 5 mm from node to node do not do.
  double largest_error_mm = 0.0;
};

/// Over the map's domain. Fails where the map has no answer somewhere in it.
[[nodiscard]] tl::expected<LinuxcncKinematics, MapFailure> linuxcnc_kinematics(
    const LengthMap& map, const LinuxcncNames& names);

}  // namespace chaintrue::grid::files
