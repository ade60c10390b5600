// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A controller's firmware: its kinematics and its settings.
#pragma once

#include <optional>

#include "model/coordinates.hpp"

namespace chaintrue::model {

enum class ControllerKind {
  /// The stated machine with the elastic catenary.
  ideal,
  /// MaslowCNC/Firmware, triangular kinematics with the parabola's sag.
  maslow_classic,
  /// The "holey" firmware: one-shot catenary and mean stretch.
  holey,
  /// FluidNC's WallPlotter: straight lines to the anchors.
  fluidnc_wallplotter,
};

/// GroundControl's settings that enter the kinematics, with GroundControl's names (as in files) in the
/// comments. A setting that a file does not state is empty and taken from the machine.
struct ControllerSettings {
  std::optional<double> bed_width_mm;          // bedwidth
  std::optional<double> bed_height_mm;         // bedheight
  std::optional<double> motor_spacing_mm;      // motorspacingx
  std::optional<double> motor_offset_y_mm;     // motoroffsety
  std::optional<double> rotation_radius_mm;    // rotationradius
  std::optional<double> sled_width_mm;         // sledwidth, bracket sleds only, as the next two
  std::optional<double> sled_height_mm;        // sledheight
  std::optional<double> sled_cg_mm;            // sledcg
  std::optional<double> chain_sag_correction;  // chainsagcorrection, unit 1e-12 / mm^2
  std::optional<double> left_chain_tolerance_percent;   // leftchaintolerance
  std::optional<double> right_chain_tolerance_percent;  // rightchaintolerance
  std::optional<double> top_beam_tilt_deg;              // topbeamtilt
  std::optional<double> chain_pitch_mm;                 // chainpitch
  std::optional<double> gear_teeth;                     // gearteeth
  std::optional<bool> chain_over_sprocket_top;          // chainoversprocket: Top | Bottom
  std::optional<double> sled_weight_n;                  // sledweight
  std::optional<double> chain_elongation_per_n;         // chainelongationfactor
};

struct Controller {
  ControllerKind kind = ControllerKind::ideal;
  ControllerSettings settings;
};

}  // namespace chaintrue::model

/// Exported: this name is used throughout chaintrue.
namespace chaintrue {
using model::ControllerKind;
}  // namespace chaintrue
