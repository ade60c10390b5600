// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a controller goes from one commanded point to the next: its number format, its stepping, and
/// what it does to targets beyond its sheet. (What chain lengths it pays out for a point is
/// model/controllers/payout.hpp.)
///
/// Sources, by file of the firmware:
///
///   maslow_classic       MaslowCNC/Firmware, cnc_ctrl_v1. Motion.cpp, coordinatedMove: a position
///                        every LOOPINTERVAL (10000 us), in float, one move after the other.
///                        Kinematics.cpp, _verifyValidTarget: clamps to half the bed. GCode.cpp,
///                        executeGcodeLine, executeMcodeLine: the codes; a code's number is cut to
///                        an integer, the rest are answered "unsupported and ignored".
///   holey                madgrizzle/OpticalFirmware (the firmware with stretch and catenary),
///                        cnc_ctrl_v1, the same files and functions: it moves and reads alike.
///   fluidnc_wallplotter  bdring/FluidNC, FluidNC/src. Kinematics/WallPlotter.cpp,
///                        cartesian_to_motors: pieces of segment_length (10 mm by default), chain
///                        lengths linear within a piece, summed up in float; a move of no length is
///                        sent to the motors as if x and y were chain lengths. GCode.cpp,
///                        gc_execute_line: the codes, Error.h: 20. Machine/MachineConfig.h:
///                        arc_tolerance 0.002 mm, planner_blocks 16. Machine/Axis.h: 25 mm/s^2.
///   maslow4              MaslowCNC/Maslow_4, FluidNC/src. Kinematics/MaslowKinematics.cpp,
///                        cartesian_to_motors: pieces of at most maxSegmentLength (5 mm by default),
///                        belts linear within a piece; a move of no length stays where it is. The
///                        rest is FluidNC's. Its axes' accelerations are a machine's own settings.
///
/// Arcs: firmware_arc.hpp.
#pragma once

#include <optional>

#include "model/controllers/payout.hpp"
#include "model/machine.hpp"

namespace chaintrue::gcode {

/// How arcs are cut (firmware_arc.hpp).
enum class ArcRule { exact, maslow, grbl };

struct Firmware {
  model::ControllerKind kind = model::ControllerKind::ideal;
  const char* name = "ideal";
  bool single_precision = false;
  /// A new position every tick; 0: as fine as one likes.
  double tick_s = 0.0;
  /// Chain lengths run linearly through pieces of about this length; 0: the commanded line is
  /// followed.
  double chain_linear_piece_mm = 0.0;
  /// At most of that length; otherwise at least.
  bool pieces_at_most = false;
  /// Targets beyond half the believed bed are clamped without a word.
  bool clamps_to_bed = false;
  /// Knows G43 H. The others pass over it, or stop there.
  bool tool_lengths = false;
  /// Moves that are planned ahead, and what speed is taken back with (its default).
  int planned_moves = 0;
  double acceleration_mm_per_s2 = 0.0;
  /// What it does to a code that it does not know.
  const char* unknown = "";
  ArcRule arcs = ArcRule::exact;
  /// A move of no length goes somewhere else.
  bool phantom_moves = false;
};

[[nodiscard]] const Firmware& firmware(model::ControllerKind kind);
/// Of a Maslow 4. Its kind is that of the FluidNC that it is built on, whose codes it has; its
/// kinematics are model/belts/belt_controller.hpp.
[[nodiscard]] const Firmware& firmware_of_four_belts();

/// Into how many pieces, linear in chain length, it cuts a command of that length.
[[nodiscard]] double pieces_of(const Firmware& firmware, double length_mm);

/// The code that it takes a code for ('G' or 'M', in tenths: G38.2 is 382).
[[nodiscard]] int taken_for(const Firmware& firmware, char letter, int tenths);
/// Whether it acts on the code that it takes this one for.
[[nodiscard]] bool knows_code(const Firmware& firmware, char letter, int tenths);

/// Half the width and height that the controller clamps to; empty where it does not clamp.
struct ClampBox {
  double half_width_mm = 0.0;
  double half_height_mm = 0.0;
};
[[nodiscard]] std::optional<ClampBox> clamp_box(const model::Machine& machine);

/// A straight command as the controller runs it.
class CommandWay {
 public:
  /// Keeps references.
  /// \param doubt_mm taken off the command's length (its numbers will be rounded) before the
  /// controller's pieces are counted.
  CommandWay(const Firmware& firmware,
             const model::ControllerKinematics& kinematics,
             model::BedPoint from,
             model::BedPoint to,
             double doubt_mm = 0.0);

  /// Pieces that are linear in chain length; 1 where the controller follows the line.
  [[nodiscard]] int pieces() const { return pieces_; }
  /// The commanded point that stands for where the controller is at the fraction t: on the line,
  /// or, where it interpolates chain lengths, where equal lengths would be commanded. Empty where
  /// its own kinematics fail.
  [[nodiscard]] std::optional<model::BedPoint> at(double t);

 private:
  [[nodiscard]] model::BedPoint on_line(double t) const {
    return {from_.x_mm + t * (to_.x_mm - from_.x_mm), from_.y_mm + t * (to_.y_mm - from_.y_mm)};
  }

  const Firmware& firmware_;
  const model::ControllerKinematics& kinematics_;
  model::BedPoint from_;
  model::BedPoint to_;
  int pieces_ = 1;
  int piece_ = -1;  // whose ends are known
  std::optional<model::ChainLengths> start_;
  std::optional<model::ChainLengths> end_;
};

}  // namespace chaintrue::gcode
