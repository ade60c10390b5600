// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "grid/diagnosis/law_residuals.hpp"
#include "grid/eigen.hpp"
#include "grid/parallel.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr std::size_t kMostLaws = 3;
/// Below it a wave has no phase.
constexpr double kSmallestWaveMm = 1e-9;
/// Less likely laws are not listed.
constexpr double kLeastLaw = 0.03;

double log_total(const std::vector<LawEvidence>& evidence) {
  std::vector<double> terms;
  for (const LawEvidence& own : evidence) terms.push_back(own.log_total());
  return log_sum(terms);
}

/// A point of a curve in one of the systems.
struct FoundPoint {
  const LawEvidence* evidence = nullptr;
  const WeighedLaw* law = nullptr;
  const LawCurve& curve() const { return evidence->curves[law->curve]; }
  /// The posterior density there, up to a factor, independent of the grid's spacing, which is finer
  /// about the leading points. A step's place is one of its gaps.
  double log_density() const {
    const LawCurve& own = curve();
    if (!is_continuous(own.shape)) return law->log_weight;
    const auto at = std::find(own.grid.begin(), own.grid.end(), law->at) - own.grid.begin();
    return law->log_weight - std::log(own.mass[as_size(at)]) + std::log(density_at(own, law->at));
  }
};

/// Size and place (a period, a scale) or size, period and phase of a point, with their variances;
/// of a wave with its second harmonic, also the size and phase of that.
struct PointParameters {
  std::vector<double> value;
  std::vector<double> variance;
};

/// Size and phase of a cosine and a sine.
PointParameters size_and_phase(const Vector2d& a, const Matrix2d& c) {
  const double size = std::max(a.norm(), kSmallestWaveMm);
  const Vector2d along = a / size;
  const Vector2d turned(along(1), -along(0));
  return {{size, std::atan2(a(0), a(1))},
          {along.dot(c * along), turned.dot(c * turned) / (size * size)}};
}

PointParameters parameters_of(const LawCurve& curve, const WeighedLaw& law) {
  const VectorXd& a = law.amplitude;
  const MatrixXd& c = law.covariance;
  switch (curve.shape) {
    case LawShape::linear:
      return {{a(0)}, {c(0, 0)}};
    case LawShape::square: {
      // A bow of zero size has no vertex.
      const double at = a(0) != 0.0 ? -0.5 * a(1) / a(0) : 0.0;
      const Vector2d slope = a(0) != 0.0 ? Vector2d(-at / a(0), -0.5 / a(0)) : Vector2d(0.0, 0.0);
      const double half = 0.5 * curve.span();
      return {{a(0), curve.middle() + half * at}, {c(0, 0), half * half * slope.dot(c * slope)}};
    }
    case LawShape::wave:
    case LawShape::harmonics: {
      const PointParameters first = size_and_phase(a.head<2>(), c.topLeftCorner<2, 2>());
      PointParameters own{{first.value[0], curve.span() / law.at, first.value[1]},
                          {first.variance[0], 0.0, first.variance[1]}};
      if (curve.shape == LawShape::harmonics) {
        const PointParameters second = size_and_phase(a.tail<2>(), c.bottomRightCorner<2, 2>());
        append_all(own.value, second.value);
        append_all(own.variance, second.variance);
      }
      return own;
    }
    case LawShape::step: {
      // Anywhere between two readings.
      const std::size_t k =
          as_size(std::find(curve.grid.begin(), curve.grid.end(), law.at) - curve.grid.begin());
      const double gap = k < curve.mass.size() ? curve.mass[k] * curve.span() : 0.0;
      return {{a(0), law.at}, {c(0, 0), gap * gap / 12.0}};
    }
    default:
      break;
  }
  return {{a(0), law.at}, {c(0, 0), 0.0}};
}

std::vector<std::string> names_of(const LawCurve& curve) {
  const auto with_unit = [&](std::string_view what) {
    return fmt::format("{}_{}", what, unit_of(curve.of));
  };
  switch (curve.shape) {
    case LawShape::linear:
      return {"size_mm"};
    case LawShape::exponential:
      return {"size_mm", with_unit("scale")};
    case LawShape::wave:
      return {"size_mm", with_unit("period"), "phase_rad"};
    case LawShape::harmonics:
      return {"size_mm", with_unit("period"), "phase_rad", "second_size_mm", "second_phase_rad"};
    default:
      break;
  }
  return {"size_mm", with_unit("place")};
}

/// The third and the fifth, for periodic shapes.
bool is_phase(std::size_t parameter) { return parameter == 2 || parameter == 4; }

/// Values of the heaviest point; sigmas over all points of its curve.
std::vector<ParameterEstimate> estimates(const FoundPoint& best,
                                         const std::vector<FoundPoint>& points) {
  const PointParameters own = parameters_of(best.curve(), *best.law);
  const std::size_t count = own.value.size();
  std::vector<double> sum(count, 0.0);
  std::vector<double> square(count, 0.0);
  std::vector<double> within(count, 0.0);
  double weights = 0.0;
  for (const FoundPoint& point : points) {
    const bool same = point.evidence == best.evidence && point.law->curve == best.law->curve;
    if (!same) continue;
    const double w = std::exp(point.law->log_weight - best.law->log_weight);
    const PointParameters there = parameters_of(point.curve(), *point.law);
    for (std::size_t k = 0; k < count; ++k) {
      double off = there.value[k] - own.value[k];
      if (is_phase(k)) off = std::remainder(off, 2.0 * std::numbers::pi);
      sum[k] += w * off;
      square[k] += w * off * off;
      within[k] += w * there.variance[k];
    }
    weights += w;
  }
  const std::vector<std::string> names = names_of(best.curve());
  std::vector<ParameterEstimate> result;
  for (std::size_t k = 0; k < count; ++k) {
    const double mean = sum[k] / weights;
    const double variance = (square[k] + within[k]) / weights - mean * mean;
    result.push_back({names[k], own.value[k], std::sqrt(std::max(variance, 0.0))});
  }
  return result;
}

void measure(const Analysis& a, const FoundPoint& best, Law& law) {
  const RegressorSystem& system = a.system;
  const MarginalisedSystem& marginalised =
      a.comparison.marginalised_systems[best.evidence->marginalised];
  const VectorXd rows = law_columns(system, best.curve(), {best.law->at}) * best.law->amplitude;
  const auto left_mm = [&](VectorXd of_rows) {
    const KeptRows& kept = marginalised.kept;
    return rms_of_units_mm(system, kept,
                           left_by(kept, system.by_setting, system.sigma, std::move(of_rows)));
  };
  law.rms_mm = left_mm(rows);
  const double all = left_mm(system.e - linear::product(system.by_setting, system.expected_change));
  law.share = all > 0.0 ? std::min(std::pow(law.rms_mm / all, 2), 1.0) : 0.0;
}

/// Laws with one variable and one way to enter; without a probability if they are too improbable to report.
std::pair<Law, FoundPoint> law_of(const Analysis& a, const std::vector<FoundPoint>& points,
                                  double log_all) {
  std::map<LawShape, double> shapes;
  double sum = 0.0;
  for (const FoundPoint& point : points) {
    const double p = std::exp(point.law->log_weight - log_all);
    shapes[point.curve().shape] += p;
    sum += p;
  }
  if (sum < kLeastLaw) return {};
  const auto likeliest =
      max_element(shapes, [](const auto& x, const auto& y) { return x.second < y.second; });
  const FoundPoint* best = nullptr;
  for (const FoundPoint& point : points) {
    if (point.curve().shape != likeliest->first) continue;
    if (best == nullptr || point.log_density() > best->log_density()) best = &point;
  }
  const LawCurve& curve = best->curve();
  Law law;
  law.of = curve.of;
  law.shape = curve.shape;
  law.enters = curve.enters;
  law.probability = averaged_over_parts(a, *best->evidence, *best->law, std::min(sum, 1.0));
  law.shape_probability = std::min(likeliest->second / sum, 1.0);
  law.direction_deg = curve.direction_rad * 180.0 / std::numbers::pi;
  law.towards = curve.towards;
  law.from = curve.from;
  law.to = curve.to;
  law.parameters = estimates(*best, points);
  measure(a, *best, law);
  law.points = residuals_about(a, *best->evidence, *best->law, law);
  if (law.probability >= kLawLikely) law.held_out = held_out_with(a, *best->evidence, *best->law);
  return {std::move(law), *best};
}

/// Systems of the best model and of the one that rejects least: a law at the border looks like bad
/// points there.
Indices systems_to_weigh(const ModelComparison& comparison) {
  const auto rejected = [&](std::size_t k) {
    const Flags& outliers = comparison.marginalised_systems[k].outliers;
    return std::count(outliers.begin(), outliers.end(), true);
  };
  Indices numbers = {comparison.best().marginalised};
  std::size_t fewest = numbers.front();
  for (std::size_t k = 0; k < comparison.marginalised_systems.size(); ++k) {
    if (rejected(k) < rejected(fewest)) fewest = k;
  }
  if (fewest != numbers.front()) numbers.push_back(fewest);
  return numbers;
}

}  // namespace

double probability_of_any(const std::vector<LawEvidence>& evidence) {
  std::vector<double> without;
  for (const LawEvidence& own : evidence) without.push_back(own.log_without);
  return std::max(0.0, -std::expm1(log_sum(without) - log_total(evidence)));
}

LawsFound laws_of(const Analysis& a, std::vector<LawEvidence> evidence) {
  LawsFound found{{}, std::move(evidence), {}};
  if (probability_of_any(found.evidence) < kLawLikely) return found;
  const double log_all = log_total(found.evidence);
  std::map<std::tuple<Coordinate, Enters>, std::vector<FoundPoint>> answers;
  for (const LawEvidence& own : found.evidence) {
    for (const WeighedLaw& law : own.laws) {
      const LawCurve& curve = own.curves[law.curve];
      answers[{curve.of, curve.enters}].push_back({&own, &law});
    }
  }
  std::vector<std::vector<FoundPoint>> points;  // for each variable and way to enter
  for (auto& [key, own] : answers) points.push_back(std::move(own));
  std::vector<std::pair<Law, FoundPoint>> laws(points.size());
  for_each_index(points.size(), [&](std::size_t k) { laws[k] = law_of(a, points[k], log_all); });
  stable_sort(laws, descending([](const auto& law) { return law.first.probability; }));
  // Parts of the bed may contradict the result of the whole.
  std::erase_if(laws, [](const auto& law) { return law.first.probability < kLeastLaw; });
  double any = 0.0;
  for (const auto& [law, heaviest] : laws) any += law.probability;
  if (any < kLawLikely) return found;
  if (laws.size() > kMostLaws) laws.erase(laws.begin() + kMostLaws, laws.end());
  for (auto& [law, heaviest] : laws) {
    found.laws.push_back(std::move(law));
    const auto at = as_size(heaviest.evidence - found.evidence.data());
    found.heaviest.push_back({at, as_size(heaviest.law - found.evidence[at].laws.data())});
  }
  return found;
}

LawsFound laws_found(const Analysis& a) {
  if (a.options.given_cause) return {};
  std::vector<LawCurve> curves = law_curves(a.system);
  // Coordinates on several sheets have different frames; chains share one.
  if (a.session.sheets > 1) {
    std::erase_if(curves, [](const LawCurve& curve) {
      return curve.of == Coordinate::x || curve.of == Coordinate::y ||
             curve.of == Coordinate::across || curve.of == Coordinate::border;
    });
  }
  if (curves.empty()) return {};
  const Indices systems = systems_to_weigh(a.comparison);
  std::vector<LawEvidence> evidence(systems.size());
  for_each_index(systems.size(),
                 [&](std::size_t k) { evidence[k] = weigh_laws(a, systems[k], curves); });
  return laws_of(a, std::move(evidence));
}

}  // namespace chaintrue::grid::diagnosis
