// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>

#include "grid/belts/fit_diagnostics.hpp"
#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/belts_analysis.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::diagnosis {

namespace {

/// rms of the distances from where the machine believes the tool, by the upper two belts, to where it is,
/// after the best rigid motion of the frame, which only places the sheet. Without places where these
/// belts do not meet.
double shape_error_mm(const BeltMachine& by, const BeltMachine& real,
                      const std::vector<model::effects::ActingEffect>& effects,
                      const std::vector<FramePoint>& places) {
  // During cutting the upper two hold; effects that set in at a visit are present.
  constexpr int kAfterAll = 1000000000;
  std::vector<Eigen::Vector4d> rows;
  for (const FramePoint& at : places) {
    const auto tl = model::belts::read_belt(real, effects, {Belt::tl, {}, kAfterAll}, at);
    const auto tr = model::belts::read_belt(real, effects, {Belt::tr, {}, kAfterAll}, at);
    if (!tl || !tr) continue;
    if (const auto believed = place_of_upper(by, tl->value, tr->value))
      rows.emplace_back(at.x_mm, at.y_mm, believed->x_mm - at.x_mm, believed->y_mm - at.y_mm);
  }
  if (rows.size() < 2) return 0.0;
  const auto n = std::ssize(rows);
  MatrixXd design(2 * n, 3);
  VectorXd shift(2 * n);
  for (const Index i : each_below(n)) {
    const Eigen::Vector4d& row = rows[as_size(i)];
    design.middleRows<2>(2 * i) = SheetPlacement{}.sensitivity({row[0], row[1]});
    shift.segment<2>(2 * i) = row.tail<2>();
  }
  const VectorXd left = shift - linear::product(design, linear::least_squares(design, shift));
  return std::sqrt(left.squaredNorm() / as_double(n));
}

/// Root mean square over shifts along each axis of the anchors' uncertainty, in both directions.
double uncertain_mm(const BeltMachine& machine, const MatrixXd& covariance,
                    const std::vector<FramePoint>& places) {
  const linear::SymmetricEigen axes(covariance);
  double square = 0.0;
  for (const Index i : each_below(covariance.cols())) {
    const AnchorVector moved =
        anchors_of(machine) +
        std::sqrt(std::max(axes.eigenvalues()[i], 0.0)) * axes.eigenvectors().col(i);
    const double own = shape_error_mm(with_anchors(machine, moved), machine, {}, places);
    square += own * own;
  }
  return std::sqrt(square);
}

ToolError tool_error(const BeltsAnalysis& a, const FitGivenCauses& given,
                     const BeltMachine& machine) {
  const auto effects = resolved(given.causes);
  const std::vector<FramePoint>& places = given.frame.state.places;
  ToolError error;
  error.after_mm = uncertain_mm(machine, a.averaged.covariance_mm2, places);
  const auto of = [&](const BeltMachine& by) {
    return std::hypot(shape_error_mm(by, machine, effects, places), error.after_mm);
  };
  if (a.belts.machine.anchors_known) error.stated_mm = of(a.belts.machine);
  error.before_mm = of(a.before.machine);
  return error;
}

/// For all readings, including rejected ones.
double rms_of_all_mm(const MeasuredBelts& belts, const FitGivenCauses& given) {
  AnchorFit from = given.frame;
  from.counting.assign(belts.points.size(), kAllBelts);
  const FitGivenCauses at = fit_given_causes(belts, given.causes, from).value_or(given);
  const VectorXd left = reading_lines(at.belts, at.frame.state).residual_mm;
  return std::sqrt(left.squaredNorm() / as_double(left.size()));
}

/// From the tape, after correcting for the causes: a stretch lengthens the belts' millimetres as a
/// scale does and would otherwise be corrected twice. Unknown if no frame fits the tape after that.
std::optional<BeltScale> scale_given_causes(const MeasuredBelts& belts,
                                            const FitGivenCauses& given) {
  if (belts.distances.empty()) return std::nullopt;
  MeasuredBelts taped = given.belts;
  taped.distances = belts.distances;
  const auto fitted = fit_anchors_from(taped, given.frame.state, given.frame.counting);
  if (!fitted) return std::nullopt;
  const FitDiagnostics view(taped, *fitted);
  return fit_report(taped, view, view.covariance()).scale;
}

/// Converged anchors, places and sizes with the causes of the decision.
FitGivenCauses explained(const BeltsAnalysis& a) {
  if (auto given = fit_as_decided(a, a)) return *std::move(given);
  FitGivenCauses as_before{{a.frame, without_effects(a.belts, a.known, a.frame.state)}, a.known};
  as_before.frame.counting = decided_counting(a);
  return as_before;
}

BeltsFindings findings_of(const BeltsAnalysis& a, const FitGivenCauses& given,
                          const FitDiagnostics& view) {
  const AnchorFit& frame = given.frame;
  BeltsFindings found;
  found.machine = with_anchors(a.belts.machine, a.averaged.anchors);
  for (const auto i : each_index(found.coordinates)) {
    const AnchorCoordinate& before = a.before.coordinates[i];
    const auto at = as_index(i);
    found.coordinates[i] = {before.name, before.stated_mm, before.fitted_mm, a.averaged.anchors[at],
                            std::sqrt(a.averaged.covariance_mm2(at, at))};
  }
  found.spread_before_mm = a.before.residual_sigma_mm;
  found.rms_before_mm = rms_of_all_mm(a.belts, {{a.alone, a.belts}, {}});
  found.rms_mm = rms_of_all_mm(a.belts, given);
  double good_square = 0.0;
  for (const auto k : each_index(a.belts.points)) {
    BeltPlacePicture place{frame.state.places[k], a.belts.points[k].order, {}, {}, {}};
    for (const Belt belt : kBelts) {
      const BeltResidual left = view.residual(k, belt);
      place.before_mm[belt] = a.before.places[k].belts[belt].residual_mm;
      place.after_mm[belt] = left.residual_mm;
      place.bad[belt] = !frame.counting[k][belt];
      if (left.counts) good_square += left.residual_mm * left.residual_mm;
    }
    found.places.push_back(place);
  }
  const auto values = std::ssize(a.estimate.free);
  found.checks = as_int(std::max<Index>(frame.checks - values, 1));
  found.residual_sigma_mm = std::sqrt(good_square / found.checks);
  found.prediction_before = a.before.half_left_out;
  found.prediction = prediction_by_halves(a.belts, frame, given.causes);
  found.tool = tool_error(a, given, found.machine);
  found.scale = scale_given_causes(a.measured, given);
  if (found.scale) found.tool.scale_mm_per_m = 1000.0 * found.scale->sigma;
  found.firmware_fit = a.measured.firmware_fit;
  return found;
}

/// The unexplained pattern if the decision has one; else only its probability.
Unexplained pattern_of_belts(const BeltsAnalysis& a) {
  Unexplained result;
  result.probability = std::clamp(a.decision.discrepancy, 0.0, 1.0);
  if (!a.noise.is_of_process()) return result;
  const KeptRows& kept = marginalised_system(a).kept;
  const VectorXd all = kept(a.estimate.left);
  const VectorXd taken = all - kept(a.estimate.left_given_discrepancy);
  result.rms_mm = a.sigma_mm * std::sqrt(taken.squaredNorm() / as_double(taken.size()));
  result.signal_to_noise = result.rms_mm / a.sigma_mm * std::sqrt(as_double(a.system.e.size()));
  result.share = std::min(1.0, taken.squaredNorm() / std::max(all.squaredNorm(), 1e-300));
  result.length_mm = a.noise.process.kernel.fields.front().length;
  return result;
}

/// Residual chi^2 of a place's other readings at their best position.
double left_without(const FitDiagnostics& view, std::size_t point, Belt without) {
  const Index first = belts::row_of(point, Belt::tl);
  const VectorXd residual = view.equations().residual_mm.segment<4>(first);
  MatrixXd free(4, 3);  // the place, and the reading that does not count
  free << view.equations().by_place.middleRows<4>(first),
      Vector4d::Unit(as_index(as_size(without)));
  const VectorXd left = residual - linear::product(free, linear::least_squares(free, residual));
  return left.squaredNorm() / std::pow(view.sigma_mm(), 2);
}

/// The belt that may be wrong instead: on the line between two anchors only the other two belts
/// determine the distance from it, so the readings cannot show which of them is wrong.
std::optional<Belt> equally_likely_belt(const FitDiagnostics& view, std::size_t point, Belt bad) {
  // Odds of twenty to one distinguish them.
  const double limit = left_without(view, point, bad) + 2.0 * std::log(20.0);
  std::optional<Belt> other;
  double least = limit;
  for (const Belt belt : kBelts) {
    if (belt == bad) continue;
    if (const double left = left_without(view, point, belt); left < least) {
      least = left;
      other = belt;
    }
  }
  return other;
}

/// Rejected readings; a place with more than one is listed as a whole.
std::vector<Outlier> bad_belts(const FitGivenCauses& given, const FitDiagnostics& view) {
  std::vector<Outlier> result;
  for (const auto k : each_index(given.belts.points)) {
    std::vector<Belt> bad;
    Outlier outlier;
    outlier.of = Observations::belts;
    outlier.index = k;
    for (const Belt belt : kBelts) {
      if (given.frame.counting[k][belt]) continue;
      bad.push_back(belt);
      const BeltResidual own = view.residual(k, belt);
      if (std::abs(own.deleted_residual_mm) <= std::abs(outlier.residual_mm)) continue;
      outlier.residual_mm = own.deleted_residual_mm;
      outlier.distance = std::abs(own.sigmas);
    }
    if (bad.empty()) continue;
    if (bad.size() == 1) {
      outlier.belt = bad.front();
      outlier.or_belt = equally_likely_belt(view, k, bad.front());
    }
    result.push_back(outlier);
  }
  return result;
}

}  // namespace

std::optional<BeltPrediction> prediction_by_halves(const MeasuredBelts& belts,
                                                   const AnchorFit& frame,
                                                   const std::vector<SizedCause>& causes) {
  return predict_by_halves(
      belts, frame, [&](const AnchorFit& from) { return fit_given_causes(belts, causes, from); });
}

void take_belts_findings(const BeltsAnalysis& a, Diagnosis& d) {
  const FitGivenCauses given = explained(a);
  const FitDiagnostics view(given.belts, given.frame);
  d.unexplained = pattern_of_belts(a);
  d.outliers = bad_belts(given, view);
  d.belts = findings_of(a, given, view);
}

}  // namespace chaintrue::grid::diagnosis
