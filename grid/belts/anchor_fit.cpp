// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/anchor_fit.hpp"

#include <algorithm>

#include "grid/plane_vectors.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::belts {

AnchorVector anchors_of(const BeltMachine& machine) {
  const auto& a = machine.anchors;
  return {a.tl.x_mm, a.tl.y_mm, a.tr.x_mm, a.tr.y_mm, a.br.x_mm};
}

BeltMachine with_anchors(BeltMachine machine, const AnchorVector& a) {
  machine.anchors.tl.x_mm = a[0];
  machine.anchors.tl.y_mm = a[1];
  machine.anchors.tr.x_mm = a[2];
  machine.anchors.tr.y_mm = a[3];
  machine.anchors.br.x_mm = a[4];
  machine.anchors_known = true;
  return machine;
}

bool are_on_a_line(const std::vector<FramePoint>& places) {
  constexpr double kLineMm = 50.0;
  Matrix2Xd at(2, std::ssize(places));
  for (const auto k : each_index(places)) {
    at.col(as_index(k)) = vector_of(places[k]);
  }
  at.colwise() -= at.rowwise().mean().eval();
  const linear::SymmetricEigen axes(at * at.transpose());
  const RowVectorXd widths = axes.eigenvectors().col(0).transpose() * at;
  return widths.maxCoeff() - widths.minCoeff() < kLineMm;
}

Index checks_of(const Counting& counting) {
  Index checks = -kAnchorUnknowns;
  for (const auto& counts : counting) checks += std::max(readings_counting(counts) - 2, 0);
  return checks;
}

}  // namespace chaintrue::grid::belts
