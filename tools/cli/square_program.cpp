// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/square_program.hpp"

#include <fmt/format.h>

#include <iterator>

namespace chaintrue::cli {

std::string square_program(const model::SquareTask& task, double depth_mm) {
  // High above the sheet between cuts, and slow enough for any hanging router.
  constexpr double kClearanceMm = 5.0;
  constexpr int kFeedMmPerMin = 600;
  constexpr int kPlungeMmPerMin = 150;
  model::SquareTask corners_alone = task;
  corners_alone.points_per_side = 2;
  const std::vector<model::BedPoint> corners = model::outline_of(corners_alone);
  std::string text = fmt::format(
      "(chaintrue square: {:g} mm, {:g} mm deep)\n(Zero is the middle of the bed.)\nG21 G90 G17 "
      "G94\nG0 Z{:g}\nG0 X{:.3f} Y{:.3f}\nG1 Z{:g} F{}\n",
      task.size_mm,
      depth_mm,
      kClearanceMm,
      corners.front().x_mm,
      corners.front().y_mm,
      -depth_mm,
      kPlungeMmPerMin);
  // Each side's end is the next one's beginning.
  for (std::size_t i = 1; i < corners.size(); i += 2) {
    fmt::format_to(std::back_inserter(text),
                   "G1 X{:.3f} Y{:.3f} F{}\n",
                   corners[i].x_mm,
                   corners[i].y_mm,
                   kFeedMmPerMin);
  }
  return text + fmt::format("G0 Z{:g}\nG0 X0 Y0\nM2\n", kClearanceMm);
}

}  // namespace chaintrue::cli
