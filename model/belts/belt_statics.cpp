// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: belt_statics.hpp.
#include "model/belts/belt_statics.hpp"

#include <stdexcept>

namespace chaintrue::model::belts {
namespace {

struct Level {
  AnchorNumber x, y;
};

AnchorNumber dot(const Level& a, const Level& b) { return a.x * b.x + a.y * b.y; }

/// u of a belt; 0 if its anchors leave no room for one.
Level unit_pull(const BeltMachine& machine, Belt belt, FramePoint place) {
  const Anchor& anchor = machine.anchors[belt];
  const auto first = static_cast<int>(first_of(belt));
  const Level way{AnchorNumber::variable(anchor.x_mm, first) - place.x_mm,
                  AnchorNumber::variable(anchor.y_mm, first + 1) - place.y_mm};
  const AnchorNumber span = sqrt(dot(way, way));
  const AnchorNumber level = span - reach_mm(machine);
  if (!(span.value > 0.0 && level.value > 0.0)) return {};
  const double c = height_mm(machine, belt);
  const AnchorNumber share = level / (sqrt(level * level + c * c) * span);
  return {share * way.x, share * way.y};
}

/// lambda = G^-1 f of (2), and along one line, where G has no inverse, f over its trace without
/// derivatives.
Level balance_of(const BeltMachine& machine, const PerBelt<Level>& pulls,
                 const PerBelt<bool>& pulled, double pull) {
  // Share of the squared trace: holding belts within 1e-4 rad of one line.
  constexpr double kOnOneLine = 1e-8;
  Level f{0.0, machine.orientation == Orientation::upright ? kWeightOverPull : 0.0};
  AnchorNumber xx, xy, yy;  // G
  for (const Belt belt : kBelts) {
    const Level& u = pulls[belt];
    if (pulled[belt]) {
      f = {f.x - pull * u.x, f.y - pull * u.y};
    } else {
      xx = xx + u.x * u.x;
      xy = xy + u.x * u.y;
      yy = yy + u.y * u.y;
    }
  }
  const double trace = xx.value + yy.value;
  const AnchorNumber determinant = xx * yy - xy * xy;
  if (determinant.value > kOnOneLine * trace * trace)
    return {(yy * f.x - xy * f.y) / determinant, (xx * f.y - xy * f.x) / determinant};
  if (trace > 0.0) return {f.x.value / trace, f.y.value / trace};
  return {};
}

/// Outside its range a tension does not follow the anchors.
AnchorNumber limited(const AnchorNumber& tension) {
  if (tension.value <= 0.0) return 0.0;
  return tension.value < kMostTension ? tension : kMostTension;
}

bool any(const PerBelt<bool>& of) { return of.tl || of.tr || of.bl || of.br; }

}  // namespace

PerBelt<AnchorNumber> tensions_of(const BeltMachine& machine, const PerBelt<bool>& pulled,
                                  double pull, FramePoint place) {
  if (!machine.anchors_known)
    throw std::logic_error("tensions of belts whose anchors are not known");
  PerBelt<AnchorNumber> tension;
  if (!any(pulled)) return tension;
  PerBelt<Level> pulls;
  for (const Belt belt : kBelts) pulls[belt] = unit_pull(machine, belt, place);
  const Level lambda = balance_of(machine, pulls, pulled, pull);
  for (const Belt belt : kBelts)
    tension[belt] = pulled[belt] ? AnchorNumber(pull) : limited(dot(pulls[belt], lambda));
  return tension;
}

}  // namespace chaintrue::model::belts
