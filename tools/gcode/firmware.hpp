// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a controller goes from one commanded point to the next: its number format, its stepping, and
/// what it does to targets beyond its sheet. (What chain lengths it pays out for a point is
/// model/controllers/payout.hpp.)
///
/// Sources, by file of the firmware:
///   maslow_classic  MaslowCNC/Firmware Motion.cpp (coordinatedMove: a position every LOOPINTERVAL,
///                   10000 us, float, one move after the other; arc: a line below 0.08 rad),
///                   Kinematics.cpp (_verifyValidTarget clamps to half the bed), GCode.cpp
///                   (executeGcodeLine, executeMcodeLine: what is known, the rest is ignored)
///   holey           taken to move as maslow_classic does: no source of its own was found
///   fluidnc_wallplotter  bdring/FluidNC WallPlotter.cpp (cartesian_to_motors: pieces of
///                   segment_length, 10 mm by default, chain lengths linear within a piece, summed
///                   up in float), MachineConfig.h (arc_tolerance 0.002 mm, planner_blocks 16),
///                   Axis.h (acceleration 25 mm/s^2), arcs as in gnea/grbl 1.1 motion_control.c
///                   (mc_arc: chords by $12, 0.002 mm), planner.h (BLOCK_BUFFER_SIZE 16), codes as
///                   in gcode.c; N_ARC_CORRECTION bounds the error of a chord's rotation: by
///                   its formula in float 1.4e-4 mm at a radius of 1 mm, 1.5e-3 mm at 0.1 mm,
///                   1.6e-4 mm at 500 mm over a full circle; it is not simulated
#pragma once

#include <optional>

#include "model/controllers/payout.hpp"
#include "model/machine.hpp"

namespace chaintrue::gcode {

struct Firmware {
  model::ControllerKind kind = model::ControllerKind::ideal;
  const char* name = "ideal";
  bool single_precision = false;
  /// A new position every tick; 0: as fine as one likes.
  double tick_s = 0.0;
  /// Chain lengths run linearly through pieces of about this length; 0: the commanded line is
  /// followed.
  double chain_linear_piece_mm = 0.0;
  /// Targets beyond half the believed bed are clamped without a word.
  bool clamps_to_bed = false;
  /// Knows G43 H. The others pass over it, or stop there.
  bool tool_lengths = false;
  /// Moves that are planned ahead, and what speed is taken back with (its default).
  int planned_moves = 0;
  double acceleration_mm_per_s2 = 0.0;
  /// What it does to a code that it does not know.
  const char* unknown = "";
  /// Arcs become chords that stay this close (grbl's $12, FluidNC's arc_tolerance_mm); 0: arcs.
  double arc_chord_mm = 0.0;
  /// Arcs that turn by less are cut as one straight line.
  double straight_arc_rad = 0.0;
};

[[nodiscard]] const Firmware& firmware(model::ControllerKind kind);

/// Whether it acts on a code ('G' or 'M', in tenths: G38.2 is 382).
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
