// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/held_out_fold.hpp"

#include "grid/containers.hpp"
#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/expected_improvement.hpp"
#include "grid/estimation/spatial_blocks.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Errors at the units of a fold, of models fitted without them.
class FoldErrors {
 public:
  FoldErrors(const Analysis& analysis, const Downdating::Without& without, const Decision& decision)
      : a_(analysis),
        comparison_(without.comparison),
        decision_(decision),
        marginalised_(marginalise_rows(
            a_.system, comparison_.marginalised_systems[decision.marginalised].outliers)) {}

  [[nodiscard]] Errors at(const std::vector<std::size_t>& units) const {
    const std::vector<int>& all = a_.decision.regressors;
    const auto with = [&](const MarginalisedSystem& marginalised, const std::vector<int>& causes) {
      return ErrorsWith{left_at(units, fit(marginalised, causes)),
                        left_at(units, fit(marginalised_, causes, preferred_discrepancy(causes)))};
    };
    return {with(without_slips(a_, marginalised_), {}),
            with(marginalised_, decision_.regressors),
            with(marginalised_, all)};
  }

 private:
  [[nodiscard]] Estimate fit(const MarginalisedSystem& marginalised,
                             const std::vector<int>& regressors,
                             int discrepancy = -1) const {
    return estimate(a_.system, marginalised, regressors, discrepancy);
  }

  /// The discrepancy preferred given these causes, or none. If the comparison contains no model of
  /// these causes, the best model's is used.
  [[nodiscard]] int preferred_discrepancy(const std::vector<int>& regressors) const {
    for (const CandidateModel& model : comparison_.models) {
      if (model.regressors == regressors && model.marginalised == decision_.marginalised)
        return model.discrepancy;
    }
    return comparison_.best().discrepancy;
  }

  /// The model's residual without its discrepancy.
  [[nodiscard]] std::vector<Eigen::Vector2d> left_at(const std::vector<std::size_t>& units,
                                                     const Estimate& model) const {
    const Eigen::VectorXd left = left_of_machine(a_.system, model, model.left_given_discrepancy);
    std::vector<Eigen::Vector2d> result;
    for (const std::size_t u : units) result.push_back(error_of_unit(a_.system, left, u));
    return result;
  }

  const Analysis& a_;
  const ModelComparison& comparison_;
  const Decision& decision_;
  MarginalisedSystem marginalised_;
};

}  // namespace

DecidedWithout decided_without(const Analysis& a,
                               const Downdating& downdating,
                               const std::vector<std::size_t>& units) {
  DecidedWithout result{downdating.without(units), {}};
  std::vector<bool> excluded(a.session.units.size(), false);
  for (const std::size_t u : units) excluded[u] = true;
  const bool detected =
      a.options.given_cause.has_value() || a.null.p_value(result.models.score) < kFalseAlarm;
  result.decision =
      decide(a.system, result.models.comparison, excluded, detected, a.decision.classes);
  return result;
}

HeldOutFolds::HeldOutFolds(const Analysis& analysis)
    : analysis_(analysis), downdating_(analysis.system, analysis.comparison) {}

Fold HeldOutFolds::without(const std::vector<std::size_t>& units) const {
  const Analysis& a = analysis_;
  const auto [without, decision] = decided_without(a, downdating_, units);
  // A reading that is wrong only at its own visit carries no information about others.
  std::vector<bool> out = marginalised_system(a).outliers;
  reject_slips(a, out);
  Fold fold;
  for (const std::size_t u : units) {
    if (!out[u]) fold.units.push_back(u);
  }
  fold.named = decision.leaders();
  fold.errors = FoldErrors(a, without, decision).at(fold.units);
  return fold;
}

namespace {

/// Blocks of the bed over all marks with chain readings; none if there are too few.
HeldOutBlocks blocks_of_the_bed(const ObservationSet& session) {
  std::vector<LengthPoint> points;
  std::vector<std::size_t> units;
  for (const auto& [part, readings] : parts_of<observation::ChainLengthReadings>(session)) {
    for (std::size_t i = 0; i < readings->places().size(); ++i) {
      const NumberedPlace& place = session.places[part->first_place + i];
      points.push_back({place.index, place.mark, place.lengths});
      units.push_back(part->first_unit + i);
    }
  }
  HeldOutBlocks result{{}, true};
  if (points.size() < 2 * kFewestPoints) return result;
  result.units = spatial_blocks(points);
  for (auto& block : result.units) {
    for (std::size_t& u : block) u = units[u];
  }
  return result;
}

/// Each hole with all its distances; none if too few distances would remain.
HeldOutBlocks blocks_by_hole(const ObservationSet& session) {
  HeldOutBlocks result;
  for (const auto& [part, tape] : parts_of<observation::TapeDistances>(session)) {
    const MeasuredHoles& set = tape->set();
    const std::size_t first = result.units.size();
    result.units.resize(first + set.holes.size());
    for (std::size_t k = 0; k < set.distances.size(); ++k) {
      const HoleDistance& distance = set.distances[k];
      result.units[first + distance.from].push_back(part->first_unit + k);
      if (!distance.edge) result.units[first + distance.to].push_back(part->first_unit + k);
    }
  }
  std::erase_if(result.units, [](const auto& block) { return block.empty(); });
  const bool enough = all_of(result.units, [&](const auto& block) {
    return session.units.size() - block.size() >= kFewestDistances;
  });
  if (!enough) result.units.clear();
  return result;
}

}  // namespace

HeldOutBlocks held_out_blocks(const ObservationSet& session) {
  constexpr std::size_t kFewestBlocks = 3;
  for (const auto& blocks : {blocks_of_the_bed(session), blocks_by_hole(session)}) {
    if (blocks.units.size() >= kFewestBlocks) return blocks;
  }
  return {};
}

}  // namespace chaintrue::grid::diagnosis
