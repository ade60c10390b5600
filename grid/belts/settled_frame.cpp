// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/settled_frame.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace chaintrue::grid::belts {

using model::Belt;
using model::kBelts;

namespace {

/// A frame whose readings are off by more has settled on the wrong side of something, or holds gross
/// slips: other starts are tried as well.
constexpr double kPlausibleSpreadMm = 10.0;

double spread_of(double square_mm2, Eigen::Index checks) {
  // Readings in whole hundredths leave no less.
  constexpr double kLeastSpreadMm = 1e-3;
  if (checks <= 0) return 1.0;
  return std::max(std::sqrt(square_mm2 / static_cast<double>(checks)), kLeastSpreadMm);
}

/// Right anchors right of the left ones, upper ones above the lower ones.
bool is_upright_frame(const AnchorVector& a) {
  return a[4] > 0.0 && a[2] > a[0] && a[1] > 0.0 && a[3] > 0.0;
}

std::optional<AnchorFit> settled_once(const MeasuredBelts& belts, AnchorFit frame) {
  const AnchorAdjustment solver(belts, frame.counting, frame.spread_mm);
  const bool at_bottom = solver.solve(frame.state);
  const FrameEquations there = solver.equations(frame.state);
  if (!std::isfinite(there.cost)) return std::nullopt;
  frame.is_sound = at_bottom && is_upright_frame(frame.state.anchors);
  frame.checks = solver.belt_degrees_of_freedom();
  // A tape that bends the frame must not make the belts seem less sure: the spread is theirs alone.
  if (!solver.fits_scale()) frame.spread_mm = spread_of(there.belts_square_mm2, frame.checks);
  return frame;
}

std::optional<AnchorFit> settled(const MeasuredBelts& belts, FrameState state, Counting counting) {
  MeasuredBelts untaped = belts;
  untaped.distances.clear();
  auto frame = settled_once(untaped, {std::move(state), std::move(counting), 1.0, 0, false});
  if (!frame || belts.distances.empty()) return frame;
  return settled_once(belts, *std::move(frame));
}

/// The normal deviate of the same chance as Student's t.
double normal_deviate(double t, double dof) {
  return (8.0 * dof + 1.0) / (8.0 * dof + 3.0) * std::sqrt(dof * std::log1p(t * t / dof));
}

struct Worst {
  std::size_t point = 0;
  Belt belt = Belt::tl;
  double sigmas = 0.0;
};

Worst worst_of(const MeasuredBelts& belts, const AnchorFit& frame, bool counting) {
  const FitDiagnostics view(belts, frame);
  Worst worst{0, Belt::tl, counting ? 0.0 : std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    for (const Belt belt : kBelts) {
      if (frame.counting[k][belt] != counting) continue;
      const double sigmas = view.residual(k, belt).sigmas;
      if (counting ? sigmas > worst.sigmas : sigmas > 0.0 && sigmas < worst.sigmas)
        worst = {k, belt, sigmas};
    }
  }
  return worst;
}

/// A point of another frame, or with digits lost, bends all others to itself, and its four readings
/// hide one another: points are left out whole, the worst first, while that makes a frame of what was
/// none.
AnchorFit without_gross_points(const MeasuredBelts& belts, AnchorFit frame) {
  // Of more points one cannot bend the frame so far that its own readings do not stand out.
  constexpr std::size_t kMostPoints = 100;
  constexpr double kMuchBetter = 3.0;
  const std::size_t count = belts.points.size();
  if (count > kMostPoints) return frame;
  const auto most =
      static_cast<std::size_t>(std::ceil(kMostBadReadings * static_cast<double>(count)));
  MeasuredBelts untaped = belts;
  untaped.distances.clear();
  for (std::size_t out = 0; out < most; ++out) {
    if (frame.is_sound && frame.spread_mm < kPlausibleSpreadMm) break;
    std::optional<AnchorFit> best;
    for (std::size_t k = 0; k < count; ++k) {
      if (!frame.counting[k].tl) continue;
      Counting fewer = frame.counting;
      fewer[k] = {false, false, false, false};
      auto without = settled(untaped, frame.state, std::move(fewer));
      if (!without || without->checks < 1 || !without->is_sound) continue;
      if (!best || without->spread_mm < best->spread_mm) best = std::move(without);
    }
    if (!best || kMuchBetter * best->spread_mm > frame.spread_mm) break;
    frame = *std::move(best);
  }
  if (belts.distances.empty()) return frame;
  return settled(belts, frame.state, frame.counting).value_or(frame);
}

/// The worst reading set aside, and again; at last those that fit after all are taken back.
AnchorFit without_bad_readings(const MeasuredBelts& belts, AnchorFit frame) {
  const auto most =
      static_cast<std::size_t>(kMostBadReadings * 4.0 * static_cast<double>(belts.points.size()));
  for (std::size_t aside = 0; frame.is_sound && aside < most && frame.checks > 1; ++aside) {
    const Worst worst = worst_of(belts, frame, true);
    if (worst.sigmas < kBadReadingSigmas) break;
    Counting fewer = frame.counting;
    fewer[worst.point][worst.belt] = false;
    auto next = settled(belts, frame.state, std::move(fewer));
    if (!next) break;
    frame = *std::move(next);
  }
  // What was set aside while a worse one was still in may fit after all.
  for (std::size_t back = 0; back < most; ++back) {
    const Worst least = worst_of(belts, frame, false);
    if (!(least.sigmas < kBadReadingSigmas)) break;
    Counting more = frame.counting;
    more[least.point][least.belt] = true;
    auto next = settled(belts, frame.state, std::move(more));
    if (!next || worst_of(belts, *next, true).sigmas >= kBadReadingSigmas) break;
    frame = *std::move(next);
  }
  return frame;
}

void place_the_unplaced(const MeasuredBelts& belts, AnchorFit& frame) {
  const model::BeltMachine machine = with_anchors(belts.machine, frame.state.anchors);
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    const auto& counts = frame.counting[k];
    if (counts.tl + counts.tr + counts.bl + counts.br >= 2) continue;
    frame.state.places[k] = nearest_place(machine, belts.points[k], {true, true, true, true});
  }
}

}  // namespace

std::optional<AnchorFit> settle_from(const MeasuredBelts& belts,
                                     FrameState state,
                                     Counting counting) {
  return settled(belts, std::move(state), std::move(counting));
}

std::optional<AnchorFit> settle(const MeasuredBelts& belts) {
  const Counting all(belts.points.size(), {true, true, true, true});
  // A tape's slip must not lead the search for the frame.
  MeasuredBelts untaped = belts;
  untaped.distances.clear();
  std::optional<AnchorFit> best;
  for (const FrameState& first : first_frames(untaped, all)) {
    auto frame = settled(untaped, first, all);
    if (!frame) continue;
    if (!best || std::pair(!frame->is_sound, frame->spread_mm) <
                     std::pair(!best->is_sound, best->spread_mm)) {
      best = std::move(frame);
    }
    if (best->is_sound && best->spread_mm < kPlausibleSpreadMm) break;
  }
  if (!best || belts.distances.empty()) return best;
  return settled(belts, best->state, best->counting);
}

std::optional<AnchorFit> settle_robustly(const MeasuredBelts& belts) {
  const auto first = settle(belts);
  if (!first) return std::nullopt;
  AnchorFit frame = without_bad_readings(belts, *first);
  if (!frame.is_sound || frame.spread_mm > kPlausibleSpreadMm) {
    frame = without_bad_readings(belts, without_gross_points(belts, *first));
  }
  place_the_unplaced(belts, frame);
  return frame;
}

FitDiagnostics::FitDiagnostics(const MeasuredBelts& belts, const AnchorFit& frame)
    : frame_(frame),
      solver_(belts, frame.counting, frame.spread_mm),
      equations_(solver_.equations(frame.state)),
      reduced_(solver_.reduce(equations_, 0.0)) {
  const Eigen::Index n = solver_.unknowns();
  covariance_ = reduced_.normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
}

Eigen::Matrix2d FitDiagnostics::place_covariance_mm2(std::size_t point) const {
  if (!solver_.is_placed(point)) return Eigen::Matrix2d::Zero();
  if (solver_.is_taped(point)) {
    const Eigen::Index column = solver_.place_column(point);
    return covariance_.block<2, 2>(column, column);
  }
  const AnchorAdjustment::Eliminated& own = reduced_.points[point];
  const Eigen::Matrix2Xd gain = own.inverse * own.cross.transpose();
  return own.inverse + gain * covariance_ * gain.transpose();
}

Eigen::VectorXd FitDiagnostics::influence(std::size_t point, Belt belt) const {
  const double weight = 1.0 / (frame_.spread_mm * frame_.spread_mm);
  Eigen::VectorXd row = solver_.frame_row(equations_, point, belt);
  if (!solver_.is_taped(point)) {
    const AnchorAdjustment::Eliminated& own = reduced_.points[point];
    row -= own.cross * (own.inverse * equations_.by_place.row(row_of(point, belt)).transpose());
  }
  return weight * covariance_ * row;
}

BeltResidual FitDiagnostics::residual(std::size_t point, Belt belt) const {
  BeltResidual result;
  const double r = equations_.residual[row_of(point, belt)];
  result.off_mm = r;
  result.counts = solver_.counts(point, belt);
  result.beside_mm = r;
  if (!solver_.is_placed(point)) return result;
  const double s2 = frame_.spread_mm * frame_.spread_mm;
  Eigen::VectorXd row = solver_.frame_row(equations_, point, belt);
  double own_share = 0.0;
  if (!solver_.is_taped(point)) {
    const AnchorAdjustment::Eliminated& own = reduced_.points[point];
    const Eigen::Vector2d by_place = equations_.by_place.row(row_of(point, belt)).transpose();
    own_share = by_place.dot(own.inverse * by_place) / s2;
    row -= own.cross * (own.inverse * by_place);
  }
  const double h = own_share + row.dot(covariance_ * row) / s2;
  const auto n = static_cast<double>(frame_.checks);
  if (!result.counts) {
    if (n >= 1.0) result.sigmas = normal_deviate(r / (frame_.spread_mm * std::sqrt(1.0 + h)), n);
    return result;
  }
  // Nothing but this reading tells where it should be.
  constexpr double kOwnWord = 1e-6;
  if (1.0 - h < kOwnWord || n < 2.0) return result;
  result.beside_mm = r / (1.0 - h);
  const double left_square = std::max(s2 * n - r * r / (1.0 - h), 1e-12 * s2) / (n - 1.0);
  result.sigmas = normal_deviate(r / std::sqrt(left_square * (1.0 - h)), n - 1.0);
  return result;
}

AnchorVector FitDiagnostics::anchors_without(std::size_t point) const {
  const double weight = 1.0 / (frame_.spread_mm * frame_.spread_mm);
  const Eigen::Index n = solver_.unknowns();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  for (const Belt belt : kBelts) {
    if (!solver_.counts(point, belt)) continue;
    const Eigen::VectorXd row = solver_.frame_row(equations_, point, belt);
    normal += weight * row * row.transpose();
    gradient += weight * equations_.residual[row_of(point, belt)] * row;
  }
  const AnchorAdjustment::Eliminated& own = reduced_.points[point];
  normal -= own.cross * own.inverse * own.cross.transpose();
  gradient -= own.cross * (own.inverse * own.gradient);
  const Eigen::VectorXd change = (reduced_.normal - normal).ldlt().solve(-gradient);
  return frame_.state.anchors + change.head<kAnchorUnknowns>();
}

}  // namespace chaintrue::grid::belts
