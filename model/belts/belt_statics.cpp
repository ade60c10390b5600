// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: belt_statics.hpp.
#include "model/belts/belt_statics.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace chaintrue::model::belts {
namespace {

/// u of a belt, and d(u)/d(anchor).
struct UnitPull {
  Eigen::Vector2d u = Eigen::Vector2d::Zero();
  Eigen::Matrix2d by_anchor = Eigen::Matrix2d::Zero();
};

UnitPull unit_pull(const BeltMachine& machine, Belt belt, FramePoint place) {
  const Eigen::Vector2d way(machine.anchors[belt].x_mm - place.x_mm,
                            machine.anchors[belt].y_mm - place.y_mm);
  const double span = way.norm();
  const double level = span - reach_mm(machine);
  const double c = height_mm(machine, belt);
  const double length = std::hypot(level, c);
  if (!(span > 0.0 && level > 0.0)) return {};
  const Eigen::Vector2d along = way / span;
  const double share = level / length;
  // d(level/length)/d(level) = c^2 / length^3.
  const double share_slope = c * c / (length * length * length);
  const Eigen::Matrix2d across = Eigen::Matrix2d::Identity() - along * along.transpose();
  return {share * along, share_slope * along * along.transpose() + share / span * across};
}

/// f, G^-1 and lambda = G^-1 f from (2).
struct Balance {
  PerBelt<UnitPull> pulls;
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
  Eigen::Vector2d lambda = Eigen::Vector2d::Zero();
  bool regular = false;
};

Balance balance_of(const BeltMachine& machine,
                   const PerBelt<bool>& pulled,
                   double pull,
                   FramePoint place) {
  // Share of the squared trace: holding belts within 1e-4 rad of one line.
  constexpr double kOnOneLine = 1e-8;
  Balance balance;
  const double weight = machine.orientation == Orientation::upright ? kWeightOverPull : 0.0;
  Eigen::Vector2d f(0.0, weight);
  Eigen::Matrix2d g = Eigen::Matrix2d::Zero();
  for (const Belt belt : kBelts) {
    UnitPull& own = balance.pulls[belt];
    own = unit_pull(machine, belt, place);
    if (pulled[belt]) {
      f -= pull * own.u;
    } else {
      g += own.u * own.u.transpose();
    }
  }
  const double trace = g.trace();
  balance.regular = g.determinant() > kOnOneLine * trace * trace;
  if (balance.regular) {
    balance.inverse = g.inverse();
    balance.lambda = balance.inverse * f;
  } else if (trace > 0.0) {
    balance.lambda = f / trace;
  }
  return balance;
}

double limited(double tension) { return std::clamp(tension, 0.0, kMostTension); }

bool any(const PerBelt<bool>& of) { return of.tl || of.tr || of.bl || of.br; }

}  // namespace

PerBelt<double> tensions_of(const BeltMachine& machine,
                            const PerBelt<bool>& pulled,
                            double pull,
                            FramePoint place) {
  if (!machine.anchors_known)
    throw std::logic_error("tensions of belts whose anchors are not known");
  PerBelt<double> tension;
  if (!any(pulled)) return tension;
  const Balance balance = balance_of(machine, pulled, pull, place);
  for (const Belt belt : kBelts) {
    tension[belt] =
        pulled[belt] ? pull : limited(balance.pulls[belt].u.dot(balance.lambda));
  }
  return tension;
}

BeltTensions tensions_at(const BeltMachine& machine,
                         const PerBelt<bool>& pulled,
                         double pull,
                         FramePoint place) {
  BeltTensions result;
  result.tension = tensions_of(machine, pulled, pull, place);
  for (const Belt belt : kBelts) {
    for (const Belt anchor : kBelts) result.by_anchor[belt][anchor].setZero();
  }
  if (!any(pulled)) return result;
  const Balance balance = balance_of(machine, pulled, pull, place);
  if (!balance.regular) return result;
  for (const Belt anchor : kBelts) {
    const UnitPull& moved = balance.pulls[anchor];
    // d(lambda)/d(anchor): through f for a belt that is pulled, through G for one that holds.
    const Eigen::Matrix2d by_lambda =
        pulled[anchor] ? Eigen::Matrix2d(-pull * balance.inverse * moved.by_anchor)
                       : Eigen::Matrix2d(-balance.inverse *
                                         (moved.by_anchor * moved.u.dot(balance.lambda) +
                                          moved.u * (balance.lambda.transpose() * moved.by_anchor)));
    for (const Belt belt : kBelts) {
      const double tension = result.tension[belt];
      if (pulled[belt] || tension <= 0.0 || tension >= kMostTension) continue;
      result.by_anchor[belt][anchor] = balance.pulls[belt].u.transpose() * by_lambda;
      if (belt == anchor)
        result.by_anchor[belt][anchor] += balance.lambda.transpose() * moved.by_anchor;
    }
  }
  return result;
}

}  // namespace chaintrue::model::belts
