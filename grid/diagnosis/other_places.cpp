// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/held_out_improvement.hpp"
#include "grid/diagnosis/model_comparison.hpp"
#include "grid/estimation/spatial_blocks.hpp"
#include "grid/failed.hpp"
#include "grid/raster.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// The first part with chain readings at marks.
std::size_t chain_part(const ObservationSet& session) {
  const auto* found = find_where(session.parts, &ObservationPart::reads_chains);
  return as_size(found - session.parts.data());
}

}  // namespace

interp::Rectangle marked_area(const ObservationSet& session) {
  const auto& places = session.parts[chain_part(session)].observation->places();
  const MarkPoint first = places.front().mark;
  interp::Rectangle area{first.x_mm, first.x_mm, first.y_mm, first.y_mm};
  for (const Place& place : places) take_in(area, place.mark);
  return area;
}

FollowUp readings_at(const ObservationSet& session, std::size_t part, std::vector<Place> places) {
  const auto& own = dynamic_cast<const ChainLengthReadings&>(*session.parts[part].observation);
  return {std::make_shared<const ChainLengthReadings>(ChainLengthReadings::in_given_order(
              std::move(places), false, own.noise(), own.noise_dof(), own.sheet())),
          part};
}

ObservationSet session_at(const Analysis& a, const std::vector<MarkPoint>& marks) {
  const std::size_t part = chain_part(a.session);
  const observation::View view = a.state.view(a.session.parts[part]);
  std::vector<Place> places;
  for (const MarkPoint& mark : marks) {
    if (view.chains().at(view.sheet.to_bed(mark))) places.push_back({0, "", mark, {}, 0});
  }
  return with_observations(a.session, {readings_at(a.session, part, std::move(places))});
}

ExpectedRows expected_rows(const Analysis& a, const Estimate& fitted, const RegressorSystem& there,
                           const std::function<std::optional<VectorXd>(const Regressor&)>& column) {
  const Index settings = fitted.setting_change.size();
  const auto by_setting = there.by_setting.leftCols(settings);
  ExpectedRows result{linear::product(by_setting, fitted.setting_change),
                      MatrixXd::Zero(by_setting.rows(), fitted.covariance.cols())};
  result.by_unknown.leftCols(settings) = by_setting;
  Index next = settings;
  for (const auto k : each_index(fitted.regressors)) {
    const bool is_free = contains(fitted.free, k);
    if (const auto g = column(regressor(a, fitted.regressors[k]))) {
      result.mean += *g * fitted.coefficient(as_index(k));
      if (is_free) result.by_unknown.col(next) = *g;
    }
    if (is_free) ++next;
  }
  return result;
}

VectorXd pattern_at(const Analysis& a, const Estimate& fitted, const RegressorSystem& there) {
  if (fitted.discrepancy_weights.size() == 0) return VectorXd::Zero(there.e.size());
  const KeptRows& kept = marginalised_system(a).kept;
  return linear::product(discrepancy_at(there, fitted.discrepancy, a.system, kept).across,
                         fitted.discrepancy_weights);
}

namespace {

/// Residuals with the placement of the sheet, and nothing else, fitted to the points that count:
/// whitened rows of points.
VectorXd placed(RegressorSystem system, const VectorXd& left) {
  const Index sheet = system.setting.size() - std::ssize(kMachineSettings);
  if (sheet == 0) return left;
  system.by_setting = system.by_setting.rightCols(sheet).eval();
  system.setting = system.expected_change = VectorXd::Zero(sheet);
  system.sigma = system.sigma.tail(sheet).eval();
  system.g = RegressorColumns(system.e.size());
  system.e = left;
  const auto outliers = outlier_sets(system, nothing_rejected(system), {{}}).front();
  return left_by(KeptRows(system, outliers), system.by_setting, system.sigma, left);
}

/// Residuals of the second session with the first one's model, before placing its sheet.
VectorXd left_of(const Analysis& a, const Estimate& model, const ObservationSet& to,
                 const State& state, const RegressorSystem& system) {
  const auto machine = std::ssize(kMachineSettings);
  VectorXd left = system.e - linear::product(system.by_setting.leftCols(machine),
                                             model.setting_change.head(machine));
  for (const auto k : each_index(model.regressors)) {
    const Regressor& d = a.system.regressor(model.regressors[k]);
    // A drift, a skip or a miscount belongs to its session; play belongs to the machine, but shows
    // only where the order of the visits is known.
    if (d.cause.effect->station == Station::reading) continue;
    if (d.cause.effect->needs == DataNeed::order && !to.ordered()) continue;
    const auto g = signature(to, state, system, d);
    if (g) left -= *g * model.coefficient(as_index(k));
  }
  return left - pattern_at(a, model, system);
}

Indices block_numbers(const ObservationSet& session) {
  const std::vector<LengthPoint> points(session.places.begin(), session.places.end());
  Indices number(points.size(), 0);
  const auto blocks = spatial_blocks(points);
  for (const auto b : each_index(blocks)) {
    for (const std::size_t i : blocks[b]) number[i] = b;
  }
  return number;
}

HeldOut summary(const ObservationSet& to, const RegressorSystem& system, const VectorXd& left,
                std::uint64_t seed) {
  return summarise(errors_of_units(system, left, numbers_below(system.units.size())),
                   block_numbers(to), seed);
}

}  // namespace

tl::expected<Transfer, DiagnosisFailure> transfer(const MeasuredGrid& from,
                                                  const Diagnosis& diagnosis,
                                                  const MeasuredGrid& to) {
  const auto first = observations_of(from);
  if (!first) return failed(first);
  // The second grid is treated as measured with the first one's machine, regardless of its file.
  MeasuredGrid other = to;
  other.machine = from.machine;
  if (!other.noise) {
    const auto& own = *parts_of<ChainLengthReadings>(*first).front().second;
    other.noise = StatedNoise{own.noise().length_mm, own.noise().position_mm, own.noise_dof()};
  }
  other.readings.clear();
  auto second = observations_of(other);
  if (!second) return failed(second);
  DiagnosisOptions options;
  options.seed = diagnosis.seed;
  const auto analysis = analyse(*first, options);
  if (!analysis) return failed(analysis);
  const Analysis& a = *analysis;
  // The other sheet was placed separately.
  State state{a.state.mechanism, std::vector<SheetPlacement>(second->sheets)};
  if (first->sheets == second->sheets) state.sheets = a.state.sheets;
  const auto system = linearise(*second, state);
  const auto stated = linearise(*second, stated_state(*second));
  if (!system || !stated) {
    return failed(DiagnosisFailure::Reason::point_unreachable,
                  "a point of the other grid cannot be reached");
  }
  const auto predicted_by = [&](const RegressorSet& regressors, int discrepancy) {
    const Estimate model = estimate(a.system, marginalised_system(a), regressors, discrepancy);
    return summary(*second, *system, placed(*system, left_of(a, model, *second, state, *system)),
                   options.seed);
  };
  Transfer result;
  result.points = second->places.size();
  result.uncalibrated =
      summary(*second, *stated, placed(*stated, uncalibrated(*second, *stated)), options.seed);
  result.calibrated = predicted_by({}, -1);
  result.extended = predicted_by(a.decision.regressors, -1);
  result.extended_and_surface = predicted_by(a.decision.regressors, a.decision.best_discrepancy);
  result.noise_floor_mm = noise_of_units_mm(*system, numbers_below(system->units.size()));
  return result;
}

}  // namespace chaintrue::grid::diagnosis
