// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A program without a map: its bounding box, its moves, and the lines that leave the sheet.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/gcode/compensator.hpp"

namespace chaintrue::gcode {

struct Box {
  Point least;
  Point most;
};

struct Sheet {
  interp::Rectangle area;
  bool is_assumed = false;  ///< nobody has stated it
};

struct Survey {
  std::optional<Box> box;  ///< of the whole path, including the bulges of arcs
  std::uint64_t rapids = 0;
  std::uint64_t feeds = 0;
  std::uint64_t arcs = 0;
  std::uint64_t probes = 0;
  double path_mm = 0.0;
  std::optional<double> slowest_mm_per_min;
  std::optional<double> fastest_mm_per_min;
  ProgramSummary program;
};

/// \param sheet lines that leave it become problems (outside_sheet).
[[nodiscard]] Result<Survey> survey(LineSource& source,
                                    const Dialect& dialect,
                                    const Sheet& sheet,
                                    Findings& findings);

}  // namespace chaintrue::gcode
