// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/anchor_fit.hpp"

#include <algorithm>

namespace chaintrue::grid::belts {

AnchorVector anchors_of(const model::BeltMachine& machine) {
  const auto& a = machine.anchors;
  return {a.tl.x_mm, a.tl.y_mm, a.tr.x_mm, a.tr.y_mm, a.br.x_mm};
}

model::BeltMachine with_anchors(model::BeltMachine machine, const AnchorVector& a) {
  machine.anchors.tl.x_mm = a[0];
  machine.anchors.tl.y_mm = a[1];
  machine.anchors.tr.x_mm = a[2];
  machine.anchors.tr.y_mm = a[3];
  machine.anchors.br.x_mm = a[4];
  machine.anchors_known = true;
  return machine;
}

Eigen::Index checks_of(const Counting& counting) {
  Eigen::Index checks = -kAnchorUnknowns;
  for (const auto& counts : counting) checks += std::max(readings_counting(counts) - 2, 0);
  return checks;
}

}  // namespace chaintrue::grid::belts
