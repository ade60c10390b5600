// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Canonical calls: those of LinuxCNC's interpreter for a program, ours, and their differences.
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
  /// For an arc: its plane's two axes in the machine frame, set by ours() only.
  std::array<std::array<double, 3>, 2> axes{};
  int plane = 0;
  int turns = 0;
  double feed_mm_per_min = 0.0;
  /// Allowed relative difference of feeds; set by ours() only.
  double feed_tolerance = 0.0;
  double value = 0.0;  ///< seconds of a dwell, number of a tool
  std::string state;   ///< of STATE
};

struct Answer {
  std::vector<Call> calls;
  bool accepted = false;
  bool unknown = false;  ///< LinuxCNC's module has no answer
  std::string refusal;   ///< the message
  std::string problem;   ///< its stable name; ours() only
  std::size_t problem_line = 0;
};

/// Parses an answer in the format of linuxcnc_moves.py.
Answer read_truth(std::string_view truth);

/// Our interpreter's answer to a program.
Answer ours(const std::string& program, gcode::Dialect dialect = {});

/// The first difference as a sentence; empty if there is none. Moves of zero length are left out.
/// Rejections count as equal for any reason; then only the calls before them are compared.
std::optional<std::string> difference(const Answer& linuxcnc, const Answer& here);

/// The same for unreviewed programs: leaves out the differences listed in docs/gcode.md: codes that
/// we reject as not supported, a loop or condition without its end, and cycles in a program without
/// G98 and G99.
std::optional<std::string> unlisted_difference(const std::string& program, const Answer& linuxcnc,
                                               const Answer& here);

}  // namespace chaintrue::witness
