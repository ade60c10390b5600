// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// GroundControl's groundcontrol.ini: its settings are what somebody holds their machine to be, and
/// what the firmware computes with. Importing makes a machine of them, and of the same numbers its
/// controller, maslow_classic. Exporting turns a machine, as calibration found it, into the numbers
/// to type in.
///
/// Notation
///   D   motorspacingx
///   Yo  motoroffsety
///   t   topbeamtilt
///   H   bedheight
///   s   left -1, right +1
///
///   motor = (0, H/2 + Yo) + s D/2 (cos t, sin t)                                            (1)
///
/// (1) is the firmware's own (Kinematics.cpp of MaslowCNC/Firmware, with the beam's tilt of its
/// optical branch). The section [Computed Settings] is ignored: GroundControl makes it from the
/// others. What the file does not say (sled, chain, frame) is the default machine's, and said as
/// assumed.
///
/// \code
///   const ReadMachine read = read_groundcontrol("groundcontrol.ini");
///   write_whole_file("machine.json", write_machine(read.machine));
/// \endcode
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grid/files/machine_file.hpp"

namespace chaintrue::grid::files {

/// "-" reads standard input. The warnings say what was assumed.
/// \throws InputError with every problem of the file: missing settings, wrong types, inches, values
/// out of range.
[[nodiscard]] ReadMachine read_groundcontrol(const std::filesystem::path& path);
/// `file` is the name used in messages and, without its folder, the machine's.
[[nodiscard]] ReadMachine parse_groundcontrol(const std::string& text, const std::string& file);

struct GroundcontrolText {
  /// `key = value` under GroundControl's sections, to 0.0001 of each setting's unit.
  std::string text;
  /// What of the machine GroundControl has no setting for, and which settings change against the
  /// machine's controller.
  std::vector<std::string> remarks;
};

/// The effects ring_radius, chain_pitch_error and chain_sag enter rotationradius, the chain
/// tolerances and chainsagcorrection, and chain_stretch enters chainelongationfactor where the
/// controller has it; any other effect is a remark with what can be done about it. The firmware
/// divides the straight part of a chain by 1 + tolerance / 100 where chain_pitch_error divides the
/// whole of it; the difference, a few tenths of a mm at most, is constant but for the wrap and goes
/// with the next zeroing of the chains.
[[nodiscard]] GroundcontrolText write_groundcontrol(const model::Machine& machine);

}  // namespace chaintrue::grid::files
