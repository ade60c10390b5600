// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_analysis.hpp"
#include "interp/eigen.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::grid::diagnosis {

std::vector<model::effects::ActingEffect> resolved(const std::vector<SizedCause>& causes) {
  std::vector<model::effects::ActingEffect> effects;
  for (const SizedCause& own : causes) {
    effects.push_back({own.cause.effect, own.cause.side, own.values});
  }
  return effects;
}

namespace {

/// A value that least squares estimates: number `value` of cause `cause`.
struct FreeValue {
  std::size_t cause;
  std::size_t value;
  const EffectParameter* parameter;
};

std::vector<FreeValue> free_values(const std::vector<SizedCause>& causes) {
  std::vector<FreeValue> free;
  for (const auto j : each_index(causes)) {
    const auto& parameters = causes[j].cause.effect->parameters;
    for (const auto i : each_index(parameters)) {
      if (!parameters[i].integer) free.push_back({j, i, &parameters[i]});
    }
  }
  return free;
}

/// Derivative of the readings by each, mm per unit.
MatrixXd value_columns(const MeasuredBelts& belts, const std::vector<SizedCause>& causes,
                       const FrameState& state, const std::vector<FreeValue>& free) {
  // Share of a value's usual spread, for difference quotients.
  constexpr double kStep = 0.05;
  MatrixXd columns(4 * std::ssize(belts.points), std::ssize(free));
  for (const auto f : each_index(free)) {
    const double step = kStep * free[f].parameter->prior_sigma;
    const SizedCause& here = causes[free[f].cause];
    SizedCause there = here;
    there.values[free[f].value] += step;
    columns.col(as_index(f)) =
        (added_by(belts, {there}, state) - added_by(belts, {here}, state)) / step;
  }
  return columns;
}

/// Applies the step; returns true once it is below the values' uncertainty.
bool moved(const VectorXd& change, const std::vector<FreeValue>& free,
           std::vector<SizedCause>& causes) {
  // Share of a value's usual spread: a hundredth of what the best data leave uncertain.
  constexpr double kConverged = 1e-4;
  bool converged = true;
  for (const auto f : each_index(free)) {
    const EffectParameter& parameter = *free[f].parameter;
    double& value = causes[free[f].cause].values[free[f].value];
    double next = value + change[kAnchorUnknowns + as_index(f)];
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

/// (1), in millimetres: changes of the five anchor coordinates, then of the values.
VectorXd least_squares(const FitGivenCauses& given, const MatrixXd& columns) {
  const AnchorFit& frame = given.frame;
  const ObservationSet set = observations_of(given.belts, frame.state, 1.0, frame.counting);
  const RegressorSystem system = linearise(set, stated_state(set)).value();
  MatrixXd design(system.e.size(), kAnchorUnknowns + columns.cols());
  design.leftCols<kAnchorUnknowns>() = system.by_setting;
  for (const auto u : each_index(system.units)) {
    const SystemUnit& unit = system.units[u];
    design.rightCols(columns.cols()).middleRows(unit.first_row, unit.rows) =
        unit.by_reading * columns.middleRows<4>(belts::row_of(set.units[u].index, Belt::tl));
  }
  return linear::least_squares(linear::gram(design), linear::inner(design, system.e));
}

}  // namespace

VectorXd added_by(const MeasuredBelts& belts, const std::vector<SizedCause>& causes,
                  const FrameState& state) {
  VectorXd added = VectorXd::Zero(4 * std::ssize(belts.points));
  if (causes.empty()) return added;
  const auto effects = resolved(causes);
  const BeltMachine machine = with_anchors(belts.machine, state.anchors);
  const std::optional<BeltPull> reference = reference_pull(belts);
  for (const Belt belt : kBelts) {
    const bool acts =
        any_of(effects, [belt](const auto& own) { return model::belts::acts_on(own.side, belt); });
    if (!acts) continue;
    for (const auto k : each_index(belts.points)) {
      const FramePoint at = state.places[k];
      const BeltPoint& point = belts.points[k];
      const model::belts::BeltVisit visit{belt, pulled_belts(point), point.order.value_or(0),
                                          pull_over(reference, point)};
      const auto with = model::belts::read_belt(machine, effects, visit, at);
      const auto without = model::belts::read_belt(machine, {}, visit, at);
      if (with && without) added[belts::row_of(k, belt)] = with->value - without->value;
    }
  }
  return added;
}

MeasuredBelts without_effects(const MeasuredBelts& belts, const std::vector<SizedCause>& causes,
                              const FrameState& state) {
  MeasuredBelts without_causes = belts;
  const VectorXd added = added_by(belts, causes, state);
  for (const auto k : each_index(without_causes.points)) {
    for (const Belt belt : kBelts)
      without_causes.points[k].lengths_mm[belt] -= added[belts::row_of(k, belt)];
  }
  return without_causes;
}

ObservationSet observations_of(const MeasuredBelts& belts, const FrameState& state, double sigma_mm,
                               const Counting& counting) {
  const auto mechanism = mechanism_at(belts, state);
  std::vector<FramePoint> about = state.places;
  for (FramePoint& at : about) {
    if (mechanism->predict({at.x_mm, at.y_mm}, {}, model::Derivatives::by_position)) continue;
    const ToolPosition middle = mechanism->extent().centre();
    at = {middle.x_mm, middle.y_mm};
  }
  const Counting all(belts.points.size(), kAllBelts);
  return estimation::observation_set(
      {},
      {std::make_shared<const observation::BeltLengthReadings>(
          belts::readings_of(belts, counting.empty() ? all : counting, sigma_mm, about))},
      mechanism);
}

std::optional<FitGivenCauses> fit_given_causes(const MeasuredBelts& belts,
                                               std::vector<SizedCause> causes,
                                               const AnchorFit& from) {
  // Sizes and frame are nearly linear in each other: three rounds suffice except for zeros of an
  // arm's length, which take six.
  constexpr int kMostRounds = 12;
  FitGivenCauses given{{from, {}}, std::move(causes)};
  const auto take_out = [&] {
    given.belts = without_effects(belts, given.causes, given.frame.state);
  };
  take_out();
  const std::vector<FreeValue> free = free_values(given.causes);
  for (const int round : each_below(kMostRounds)) {
    auto frame = fit_anchors_from(given.belts, given.frame.state, given.frame.counting);
    if (!frame) return std::nullopt;
    given.frame = *std::move(frame);
    take_out();
    if (free.empty() && round > 0) break;
    const VectorXd change =
        least_squares(given, value_columns(belts, given.causes, given.frame.state, free));
    const bool is_settled = moved(change, free, given.causes);
    take_out();
    if (is_settled && round > 0) break;
  }
  return given;
}

}  // namespace chaintrue::grid::diagnosis
