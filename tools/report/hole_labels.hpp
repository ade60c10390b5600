// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the names of holes stand in a drawing, so that none can be read as a neighbour's: a label is
/// nearer to its own hole than to any other and lies on no label and no hole.
///
/// A label has a name and a place, "A (-1118, 509)". Where no position for both keeps to that, the place
/// is left out; the list next to the drawing has it.
#pragma once

#include <string>
#include <vector>

namespace chaintrue::report {

/// A hole in the units of the drawing, y downwards.
struct DrawnHole {
  double x = 0.0;
  double y = 0.0;
  std::string name{};
  std::string place{};
};

struct HoleLabel {
  double left = 0.0;
  double right = 0.0;
  double top = 0.0;
  double bottom = 0.0;
  bool has_place = true;
};

/// From a point to the nearest point of a label; 0 inside.
[[nodiscard]] double distance_to(const HoleLabel& label, double x, double y);

/// One for each hole, between `left` and `right`. Where holes are too near each other for any position
/// it is the one that overlaps least.
[[nodiscard]] std::vector<HoleLabel> place_labels(const std::vector<DrawnHole>& holes,
                                                  double left,
                                                  double right);

}  // namespace chaintrue::report
