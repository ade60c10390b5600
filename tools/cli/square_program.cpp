// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/square_program.hpp"

#include <fmt/format.h>

#include <iterator>

namespace chaintrue::cli {

namespace {

std::vector<BedPoint> corners_of(SquareTask task) {
  task.points_per_side = 2;
  return model::outline_of(task);
}

/// Each side's end is the next one's beginning.
std::string sides_text(const std::vector<BedPoint>& corners, double feed_mm_per_min) {
  std::string text;
  for (std::size_t i = 1; i < corners.size(); i += 2) {
    fmt::format_to(std::back_inserter(text),
                   "G1 X{:.3f} Y{:.3f} F{:g}\n",
                   corners[i].x_mm,
                   corners[i].y_mm,
                   feed_mm_per_min);
  }
  return text;
}

}  // namespace

std::string square_program(const SquareTask& task, double depth_mm) {
  // High above the sheet between cuts, and slow enough for any hanging router.
  constexpr double kClearanceMm = 5.0;
  constexpr double kFeedMmPerMin = 600.0;
  constexpr int kPlungeMmPerMin = 150;
  const std::vector<BedPoint> corners = corners_of(task);
  const std::string text = fmt::format(
      "(chaintrue square: {:g} mm, {:g} mm deep)\n(Zero is the middle of the bed.)\nG21 G90 G17 "
      "G94\nG0 Z{:g}\nG0 X{:.3f} Y{:.3f}\nG1 Z{:g} F{}\n",
      task.size_mm,
      depth_mm,
      kClearanceMm,
      corners.front().x_mm,
      corners.front().y_mm,
      -depth_mm,
      kPlungeMmPerMin);
  return text + sides_text(corners, kFeedMmPerMin) +
         fmt::format("G0 Z{:g}\nG0 X0 Y0\nM2\n", kClearanceMm);
}

std::string square_program(const SquareTask& task, const grid::SetPlotter& plotter) {
  const std::vector<BedPoint> corners = corners_of(task);
  return fmt::format("; chaintrue square: {:g} mm\nG21\nG90\n{}\nG0 X{:.3f} Y{:.3f}\n{}\n",
                     task.size_mm,
                     plotter.pen.up,
                     corners.front().x_mm,
                     corners.front().y_mm,
                     plotter.pen.down) +
         sides_text(corners, plotter.feed_mm_per_min) + plotter.pen.up + "\n";
}

}  // namespace chaintrue::cli
