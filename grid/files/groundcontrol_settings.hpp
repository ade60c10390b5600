// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings that GroundControl and WebControl share, independent of the file format. Private to
/// grid/files.
#pragma once

#include <optional>

#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/setting_reader.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

using model::ControllerSettings;

/// The sled that needs a setting, or all or none.
enum class Need { always, ring, brackets, never };

/// A number among the settings, with what it means in a machine's file and its range in an import. The
/// ranges are inside those of model::problems_of and of the catalogue of effects, so that messages name
/// the imported file's lines.
struct NumberKey {
  const char* key;
  const char* meaning;
  Range range;
  Need need;
  std::optional<double> ControllerSettings::*setting;
};

/// In the order of a machine's file.
inline constexpr NumberKey kNumberKeys[] = {
    {"bedwidth",
     "GroundControl's bedwidth.",
     {"mm", 200, 20000},
     Need::always,
     &ControllerSettings::bed_width_mm},
    {"bedheight",
     "GroundControl's bedheight.",
     {"mm", 200, 20000},
     Need::always,
     &ControllerSettings::bed_height_mm},
    {"motorspacingx",
     "Distance between the motors' axes.",
     {"mm", 300, 40000},
     Need::always,
     &ControllerSettings::motor_spacing_mm},
    {"motoroffsety",
     "Height of the motors above the bed's upper edge.",
     {"mm", 1, 10000},
     Need::always,
     &ControllerSettings::motor_offset_y_mm},
    {"rotationradius",
     "Distance from the bit to a chain's end.",
     {"mm", 20, 500},
     Need::ring,
     &ControllerSettings::rotation_radius_mm},
    {"sledwidth",
     "For a sled on brackets: distance between the brackets.",
     {"mm", 50, 1500},
     Need::brackets,
     &ControllerSettings::sled_width_mm},
    {"sledheight",
     "For a sled on brackets: height of the brackets above the bit.",
     {"mm", 20, 1000},
     Need::brackets,
     &ControllerSettings::sled_height_mm},
    {"sledcg",
     "For a sled on brackets: distance of its centre of gravity below the bit.",
     {"mm", 5, 1000},
     Need::brackets,
     &ControllerSettings::sled_cg_mm},
    {"chainsagcorrection",
     "Factor of the firmware's parabola for the chain's sag.",
     {"1e-12 / mm^2", -1000, 1000},
     Need::never,
     &ControllerSettings::chain_sag_correction},
    {"leftchaintolerance",
     "Excess length of the left chain's links.",
     {"percent", -5, 5},
     Need::never,
     &ControllerSettings::left_chain_tolerance_percent},
    {"rightchaintolerance",
     "Excess length of the right chain's links.",
     {"percent", -5, 5},
     Need::never,
     &ControllerSettings::right_chain_tolerance_percent},
    {"topbeamtilt",
     "Tilt of the beam.",
     {"degrees", -20, 20},
     Need::never,
     &ControllerSettings::top_beam_tilt_deg},
    {"chainpitch",
     "Length of a link.",
     {"mm", 1, 50},
     Need::always,
     &ControllerSettings::chain_pitch_mm},
    {"gearteeth",
     "Number of teeth of a sprocket.",
     {"teeth", 3, 100},
     Need::always,
     &ControllerSettings::gear_teeth},
    {"sledweight",
     "Weight of the sled.",
     {"N", 1, 2000},
     Need::never,
     &ControllerSettings::sled_weight_n},
    {"chainelongationfactor",
     "Stretch of the chain per newton.",
     {"1/N", 0, 1e-3},
     Need::never,
     &ControllerSettings::chain_elongation_per_n}};

/// As in groundcontrol_file.hpp; paths are "maslow settings/bedwidth". \throws InputError with every problem of the file.
ReadMachine machine_of_settings(SettingTexts texts, Tolerances tolerances, Problems& problems);

}  // namespace chaintrue::grid::files
