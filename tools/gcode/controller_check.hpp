// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parts of an uncompensated program that an unmodified controller cannot execute.
#pragma once

#include <map>
#include <string>
#include <utility>

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
  bool goes_on_after(const Problem&) override { return true; }

 private:
  /// In the order in which they are reported.
  enum class Kind {
    unknown_code,
    misread_code,
    straight_arc,
    upright_arc,
    arc_turns,
    no_length,
    short_tick,
    short_plan,
  };
  struct Occurrences {
    std::size_t line = 0;
    std::size_t count = 0;
    double worst = 0.0;
  };
  void add(Kind kind, std::size_t line, double size = 0.0, std::string codes = {});
  void arc(const Move& move);

  const Firmware& firmware_;
  Findings& findings_;
  std::map<std::pair<Kind, std::string>, Occurrences> observed_;
};

}  // namespace chaintrue::gcode
