// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// GroundControl's groundcontrol.ini: its settings are the owner's description of the machine, and
/// the numbers that the firmware uses. An import makes a machine of them and, from the same numbers,
/// its controller, maslow_classic. An export converts a calibrated machine into the numbers to type
/// in.
///
/// The chain tolerances are the pitch that the owner measured for each chain: the machine has each
/// as a chain_pitch_error, which a reading of link_pitch_mm replaces.
///
/// Tolerances of unknown origin, or tuned to compensate something else, may be left out
/// (Tolerances::unexplained): the links are then nominal, and a diagnosis estimates them.
///
/// An export of an imported machine returns every number unchanged unless the machine has changed
/// it; import, export, import gives the same machine.
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
/// optical branch). The section [Computed Settings] is ignored: GroundControl computes it from the
/// others. What the file does not contain (sled, chain, frame) is the default machine's, with a
/// warning.
///
/// \code
///   const ReadMachine found = read(parse_groundcontrol, "groundcontrol.ini");
///   write_whole_file("machine.json", write_machine(found.machine));
/// \endcode
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/files/machine_file.hpp"

namespace chaintrue::grid::files {

/// sledweight is the sled's mass under this gravity.
inline constexpr double kGroundcontrolGravity_m_per_s2 = 9.80665;

enum class Tolerances { are_pitch, unexplained };

/// `file` is the name used in messages and, without its folder, the machine's. The warnings list
/// what was assumed. \throws InputError with every problem of the file: missing settings, wrong
/// types, inches, values out of range.
ReadMachine parse_groundcontrol(const std::string& text, const std::string& file,
                                Tolerances tolerances = Tolerances::are_pitch);

/// The machine's own measures as settings: motors, ring or sled, sprocket, the sag of the chain's weight where
/// no import states one; tilt and stretch of the holey firmware alone. They do not include its
/// effects: map/settings_to_type.hpp finds the numbers for the whole machine.
model::ControllerSettings measures_as_settings(const Machine& machine);

struct GroundcontrolText {
  /// `key = value` under GroundControl's sections: changed settings to 0.0001 of their unit, the
  /// others unchanged. An imported machine has the keys of its file.
  std::string text;
  /// Which settings differ from the machine's controller and by how much.
  std::vector<std::string> remarks;
};

/// For those measures. A setting of the controller that agrees with the machine is unchanged.
GroundcontrolText write_groundcontrol(const Machine& machine);

/// Whether anything was measured since the import: false if the machine is what an import of its
/// settings gives.
bool says_more_than_its_settings(const Machine& machine);

/// The machine's controller with these settings. `by` is the source of the change: "the 28 points
/// of map.json".
GroundcontrolText write_groundcontrol_settings(const Machine& machine,
                                               const model::ControllerSettings& settings,
                                               std::string_view by);

// WebControl's webcontrol.json: GroundControl's settings, each an object with its key and its value
// in a list for each section:
//
//   { "Maslow Settings": [ {"key": "motorSpacingX", "value": "2978.4", ...}, ... ],
//     "Advanced Settings": [ ... ] }
//
// Everything else is as in groundcontrol_file.hpp. Source: WebControlCNC/WebControl,
// defaultwebcontrol.json.

/// True for JSON with its two sections. \throws InputError for a text that is not JSON.
bool is_webcontrol(const std::string& text, const std::string& file);
/// `file` is the name used in messages and, without its folder, the machine's.
/// \throws InputError with every problem of the file.
ReadMachine parse_webcontrol(const std::string& text, const std::string& file);

// FluidNC's config.yaml of a wall plotter: its anchors, and the travel of its axes as the bed.
//
//   kinematics:
//     WallPlotter:
//       left_anchor_x: -1200
//       left_anchor_y: 900
//       right_anchor_x: 1200
//       right_anchor_y: 900
//   axes:
//     x:
//       max_travel_mm: 2000
//     y:
//       max_travel_mm: 1200
//
// WallPlotter uses straight lines to the anchors, without sprockets, weights and rings: all of
// these are assumed, with a warning. Its origin is taken as the bed's centre. Only this part of
// YAML is read: keys by their indentation, and the value after the colon. Source: bdring/FluidNC,
// src/Kinematics/WallPlotter.cpp.

bool is_fluidnc(const std::string& text);
/// `file` is the name used in messages and, without its folder, the machine's.
/// \throws InputError with every problem of the file.
ReadMachine parse_fluidnc(const std::string& text, const std::string& file);

}  // namespace chaintrue::grid::files
