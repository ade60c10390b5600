// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/bed_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "grid/diagnosis/downdating.hpp"
#include "grid/eigen.hpp"
#include "grid/parallel.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kCutDirections = 16;
constexpr double kShareLeftOut = 0.25;
/// Places are on a line if their scatter across the best line is less than this share of that along it.
constexpr double kOnALine = 1e-3;
/// Enough models for 99 % of the probability with 60 marks of a real scan, whose pattern dozens of
/// neighbouring discrepancies share.
constexpr FollowedModels kFollowed{
    .within = 16.0, .most = 1000, .discrepancy_share = 0.002, .most_discrepancies = 30};
/// The cost of a discrepancy grows with the cube of the rows. With more rows than this, the
/// likeliest discrepancies represent the rest.
constexpr Index kRowsForAllDiscrepancies = 500;
constexpr std::size_t kDiscrepanciesOfMany = 6;

FollowedModels followed_of(const RegressorSystem& system) {
  FollowedModels result = kFollowed;
  if (system.e.size() > kRowsForAllDiscrepancies) result.most_discrepancies = kDiscrepanciesOfMany;
  return result;
}

struct UnitPlace {
  std::size_t unit = 0;
  Vector2d at;
};

std::vector<UnitPlace> places_of_units(const RegressorSystem& system) {
  std::vector<UnitPlace> result;
  for (std::size_t u = 0; u < system.units.size(); ++u) {
    const auto& places = system.units[u].places;
    if (places.empty()) continue;
    Vector2d sum = Vector2d::Zero();
    for (const observation::PlaceColumns& own : places)
      sum += vector_of(system.places[own.place].mark);
    result.push_back({u, sum / as_double(places.size())});
  }
  return result;
}

bool lie_on_a_line(const std::vector<UnitPlace>& places) {
  Vector2d mean = Vector2d::Zero();
  for (const UnitPlace& own : places) mean += own.at / as_double(places.size());
  Matrix2d scatter = Matrix2d::Zero();
  for (const UnitPlace& own : places) scatter += (own.at - mean) * (own.at - mean).transpose();
  const VectorXd squares = linear::SymmetricEigen(scatter).eigenvalues();
  return squares(0) <= kOnALine * kOnALine * squares(1);
}

using ModelKey = std::tuple<RegressorSet, int, std::size_t>;
ModelKey key_of(const CandidateModel& model) {
  return {model.regressors, model.discrepancy, model.marginalised};
}

PartPosterior summary(const RegressorSystem& system,
                      const std::vector<const CandidateModel*>& models,
                      const std::vector<double>& probability, BedPart part) {
  PartPosterior result{std::move(part)};
  for (std::size_t k = 0; k < models.size(); ++k) {
    if (!models[k]->regressors.empty()) result.caused += probability[k];
    for (const int regressor : models[k]->regressors) {
      const CauseId& cause = system.regressor(regressor).cause;
      auto* known = find_where(result.causes, [&](const auto& own) { return own.first == cause; });
      auto& own = known != nullptr ? *known : result.causes.emplace_back(cause, 0.0);
      own.second += probability[k];
    }
  }
  result.caused = std::min(result.caused, 1.0);
  return result;
}

/// Shares out the total weight of models with a pattern in proportion to these weights of some; those
/// without keep theirs.
void redistribute(const std::map<ModelKey, double>& weights, double together,
                  ModelComparison& comparison) {
  // Floor for a model that no part supports, so that its logarithm is finite.
  constexpr double kNothing = 1e-300;
  double all = kNothing;
  for (const auto& [key, weight] : weights) all += weight;
  for (CandidateModel& model : comparison.models) {
    const auto found = weights.find(key_of(model));
    const double p = found != weights.end()   ? found->second / all * together
                     : model.discrepancy >= 0 ? 0.0
                                              : comparison.probability(model);
    model.log_weight = std::log(std::max(p, kNothing));
  }
  sort_by_weight(comparison);
}

}  // namespace

std::vector<BedPart> bed_parts(const RegressorSystem& system, std::size_t fewest) {
  std::vector<UnitPlace> places = places_of_units(system);
  const auto out = static_cast<std::size_t>(kShareLeftOut * as_double(places.size()));
  std::vector<BedPart> parts;
  for (int k = 0; k < kCutDirections && out > 0; ++k) {
    // Half a step from the axes, so that no line runs along the columns of a lattice.
    const double towards = (k + 0.5) * 2.0 * std::numbers::pi / kCutDirections;
    const Vector2d direction(std::cos(towards), std::sin(towards));
    const auto along = [&](const UnitPlace& own) { return direction.dot(own.at); };
    stable_sort(places, descending(along));
    // Readings of one mark stay together.
    constexpr double kOneMarkMm = 1e-6;
    const double last = along(places[out - 1]) - kOneMarkMm;
    const auto rest = std::find_if(places.begin(), places.end(),
                                   [&](const UnitPlace& own) { return along(own) < last; });
    BedPart part{towards, {}};
    for (auto own = places.begin(); own != rest; ++own) part.units.push_back(own->unit);
    const std::size_t left = places.size() - part.units.size();
    if (left >= std::max<std::size_t>(fewest, 3) && !lie_on_a_line({rest, places.end()}))
      parts.push_back(std::move(part));
  }
  if (2 * parts.size() < as_size(kCutDirections)) parts.clear();
  return parts;
}

std::vector<PartPosterior> average_over_parts(const RegressorSystem& system, std::size_t fewest,
                                              ModelComparison& comparison) {
  std::vector<PartPosterior> result;
  double pattern = 0.0;
  for (const CandidateModel& model : comparison.models) {
    if (model.discrepancy >= 0) pattern += comparison.probability(model);
  }
  if (pattern <= kDiscrepancyLikely) return result;
  std::vector<BedPart> parts = bed_parts(system, fewest);
  if (parts.empty()) return result;
  const Downdating downdating(system, comparison, followed_of(system));
  const std::vector<const CandidateModel*> models = downdating.followed();
  std::vector<std::vector<double>> of_part(parts.size());
  for_each_index(parts.size(), [&](std::size_t p) {
    of_part[p] = downdating.probabilities_without(parts[p].units, CountAs::all);
  });
  std::map<ModelKey, double> weights;  // of models with a pattern
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::size_t k = 0; k < models.size(); ++k) {
      if (models[k]->discrepancy >= 0) weights[key_of(*models[k])] += of_part[p][k];
    }
    result.push_back(summary(system, models, of_part[p], std::move(parts[p])));
  }
  redistribute(weights, pattern, comparison);
  return result;
}

std::vector<PartPosterior> session_posteriors(const RegressorSystem& system, std::size_t fewest,
                                              const ModelComparison& comparison) {
  std::vector<PartPosterior> result;
  std::size_t sessions = 0;
  for (const SystemUnit& unit : system.units) sessions = std::max(sessions, unit.observation + 1);
  if (sessions < 2) return result;
  const Downdating downdating(system, comparison, followed_of(system));
  for (std::size_t session = 0; session < sessions; ++session) {
    BedPart others;
    for (std::size_t u = 0; u < system.units.size(); ++u) {
      if (system.units[u].observation != session) others.units.push_back(u);
    }
    if (system.units.size() - others.units.size() < std::max<std::size_t>(fewest, 1)) continue;
    const std::vector<double> own =
        downdating.probabilities_without(others.units, CountAs::themselves);
    result.push_back(summary(system, downdating.followed(), own, std::move(others)));
    result.back().session = session;
  }
  if (result.size() < 2) result.clear();
  return result;
}

}  // namespace chaintrue::grid::diagnosis
