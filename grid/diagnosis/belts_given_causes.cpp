// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_given_causes.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/belts/belt_readings.hpp"

namespace chaintrue::grid::diagnosis {

using model::Belt;
using model::kBelts;

namespace {

std::vector<model::belts::ResolvedBeltEffect> resolved(const std::vector<BeltCause>& causes) {
  std::vector<model::belts::ResolvedBeltEffect> effects;
  for (const BeltCause& own : causes) {
    effects.push_back(
        {model::belts::belt_effect_of(*own.cause.effect), own.cause.side, own.values});
  }
  return effects;
}

/// A value that least squares finds: of cause `cause` the value numbered `value`.
struct FreeValue {
  std::size_t cause = 0;
  std::size_t value = 0;
};

std::vector<FreeValue> free_values(const std::vector<BeltCause>& causes) {
  std::vector<FreeValue> free;
  for (std::size_t j = 0; j < causes.size(); ++j) {
    const auto& parameters = causes[j].cause.effect->parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (!parameters[i].integer) free.push_back({j, i});
    }
  }
  return free;
}

const model::effects::EffectParameter& parameter_of(const std::vector<BeltCause>& causes,
                                                    FreeValue which) {
  return causes[which.cause].cause.effect->parameters[which.value];
}

/// What each of them moves, mm by its unit.
Eigen::MatrixXd value_columns(const MeasuredBelts& belts,
                              const std::vector<BeltCause>& causes,
                              const belts::FrameState& state,
                              const std::vector<FreeValue>& free) {
  // Of a value's usual spread: far enough for differences.
  constexpr double kStep = 0.05;
  Eigen::MatrixXd columns(4 * static_cast<Eigen::Index>(belts.points.size()),
                          static_cast<Eigen::Index>(free.size()));
  for (std::size_t f = 0; f < free.size(); ++f) {
    const double step = kStep * parameter_of(causes, free[f]).prior_sigma;
    const BeltCause& here = causes[free[f].cause];
    BeltCause there = here;
    there.values[free[f].value] += step;
    columns.col(static_cast<Eigen::Index>(f)) =
        (added_by(belts, {there}, state) - added_by(belts, {here}, state)) / step;
  }
  return columns;
}

/// Moves the values; whether that was no more than they are uncertain by anyway.
bool moved(const Eigen::VectorXd& change,
           const std::vector<FreeValue>& free,
           std::vector<BeltCause>& causes) {
  // Of a value's usual spread: a hundredth of what the best data leave uncertain.
  constexpr double kConverged = 1e-4;
  bool converged = true;
  for (std::size_t f = 0; f < free.size(); ++f) {
    const auto& parameter = parameter_of(causes, free[f]);
    double& value = causes[free[f].cause].values[free[f].value];
    double next = value + change[belts::kAnchorUnknowns + static_cast<Eigen::Index>(f)];
    if (parameter.name.ends_with("_rad")) {
      next = std::remainder(next, 2.0 * std::numbers::pi);
    } else {
      next = std::clamp(next, parameter.lower, parameter.upper);
    }
    converged = converged && std::abs(next - value) < kConverged * parameter.prior_sigma;
    value = next;
  }
  return converged;
}

/// (1): changes of the five anchor coordinates, then of the values.
Eigen::VectorXd least_squares(const MeasuredBelts& without_causes,
                              const belts::AnchorFit& frame,
                              const Eigen::MatrixXd& columns) {
  const belts::ReadingLines lines = belts::reading_lines(without_causes, frame.state);
  const Eigen::Index unknowns = belts::kAnchorUnknowns + columns.cols();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(unknowns);
  Eigen::MatrixXd design(4, unknowns);
  for (std::size_t k = 0; k < without_causes.points.size(); ++k) {
    const Eigen::MatrixXd q = checks_of(lines, k, frame.counting[k]);
    if (q.cols() == 0) continue;
    const Eigen::Index row = belts::row_of(k, Belt::tl);
    design.leftCols<belts::kAnchorUnknowns>() = lines.by_anchor.middleRows<4>(row);
    design.rightCols(columns.cols()) = columns.middleRows<4>(row);
    const Eigen::MatrixXd own = q.transpose() * design;
    normal += own.transpose() * own;
    gradient += own.transpose() * (q.transpose() * lines.residual_mm.segment<4>(row));
  }
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(normal).solve(gradient);
}

}  // namespace

model::belts::BeltVisit visit_of(const BeltPoint& point,
                                 Belt belt,
                                 const std::optional<BeltPull>& reference) {
  return {belt, pulled_belts(point), point.order.value_or(0), pull_over(reference, point)};
}

Eigen::VectorXd added_by(const MeasuredBelts& belts,
                         const std::vector<BeltCause>& causes,
                         const belts::FrameState& state) {
  Eigen::VectorXd added = Eigen::VectorXd::Zero(4 * static_cast<Eigen::Index>(belts.points.size()));
  if (causes.empty()) return added;
  const auto effects = resolved(causes);
  const model::BeltMachine machine = belts::with_anchors(belts.machine, state.anchors);
  const std::optional<BeltPull> reference = reference_pull(belts);
  for (const Belt belt : kBelts) {
    const bool acts = std::any_of(effects.begin(), effects.end(), [belt](const auto& own) {
      return model::belts::acts_on(own.side, belt);
    });
    if (!acts) continue;
    for (std::size_t k = 0; k < belts.points.size(); ++k) {
      const model::FramePoint at = state.places[k];
      const auto visit = visit_of(belts.points[k], belt, reference);
      const auto with = model::belts::read_belt(machine, effects, visit, at);
      const auto without = model::belts::read_belt(machine, {}, visit, at);
      if (with && without) added[belts::row_of(k, belt)] = *with - *without;
    }
  }
  return added;
}

MeasuredBelts without_effects(const MeasuredBelts& belts,
                              const std::vector<BeltCause>& causes,
                              const belts::FrameState& state) {
  MeasuredBelts without_causes = belts;
  const Eigen::VectorXd added = added_by(belts, causes, state);
  for (std::size_t k = 0; k < without_causes.points.size(); ++k) {
    for (const Belt belt : kBelts) without_causes.points[k].lengths_mm[belt] -= added[belts::row_of(k, belt)];
  }
  return without_causes;
}

Eigen::MatrixXd checks_of(const belts::ReadingLines& lines,
                          std::size_t point,
                          const model::PerBelt<bool>& counting) {
  std::vector<Eigen::Index> rows;
  for (const Belt belt : kBelts) {
    if (counting[belt]) rows.push_back(static_cast<Eigen::Index>(belt));
  }
  const auto count = static_cast<Eigen::Index>(rows.size());
  if (count < 3) return Eigen::MatrixXd(4, 0);
  const Eigen::MatrixXd by_place =
      lines.by_place.middleRows<4>(belts::row_of(point, Belt::tl))(rows, Eigen::all);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(by_place);
  const Eigen::MatrixXd whole = qr.householderQ() * Eigen::MatrixXd::Identity(count, count);
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(4, count - 2);
  q(rows, Eigen::all) = whole.rightCols(count - 2);
  return q;
}

std::optional<FitGivenCauses> fit_given_causes(const MeasuredBelts& belts,
                                         std::vector<BeltCause> causes,
                                         const belts::AnchorFit& from) {
  // Sizes and frame are nearly linear in each other: three rounds settle all but zeros of an arm's
  // length, which take six.
  constexpr int kMostRounds = 12;
  MeasuredBelts untaped = belts;
  untaped.distances.clear();
  FitGivenCauses given{from, std::move(causes)};
  const std::vector<FreeValue> free = free_values(given.causes);
  for (int round = 0; round < kMostRounds; ++round) {
    const MeasuredBelts without_causes = without_effects(untaped, given.causes, given.frame.state);
    auto frame = belts::fit_anchors_from(without_causes, given.frame.state, given.frame.counting);
    if (!frame) return std::nullopt;
    given.frame = *std::move(frame);
    if (free.empty() && round > 0) return given;
    const Eigen::MatrixXd columns =
        value_columns(untaped, given.causes, given.frame.state, free);
    const Eigen::VectorXd change = least_squares(
        without_effects(untaped, given.causes, given.frame.state), given.frame, columns);
    if (moved(change, free, given.causes) && round > 0) return given;
  }
  return given;
}

}  // namespace chaintrue::grid::diagnosis
