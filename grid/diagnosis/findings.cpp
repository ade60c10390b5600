// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/diagnosis/regressor_system.hpp"
#include "grid/observation/drawn_measures.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Describes a column at a step from a value; empty if one of the two machines is invalid.
template <class At>
std::optional<VectorXd> central_difference(const At& at, double step) {
  const auto above = at(step);
  const auto below = at(-step);
  if (!above || !below) return std::nullopt;
  return (*above - *below) / (2.0 * step);
}

/// Where a cause sets in: parameter `which` of regressor `column`.
///
/// Its sigma is the larger of two: the scatter of the place over the models, and the curvature of the
/// likelihood about the best, settings and all other coefficients free. For a step between two marks it is
/// that of a uniform distribution over the gap. The models contain only a few values of a continuous place:
/// if one has all the weight, their scatter does not show the uncertainty.
class PlaceOfCause {
 public:
  PlaceOfCause(const Analysis& a, int column, std::size_t which)
      : a_(a),
        own_(regressor(a, column)),
        which_(which),
        place_(own_.cause.effect->parameters[which]) {}

  /// \pre `fitted` has the regressor, with this coefficient.
  ParameterEstimate estimated(const Estimate& fitted, double coefficient) const {
    ParameterEstimate result{std::string(place_.name), own_.values[which_], 0.0};
    double width = 0.0;
    if (!place_.integer) {
      const auto slope = slope_by_place();
      const bool is_step = slope && slope->isZero();
      if (slope && !is_step) width = fitted_sigma(fitted, coefficient, *slope);
      // No reading shows where between two of them a step is.
      if (const auto gap =
              is_step ? gap_about(a_.system, own_.cause, result.value) : std::nullopt) {
        result.value = 0.5 * (gap->below + gap->above);
        width = (gap->above - gap->below) / std::sqrt(12.0);
      }
    }
    result.sigma = std::max(scatter(result.value), width);
    return result;
  }

 private:
  /// Derivative of the whitened signature by the place; empty if the machine cannot have such an effect.
  std::optional<VectorXd> slope_by_place() const {
    // Step in radians: central differences of a wave are accurate to h^2 / 6, rounding to 1e-16 / h.
    constexpr double kStep = 1e-3;
    const auto at = [&](double step) {
      SizedCause there = own_;
      there.values[which_] += step;
      return signature(a_.session, a_.state, a_.system, there);
    };
    return central_difference(at, kStep);
  }

  /// The same with each setting, n x q. A wave along a chain moves along it with the chain's length:
  /// a motor that is off by half a millimetre moves the wave of a sprocket by 3 degrees. 0 if such a
  /// machine is invalid.
  MatrixXd slope_by_settings() const {
    // Step in sigmas: central differences of a wave of 60 mm are accurate to 1e-7 for a motor known
    // to 3 mm.
    constexpr double kStep = 1e-3;
    const RegressorSystem& system = a_.system;
    MatrixXd slope = MatrixXd::Zero(system.by_setting.rows(), system.setting.size());
    for (const Index column : each_below(a_.session.setting_columns())) {
      const double step = kStep * system.sigma(column);
      const auto at = [&](double change) -> std::optional<VectorXd> {
        VectorXd settings = system.setting;
        settings(column) += change;
        const auto state = moved_to(a_.session, a_.state, settings);
        if (!state) return std::nullopt;
        const auto there = linearise(a_.session, *state);
        if (!there) return std::nullopt;
        return signature(a_.session, *state, *there, own_);
      };
      if (const auto own = central_difference(at, step)) slope.col(column) = *own;
    }
    return slope;
  }

  /// The distance from a continuous place to the nearest other one tried.
  double step_of_places() const {
    double least = kInfinity;
    for (const Regressor& other : a_.system.regressors) {
      if (other.cause != own_.cause) continue;
      const double step = std::abs(other.values[which_] - own_.values[which_]);
      if (step > 0.0) least = std::min(least, step);
    }
    return std::isfinite(least) ? least : 0.0;
  }

  /// The sigma of a continuous place, from the curvature of the likelihood with settings and all
  /// coefficients free.
  double fitted_sigma(const Estimate& fitted, double coefficient, const VectorXd& slope) const {
    const MarginalisedSystem& marginalised = marginalised_system(a_);
    Unknowns unknowns = unknowns_of(a_.system, marginalised, fitted.free_regressors());
    auto& [design, sigma] = unknowns;
    const Index last = sigma.size();
    design.leftCols(a_.system.setting.size()) +=
        coefficient * marginalised.kept(slope_by_settings());
    design.conservativeResize(Eigen::NoChange, last + 1);
    design.col(last) = coefficient * marginalised.kept(slope);
    sigma.conservativeResize(last + 1);
    // The prior is uniform between the bounds; a phase is cyclic.
    const double range = place_.upper - place_.lower;
    sigma(last) =
        (place_.name.ends_with("_rad") ? std::min(range, kTurn) : range) / std::sqrt(12.0);
    design = a_.noise.covariance.half_solve(design);
    const MatrixXd scaled = linear::scaled_columns(design, sigma / std::sqrt(fitted.noise_square));
    const linear::Cholesky normal(linear::one_plus_gram(scaled));
    const VectorXd column_of_inverse = normal.solve(VectorXd::Unit(last + 1, last));
    // With a discrepancy the place is the best of those tried (relinearise.cpp), off by up to half a
    // step either way.
    const double step = a_.noise.is_of_process() ? step_of_places() : 0.0;
    return std::hypot(sigma(last) * std::sqrt(column_of_inverse(last)), step / std::sqrt(12.0));
  }

  /// The scatter of the place over the models, about a value.
  double scatter(double about) const {
    const bool turns = place_.upper - place_.lower >= kTurn;
    double weight = 0.0;
    double square = 0.0;
    for (const CandidateModel& model : a_.comparison.models) {
      for (const int k : model.regressors) {
        const Regressor& other = regressor(a_, k);
        if (other.cause != own_.cause) continue;
        const double p = a_.comparison.probability(model);
        const double off = other.values[which_] - about;
        weight += p;
        square += p * std::pow(turns ? std::remainder(off, kTurn) : off, 2);
      }
    }
    return weight > 0.0 ? std::sqrt(square / weight) : 0.0;
  }

  static constexpr double kTurn = 2.0 * std::numbers::pi;

  const Analysis& a_;
  const Regressor& own_;
  std::size_t which_;
  const EffectParameter& place_;
};

/// The cause of regressor `column`, in the effect's order. \pre `fitted` has the regressor.
std::vector<ParameterEstimate> parameters_of(const Analysis& a, int column,
                                             const Estimate& fitted) {
  const Regressor& d = regressor(a, column);
  const Index at = fitted.position(column);
  const double coefficient = fitted.coefficient(at);
  const double sigma = fitted.coefficient_sigma(at);
  std::vector<ParameterEstimate> result;
  const auto& described = d.cause.effect->parameters;
  result.push_back({std::string(described.front().name), size_at(d, coefficient),
                    std::abs(size_slope(d, coefficient)) * sigma});
  for (std::size_t k = 1; k < described.size(); ++k)
    result.push_back(PlaceOfCause(a, column, k).estimated(fitted, coefficient));
  return result;
}

constexpr double kQuantile95 = 1.645;  // one-sided 95 %
constexpr double kSettingOff = 3.0;    // sigmas: 1 in 370 for each setting

/// Length of a column, and before projection on the settings.
double reduced_length(const Analysis& a, int column) {
  return reduced(marginalised_system(a), a.system.g.col(column)).norm();
}
double raw_length(const Analysis& a, int column) {
  return length_in_noise(a.system, marginalised_system(a).kept, a.system.g.col(column));
}

Cause describe(const Analysis& a, std::size_t index) {
  const CauseClass& members = a.decision.classes[index];
  Cause cause;
  cause.cause = members.front();
  cause.probability = a.decision.probability_of(index);
  // Other named causes stay in the model; rivals of a set are each fitted alone.
  RegressorSet others;
  for (const int k : a.decision.regressors) {
    const CauseId& acting = regressor(a, k).cause;
    const bool several = a.decision.verdict == Verdict::several_causes;
    if (several && !contains(members, acting)) {
      others.push_back(k);
    }
  }
  for (const CauseId& member : members) {
    const int column = best_regressor(a, member);
    RegressorSet set = others;
    set.push_back(column);
    const Estimate fitted = estimate_with(a, set);
    const Index at = fitted.position(column);
    auto found = parameters_of(a, column, fitted);
    if (member == members.front()) {
      const double length = reduced_length(a, column);
      cause.signal_to_noise = std::abs(fitted.coefficient(at)) * length;
      cause.share_left = length / std::max(raw_length(a, column), 1e-12);
      cause.parameters = std::move(found);
      if (const Nearest other = nearest_other(a, column); other.column >= 0) {
        cause.rival = regressor(a, other.column).cause;
        cause.rival_collinearity = other.collinearity;
      }
    } else {
      cause.same_as.push_back({member, std::move(found)});
    }
  }
  cause.order_assumed = a.options.order_assumed && cause.cause.effect->needs == DataNeed::order;
  return cause;
}

}  // namespace

std::vector<Cause> causes_found(const Analysis& a) {
  return mapped(a.decision.listed, [&](std::size_t index) { return describe(a, index); });
}

Hypothesis hypothesis_of(const CauseClass& members, double probability) {
  const CauseId& cause = members.front();
  return {std::string(cause.effect->id), std::string(name(cause.side)), probability, members};
}

std::vector<Hypothesis> hypotheses(const Analysis& a) {
  auto result = mapped(a.decision.marginal, [&](const ClassProbability& one) {
    return hypothesis_of(a.decision.classes[one.index], one.probability);
  });
  result.push_back({"nothing", "", a.decision.nothing});
  result.push_back({"unknown", "", a.decision.discrepancy});
  result.push_back({"noise", "", a.decision.noise});
  result.push_back({"bad_points", "", a.decision.outliers});
  stable_sort(result, descending(&Hypothesis::probability));
  return result;
}

namespace {

/// A cause with a higher probability is not reported as absent.
constexpr double kMayAct = 0.05;

}  // namespace

double probability_of(const Analysis& a, const CauseId& cause) {
  return a.decision.probability_of(a.decision.class_of(cause));
}

std::vector<Bound> bounds(const Analysis& a, std::vector<NotTestable>& not_testable) {
  std::vector<Bound> result;
  for (const CauseId& cause : a.candidates.testable) {
    if (contains(a.decision.listed, a.decision.class_of(cause))) continue;
    const int column = best_regressor(a, cause);
    const EffectParameter& size = cause.effect->parameters.front();
    const double left = column < 0 ? 0.0 : reduced_length(a, column);
    if (column < 0 || left < kAbsorbed * raw_length(a, column)) {
      not_testable.push_back({cause, "calibrating the settings would hide its whole effect"});
      continue;
    }
    if (regressor(a, column).fixed) {
      // A skip has no bound on its size: it is absent, or it may act.
      if (probability_of(a, cause) < kMayAct)
        result.push_back({cause, std::string(size.name), 0.0});
      continue;
    }
    RegressorSet set = a.decision.regressors;
    if (!contains(set, column)) set.push_back(column);
    const Estimate fitted = estimate_with(a, set);
    const Index at = fitted.position(column);
    const double most =
        std::abs(fitted.coefficient(at)) + kQuantile95 * fitted.coefficient_sigma(at);
    const double upper = std::abs(size_at(regressor(a, column), most));
    if (upper >= std::max(std::abs(size.lower), std::abs(size.upper))) {
      not_testable.push_back({cause, fmt::format("it could hide in these {}, whatever its size",
                                                 a.session.units_word())});
    } else {
      result.push_back({cause, std::string(size.name), upper});
    }
  }
  return result;
}

std::vector<CalibratedSetting> settings_found(const Analysis& a) {
  const ObservationSet& session = a.session;
  std::vector<CalibratedSetting> result;
  for (const auto k : each_index(session.settings)) {
    const auto at = as_index(k);
    if (!session.knows(k)) continue;
    CalibratedSetting one;
    one.setting = session.settings[k];
    one.stated = session.stated_value(at);
    one.stated_sigma = session.stated_sigma(at);
    one.calibrated = a.system.setting(at) + a.estimate.setting_change(at);
    one.sigma = std::sqrt(a.estimate.covariance(at, at));
    // A posterior mean under the stated prior scatters by sqrt(prior - posterior).
    const double prior = one.stated_sigma * one.stated_sigma;
    const double scatter =
        std::sqrt(std::max(prior - one.sigma * one.sigma / a.estimate.noise_square, 1e-6 * prior));
    one.off = std::abs(one.calibrated - one.stated) > kSettingOff * scatter;
    result.push_back(one);
  }
  return result;
}

void take_findings(const Analysis& a, Diagnosis& d) {
  d.seed = a.options.seed;
  d.verdict = a.decision.verdict;
  d.noise_factor = std::sqrt(a.estimate.noise_square);
  d.family_wise_p = a.family_wise_p;
  d.causes = causes_found(a);
  d.hypotheses = hypotheses(a);
  d.not_testable = a.candidates.not_testable;
  d.bounds = bounds(a, d.not_testable);
}

namespace {

Outlier outlier_of(const Analysis& a, std::size_t u) {
  const SystemUnit& unit = a.system.units[u];
  const NumberedUnit& own = a.session.units[u];
  const VectorXd& left = a.estimate.left_given_discrepancy;
  const Vector2d error_mm = error_of_unit(a.system, left, u);
  double variance = a.estimate.noise_square;
  Outlier outlier;
  outlier.index = own.index;
  if (unit.reads_chains) {
    // Where the tool would have to be, minus its mark.
    outlier.shift_mm = -error_mm;
  } else {
    const bool is_drawn =
        &a.session.parts[own.part].observation->kind() == &observation::drawn_measures;
    outlier.of = is_drawn ? Observations::drawing : Observations::distances;
    outlier.residual_mm = error_mm.x();
    // The prediction includes the others' information on its holes, and its uncertainty.
    const VectorXd by_setting = a.system.by_setting.row(unit.first_row);
    const auto settings = by_setting.size();
    variance += by_setting.dot(
        linear::product(a.estimate.covariance.topLeftCorner(settings, settings), by_setting));
  }
  outlier.distance = unit.segment(left).norm() / std::sqrt(variance);
  return outlier;
}

}  // namespace

std::vector<Outlier> outliers_found(const Analysis& a) {
  Flags outliers = marginalised_system(a).outliers;
  // A miscounted link is an outlier with a name.
  reject_slips(a, outliers);
  std::vector<Outlier> result;
  for (const auto u : each_index(outliers)) {
    if (outliers[u]) result.push_back(outlier_of(a, u));
  }
  sort(result, ascending([](const Outlier& own) { return std::pair(own.of, own.index); }));
  return result;
}

}  // namespace chaintrue::grid::diagnosis
