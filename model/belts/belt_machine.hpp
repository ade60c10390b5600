// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A router that hangs on four belts (Maslow 4), with the settings of its firmware. Data only; the
/// geometry is in belt_kinematics.hpp.
///
/// Frame: the bottom left anchor is the origin, x points to the bottom right anchor, whose y is 0; y
/// up the sheet, mm. The origin of commands is where the frame's diagonals cross (BedPoint).
///
/// Sources: MaslowCNC/Maslow_4, firmware/FluidNC/src/Kinematics/MaslowKinematics.cpp (heights, arm,
/// extension), src/Maslow/Calibration.cpp (what is printed, which belts hold and which are pulled)
/// and data/maslow.yaml (defaults).
///
/// \code
///   BeltMachine machine;
///   machine.anchors.tl = {-20.0, 2070.0, 100.0};
///   machine.orientation = Orientation::flat;
///   for (const MachineProblem& p : problems_of(machine)) say(p.parameter, p.value, p.expected);
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/belts/belt.hpp"
#include "model/coordinates.hpp"
#include "model/machine.hpp"

namespace chaintrue::model {

/// A point in the sheet's plane, in the anchors' frame.
struct FramePoint {
  double x_mm = 0.0;
  double y_mm = 0.0;
};

/// The point where a belt leaves the frame; z above the bed.
struct Anchor {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double z_mm = 0.0;
};

enum class Orientation { upright, flat };

/// The length that the controller prints.
enum class BeltLengths {
  belt,          ///< the belt itself, from the anchor slanting to its end
  belt_and_arm,  ///< belt plus extension and arm: firmware before October 2024
  span,          ///< horizontal from the anchor to the tool: firmware since
};
/// The controller's names of its settings: /kinematics/MaslowKinematics/tlX, or /Maslow_tlX as in firmware
/// before July 2025.
enum class SettingNames { in_kinematics, top_level };
std::string_view name(Orientation orientation);
std::string_view name(BeltLengths lengths);

struct BeltMachine {
  std::string name = "Maslow 4";
  /// Heights are the firmware's defaults: the arms cross at different heights.
  PerBelt<Anchor> anchors{{0.0, 0.0, 100.0}, {0.0, 0.0, 56.0}, {0.0, 0.0, 34.0}, {0.0, 0.0, 78.0}};
  /// If false, x_mm and y_mm are not known yet and 0.
  bool anchors_known = false;
  double arm_mm = 123.4;
  double end_extension_mm = 30.0;  ///< the belt's end, between its last tooth and the arm
  double surface_mm = 0.0;         ///< spoilboard and work together, on top of the anchors' z
  Orientation orientation = Orientation::upright;
  BeltLengths lengths = BeltLengths::span;
  double belt_turn_mm = 43.975;  ///< belt per turn of the encoder
  /// Commands are multiplied by these first.
  double scale_x = 1.0;
  double scale_y = 1.0;
  std::optional<SettingNames> setting_names = std::nullopt;  ///< empty: in_kinematics
};

/// From the belt's end to the tool: arm and extension.
double reach_mm(const BeltMachine& machine);
/// Height of the anchor over the belt's end.
double height_mm(const BeltMachine& machine, Belt belt);

/// The origin of commands: the crossing of the frame's diagonals. \throws std::logic_error if the
/// anchors are not known or the diagonals are parallel.
FramePoint centre_of(const BeltMachine& machine);
/// The position that the controller intends for a command, with its scales applied.
FramePoint to_frame(const BeltMachine& machine, BedPoint command);

/// All reasons why a machine is invalid; empty if it is valid. The ranges contain every real
/// machine.
[[nodiscard]] std::vector<MachineProblem> problems_of(const BeltMachine& machine);

}  // namespace chaintrue::model

/// Exported: these names are used throughout chaintrue.
namespace chaintrue {
using model::BeltMachine;
using model::FramePoint;
using model::Orientation;
}  // namespace chaintrue
