// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a controller moves from one commanded point to the next: its number format, its stepping, and
/// its treatment of targets outside its sheet. (Its chain lengths for a point are in
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
///                        cnc_ctrl_v1, the same files and functions with the same behaviour.
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
///   marlin               MarlinFirmware/Marlin, Marlin/src/module/motion.cpp,
///                        line_to_destination_kinematic: as many pieces as a move has fifths of a second
///                        (DEFAULT_SEGMENTS_PER_SECOND 5 of a POLARGRAPH), cut to a whole number, belts
///                        linear within a piece. G0 goes at the F in force, 1500 mm/min at first. Codes:
///                        gcode/gcode.cpp with the options of a plotter; an unknown one is answered
///                        "Unknown command" and ignored. Its arcs, chords of 1 mm, are taken as exact.
///
///   mural                nikivanov/mural, src/tasks/interpolatingmovementtask.cpp: pieces of 1 mm, belts
///                        linear within a piece, in double. It draws pictures.
///   polargraph           euphy/polargraph_server_a1, exec.ino, exec_drawBetweenPoints: pieces of at most
///                        maxSegmentLength along the longer axis, 2 as its controller sends it, in float.
///                        It draws pictures.
///
/// Arcs of an uncompensated program (firmware_arc.cpp):
///
///   ArcRule::maslow  Motion.cpp, arc (MaslowCNC/Firmware and madgrizzle/OpticalFirmware): on the
///                    radius of the start, through an angle that is made of atan2 and 2 x 3.1415,
///                    then to the end; P is not read. One straight line instead where the "chord
///                    height" r - sqrt(r^2 - c/4), c the chord (not squared), is below 0.01 and the
///                    angle below 0.5 rad, or where r is beyond 25400 mm.
///   ArcRule::grbl    MotionControl.cpp, mc_arc (FluidNC, as in grbl 1.1): n = floor(|a| r / 2 /
///                    sqrt(h (2 r - h))) chords, h = arc_tolerance, on the radius of the start; each
///                    turned from the one before by cos = 1 - b^2/2, sin = b (4 + 2 cos)/6 in float,
///                    after every N_ARC_CORRECTION (12) of them exactly; the last goes to the end.
///                    P is an error (36).
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "model/controllers/payout.hpp"
#include "model/machine.hpp"
#include "model/plotter/plotter_controller.hpp"
#include "tools/gcode/events.hpp"

namespace chaintrue::gcode {

/// How arcs are cut.
enum class ArcRule { exact, maslow, grbl };

struct Firmware {
  const char* name = "ideal";
  bool single_precision = false;
  /// A new position every tick; 0: continuous.
  double tick_s = 0.0;
  /// Chain lengths are linear over pieces of about this length; 0: the commanded line is followed.
  double chain_linear_piece_mm = 0.0;
  /// The length is an upper bound; otherwise a lower bound.
  bool pieces_at_most = false;
  /// In place of a length: chain lengths are linear over pieces, so many a second; 0: by length.
  double pieces_per_second = 0.0;
  /// The feed until a program states one.
  double first_feed_mm_per_min = 0.0;
  /// The codes that it implements, each between blanks; empty: every code.
  std::string_view codes;
  /// Targets outside half the set bed are clamped without a message.
  bool clamps_to_bed = false;
  /// Implements G43 H. The others ignore it or stop.
  bool tool_lengths = false;
  /// Number of moves planned ahead, and the default deceleration.
  int planned_moves = 0;
  double acceleration_mm_per_s2 = 0.0;
  /// Its treatment of an unknown code.
  const char* unknown = "";
  ArcRule arcs = ArcRule::exact;
  /// A move of zero length goes to another position.
  bool phantom_moves = false;
  /// A comment begins with a semicolon, and a line has one code.
  bool semicolon_comments = false;
  /// False: it is sent pictures.
  bool reads_gcode = true;
};

const Firmware& firmware(model::ControllerKind kind);
/// The firmware of a Maslow 4: FluidNC, on which it is based, with other kinematics
/// (model/belts/belt_controller.hpp).
const Firmware& firmware_of_four_belts();

/// The firmware of a V-plotter.
const Firmware& firmware(model::PlotterFirmware plotter);

/// Whether it interpolates chain lengths, in pieces of a command.
bool is_chain_linear(const Firmware& firmware);
/// Number of pieces, linear in chain length, for a command of that length at that feed.
double pieces_of(const Firmware& firmware, double length_mm, double feed_mm_per_min);

/// The code that it executes for a code.
Code taken_for(const Firmware& firmware, Code code);
/// Whether it implements the code that it executes for this one.
bool knows_code(const Firmware& firmware, Code code);

/// Half the width and height that the controller clamps to; empty if it does not clamp.
struct ClampBox {
  double half_width_mm = 0.0;
  double half_height_mm = 0.0;
};
std::optional<ClampBox> clamp_box(const model::Machine& machine);

/// Whether an arc of this radius and angle (of one turn at most, no sign) becomes a straight line.
bool cuts_straight(const Firmware& firmware, double radius_mm, double sweep_rad);

/// The ends of the straight moves that an arc becomes, in order; the last is the arc's end. Stops if
/// `visit` returns false.
/// \param bow_mm the largest deviation of the chords if the controller follows the arc itself
void for_each_chord(const Firmware& firmware, const Move& arc, double bow_mm,
                    const std::function<bool(Point)>& visit);

/// The path of a straight command in the controller.
class CommandWay {
 public:
  /// Keeps references.
  /// \param feed_mm_per_min of the command; 0: none was stated.
  /// \param doubt_mm subtracted from the command's length (its numbers will be rounded) before the
  /// controller's pieces are counted.
  CommandWay(const Firmware& firmware, const model::ControllerKinematics& kinematics, Point from,
             Point to, double feed_mm_per_min, double doubt_mm = 0.0);

  /// Pieces that are linear in chain length; 1 if the controller follows the line.
  int pieces() const { return pieces_; }
  /// The commanded point that is equivalent to the controller's position at the fraction t: on the
  /// line, or, if it interpolates chain lengths, the point with the same lengths. Empty if its own
  /// kinematics fail.
  std::optional<Point> at(double t);

 private:
  const Firmware& firmware_;
  const model::ControllerKinematics& kinematics_;
  Point from_;
  Point to_;
  int pieces_ = 1;
  int piece_ = -1;  // whose ends are computed
  std::optional<model::ChainLengths> start_;
  std::optional<model::ChainLengths> end_;
};

}  // namespace chaintrue::gcode
