// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reports on a program: without a map its bounding box, its moves, and the lines that leave the
/// sheet; with a map the chain lengths along its path, at the end of every move, and between, no
/// further apart than requested, at least eight per turn.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "grid/map/length_map.hpp"
#include "tools/gcode/program.hpp"

namespace chaintrue::gcode {

struct PathLengths {
  std::size_t line = 0;
  MoveKind kind = MoveKind::rapid;
  Point place;                   ///< on the sheet, mm
  grid::LengthsAnswer answer;    ///< the first two are paid out
  double feed_mm_per_min = 0.0;  ///< 0 for rapids
};

/// Writes the lengths at each point; points off the map become problems of `findings` instead, one
/// for each line of the program.
[[nodiscard]] Result<ProgramSummary> path_lengths(
    LineSource& source, const Dialect& dialect, const grid::LengthMap& map, double every_mm,
    const std::function<void(const PathLengths&)>& write, Findings& findings);

struct Box {
  Point least;
  Point most;
};

struct Sheet {
  interp::Rectangle area;
  bool is_assumed = false;  ///< not stated
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
[[nodiscard]] Result<Survey> survey(LineSource& source, const Dialect& dialect, const Sheet& sheet,
                                    Findings& findings);

}  // namespace chaintrue::gcode
