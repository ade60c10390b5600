// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A controller and its machine, simulated: the tool's track for the moves of a program.
///
/// Numbers are taken in the controller's own format; its way between two commands, and what it
/// makes of an arc, are its own (firmware.hpp); the machine is the map backwards, with play if
/// there is any. Nothing of what compensating computes is used.
#pragma once

#include <functional>
#include <optional>

#include "tools/gcode/events.hpp"
#include "tools/gcode/tool_field.hpp"

namespace chaintrue::gcode {

class SimulatedMachine {
 public:
  struct Options {
    model::ChainLengths half_play_mm;
    /// Between two places that are visited the tool leaves their chord by less than this.
    double flatness_mm = 5e-4;
    /// What interpolating the map may cost; see ToolField.
    double field_bound_mm = 2.5e-4;
    /// Of rapids only the ends are visited.
    bool rapids_whole = false;
  };
  /// A place of the tool, and the commanded place that led to it. False ends the move there.
  using Visit = std::function<bool(Point tool, Point command)>;

  /// Keeps the reference.
  SimulatedMachine(const Corrector& corrector, const Options& options)
      : corrector_(corrector),
        options_(options),
        field_(corrector, options.field_bound_mm),
        play_(options.half_play_mm.left_mm != 0.0 || options.half_play_mm.right_mm != 0.0) {}

  /// Where the tool is when the controller believes to stand at `command`.
  [[nodiscard]] Result<Point> place(Point command, std::size_t line);
  /// Visits the places behind the move's start, up to its end.
  [[nodiscard]] Result<void> run(const Move& move, const Visit& visit);
  /// By how much the controller's last tick of a command has overshot its end, at most.
  [[nodiscard]] double tick_overshoot_mm() const { return tick_overshoot_mm_; }

 private:
  [[nodiscard]] Point as_read(Point point) const;
  [[nodiscard]] Result<Point> tool(Point command, std::size_t line);
  Result<bool> straight(Point from, Point to, std::size_t line, const Visit& visit);
  Result<bool> chain_linear(Point from, Point to, std::size_t line, const Visit& visit);
  Result<bool> arc(const Move& move, const Visit& visit);
  void count_ticks(const Move& move);

  const Corrector& corrector_;
  Options options_;
  ToolField field_;
  bool play_;
  std::optional<double> left_mm_;  // of the chains behind the play
  std::optional<double> right_mm_;
  double tick_overshoot_mm_ = 0.0;
};

}  // namespace chaintrue::gcode
