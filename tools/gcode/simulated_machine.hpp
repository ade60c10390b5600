// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A simulated controller and machine: the tool's track for the moves of a program.
///
/// Numbers are converted to the controller's format; its path between two commands and its
/// treatment of arcs are those of firmware.hpp; the machine is the inverse of the map, with play if
/// there is any. Nothing that the compensation computes is used.
#pragma once

#include <functional>
#include <optional>

#include "interp/checked_field.hpp"
#include "tools/gcode/corrector.hpp"
#include "tools/gcode/events.hpp"

namespace chaintrue::gcode {

class SimulatedMachine {
 public:
  struct Options {
    model::ChainLengths half_play_mm;
    /// Between two visited points the tool is within this distance of their chord.
    double flatness_mm = 5e-4;
    /// Error bound of interpolating the map; docs/gcode.md states it as part of what verify proves.
    double field_bound_mm = 2.5e-4;
    /// Only the ends of rapids are visited.
    bool rapids_whole = false;
  };
  /// A point of the tool, and its commanded point. A return of false ends the move there.
  using Visit = std::function<bool(Point tool, Point command)>;

  /// Keeps a reference.
  SimulatedMachine(const Corrector& corrector, const Options& options)
      : corrector_(corrector),
        options_(options),
        field_(offsets_of_tool(corrector), {16.0, options.field_bound_mm}),
        play_(options.half_play_mm.left_mm != 0.0 || options.half_play_mm.right_mm != 0.0) {}

  /// The tool's position when the controller's position is `command`.
  Point place(Point command, std::size_t line);
  /// Visits the points after the move's start, up to its end. \throws Refusal
  void run(const Move& move, const Visit& visit);
  /// Largest overshoot of the controller's last tick of a command.
  double tick_overshoot_mm() const { return tick_overshoot_mm_; }

 private:
  Point as_read(Point point) const;
  Point tool(Point command, std::size_t line);
  /// Lengths of the chains when their motors have gone to these: a chain follows once its motor has
  /// crossed the gap.
  model::ChainLengths follow(model::ChainLengths motors);
  double straight_mm(Point command);
  bool straight(Point from, Point to, const Move& move, const Visit& visit);
  bool chain_linear(Point from, Point to, const Move& move, const Visit& visit);
  void arc(const Move& move, const Visit& visit);
  void count_ticks(const Move& move);

  const Corrector& corrector_;
  Options options_;
  interp::CheckedField field_;
  bool play_;
  model::PerSide<std::optional<double>> chains_mm_;  // after the play
  double tick_overshoot_mm_ = 0.0;
};

}  // namespace chaintrue::gcode
