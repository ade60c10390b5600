// SPDX-License-Identifier: GPL-3.0-or-later

#include "grid/diagnosis/held_out_fold.hpp"
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/other_places.hpp"
#include "grid/diagnosis/stability.hpp"
#include "grid/estimation/spatial_blocks.hpp"
#include "grid/raster.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// The discrepancy preferred given these causes, or none. If the comparison contains no model of these causes, the best
/// model's is used.
int preferred_discrepancy(const ModelComparison& comparison, std::size_t marginalised,
                          const RegressorSet& causes) {
  const auto* model = find_where(comparison.models, [&](const CandidateModel& own) {
    return own.regressors == causes && own.marginalised == marginalised;
  });
  return model != nullptr ? model->discrepancy : comparison.best().discrepancy;
}

/// Errors at the units of a fold, of models fitted without them.
Errors errors_at(const Indices& units, const Analysis& a, const ModelComparison& comparison,
                 const Decision& decision) {
  const MarginalisedSystem marginalised =
      marginalise(a.system, comparison.marginalised_systems[decision.marginalised].outliers);
  std::map<int, DiscrepancyNoise> noise;
  // The residual without the model's discrepancy.
  const auto left = [&](const MarginalisedSystem& own, const RegressorSet& causes,
                        const DiscrepancyNoise& given) {
    const Estimate model = estimate(a.system, own, causes, given);
    return errors_of_units(a.system, left_of_machine(a.system, model, model.left_given_discrepancy),
                           units);
  };
  const auto with = [&](const MarginalisedSystem& own, const RegressorSet& causes) {
    const int discrepancy = preferred_discrepancy(comparison, decision.marginalised, causes);
    const auto [known, is_new] = noise.try_emplace(discrepancy);
    if (is_new) known->second = discrepancy_noise(a.system, marginalised, discrepancy);
    return ErrorsWith{left(own, causes, discrepancy_noise(a.system, own, -1)),
                      left(marginalised, causes, known->second)};
  };
  return {{with(without_slips(a, marginalised), {}), with(marginalised, decision.regressors),
           with(marginalised, a.decision.regressors)}};
}

bool hangs_on_visits(const Analysis& a) {
  return any_of(a.decision.regressors, [&](int k) {
    const Regressor& d = a.system.regressor(k);
    return !d.slip && model::effects::depends_on_visit(*d.cause.effect);
  });
}

/// Places over the rectangle that the marks span, 100 mm apart on a whole bed: waves of a sprocket's
/// turn included.
ObservationSet over_the_area(const Analysis& a) {
  return session_at(a, raster(marked_area(a.session), 25, 13, RasterOf::cells));
}

/// Expected drop and remaining uncertainty of the error over some units.
ExpectedImprovement over_units(const RegressorSystem& there, const VectorXd& moved,
                               const MatrixXd& design, const MatrixXd& covariance) {
  double drop = 0.0;
  double doubt = 0.0;
  for (std::size_t u = 0; u < there.units.size(); ++u) {
    const SystemUnit& unit = there.units[u];
    MatrixXd to_mm = unit.whitening.inverse();
    if (unit.reads_chains)
      to_mm = there.places[unit.places.front().place].state.by_mark.inverse() * to_mm;
    drop += error_of_unit(there, moved, u).squaredNorm();
    const MatrixXd by_unknown =
        linear::product(to_mm, design.middleRows(unit.first_row, unit.rows));
    doubt += linear::carried(by_unknown, covariance).trace();
  }
  const auto count = as_double(there.units.size());
  return {drop / count, drop > 0.0 ? drop / (drop + doubt) : 0.0};
}

}  // namespace

DecidedWithout decided_without(const Analysis& a, const Downdating& downdating,
                               const Indices& units) {
  DecidedWithout result{downdating.without(units), {}};
  Flags excluded(a.session.units.size(), false);
  for (const std::size_t u : units) excluded[u] = true;
  const bool detected =
      a.options.given_cause.has_value() || a.null.p_value(result.models.score) < kFalseAlarm;
  result.decision =
      decide(a.system, result.models.comparison, excluded, detected, a.decision.classes);
  return result;
}

Fold fold_without(const Analysis& a, const Downdating& downdating, const Indices& units) {
  const auto [without, decision] = decided_without(a, downdating, units);
  // A reading that is wrong only at its own visit carries no information about others.
  Flags out = marginalised_system(a).outliers;
  reject_slips(a, out);
  Fold fold;
  for (const std::size_t u : units) {
    if (!out[u]) fold.units.push_back(u);
  }
  fold.named = decision.leaders();
  fold.errors = errors_at(fold.units, a, without.comparison, decision);
  return fold;
}

namespace {

/// Blocks of the bed over all marks with chain readings; none if there are too few.
HeldOutBlocks blocks_of_the_bed(const ObservationSet& session) {
  std::vector<LengthPoint> points;
  Indices units;
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
  for (LeftOut& hole : holes_to_leave_out(session)) result.units.push_back(std::move(hole.units));
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

MarginalisedSystem without_slips(const Analysis& a, const MarginalisedSystem& marginalised) {
  Flags outliers = marginalised.outliers;
  reject_slips(a, outliers);
  return marginalise(a.system, outliers);
}

ExpectedImprovement expected_improvement(const Analysis& a) {
  // Distances have positions only where they were read.
  const bool of_distances = !a.session.reads_chains();
  const ObservationSet area = of_distances || hangs_on_visits(a) ? a.session : over_the_area(a);
  auto there = linearise(area, a.state);
  if (!there || area.units.empty()) return {};
  // An error of the tape is not an error of the machine.
  if (of_distances) there->by_setting.rightCols(there->nuisances).setZero();
  const Estimate plain = estimate(a.system, without_slips(a, marginalised_system(a)), {}, -1);
  const Estimate named = estimate_of(a, a.decision.regressors);
  const ExpectedRows expected = expected_rows(a, named, *there, [&](const Regressor& own) {
    return own.slip ? std::nullopt : signature(area, a.state, *there, own);
  });
  const VectorXd moved = linear::product(there->by_setting, plain.setting_change) - expected.mean;
  return over_units(*there, moved, expected.by_unknown, named.covariance);
}

}  // namespace chaintrue::grid::diagnosis
