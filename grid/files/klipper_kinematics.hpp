// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A map as a kinematics module of Klipper: the source (Python) of a module that interpolates both
/// lengths in a table (length_table.hpp).
///
/// Klipper computes steps in C, as straight distances from anchors (its kinematics `winch`). To put
/// the tool at p the module commands the place c whose straight distances from two anchors a are
/// the map's lengths L,
///
///   |c - a| = sqrt((L(p) + o)^2 - z^2)                                                      (1)
///
/// o is a constant by which such distances are longer, such as a sled's ring; steppers count from
/// where they are switched on, so it needs no setting.
///
/// in pieces so short that the lengths between their ends are the map's to a hundredth of a millimetre:
/// `winch` counts z into its distances, which (1) takes out. Outside the table a move is refused before
/// its first piece.
///
/// Sources: Klipper3d/klipper, klippy/kinematics/winch.py, klippy/extras/skew_correction.py (a transform
/// of moves), klippy/chelper/kin_winch.c.
///
/// \code
///   const auto module = klipper_kinematics(MapInFrame(map), {anchors, longer_mm}, "my map");
///   if (module) write_whole_file("chaintrue.py", module->source);
/// \endcode
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "grid/files/length_table.hpp"

namespace chaintrue::grid::files {

struct KlipperKinematics : TableModule {
  double piece_mm = 0.0;  ///< the longest move that is not divided
};

/// Approximate origins of the chains, in the map's frame, and o of (1); straight_settings.hpp gives
/// the best, and nearby ones serve.
struct StraightChains {
  PerSide<BedPoint> anchors;
  ChainLengths longer_mm;
};

/// Over the map's domain. Fails if the map has no answer somewhere, or straight chains from there do not meet.
[[nodiscard]] tl::expected<KlipperKinematics, MapFailure> klipper_kinematics(
    const LengthMap& map, const StraightChains& straight, const std::string& name);

}  // namespace chaintrue::grid::files
