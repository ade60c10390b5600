// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/laws.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/law_model.hpp"
#include "grid/parallel.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr std::size_t kMostLaws = 3;
/// Below it a wave has no phase.
constexpr double kSmallestWaveMm = 1e-9;
/// Less likely laws are not listed.
constexpr double kLeastLaw = 0.03;

/// Logarithm of all weights together.
double log_total(const std::vector<LawEvidence>& evidence) {
  std::vector<double> terms;
  for (const LawEvidence& own : evidence) {
    terms.push_back(own.log_without);
    for (const WeighedLaw& law : own.laws) terms.push_back(law.log_weight);
  }
  return log_sum(terms);
}

/// The posterior density of a point, up to a factor, independent of the grid's spacing, which is finer
/// about the leading points. A step's place is one of its gaps.
double log_density(const WeighedLaw& law) {
  if (!is_continuous(law.curve->shape)) return law.log_weight;
  return law.log_weight - std::log(law.mass) + std::log(density_at(*law.curve, law.at));
}

/// A parameter of a law as estimated.
struct ValueAndVariance {
  double value = 0.0;
  double variance = 0.0;
};

/// Size and phase of a cosine and a sine.
std::vector<ValueAndVariance> size_and_phase(const Vector2d& a, const Matrix2d& c) {
  const double size = std::max(a.norm(), kSmallestWaveMm);
  const Vector2d along = a / size;
  const Vector2d turned(along(1), -along(0));
  return {{size, along.dot(c * along)},
          {std::atan2(a(0), a(1)), turned.dot(c * turned) / (size * size)}};
}

/// In the order of parameter_names().
std::vector<ValueAndVariance> parameters_of(const WeighedLaw& law) {
  const LawCurve& curve = *law.curve;
  const VectorXd& a = law.amplitude;
  const MatrixXd& c = law.covariance;
  const ValueAndVariance size{a(0), c(0, 0)};
  switch (curve.shape) {
    case LawShape::linear:
      return {size};
    case LawShape::square: {
      // A bow of zero size has no vertex.
      const double at = a(0) != 0.0 ? -0.5 * a(1) / a(0) : 0.0;
      const Vector2d slope = a(0) != 0.0 ? Vector2d(-at / a(0), -0.5 / a(0)) : Vector2d(0.0, 0.0);
      const double half = 0.5 * curve.span();
      return {size, {curve.middle() + half * at, half * half * slope.dot(c * slope)}};
    }
    case LawShape::wave:
    case LawShape::harmonics: {
      auto own = size_and_phase(a.head<2>(), c.topLeftCorner<2, 2>());
      own.insert(own.begin() + 1, {curve.span() / law.at, 0.0});
      if (curve.shape == LawShape::harmonics)
        append_all(own, size_and_phase(a.tail<2>(), c.bottomRightCorner<2, 2>()));
      return own;
    }
    case LawShape::step: {
      // Anywhere between two readings.
      const double gap = law.mass * curve.span();
      return {size, {law.at, gap * gap / 12.0}};
    }
    default:
      return {size, {law.at, 0.0}};
  }
}

/// Values of the best point; sigmas over all points of its curve.
std::vector<ParameterEstimate> estimates(const WeighedLaw& best, const LawPoints& of_curve) {
  const auto own = parameters_of(best);
  const auto names = parameter_names(best.curve->shape, best.curve->of);
  std::vector<ParameterEstimate> result;
  for (const auto k : each_index(own)) {
    const bool is_phase = names[k].ends_with("phase_rad");
    double weights = 0.0;
    double sum = 0.0;
    double square = 0.0;
    for (const WeighedLaw* point : of_curve) {
      const double w = std::exp(point->log_weight - best.log_weight);
      const ValueAndVariance there = parameters_of(*point)[k];
      double off = there.value - own[k].value;
      if (is_phase) off = std::remainder(off, 2.0 * std::numbers::pi);
      weights += w;
      sum += w * off;
      square += w * (off * off + there.variance);
    }
    const double variance = square / weights - std::pow(sum / weights, 2);
    result.push_back({names[k], own[k].value, std::sqrt(std::max(variance, 0.0))});
  }
  return result;
}

void measure(const Analysis& a, const WeighedLaw& best, Law& law) {
  const RegressorSystem& system = a.system;
  const KeptRows& kept = marginalised_system(a, best).kept;
  const auto left_mm = [&](VectorXd of_rows) {
    return rms_of_units_mm(system, kept,
                           left_by(kept, system.by_setting, system.sigma, std::move(of_rows)));
  };
  law.rms_mm = left_mm(best.rows(system));
  const double all = left_mm(system.e - linear::product(system.by_setting, system.expected_change));
  law.share = all > 0.0 ? std::min(std::pow(law.rms_mm / all, 2), 1.0) : 0.0;
}

/// A law with its best point.
struct FoundLaw {
  Law law;
  const WeighedLaw* best = nullptr;
};

/// Laws with one variable and one way to enter; without a probability if they are too improbable to report.
FoundLaw law_of(const Analysis& a, const LawPoints& points, double log_all) {
  std::map<LawShape, double> shapes;
  double sum = 0.0;
  for (const WeighedLaw* point : points) {
    const double p = std::exp(point->log_weight - log_all);
    shapes[point->curve->shape] += p;
    sum += p;
  }
  if (sum < kLeastLaw) return {};
  const auto likeliest =
      max_element(shapes, [](const auto& x, const auto& y) { return x.second < y.second; });
  LawPoints of_curve = points;
  std::erase_if(of_curve,
                [&](const WeighedLaw* own) { return own->curve->shape != likeliest->first; });
  const WeighedLaw& best =
      **max_element(of_curve, ascending([](const WeighedLaw* own) { return log_density(*own); }));
  std::erase_if(of_curve, [&](const WeighedLaw* own) { return own->curve != best.curve; });
  Law law{*best.curve};
  law.probability = averaged_over_parts(a, best, std::min(sum, 1.0));
  law.shape_probability = std::min(likeliest->second / sum, 1.0);
  law.parameters = estimates(best, of_curve);
  measure(a, best, law);
  law.points = residuals_about(a, best, law);
  if (law.probability >= kLawLikely) law.held_out = held_out_with(a, best, of_curve);
  return {std::move(law), &best};
}

/// Systems of the best model and of the one that rejects least: a law at the border looks like bad
/// points there.
Indices systems_to_weigh(const ModelComparison& comparison) {
  const auto rejected = [&](std::size_t k) {
    const Flags& outliers = comparison.marginalised_systems[k].outliers;
    return count_equal(outliers, true);
  };
  Indices numbers = {comparison.best().marginalised};
  std::size_t fewest = numbers.front();
  for (const auto k : each_index(comparison.marginalised_systems)) {
    if (rejected(k) < rejected(fewest)) fewest = k;
  }
  if (fewest != numbers.front()) numbers.push_back(fewest);
  return numbers;
}

}  // namespace

double probability_of_any(const std::vector<LawEvidence>& evidence) {
  return std::max(
      0.0, -std::expm1(log_sum(mapped(evidence, &LawEvidence::log_without)) - log_total(evidence)));
}

LawsFound laws_found(const Analysis& a) {
  LawsFound found;
  std::vector<LawCurve> curves = law_curves(a.system);
  // Coordinates on several sheets have different frames; chains share one.
  if (a.session.sheets > 1) {
    std::erase_if(curves, [](const LawCurve& curve) {
      return curve.of == Coordinate::x || curve.of == Coordinate::y ||
             curve.of == Coordinate::across || curve.of == Coordinate::border;
    });
  }
  if (curves.empty()) return found;
  const Indices systems = systems_to_weigh(a.comparison);
  std::vector<LawEvidence> evidence(systems.size());
  for_each_index(systems.size(),
                 [&](std::size_t k) { evidence[k] = weigh_laws(a, systems[k], curves); });
  if (probability_of_any(evidence) < kLawLikely) return found;
  const double log_all = log_total(evidence);
  std::map<std::pair<Coordinate, Enters>, LawPoints> answers;
  for (const LawEvidence& own : evidence) {
    for (const WeighedLaw& law : own.laws)
      answers[{law.curve->of, law.curve->enters}].push_back(&law);
  }
  std::vector<LawPoints> points;  // for each variable and way to enter
  for (auto& [key, own] : answers) points.push_back(std::move(own));
  std::vector<FoundLaw> laws(points.size());
  for_each_index(points.size(), [&](std::size_t k) { laws[k] = law_of(a, points[k], log_all); });
  stable_sort(laws, descending([](const FoundLaw& own) { return own.law.probability; }));
  // Parts of the bed may contradict the result of the whole.
  std::erase_if(laws, [](const FoundLaw& own) { return own.law.probability < kLeastLaw; });
  double any = 0.0;
  for (const FoundLaw& own : laws) any += own.law.probability;
  if (any < kLawLikely) return found;
  for (FoundLaw& own : laws) {
    if (found.laws.size() == kMostLaws) break;
    found.laws.push_back(std::move(own.law));
    found.heaviest.push_back(*own.best);
  }
  return found;
}

namespace {

/// If no cause alone is this likely, none will be named: the odds of a cause named at 90 % are
/// eighty times these, and only two causes that mask each other gain as much together.
constexpr double kHardlyLikely = 0.1;

/// Whether some cause deserves a second comparison, by its evidence alone.
bool may_name_a_cause(const Analysis& a, const VectorXd& rows) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const VectorXd e = marginalised.e - reduced(marginalised, rows);
  const double beforehand = log_odds_of_another(a.system, {}, false);
  const double least = std::log(kHardlyLikely / (1.0 - kHardlyLikely));
  return any_of(single_scores(a.system, marginalised, e),
                [&](const CauseScore& own) { return own.log_factor + beforehand > least; });
}

bool holds(const Analysis& a, const CauseId& cause) {
  return contains(a.decision.listed, a.decision.class_of(cause));
}

}  // namespace

std::optional<VectorXd> rows_of_claimed_law(const Analysis& a, const LawsFound& laws) {
  if (laws.laws.empty() || laws.laws.front().probability < kLawClaimed) return std::nullopt;
  VectorXd rows = laws.heaviest.front().rows(a.system);
  if (a.decision.listed.empty() && !may_name_a_cause(a, rows)) return std::nullopt;
  return rows;
}

std::vector<CauseGivenLaw> changed_causes(const Analysis& without_law, const Analysis& given_law) {
  std::vector<CauseGivenLaw> changed;
  for (Cause& cause : causes_found(given_law)) {
    if (holds(without_law, cause.cause)) continue;
    changed.push_back({cause.cause, cause.probability, probability_of(without_law, cause.cause),
                       std::move(cause.parameters)});
    for (SameCause& same : cause.same_as) changed.back().same_as.push_back(same.cause);
  }
  stable_sort(changed, descending(&CauseGivenLaw::probability));
  for (const CauseId& cause : without_law.decision.leaders()) {
    if (holds(given_law, cause)) continue;
    changed.push_back(
        {cause, probability_of(given_law, cause), probability_of(without_law, cause), {}});
  }
  return changed;
}

void take_names_back(const Analysis& given_law, Analysis& a) {
  std::vector<CauseId> lost = a.decision.leaders();
  std::erase_if(lost, [&](const CauseId& cause) {
    return holds(given_law, cause) || probability_of(given_law, cause) >= kLikelierThanNot;
  });
  if (lost.empty()) return;
  if (lost.size() == a.decision.listed.size()) {
    withdraw_names(a.comparison, a.decision);
  } else if (a.decision.verdict == Verdict::several_causes) {
    std::erase_if(a.decision.regressors, [&](int k) {
      return any_of(
          lost, [&](const CauseId& cause) { return same_class(a, regressor(a, k).cause, cause); });
    });
    std::erase_if(a.decision.listed, [&](std::size_t index) {
      return contains(lost, a.decision.classes[index].front());
    });
    if (a.decision.listed.size() == 1) a.decision.verdict = Verdict::named;
  }
  estimate_decided(a);
  for (ClassProbability& one : a.decision.marginal) {
    const CauseId& cause = a.decision.classes[one.index].front();
    if (contains(lost, cause)) one.probability = probability_of(given_law, cause);
  }
  stable_sort(a.decision.marginal, descending(&ClassProbability::probability));
}

std::vector<CauseGivenLaw> name_given_law(const LawsFound& laws, const AnalysisRules& rules,
                                          Analysis& a) {
  const auto rows = rows_of_claimed_law(a, laws);
  if (!rows) return {};
  const Analysis given = analyse_without(a, *rows, rules);
  std::vector<CauseGivenLaw> changed = changed_causes(a, given);
  take_names_back(given, a);
  return changed;
}

}  // namespace chaintrue::grid::diagnosis
