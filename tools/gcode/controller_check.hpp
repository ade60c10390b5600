// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parts of an uncompensated program that an unmodified controller cannot execute.
#pragma once

#include <map>
#include <string>

#include "tools/gcode/firmware.hpp"

namespace chaintrue::gcode {

/// Use as the sink of a program; the notes are made at the program's end, each with its first line
/// and the number of occurrences.
class ControllerCheck final : public Sink {
 public:
  /// Keeps references.
  ControllerCheck(const Firmware& firmware, Findings& findings)
      : firmware_(firmware), findings_(findings) {}

  void code(std::size_t line, Code code) override;
  void move(const Move& move) override;
  void end(std::size_t line, std::string_view word) override;
  [[nodiscard]] bool goes_on_after(const Problem&) override { return true; }

 private:
  void arc(const Move& move);

  struct Occurrences {
    std::size_t line = 0;
    std::size_t count = 0;
    double worst = 0.0;
    void add(std::size_t where, double size = 0.0);
  };

  const Firmware& firmware_;
  Findings& findings_;
  std::map<std::string, Occurrences> unknown_;
  std::map<std::string, Occurrences> misread_;
  Occurrences straight_arcs_;
  Occurrences upright_arcs_;
  Occurrences arc_turns_;
  Occurrences no_length_;
  Occurrences short_ticks_;
  Occurrences short_plans_;
};

}  // namespace chaintrue::gcode
