// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Positions of the holes' names in a drawing, so that none can be read as a neighbour's: a label
/// is nearer to its hole than to any other and covers no label and no hole. A label has a name and
/// a place, "A (-1118, 509)". If no position fits both, the place is omitted; it is in the list
/// next to the drawing.
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
double distance_to(const HoleLabel& label, double x, double y);

/// One for each hole, between `left` and `right`. If holes are too close for any position, the one
/// with the least overlap.
std::vector<HoleLabel> place_labels(const std::vector<DrawnHole>& holes, double left, double right);

}  // namespace chaintrue::report
