// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Canonical calls: what LinuxCNC's interpreter says of a program, what ours says, and where they
/// differ.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/gcode/interpreter.hpp"

namespace chaintrue::witness {

/// One call, as linuxcnc_moves.py describes it. Lengths in mm in the machine frame.
struct Call {
  std::string kind;  ///< RAPID, FEED, ARC, PROBE, DWELL, TOOL or STATE
  std::size_t line = 0;
  std::array<double, 3> to{};
  std::array<double, 3> centre{};
  /// Of an arc: its plane's two axes in the machine frame, filled by ours() alone.
  std::array<std::array<double, 3>, 2> axes{};
  int plane = 0;
  int turns = 0;
  double feed_mm_per_min = 0.0;
  /// How far feeds may differ, relatively; ours() alone says it.
  double feed_tolerance = 0.0;
  double value = 0.0;  ///< seconds of a dwell, number of a tool
  std::string state;   ///< of STATE
};

struct Answer {
  std::vector<Call> calls;
  bool accepted = false;
  bool unknown = false;      ///< LinuxCNC's module cannot know
  std::string refusal;       ///< the sentence
  std::string problem;       ///< its stable name; ours alone
  std::size_t problem_line = 0;
};

/// Of a truth as linuxcnc_moves.py writes it.
[[nodiscard]] Answer read_truth(std::string_view truth);

/// What our interpreter makes of a program.
[[nodiscard]] Answer ours(const std::string& program, const gcode::Dialect& dialect = {});

/// The first difference in a sentence, or nothing. Moves that go nowhere are left out. Refusals agree
/// whatever their reasons, and then only the calls that both made before are compared.
[[nodiscard]] std::optional<std::string> difference(const Answer& linuxcnc, const Answer& here);

/// The same for programs that nobody has looked at: leaves out what docs/gcode.md lists as different.
/// That is: what we know and refuse as not supported, a loop or condition without its end, and cycles
/// in a program that says neither G98 nor G99.
[[nodiscard]] std::optional<std::string> unlisted_difference(const std::string& program,
                                                             const Answer& linuxcnc,
                                                             const Answer& here);

}  // namespace chaintrue::witness
