// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// GroundControl's groundcontrol.ini: its settings are what somebody holds their machine to be, and
/// what the firmware computes with. Importing makes a machine of them, and of the same numbers its
/// controller, maslow_classic. Exporting turns a machine, as calibration found it, into the numbers
/// to type in.
///
/// The chain tolerances are the pitch that the owner found for each chain: the machine bears each
/// as a chain_pitch_error, which a reading of link_pitch_mm replaces. A later chain_pitch_error
/// comes on top of it.
///
/// Of tolerances that nobody knows the origin of, or that were tuned to take up something else, the
/// machine may leave that out (Tolerances::unexplained): its links are then nominal, and a diagnosis
/// finds for itself what they are.
///
/// Exporting an imported machine returns every number as it came, but for those that the machine
/// says otherwise now; import, export, import gives the same machine.
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
#include <string_view>
#include <vector>

#include "grid/files/machine_file.hpp"

namespace chaintrue::grid::files {

/// sledweight is the sled's mass under this gravity.
inline constexpr double kGroundcontrolGravity_m_per_s2 = 9.80665;

enum class Tolerances { are_pitch, unexplained };

/// "-" reads standard input. The warnings say what was assumed.
/// \throws InputError with every problem of the file: missing settings, wrong types, inches, values
/// out of range.
[[nodiscard]] ReadMachine read_groundcontrol(const std::filesystem::path& path,
                                             Tolerances tolerances = Tolerances::are_pitch);
/// `file` is the name used in messages and, without its folder, the machine's.
[[nodiscard]] ReadMachine parse_groundcontrol(const std::string& text,
                                              const std::string& file,
                                              Tolerances tolerances = Tolerances::are_pitch);

struct GroundcontrolText {
  /// `key = value` under GroundControl's sections: what changes to 0.0001 of each setting's unit,
  /// what does not as it came. An imported machine has the keys that its file had.
  std::string text;
  /// Which settings change against the machine's controller and by what, and what of the machine
  /// GroundControl has no setting for.
  std::vector<std::string> remarks;
};

/// A setting in the machine's controller that the machine still agrees with stays as it is.
/// chainsagcorrection, which owners tune to take up much else, stays unless chain_sag is named.
///
/// The effects ring_radius, chain_pitch_error and chain_sag enter rotationradius, the chain
/// tolerances and chainsagcorrection, and chain_stretch enters chainelongationfactor where the
/// controller has it; any other effect is a remark with what can be done about it. The firmware
/// divides the straight part of a chain by 1 + tolerance / 100 where chain_pitch_error divides the
/// whole of it; the difference, a few tenths of a mm at most, is constant but for the wrap and goes
/// with the next zeroing of the chains.
[[nodiscard]] GroundcontrolText write_groundcontrol(const model::Machine& machine);

/// The machine's controller with `settings` in place of its own. `by` is what changes them: "the
/// 28 points of map.json".
[[nodiscard]] GroundcontrolText write_groundcontrol_settings(const model::Machine& machine,
                                                             const model::ControllerSettings& settings,
                                                             std::string_view by);

}  // namespace chaintrue::grid::files
