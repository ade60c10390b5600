// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a program does, without a map: its box, its moves, and what leaves the sheet, by line.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/gcode/compensator.hpp"

namespace chaintrue::gcode {

struct Box {
  Point least;
  Point most;
};

struct Survey {
  std::optional<Box> box;  ///< of the whole path; arcs with their bulges
  std::uint64_t rapids = 0;
  std::uint64_t feeds = 0;
  std::uint64_t arcs = 0;
  std::uint64_t probes = 0;
  double path_mm = 0.0;
  std::optional<double> slowest_mm_per_min;
  std::optional<double> fastest_mm_per_min;
  ProgramSummary program;
};

/// \param sheet what may not be left; the offending lines become problems (outside_sheet).
[[nodiscard]] Result<Survey> survey(LineSource& source,
                                    const Dialect& dialect,
                                    model::BedPoint home,
                                    const interp::Rectangle& sheet,
                                    Findings& findings);

}  // namespace chaintrue::gcode
