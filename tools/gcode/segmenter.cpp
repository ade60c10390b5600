// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Greedy longest chords. The deviation grows with the square of a chord's length, which predicts
/// the next trial.
#include "tools/gcode/segmenter.hpp"

#include <algorithm>
#include <cmath>

#include "grid/precondition.hpp"

namespace chaintrue::gcode {
namespace {

/// Upper bound of the tool's path length relative to the commanded one (the steepest corrections
/// allowed are far smaller): a chord's deviation is measured in commands, but the tolerance holds
/// at the tool.
constexpr double kStretch = 1.05;
/// Short straight moves are not checked if their bow is less than this share of the tolerance, by
/// the sampled curvature and kCurvatureSafety.
constexpr double kUncheckedShare = 0.25;
/// Share of the tolerance for verify's own errors, and for the chords' deviation between the points
/// where they are checked.
constexpr double kSpare = 0.045;
/// A chord is accepted if its deviation is this share of the tolerance: sqrt(0.85) = 0.92 of the
/// longest.
constexpr double kGoodEnough = 0.85;
/// Target of the next trial, as a share of the tolerance.
constexpr double kAim = 0.93;
constexpr int kMostTrials = 12;
/// Chords are checked at least this densely: measured residual surfaces have no shorter
/// wavelengths.
constexpr double kCheckEveryMm = 30.0;
constexpr int kFewestChecks = 6;
/// Rounding changes a command's length by less, at two decimals and more.
constexpr double kRoundingMm = 0.02;
/// Half a unit of single precision below 2048 mm, in X and Y: of a word, with a margin, and of each
/// piece of a controller that sums them.
constexpr double kSinglePrecisionMm = 0.5 * 1.25e-4 * 1.5;
constexpr double kPieceRoundingMm = 0.5 * 1.2207e-4 * 1.4143;
/// Chords are not divided below this: output has three decimals.
constexpr double kShortestMm = 0.002;

/// Half a unit of the last decimal, in X, Y and Z.
double rounding_mm(int decimals) { return 0.5 * std::sqrt(3.0) * std::pow(10.0, -decimals); }

/// From the controller's path.
Corrected<double> deviation_from(CommandWay& way, bool own_way, const Curve& curve,
                                 const PathSample& a, const PathSample& b, double length_mm) {
  int checks = std::max(kFewestChecks,
                        static_cast<int>(std::min(1e4, std::ceil(length_mm / kCheckEveryMm))));
  // Each of the controller's pieces bows: the worst point is in the middle of one, or between two.
  if (own_way) checks = 2 * way.pieces() * ((checks + 2 * way.pieces() - 1) / (2 * way.pieces()));
  double worst = 0.0;
  double behind = 0.0;
  for (int i = own_way ? 1 : 0; i < checks; ++i) {
    // Unequal spacing otherwise, so that no wave of the surface is missed by all checks.
    const double share = (i + (own_way ? 0.0 : 0.5 + 0.118 * (i % 3 - 1))) / checks;
    const auto sample = curve(a.t + share * (b.t - a.t));
    if (!sample) return tl::unexpected(sample.error());
    // The tool does not move back along its chord; where the curve does, that counts as deviation.
    const double u = std::max(behind, nearest_on_line(a.command, b.command, sample->command));
    behind = u;
    const auto on_way = way.at(u);
    if (!on_way) return tl::unexpected(CorrectionReason::controller);
    worst = std::max(worst, distance_mm(sample->command, *on_way));
  }
  // FluidNC sums its pieces in single precision.
  return own_way ? worst + way.pieces() * kPieceRoundingMm : worst;
}

}  // namespace

double least_tolerance_mm(int decimals) {
  return (rounding_mm(decimals) + kSinglePrecisionMm) / (1.0 - kSpare);
}

Segmenter::Segmenter(const Corrector& corrector, double tolerance_mm, int decimals)
    : corrector_(corrector) {
  const Firmware& firmware = corrector.firmware();
  const double rounding =
      rounding_mm(decimals) + (firmware.single_precision ? kSinglePrecisionMm : 0.0);
  tolerance_mm_ = ((1.0 - kSpare) * tolerance_mm - rounding) / kStretch;
  if (!(tolerance_mm_ > 0.0)) {
    throw grid::precondition("a tolerance of {} mm is used up by rounding to {} decimals",
                             tolerance_mm, decimals);
  }
  if (is_chain_linear(firmware)) return;
  const double curvature = kCurvatureSafety * corrector.sampled_curvature_per_mm();
  unchecked_mm_ = std::sqrt(8.0 * kUncheckedShare * tolerance_mm_ / std::max(curvature, 1e-9));
}

Corrected<double> Segmenter::deviation_mm(const Curve& curve, const PathSample& a,
                                          const PathSample& b, double length_mm,
                                          double feed_mm_per_min) const {
  const auto way = [&](double doubt_mm) {
    return CommandWay(corrector_.firmware(), corrector_.kinematics(), a.command, b.command,
                      feed_mm_per_min, doubt_mm);
  };
  // If rounding decides the number of the controller's pieces, both numbers must be within the
  // tolerance: a piece's bow may be on the curve's side of the chord or on the other.
  CommandWay fewer = way(kRoundingMm);
  CommandWay more = way(-kRoundingMm);
  const bool own_way = is_chain_linear(corrector_.firmware());
  const auto first = deviation_from(fewer, own_way, curve, a, b, length_mm);
  if (!first || more.pieces() == fewer.pieces()) return first;
  const auto second = deviation_from(more, own_way, curve, a, b, length_mm);
  return second ? std::max(*first, *second) : second;
}

Corrected<void> Segmenter::run(const Curve& curve, const PathSample& start, double end,
                               Extent extent, const std::function<void(const PathSample&)>& visit) {
  const double length_mm = extent.length_mm;
  const double per_mm = length_mm > 0.0 ? (end - start.t) / length_mm : 0.0;
  PathSample a = start;
  while (a.t < end) {
    // The end of the longest allowed command.
    const double furthest =
        per_mm > 0.0 ? std::min(end, a.t + extent.longest_mm * per_mm * (1.0 + 1e-9)) : end;
    double reach = per_mm > 0.0 ? std::min(furthest, a.t + last_step_mm_ * per_mm) : end;
    // A remainder this short after a sample is not sampled.
    PathSample best;
    double best_share = 0.0;
    for (int trial = 0; trial < kMostTrials; ++trial) {
      const auto b = curve(reach);
      if (!b) return tl::unexpected(b.error());
      const double step_mm = per_mm > 0.0 ? (reach - a.t) / per_mm : length_mm;
      const auto deviation = deviation_mm(curve, a, *b, step_mm, extent.feed_mm_per_min);
      if (!deviation) return tl::unexpected(deviation.error());
      const double share = *deviation / tolerance_mm_;
      const double factor = share > 0.0 ? std::sqrt(kAim / share) : 4.0;
      if (share <= 1.0 || step_mm <= kShortestMm) {
        best = *b;
        best_share = share;
        if (reach >= furthest || share >= kGoodEnough || step_mm <= kShortestMm) break;
        if (trial + 4 >= kMostTrials) break;
        reach = std::min(furthest, a.t + (reach - a.t) * std::min(factor, 4.0));
      } else {
        const double shrunk = a.t + (reach - a.t) * std::clamp(factor, 0.2, 0.97);
        if (best.t > a.t && shrunk <= best.t) break;
        reach = shrunk;
      }
    }
    if (!(best.t > a.t)) {
      // The deviation did not decrease with the chord: take the shortest.
      const auto b = curve(std::min(end, a.t + std::max(kShortestMm * per_mm, 1e-12)));
      if (!b) return tl::unexpected(b.error());
      best = *b;
    }
    if (best.t < end && per_mm > 0.0 && best_share > 0.0) last_step_mm_ = (best.t - a.t) / per_mm;
    visit(best);
    a = best;
  }
  return {};
}

}  // namespace chaintrue::gcode
