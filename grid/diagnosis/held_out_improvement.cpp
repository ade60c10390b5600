// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/held_out_improvement.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <map>

#include "grid/diagnosis/stability.hpp"
#include "grid/estimation/spatial_blocks.hpp"
#include "grid/parallel.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/random.hpp"
#include "grid/raster.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Errors of the tool in mm with some causes, without a surface and with one.
struct ErrorsWith {
  std::vector<Vector2d> machine, and_surface;
};
/// None, those that the fold itself names, and those that all units name, their sizes fitted without the
/// fold.
enum CausesOfFold { kCalibrated, kExtended, kFixedNaming };
using Errors = std::array<ErrorsWith, 3>;  ///< by CausesOfFold

/// The decision's marginalised system without the points that only causes at one visit explain: a
/// calibration without these causes would reject them too.
MarginalisedSystem without_slips(const Analysis& a, const MarginalisedSystem& marginalised) {
  Flags outliers = marginalised.outliers;
  reject_slips(a, outliers);
  return marginalise(a.system, outliers);
}

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
    return !d.slip && depends_on_visit(*d.cause.effect);
  });
}

/// Places over the rectangle that the marks span, 100 mm apart on a whole bed: waves of a sprocket's
/// turn included.
ObservationSet over_the_area(const Analysis& a) {
  return session_at(a, raster(marked_area(a.session), 25, 13, RasterOf::cells));
}

/// Sets the expected drop and the remaining uncertainty of the error over some units.
void expect_over(const RegressorSystem& there, const VectorXd& moved, const MatrixXd& design,
                 const MatrixXd& covariance, HeldOutImprovement& improvement) {
  double drop = 0.0;
  double doubt = 0.0;
  for (const auto u : each_index(there.units)) {
    const SystemUnit& unit = there.units[u];
    MatrixXd to_mm = unit.whitening.inverse();
    if (unit.reads_chains)
      to_mm = there.places[unit.places.front().place].state.by_mark.inverse() * to_mm;
    drop += error_of_unit(there, moved, u).squaredNorm();
    const MatrixXd by_unknown =
        linear::product(to_mm, design.middleRows(unit.first_row, unit.rows));
    doubt += linear::carried(by_unknown, covariance).trace();
  }
  improvement.drop_mm2 = drop / as_double(there.units.size());
  improvement.drop_share = drop > 0.0 ? drop / (drop + doubt) : 0.0;
}

/// Over the measured area with equal weights; over the measured distances; or at the points
/// themselves if a cause depends on the visits.
void expect_improvement(const Analysis& a, HeldOutImprovement& improvement) {
  // Distances have positions only where they were read.
  const bool of_distances = !a.session.reads_chains();
  const ObservationSet area = of_distances || hangs_on_visits(a) ? a.session : over_the_area(a);
  auto there = linearise(area, a.state);
  if (!there || area.units.empty()) return;
  // An error of the tape is not an error of the machine.
  if (of_distances) there->by_setting.rightCols(there->nuisances).setZero();
  const Estimate plain = estimate(a.system, without_slips(a, marginalised_system(a)), {}, -1);
  const Estimate named = estimate_of(a, a.decision.regressors);
  const ExpectedRows expected = expected_rows(a, named, *there, [&](const Regressor& own) {
    return own.slip ? std::nullopt : signature(area, a.state, *there, own);
  });
  const VectorXd moved = linear::product(there->by_setting, plain.setting_change) - expected.mean;
  expect_over(*there, moved, expected.by_unknown, named.covariance, improvement);
}

}  // namespace

DecidedWithout decided_without(const Analysis& a, const Downdating& downdating,
                               const Indices& units) {
  DecidedWithout result{downdating.without(units), {}};
  Flags excluded(a.session.units.size(), false);
  for (const std::size_t u : units) excluded[u] = true;
  const bool detected = a.null.p_value(result.models.score) < kFalseAlarm;
  result.decision =
      decide(a.system, result.models.comparison, excluded, detected, a.decision.classes);
  return result;
}

namespace {

/// Held-out units of one fold, or of all.
struct Folds {
  Indices units;
  Indices number;  ///< of the block of each
  Errors errors;
  int agree = 0;  ///< folds that name the same first cause, or name none either
};

/// \param units of the analysis' session, left out of everything. The gate and the decision are
/// those for all units; the models are those of the whole comparison, weighed without these units
/// (downdating.hpp). Outliers and slips of the whole session are not among the fold's units.
Folds fold_without(const Analysis& a, const Downdating& downdating, const Indices& units) {
  const auto [without, decision] = decided_without(a, downdating, units);
  // A reading that is wrong only at its own visit carries no information about others.
  Flags out = marginalised_system(a).outliers;
  reject_slips(a, out);
  Folds fold;
  for (const std::size_t u : units) {
    if (!out[u]) fold.units.push_back(u);
  }
  const std::vector<CauseId> named = decision.leaders();
  fold.agree = as_int(named.empty() ? a.decision.listed.empty()
                                    : contains(a.decision.leaders(), named.front()));
  fold.errors = errors_at(fold.units, a, without.comparison, decision);
  return fold;
}

/// Groups of units that are held out together.
struct HeldOutBlocks {
  std::vector<Indices> units;  ///< empty if there are too few units
  bool of_the_bed = false;     ///< or each hole with all distances that end there
};

/// Blocks of the bed over all marks with chain readings; none if there are too few.
HeldOutBlocks blocks_of_the_bed(const ObservationSet& session) {
  std::vector<LengthPoint> points;
  Indices units;
  for (const auto& [part, readings] : parts_of<ChainLengthReadings>(session)) {
    for (const auto i : each_index(readings->places())) {
      points.push_back(session.places[part->first_place + i]);
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

/// The held-out errors are those of the tool if chains were read at enough marks, else of
/// distances.
HeldOutBlocks held_out_blocks(const ObservationSet& session) {
  constexpr std::size_t kFewestBlocks = 3;
  for (const auto& blocks : {blocks_of_the_bed(session), blocks_by_hole(session)}) {
    if (blocks.units.size() >= kFewestBlocks) return blocks;
  }
  return {};
}

/// Sets the errors of the machine as delivered, and with only the sheets' placement fitted.
void measure_before_calibration(const Analysis& a, const Indices& units, const Indices& number,
                                HeldOutImprovement& improvement) {
  const ObservationSet& session = a.session;
  const auto stated = linearise(session, stated_state(session));
  if (!stated) return;
  const auto summary = [&](const VectorXd& rows) {
    return summarise(errors_of_units(*stated, rows, units), number, a.options.seed);
  };
  const VectorXd as_stated = uncalibrated(session, *stated);
  improvement.uncalibrated = summary(as_stated);
  constexpr auto kOfMachine = std::ssize(kMachineSettings);
  const auto sheet = std::ssize(session.settings) - kOfMachine;
  const auto moves = [&](Index k) {
    return session.settings[as_size(k)] != Setting::sheet_rotation_rad && session.knows(as_size(k));
  };
  if (none_of(numbers_below<Index>(sheet), [&](Index k) { return moves(kOfMachine + k); })) return;
  improvement.placed =
      summary(left_by(marginalised_system(a).kept, stated->by_setting.middleCols(kOfMachine, sheet),
                      stated->sigma.segment(kOfMachine, sheet), as_stated));
}

/// The errors that judge the extension, which must help at points that it was not fitted to; else those
/// of the calibration.
const ErrorsWith& extension_of(const Analysis& a, const Errors& errors) {
  // If these points leave two names without a block, the wrong one first, that says little against
  // the name that all points give.
  for (const CausesOfFold causes : {kExtended, kFixedNaming}) {
    if (!a.decision.listed.empty() &&
        rms_length(errors[causes].machine) < rms_length(errors[kCalibrated].machine))
      return errors[causes];
  }
  return errors[kCalibrated];
}

Folds hold_out_each(const Analysis& a, const HeldOutBlocks& blocks) {
  Folds all;
  tell(a.options.progress, {"what a name gains", 3, 4});
  const Downdating downdating(a.system, a.comparison);
  std::vector<Folds> folds(blocks.units.size());
  for_each_index(folds.size(),
                 [&](std::size_t b) { folds[b] = fold_without(a, downdating, blocks.units[b]); });
  for (const auto b : each_index(folds)) {
    const Folds& fold = folds[b];
    all.agree += fold.agree;
    append_all(all.units, fold.units);
    all.number.insert(all.number.end(), fold.units.size(), b);
    for (const auto k : each_index(all.errors)) {
      append_all(all.errors[k].machine, fold.errors[k].machine);
      append_all(all.errors[k].and_surface, fold.errors[k].and_surface);
    }
  }
  return all;
}

std::string scheme_of(const ObservationSet& session, const HeldOutBlocks& blocks,
                      bool naming_repeated) {
  return fmt::format(
      "{}, each left out in turn, {}",
      blocks.of_the_bed ? fmt::format("{} blocks of the bed", blocks.units.size())
                        : fmt::format("all the distances of each of {} holes", blocks.units.size()),
      naming_repeated ? "the rest diagnosed without it"
                      : fmt::format("with the causes from all {} fitted without it, because "
                                    "leaving some out changes the answer",
                                    session.units_word()));
}

}  // namespace

HeldOut summarise(const std::vector<Vector2d>& tool_mm, const Indices& block, std::uint64_t seed) {
  HeldOut result;
  result.rms_mm = rms_length(tool_mm);
  std::vector<double> sorted;
  for (const Vector2d& e : tool_mm) sorted.push_back(e.norm());
  sort(sorted);
  const auto at = static_cast<std::size_t>(std::ceil(0.95 * as_double(sorted.size())));
  result.percentile_95_mm = sorted[at - 1];
  const std::size_t blocks = 1 + *max_element(block);
  std::vector<double> sum(blocks, 0.0);
  std::vector<double> count(blocks, 0.0);
  for (const auto i : each_index(tool_mm)) {
    sum[block[i]] += tool_mm[i].squaredNorm();
    count[block[i]] += 1.0;
  }
  constexpr int kDraws = 400;  // the 5th and 95th percentile to a tenth of the interval
  constexpr std::uint64_t kStream = 62;
  Random random(seed, kStream);
  std::vector<double> drawn;
  for (int draw = 0; draw < kDraws; ++draw) {
    double s = 0.0;
    double n = 0.0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::size_t k = random.below(blocks);
      s += sum[k];
      n += count[k];
    }
    drawn.push_back(n > 0.0 ? std::sqrt(s / n) : 0.0);
  }
  sort(drawn);
  result.low_mm = drawn[kDraws / 20];
  result.high_mm = drawn[kDraws - 1 - kDraws / 20];
  return result;
}

std::optional<HeldOutImprovement> measure_improvement(const Analysis& a) {
  const HeldOutBlocks blocks = held_out_blocks(a.session);
  const Folds folds = hold_out_each(a, blocks);
  const auto& [units, number, all, agree] = folds;
  if (units.empty()) return std::nullopt;
  HeldOutImprovement improvement;
  improvement.folds = as_int(blocks.units.size());
  improvement.folds_agree = agree;
  const std::uint64_t seed = a.options.seed;
  measure_before_calibration(a, units, number, improvement);
  improvement.calibrated = summarise(all[kCalibrated].machine, number, seed);
  improvement.surface_only = summarise(all[kCalibrated].and_surface, number, seed);
  const ErrorsWith& extension = extension_of(a, all);
  improvement.scheme = scheme_of(a.session, blocks, &extension != &all[kFixedNaming]);
  improvement.extended = summarise(extension.machine, number, seed);
  improvement.extended_and_surface = summarise(extension.and_surface, number, seed);
  improvement.noise_floor_mm =
      std::sqrt(a.estimate.noise_square) * noise_of_units_mm(a.system, units);
  if (&extension != &all[kCalibrated]) expect_improvement(a, improvement);
  return improvement;
}

bool naming_improves_the_map(const Analysis& a) {
  const Errors errors = hold_out_each(a, held_out_blocks(a.session)).errors;
  return rms_length(extension_of(a, errors).and_surface) <
         rms_length(errors[kCalibrated].and_surface);
}

bool naming_improves_the_map(const std::optional<HeldOutImprovement>& improvement) {
  return improvement && improvement->extended_and_surface.rms_mm < improvement->surface_only.rms_mm;
}

VectorXd uncalibrated(const ObservationSet& session, const RegressorSystem& stated) {
  VectorXd e = stated.e;
  for (const SystemUnit& unit : stated.units) {
    if (!unit.reads_chains) continue;
    const std::size_t number = unit.places.front().place;
    const ObservationPart& part = session.parts[session.places[number].part];
    const Place& place = part.observation->places()[number - part.first_place];
    if (!place.commanded) continue;
    e.segment<2>(unit.first_row) = unit.whitening * (stated.places[number].state.by_mark *
                                                     difference(*place.commanded, place.mark));
  }
  return e;
}

}  // namespace chaintrue::grid::diagnosis
